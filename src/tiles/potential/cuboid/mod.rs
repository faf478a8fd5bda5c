//! Uniformly magnetised blocks, exact at all distances.
//!
//! A uniformly magnetised block is equivalent to two uniform sheets of magnetic charge, its pole
//! faces, and the energy of two blocks is the Coulomb energy of the four pairs of sheets. Blocks
//! may have any sizes and strengths and stand at any angle in the plane; all are centred on one
//! mid-plane, as the thicknesses of the two need not be equal.
//!
//! * Nearby, three of the four integrals over a pair of sheets have closed forms and the last is a
//!   Gauss quadrature (`sheet`, `panel`, `quadrature`); the discontinuous parts of the gradient's
//!   integrands are treated separately (`closed`).
//! * Beyond about three block sizes, where closed forms lose digits, the multipole series is used
//!   (`far`), with ten terms at first and down to two farther out. The bound of the
//!   omitted terms decides: 1e-9 of `mu0 m1 m2 / (4 pi r^3)`, for the strongest pair if pairs are
//!   summed.
//!
//! * With many blocks the field of the fixed tile is tabulated (`table`), and bounds are those of
//!   groups (`many`).
//!
//! # Accuracy
//! Relative to the pair's energy, force, and force times 1 cm: 1e-6 from a gap of 1 mm up (2e-7 at
//! worst in the tests) and 1e-4 closer, contact and sliding contact included (4e-6 at worst), for
//! blocks of about 1 cm; it scales with the blocks' width. Where the energy passes through zero on
//! a slide, the error is relative to 1 mm times the force. At the hand-over to the far form
//! energies step by less than 4e-9 of `mu0 m1 m2 / (4 pi r^3)` of the strongest pair.
//!
//! # Edges
//! Energies are finite at every configuration, including overlaps. In contact the gradient is the
//! limit from the side of the free configurations. Second derivatives are infinite, like a
//! logarithm, where edges of pole faces meet. Derivatives computed from differences of energies are
//! only as accurate as the energies: at contact use steps of about 0.1 mm.

pub mod block;
mod closed;
#[cfg(test)]
pub(in crate::potential) mod cloud;
pub(in crate::potential) mod correction;
pub mod limits;
mod many;
mod panel;
pub(crate) mod quadrature;
pub(in crate::potential) mod sheet;
mod sum;
mod table;

use std::sync::Arc;

use nalgebra::{Complex, Vector2, Vector3};

use super::dipole::dipoles;
use super::far::FarForm;
pub use super::far::PairEnergy;
use super::far::group::Group;
use super::far::multipole::{Homogeneous, Multipole, along, composed, product, squares};
use super::far::rows::Facing;
use super::kinds::number_of;
use super::lever::Lever;
use super::simd::Level;
use super::{DipolePotential, Potential, motion};
use crate::configuration::Configuration;
use crate::tile::Magnet;
pub use block::Block;
use limits::BlockLimits;
use many::{BlockGroups, Many};
pub use panel::exact;
use sum::{BlockSum, Each};
use table::BlockField;

/// The relative error of a pair (in units of `mu0 m1 m2 / (4 pi r^3)`) at which the far form
/// replaces the pole faces and, in units of the strongest pair's value, at which its terms are
/// dropped one by one.
const HAND_OVER: f64 = 1e-9;

/// The interaction energy of two sets of uniformly magnetised blocks, one in each tile.
#[derive(Clone, Debug)]
pub struct CuboidPotential {
    level: Level,
    fixed: Vec<SizedBlock>,
    moving: Vec<SizedBlock>,
    fixed_groups: Vec<Group>,
    moving_groups: Vec<Group>,
    /// For each size of a fixed block and each size of a moving one.
    sizes: Vec<Vec<Sizes>>,
    many: Option<Many>,
    field: Option<Arc<BlockField>>,
    /// The blocks as dipoles.
    dipoles: DipolePotential,
    lever: Lever,
}

/// A block and the index of its size.
#[derive(Clone, Copy, Debug)]
struct SizedBlock {
    block: Block,
    size: usize,
}

/// What pairs of blocks of two sizes have in common.
#[derive(Clone, Debug)]
struct Sizes {
    far: FarForm,
    /// Bounds for moments of 1 A m^2.
    limits: BlockLimits,
    /// The sum of the blocks' radii (m).
    radii: f64,
}

/// Terms of the series that are summed, and that enter the bound of the error.
const TERMS: usize = 10;
const BOUND_TERMS: usize = 16;

