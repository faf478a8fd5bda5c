//! Uniformly magnetised blocks.

pub mod block;
#[cfg(test)]
mod cloud;
mod elementary;
mod far;
mod multipole;
mod panel;
mod quadrature;
mod sheet;

mod sum;

use nalgebra::{Complex, Vector3};

use super::Potential;
use super::batch::Level;
use crate::configuration::Configuration;
use crate::tile::Magnet;
pub use block::{Block, PairEnergy};
use far::Group;
use multipole::{Multipole, TERMS};
use sum::Sum;

/// The relative error of a pair (in units of `mu0 m1 m2 / (4 pi r^3)`) at which the far form takes
/// over from the pole faces, and at which it drops its terms one after the other.
const HAND_OVER: f64 = 1e-9;

/// The interaction energy of two sets of uniformly magnetised blocks, one in each tile.
#[derive(Clone, Debug)]
pub struct CuboidPotential {
    level: Level,
    fixed: Vec<Block>,
    moving: Vec<Block>,
    fixed_groups: Vec<Group>,
    moving_groups: Vec<Group>,
    /// For each size of a fixed block and each size of a moving one.
    far: Vec<Vec<Far>>,
    lever: f64,
}

/// The far form of blocks of two sizes.
#[derive(Clone, Debug)]
struct Far {
    series: Multipole,
    /// The squared distances (m^2) from which on 0, 1, 2 .. terms are enough.
    squares: [f64; TERMS + 1],
}

impl Far {
    fn new(first: [f64; 3], second: [f64; 3]) -> Self {
        let series = Multipole::new(first, second);
        let square = |terms| match terms {
            0 => f64::INFINITY,
            terms => series.radius(terms, HAND_OVER).powi(2),
        };
        Self {
            squares: std::array::from_fn(square),
            series,
        }
    }

    /// The squared distance below which the pole faces are summed.
    fn near(&self) -> f64 {
        self.squares[TERMS]
    }

    /// How many terms are enough at a squared distance.
    fn terms(&self, square: f64) -> usize {
        let mut terms = TERMS;
        while terms > 1 && square >= self.squares[terms - 1] {
            terms -= 1;
        }
        terms
    }
}

/// Blocks sorted by size and by axis (up to its sign), and the sizes.
fn groups(blocks: &[Block]) -> (Vec<Group>, Vec<[f64; 3]>) {
    let mut sizes: Vec<[f64; 3]> = Vec::new();
    let mut groups: Vec<Group> = Vec::new();
    for (member, block) in blocks.iter().enumerate() {
        let known = sizes.iter().position(|size| *size == block.size);
        let size = known.unwrap_or(sizes.len());
        if known.is_none() {
            sizes.push(block.size);
        }
        let axis = Complex::new(block.axis.x, block.axis.y);
        let same = |group: &Group| {
            group.size == size && (axis * group.axis.conj()).im.abs() < SAME_DIRECTION
        };
        let number = groups.iter().position(same).unwrap_or(groups.len());
        if number == groups.len() {
            groups.push(Group::new(size, block.axis));
        }
        let along = (axis * groups[number].axis.conj()).re.signum();
        groups[number].push(member, block.position, along * block.moment);
    }
    (groups, sizes)
}

/// Axes that differ by less (rad) are taken for the same in the far form.
const SAME_DIRECTION: f64 = 1e-12;

impl CuboidPotential {
    /// Of two tiles' magnets, for the fastest instruction set of this machine.
    pub fn new(fixed: &[Magnet], moving: &[Magnet]) -> Self {
        Self::with_level(fixed, moving, Level::best())
    }

    /// Of two tiles' magnets, for the given instruction set.
    pub fn with_level(fixed: &[Magnet], moving: &[Magnet], level: Level) -> Self {
        let lever = moving
            .iter()
            .flat_map(|magnet| magnet.corners())
            .map(|corner| corner.norm())
            .fold(0.0, f64::max);
        let blocks = |magnets: &[Magnet]| magnets.iter().map(Block::from).collect::<Vec<_>>();
        let (fixed, moving) = (blocks(fixed), blocks(moving));
        let (mut fixed_groups, fixed_sizes) = groups(&fixed);
        let (moving_groups, moving_sizes) = groups(&moving);
        for group in &mut fixed_groups {
            group.fill(level.width());
        }
        let far = fixed_sizes
            .iter()
            .map(|first| {
                moving_sizes
                    .iter()
                    .map(|second| Far::new(*first, *second))
                    .collect()
            })
            .collect();
        Self {
            level,
            fixed,
            moving,
            fixed_groups,
            moving_groups,
            far,
            lever,
        }
    }
}

impl Potential for CuboidPotential {
    fn energy(&self, q: &Configuration) -> f64 {
        self.level.run(Sum::<false> { potential: self, q }).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        self.level.run(Sum::<true> { potential: self, q })
    }

    fn curvature_bound(&self, _q: &Configuration, _reach: f64) -> f64 {
        f64::INFINITY
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.xy().norm() + self.lever * step.z.abs()
    }
}
