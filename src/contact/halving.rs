//! Motions halved again and again, until all of their stretches are proved free or one is met where
//! the tiles overlap.

use std::ops::Range;

use super::motion::{End, Motion, Step};
use super::{Contact, separated};
use crate::tile::outline::ConvexPart;

/// Motions shorter than this (m) are as good as their ends.
pub(super) const SHORTEST: f64 = 1e-7;

/// Stretches halved so often are looked at with an eye on those pairs of convex parts that may meet
/// in them. Of longer stretches these are many, most of them far apart in each half.
const LISTED: usize = 1;

/// What is left to be proved of a motion. Who tries many motions lends the same to all of them, so
/// that none has to ask for memory.
#[derive(Debug, Default)]
pub struct Halves {
    stretches: Vec<Stretch>,
    finer: Vec<Stretch>,
    /// Pairs of convex parts, of the fixed and of the moving tile.
    open: Vec<[usize; 2]>,
    kept: Vec<[usize; 2]>,
}

#[derive(Clone, Debug)]
struct Stretch {
    ends: [End; 2],
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

    /// Both halves of a stretch are to be looked at.
    fn halve(&mut self, [a, b]: [End; 2], middle: End, pairs: Option<Range<usize>>) {
        for ends in [[a, middle], [middle, b]] {
            let pairs = pairs.clone();
            self.finer.push(Stretch { ends, pairs });
        }
    }
}

impl Contact {
    /// Halves a motion where pairs of convex parts are not proved to stay separated, again and again,
    /// with an eye on these pairs only. All stretches of one length are looked at before any shorter
    /// one: what blocks a motion is found soon.
    pub(super) fn stretches_overlap_at_most(
        &self,
        ends: [End; 2],
        mut step: Step,
        allowed: f64,
        left: &mut Halves,
    ) -> bool {
        left.clear();
        let mut reach = step.reach(self);
        let mut halved = 0;
        left.stretches.push(Stretch { ends, pairs: None });
        while !left.stretches.is_empty() && reach > SHORTEST {
            for k in 0..left.stretches.len() {
                let Stretch { ends, pairs } = left.stretches[k].clone();
                let motion = Motion::new(&ends, &step, allowed);
                let is_free = match pairs {
                    Some(pairs) => self.open_pairs_stay_apart(&motion, pairs, left),
                    None => self.parts_stay_apart(&motion, halved >= LISTED, left),
                };
                if !is_free {
                    return false;
                }
            }
            std::mem::swap(&mut left.stretches, &mut left.finer);
            std::mem::swap(&mut left.open, &mut left.kept);
            left.finer.clear();
            left.kept.clear();
            step = step.half();
            reach /= 2.0;
            halved += 1;
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

    /// The same for all parts; pairs that may meet are told apart where they are to be listed.
    fn parts_stay_apart(&self, motion: &Motion, listed: bool, left: &mut Halves) -> bool {
        if motion.separates((&self.fixed_hull, &self.moving_hull)) {
            return true;
        }
        let middle = motion.middle();
        let cores = (&self.fixed_core, &self.moving_core);
        if !are_separated(cores, &middle, motion.allowed) {
            return false;
        }
        if self.fixed.parts().len() == 1 && self.moving.parts().len() == 1 {
            // Hulls and cores are all there is.
            left.halve(*motion.ends, middle, None);
            return true;
        }
        if !listed {
            left.halve(*motion.ends, middle, None);
            return self.fixed_tree.near_pairs(
                &self.moving_tree,
                &middle.place(),
                &|_| 0.0,
                &mut |i, j| are_separated(self.pair([i, j]), &middle, motion.allowed),
            );
        }
        let first = left.kept.len();
        let kept = &mut left.kept;
        let is_free = self.near_pairs(motion, &middle, &mut |i, j| {
            let parts = self.pair([i, j]);
            motion.separates(parts) || {
                kept.push([i, j]);
                are_separated(parts, &middle, motion.allowed)
            }
        });
        let pairs = first..left.kept.len();
        if is_free && !pairs.is_empty() {
            left.halve(*motion.ends, middle, Some(pairs));
        }
        is_free
    }

    pub(super) fn pair(&self, [i, j]: [usize; 2]) -> (&ConvexPart, &ConvexPart) {
        (&self.fixed.parts()[i], &self.moving.parts()[j])
    }
}

/// Whether two parts overlap by no more than `allowed` (m) where the moving one is placed.
fn are_separated((fixed, moving): (&ConvexPart, &ConvexPart), at: &End, allowed: f64) -> bool {
    separated(fixed, moving, &at.placement, -allowed)
}
