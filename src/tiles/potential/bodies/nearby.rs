//! The energy of two kinds of magnets close to each other, interpolated, for motions that need it
//! millions of times.
//!
//! The energy of two magnets of 1 A m^2 is a function of the second one's place and turn in the frame of
//! the first, whatever tiles carry them. Its domain is cut into boxes. In each it is a polynomial of
//! degree 5 in x, y and the turn, through its values at Chebyshev nodes; forces are its derivatives. A box
//! whose polynomial errs is halved in every direction, and where that does not help, close to magnets
//! that touch, the energy is computed exactly. Boxes are made on first use; each is the same whenever this
//! is, and on whichever thread.

use std::f64::consts::PI;
use std::sync::OnceLock;

use nalgebra::Vector2;

use super::Body;
use super::near::exact;
use crate::potential::far::PairEnergy;
use crate::units::MU0_OVER_4PI;

/// Nodes along each direction of a box.
const N: usize = 6;
/// Boxes along x and y, and around a turn, before any is halved.
const SIDE: usize = 4;
const TURNS: usize = 8;
/// A box is halved this often at most.
const HALVINGS: usize = 4;
/// The largest error of a force over that of the energy times 3 / reach.
const OF_FORCE: f64 = 30.0;
/// Places in a box (from -1 to 1) at which the polynomial is compared with the energy: between the nodes,
/// where it errs most.
const TRIED: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [0.99, 0.99, 0.99],
    [-0.99, 0.99, -0.51],
    [0.51, -0.99, 0.99],
    [-0.99, -0.51, 0.0],
    [0.83, 0.13, -0.99],
];

/// The interpolated energy of two kinds of magnets.
#[derive(Debug)]
pub struct Nearby {
    /// With the axis along x, at the origin.
    first: Body,
    second: Body,
    /// The distance (m) along x and along y that is covered.
    reach: f64,
    /// The largest error (J) for moments of 1 A m^2.
    error: f64,
    boxes: Vec<OnceLock<Node>>,
}

/// What is known of a box.
#[derive(Debug)]
enum Node {
    /// The coefficients of Chebyshev polynomials, by x, y and turn.
    Polynomial(Box<[f64; N * N * N]>),
    Halves(Box<[OnceLock<Node>; 8]>),
    /// The energy is computed.
    Exact,
}

/// A box: its middle (m, m, rad) and half its sides.
#[derive(Clone, Copy)]
struct Place {
    middle: [f64; 3],
    half: [f64; 3],
}

impl Nearby {
    /// Up to a distance (m); `error` is relative to the energy of dipoles at this distance.
    pub fn new(first: &Body, second: &Body, reach: f64, error: f64) -> Self {
        let along = |body: &Body| Body {
            position: Vector2::zeros(),
            direction: Vector2::x(),
            ..*body
        };
        Self {
            first: along(first),
            second: along(second),
            reach,
            error: error * MU0_OVER_4PI / (reach * reach * reach),
            boxes: (0..SIDE * SIDE * TURNS).map(|_| OnceLock::new()).collect(),
        }
    }

    /// The energy (J) for moments of 1 A m^2 and its derivatives, by the direction of the first, and the
    /// place (m) and direction of the second relative to it.
    pub fn at(
        &self,
        axis: Vector2<f64>,
        place: Vector2<f64>,
        direction: Vector2<f64>,
    ) -> PairEnergy {
        let turn = libm::atan2(axis.perp(&direction), axis.dot(&direction));
        let q = [axis.dot(&place), axis.perp(&place), turn];
        let (energy, [x, y, slope]) = self.local(q);
        PairEnergy {
            energy,
            gradient: axis * x + Vector2::new(-axis.y, axis.x) * y,
            slope,
        }
    }

