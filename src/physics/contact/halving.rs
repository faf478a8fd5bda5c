//! Recursive bisection of a motion: until all its parts are proved free, or one is found at which
//! the tiles overlap.

use std::ops::Range;

use super::motion::{Known, Motion, Step};
use super::{Contact, Placement, separated};
use crate::configuration::Configuration;
use crate::tile::outline::ConvexPart;

/// Motions shorter than this (m) are as good as their ends.
const SHORTEST: f64 = 1e-7;

/// What is left to be proved of a motion. Who tries many motions of the same tiles lends the same to
/// all of them, so that none has to ask for memory.
#[derive(Debug, Default)]
pub struct Halves {
    stretches: Vec<Stretch>,
    finer: Vec<Stretch>,
    /// Pairs of convex parts, of the fixed and of the moving tile.
    open: Vec<[usize; 2]>,
    kept: Vec<[usize; 2]>,
    /// The pair that blocked a motion last. It is the first to be looked at in the next one, which
    /// often leads from the same place.
    blocking: Option<[usize; 2]>,
}

#[derive(Clone, Debug)]
struct Stretch {
    ends: [Placement; 2],
    /// Those of the open pairs that are not proved to stay separated; all parts where `None`.
    pairs: Option<Range<usize>>,
}

impl Halves {
    fn clear(&mut self) {
        self.stretches.clear();
        self.finer.clear();
        self.open.clear();
        self.kept.clear();
    }

    /// What was left of stretches becomes what is looked at.
    fn next(&mut self) {
        std::mem::swap(&mut self.stretches, &mut self.finer);
        std::mem::swap(&mut self.open, &mut self.kept);
        self.finer.clear();
        self.kept.clear();
    }

    /// Both halves of a stretch are to be looked at.
    fn halve(&mut self, [a, b]: [Placement; 2], middle: Placement, pairs: Option<Range<usize>>) {
        for ends in [[a, middle], [middle, b]] {
            let pairs = pairs.clone();
            self.finer.push(Stretch { ends, pairs });
        }
    }
}

impl Contact {
    /// Whether the motion from `a` to `b` (straight in x, y and theta, the shorter way round) is
    /// free all along. Both ends are taken to be free.
    ///
    /// Nothing thin can be stepped over: a stretch is accepted where the line of an edge keeps every
    /// two convex parts apart; otherwise it is halved, and the motion refused at the first
    /// configuration that overlaps.
    pub fn motion_is_free(&self, a: &Configuration, b: &Configuration) -> bool {
        self.motion_overlaps_at_most(a, b, self.touch())
    }

    /// Whether no convex part of a tile gets deeper than `allowed` (m) into one of the other's all
    /// along the motion, which both ends are taken to fulfil.
    pub fn motion_overlaps_at_most(
        &self,
        a: &Configuration,
        b: &Configuration,
        allowed: f64,
    ) -> bool {
        // Of a single motion, clearances would cost more than they save.
        let ends = [a, b].map(|end| Known::of(end, 0.0));
        self.known_motion_overlaps_at_most(ends.each_ref(), allowed, &mut Halves::default())
    }

    /// A configuration with what every motion from or to it asks for.
    pub fn known(&self, q: Configuration) -> Known {
        Known::of(&q, self.clearance_bound(&q))
    }

    /// The same between configurations that are known; `left` is lent.
    pub fn known_motion_overlaps_at_most(
        &self,
        [a, b]: [&Known; 2],
        allowed: f64,
        left: &mut Halves,
    ) -> bool {
        let step = Step::between(a, b);
        let reach = step.reach(self);
        // What is closer to an end than its clearance is free, what is a little farther overlaps by
        // that little, and a motion that brings no point farther than both together passes from the
        // one's surroundings into the other's.
        let around = [a, b].map(|known| known.clearance.max(0.0) + allowed.max(0.0));
        around[0] + around[1] >= reach
            || reach <= self.scaled(SHORTEST)
            || self.stretches_overlap_at_most([a.placement, b.placement], step, allowed, left)
    }

    /// Halves a motion where pairs of convex parts are not proved to stay separated, again and again,
    /// with an eye on these pairs only. All stretches of one length are looked at before any shorter
    /// one: what blocks a motion is found soon.
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
                let motion = Motion::new(ends, &step, allowed);
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

    /// Looks at pairs of parts in a stretch, of which what is not proved is left; false where one of
    /// them overlaps half way.
    fn open_pairs_stay_apart(
        &self,
        motion: &Motion,
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
    fn parts_stay_apart(&self, motion: &Motion, left: &mut Halves) -> bool {
        if motion.separates((&self.fixed.hull, &self.moving.hull)) {
            return true;
        }
        let middle = motion.middle();
        let cores = (&self.fixed.core, &self.moving.core);
        if !are_separated(cores, &middle, motion.allowed) {
            return false;
        }
        if self.fixed().parts().len() == 1 && self.moving().parts().len() == 1 {
            // Hulls and cores are all there is.
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

/// Whether two parts overlap by no more than `allowed` (m) where the moving one is placed.
fn are_separated(
    (fixed, moving): (&ConvexPart, &ConvexPart),
    at: &Placement,
    allowed: f64,
) -> bool {
    separated(fixed, moving, at, -allowed)
}
