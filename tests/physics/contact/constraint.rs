//! The motions that contact allows: gaps, their gradients and admissible directions.

use nalgebra::{Matrix3, Rotation2, Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::contact::{Contact, closest_admissible};

use super::{outline, regular, saw, square};

fn flush() -> (Contact, Configuration) {
    let contact = Contact::new(&square(0.4), &square(0.4));
    (contact, Configuration::new(0.4, 0.05, 0.0))
}

#[test]
fn gaps_and_their_gradients_agree_with_finite_differences() {
    for (a, b, q) in [
        (
            square(0.4),
            square(0.4),
            Configuration::new(0.41, 0.05, 0.03),
        ),
        (
            square(0.4),
            square(0.4),
            Configuration::new(0.41, -0.05, -0.03),
        ),
        (
            saw(false),
            saw(true),
            Configuration::new(0.402, 0.0003, 0.01),
        ),
    ] {
        let contact = Contact::new(&a, &b);
        let here = contact.constraints(&q, 0.02);
        assert!(!here.is_empty());
        let h = 1e-7;
        for axis in 0..3 {
            let mut step = Vector3::zeros();
            step[axis] = h;
            let there = contact.constraints(&q.moved(step), 0.02);
            let back = contact.constraints(&q.moved(-step), 0.02);
            assert_eq!((here.len(), here.len()), (there.len(), back.len()));
            for k in 0..here.len() {
                let slope = (there[k].gap - back[k].gap) / (2.0 * h);
                assert!((slope - here[k].gradient[axis]).abs() < 1e-6);
            }
        }
    }
}

#[test]
fn a_flush_face_may_slide_and_leave_but_not_enter_or_turn() {
    let (contact, q) = flush();
    let constraints = contact.constraints(&q, 1e-6);
    let metric = Matrix3::identity();
    let go = |v: Vector3<f64>| {
        closest_admissible((v, 1.0), &metric, &constraints)
            .unwrap()
            .0
    };
    let slide = Vector3::new(0.0, 1.0, 0.0);
    assert!((go(slide) - slide).norm() < 1e-12);
    let leave = Vector3::new(1.0, 0.3, 0.1);
    assert!((go(leave) - leave).norm() < 1e-12);
    assert!(go(Vector3::new(-1.0, 0.0, 0.0)).norm() < 1e-12);
    let turned = go(Vector3::new(-1.0, 0.5, 0.0));
    assert!((turned - Vector3::new(0.0, 0.5, 0.0)).norm() < 1e-12);
    // A turn in place is possible only by backing off.
    let turned = go(Vector3::new(0.0, 0.0, 1.0));
    assert!(turned.x > 0.0 && turned.z > 0.0);
}

#[test]
fn coinciding_corners_do_not_hinder_sliding_either_way() {
    let contact = Contact::new(&square(0.4), &square(0.4));
    let constraints = contact.constraints(&Configuration::new(0.4, 0.0, 0.0), 1e-6);
    for dy in [-1.0, 1.0] {
        let wanted = Vector3::new(-0.5, dy, 0.0);
        let (go, multipliers) =
            closest_admissible((wanted, 1.0), &Matrix3::identity(), &constraints).unwrap();
        assert!((go - Vector3::new(0.0, dy, 0.0)).norm() < 1e-12);
        assert!(multipliers.iter().all(|m| *m >= 0.0));
    }
}

/// A corner that is on the other tile's side is in front of that side alone: it is behind the line of the
/// next one, but not inside, whatever rounding makes of its place.
#[test]
fn corners_on_a_side_are_not_held_by_the_next_one() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for sides in [3, 4, 5, 6] {
        let half = std::f64::consts::PI / f64::from(sides);
        for _ in 0..200 {
            let turn = rng.random_range(0.0..6.0);
            let polygon = |by: f64| {
                let corners = regular(sides as usize, 0.05 / half.sin());
                let turned = |p: &Vector2<f64>| (Rotation2::new(by) * p).into();
                outline(&corners.vertices().iter().map(turned).collect::<Vec<_>>())
            };
            let contact = Contact::new(&polygon(turn), &polygon(turn + std::f64::consts::PI));
            let apart = 0.1 / half.tan();
            let slid = f64::powf(10.0, rng.random_range(-8.0..-5.0));
            for slid in [slid, -slid] {
                let (sine, cosine) = f64::sin_cos(turn);
                let q = Configuration::new(
                    apart * cosine - slid * sine,
                    apart * sine + slid * cosine,
                    0.0,
                );
                if !contact.is_free(&q) {
                    continue;
                }
                for held in contact.constraints(&q, 1e-5) {
                    assert!(held.gap > -1e-9, "{sides} {slid:e}: {held:?}");
                }
            }
        }
    }
}

