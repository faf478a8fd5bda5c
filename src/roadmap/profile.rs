//! The energy along a straight motion, sampled as finely as its curvature demands.

use crate::configuration::Configuration;
use crate::problem::Problem;
use crate::roadmap::Milestone;

/// How closely a profile follows the energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileTolerance {
    /// Allowed error of the highest energy, relative to itself.
    pub relative: f64,
    /// Error allowed in any case (J).
    pub absolute: f64,
}

/// A sample of the energy along a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Fraction of the motion, 0 to 1.
    pub t: f64,
    /// U (J).
    pub energy: f64,
    /// dU/dt (J).
    pub slope: f64,
}

/// The energy along a motion: samples in order, both ends included, between which the energy
/// nowhere exceeds the larger of its neighbours by more than the tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pub samples: Vec<Sample>,
}

/// Stretches are not halved more often than this.
const DEEPEST: u32 = 16;

impl Profile {
    /// Samples the straight motion from `a` to `b`.
    ///
    /// A stretch of duration h is accepted when an upper bound of the energy on it exceeds the
    /// larger end by less than the tolerance. The bound comes from the ends' values and slopes and
    /// from the potential's bound B of the second derivative: `U(t) <= U_a + s_a t + B t^2 / 2`,
    /// and the same from the other end.
    pub fn new(
        problem: &Problem,
        a: &Milestone,
        b: &Milestone,
        tolerance: &ProfileTolerance,
    ) -> Self {
        let step = a.configuration.step_to(&b.configuration);
        let end = |t: f64, milestone: &Milestone| Sample {
            t,
            energy: milestone.energy,
            slope: milestone.gradient.dot(&step),
        };
        let mut profile = Self {
            samples: vec![end(0.0, a)],
        };
        let whole = Motion {
            problem,
            from: a.configuration,
            to: b.configuration,
            displacement: problem.potential().displacement(step),
            tolerance,
        };
        profile.refine(&whole, end(0.0, a), end(1.0, b), 0);
        profile
    }

    fn refine(&mut self, motion: &Motion, a: Sample, b: Sample, depth: u32) {
        if depth >= DEEPEST || motion.is_settled(&a, &b) {
            self.samples.push(b);
            return;
        }
        let middle = motion.sample((a.t + b.t) / 2.0);
        self.refine(motion, a, middle, depth + 1);
        self.refine(motion, middle, b, depth + 1);
    }

    /// The highest sample.
    pub fn peak(&self) -> Sample {
        *self
            .samples
            .iter()
            .max_by(|a, b| a.energy.total_cmp(&b.energy))
            .expect("a profile has two ends")
    }

    /// Mechanical work against the energy, forwards and backwards (J): the sum of all climbs.
    pub fn work(&self) -> (f64, f64) {
        let mut work = (0.0, 0.0);
        for pair in self.samples.windows(2) {
            let climb = pair[1].energy - pair[0].energy;
            work.0 += climb.max(0.0);
            work.1 += (-climb).max(0.0);
        }
        work
    }

    /// The energy at `t` (J), by cubic Hermite interpolation of the samples.
    pub fn energy_at(&self, t: f64) -> f64 {
        let i = self
            .samples
            .partition_point(|s| s.t <= t)
            .clamp(1, self.samples.len() - 1);
        let (a, b) = (&self.samples[i - 1], &self.samples[i]);
        let h = b.t - a.t;
        let u = (t - a.t) / h;
        let (u2, u3) = (u * u, u * u * u);
        a.energy * (2.0 * u3 - 3.0 * u2 + 1.0)
            + a.slope * h * (u3 - 2.0 * u2 + u)
            + b.energy * (3.0 * u2 - 2.0 * u3)
            + b.slope * h * (u3 - u2)
    }
}

struct Motion<'a> {
    problem: &'a Problem,
    from: Configuration,
    to: Configuration,
    /// Displacement of the whole motion, as the potential counts it (m).
    displacement: f64,
    tolerance: &'a ProfileTolerance,
}

impl Motion<'_> {
    fn sample(&self, t: f64) -> Sample {
        let q = self.from.interpolate(&self.to, t);
        let (energy, gradient) = self.problem.energy_and_gradient(&q);
        let slope = gradient.dot(&self.from.step_to(&self.to));
        Sample { t, energy, slope }
    }

    fn is_settled(&self, a: &Sample, b: &Sample) -> bool {
        let highest = a.energy.max(b.energy);
        let allowed = self.tolerance.absolute + self.tolerance.relative * highest.abs();
        let duration = b.t - a.t;
        let middle = self.from.interpolate(&self.to, (a.t + b.t) / 2.0);
        let reach = self.displacement * duration / 2.0;
        let bound = self.problem.potential().curvature_bound(&middle, reach);
        let curvature = bound * self.displacement * self.displacement;
        upper_bound(a, b, duration, curvature) - highest <= allowed
    }
}

/// Upper bound of a function on an interval from its values and slopes at the ends and a bound of
/// its second derivative: the highest point of the smaller of the two parabolas.
fn upper_bound(a: &Sample, b: &Sample, duration: f64, curvature: f64) -> f64 {
    if !curvature.is_finite() {
        return f64::INFINITY;
    }
    // The parabolas U_a + s_a t + B t^2/2 and U_b - s_b (h - t) + B (h - t)^2/2 differ by a linear
    // function of t; each is convex, so the lower one peaks at an end or where they cross.
    let left = |t: f64| a.energy + a.slope * t + curvature * t * t / 2.0;
    let back = duration;
    let right_at_0 = b.energy - b.slope * back + curvature * back * back / 2.0;
    let difference_at_0 = left(0.0) - right_at_0;
    let difference_at_h = left(duration) - b.energy;
    let highest = a.energy.max(b.energy);
    if difference_at_0 >= 0.0 || difference_at_h <= 0.0 {
        return highest
            .max(left(0.0).min(right_at_0))
            .max(left(duration).min(b.energy));
    }
    let crossing = duration * difference_at_0 / (difference_at_0 - difference_at_h);
    highest.max(left(crossing))
}
