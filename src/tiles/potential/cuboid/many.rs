//! Very many blocks: far groups of equal blocks, whose bounds follow from their distance alone.
//!
//! Blocks are grouped as dipoles are ([`groups`](crate::potential::groups)). A block is a uniform
//! distribution of dipoles, so the derivatives of the energy of two groups are bounded by those of
//! dipoles as far apart as the nearest points of their blocks, with the sums of the moments.

use super::{HAND_OVER, SizedBlock, Sizes};
use crate::configuration::Configuration;
use crate::potential::dipole::Dipole;
use crate::potential::far::group::Group;
use crate::potential::groups::are_many;
use crate::potential::groups::tree::{self, Grain, Tree};
use crate::potential::groups::walk::{self, Leeway, Walk};

/// The blocks of two tiles in groups.
#[derive(Clone, Debug)]
pub struct Many {
    sides: [Side; 2],
    /// Groups closer than this (m) are not taken as wholes.
    least: f64,
    /// The largest sum of two blocks' radii (m).
    radii: f64,
}

/// The groups of one tile.
#[derive(Clone, Debug)]
struct Side {
    tree: Vec<tree::DipoleGroup>,
    /// By their place in the tree, ascending.
    parts: Vec<SizeGroup>,
}

/// Blocks of one size.
#[derive(Clone, Debug)]
pub struct SizeGroup {
    /// Where their dipoles, or those that stand for them, start in the tree.
    start: usize,
    /// The index of the size.
    pub size: usize,
    /// Their indices; empty if they are only taken as a whole.
    pub members: Vec<usize>,
}

/// Two groups.
#[derive(Clone, Copy, Debug)]
pub struct BlockGroups<'a> {
    pub fixed: &'a SizeGroup,
    pub moving: &'a SizeGroup,
    /// If they are taken as wholes, the product (A^2 m^4) of the sums of the moments' magnitudes, and
    /// the smallest distance (m) of the blocks.
    pub whole: Option<(f64, f64)>,
}

impl Many {
    /// Groups of the blocks of two tiles, given their groups by size and axis; `None` if groups do not
    /// pay.
    pub fn new(
        blocks: [&[SizedBlock]; 2],
        kinds: [&[Group]; 2],
        sizes: &[Vec<Sizes>],
    ) -> Option<Self> {
        if !are_many(blocks[0].len(), blocks[1].len()) {
            return None;
        }
        let sides = [0, 1].map(|side| Side::new(blocks[side], kinds[side]));
        let has_stands = |side: &Side| side.tree.iter().any(|group| !group.stands.is_empty());
        let largest =
            |value: fn(&Sizes) -> f64| sizes.iter().flatten().map(value).fold(0.0, f64::max);
        sides.iter().any(has_stands).then(|| Self {
            sides,
            least: largest(|sizes| sizes.far.near().sqrt()) * (1.0 + 1e-9),
            radii: largest(|sizes| sizes.radii),
        })
    }

    /// The groups that interact within `reach` (m) of a configuration, those taken as wholes so far
    /// apart, compared with their lengths, that their smallest distance says enough: each pair of
    /// blocks is in exactly one pair of groups.
    pub fn meetings(&self, q: &Configuration, reach: f64) -> impl Iterator<Item = BlockGroups<'_>> {
        let trees = self.sides.each_ref().map(|side| side.tree.as_slice());
        let leeway = Leeway {
            travel: reach,
            lengths: 3.0,
            least: self.least,
            radii: self.radii,
            ..Leeway::default()
        };
        Walk::new(trees, q, leeway).map(|it: walk::DipoleGroups| BlockGroups {
            fixed: self.sides[0].part(it.fixed.start),
            moving: self.sides[1].part(it.moving.start),
            whole: (it.replaced > 0.0).then_some((it.replaced, it.distance)),
        })
    }
}

