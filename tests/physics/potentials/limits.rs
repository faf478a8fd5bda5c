//! Bounds of a pair of blocks' energy and its derivatives.

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::potential::Potential;
use tilebind::potential::cuboid::CuboidPotential;
use tilebind::potential::cuboid::limits::{BlockLimits, face_distances};
use tilebind::potential::cuboid::{Block, exact};
use tilebind::tile::{Magnet, Tile};

use crate::designs;

fn random_pair(rng: &mut ChaCha8Rng, gap: f64) -> (Block, Block) {
    let first = Block::new(0.3, [0.010, 0.012, 0.003]);
    let size = [0.008, 0.007, 0.005];
    let angle: f64 = rng.random_range(-3.2..3.2);
    let reach = (size[0] * angle.cos().abs() + size[1] * angle.sin().abs()) / 2.0;
    let second = Block {
        position: Vector2::new(0.005 + gap + reach, rng.random_range(-0.012..0.012)),
        axis: Vector2::new(angle.cos(), angle.sin()),
        ..Block::new(0.2, size)
    };
    (first, second)
}

fn moved(block: &Block, step: Vector2<f64>) -> Block {
    Block {
        position: block.position + step,
        ..*block
    }
}

#[test]
fn energies_and_gradients_stay_below_their_bounds() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for gap in [0.0, 1e-4, 1e-3, 1e-2, 5e-2, 0.3] {
        for _ in 0..100 {
            let (first, second) = random_pair(&mut rng, gap);
            let limits = BlockLimits::new(&first, &second);
            let pair = exact(&first, &second);
            assert!(pair.energy.abs() <= limits.energy(gap));
            assert!(pair.gradient.norm() <= limits.gradient(0.0, gap));
        }
    }
}

#[test]
fn the_bound_of_the_energy_is_attained_by_a_block_on_its_own_copy() {
    let block = Block::new(0.3, [0.010, 0.012, 0.003]);
    let limits = BlockLimits::new(&block, &block);
    let energy = exact(&block, &block).energy;
    assert!(energy <= limits.energy(0.0) && energy > 0.999 * limits.energy(0.0));
}

#[test]
fn second_differences_stay_below_their_bounds() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for gap in [3e-4, 1e-3, 5e-3, 3e-2] {
        for _ in 0..100 {
            let (first, second) = random_pair(&mut rng, gap);
            let limits = BlockLimits::new(&first, &second);
            let h = 0.1 * gap;
            let direction: f64 = rng.random_range(-3.2..3.2);
            let step = Vector2::new(direction.cos(), direction.sin()) * h;
            let at = |t: f64| exact(&first, &moved(&second, step * t));
            let second_derivative =
                (at(1.0).gradient - at(-1.0).gradient).dot(&step) / (2.0 * h * h);
            let distances = face_distances(&first, &second).map(|d| d - h);
            let bound = limits.curvature_of_faces(0.0, distances);
            assert!(second_derivative.abs() <= bound, "{gap}");
            assert!(second_derivative.abs() <= limits.curvature(0.0, gap - h));
        }
    }
}

/// Head on and far apart, blocks are dipoles: U = -2 K / r^3, its fourth derivative 6! K / r^7. Turning
/// adds to it. Twice the moment has twice the energy, and twice the bound.
#[test]
fn the_fourth_derivative_s_bound_holds_far_apart_and_is_as_the_moment() {
    let pair = designs::load("shapes/one-face.toml").pair;
    let alone = |tile: &Tile, times: f64| {
        let first = &tile.magnets[0];
        [Magnet {
            position: Vector2::zeros(),
            angle: 0.0,
            moment: times * first.moment,
            ..first.clone()
        }]
    };
    let (fixed, moving) = (alone(&pair.fixed, 1.0), alone(&pair.moving, 1.0));
    let potential = CuboidPotential::new(&fixed, &moving);
    let twice = CuboidPotential::new(&fixed, &alone(&pair.moving, 2.0));
    let strength = 1e-7 * fixed[0].moment * moving[0].moment;
    for r in [0.2, 1.0, 2.0] {
        let reach = 0.1;
        let at = Configuration::new(r, 0.0, 0.0);
        let nearest = 720.0 * strength / (r - reach).powi(7);
        let bound = potential.fourth_derivative_bound(&at, reach);
        assert!(bound >= nearest, "{bound} {nearest}");
        let doubled = twice.fourth_derivative_bound(&at, reach);
        assert!((doubled / bound - 2.0).abs() < 1e-12, "{bound} {doubled}");
    }
    // Where the blocks may meet there is none.
    let near = Configuration::new(0.02, 0.0, 0.0);
    assert_eq!(potential.fourth_derivative_bound(&near, 0.1), f64::INFINITY);
}
