//! Motions that bring outlines into long contact, against a plain measure of contact.

use tilebind::Configuration;
use tilebind::contact::Contact;
use tilebind::contact::matching::matches;
use tilebind::tile::Outline;

use super::{outline, saw, square};

/// Length (m) along which two outlines touch: points of one this close to the other.
fn plain_contact(fixed: &Outline, moving: &Outline, q: &Configuration) -> f64 {
    const POINTS: usize = 2000;
    let mut length = 0.0;
    for j in 0..moving.vertices().len() {
        let (from, to) = moving.edge(j);
        let (from, to) = (q.transform(from), q.transform(to));
        let direction = (to - from).normalize();
        for i in 0..fixed.vertices().len() {
            let (start, end) = fixed.edge(i);
            // Edges that face each other; the rest touch in points.
            if (end - start).normalize().dot(&direction) > -1.0 + 1e-12 {
                continue;
            }
            let along = (end - start).normalize();
            let touches = |k: usize| {
                let p = from + (to - from) * ((k as f64 + 0.5) / POINTS as f64) - start;
                let place = p.dot(&along);
                p.perp(&along).abs() < 1e-7 && place > 0.0 && place < (end - start).norm()
            };
            let share = (0..POINTS).filter(|k| touches(*k)).count() as f64 / POINTS as f64;
            length += share * (to - from).norm();
        }
    }
    length
}

/// A trapezium: edges of four directions and three lengths.
fn trapezium() -> Outline {
    outline(&[[-0.1, -0.05], [0.1, -0.05], [0.05, 0.05], [-0.02, 0.05]])
}

#[test]
fn contacts_are_as_long_as_they_are_said_to_be_and_none_overlaps() {
    for (a, b) in [
        (square(0.1), trapezium()),
        (trapezium(), trapezium()),
        (saw(false), saw(true)),
    ] {
        let contact = Contact::new(&a, &b);
        let found = matches(&contact, 60);
        assert!(found.len() > 10);
        assert!(
            found
                .windows(2)
                .all(|pair| pair[0].contact >= pair[1].contact - 1e-6)
        );
        for one in &found {
            assert!(contact.is_free(&one.pose));
            let plain = plain_contact(&a, &b, &one.pose);
            assert!((plain - one.contact).abs() < 1e-3, "{one:?}: {plain}");
        }
    }
}

/// Exchanging the outlines inverts the motions.
#[test]
fn contacts_are_those_seen_from_the_other_outline() {
    for (a, b) in [(square(0.1), trapezium()), (saw(false), saw(true))] {
        let lengths = |a: &Outline, b: &Outline| -> Vec<f64> {
            let found = matches(&Contact::new(a, b), 100_000);
            found.iter().map(|one| one.contact).collect()
        };
        let (there, back) = (lengths(&a, &b), lengths(&b, &a));
        assert_eq!(there.len(), back.len());
        assert!(there.iter().zip(&back).all(|(a, b)| (a - b).abs() < 1e-6));
    }
}

/// The best match of a saw is its complement, all along its teeth.
#[test]
fn complements_match_all_along() {
    let contact = Contact::new(&saw(false), &saw(true));
    let best = matches(&contact, 1)[0];
    let teeth = 8.0 * 0.05f64.hypot(0.03);
    assert!((best.contact - teeth).abs() < 1e-9, "{best:?}");
    assert!((best.pose.x - 0.4).abs() < 1e-9 && best.pose.y.abs() < 1e-9);
    assert_eq!(best.gap, 0.0);
}

/// Neither where an outline's reference point lies nor how it is turned.
#[test]
fn contacts_do_not_depend_on_the_outlines_frames() {
    let lengths = |a: &Outline, b: &Outline| -> Vec<f64> {
        let found = matches(&Contact::new(a, b), 100_000);
        found.iter().map(|one| one.contact).collect()
    };
    let framed = |outline: &Outline, x: f64, y: f64, turn: f64| {
        let frame = Configuration::new(x, y, turn);
        let vertices = outline.vertices().iter().map(|v| frame.transform(*v));
        Outline::new(vertices.collect()).unwrap()
    };
    for (a, b) in [(square(0.1), trapezium()), (saw(false), saw(true))] {
        let expected = lengths(&a, &b);
        for k in 0..8 {
            let turn = f64::from(k) * std::f64::consts::FRAC_PI_4;
            let a = framed(&a, 0.3, -0.2, 0.1 * f64::from(k));
            let b = framed(&b, -0.07, 0.11, turn + 0.1 * f64::from(k));
            let found = lengths(&a, &b);
            assert_eq!(found.len(), expected.len(), "{k}");
            let same = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-6;
            assert!(found.iter().zip(&expected).all(same), "{k}");
        }
    }
}

/// Corners that are off by some nanometres, as drawings' are, touch along the same lengths.
#[test]
fn contacts_are_as_long_where_corners_are_off_by_nanometres() {
    let best = |a: &Outline, b: &Outline| matches(&Contact::new(a, b), 1)[0].contact;
    let shaken = |outline: &Outline, seed: f64| {
        let off = |k: usize| 1.5e-8 * (seed + 7.0 * k as f64).sin();
        let vertices = outline.vertices().iter().enumerate();
        let vertices = vertices.map(|(k, v)| v + nalgebra::Vector2::new(off(k), off(k + 3)));
        Outline::new(vertices.collect()).unwrap()
    };
    let (a, b) = (saw(false), saw(true));
    let expected = best(&a, &b);
    for seed in [0.0, 1.0, 2.0, 3.0] {
        let found = best(&shaken(&a, seed), &shaken(&b, seed + 0.5));
        assert!(
            (found - expected).abs() < 1e-5,
            "{seed}: {found} {expected}"
        );
    }
}
