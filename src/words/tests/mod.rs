//! Tests of words against plain sums over dipoles and against brute force.

mod brute;
mod definitions;

use nalgebra::Vector2;

use super::effort::Effort;
use super::search::largest;
use super::*;
use tiles::budget::Budget;
use tiles::potential::dipole::pair;

const PITCH: f64 = 0.04;

fn effort(seconds: f64) -> Effort {
    Effort {
        seed: 1,
        budget: Budget::seconds(seconds),
    }
}

fn task(places: usize, rules: Rules) -> Task {
    Task {
        places,
        magnets: places,
        stands: false,
        lags: Lags::new(&Bar::paper(), places),
        rules,
        constraints: Constraints::default(),
    }
}

fn all_words(places: usize) -> Vec<Word> {
    (0..1u64 << places)
        .map(|set| Word::new(set, !set, places))
        .collect()
}

/// The energy (J) of two faces at contact, the second one slid along the first, by a plain sum
/// over point dipoles.
fn plain_energy(first: Word, second: Word, slide: i32) -> f64 {
    let bar = Bar::paper();
    let middle = (first.places() as f64 - 1.0) / 2.0;
    let mut energy = 0.0;
    for k in 0..first.places() {
        for j in 0..second.places() {
            let s = (k as f64 - middle) * PITCH;
            let t = -(j as f64 - middle) * PITCH + f64::from(slide) * PITCH;
            let [m1, m2] = [first.at(k), -second.at(j)]
                .map(|pole| Vector2::new(f64::from(pole) * bar.moment, 0.0));
            energy += pair(m1, m2, Vector2::new(bar.size[0], t - s)).0;
        }
    }
    energy
}

/// The strongest wrong attraction (J) of two words by the definition of the gap.
fn plain_attraction(u: Word, v: Word, rules: &Rules) -> f64 {
    let last = if rules.slides() {
        u.places() as i32 - 1
    } else {
        0
    };
    let mut strongest = 0.0f64;
    for slide in -last..=last {
        for mate in [true, false] {
            for flipped in [false, true] {
                if (!mate && !rules.words_meet()) || (flipped && !rules.flip) {
                    continue;
                }
                if mate && rules.own() {
                    continue;
                }
                if mate != rules.own() && !flipped && slide == 0 && u == v {
                    continue;
                }
                let second = if mate { v.mate() } else { v };
                let second = if flipped { second.reversed() } else { second };
                strongest = strongest.max(-plain_energy(u, second, slide));
            }
        }
    }
    strongest
}

fn every_rule() -> Vec<Rules> {
    let mut all = Vec::new();
    for flip in [false, true] {
        for (faces, shape) in [
            (Faces::All, FaceShape::None),
            (Faces::Mates, FaceShape::None),
            (Faces::All, FaceShape::Shared),
            (Faces::All, FaceShape::Polar),
            (Faces::Own, FaceShape::None),
            (Faces::Own, FaceShape::Shared),
        ] {
            all.push(Rules {
                faces,
                shape,
                flip,
                fault: None,
            });
        }
    }
    all
}

#[test]
fn energies_by_lags_are_plain_sums() {
    let lags = Lags::new(&Bar::paper(), 5);
    let rules = Rules {
        flip: true,
        ..Rules::default()
    };
    for (u, v) in [("NNSNS", "SNNNS"), ("NSSSN", "NSSSN"), ("N.SN.", "..NSN")] {
        let [u, v] = [u, v].map(|text| Word::parse(text).unwrap());
        let depth = -plain_energy(u, u.mate(), 0);
        assert!((rules.bond(&lags, u) - depth).abs() < 1e-12 * depth);
        let worst = rules.strongest(&lags, u, v).unwrap();
        let second = if worst.flipped {
            worst.second.reversed()
        } else {
            worst.second
        };
        let energy = plain_energy(u, second, worst.slide);
        assert!(
            (worst.energy - energy).abs() < 1e-12 * depth,
            "{worst:?} {energy}"
        );
        assert!((plain_attraction(u, v, &rules) + energy).abs() < 1e-12 * depth);
    }
}

#[test]
fn counted_contacts_give_the_known_numbers() {
    for (places, numbers) in [
        (6, [(2, 1), (3, 3), (4, 12)]),
        (8, [(3, 2), (4, 7), (5, 17)]),
    ] {
        for (contacts, number) in numbers {
            let task = Task {
                lags: Lags::contacts(places),
                ..task(places, Rules::default())
            };
            let gap = 1.0 - f64::from(contacts) / places as f64;
            let found = largest(&task, gap, usize::MAX, &mut effort(20.0));
            assert_eq!(
                (found.words.len(), found.upper),
                (number, number),
                "{places} {contacts}"
            );
        }
    }
}

