//! Shielded tiles, tested by principle.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Vector2, Vector3};
use tilebind::Configuration;
use tilebind::potential::shielding::{Shield, ShieldRule, Shields};
use tilebind::potential::{
    CuboidPotential, DipolePotential, MagnetModel, Potential, ShieldedPotential,
};
use tilebind::tile::{Face, Magnet, Outline, Tile};

const SHIELD: Shield = Shield {
    attenuation: 0.9,
    length: 0.05,
    width: 0.2,
    front_gain: 1.0,
};

/// A square of 0.2 m with two magnets on each face.
fn tile(code: [f64; 2]) -> Tile {
    let half = 0.1;
    let corners = [[half, -half], [half, half], [-half, half], [-half, -half]]
        .map(|[x, y]| Vector2::new(x, y));
    let faces: Vec<Face> = (0..4)
        .map(|i| Face {
            name: i.to_string(),
            start: corners[i],
            end: corners[(i + 1) % 4],
        })
        .collect();
    let magnets = (0..4)
        .flat_map(|face| {
            let outwards = face as f64 * FRAC_PI_2;
            let frame = &faces[face];
            [-0.02, 0.02]
                .into_iter()
                .zip(code)
                .map(move |(s, pole)| Magnet {
                    position: frame.point(s, -0.005),
                    angle: if pole > 0.0 { outwards } else { outwards + PI },
                    moment: 0.3,
                    size: [0.010, 0.010, 0.003],
                    face,
                })
        })
        .collect();
    Tile {
        outline: Outline::new(corners.to_vec()).unwrap(),
        faces,
        magnets,
        mass: 0.1,
        thickness: 0.01,
    }
}

fn tiles() -> (Tile, Tile) {
    (tile([1.0, -1.0]), tile([1.0, 1.0]))
}

fn shields(rule: ShieldRule, shield: Option<Shield>) -> Shields {
    Shields {
        rule,
        fixed: vec![shield; 4],
        // One face of the moving tile goes without.
        moving: vec![shield, shield, None, shield],
    }
}

fn poses() -> Vec<Configuration> {
    (0..40)
        .map(|i| {
            let t = i as f64;
            Configuration::new(
                0.215 + 0.01 * t,
                0.1 * (0.9 * t).sin(),
                0.08 * (1.7 * t).cos(),
            )
        })
        .collect()
}

#[test]
fn without_shields_it_is_the_bare_model() {
    let (fixed, moving) = tiles();
    let none = shields(ShieldRule::Smooth, None);
    let bare: [Box<dyn Potential>; 2] = [
        Box::new(DipolePotential::new(&fixed.magnets, &moving.magnets)),
        Box::new(CuboidPotential::new(&fixed.magnets, &moving.magnets)),
    ];
    for (model, bare) in [MagnetModel::Dipole, MagnetModel::Cuboid]
        .into_iter()
        .zip(bare)
    {
        let potential = ShieldedPotential::new(model, &fixed, &moving, &none);
        for q in poses() {
            let (energy, gradient) = potential.energy_and_gradient(&q);
            let (expected, slope) = bare.energy_and_gradient(&q);
            assert!((energy - expected).abs() < 1e-8 * expected.abs());
            assert!((gradient - slope).norm() < 1e-8 * slope.norm());
        }
    }
}

#[test]
fn forces_and_torques_are_derivatives_and_bends_are_bounded() {
    let (fixed, moving) = tiles();
    let shields = shields(ShieldRule::Smooth, Some(SHIELD));
    for model in [MagnetModel::Dipole, MagnetModel::Cuboid] {
        let potential = ShieldedPotential::new(model, &fixed, &moving, &shields);
        let mut tightest = f64::INFINITY;
        for q in poses() {
            let (_, gradient) = potential.energy_and_gradient(&q);
            let scale = gradient.norm();
            for (axis, step) in [(0, 2e-5), (1, 2e-5), (2, 2e-4)] {
                let at = |n: f64| {
                    let mut d = Vector3::zeros();
                    d[axis] = n * step;
                    potential.energy(&q.moved(d))
                };
                let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
                assert!(
                    (slope - gradient[axis]).abs() < 2e-5 * scale,
                    "{model:?} {q:?} {axis}"
                );
            }
            let step = Vector3::new(3e-5, 4e-5, 1e-4);
            let along = |n: f64| potential.energy(&q.moved(step * n));
            let displacement = potential.displacement(step);
            let second = (along(1.0) - 2.0 * along(0.0) + along(-1.0)) / displacement.powi(2);
            assert!(second.abs() <= potential.curvature_bound(&q, displacement));
            let step = step * 10.0;
            let along = |n: f64| potential.energy(&q.moved(step * n));
            let displacement = potential.displacement(step);
            let third = along(2.0) - 2.0 * along(1.0) + 2.0 * along(-1.0) - along(-2.0);
            let third = third.abs() / (2.0 * displacement.powi(3));
            let bound = potential.bend_bounds(&q, 2.0 * displacement)[1];
            assert!(third <= bound, "{model:?} {q:?}: {third} {bound}");
            tightest = tightest.min(bound / third);
        }
        // A bound that lost its sense would be nowhere near.
        assert!(
            model == MagnetModel::Cuboid || tightest < 50.0,
            "{tightest}"
        );
    }
}

