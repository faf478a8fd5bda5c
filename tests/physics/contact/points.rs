//! Points of contact against parry's distance, and properties that every point must have.

use std::sync::Arc;

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::contact::{Contact, ContactPoint};
use tilebind::tile::Pair;

use crate::designs;

const SHAPES: [&str; 6] = [
    "paper-tile",
    "arc-20mm",
    "dovetail",
    "sine-teeth-20mm",
    "square-teeth-10mm",
    "triangle-teeth-10mm",
];

struct Tiles {
    pair: Arc<Pair>,
    contact: Contact,
}

fn tiles(shape: &str) -> Tiles {
    let pair = designs::load(&format!("shapes/{shape}.toml")).pair;
    let (fixed, moving) = (&pair.fixed.outline, &pair.moving.outline);
    Tiles {
        contact: Contact::new(fixed, moving),
        pair,
    }
}

impl Tiles {
    fn points(&self, q: &Configuration, margin: f64) -> Vec<ContactPoint> {
        let pairs = self.contact.near(q, 1.5 * margin);
        self.contact.points(q, margin, &pairs)
    }

    /// Free configurations about the bond, from flush to a few millimetres away and askew, and
    /// beside any face.
    fn near_contact(&self, count: usize) -> Vec<Configuration> {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let mut found = Vec::new();
        while found.len() < count {
            let size = 10f64.powf(rng.random_range(-5.0..-2.0));
            let mut random = || rng.random_range(-1.0..1.0);
            let out = self.pair.bound.position().normalize() * size;
            let askew = Vector3::new(random(), random(), random()) * (0.1 * size);
            let mut q = self
                .pair
                .bound
                .moved(Vector3::new(out.x, out.y, 0.0) + askew);
            if self.contact.clearance(&q) <= 0.0 {
                // Steep flanks only allow the tile to move straight out.
                q = self.pair.bound.moved(Vector3::new(out.x, out.y, 0.0));
            }
            if found.len() % 2 == 0 {
                // Approaches until it touches, then moves back a little.
                let angle = 3.2 * random();
                let away = Vector2::new(angle.cos(), angle.sin());
                let turned = Configuration::new(0.0, 0.0, 3.2 * random());
                let Some(t) = self.contact.landing(&turned, away) else {
                    continue;
                };
                let at = away * (t + size);
                q = Configuration::new(at.x, at.y, turned.theta);
            }
            if self.contact.clearance(&q) > 0.0 {
                found.push(q);
            }
        }
        found
    }
}

#[test]
fn the_nearest_point_is_as_far_as_the_tiles_are() {
    let margin = 1e-3;
    for shape in SHAPES {
        let tiles = tiles(shape);
        let mut nonempty = 0;
        for q in tiles.near_contact(300) {
            let clearance = tiles.contact.clearance(&q);
            let points = tiles.points(&q, margin);
            let least = points.iter().map(|p| p.gap).fold(margin, f64::min);
            // Never more; less only where an edge's line goes on beyond a notch, or past a corner.
            assert!(
                least <= clearance.min(margin) + 1e-9,
                "{shape} {q:?} {least} {clearance}"
            );
            assert!(least > -1e-9, "{shape} {q:?} {least} {clearance}");
            nonempty += usize::from(!points.is_empty());
        }
        assert!(nonempty > 100, "{shape}: {nonempty}");
    }
}

#[test]
fn points_lie_on_the_outlines_and_apart_along_their_normals() {
    for shape in SHAPES {
        let tiles = tiles(shape);
        for q in tiles.near_contact(100) {
            for point in tiles.points(&q, 5e-4) {
                let away = point.on_moving - point.on_fixed();
                assert!((point.normal.norm() - 1.0).abs() < 1e-12);
                assert!(
                    (away - point.normal * point.gap).norm() < 1e-12,
                    "{point:?}"
                );
                // One is a corner of its tile; the other lies on its edge or on the edge's line.
                let fixed = tiles.pair.fixed.outline.signed_distance(point.on_fixed());
                let on_moving = q.inverse_transform(point.on_moving);
                let moving = tiles.pair.moving.outline.signed_distance(on_moving);
                assert!(
                    fixed.abs() < 1e-9 || moving.abs() < 1e-9,
                    "{shape} {point:?}"
                );
            }
        }
    }
}

#[test]
fn swapping_the_tiles_swaps_the_points() {
    for shape in SHAPES {
        let tiles = tiles(shape);
        let (fixed, moving) = (tiles.contact.fixed(), tiles.contact.moving());
        let swapped = Contact::new(moving, fixed);
        for q in tiles.near_contact(40) {
            let back = q.inverse();
            let here = tiles.points(&q, 5e-4);
            let there = swapped.points(&back, 5e-4, &swapped.near(&back, 1e-3));
            assert_eq!(here.len(), there.len(), "{shape} {q:?}");
            let sum = |points: &[ContactPoint]| points.iter().map(|p| p.gap).sum::<f64>();
            assert!((sum(&here) - sum(&there)).abs() < 1e-9, "{shape} {q:?}");
        }
    }
}

#[test]
fn a_motion_that_closes_no_gap_leaves_the_tiles_apart() {
    // Straight motions shorter than half the margin that all points allow overlap no more than the
    // turn of the normals makes up for.
    let margin = 1e-3;
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    for shape in SHAPES {
        let tiles = tiles(shape);
        let mut tried = 0;
        for q in tiles.near_contact(200) {
            let points = tiles.points(&q, margin);
            for _ in 0..10 {
                let mut random = || rng.random_range(-1.0..1.0);
                let step = Vector3::new(random(), random(), 2.0 * random()) * 1.5e-4;
                let allowed = points.iter().all(|p| {
                    let arm = p.on_moving - q.position();
                    let way = step.xy() + Vector2::new(-arm.y, arm.x) * step.z;
                    p.normal.dot(&way) >= -p.gap
                });
                if allowed {
                    tried += 1;
                    let depth = -tiles.contact.clearance(&q.moved(step));
                    assert!(depth < 3e-7, "{shape} {q:?} {step:?} {depth}");
                }
            }
        }
        assert!(tried > 500, "{shape}: {tried}");
    }
}
