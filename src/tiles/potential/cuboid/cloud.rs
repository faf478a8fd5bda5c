//! A brute-force reference for tests: every pole face as a Gauss grid of point charges.

use nalgebra::{Vector2, Vector3};

use super::block::Block;
use super::quadrature::gauss_legendre;
use crate::potential::far::PairEnergy;
use crate::units::MU0_OVER_4PI;

/// The charges (A m) of a block, N x N on each pole face, and their places (m).
fn charges<const N: usize>(block: &Block) -> Vec<(f64, Vector3<f64>)> {
    let across = Vector2::new(-block.axis.y, block.axis.x);
    let [nodes, weights] = gauss_legendre::<N>();
    let mut charges = Vec::new();
    for sign in [-1.0, 1.0] {
        for (u, wu) in nodes.iter().zip(&weights) {
            for (v, wv) in nodes.iter().zip(&weights) {
                let place = block.position
                    + block.axis * (sign * block.size[0] / 2.0)
                    + across * (u * block.size[1] / 2.0);
                let height = v * block.size[2] / 2.0;
                let charge = sign * block.moment / block.size[0] * wu * wv / 4.0;
                charges.push((charge, Vector3::new(place.x, place.y, height)));
            }
        }
    }
    charges
}

/// Energy, gradient and slope of two blocks by Coulomb's law.
pub fn energy_and_gradient<const N: usize>(first: &Block, second: &Block) -> PairEnergy {
    let mut total = PairEnergy::default();
    for (q1, r1) in charges::<N>(first) {
        for (q2, r2) in charges::<N>(second) {
            let d = r2 - r1;
            let energy = MU0_OVER_4PI * q1 * q2 / d.norm();
            let gradient = -d.xy() * (energy / d.norm_squared());
            total.energy += energy;
            total.gradient += gradient;
            total.slope += (r2.xy() - second.position).perp(&gradient);
        }
    }
    total
}
