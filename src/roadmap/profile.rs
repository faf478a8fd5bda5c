//! The energy along a straight motion, sampled as finely as its curvature demands.

use nalgebra::Vector3;
use ordered_float::OrderedFloat;

use crate::configuration::Configuration;
use crate::problem::Problem;
use crate::roadmap::Milestone;

/// How closely a profile follows the energy.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ProfileTolerance {
    /// Allowed error of the highest energy, relative to itself.
    pub relative: f64,
    /// Error allowed in any case (J).
    pub absolute: f64,
}

/// A point of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Fraction of the motion, 0 to 1.
    pub t: f64,
    /// U (J).
    pub energy: f64,
    /// dU/dt (J).
    pub slope: f64,
}

/// The energy along a motion as a cubic spline: knots in order, both ends included, and the
/// spline's own highest and lowest points between them. The energy nowhere exceeds the larger of
/// its two neighbours by more than the tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// In the order of t.
    pub knots: Vec<Knot>,
}

/// Stretches are not halved more often than this.
const DEEPEST: u32 = 16;

impl Profile {
    /// Samples the straight motion from `a` to `b`.
    ///
    /// A stretch of duration h is accepted when one of two bounds says that it is known within the
    /// tolerance, given the values and slopes at its ends:
    ///
    /// * the cubic through them is off by at most `h^4 / 384` times the largest fourth derivative
    ///   (the error of Hermite's interpolation; Davis, *Interpolation and Approximation*, theorem
    ///   3.5.1), or
    /// * where no bound of that is known, `U(t) <= U_a + s_a t + B t^2 / 2` with B a bound of the
    ///   second derivative, and the same from the other end, exceed the larger end by no more.
    ///
    /// Blocks in contact have no bound of the one and only a very wide one of the other. There a
    /// stretch shorter than [`Potential::feature_length`](crate::potential::Potential) is accepted
    /// where the cubic foretells the energy in its middle. That is a check, no proof; proved bounds
    /// of barriers come from the certificate.
    pub fn new(
        problem: &Problem,
        a: &Milestone,
        b: &Milestone,
        tolerance: &ProfileTolerance,
    ) -> Self {
        let step = a.configuration.step_to(&b.configuration);
        let end = |t: f64, milestone: &Milestone| Knot {
            t,
            energy: milestone.energy,
            slope: milestone.gradient.dot(&step),
        };
        let mut profile = Self {
            knots: Vec::with_capacity(16),
        };
        profile.knots.push(end(0.0, a));
        let whole = Motion {
            problem,
            from: a.configuration,
            step,
            displacement: problem.potential().displacement(step),
            tolerance,
        };
        profile.refine(&whole, [end(0.0, a), end(1.0, b)], f64::INFINITY, 0);
        profile
    }

    /// `fourth` is a bound of the fourth derivative that holds on a longer stretch.
    fn refine(&mut self, motion: &Motion, [a, b]: [Knot; 2], fourth: f64, depth: u32) {
        let mut fourth = fourth;
        if depth >= DEEPEST || motion.is_settled(&a, &b, &mut fourth) {
            self.finish(&a, &b);
            return;
        }
        let middle = motion.knot((a.t + b.t) / 2.0);
        if fourth == f64::INFINITY && motion.is_foreseen(&a, &middle, &b) {
            self.finish(&a, &middle);
            self.finish(&middle, &b);
            return;
        }
        self.refine(motion, [a, middle], fourth, depth + 1);
        self.refine(motion, [middle, b], fourth, depth + 1);
    }

    fn finish(&mut self, a: &Knot, b: &Knot) {
        self.knots.extend(inner_extremes(a, b));
        self.knots.push(*b);
    }

    /// The highest knot.
    pub fn peak(&self) -> Knot {
        *self
            .knots
            .iter()
            .max_by_key(|knot| OrderedFloat(knot.energy))
            .expect("a profile has two ends")
    }

    /// Mechanical work against the energy, forwards and backwards (J): the sum of all climbs.
    pub fn work(&self) -> (f64, f64) {
        let mut work = (0.0, 0.0);
        for pair in self.knots.windows(2) {
            let climb = pair[1].energy - pair[0].energy;
            work.0 += climb.max(0.0);
            work.1 += (-climb).max(0.0);
        }
        work
    }

    /// The energy (J) at `count + 1` evenly spaced points from end to end.
    pub fn energies(&self, count: usize) -> impl Iterator<Item = f64> + '_ {
        let mut i = 1;
        (0..=count).map(move |k| {
            let t = k as f64 / count as f64;
            while i + 1 < self.knots.len() && self.knots[i].t <= t {
                i += 1;
            }
            cubic(&self.knots[i - 1], &self.knots[i], t)
        })
    }
}

