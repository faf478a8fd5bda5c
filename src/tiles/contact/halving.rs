//! Recursive bisection of a motion: until all its parts are proved free, or one is found at which
//! the tiles overlap.

use std::ops::Range;

use super::motion::{Known, MotionPart, Step};
use super::{Contact, Placement, separated};
use crate::configuration::Configuration;
use crate::tile::outline::ConvexPart;

/// Motions shorter than this (m) are judged by their ends.
const SHORTEST: f64 = 1e-7;

/// The unproved parts of a motion. Callers reuse it for many motions of the same tiles, to avoid
/// allocations.
#[derive(Debug, Default)]
pub struct Halves {
    stretches: Vec<Stretch>,
    finer: Vec<Stretch>,
    /// Pairs of convex parts, of the fixed and of the moving tile.
    open: Vec<[usize; 2]>,
    kept: Vec<[usize; 2]>,
    /// The pair that blocked the last motion. It is tested first in the next one, which often
    /// starts at the same configuration.
    blocking: Option<[usize; 2]>,
}

#[derive(Clone, Debug)]
struct Stretch {
    ends: [Placement; 2],
    /// The open pairs that are not proved to stay separated; all parts if `None`.
    pairs: Option<Range<usize>>,
}

impl Halves {
    fn clear(&mut self) {
        self.stretches.clear();
        self.finer.clear();
        self.open.clear();
        self.kept.clear();
    }

    /// Continues with the remaining stretches.
    fn next(&mut self) {
        std::mem::swap(&mut self.stretches, &mut self.finer);
        std::mem::swap(&mut self.open, &mut self.kept);
        self.finer.clear();
        self.kept.clear();
    }

    /// Adds both halves of a stretch.
    fn halve(&mut self, [a, b]: [Placement; 2], middle: Placement, pairs: Option<Range<usize>>) {
        for ends in [[a, middle], [middle, b]] {
            let pairs = pairs.clone();
            self.finer.push(Stretch { ends, pairs });
        }
    }
}

impl Contact {
    /// Whether the motion from `a` to `b` (straight in x, y and theta, the shorter way round) is
    /// free all along. Both ends are assumed to be free.
    ///
    /// Thin obstacles cannot be missed: a stretch is accepted only if the line of an edge separates
    /// every two convex parts; otherwise it is bisected, and the motion is rejected at the first
    /// configuration that overlaps.
    pub fn motion_is_free(&self, a: &Configuration, b: &Configuration) -> bool {
        self.motion_overlaps_at_most(a, b, self.touch())
    }

    /// Whether, all along the motion, no convex part of a tile is deeper than `allowed` (m) inside
    /// one of the other's. Both ends are assumed to satisfy this.
    pub fn motion_overlaps_at_most(
        &self,
        a: &Configuration,
        b: &Configuration,
        allowed: f64,
    ) -> bool {
        // For a single motion, clearances would cost more than they save.
        let ends = [a, b].map(|end| Known::of(end, 0.0));
        self.known_motion_overlaps_at_most(ends.each_ref(), allowed, &mut Halves::default())
    }

    /// A configuration with the data that every motion from or to it needs.
    pub fn known(&self, q: Configuration) -> Known {
        Known::of(&q, self.clearance_bound(&q))
    }

    /// The same between known configurations; `left` is reused.
    pub fn known_motion_overlaps_at_most(
        &self,
        [a, b]: [&Known; 2],
        allowed: f64,
        left: &mut Halves,
    ) -> bool {
        let step = Step::between(a, b);
        let reach = step.reach(self);
        // Configurations closer to an end than its clearance are free, and those slightly farther
        // overlap by at most the difference. So a motion that moves no point farther than both
        // clearances together passes directly from one neighbourhood to the other.
        let around = [a, b].map(|known| known.clearance.max(0.0) + allowed.max(0.0));
        around[0] + around[1] >= reach
            || reach <= self.scaled(SHORTEST)
            || self.stretches_overlap_at_most([a.placement, b.placement], step, allowed, left)
    }

    /// Recursively bisects a motion where pairs of convex parts are not proved to stay separated,
    /// and only tests these pairs. All stretches of one length come before shorter ones, so that
    /// blocked motions are found early.
    fn stretches_overlap_at_most(
        &self,
        ends: [Placement; 2],
        mut step: Step,
        allowed: f64,
        left: &mut Halves,
    ) -> bool {
        left.clear();
        let mut reach = step.reach(self);
        left.stretches.push(Stretch { ends, pairs: None });
        while !left.stretches.is_empty() && reach > self.scaled(SHORTEST) {
            let stretches = std::mem::take(&mut left.stretches);
            let are_free = stretches.iter().all(|Stretch { ends, pairs }| {
                let motion = MotionPart::new(ends, &step, allowed);
                match pairs {
                    Some(pairs) => self.open_pairs_stay_apart(&motion, pairs.clone(), left),
                    None => self.parts_stay_apart(&motion, left),
                }
            });
            left.stretches = stretches;
            if !are_free {
                return false;
            }
            left.next();
            step = step.half();
            reach /= 2.0;
        }
        true
    }

    /// Tests pairs of parts in a stretch and keeps the unproved ones; false if one of them overlaps
    /// half way.
    fn open_pairs_stay_apart(
        &self,
        motion: &MotionPart,
        pairs: Range<usize>,
        left: &mut Halves,
    ) -> bool {
        let middle = motion.middle();
        let first = left.kept.len();
        for &pair in &left.open[pairs] {
            let parts = self.pair(pair);
            if motion.separates(parts) {
                continue;
            }
            if !are_separated(parts, &middle, motion.allowed) {
                return false;
            }
            left.kept.push(pair);
        }
        let pairs = first..left.kept.len();
        if !pairs.is_empty() {
            left.halve(*motion.ends, middle, Some(pairs));
        }
        true
    }

    /// The same for all parts.
    fn parts_stay_apart(&self, motion: &MotionPart, left: &mut Halves) -> bool {
        if motion.separates((&self.fixed.hull, &self.moving.hull)) {
            return true;
        }
        let middle = motion.middle();
        let cores = (&self.fixed.core, &self.moving.core);
        if !are_separated(cores, &middle, motion.allowed) {
            return false;
        }
        if self.fixed().parts().len() == 1 && self.moving().parts().len() == 1 {
            // The hulls and cores are the only parts.
            left.halve(*motion.ends, middle, None);
            return true;
        }
        let overlap = |pair: [usize; 2]| !are_separated(self.pair(pair), &middle, motion.allowed);
        if left.blocking.is_some_and(overlap) {
            return false;
        }
        let first = left.kept.len();
        let Halves { kept, blocking, .. } = left;
        let is_free = self.near_pairs(motion, &middle, &mut |i, j| {
            if motion.separates(self.pair([i, j])) {
                return true;
            }
            kept.push([i, j]);
            let blocks = overlap([i, j]);
            if blocks {
                *blocking = Some([i, j]);
            }
            !blocks
        });
        let pairs = first..left.kept.len();
        if is_free && !pairs.is_empty() {
            left.halve(*motion.ends, middle, Some(pairs));
        }
        is_free
    }
}

/// Whether two parts overlap by at most `allowed` (m) at a placement of the moving one.
fn are_separated(
    (fixed, moving): (&ConvexPart, &ConvexPart),
    at: &Placement,
    allowed: f64,
) -> bool {
    separated(fixed, moving, at, -allowed)
}
