//! Tiles that touch: clearance, motions, constraints and cells.

mod cells;
mod constraint;
mod distance;
mod lift;
mod matching;
mod motion;
mod points;
mod possible;
mod stretch;

use std::f64::consts::TAU;

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::contact::Contact;
use tilebind::tile::Outline;
use tilebind::tile::outline::distance_to_segment;

pub fn outline(points: &[[f64; 2]]) -> Outline {
    Outline::new(points.iter().map(|p| Vector2::new(p[0], p[1])).collect()).unwrap()
}

pub fn square(side: f64) -> Outline {
    let h = side / 2.0;
    outline(&[[-h, -h], [h, -h], [h, h], [-h, h]])
}

/// A regular polygon of this circumradius (m), an edge towards +x.
pub fn regular(sides: usize, radius: f64) -> Outline {
    let angle = |k: usize| (k as f64 - 0.5) * TAU / sides as f64;
    let vertex = |k: usize| [radius * angle(k).cos(), radius * angle(k).sin()];
    outline(&(0..sides).map(vertex).collect::<Vec<_>>())
}

/// A block with a saw blade on its right side, or its complement on the left one.
pub fn saw(left: bool) -> Outline {
    let teeth = 4;
    let mut points = Vec::new();
    for k in 0..teeth {
        let y = -0.2 + 0.1 * k as f64;
        points.push([0.2, y]);
        points.push([0.23, y + 0.05]);
    }
    points.push([0.2, 0.2]);
    if left {
        let mut mirrored = vec![[0.2, -0.2], [0.2, 0.2]];
        mirrored.extend(points.iter().rev().map(|p| [p[0] - 0.4, p[1]]));
        outline(&mirrored)
    } else {
        points.extend([[-0.2, 0.2], [-0.2, -0.2]]);
        outline(&points)
    }
}

/// A free configuration with the tiles at most slightly apart: moved together from a clear
/// configuration.
pub fn near_contact(contact: &Contact, rng: &mut ChaCha8Rng) -> Configuration {
    let (angle, theta) = (rng.random_range(-3.1..3.1f64), rng.random_range(-3.1..3.1));
    let (mut near, mut far) = (0.0, 2.0);
    for _ in 0..50 {
        let middle = (near + far) / 2.0;
        let q = Configuration::new(middle * angle.cos(), middle * angle.sin(), theta);
        if contact.is_free(&q) {
            far = middle
        } else {
            near = middle
        }
    }
    Configuration::new(far * angle.cos(), far * angle.sin(), theta)
}

fn plain_distance(a: &Outline, b: &Outline, q: &Configuration) -> f64 {
    let n = b.vertices().len();
    let placed: Vec<_> = b.vertices().iter().map(|v| q.transform(*v)).collect();
    let mut least = f64::INFINITY;
    for i in 0..a.vertices().len() {
        let (p0, p1) = a.edge(i);
        for j in 0..n {
            let (q0, q1) = (placed[j], placed[(j + 1) % n]);
            least = least
                .min(distance_to_segment(p0, q0, q1))
                .min(distance_to_segment(q0, p0, p1));
        }
    }
    least
}

#[test]
fn clearance_agrees_with_a_plain_distance_of_segments() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for (a, b) in [(square(0.43), square(0.43)), (saw(false), saw(true))] {
        let contact = Contact::new(&a, &b);
        let mut compared = 0;
        for _ in 0..3000 {
            let q = Configuration::new(
                rng.random_range(-0.7..0.7),
                rng.random_range(-0.7..0.7),
                rng.random_range(-3.1..3.1),
            );
            let clearance = contact.clearance(&q);
            assert_eq!(clearance >= -contact.touch(), contact.is_free(&q));
            if clearance > 0.0 {
                compared += 1;
                assert!(
                    (clearance - plain_distance(&a, &b, &q)).abs() < 1e-9,
                    "{q:?}"
                );
                assert!(contact.clearance_bound(&q) <= clearance + 1e-12);
            }
        }
        assert!(compared > 500);
    }
}

#[test]
fn flush_mates_touch_and_overlapping_tiles_do_not() {
    let squares = Contact::new(&square(0.43), &square(0.43));
    assert!(squares.is_free(&Configuration::new(0.43, 0.0, 0.0)));
    assert!(!squares.is_free(&Configuration::new(0.4299, 0.0, 0.0)));
    assert!((squares.clearance(&Configuration::new(0.42, 0.0, 0.0)) + 0.01).abs() < 1e-12);
    assert!((squares.clearance(&Configuration::new(0.44, 0.0, 0.0)) - 0.01).abs() < 1e-12);
    let saws = Contact::new(&saw(false), &saw(true));
    assert!(saws.is_free(&Configuration::new(0.4, 0.0, 0.0)));
    assert!(!saws.is_free(&Configuration::new(0.4, 0.001, 0.0)));
    assert!(saws.is_free(&Configuration::new(0.4, 0.1, 0.0)));
}

/// For squares in front of each other's faces the cheap bound is the clearance, and for separate
/// convex tiles there always is one.
#[test]
fn the_clearance_s_bound_tells_of_convex_tiles_whether_they_are_apart() {
    let contact = Contact::new(&square(0.43), &square(0.43));
    for gap in [0.0, 1e-6, 1e-3, 0.05, 0.15] {
        for y in [0.0, 0.1, -0.3] {
            let q = Configuration::new(0.43 + gap, y, 0.0);
            if q.x.hypot(q.y) < 0.6 {
                assert!((contact.clearance_bound(&q) - gap).abs() < 1e-12, "{q:?}");
            }
        }
    }
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..2000 {
        let q = Configuration::new(
            rng.random_range(-1.0..1.0),
            rng.random_range(-1.0..1.0),
            rng.random_range(-3.1..3.1),
        );
        let apart = contact.clearance(&q) > 0.0;
        assert_eq!(contact.clearance_bound(&q) >= 0.0, apart, "{q:?}");
    }
}