/// The terms of degree 1, 3, 5 .. of `S d_a`, in the block's own directions.
fn operator(size: [f64; 3]) -> Vec<Homogeneous> {
    let sides = squares().into_iter().zip(size);
    let parts: Vec<_> = sides
        .map(|(square, length)| along(&square, BOUND_TERMS, length))
        .collect();
    let forms = composed(&parts, BOUND_TERMS);
    forms
        .iter()
        .map(|form| product(form, &[1.0, 1.0]))
        .collect()
}

/// The series of blocks of two sizes.
pub(in crate::potential) fn series(first: [f64; 3], second: [f64; 3]) -> Multipole {
    Multipole::new([&operator(first), &operator(second)], TERMS)
}

impl Sizes {
    fn new(first: [f64; 3], second: [f64; 3]) -> Self {
        let far = FarForm::new(series(first, second), HAND_OVER);
        let [first, second] = [first, second].map(|size| Block::new(1.0, size));
        Self {
            far,
            limits: BlockLimits::new(&first, &second),
            radii: first.radius() + second.radius(),
        }
    }
}

/// Blocks with the indices of their sizes, and the sizes.
fn by_size(magnets: &[Magnet]) -> (Vec<SizedBlock>, Vec<[f64; 3]>) {
    let mut sizes: Vec<[f64; 3]> = Vec::new();
    let mut number = |size| number_of(&mut sizes, |other| *other == size, |_| size);
    let blocks = magnets
        .iter()
        .map(|magnet| SizedBlock {
            block: Block::from(magnet),
            size: number(magnet.size),
        })
        .collect();
    (blocks, sizes)
}

/// Blocks sorted by size and by axis (up to its sign).
fn groups(blocks: &[SizedBlock]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (member, SizedBlock { block, size }) in blocks.iter().enumerate() {
        let axis = Complex::new(block.axis.x, block.axis.y);
        let same = |group: &Group| {
            group.size == *size && (axis * group.axis.conj()).im.abs() < SAME_DIRECTION
        };
        let number = number_of(&mut groups, same, |_| Group::new(*size, block.axis));
        let along = (axis * groups[number].axis.conj()).re.signum();
        groups[number].push(member, block.position, along * block.moment);
    }
    groups
}

/// Block number `at` of a group of the tile's blocks: with the group's axis and the moment along it.
#[inline(always)]
fn member(group: &Group, blocks: &[SizedBlock], at: usize) -> Block {
    Block {
        axis: Vector2::new(group.axis.re, group.axis.im),
        moment: group.moment[at],
        ..blocks[group.members[at]].block
    }
}

/// Axes that differ by less than this (rad) count as equal in the far form.
const SAME_DIRECTION: f64 = 1e-12;

impl CuboidPotential {
    /// The potential of two tiles' magnets, for the fastest instruction set of this machine.
    pub fn new(fixed: &[Magnet], moving: &[Magnet]) -> Self {
        Self::with_level(fixed, moving, Level::best())
    }

    /// The potential of two tiles' magnets, for the given instruction set.
    pub fn with_level(fixed: &[Magnet], moving: &[Magnet], level: Level) -> Self {
        let lever = Lever::of(moving.iter().flat_map(|magnet| magnet.corners()));
        let dipoles = DipolePotential::with_level(&dipoles(fixed), &dipoles(moving), level);
        let ((fixed, fixed_sizes), (moving, moving_sizes)) = (by_size(fixed), by_size(moving));
        let (mut fixed_groups, moving_groups) = (groups(&fixed), groups(&moving));
        for group in &mut fixed_groups {
            group.fill();
        }
        let sizes: Vec<Vec<Sizes>> = fixed_sizes
            .iter()
            .map(|first| {
                moving_sizes
                    .iter()
                    .map(|second| Sizes::new(*first, *second))
                    .collect()
            })
            .collect();
        let field = BlockField::new((&fixed, &fixed_groups), (&moving, &moving_sizes), level);
        let many = Many::new([&fixed, &moving], [&fixed_groups, &moving_groups], &sizes);
        Self {
            level,
            fixed,
            moving,
            fixed_groups,
            moving_groups,
            sizes,
            many,
            field: field.map(Arc::new),
            dipoles,
            lever,
        }
    }
}

impl CuboidPotential {
    /// The distance (m) between centres beyond which the multipole series replaces every pair of
    /// blocks.
    pub(in crate::potential) fn hand_over(&self) -> f64 {
        let all = self.sizes.iter().flatten();
        all.map(|sizes| sizes.far.near().sqrt()).fold(0.0, f64::max)
    }

