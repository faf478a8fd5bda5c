//! Uniformly magnetised blocks, tested by principle.

use nalgebra::{Matrix3, Vector2, Vector3};
use tilebind::Configuration;
use tilebind::potential::cuboid::block::{Block, exact};
use tilebind::potential::{CuboidPotential, DipolePotential, Potential};
use tilebind::tile::Magnet;
use tilebind::units::{MU0, MU0_OVER_4PI};

const SIZE: [f64; 3] = [0.010, 0.012, 0.003];
const OTHER: [f64; 3] = [0.006, 0.008, 0.005];

fn magnet(x: f64, y: f64, angle: f64, size: [f64; 3]) -> Magnet {
    Magnet {
        position: Vector2::new(x, y),
        angle,
        moment: 1.2 * size.iter().product::<f64>() / MU0,
        size,
        face: 0,
    }
}

/// A few magnets of two sizes at odd angles, in either tile.
fn tiles() -> (Vec<Magnet>, Vec<Magnet>) {
    (
        vec![
            magnet(0.020, 0.010, 0.1, SIZE),
            magnet(0.020, -0.010, 3.2, OTHER),
            magnet(-0.015, 0.012, 1.7, SIZE),
        ],
        vec![
            magnet(-0.020, 0.011, 0.2, OTHER),
            magnet(-0.019, -0.012, 2.9, SIZE),
        ],
    )
}

/// Poses from touching to far away.
fn poses() -> Vec<Configuration> {
    (0..40)
        .map(|i| {
            let t = i as f64;
            let distance = 0.0565 * 1.06f64.powi(i);
            Configuration::new(distance, 0.01 * (1.3 * t).sin(), 0.3 * (0.7 * t).cos())
        })
        .collect()
}

#[test]
fn the_far_field_is_the_dipoles_with_an_error_of_two_more_powers() {
    let (fixed, moving) = (
        [magnet(0.0, 0.0, 0.3, SIZE)],
        [magnet(0.0, 0.0, 0.0, OTHER)],
    );
    let blocks = CuboidPotential::new(&fixed, &moving);
    let dipoles = DipolePotential::new(&fixed, &moving);
    let error = |r: f64| {
        let q = Configuration::new(r * 0.8, r * 0.6, 1.0);
        blocks.energy(&q) / dipoles.energy(&q) - 1.0
    };
    for r in [0.2, 0.4, 0.8, 1.6] {
        let ratio = error(r) / error(2.0 * r);
        assert!((ratio - 4.0).abs() < 0.05, "{r}: {ratio}");
    }
    assert!(error(1.0).abs() < 1e-4);
}

#[test]
fn cutting_a_block_in_two_changes_nothing() {
    let (fixed, moving) = tiles();
    let whole = CuboidPotential::new(&fixed, &moving);
    for direction in 0..2 {
        let halves: Vec<Magnet> = moving
            .iter()
            .flat_map(|magnet| {
                let mut size = magnet.size;
                size[direction] /= 2.0;
                let axis = Vector2::new(magnet.angle.cos(), magnet.angle.sin());
                let shift = if direction == 0 {
                    axis * (size[0] / 2.0)
                } else {
                    Vector2::new(-axis.y, axis.x) * (size[1] / 2.0)
                };
                [1.0, -1.0].map(|sign| Magnet {
                    position: magnet.position + shift * sign,
                    moment: magnet.moment / 2.0,
                    size,
                    ..magnet.clone()
                })
            })
            .collect();
        let cut = CuboidPotential::new(&fixed, &halves);
        for q in poses() {
            let (a, ga) = whole.energy_and_gradient(&q);
            let (b, gb) = cut.energy_and_gradient(&q);
            let scale = ga.norm();
            assert!((a - b).abs() < 1e-6 * 0.01 * scale, "{q:?}: {a:e} {b:e}");
            assert!((ga - gb).norm() < 1e-6 * scale, "{q:?}: {ga} {gb}");
        }
    }
}

#[test]
fn energies_scale_with_the_volume_and_the_square_of_the_remanence() {
    let (fixed, moving) = tiles();
    let scaled = |magnets: &[Magnet], length: f64, strength: f64| -> Vec<Magnet> {
        magnets
            .iter()
            .map(|magnet| Magnet {
                position: magnet.position * length,
                size: magnet.size.map(|size| size * length),
                moment: magnet.moment * length.powi(3) * strength,
                ..magnet.clone()
            })
            .collect()
    };
    let small = CuboidPotential::new(&fixed, &moving);
    for length in [1e-3, 7.0] {
        let large =
            CuboidPotential::new(&scaled(&fixed, length, 1.0), &scaled(&moving, length, 0.5));
        for q in poses() {
            let energy = large.energy(&Configuration::new(q.x * length, q.y * length, q.theta));
            let expected = small.energy(&q) * length.powi(3) * 0.5;
            assert!((energy - expected).abs() < 1e-9 * expected.abs());
        }
    }
}

#[test]
fn action_equals_reaction() {
    let (fixed, moving) = tiles();
    let one = CuboidPotential::new(&fixed, &moving);
    let other = CuboidPotential::new(&moving, &fixed);
    for q in poses() {
        let (energy, gradient) = one.energy_and_gradient(&q);
        let (same, reaction) = other.energy_and_gradient(&q.inverse());
        let scale = gradient.xy().norm();
        assert!((energy - same).abs() < 1e-6 * 0.01 * scale);
        // The reaction, in the moving tile's frame, turned into the fixed tile's.
        let force = q.rotation() * reaction.xy();
        assert!((force + gradient.xy()).norm() < 2e-6 * scale, "{q:?}");
        let torque = reaction.z + gradient.z + q.position().perp(&gradient.xy());
        assert!(torque.abs() < 2e-6 * 0.05 * scale, "{q:?} {torque}");
    }
}

