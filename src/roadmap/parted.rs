//! The energy along a motion, of very many magnets: what is far apart asked at few places.
//!
//! Each stretch knows the cubic through the values and slopes at its ends of all *slow* parts of the
//! energy ([`Parts`]), and asks in its middle for the others only. A part becomes slow on the
//! longest stretch on which its own cubic is right within its share of the tolerance: by the error
//! of Hermite's interpolation, `h^4 / 384` times the bound of the fourth derivative, h the
//! displacement on that stretch. It stays so on all that the stretch is halved into, on which the
//! same cubic is as right. All slow parts together are off by at most half the absolute tolerance,
//! and the others may be off by what the tolerance has left beside that.

use super::profile::{DEEPEST, Knot, cubic, cubic_slope};
use super::stretch::Motion;
use crate::potential::parts::{Part, Parts};

/// The share of the absolute tolerance that slow parts may be off by, and the share of what is left
/// of that which those may that become slow on one stretch.
const SLOW: f64 = 0.5;
const AT_ONCE: f64 = 0.5;

pub(super) struct Parted<'a> {
    motion: &'a Motion<'a>,
    energy: &'a dyn Parts,
    settled: Vec<[Knot; 2]>,
}

/// A stretch of the motion.
struct Stretch {
    /// Of the whole energy.
    ends: [Knot; 2],
    /// Of its slow parts.
    slow: [Knot; 2],
    /// What those are off by, at most (J).
    off: f64,
    /// A bound of the fourth derivative of its other parts that holds on a stretch around this one.
    fourth: f64,
    depth: u32,
}

impl<'a> Parted<'a> {
    pub fn new(motion: &'a Motion<'a>, energy: &'a dyn Parts) -> Self {
        Self {
            motion,
            energy,
            settled: Vec::with_capacity(16),
        }
    }

    /// The stretches, in order, on each of which the cubic through its ends is right within the
    /// tolerance.
    pub fn settled(mut self, ends: [Knot; 2]) -> Vec<[Knot; 2]> {
        let none = |knot: Knot| Knot {
            energy: 0.0,
            slope: 0.0,
            ..knot
        };
        let whole = Stretch {
            ends,
            slow: ends.map(none),
            off: 0.0,
            fourth: f64::INFINITY,
            depth: 0,
        };
        let parts = [self.energy.whole()];
        self.follow(whole, &parts);
        self.settled
    }

    /// Follows the energy along a stretch, of which some parts are not known to be slow.
    fn follow(&mut self, mut stretch: Stretch, parts: &[Part]) {
        let motion = self.motion;
        let [a, b] = stretch.ends;
        let length = motion.displacement * (b.t - a.t);
        let left = motion.allowed(&a, &b) - stretch.off;
        let enough = 384.0 * left / length.powi(4);
        let t = (a.t + b.t) / 2.0;
        let (q, reach) = (motion.at(t), length / 2.0);
        if stretch.fourth > enough {
            let bound = self.energy.fourth_derivative_bound_of(parts, &q, reach);
            stretch.fourth = stretch.fourth.min(bound);
        }
        if stretch.fourth <= enough || stretch.depth >= DEEPEST {
            self.settled.push(stretch.ends);
            return;
        }
        let slow = AT_ONCE * (SLOW * motion.tolerance.absolute - stretch.off);
        let sifted = self.energy.sift(parts, &q, reach, slow);
        let off = stretch.off + sifted.off;
        if !sifted.slow.is_empty() {
            for known in &mut stretch.slow {
                let more = self.ask(&sifted.slow, known.t, true);
                known.energy += more.energy;
                known.slope += more.slope;
            }
        }
        let fast = self.ask(&sifted.fast, t, false);
        let [first, last] = &stretch.slow;
        let slow = Knot {
            t,
            energy: cubic(first, last, t),
            slope: cubic_slope(first, last, t),
        };
        let middle = Knot {
            t,
            energy: slow.energy + fast.energy,
            slope: slow.slope + fast.slope,
        };
        let halves = [([a, middle], [*first, slow]), ([middle, b], [slow, *last])];
        for (ends, slow) in halves {
            let half = Stretch {
                ends,
                slow,
                off,
                fourth: stretch.fourth,
                depth: stretch.depth + 1,
            };
            self.follow(half, &sifted.fast);
        }
    }

    /// Energy and slope of some parts somewhere on the motion.
    fn ask(&self, parts: &[Part], t: f64, roughly: bool) -> Knot {
        let motion = self.motion;
        let q = motion.at(t);
        let (energy, gradient) =
            motion
                .problem
                .energy_and_gradient_of(self.energy, parts, &q, roughly);
        Knot {
            t,
            energy,
            slope: gradient.dot(&motion.step),
        }
    }
}
