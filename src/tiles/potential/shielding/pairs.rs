//! Pairs of magnets that are not point dipoles in the tiles' plane, without their shields.

use super::kernel::PairColumns;
use crate::configuration::Configuration;
use crate::potential::cuboid::block::Block;
use crate::potential::cuboid::limits::{BlockLimits, face_distances};
use crate::potential::simd::Level;
use crate::potential::{BodyPotential, CuboidPotential, Potential};
use crate::tile::Magnet;

/// The pairs of two tiles' magnets.
#[derive(Clone, Debug)]
pub(super) enum Bare {
    /// Of blocks that lie flat.
    Blocks(Box<Blocks>),
    /// Of any other magnets.
    Bodies(Box<BodyPotential>),
}

/// Blocks that lie flat.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    potential: CuboidPotential,
    fixed: Vec<Block>,
    moving: Vec<Block>,
    /// For each pair, in the order of the second magnets.
    limits: Vec<BlockLimits>,
}

impl Bare {
    pub fn blocks(fixed: &[Magnet], moving: &[Magnet], level: Level) -> Self {
        let blocks = |magnets: &[Magnet]| magnets.iter().map(Block::from).collect::<Vec<_>>();
        let (first, second) = (blocks(fixed), blocks(moving));
        let limits = second
            .iter()
            .flat_map(|second| first.iter().map(|first| BlockLimits::new(first, second)));
        Self::Blocks(Box::new(Blocks {
            potential: CuboidPotential::with_level(fixed, moving, level),
            limits: limits.collect(),
            fixed: first,
            moving: second,
        }))
    }

    /// The energy of all pairs together.
    pub fn potential(&self) -> &dyn Potential {
        match self {
            Self::Blocks(blocks) => &blocks.potential,
            Self::Bodies(bodies) => &**bodies,
        }
    }

    /// The energies of the pairs of `fixed` magnets with the moving ones, in columns of the given stride.
    pub fn pairs<const SLOPE: bool>(
        &self,
        q: &Configuration,
        fixed: usize,
        stride: usize,
    ) -> PairColumns {
        let pairs = match self {
            Self::Blocks(blocks) => blocks.potential.pairs::<SLOPE>(q),
            Self::Bodies(bodies) => bodies.pairs(q),
        };
        PairColumns::new(&pairs, fixed, stride)
    }

    /// Bounds within a reach (m) of |u| (J), |u'| (J/m) and |u''| (J/m^2) of each pair along motions in which no
    /// point is faster than 1 and magnets turn at most at the rate `turn` (1/m), in columns of the given length and
    /// stride.
    pub fn limits(
        &self,
        q: &Configuration,
        [turn, reach]: [f64; 2],
        [length, stride]: [usize; 2],
    ) -> [Vec<f64>; 3] {
        let mut columns = [(); 3].map(|()| vec![0.0; length]);
        let mut put = |[i, j]: [usize; 2], row: [f64; 3]| {
            for (column, entry) in columns.iter_mut().zip(row) {
                column[j * stride + i] = entry;
            }
        };
        match self {
            Self::Blocks(blocks) => blocks.each_limits(q, turn, reach, put),
            Self::Bodies(bodies) => {
                let each = bodies.pair_limits(q, turn, reach);
                each.for_each(|(numbers, row)| put(numbers, row));
            }
        }
        columns
    }
}

impl Blocks {
    /// Calls `put` with the numbers of each pair and its bounds, see [`BlockLimits`].
    fn each_limits(
        &self,
        q: &Configuration,
        turn: f64,
        reach: f64,
        mut put: impl FnMut([usize; 2], [f64; 3]),
    ) {
        let (sin, cos) = libm::sincos(q.theta);
        let mut limits = self.limits.iter();
        for (j, second) in self.moving.iter().enumerate() {
            let moved = second.moved(cos, sin, q.position());
            for (i, (first, limits)) in self.fixed.iter().zip(limits.by_ref()).enumerate() {
                let r = (moved.position - first.position).norm() - reach;
                let distance = r - first.radius() - moved.radius();
                let faces = face_distances(first, &moved).map(|d| (d - reach).max(reach / 16.0));
                let bend = limits.curvature(turn, distance);
                put(
                    [i, j],
                    [
                        limits.energy(distance),
                        limits.gradient(turn, distance),
                        bend.min(limits.curvature_of_faces(turn, faces)),
                    ],
                );
            }
        }
    }
}