    /// The same in the frame of the first.
    fn local(&self, q: [f64; 3]) -> (f64, [f64; 3]) {
        let counts = [SIDE, SIDE, TURNS];
        let whole = [2.0 * self.reach, 2.0 * self.reach, 2.0 * PI];
        let at = [0, 1, 2].map(|k| {
            let share = q[k] / whole[k] + 0.5;
            (share * counts[k] as f64).clamp(0.0, counts[k] as f64 - 1.0) as usize
        });
        let half = [0, 1, 2].map(|k| 0.5 * whole[k] / counts[k] as f64);
        let mut place = Place {
            middle: [0, 1, 2].map(|k| (2 * at[k] + 1) as f64 * half[k] - 0.5 * whole[k]),
            half,
        };
        let mut node = &self.boxes[(at[0] * SIDE + at[1]) * TURNS + at[2]];
        for depth in 0..=HALVINGS {
            match node.get_or_init(|| self.node(&place, depth)) {
                Node::Polynomial(all) => return place.value(all, q),
                Node::Exact => break,
                Node::Halves(halves) => {
                    let upper = [0, 1, 2].map(|k| q[k] > place.middle[k]);
                    let [x, y, turn] = upper.map(usize::from);
                    place = place.part(upper);
                    node = &halves[4 * x + 2 * y + turn];
                }
            }
        }
        self.exact(q)
    }

    fn exact(&self, [x, y, turn]: [f64; 3]) -> (f64, [f64; 3]) {
        let (sin, cos) = libm::sincos(turn);
        let second = Body {
            position: Vector2::new(x, y),
            direction: Vector2::new(cos, sin),
            ..self.second
        };
        let found = exact(&self.first, &second);
        let PairEnergy {
            energy,
            gradient,
            slope,
        } = found;
        (energy, [gradient.x, gradient.y, slope])
    }

    /// The polynomial of a box if it is good enough.
    fn node(&self, place: &Place, depth: usize) -> Node {
        let nodes: [f64; N] = std::array::from_fn(|k| libm::cos(PI * (k as f64 + 0.5) / N as f64));
        let mut values = Box::new([0.0; N * N * N]);
        for (number, value) in values.iter_mut().enumerate() {
            let at = [number / (N * N), number / N % N, number % N];
            *value = self.exact(place.of(at.map(|k| nodes[k]))).0;
        }
        let all = coefficients(values);
        let force = OF_FORCE * 3.0 * self.error / self.reach;
        let is_good = |at: &[f64; 3]| {
            let q = place.of(*at);
            let ((energy, slopes), (told, told_slopes)) = (self.exact(q), place.value(&all, q));
            let scale = [1.0, 1.0, self.reach];
            let off = [0, 1, 2].map(|k| (slopes[k] - told_slopes[k]).abs() / scale[k]);
            (energy - told).abs() <= self.error && off.iter().all(|off| *off <= force)
        };
        match TRIED.iter().all(is_good) {
            true => Node::Polynomial(all),
            false if depth == HALVINGS => Node::Exact,
            false => Node::Halves(Box::new(std::array::from_fn(|_| OnceLock::new()))),
        }
    }
}

impl Place {
    /// The configuration at a place in the box (from -1 to 1).
    fn of(&self, at: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| self.middle[k] + self.half[k] * at[k])
    }

    /// One of its eight parts.
    fn part(&self, upper: [bool; 3]) -> Self {
        let half = self.half.map(|it| 0.5 * it);
        let middle = [0, 1, 2].map(|k| {
            let by = if upper[k] { half[k] } else { -half[k] };
            self.middle[k] + by
        });
        Self { middle, half }
    }

    /// The sum of the polynomials, and its derivatives by x, y and turn.
    fn value(&self, all: &[f64; N * N * N], q: [f64; 3]) -> (f64, [f64; 3]) {
        let at = [0, 1, 2].map(|k| (q[k] - self.middle[k]) / self.half[k]);
        let [(x, dx), (y, dy), (z, dz)] = at.map(polynomials);
        let [mut value, mut by_x, mut by_y, mut by_z] = [0.0; 4];
        for (plane, (x, dx)) in all.chunks_exact(N * N).zip(x.iter().zip(&dx)) {
            let [mut sum, mut sum_y, mut sum_z] = [0.0; 3];
            for (row, (y, dy)) in plane.chunks_exact(N).zip(y.iter().zip(&dy)) {
                let mut along = 0.0;
                let mut slope = 0.0;
                for k in 0..N {
                    along += row[k] * z[k];
                    slope += row[k] * dz[k];
                }
                sum += along * y;
                sum_y += along * dy;
                sum_z += slope * y;
            }
            value += sum * x;
            by_x += sum * dx;
            by_y += sum_y * x;
            by_z += sum_z * x;
        }
        let slopes = [by_x, by_y, by_z];
        (value, [0, 1, 2].map(|k| slopes[k] / self.half[k]))
    }
}

