//! A motion along which the energy is followed, and the criterion for sampling a part of it densely
//! enough.

use nalgebra::Vector3;

use super::knot::{Knot, cubic};
use super::point::Point;
use tiles::configuration::Configuration;
use tiles::problem::Problem;

/// How closely a profile follows the energy.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ProfileTolerance {
    /// Allowed error of the highest energy, relative to itself.
    pub relative: f64,
    /// Error allowed in any case (J).
    pub absolute: f64,
}

/// A stretch of one of many motions.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    /// The index of the motion.
    pub number: usize,
    pub ends: [Knot; 2],
    /// Bounds that hold on a stretch around this one.
    pub bends: Bends,
    pub depth: u32,
}

/// Bounds of the energy's derivatives along a motion, by its displacement.
#[derive(Clone, Copy)]
pub(super) struct Bends {
    /// J/m^3.
    pub third: f64,
    /// J/m^4.
    pub fourth: f64,
}

impl Bends {
    /// No bounds.
    pub const NONE: Self = Self {
        third: f64::INFINITY,
        fourth: f64::INFINITY,
    };

    pub fn is_none(&self) -> bool {
        self.third == f64::INFINITY && self.fourth == f64::INFINITY
    }

    /// A bound (J) of the error of the cubic through the ends of a stretch of this displacement
    /// (m).
    pub fn error(&self, displacement: f64) -> f64 {
        let [third, fourth] = [(self.third, 3, 96.0), (self.fourth, 4, 384.0)]
            .map(|(bound, power, share)| bound * displacement.powi(power) / share);
        third.min(fourth)
    }
}

impl Stretch {
    pub fn middle(&self) -> f64 {
        (self.ends[0].t + self.ends[1].t) / 2.0
    }
}

pub(super) struct StretchMotion<'a> {
    pub problem: &'a Problem,
    from: Configuration,
    /// The whole motion (m, m, rad).
    pub step: Vector3<f64>,
    /// Displacement of the whole motion, as the potential counts it (m).
    pub displacement: f64,
    pub tolerance: &'a ProfileTolerance,
}

impl<'a> StretchMotion<'a> {
    pub fn new(
        problem: &'a Problem,
        a: &Point,
        b: &Point,
        tolerance: &'a ProfileTolerance,
    ) -> Self {
        let step = a.q.step_to(&b.q);
        Self {
            problem,
            from: a.q,
            step,
            displacement: problem.potential().displacement(step),
            tolerance,
        }
    }

    pub fn ends(&self, [a, b]: [&Point; 2]) -> [Knot; 2] {
        [(0.0, a), (1.0, b)].map(|(t, milestone)| Knot {
            t,
            energy: milestone.energy,
            slope: milestone.gradient.dot(&self.step),
        })
    }

    pub fn at(&self, t: f64) -> Configuration {
        self.from.moved(self.step * t)
    }

    /// Error (J) allowed on a stretch.
    pub fn allowed(&self, a: &Knot, b: &Knot) -> f64 {
        let highest = a.energy.max(b.energy);
        self.tolerance.absolute + self.tolerance.relative * highest.abs()
    }

    /// Whether the cubic through the ends of a stretch shorter than the energy's features predicts
    /// the energy at its midpoint.
    pub fn is_foreseen(&self, a: &Knot, middle: &Knot, b: &Knot) -> bool {
        let length = self.displacement * (b.t - a.t);
        length <= self.problem.potential().feature_length()
            && (cubic(a, b, middle.t) - middle.energy).abs() <= self.allowed(a, b)
    }

    /// Whether a stretch is known within the tolerance; tightens the bounds of its derivatives if
    /// this is worthwhile.
    pub fn is_settled(&self, [a, b]: &[Knot; 2], bends: &mut Bends) -> bool {
        let allowed = self.allowed(a, b);
        let duration = b.t - a.t;
        let displacement = self.displacement * duration;
        if bends.error(displacement) <= allowed {
            return true;
        }
        let middle = self.at((a.t + b.t) / 2.0);
        let reach = displacement / 2.0;
        let potential = self.problem.potential();
        bends.fourth = bends
            .fourth
            .min(potential.fourth_derivative_bound(&middle, reach));
        if bends.fourth.is_finite() {
            return bends.error(displacement) <= allowed;
        }
        // If the midpoint can be used, it decides more often, and sooner.
        if potential.feature_length() > 0.0 {
            return false;
        }
        let [second, third] = potential.bend_bounds(&middle, reach);
        bends.third = bends.third.min(third);
        if bends.error(displacement) <= allowed {
            return true;
        }
        let curvature = second * self.displacement * self.displacement;
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Above the lower of the two parabolas, and no higher than their peak or an end.
    #[test]
    fn the_upper_bound_is_the_peak_of_the_lower_parabola() {
        let knot = |t, energy, slope| Knot { t, energy, slope };
        let slopes = [-3.0, -0.4, 0.0, 0.7, 2.0];
        for (duration, curvature) in [(0.5, 0.0), (0.5, 3.0), (2.0, 1.0), (0.1, 40.0)] {
            for (first, last) in slopes.iter().flat_map(|s| slopes.map(|t| (*s, t))) {
                let (a, b) = (knot(0.0, 0.3, first), knot(duration, -0.2, last));
                let lower = |t: f64| {
                    let back = duration - t;
                    let bend = |t: f64| curvature * t * t / 2.0;
                    let left = a.energy + a.slope * t + bend(t);
                    left.min(b.energy - b.slope * back + bend(back))
                };
                let sampled = (0..=20_000)
                    .map(|k| lower(duration * f64::from(k) / 20_000.0))
                    .fold(a.energy.max(b.energy), f64::max);
                let bound = upper_bound(&a, &b, duration, curvature);
                assert!(
                    bound >= sampled && bound < sampled + 2e-3 * duration,
                    "{a:?} {b:?} {curvature}: {bound} {sampled}"
                );
            }
        }
    }

    /// The functions with the largest error of Hermite's cubic, |t|^3 and t^4, have the stated
    /// error.
    #[test]
    fn the_cubic_is_off_by_its_error_at_most() {
        for (power, bends) in [
            (
                3,
                Bends {
                    third: 6.0,
                    ..Bends::NONE
                },
            ),
            (
                4,
                Bends {
                    fourth: 24.0,
                    ..Bends::NONE
                },
            ),
        ] {
            for half in [1.0_f64, 0.3] {
                let slope = f64::from(power) * half.powi(power - 1);
                let knot = |sign: f64| Knot {
                    t: sign * half,
                    energy: half.powi(power),
                    slope: sign * slope,
                };
                let off = cubic(&knot(-1.0), &knot(1.0), 0.0).abs();
                assert!((bends.error(2.0 * half) / off - 1.0).abs() < 1e-12);
            }
        }
        assert!(Bends::NONE.is_none() && Bends::NONE.error(1.0) == f64::INFINITY);
    }

    #[test]
    fn without_a_bound_of_the_curvature_there_is_none_of_the_energy() {
        let flat = |t| Knot {
            t,
            energy: 0.0,
            slope: 0.0,
        };
        assert_eq!(
            upper_bound(&flat(0.0), &flat(1.0), 1.0, f64::INFINITY),
            f64::INFINITY
        );
    }
}
