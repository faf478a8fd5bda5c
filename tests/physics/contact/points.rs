//! Points of contact against parry's distance, and properties that every point must have.

use std::sync::Arc;

use nalgebra::{Vector2, Vector3};
use ordered_float::OrderedFloat;
use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::query;
use parry2d_f64::shape::SharedShape;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::contact::{Contact, ContactPoint};
use tilebind::tile::{Outline, Pair};

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
    let cases = SHAPES
        .iter()
        .flat_map(|shape| [1e-3, 5e-3, 0.012, 0.025].map(|it| (shape, it)));
    for (shape, margin) in cases {
        let tiles = tiles(shape);
        let mut nonempty = 0;
        for q in tiles.near_contact(300) {
            let clearance = tiles.contact.clearance(&q);
            let points = tiles.points(&q, margin);
            let least = points.iter().map(|p| p.gap).fold(margin, f64::min);
            // Never more; less only where an edge's line goes on beyond a notch, or past a corner.
            assert!(
                least <= clearance.min(margin) + 1e-9,
                "{shape} {margin} {q:?} {least} {clearance}"
            );
            assert!(least > -1e-9, "{shape} {margin} {q:?} {least} {clearance}");
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

/// A convex tile of 40 mm or so: a ring's sector, a square, or a triangle with a sharp corner.
fn convex(vertices: &[[f64; 2]]) -> (Contact, SharedShape) {
    let outline = Outline::new(vertices.iter().map(|it| Vector2::from(*it)).collect()).unwrap();
    let points = vertices.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
    let shape = SharedShape::convex_polyline_unmodified(points).unwrap();
    (Contact::new(&outline, &outline), shape)
}

const CONVEX: [&[[f64; 2]]; 3] = [
    &[
        [0.023, -0.0095],
        [0.0434, -0.018],
        [0.0434, 0.018],
        [0.023, 0.0095],
    ],
    &[[-0.02, -0.02], [0.02, -0.02], [0.02, 0.02], [-0.02, 0.02]],
    &[[0.0, 0.0], [0.04, 0.0], [0.035, 0.015]],
];

/// A corner of the moving tile beside a corner of the fixed one, with any orientation or with two edges that
/// are parallel but for a little.
fn corner_at_corner(contact: &Contact, size: f64, rng: &mut ChaCha8Rng) -> Configuration {
    let vertices = contact.fixed().vertices();
    let n = vertices.len();
    let [k, i] = [0, 1].map(|_| rng.random_range(0..n));
    let mut random = || rng.random_range(-1.0..1.0);
    let mut theta = 3.2 * random();
    if random() > 0.0 {
        let angle = |edge: usize| {
            let normal = contact.fixed().normals()[edge];
            normal.y.atan2(normal.x)
        };
        let edge = |at: usize, share: f64| if share > 0.0 { at } else { (at + n - 1) % n };
        let edges = [edge(k, random()), edge(i, random())];
        theta = std::f64::consts::PI + angle(edges[0]) - angle(edges[1]) + size * random();
    }
    let offset = vertices[k] + Vector2::new(random(), random()) * size;
    let turned = Configuration::new(0.0, 0.0, theta).rotation() * vertices[i];
    Configuration::new(offset.x - turned.x, offset.y - turned.y, theta)
}

fn nearest(contact: &Contact, q: &Configuration, margin: f64) -> Option<ContactPoint> {
    let points = contact.points(q, margin, &contact.near(q, 1.5 * margin));
    points.into_iter().min_by_key(|it| OrderedFloat(it.gap))
}

/// The distance by parry's search (Gilbert, Johnson and Keerthi).
#[test]
fn the_least_gap_at_corners_is_the_distance() {
    let margin = 5e-4;
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    for vertices in CONVEX {
        let (contact, shape) = convex(vertices);
        let mut apart = 0;
        for _ in 0..6000 {
            let size = 10f64.powf(rng.random_range(-6.0..-3.3));
            let q = corner_at_corner(&contact, size, &mut rng);
            let pose = Pose::new(Vector::new(q.x, q.y), q.theta);
            let distance =
                query::distance(&Pose::identity(), shape.as_ref(), &pose, shape.as_ref()).unwrap();
            let distance = distance.distance;
            if !(1e-8..0.9 * margin).contains(&distance) {
                continue;
            }
            apart += 1;
            let least = nearest(&contact, &q, margin).unwrap();
            assert!(
                (least.gap - distance).abs() < 1e-9,
                "{q:?} {least:?} {distance}"
            );
        }
        assert!(apart > 1000, "{apart}");
    }
}

/// Tiles that overlap at their corners have a point that says so, also where edges cross and no corner is inside
/// the other tile.
#[test]
fn overlaps_at_corners_are_seen() {
    let margin = 5e-4;
    let mut rng = ChaCha8Rng::seed_from_u64(14);
    for vertices in CONVEX {
        let (contact, _) = convex(vertices);
        let mut overlaps = 0;
        for _ in 0..6000 {
            let size = 10f64.powf(rng.random_range(-6.0..-3.3));
            let q = corner_at_corner(&contact, size, &mut rng);
            let clearance = contact.clearance(&q);
            if !(-0.1 * margin..-1e-8).contains(&clearance) {
                continue;
            }
            overlaps += 1;
            let least = nearest(&contact, &q, margin);
            assert!(
                least.is_some_and(|it| it.gap < 0.0),
                "{q:?} {clearance} {least:?}"
            );
        }
        assert!(overlaps > 500, "{overlaps}");
    }
}

/// The distance of two convex tiles has one gradient everywhere, whose direction turns by no more than the
/// tile moves over the distance: also past corners.
#[test]
fn gap_and_normal_change_steadily_past_corners() {
    let margin = 5e-4;
    let mut rng = ChaCha8Rng::seed_from_u64(13);
    for vertices in CONVEX {
        let (contact, _) = convex(vertices);
        let [mut steps, mut changes] = [0; 2];
        for _ in 0..200 {
            let size = 10f64.powf(rng.random_range(-5.0..-3.5));
            let start = corner_at_corner(&contact, size, &mut rng);
            if contact.clearance(&start) <= 0.0 {
                continue;
            }
            let angle = rng.random_range(-3.2..3.2);
            let step = Vector2::new(f64::cos(angle), f64::sin(angle)) * (0.02 * size);
            let path = (0..100).map(|k| start.moved((step * f64::from(k)).push(0.0)));
            let path = path.take_while(|q| contact.clearance(q) > 0.02 * size);
            let path: Vec<_> = path.map_while(|q| nearest(&contact, &q, margin)).collect();
            for pair in path.windows(2) {
                let [from, to] = [&pair[0], &pair[1]];
                let turn = (to.normal - from.normal).norm();
                let least = from.gap.min(to.gap);
                assert!(turn <= 1.01 * step.norm() / least + 1e-9, "{from:?} {to:?}");
                // The mean of both rates, with an error of second order in the step.
                let rate = 0.5 * (from.normal + to.normal).dot(&step);
                let error = (to.gap - from.gap - rate).abs();
                let most = step.norm_squared() / least + 1e-12;
                assert!(error <= most, "{error:e} {most:e} {from:?} {to:?}");
                steps += 1;
                changes += usize::from(from.turns_with != to.turns_with);
            }
        }
        assert!(steps > 3000 && changes > 20, "{steps} {changes}");
    }
}