    /// The bounds of the derivatives of the fixed block `i` and the moving block `j`, for moments of
    /// 1 A m^2.
    pub(in crate::potential) fn limits(&self, i: usize, j: usize) -> &BlockLimits {
        &self.sizes[self.fixed[i].size][self.moving[j].size].limits
    }

    /// Two groups at a configuration with this rotation.
    #[inline(always)]
    fn facing<'a>(
        &'a self,
        groups: [&'a Group; 2],
        q: &Configuration,
        rotation: Complex<f64>,
    ) -> Facing<'a> {
        let sizes = &self.sizes[groups[0].size][groups[1].size];
        Facing::new(&sizes.far, groups, q, rotation)
    }

    /// The energies of all pairs of blocks; the pair of the fixed tile's block i and the moving
    /// tile's block j has the index `j * fixed blocks + i`. Derivatives are zero unless requested.
    pub fn pairs<const SLOPE: bool>(&self, q: &Configuration) -> Vec<PairEnergy> {
        let mut out = vec![PairEnergy::default(); self.fixed.len() * self.moving.len()];
        self.level.run(Each::<SLOPE> {
            potential: self,
            q,
            out: &mut out,
        });
        out
    }
}

impl Potential for CuboidPotential {
    fn energy(&self, q: &Configuration) -> f64 {
        self.level.run(BlockSum::<false> { potential: self, q }).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        self.level.run(BlockSum::<true> { potential: self, q })
    }

    /// See [`limits`] for the bounds and their proofs. If pole faces may come closer than a
    /// sixteenth of the reach, the second derivative has no bound, because it grows like the
    /// logarithm of their distance; the value returned is the bound at a sixteenth of the reach,
    /// which holds for the average over a motion of that reach.
    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let (sin, cos) = libm::sincos(q.theta);
        let turn = self.lever.turn();
        let of_pair = |first: &SizedBlock, second: &SizedBlock| {
            let moved = second.block.moved(cos, sin, q.position());
            let Sizes { limits, radii, .. } = &self.sizes[first.size][second.size];
            let r = (moved.position - first.block.position).norm();
            let distance = r - radii - reach;
            let apart = limits.curvature(turn, distance);
            let strength = (first.block.moment * moved.moment).abs();
            strength
                * if distance > 2.0 * radii {
                    apart
                } else {
                    let distances = limits::face_distances(&first.block, &moved)
                        .map(|d| (d - reach).max(reach / 16.0));
                    apart.min(limits.curvature_of_faces(turn, distances))
                }
        };
        let Some(many) = &self.many else {
            let all = self.moving.iter();
            let pairs = all.flat_map(|second| self.fixed.iter().map(move |first| (first, second)));
            return pairs.fold(0.0, |sum, (first, second)| sum + of_pair(first, second));
        };
        let of_groups = |it: BlockGroups| {
            if let Some((moments, distance)) = it.whole {
                let limits = &self.sizes[it.fixed.size][it.moving.size].limits;
                return moments * limits.curvature(turn, distance);
            }
            let fixed = it.fixed.members.iter().map(|i| &self.fixed[*i]);
            let with_all = |j: &usize| {
                let pairs = fixed.clone().map(|first| of_pair(first, &self.moving[*j]));
                pairs.sum::<f64>()
            };
            it.moving.members.iter().map(with_all).sum()
        };
        let meetings = many.meetings(q, reach).map(of_groups);
        meetings.fold(0.0, |sum: f64, share: f64| sum + share)
    }

    /// That of dipoles as far apart as the blocks' nearest points. Known only if all blocks are
    /// farther apart than their own size: closer, the second derivative's bound is tighter.
    fn fourth_derivative_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let radii = self.sizes.iter().flatten().map(|sizes| sizes.radii);
        let radii = radii.fold(0.0, f64::max);
        let terms = motion::fourth_derivative(self.lever.turn());
        self.dipoles
            .derivative_bound(terms, q, [reach + radii, radii])
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        self.lever.displacement(step)
    }

    fn is_expensive(&self) -> bool {
        self.many.is_some()
    }

    /// Half the shortest side in the plane of any block.
    fn feature_length(&self) -> f64 {
        let blocks = self.fixed.iter().chain(&self.moving);
        let sides = blocks.flat_map(|each| [each.block.size[0], each.block.size[1]]);
        sides.fold(f64::INFINITY, f64::min) / 2.0
    }

    /// Measured at the worst place, where edges of touching blocks meet: 2e-7 between energies and
    /// the integral of the gradient.
    fn noise(&self) -> f64 {
        1e-6
    }
}
