//! Very many blocks: far groups of equal blocks with one axis, replaced by a few blocks of the same
//! size and axis.
//!
//! What holds for dipoles ([`groups`](crate::potential::groups)) holds for such blocks, as a block is a
//! uniform distribution of dipoles: the energy of two blocks is the mean of dipoles' energies over
//! their volumes, so its derivatives by a block's place are at most those of dipoles as far apart as
//! the blocks' nearest points. Groups are replaced only where all of their blocks interact by the
//! multipole series.

use nalgebra::Vector2;

use super::far::Group;
use super::{Far, HAND_OVER, SizedBlock};
use crate::configuration::Configuration;
use crate::potential::dipole::Dipole;
use crate::potential::groups::are_many;
use crate::potential::groups::tree::{self, Grain, Tree};
use crate::potential::groups::walk::{self, Leeway, Walk};
use crate::potential::lever::Lever;

/// The blocks of two tiles in groups.
#[derive(Clone, Debug)]
pub struct Many {
    sides: [Side; 2],
    /// Groups closer than this (m) are not replaced.
    least: f64,
    /// The largest sum of two blocks' radii (m).
    radii: f64,
}

/// The groups of one tile.
#[derive(Clone, Debug)]
struct Side {
    tree: Vec<tree::Group>,
    /// The blocks of each undivided group, and those that replace a group.
    groups: Vec<Group>,
    /// Where the dipoles of each of these start in the tree, ascending.
    starts: Vec<usize>,
    /// The largest distance (m) of a group from the tile's reference point.
    lever: f64,
}

/// Two interacting groups, by their numbers.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    pub groups: [usize; 2],
    /// If a group is replaced, the product (A^2 m^4) of the sums of the moments' magnitudes, and the
    /// smallest distance (m) of the blocks.
    pub replaced: Option<(f64, f64)>,
}

impl Many {
    /// Groups of the blocks of two tiles, given their groups by size and axis; `None` if groups do not
    /// pay.
    pub fn new(blocks: [&[SizedBlock]; 2], kinds: [&[Group]; 2], far: &[Vec<Far>]) -> Option<Self> {
        if !are_many(blocks[0].len(), blocks[1].len()) {
            return None;
        }
        let sides = [0, 1].map(|side| Side::new(blocks[side], kinds[side], side == 0));
        let has_stands = |side: &Side| side.tree.iter().any(|group| !group.stands.is_empty());
        let largest = |value: fn(&Far) -> f64| far.iter().flatten().map(value).fold(0.0, f64::max);
        sides.iter().any(has_stands).then(|| Self {
            sides,
            least: largest(|far| far.near().sqrt()) * (1.0 + 1e-9),
            radii: largest(|far| far.radii),
        })
    }

    /// The blocks of all groups of either tile, and of all that replace groups.
    pub fn groups(&self) -> [&[Group]; 2] {
        self.sides.each_ref().map(|side| side.groups.as_slice())
    }

    /// The lever of the moving tile's blocks and of those that replace them, which reach this much (m)
    /// from their centres.
    pub fn lever(&self, radius: f64) -> Lever {
        let farthest = self.sides[1].lever + radius;
        Lever::of([Vector2::new(farthest, 0.0)].into_iter())
    }

    /// The groups that interact in a configuration: each pair of blocks is in exactly one pair of
    /// groups.
    pub fn meetings(&self, q: &Configuration) -> Vec<Meeting> {
        self.met(q, Leeway::default())
    }

    /// The same for bounds that hold within `reach` (m) of it, with groups so far apart, compared with
    /// their lengths, that their smallest distance says enough.
    pub fn meetings_within(&self, q: &Configuration, reach: f64) -> Vec<Meeting> {
        let leeway = Leeway {
            travel: reach,
            lengths: 3.0,
            ..Leeway::default()
        };
        self.met(q, leeway)
    }

    fn met(&self, q: &Configuration, leeway: Leeway) -> Vec<Meeting> {
        let trees = self.sides.each_ref().map(|side| side.tree.as_slice());
        let leeway = Leeway {
            least: self.least,
            radii: self.radii,
            ..leeway
        };
        let meeting = |it: walk::Meeting| Meeting {
            groups: [
                self.sides[0].number(it.fixed.start),
                self.sides[1].number(it.moving.start),
            ],
            replaced: (it.replaced > 0.0).then_some((it.replaced, it.distance)),
        };
        Walk::new(trees, q, leeway).map(meeting).collect()
    }
}

