//! Cells of configurations: blocked, cut or open.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::contact::Contact;
use tilebind::contact::cells::{ContactCells, Cut};
use tilebind::tile::Outline;

use super::{near_contact, regular, saw, square};

#[test]
fn no_free_configuration_is_blocked_or_cut_off() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for (a, b) in [
        (square(0.43), square(0.43)),
        (regular(3, 0.35), regular(3, 0.35)),
        (saw(false), saw(true)),
        (saw(true), saw(false)),
    ] {
        let contact = Contact::new(&a, &b);
        let cells = ContactCells::new(&contact);
        let (mut blocked, mut cut, mut cut_off, mut cornered) = (0, 0, 0, 0);
        for _ in 0..2000 {
            let size = 10f64.powf(rng.random_range(-3.5..-0.7));
            let cell = Cell {
                centre: Configuration::new(
                    rng.random_range(-0.6..0.6),
                    rng.random_range(-0.6..0.6),
                    rng.random_range(-3.1..3.1),
                ),
                half: std::array::from_fn(|_| size * rng.random_range(0.05..1.0)),
            };
            let verdict = cells.classify(&cell);
            for _ in 0..20 {
                let d: [f64; 3] =
                    std::array::from_fn(|i| cell.half[i] * rng.random_range(-1.0..=1.0));
                let free = contact.is_free(&cell.centre.moved(d.into()));
                match &verdict {
                    None => {
                        blocked += 1;
                        assert!(!free, "{cell:?} {d:?}");
                    }
                    Some(cuts) => {
                        let holds = |c: &Cut| c.form.at(d) + c.slack >= 0.0;
                        let allowed = cuts.all.iter().all(holds)
                            && cuts.corners.iter().all(|pair| pair.iter().any(holds));
                        assert!(allowed || !free, "{cell:?} {d:?}");
                        cut += usize::from(!cuts.all.is_empty());
                        cornered += usize::from(!cuts.corners.is_empty());
                        cut_off += usize::from(!allowed);
                    }
                }
            }
        }
        assert!(
            blocked > 3000 && cut > 200 && cut_off > 100 && cornered > 5,
            "{blocked} {cut} {cut_off} {cornered}"
        );
    }
}

/// The first corner of an outline makes no difference to cells.
#[test]
fn cells_do_not_depend_on_how_corners_are_numbered() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    for (a, b) in [(square(0.43), square(0.43)), (saw(false), saw(true))] {
        let plain = Contact::new(&a, &b);
        let others = [1, 2, 3].map(|k| {
            let begun = |outline: &Outline| {
                let mut vertices = outline.vertices().to_vec();
                vertices.rotate_left(k);
                Outline::new(vertices).unwrap()
            };
            Contact::new(&begun(&a), &begun(&b))
        });
        let (mut cuts, mut corners) = (0, 0);
        for _ in 0..2000 {
            let size = 10f64.powf(rng.random_range(-4.5..-2.5));
            let cell = Cell {
                centre: near_contact(&plain, &mut rng),
                half: [size; 3],
            };
            let counts = |contact: &Contact| {
                let found = ContactCells::new(contact).classify(&cell);
                found.map(|found| (found.all.len(), found.corners.len()))
            };
            let expected = counts(&plain);
            cuts += expected.map_or(0, |counts| counts.0);
            corners += expected.map_or(0, |counts| counts.1);
            for other in &others {
                assert_eq!(counts(other), expected, "{cell:?}");
            }
        }
        assert!(cuts > 100 && corners > 10, "{cuts} {corners}");
    }
}

#[test]
fn corners_that_cross_with_no_vertex_inside_are_blocked() {
    // 60 degrees leave room for edges that cross 4 mm from either corner.
    let triangle = regular(3, 0.1 / 3f64.sqrt());
    let contact = Contact::new(&triangle, &triangle);
    let crossed = Configuration::new(0.059_14, 0.023_43, 1.794_8);
    let depth = -contact.clearance(&crossed);
    assert!(depth > 0.02, "{depth}");
    let cells = ContactCells::new(&contact);
    for half in [5e-5, 1e-3, 5e-3] {
        let cell = Cell {
            centre: crossed,
            half: [half, half, 10.0 * half],
        };
        assert_eq!(cells.classify(&cell), None, "{half}");
    }
}