impl Side {
    fn new(blocks: &[SizedBlock], kinds: &[Group]) -> Self {
        let of_kinds = kinds.iter().enumerate();
        let order: Vec<[usize; 2]> = of_kinds
            .flat_map(|(kind, group)| group.members.iter().map(move |member| [kind, *member]))
            .collect();
        let dipole = |[_, member]: &[usize; 2]| {
            let block = &blocks[*member].block;
            Dipole {
                position: block.position,
                moment: block.axis * block.moment,
            }
        };
        let dipoles: Vec<Dipole> = order.iter().map(dipole).collect();
        let of: Vec<usize> = order.iter().map(|[kind, _]| *kind).collect();
        let grain = Grain {
            fill: 1,
            lost: HAND_OVER,
        };
        let tree = Tree::of_kinds(&dipoles, &of, grain).groups;
        // Groups are listed before their parts, so the blocks before a group's first one are those of
        // undivided groups before it.
        let mut next = 0;
        let mut parts = Vec::new();
        for group in &tree {
            let size = kinds[of[next]].size;
            parts.extend(group.stands.iter().map(|stand| SizeGroup {
                start: stand.dipoles.start,
                size,
                members: Vec::new(),
            }));
            if group.parts.is_none() {
                let members = order[next..next + group.count].iter();
                parts.push(SizeGroup {
                    start: group.own.start,
                    size,
                    members: members.map(|[_, member]| *member).collect(),
                });
                next += group.count;
            }
        }
        parts.sort_by_key(|part| part.start);
        Self { tree, parts }
    }

    /// The blocks whose dipoles start there.
    fn part(&self, start: usize) -> &SizeGroup {
        &self.parts[self.parts.partition_point(|it| it.start < start)]
    }
}

#[cfg(test)]
pub mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use nalgebra::Vector2;
    use rand::{RngExt, SeedableRng};

    use super::super::CuboidPotential;
    use super::*;
    use crate::potential::Potential;
    use crate::tile::Magnet;

    /// A square of 0.4 m with as many magnets on each side, half of them of another size and some of
    /// them along the side.
    pub fn square(count: u32, seed: u64) -> Vec<Magnet> {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let mut magnets = Vec::new();
        let pitch = 0.39 / f64::from(count);
        for side in 0..4 {
            let outwards = f64::from(side) * FRAC_PI_2;
            for k in 0..count {
                let along = (f64::from(k) - f64::from(count - 1) / 2.0) * pitch;
                let (sin, cos) = libm::sincos(outwards);
                let turned = if k % 32 == 3 { FRAC_PI_2 } else { 0.0 };
                let reversed = if rng.random() { PI } else { 0.0 };
                let width = if 2 * k < count { 0.5 } else { 0.7 };
                magnets.push(Magnet {
                    position: Vector2::new(cos * 0.197 - sin * along, sin * 0.197 + cos * along),
                    angle: outwards + turned + reversed,
                    moment: 0.1 + 0.02 * f64::from(k % 5),
                    size: [0.7 * pitch, width * pitch, 0.003],
                    form: Default::default(),
                    face: side as usize,
                });
            }
        }
        magnets
    }

    /// The second derivatives' bounds of groups are about those of all pairs, and of fewer.
    #[test]
    fn groups_are_bounded_like_their_blocks() {
        let (fixed, moving) = (square(128, 1), square(128, 2));
        let potential = CuboidPotential::new(&fixed, &moving);
        let many = potential.many.as_ref().expect("groups");
        let alone = CuboidPotential {
            many: None,
            ..potential.clone()
        };
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        for k in 0..60 {
            let q = Configuration::new(
                [0.405, 0.6][k % 2] + rng.random_range(0.0..[0.01, 0.2, 1.0][k % 3]),
                rng.random_range(-0.3..0.3),
                rng.random_range(-3.1..3.1) * [0.001, 1.0][k % 2],
            );
            for reach in [1e-4, 0.01] {
                let one_by_one = many.meetings(&q, reach);
                let pairs = one_by_one.map(|it| it.fixed.members.len() * it.moving.members.len());
                let pairs: usize = pairs.sum();
                assert!(pairs < fixed.len() * moving.len() / 2, "{q:?}: {pairs}");
                let [found, all] = [&potential, &alone].map(|it| it.curvature_bound(&q, reach));
                assert!(
                    found >= 0.999 * all && found < 4.0 * all,
                    "{q:?}: {found} {all}"
                );
            }
        }
    }
}