fn stepped(q: &Configuration, axis: usize, by: f64) -> Configuration {
    let mut step = Vector3::zeros();
    step[axis] = by;
    q.moved(step)
}

#[test]
fn force_and_torque_are_derivatives_and_the_force_has_no_curl() {
    let (fixed, moving) = tiles();
    let potential = CuboidPotential::new(&fixed, &moving);
    for q in poses() {
        let (_, gradient) = potential.energy_and_gradient(&q);
        let steps = [2e-5, 2e-5, 1e-3];
        let mut hessian = Matrix3::zeros();
        for axis in 0..3 {
            let at = |n: f64| potential.energy_and_gradient(&stepped(&q, axis, n * steps[axis]));
            let [(a, ga), (b, gb), (c, gc), (d, gd)] = [at(-2.0), at(-1.0), at(1.0), at(2.0)];
            let slope = (8.0 * (c - b) - (d - a)) / (12.0 * steps[axis]);
            let lever = if axis == 2 { 0.03 } else { 1.0 };
            let scale = gradient.xy().norm() * lever;
            assert!(
                (slope - gradient[axis]).abs() < 2e-5 * scale,
                "{q:?} {axis}"
            );
            let column = ((gc - gb) * 8.0 - (gd - ga)) / (12.0 * steps[axis]);
            hessian.set_column(axis, &column);
        }
        let curl = hessian - hessian.transpose();
        assert!(curl.norm() < 1e-4 * hessian.norm(), "{q:?} {hessian}");
    }
}

#[test]
fn the_hand_over_to_the_far_form_leaves_no_step() {
    let (fixed, moving) = ([magnet(0.0, 0.0, 0.0, SIZE)], [magnet(0.0, 0.0, 0.0, SIZE)]);
    let potential = CuboidPotential::new(&fixed, &moving);
    let mut seen = [false; 2];
    for i in 0..4000 {
        let r = 0.02 * 1.0008f64.powi(i);
        let q = Configuration::new(r * 0.9, r * 0.19f64.sqrt(), 0.8);
        let (energy, gradient) = potential.energy_and_gradient(&q);
        let moved = |magnet: &Magnet, x: f64, y: f64, turn: f64| {
            let mut block = Block::from(magnet).moved(turn.cos(), turn.sin(), Vector2::new(x, y));
            block.moment = magnet.moment;
            block
        };
        let pair = exact(
            &moved(&fixed[0], 0.0, 0.0, 0.0),
            &moved(&moving[0], q.x, q.y, q.theta),
        );
        // The far form's own error and the quadrature's; and what the pole faces, whose sum cancels
        // over each of the three sides twice, lose to rounding: a dozen times that, with a margin of
        // ten.
        let scale = MU0_OVER_4PI * fixed[0].moment.powi(2) / r.powi(3);
        let lost = f64::EPSILON * (r.powi(3) / SIZE.iter().product::<f64>()).powi(2);
        if r < 0.1 {
            assert!((energy - pair.energy).abs() < 4e-9 * scale, "{r}");
            assert!(
                (gradient.xy() - pair.gradient).norm() < (1e-8 + 120.0 * lost) * scale / r,
                "{r}"
            );
        }
        seen[usize::from(energy == pair.energy)] = true;
    }
    assert_eq!(seen, [true; 2], "both forms were met");
}

#[test]
fn energies_are_finite_wherever_the_tiles_are() {
    let (fixed, moving) = tiles();
    let potential = CuboidPotential::new(&fixed, &moving);
    for i in 0..2000 {
        let t = i as f64;
        let q = Configuration::new(
            0.05 * (0.9 * t).sin(),
            0.05 * (1.7 * t).cos(),
            3.0 * t.sin(),
        );
        let (energy, gradient) = potential.energy_and_gradient(&q);
        assert!(energy.is_finite() && gradient.iter().all(|g| g.is_finite()));
    }
    let on_itself = CuboidPotential::new(&fixed, &fixed);
    let (energy, gradient) = on_itself.energy_and_gradient(&Configuration::new(0.0, 0.0, 0.0));
    assert!(energy.is_finite() && gradient.iter().all(|g| g.is_finite()));
}

/// Face to face, magnetised along 10 mm the dipole is too weak near by, and through 3 mm it is
/// many times too strong.
#[test]
fn the_dipoles_error_near_contact_depends_on_the_direction_of_the_magnetisation() {
    let ratio = |size: [f64; 3], gap: f64| {
        let magnets = [magnet(0.0, 0.0, 0.0, size)];
        let q = Configuration::new(size[0] + gap, 0.0, 0.0);
        let dipole = DipolePotential::new(&magnets, &magnets).energy(&q);
        dipole / CuboidPotential::new(&magnets, &magnets).energy(&q)
    };
    // By the Coulomb law between Gauss grids of charges on the pole faces.
    for (size, gap, expected) in [
        ([0.010, 0.010, 0.003], 1e-3, 0.645_661_115_8),
        ([0.010, 0.010, 0.003], 5e-3, 0.816_286_358_6),
        ([0.003, 0.010, 0.010], 1e-3, 6.679_267_638),
        ([0.003, 0.010, 0.010], 5e-3, 2.406_813_614),
    ] {
        let ratio = ratio(size, gap);
        assert!(
            (ratio / expected - 1.0).abs() < 1e-6,
            "{size:?} {gap}: {ratio}"
        );
    }
}
