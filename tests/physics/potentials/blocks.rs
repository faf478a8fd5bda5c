//! Uniformly magnetised blocks, tested by principle.

use nalgebra::Vector2;
use tilebind::Configuration;
use tilebind::potential::cuboid::{Block, exact};
use tilebind::potential::{CuboidPotential, DipolePotential, Potential};
use tilebind::tile::Magnet;
use tilebind::units::MU0_OVER_4PI;

use super::kinds::{OTHER, SIZE, magnet, odd_blocks};

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
    let kind = odd_blocks();
    let [fixed, moving] = kind.tiles.map(|tile| tile.magnets);
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
        for q in &kind.poses {
            let (a, ga) = whole.energy_and_gradient(q);
            let (b, gb) = cut.energy_and_gradient(q);
            let scale = ga.norm();
            assert!((a - b).abs() < 1e-6 * 0.01 * scale, "{q:?}: {a:e} {b:e}");
            assert!((ga - gb).norm() < 1e-6 * scale, "{q:?}: {ga} {gb}");
        }
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