/// Squares that overlap, with corners of each on sides of the other, are held apart, however the corners'
/// places are rounded.
#[test]
fn corners_on_a_side_whose_tile_is_inside_are_held() {
    for k in 0..200 {
        let side = 0.3 + 1e-3 * f64::from(k);
        let contact = Contact::new(&square(side), &square(side));
        for overlap in [1e-7, 1e-5, 1e-4] {
            let held = contact.constraints(&Configuration::new(side - overlap, 0.0, 0.0), 1e-3);
            let deep = held.iter().filter(|it| (it.gap + overlap).abs() < 1e-9);
            assert!(deep.count() >= 2, "{side} {overlap:e}: {held:?}");
        }
    }
}

#[test]
fn mated_teeth_only_let_go_outwards() {
    let contact = Contact::new(&saw(false), &saw(true));
    let constraints = contact.constraints(&Configuration::new(0.4, 0.0, 0.0), 1e-6);
    let go = |v| {
        closest_admissible((v, 1.0), &Matrix3::identity(), &constraints)
            .unwrap()
            .0
    };
    assert!(go(Vector3::new(-1.0, 0.0, 0.0)).norm() < 1e-12);
    let slid = go(Vector3::new(0.0, 1.0, 0.0));
    assert!(slid.x > 0.0, "a slide climbs the teeth: {slid}");
}

/// Steps that open all gaps stay free, steps that close one overlap: wherever polygons touch along
/// a whole side, a part of it, in a corner.
#[test]
fn gaps_tell_free_steps_from_blocked_ones() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    for sides in [3, 5, 6, 7] {
        let half = std::f64::consts::PI / sides as f64;
        // Sides of 0.1 m.
        let polygon = regular(sides, 0.05 / half.sin());
        let contact = Contact::new(&polygon, &polygon);
        let apothem = 0.05 / half.tan();
        let (mut opened, mut closed) = (0, 0);
        for slide in [0.0, 0.03, -0.06, 0.0999, -0.1] {
            // The sides face each other: the right side of one, its image on the other.
            let q = Configuration::new(2.0 * apothem, slide, std::f64::consts::PI);
            let constraints = contact.constraints(&q, 1e-6);
            for _ in 0..300 {
                let mut draw = |scale: f64| scale * rng.random_range(-1.0..=1.0);
                let step = Vector3::new(draw(1e-4), draw(1e-4), draw(3e-4));
                let rates: Vec<f64> = constraints.iter().map(|c| c.gradient.dot(&step)).collect();
                let free = contact.is_free(&q.moved(step));
                if rates.iter().all(|rate| *rate > 1e-6) {
                    opened += 1;
                    assert!(free, "{sides} {slide} {step:?}");
                } else if slide.abs() < 0.09 && rates.iter().any(|rate| *rate < -1e-6) {
                    closed += 1;
                    assert!(!free, "{sides} {slide} {step:?}");
                }
            }
        }
        assert!(opened > 100 && closed > 100, "{opened} {closed}");
    }
}

/// A corner in an obtuse notch, a little up one of its flanks: the other flank also blocks it,
/// although the corner is not in front of it.
#[test]
fn both_flanks_of_a_notch_hold_a_corner_back() {
    let notched = outline(&[
        [-0.2, -0.2],
        [0.2, -0.2],
        [0.2, -0.135],
        [0.1, 0.0],
        [0.2, 0.135],
        [0.2, 0.2],
        [-0.2, 0.2],
    ]);
    let contact = Contact::new(&notched, &square(0.1));
    let up = Vector2::new(0.1, 0.135).normalize();
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let (mut opened, mut closed) = (0, 0);
    for (along, turn) in [(0.0, 0.0), (1e-6, 0.02), (3e-5, -0.02), (2e-4, 0.05)] {
        let theta = std::f64::consts::FRAC_PI_4 + turn;
        let corner = Rotation2::new(theta) * Vector2::new(-0.05, 0.05);
        let at = Vector2::new(0.1, 0.0) + up * along - corner;
        let q = Configuration::new(at.x, at.y, theta);
        let constraints = contact.constraints(&q, 1e-3);
        assert_eq!(constraints.len(), 2, "{along}: {constraints:?}");
        for _ in 0..300 {
            let mut draw = |scale: f64| scale * rng.random_range(-1.0..=1.0);
            let step = Vector3::new(draw(3e-4), draw(3e-4), draw(1e-3));
            let gaps = constraints.iter().map(|c| c.gap + c.gradient.dot(&step));
            let least = gaps.fold(f64::INFINITY, f64::min);
            if least.abs() > 1e-6 {
                let is_open = least > 0.0;
                assert_eq!(contact.is_free(&q.moved(step)), is_open, "{along} {step:?}");
                *(if is_open { &mut opened } else { &mut closed }) += 1;
            }
        }
    }
    assert!(opened > 100 && closed > 100, "{opened} {closed}");
}