#[test]
fn ties_of_contacts_are_decided_by_energies() {
    let rules = Rules::default();
    let found = largest(&task(6, rules), 0.5, usize::MAX, &mut effort(20.0));
    assert_eq!((found.words.len(), found.upper), (2, 2));
    assert!(task(6, rules).judge(&found.words).unwrap().gap >= 0.5);
}

#[test]
fn sets_with_a_polar_shape_are_codes() {
    let rules = Rules {
        shape: FaceShape::Polar,
        ..Rules::default()
    };
    // A(n, d) of Brouwer's table: words of n places differ in at least d places if the gap is 2 d /
    // n.
    for (n, d, size) in [
        (5, 3, 4),
        (6, 3, 8),
        (7, 3, 16),
        (8, 4, 16),
        (9, 5, 6),
        (10, 5, 12),
        (11, 5, 24),
        (12, 5, 32),
        (11, 6, 12),
        (12, 6, 24),
        // From known codes: Hadamard's and Hamming's, which no exchange of words finds.
        (16, 8, 32),
        (15, 8, 16),
        (12, 3, 256),
    ] {
        let gap = (2.0 * f64::from(d) - 1.0) / f64::from(n);
        let found = largest(&task(n as usize, rules), gap, usize::MAX, &mut effort(20.0));
        assert_eq!(
            (found.words.len(), found.upper),
            (size, size),
            "A({n}, {d})"
        );
    }
}

#[test]
fn more_is_asked_fewer_are_found() {
    let count = |rules, gap, balanced| {
        let constraints = Constraints {
            balanced,
            ..Constraints::default()
        };
        let task = Task {
            constraints,
            ..task(7, rules)
        };
        largest(&task, gap, usize::MAX, &mut effort(20.0))
            .words
            .len()
    };
    let plain = Rules::default();
    let (shared, flip) = (
        Rules {
            shape: FaceShape::Shared,
            ..plain
        },
        Rules {
            flip: true,
            ..plain
        },
    );
    let numbers = [0.2, 0.35, 0.5, 0.65].map(|gap| count(plain, gap, false));
    assert!(numbers.is_sorted_by(|a, b| a >= b), "{numbers:?}");
    assert!(count(flip, 0.35, false) <= numbers[1]);
    assert!(count(plain, 0.35, true) <= numbers[1]);
    assert!(count(shared, 0.35, false) >= numbers[1]);
}

#[test]
fn mirrors_and_poles_change_nothing() {
    let task = task(7, Rules::default());
    let words = largest(&task, 0.35, usize::MAX, &mut effort(20.0)).words;
    let gap = |map: fn(Word) -> Word| {
        let mapped: Vec<Word> = words.iter().map(|word| map(*word)).collect();
        task.judge(&mapped).unwrap().gap
    };
    for map in [Word::reversed, Word::negated, Word::mate] {
        assert!((gap(map) - gap(|word| word)).abs() < 1e-12);
    }
}

#[test]
fn the_widest_gap_is_that_of_the_largest_sets() {
    let task = task(6, Rules::default());
    for count in [1, 2, 3, 5] {
        let widest = frontier::widest(&task, count, &mut effort(60.0));
        assert!(widest.proved && widest.words.len() == count);
        let more = largest(&task, widest.gap + 1e-6, usize::MAX, &mut effort(20.0));
        assert!(more.upper < count, "{count}: {}", widest.gap);
    }
    let none = frontier::widest(&task, 100, &mut effort(20.0));
    assert!(none.proved && none.words.is_empty());
}

#[test]
fn threads_change_nothing() {
    let task = task(9, Rules::default());
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| largest(&task, 0.3, usize::MAX, &mut effort(0.5)))
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn spacing_carries_more_words() {
    let slots = |places, magnets| Task {
        magnets,
        ..task(places, Rules::default())
    };
    let count = |task: &Task| {
        largest(task, 0.45, usize::MAX, &mut effort(2.0))
            .words
            .len()
    };
    let (uniform, spaced) = (count(&slots(4, 4)), count(&slots(9, 4)));
    assert!(spaced > uniform, "{spaced} {uniform}");
}