/// The Chebyshev polynomials at x and their derivatives.
fn polynomials(x: f64) -> ([f64; N], [f64; N]) {
    let (mut values, mut slopes) = ([1.0; N], [0.0; N]);
    (values[1], slopes[1]) = (x, 1.0);
    for k in 2..N {
        values[k] = 2.0 * x * values[k - 1] - values[k - 2];
        slopes[k] = 2.0 * values[k - 1] + 2.0 * x * slopes[k - 1] - slopes[k - 2];
    }
    (values, slopes)
}

/// The coefficients of Chebyshev polynomials from the values at the nodes, direction by direction.
fn coefficients(mut all: Box<[f64; N * N * N]>) -> Box<[f64; N * N * N]> {
    for stride in [N * N, N, 1] {
        let firsts = (0..N * N * N).filter(|at| at / stride % N == 0);
        for first in firsts {
            let values: [f64; N] = std::array::from_fn(|k| all[first + k * stride]);
            for m in 0..N {
                let of = |(k, value): (usize, &f64)| {
                    value * libm::cos(PI * m as f64 * (k as f64 + 0.5) / N as f64)
                };
                let sum: f64 = values.iter().enumerate().map(of).sum();
                let share = if m == 0 { 1.0 } else { 2.0 };
                all[first + m * stride] = share * sum / N as f64;
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tile::magnet::Shape;

    #[test]
    fn it_is_the_energy_within_its_error() {
        let disc = Body {
            position: Vector2::zeros(),
            direction: Vector2::x(),
            moment: 1.0,
            size: [3e-3, 6e-3, 6e-3],
            shape: Shape::Disc,
            stands: false,
        };
        let nearby = Nearby::new(&disc, &disc, 0.011, 1e-4);
        let mut worst = [0.0f64; 2];
        for k in 0..400 {
            let share = |by: f64| (f64::from(k) * by).fract();
            let (angle, from) = (2.0 * PI * share(0.618), 7e-3 + 4e-3 * share(0.414));
            let q = [
                from * libm::cos(angle),
                from * libm::sin(angle),
                PI * (2.0 * share(0.732) - 1.0),
            ];
            let (exact, told) = (nearby.exact(q), nearby.local(q));
            worst[0] = worst[0].max((exact.0 - told.0).abs() / nearby.error);
            for axis in 0..2 {
                let force = 3.0 * nearby.error / nearby.reach;
                worst[1] = worst[1].max((exact.1[axis] - told.1[axis]).abs() / force);
            }
        }
        assert!(worst[0] < 2.0 && worst[1] < 2.0 * OF_FORCE, "{worst:?}");
        assert!(worst[0] > 0.0, "nothing was interpolated");
        // In any frame.
        let axis = Vector2::new(0.6, 0.8);
        let turned = nearby.at(axis, axis * 8e-3, Vector2::new(0.8, 0.6));
        let direction = Vector2::new(
            axis.dot(&Vector2::new(0.8, 0.6)),
            axis.perp(&Vector2::new(0.8, 0.6)),
        );
        let straight = nearby.at(Vector2::x(), Vector2::new(8e-3, 0.0), direction);
        assert!((turned.energy / straight.energy - 1.0).abs() < 1e-9);
        assert!((turned.gradient.dot(&axis) / straight.gradient.x - 1.0).abs() < 1e-9);
    }
}
