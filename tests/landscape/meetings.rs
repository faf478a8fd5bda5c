//! The faces that touch and the magnets that face each other, and the lowest energy over theta.

use nalgebra::{Rotation2, Vector2};
use std::f64::consts::PI;
use tilebind::landscape::map::{EnergyMap, Window};
use tilebind::landscape::meeting::{magnet_pairs, touching_faces};
use tilebind::tile::Tile;
use tilebind::{Configuration, Design};

use crate::designs;

/// The moving tile with one of its faces flush on one of the fixed tile's, slid along it.
fn flush(design: &Design, [fixed, moving]: [usize; 2], slide: f64) -> Configuration {
    let pair = &design.pair;
    let (to, from) = (&pair.fixed.faces[fixed], &pair.moving.faces[moving]);
    let (n, m) = (to.normal(), from.normal());
    let theta = n.y.atan2(n.x) - m.y.atan2(m.x) + PI;
    let middle = (from.start + from.end) / 2.0;
    let place = (to.start + to.end) / 2.0 - Rotation2::new(theta) * middle;
    let place = place + Vector2::new(-n.y, n.x) * slide;
    Configuration::new(place.x, place.y, theta)
}

#[test]
fn flush_faces_are_those_that_touch() {
    let design = designs::load("shapes/paper-tile.toml");
    let (problem, pair) = (design.problem(), &design.pair);
    let contact = problem.contact.as_ref().expect("tiles have outlines");
    for faces in (0..16).map(|k| [k / 4, k % 4]) {
        for slide in [0.0, 0.05, -0.2] {
            let q = flush(&design, faces, slide);
            let found = touching_faces(contact, &pair.fixed, &pair.moving, &q);
            assert_eq!(found, [(faces[0], faces[1])], "{slide}");
        }
        let q = flush(&design, faces, 0.0);
        let apart = Configuration::new(1.01 * q.x, 1.01 * q.y, q.theta);
        assert_eq!(
            touching_faces(contact, &pair.fixed, &pair.moving, &apart),
            []
        );
    }
}

/// Pairs that attract and that repel, of those with a tenth of the strongest one's energy, by the
/// textbook's formula.
fn plain_pairs(fixed: &Tile, moving: &Tile, q: &Configuration) -> (usize, usize) {
    let direction = |angle: f64| Vector2::new(angle.cos(), angle.sin());
    let mut energies = Vec::new();
    for a in &fixed.magnets {
        for b in &moving.magnets {
            let r = q.transform(b.position) - a.position;
            let (m, n) = (
                direction(a.angle) * a.moment,
                direction(b.angle + q.theta) * b.moment,
            );
            let along = r.normalize();
            let dipoles = m.dot(&n) - 3.0 * m.dot(&along) * n.dot(&along);
            energies.push(dipoles / r.norm().powi(3));
        }
    }
    let strongest = energies.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let count = |sign: f64| {
        energies
            .iter()
            .filter(|u| sign * **u >= 0.1 * strongest)
            .count()
    };
    (count(-1.0), count(1.0))
}

#[test]
fn magnets_that_attract_and_repel_are_counted() {
    let design = designs::load("shapes/paper-tile.toml");
    let pair = &design.pair;
    for faces in (0..16).map(|k| [k / 4, k % 4]) {
        for slide in [0.0, 0.04, -0.08, 0.017] {
            let q = flush(&design, faces, slide);
            let found = magnet_pairs(&pair.fixed, &pair.moving, &q);
            assert_eq!(
                found,
                plain_pairs(&pair.fixed, &pair.moving, &q),
                "{faces:?}"
            );
        }
    }
    assert_eq!(magnet_pairs(&pair.fixed, &pair.moving, &pair.bound), (4, 0));
}

#[test]
fn maps_show_the_lowest_energy_over_theta_and_where_the_blocked_region_ends() {
    let design = designs::load("shapes/paper-tile.toml");
    let problem = design.problem();
    // Along the normal of a face, and beside it; not on the axis, where borders meet grid points.
    let window = Window {
        origin: Vector2::zeros(),
        angle: 0.0,
        low: [0.364, -0.1],
        high: [0.524, 0.1],
        samples: [33, 5],
    };
    let map = EnergyMap::new(&problem, &window, 90);
    let spacing = 0.16 / 32.0;
    let (mut free, mut blocked) = (0, 0);
    for (row, y) in map.lowest.y.iter().enumerate() {
        for (column, x) in map.lowest.x.iter().enumerate() {
            let at = |k: usize| Configuration::new(*x, *y, k as f64 * PI / 1800.0 - PI);
            let plain = (0..3600).map(at).filter(|q| problem.is_clear(q));
            let plain = plain.map(|q| problem.potential().energy(&q));
            let plain = plain.fold(f64::INFINITY, f64::min);
            let border = map.border_distance[row * 33 + column];
            assert!(border.abs() <= spacing + 1e-12);
            let Some(lowest) = map.lowest.value(column, row) else {
                blocked += 1;
                assert!(border <= 0.0 && plain.is_infinite(), "{x} {y}");
                // The border is straight there; tilted tiles meet it a little sooner.
                assert!(
                    (border - (x - 0.43).max(-spacing)).abs() < spacing / 2.0,
                    "{x} {y}"
                );
                continue;
            };
            free += 1;
            let q = lowest.configuration;
            assert!(problem.is_clear(&q) && (q.x - x).hypot(q.y - y) < 1e-12);
            assert_eq!(lowest.energy, problem.potential().energy(&q));
            let close = 5e-3 * problem.depth();
            assert!(
                lowest.energy <= plain + close,
                "{x} {y}: {} {plain}",
                lowest.energy
            );
            assert!(
                (border - (x - 0.43).min(spacing)).abs() < spacing / 2.0,
                "{x} {y}: {border}"
            );
        }
    }
    assert!(free > 60 && blocked > 50, "{free} {blocked}");
}
