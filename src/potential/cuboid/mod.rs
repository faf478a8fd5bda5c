//! Uniformly magnetised blocks.

pub mod block;
#[cfg(test)]
mod cloud;
pub mod multipole;
mod quadrature;
mod sheet;

use nalgebra::Vector3;

use super::Potential;
use crate::configuration::Configuration;
use crate::tile::Magnet;
pub use block::{Block, PairEnergy};
use multipole::Multipole;

/// The relative error of a pair (in units of `mu0 m1 m2 / (4 pi r^3)`) at which the far form takes
/// over from the pole faces.
const HAND_OVER: f64 = 1e-9;

/// The interaction energy of two sets of uniformly magnetised blocks, one in each tile.
#[derive(Clone, Debug)]
pub struct CuboidPotential {
    fixed: Vec<Sized>,
    moving: Vec<Sized>,
    /// For each size of a fixed block and each size of a moving one, the far form and the squared
    /// distance from which on it is used.
    far: Vec<Vec<(f64, Multipole)>>,
    lever: f64,
}

/// A block and the number of its size.
#[derive(Clone, Copy, Debug)]
struct Sized {
    block: Block,
    size: usize,
}

fn by_size(magnets: &[Magnet]) -> (Vec<Sized>, Vec<[f64; 3]>) {
    let mut sizes: Vec<[f64; 3]> = Vec::new();
    let mut blocks = Vec::with_capacity(magnets.len());
    for magnet in magnets {
        let known = sizes.iter().position(|size| *size == magnet.size);
        let size = known.unwrap_or(sizes.len());
        if known.is_none() {
            sizes.push(magnet.size);
        }
        blocks.push(Sized {
            block: Block::from(magnet),
            size,
        });
    }
    (blocks, sizes)
}

impl CuboidPotential {
    pub fn new(fixed: &[Magnet], moving: &[Magnet]) -> Self {
        let lever = moving
            .iter()
            .flat_map(|magnet| magnet.corners())
            .map(|corner| corner.norm())
            .fold(0.0, f64::max);
        let ((fixed, fixed_sizes), (moving, moving_sizes)) = (by_size(fixed), by_size(moving));
        let far_form = |first: [f64; 3], second: [f64; 3]| {
            let series = Multipole::new(first, second);
            (series.radius(HAND_OVER).powi(2), series)
        };
        let far = fixed_sizes
            .iter()
            .map(|first| {
                moving_sizes
                    .iter()
                    .map(|second| far_form(*first, *second))
                    .collect()
            })
            .collect();
        Self {
            fixed,
            moving,
            far,
            lever,
        }
    }

    fn pair(&self, first: &Sized, second: &Sized) -> PairEnergy {
        let (limit, series) = &self.far[first.size][second.size];
        let r = second.block.position - first.block.position;
        if r.norm_squared() < *limit {
            block::energy_and_gradient(&first.block, &second.block)
        } else {
            series.energy_and_gradient(&first.block, &second.block)
        }
    }
}

impl Potential for CuboidPotential {
    fn energy(&self, q: &Configuration) -> f64 {
        self.energy_and_gradient(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let (sin, cos) = q.theta.sin_cos();
        let mut energy = 0.0;
        let mut gradient = Vector3::zeros();
        for second in &self.moving {
            let second = Sized {
                block: second.block.moved(cos, sin, q.position()),
                ..*second
            };
            let arm = second.block.position - q.position();
            for first in &self.fixed {
                let pair = self.pair(first, &second);
                energy += pair.energy;
                gradient += Vector3::new(
                    pair.gradient.x,
                    pair.gradient.y,
                    pair.slope + arm.perp(&pair.gradient),
                );
            }
        }
        (energy, gradient)
    }

    fn curvature_bound(&self, _q: &Configuration, _reach: f64) -> f64 {
        f64::INFINITY
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.xy().norm() + self.lever * step.z.abs()
    }
}
