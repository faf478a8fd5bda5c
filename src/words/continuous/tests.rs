//! Tests against plain sums over dipoles and the exact contact of two squares.

use nalgebra::Vector2;

use super::pose::Meetings;
use super::*;
use crate::Effort;
use tiles::budget::Budget;
use tiles::contact::Contact;
use tiles::potential::dipole::pair;
use tiles::tile::Outline;

fn wanted(magnets: usize) -> Wanted {
    Wanted {
        magnets,
        bar: Bar {
            pitch: 0.015,
            ..Bar::paper()
        },
        face: 0.2,
        words_meet: true,
        flip: false,
        balanced: false,
        longest_run: None,
    }
}

fn effort(seconds: f64) -> Effort {
    Effort {
        seed: 1,
        budget: Budget::seconds(seconds),
    }
}

fn square(side: f64) -> Outline {
    let half = side / 2.0;
    let corners = [[half, -half], [half, half], [-half, half], [-half, -half]];
    Outline::new(corners.map(Vector2::from).to_vec()).unwrap()
}

/// The energy (J) of two faces of squares in contact by plain sums, with exact contact of the
/// squares.
fn plain(wanted: &Wanted, first: &SpacedWord, second: &SpacedWord, slide: f64, tilt: f64) -> f64 {
    let (half, bar) = (wanted.face / 2.0, wanted.bar);
    let contact = Contact::new(&square(wanted.face), &square(wanted.face));
    let turned = tiles::Configuration::new(0.0, 0.0, tilt).transform(Vector2::new(-half, 0.0));
    let flush = tiles::Configuration::new(half - turned.x, slide - turned.y, tilt);
    let out = contact.landing(&flush, Vector2::x()).expect("they meet");
    let q = tiles::Configuration::new(flush.x + out, flush.y, tilt);
    let depth = bar.size[0] / 2.0 + bar.inset;
    let mut energy = 0.0;
    for (at, pole) in &first.magnets {
        for (other, other_pole) in &second.magnets {
            let place = q.transform(Vector2::new(-half + depth, -other));
            let there = q.rotation() * Vector2::new(-f64::from(*other_pole) * bar.moment, 0.0);
            let here = Vector2::new(f64::from(*pole) * bar.moment, 0.0);
            energy += pair(here, there, place - Vector2::new(half - depth, *at)).0;
        }
    }
    energy
}

#[test]
fn attractions_bound_plain_sums_over_poses() {
    let wanted = wanted(3);
    let found = search(&wanted, 2, &[], 0.0, &mut effort(0.05)).unwrap();
    let meetings = Meetings::new(&wanted);
    let [first, second] = [&found.words[0], &found.words[1]];
    let strongest = meetings.strongest(first, second, false);
    let mut lowest = 0.0f64;
    for tilt in -20..=20 {
        for slide in -190..=190 {
            let (tilt, slide) = (f64::from(tilt) * 0.016, f64::from(slide) * 1e-3);
            if slide.abs() + 0.02 < wanted.face {
                lowest = lowest.min(plain(&wanted, first, second, slide, tilt));
            }
        }
    }
    // A dense grid finds little more than annealing does.
    assert!(-lowest <= 1.15 * strongest, "{lowest} {strongest}");
    let bond = -plain(&wanted, first, &first.mate(), 0.0, 0.0);
    assert!((meetings.bond(first) - bond).abs() < 1e-12 * bond);
}

#[test]
fn words_keep_their_distance_and_annealing_widens_the_gap() {
    let wanted = wanted(4);
    let short = search(&wanted, 3, &[], 0.0, &mut effort(0.01)).unwrap();
    let long = search(&wanted, 3, &[], 0.0, &mut effort(1.0)).unwrap();
    assert!(long.share < short.share, "{} {}", long.share, short.share);
    for word in &long.words {
        assert!(wanted.allows(word) && wanted.allows(&word.mate()));
        assert_eq!(word.mate().mate(), *word);
        assert_eq!(
            word.turned_over()
                .code(false)
                .chars()
                .rev()
                .collect::<String>(),
            word.code(false)
        );
    }
    assert_eq!(search(&wanted, 3, &[], 0.0, &mut effort(1.0)), Some(long));
    let crowded = Wanted {
        magnets: 40,
        ..wanted
    };
    assert_eq!(search(&crowded, 1, &[], 0.0, &mut effort(0.1)), None);
}
