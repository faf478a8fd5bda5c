//! Possible contacts of a cell: motions that close none of them stay free.

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::contact::Contact;
use tilebind::contact::cells::ContactCells;

use super::{near_contact, saw, square};

#[test]
fn a_step_that_closes_no_possible_contact_stays_free() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let (mut kept, mut refused, mut lost) = (0, 0, 0);
    for (a, b) in [
        (square(0.43), square(0.43)),
        (saw(false), saw(true)),
        (saw(true), saw(false)),
    ] {
        let contact = Contact::new(&a, &b);
        let cells = ContactCells::new(&contact);
        for _ in 0..3000 {
            let size = 10f64.powf(rng.random_range(-5.0..-2.0));
            let mut draw = |half: f64| half * rng.random_range(-1.0..=1.0);
            let half = [size, size, 3.0 * size];
            let step = Vector3::new(draw(size), draw(size), draw(3.0 * size));
            let offset = Vector3::new(draw(size), draw(size), draw(3.0 * size));
            let centre = near_contact(&contact, &mut rng).moved(offset);
            let swept = Cell {
                centre: centre.moved(step / 2.0),
                half: std::array::from_fn(|i| half[i] + step[i].abs() / 2.0),
            };
            let contacts = cells.possible(&swept, 10_000).unwrap();
            let opens = contacts
                .iter()
                .all(|c| c.opening(&swept.half, &step) >= 0.0);
            for _ in 0..10 {
                let d = Vector3::from_fn(|i, _| half[i] * rng.random_range(-1.0..=1.0));
                let start = centre.moved(d);
                // Overlaps of a nanometre count as free: start from clearly apart.
                if contact.clearance(&start) <= 1e-9 {
                    continue;
                }
                let stays =
                    (1..=8).all(|k| contact.is_free(&start.moved(step * f64::from(k) / 8.0)));
                match (opens, stays) {
                    (true, true) => kept += 1,
                    (true, false) => panic!("{start:?} {step:?} leads into overlap"),
                    (false, true) => refused += 1,
                    (false, false) => lost += 1,
                }
            }
        }
    }
    // All three happen often: the test can fail, and the claim says something.
    assert!(
        kept > 5000 && refused > 1000 && lost > 1000,
        "{kept} {refused} {lost}"
    );
}

#[test]
fn without_possible_contacts_a_cell_is_wholly_free_or_wholly_not() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut clear = 0;
    for (a, b) in [(square(0.43), square(0.43)), (saw(false), saw(true))] {
        let contact = Contact::new(&a, &b);
        let cells = ContactCells::new(&contact);
        for _ in 0..3000 {
            let size = 10f64.powf(rng.random_range(-5.0..-2.0));
            let draw = |rng: &mut ChaCha8Rng, most: f64| {
                Vector3::from_fn(|_, _| most * rng.random_range(-1.0..=1.0))
            };
            let centre = near_contact(&contact, &mut rng).moved(draw(&mut rng, 4.0 * size));
            let cell = Cell {
                centre,
                half: [size; 3],
            };
            if !cells.possible(&cell, 10_000).unwrap().is_empty() {
                continue;
            }
            clear += 1;
            let is_free = contact.is_free(&centre);
            for _ in 0..10 {
                let q = centre.moved(draw(&mut rng, size));
                assert_eq!(contact.is_free(&q), is_free, "{cell:?} {q:?}");
            }
        }
    }
    assert!(clear > 1000, "{clear}");
}

#[test]
fn contacts_are_listed_as_far_as_there_is_room_for_them() {
    let contact = Contact::new(&saw(false), &saw(true));
    let cells = ContactCells::new(&contact);
    let cell = Cell {
        centre: Configuration::new(0.4, 0.0, 0.0),
        half: [0.01, 0.01, 0.05],
    };
    let all = cells.possible(&cell, 10_000).unwrap().len();
    assert!(all > 4);
    assert_eq!(
        cells.possible(&cell, all).map(|found| found.len()),
        Some(all)
    );
    assert!(cells.possible(&cell, all - 1).is_none());
}