#[test]
fn a_closed_way_costs_nothing() {
    let (fixed, moving) = tiles();
    let shields = shields(ShieldRule::Smooth, Some(SHIELD));
    let potential = ShieldedPotential::new(MagnetModel::Dipole, &fixed, &moving, &shields);
    // Round a loop in x, y and theta, by the trapezoidal rule (exponentially accurate here).
    let at =
        |t: f64| Configuration::new(0.25 + 0.02 * t.cos(), 0.03 * t.sin(), 0.2 * (2.0 * t).sin());
    let steps = 400;
    let (mut work, mut travelled) = (0.0, 0.0);
    for i in 0..steps {
        let t = std::f64::consts::TAU * i as f64 / steps as f64;
        let velocity = Vector3::new(-0.02 * t.sin(), 0.03 * t.cos(), 0.4 * (2.0 * t).cos());
        let power = potential.energy_and_gradient(&at(t)).1.dot(&velocity);
        work += power;
        travelled += power.abs();
    }
    assert!(work.abs() < 1e-10 * travelled, "{work} of {travelled}");
}

/// Seen from the other tile the energy is the same, and so are the forces, turned: in a frame held
/// by the moving tile the fixed one stands at the inverse configuration.
#[test]
fn action_equals_reaction() {
    let (fixed, moving) = tiles();
    let shields = shields(ShieldRule::Smooth, Some(SHIELD));
    let exchanged = Shields {
        fixed: shields.moving.clone(),
        moving: shields.fixed.clone(),
        ..shields
    };
    for model in [MagnetModel::Dipole, MagnetModel::Cuboid] {
        let here = ShieldedPotential::new(model, &fixed, &moving, &shields);
        let there = ShieldedPotential::new(model, &moving, &fixed, &exchanged);
        for q in poses() {
            let (energy, gradient) = here.energy_and_gradient(&q);
            let (other, reaction) = there.energy_and_gradient(&q.inverse());
            assert!((energy - other).abs() < 1e-6 * energy.abs(), "{q:?}");
            // The reaction on the fixed tile, in the fixed tile's frame.
            let back = q.rotation() * Vector2::new(reaction.x, reaction.y);
            assert!(
                (back + gradient.xy()).norm() < 1e-5 * gradient.norm(),
                "{q:?}"
            );
            // The torques about the two reference points and the force's lever add up to nothing.
            let arm = q.position();
            let total = gradient.z + reaction.z + arm.perp(&gradient.xy());
            assert!(
                total.abs() < 1e-5 * gradient.norm(),
                "{model:?} {q:?} {total}"
            );
        }
    }
}

#[test]
fn the_nearest_face_rule_counts_one_pair_of_faces_and_jumps() {
    let (fixed, moving) = tiles();
    let shields = shields(ShieldRule::NearestFace, None);
    let potential = ShieldedPotential::new(MagnetModel::Dipole, &fixed, &moving, &shields);
    let on_face = |tile: &Tile, face: usize| -> Vec<Magnet> {
        let mine = tile.magnets.iter().filter(|magnet| magnet.face == face);
        mine.cloned().collect()
    };
    let east_west = DipolePotential::new(&on_face(&fixed, 0), &on_face(&moving, 2));
    let q = Configuration::new(0.22, 0.01, 0.02);
    let energy = potential.energy(&q);
    assert!((energy - east_west.energy(&q)).abs() < 1e-12 * energy.abs());

    // Near an eighth of a turn another face becomes the nearest: the energy steps, by as much
    // however finely the turn is sampled.
    let steepest = |step: f64| {
        let at = |n: i32| {
            let turn = PI / 4.0 + step * (f64::from(n) + 0.5);
            potential.energy(&Configuration::new(0.26, 0.01, turn))
        };
        let count = (0.2 / step) as i32;
        let steps = (-count..count).map(|n| (at(n + 1) - at(n)).abs());
        steps.fold(0.0, f64::max)
    };
    let (coarse, fine) = (steepest(4e-3), steepest(1e-5));
    assert!(fine > 0.5 * coarse && fine > 1e-7, "{coarse} J, {fine} J");
}
