//! Bounds for large numbers of dipoles in groups (see [`crate::potential::groups`]): the few
//! dipoles that replace a far group are bounded like any others, and the error of the replacement
//! over the cell is added.

use super::taylor::Taylor;
use super::{DipoleBounds, NEAR};
use crate::cell::Cell;
use crate::potential::bounds::{Enclosure, depths};
use crate::potential::dipole::{Dipole, dipoles};
use crate::potential::groups::tree::{self, DipoleGroup, Grain, Tree};
use crate::potential::groups::walk::{Leeway, Walk};
use crate::tile::Tile;
use crate::units::MU0_OVER_4PI;

impl DipoleBounds {
    /// Encloses U group by group.
    pub(super) fn enclose_groups(
        &self,
        [fixed, moving]: [&[DipoleGroup]; 2],
        cell: &Cell,
    ) -> Enclosure {
        let leeway = Leeway {
            travel: cell.travel(),
            turn: cell.half[2],
            // A little farther than single pairs, so that no replacement is near.
            near: NEAR * (1.0 + 1e-6),
            ..Leeway::default()
        };
        let mut out = Enclosure::default();
        let mut weights = Vec::new();
        let rotation = cell.centre.rotation();
        for meeting in Walk::new([fixed, moving], &cell.centre, leeway) {
            let (form, mut remainder) = self.level.run(Taylor::<false> {
                bounds: self,
                cell,
                fixed: meeting.fixed.clone(),
                moving: meeting.moving.clone(),
                weights: &mut weights,
            });
            // By the order of the remainder, see `taylor`.
            out.slope += 3.0 * remainder;
            if meeting.replaced > 0.0 {
                let scale = MU0_OVER_4PI / meeting.distance.powi(3);
                let lost = LOST_AND_ROUNDED * scale * meeting.replaced;
                remainder += lost;
                out.slope += SLOPE_OF_LOST * lost;
            }
            out.form = out.form.minus(-1.0, &form);
            out.low -= remainder;
            out.high += remainder;
            let near = weights
                .iter()
                .enumerate()
                .filter(|(_, weight)| **weight == 0.0);
            for (k, _) in near {
                let (j, i) = (k / meeting.moving.len(), k % meeting.moving.len());
                let fixed = &self.fixed[meeting.fixed.start + j];
                let i = meeting.moving.start + i;
                self.add_near(&mut out, (cell, &rotation), fixed, i);
            }
        }
        out
    }
}

/// Relative error of the energy of replacement dipoles ([`tree::LOST`]), including the rounding in
/// computing them.
const LOST_AND_ROUNDED: f64 = 1.1 * tree::LOST;

/// A motion by the cell's half sizes changes this error by no more than this times its bound: for n
/// up to 24 nodes by `(n + 3) / r` times the reach, which is a third of the distance r at most, and
/// by `n + 2` times the turn, which is half a turn at most, as a turn moves dipoles linearly in
/// their places and turns their moments.
const SLOPE_OF_LOST: f64 = 100.0;

/// The tree of a tile's dipoles, and the dipoles of its groups with their distances to the outline,
/// which replacements lack.
pub(super) fn in_groups(tile: &Tile, fill: usize) -> (Vec<(Dipole, f64)>, Vec<DipoleGroup>) {
    let tree = Tree::new(&dipoles(&tile.magnets), Grain::of_dipoles(fill));
    let mut all: Vec<_> = tree.dipoles.iter().map(|dipole| (*dipole, 0.0)).collect();
    let mut depths = depths(tile).into_iter();
    for group in &tree.groups {
        let count = group.count;
        for (dipole, depth) in all[group.own.clone()]
            .iter_mut()
            .take(count)
            .zip(&mut depths)
        {
            dipole.1 = depth;
        }
    }
    (all, tree.groups)
}