/// The cubic through the values and slopes of two knots.
fn cubic(a: &Knot, b: &Knot, t: f64) -> f64 {
    let h = b.t - a.t;
    let u = (t - a.t) / h;
    let (u2, u3) = (u * u, u * u * u);
    a.energy * (2.0 * u3 - 3.0 * u2 + 1.0)
        + a.slope * h * (u3 - 2.0 * u2 + u)
        + b.energy * (3.0 * u2 - 2.0 * u3)
        + b.slope * h * (u3 - u2)
}

/// Where the cubic through two knots is highest or lowest between them, in order.
pub(crate) fn inner_extremes(a: &Knot, b: &Knot) -> impl Iterator<Item = Knot> {
    // The derivative by u = (t - a.t) / h is p u^2 + 2 q u + r.
    let h = b.t - a.t;
    let climb = b.energy - a.energy;
    let (first, last) = (a.slope * h, b.slope * h);
    let p = 3.0 * (first + last) - 6.0 * climb;
    let q = 3.0 * climb - 2.0 * first - last;
    let r = first;
    let root = (q * q - p * r).sqrt();
    // Of the two forms of each root the one in which nothing cancels.
    let sum = -(q + root.copysign(q));
    let (mut low, mut high) = (sum / p, r / sum);
    if low > high {
        std::mem::swap(&mut low, &mut high);
    }
    let (a, b) = (*a, *b);
    [low, high]
        .into_iter()
        .filter(|u| *u > 1e-9 && *u < 1.0 - 1e-9)
        .map(move |u| {
            let t = a.t + u * h;
            Knot {
                t,
                energy: cubic(&a, &b, t),
                slope: 0.0,
            }
        })
}

struct Motion<'a> {
    problem: &'a Problem,
    from: Configuration,
    /// The whole motion (m, m, rad).
    step: Vector3<f64>,
    /// Displacement of the whole motion, as the potential counts it (m).
    displacement: f64,
    tolerance: &'a ProfileTolerance,
}

impl Motion<'_> {
    fn at(&self, t: f64) -> Configuration {
        self.from.moved(self.step * t)
    }

    fn knot(&self, t: f64) -> Knot {
        let (energy, gradient) = self.problem.energy_and_gradient(&self.at(t));
        let slope = gradient.dot(&self.step);
        Knot { t, energy, slope }
    }

    /// Error (J) allowed on a stretch.
    fn allowed(&self, a: &Knot, b: &Knot) -> f64 {
        let highest = a.energy.max(b.energy);
        self.tolerance.absolute + self.tolerance.relative * highest.abs()
    }

    /// Whether a stretch shorter than the energy's own features has in its middle what the cubic
    /// through its ends says.
    fn is_foreseen(&self, a: &Knot, middle: &Knot, b: &Knot) -> bool {
        let length = self.displacement * (b.t - a.t);
        length <= self.problem.potential().feature_length()
            && (cubic(a, b, middle.t) - middle.energy).abs() <= self.allowed(a, b)
    }

    /// Whether a stretch is known within the tolerance; narrows the bound of its fourth derivative
    /// where that is worth while.
    fn is_settled(&self, a: &Knot, b: &Knot, fourth: &mut f64) -> bool {
        let allowed = self.allowed(a, b);
        let duration = b.t - a.t;
        let is_close =
            |fourth: f64| fourth * (self.displacement * duration).powi(4) <= 384.0 * allowed;
        if is_close(*fourth) {
            return true;
        }
        let middle = self.at((a.t + b.t) / 2.0);
        let reach = self.displacement * duration / 2.0;
        let potential = self.problem.potential();
        *fourth = fourth.min(potential.fourth_derivative_bound(&middle, reach));
        if fourth.is_finite() {
            return is_close(*fourth);
        }
        // Where the middle can be asked it tells more, and sooner.
        if potential.feature_length() > 0.0 {
            return false;
        }
        let bound = potential.curvature_bound(&middle, reach);
        let curvature = bound * self.displacement * self.displacement;
        upper_bound(a, b, duration, curvature) - a.energy.max(b.energy) <= allowed
    }
}

/// Upper bound of a function on an interval from its values and slopes at the ends and a bound of
/// its second derivative: the highest point of the smaller of the two parabolas.
fn upper_bound(a: &Knot, b: &Knot, duration: f64, curvature: f64) -> f64 {
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
