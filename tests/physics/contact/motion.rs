//! Motions: free throughout, or not.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::contact::{Contact, Halves};

use super::{saw, square};

#[test]
fn a_corner_clipped_between_free_ends_is_found() {
    let contact = Contact::new(&square(0.4), &square(0.4));
    // Two free configurations on either side of the fixed tile's corner.
    let a = Configuration::new(0.4001, 0.35, 0.0);
    let b = Configuration::new(0.35, 0.4001, 0.0);
    assert!(contact.is_free(&a) && contact.is_free(&b));
    assert!(!contact.motion_is_free(&a, &b));
    let sliver = Configuration::new(0.40005, 0.39995, 0.0);
    let past = Configuration::new(0.39995, 0.40005, 0.0);
    assert!(contact.motion_is_free(&sliver, &past));
    let sliver = Configuration::new(0.40005, 0.39994, 0.0);
    let past = Configuration::new(0.39994, 0.40005, 0.0);
    assert!(!contact.motion_is_free(&sliver, &past));
}

#[test]
fn flush_sliding_is_free_and_cheap_to_prove() {
    let contact = Contact::new(&square(0.4), &square(0.4));
    let a = Configuration::new(0.4, -0.3, 0.0);
    let b = Configuration::new(0.4, 0.3, 0.0);
    assert!(contact.stays_separated(&a, &b, contact.touch()));
    assert!(contact.motion_is_free(&a, &b));
}

#[test]
fn verdicts_agree_with_fine_sampling() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let contact = Contact::new(&saw(false), &saw(true));
    let mut counts = [0, 0];
    for _ in 0..400 {
        let mut near = || {
            Configuration::new(
                rng.random_range(0.39..0.46),
                rng.random_range(-0.1..0.1),
                rng.random_range(-0.15..0.15),
            )
        };
        let (a, b) = (near(), near());
        if !contact.is_free(&a) || !contact.is_free(&b) {
            continue;
        }
        let sampled = (0..=2000).all(|i| contact.is_free(&a.interpolate(&b, i as f64 / 2000.0)));
        let verdict = contact.motion_is_free(&a, &b);
        // Sampling can miss a grazing contact, but must never contradict a free verdict.
        assert!(!verdict || sampled);
        counts[usize::from(verdict)] += 1;
        if sampled != verdict {
            let least = (0..=20000)
                .map(|i| contact.clearance(&a.interpolate(&b, i as f64 / 20000.0)))
                .fold(f64::INFINITY, f64::min);
            assert!(least < 1e-6, "refused a motion with clearance {least}");
        }
    }
    assert!(counts[0] > 20 && counts[1] > 20, "{counts:?}");
}

#[test]
fn a_proved_motion_is_free_wherever_it_is_looked_at() {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    for (a, b) in [(square(0.4), square(0.4)), (saw(false), saw(true))] {
        let contact = Contact::new(&a, &b);
        let mut counts = [0, 0];
        for _ in 0..4000 {
            let mut near = |size: f64| {
                Configuration::new(
                    rng.random_range(0.39..0.39 + size),
                    rng.random_range(-0.1..0.1),
                    rng.random_range(-0.15..0.15),
                )
            };
            let p = near(0.08);
            let q = p.interpolate(&near(0.08), 0.2);
            let proved = contact.stays_separated(&p, &q, 0.0);
            counts[usize::from(proved)] += 1;
            let free = (0..=50).all(|k| contact.is_free(&p.interpolate(&q, k as f64 / 50.0)));
            assert!(free || !proved, "{p:?} {q:?}");
        }
        assert!(counts[0] > 500 && counts[1] > 500, "{counts:?}");
    }
}

#[test]
fn flush_sliding_is_proved_with_touch_and_refused_where_room_is_asked_for() {
    let contact = Contact::new(&square(0.4), &square(0.4));
    let at = |x: f64, y: f64| Configuration::new(x, y, 0.0);
    assert!(contact.stays_separated(&at(0.4, -0.3), &at(0.4, 0.3), contact.touch()));
    assert!(!contact.stays_separated(&at(0.4, -0.3), &at(0.4, 0.3), -1e-12));
    assert!(contact.stays_separated(&at(0.401, -0.3), &at(0.401, 0.3), -0.0009));
    assert!(!contact.stays_separated(&at(0.401, -0.3), &at(0.401, 0.3), -0.0011));
}

#[test]
fn what_is_lent_to_many_motions_changes_no_verdict() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let mut counts = [0, 0];
    for (a, b) in [(square(0.4), square(0.4)), (saw(false), saw(true))] {
        let contact = Contact::new(&a, &b);
        let mut left = Halves::default();
        let mut near = || {
            let q = Configuration::new(
                rng.random_range(0.39..0.46),
                rng.random_range(-0.1..0.1),
                rng.random_range(-0.15..0.15),
            );
            contact.is_free(&q).then_some(q)
        };
        for _ in 0..4000 {
            let (Some(a), Some(b)) = (near(), near()) else {
                continue;
            };
            let known = [a, b].map(|q| contact.known(q));
            let verdict =
                contact.known_motion_overlaps_at_most(known.each_ref(), contact.touch(), &mut left);
            assert_eq!(verdict, contact.motion_is_free(&a, &b), "{a:?} {b:?}");
            counts[usize::from(verdict)] += 1;
        }
    }
    assert!(counts[0] > 100 && counts[1] > 100, "{counts:?}");
}
