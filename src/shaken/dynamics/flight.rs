//! Motion between contacts: an embedded Runge-Kutta pair with step-size control.

use nalgebra::Vector3;

use super::force::Forces;
use crate::rigid::Phase;
use tiles::scale::Scale;

/// Coefficients of Dormand and Prince (1980, doi:10.1016/0771-050X(80)90013-3), order 5 with an
/// error estimate of order 4. The last row of `A` gives the step itself, and its stage is the
/// first of the next step.
const A: [&[f64]; 6] = [
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
    ],
    &[
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
    ],
    &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];
const C: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
/// Weights of the error estimate.
const E: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// A step tried from one phase.
pub(super) struct Trial {
    pub phase: Phase,
    /// Acceleration at its end, drag included.
    pub acceleration: Vector3<f64>,
    /// Estimated error of the step (m): the largest of those of the place and of the velocity times
    /// a tenth of a second, with rotations multiplied by the radius `rho`.
    pub error: f64,
}

/// The time (s, for the paper's tile) that converts errors of velocity to errors of position.
const VELOCITY_TIME: f64 = 0.1;

/// One step of length `h` (s) from `phase` at time `t`, where the acceleration is given.
pub(super) fn attempt(
    forces: &Forces,
    phase: &Phase,
    acceleration: Vector3<f64>,
    (t, h): (f64, f64),
    (rho, scale): (f64, Scale),
) -> Trial {
    let mut rates = [(Vector3::zeros(), Vector3::zeros()); 7];
    rates[0] = (phase.velocity, acceleration);
    let mut next = *phase;
    for (i, row) in A.iter().enumerate() {
        next = *phase;
        for (a, (velocity, acceleration)) in row.iter().zip(&rates) {
            next.place += velocity * (a * h);
            next.velocity += acceleration * (a * h);
        }
        rates[i + 1] = (next.velocity, forces.acceleration(&next, t + C[i] * h));
    }
    let mut wrong = (Vector3::zeros(), Vector3::zeros());
    for (e, (velocity, acceleration)) in E.iter().zip(&rates) {
        wrong.0 += velocity * (e * h);
        wrong.1 += acceleration * (e * h);
    }
    let size = |v: &Vector3<f64>| v.x.abs().max(v.y.abs()).max(rho * v.z.abs());
    Trial {
        phase: next,
        acceleration: rates[6].1,
        error: size(&wrong.0).max(scale.time(VELOCITY_TIME) * size(&wrong.1)),
    }
}

/// The factor by which the step should change, given its error over the tolerance.
pub(super) fn step_factor(error_ratio: f64) -> f64 {
    (0.9 * libm::pow(error_ratio, -0.2)).clamp(0.2, 4.0)
}