impl Side {
    fn new(blocks: &[SizedBlock], kinds: &[Group], is_filled: bool) -> Self {
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
        let tree = Tree::of_kinds(&dipoles, &of, grain);
        // Groups are listed before their parts, so the blocks before a group's first one are those of
        // undivided groups before it.
        let mut next = 0;
        let mut groups: Vec<(usize, Group)> = Vec::new();
        for group in &tree.groups {
            let kind = &kinds[of[next]];
            let axis = Vector2::new(kind.axis.re, kind.axis.im);
            for stand in &group.stands {
                let mut found = Group::new(kind.size, axis);
                for dipole in &tree.dipoles[stand.dipoles.clone()] {
                    found.push_stand(dipole.position, dipole.moment.dot(&axis));
                }
                groups.push((stand.dipoles.start, found));
            }
            if group.parts.is_none() {
                let mut found = Group::new(kind.size, axis);
                for [_, member] in &order[next..next + group.count] {
                    let block = &blocks[*member].block;
                    found.push(
                        *member,
                        block.position,
                        block.moment * block.axis.dot(&axis).signum(),
                    );
                }
                groups.push((group.own.start, found));
                next += group.count;
            }
        }
        groups.sort_by_key(|(start, _)| *start);
        let (starts, mut groups): (Vec<usize>, Vec<Group>) = groups.into_iter().unzip();
        if is_filled {
            groups.iter_mut().for_each(Group::fill);
        }
        Self {
            tree: tree.groups,
            groups,
            starts,
            lever: tree.lever,
        }
    }

    /// The number of the group whose dipoles start there.
    fn number(&self, start: usize) -> usize {
        self.starts.partition_point(|it| *it < start)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use rand::{RngExt, SeedableRng};

    use super::super::CuboidPotential;
    use super::*;
    use crate::potential::Potential;
    use crate::tile::Magnet;
    use crate::units::MU0_OVER_4PI;

    /// A square of 0.4 m with as many magnets on each side, half of them of another size and some of
    /// them along the side.
    fn square(count: u32, seed: u64) -> Vec<Magnet> {
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

    /// Where tiles do not overlap, energies, gradients and bounds of groups are those of all pairs,
    /// within the error of a pair in contact, and of fewer pairs.
    #[test]
    fn groups_act_like_their_blocks() {
        let (fixed, moving) = (square(128, 1), square(128, 2));
        let potential = CuboidPotential::new(&fixed, &moving);
        let many = potential.many.as_ref().expect("groups");
        let alone = CuboidPotential {
            many: None,
            ..potential.clone()
        };
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let moment = fixed
            .iter()
            .map(|magnet| magnet.moment.abs())
            .fold(0.0, f64::max);
        let mut farthest: f64 = 0.0;
        for k in 0..60 {
            let q = Configuration::new(
                [0.405, 0.6][k % 2] + rng.random_range(0.0..[0.01, 0.2, 1.0][k % 3]),
                rng.random_range(-0.3..0.3),
                rng.random_range(-3.1..3.1) * [0.001, 1.0][k % 2],
            );
            let unit = MU0_OVER_4PI * moment.powi(2) / 0.01f64.powi(3);
            let (one, other) = (
                potential.energy_and_gradient(&q),
                alone.energy_and_gradient(&q),
            );
            let off = (one.0 - other.0).abs() / unit;
            let slope = (one.1 - other.1).norm() / unit;
            farthest = farthest.max(off);
            assert!(off < 1e-7 && slope < 1e-7 / 0.005, "{q:?}: {off} {slope}");
            assert!((one.0 - potential.energy(&q)).abs() < 1e-12 * unit);
            let evaluated: usize = many
                .meetings(&q)
                .iter()
                .map(|it| {
                    many.groups()[0][it.groups[0]].count * many.groups()[1][it.groups[1]].count
                })
                .sum();
            assert!(
                evaluated < fixed.len() * moving.len() / 2,
                "{q:?}: {evaluated}"
            );
            for reach in [1e-4, 0.01] {
                let [found, all] = [&potential, &alone].map(|it| it.curvature_bound(&q, reach));
                assert!(
                    found >= 0.999 * all && found < 4.0 * all,
                    "{q:?}: {found} {all}"
                );
                let [found, all] =
                    [&potential, &alone].map(|it| it.fourth_derivative_bound(&q, reach));
                let is_close = found >= 0.999 * all && found < 6.0 * all;
                assert!(found == all || is_close, "{q:?}: {found} {all}");
            }
        }
        assert!(farthest > 1e-14, "nothing is replaced");
    }
}
