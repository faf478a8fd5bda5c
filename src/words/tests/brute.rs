//! Exhaustive search for the largest sets, with every option implemented by its definition.

use super::super::constraint::Constraints;
use super::super::search::largest;
use super::super::{FaceShape, Fault, Rules, Task};
use super::definitions::{Poles, allowed, bond, energy, mate, poles, sound, wrong};
use super::{all_words, effort, every_rule, task};

/// The size of a largest set by exhaustive search, over all weakest bonds.
fn brute_force(places: usize, gap: f64, rules: &Rules, asked: &Constraints) -> usize {
    let words: Vec<(f64, Poles)> = all_words(places)
        .into_iter()
        .map(poles)
        .filter(|word| sound(word, rules, asked))
        .map(|word| (bond(&word, rules), word))
        .filter(|(bond, _)| *bond > 0.0)
        .collect();
    let n = words.len();
    let wrongs: Vec<Vec<f64>> = (0..n)
        .map(|i| {
            (0..n)
                .map(|j| wrong(&words[i].1, &words[j].1, rules))
                .collect()
        })
        .collect();
    let both: Vec<Vec<bool>> = (0..n)
        .map(|i| {
            let fits = |j: usize| {
                let (u, v) = (&words[i].1, &words[j].1);
                (!rules.words_meet() || rules.own() || *u != mate(v))
                    && allowed(u, v, asked)
                    && allowed(v, u, asked)
            };
            (0..n).map(fits).collect()
        })
        .collect();
    let mut bonds: Vec<f64> = words.iter().map(|word| word.0).collect();
    bonds.sort_by(f64::total_cmp);
    bonds.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
    let largest = bonds.into_iter().map(|weakest| {
        let limit = (1.0 - gap) * weakest * (1.0 + 1e-12);
        let own: Vec<usize> = (0..n)
            .filter(|i| words[*i].0 >= weakest - 1e-12 && wrongs[*i][*i] <= limit)
            .collect();
        let fits = |i: usize, j: usize| both[i][j] && wrongs[i][j] <= limit;
        let mut best = 0;
        grow(0, &own, &fits, &mut best);
        best
    });
    largest.max().unwrap_or(0)
}

fn grow(size: usize, left: &[usize], fits: &dyn Fn(usize, usize) -> bool, best: &mut usize) {
    *best = (*best).max(size);
    for (k, i) in left.iter().enumerate() {
        if size + left.len() - k <= *best {
            return;
        }
        let rest: Vec<usize> = left[k + 1..]
            .iter()
            .copied()
            .filter(|j| fits(*i, *j))
            .collect();
        grow(size + 1, &rest, fits, best);
    }
}

fn check(places: usize, gap: f64, rules: Rules, asked: &Constraints) {
    let task = Task {
        constraints: asked.clone(),
        ..task(places, rules)
    };
    let found = largest(&task, gap, usize::MAX, &mut effort(20.0));
    let size = brute_force(places, gap, &rules, asked);
    let told = format!("{places} {gap} {rules:?} {asked:?}");
    assert_eq!((found.words.len(), found.upper), (size, size), "{told}");
    // The set again, by plain sums alone.
    let words: Vec<Poles> = found.words.iter().map(|word| poles(*word)).collect();
    let weakest = words
        .iter()
        .map(|word| bond(word, &rules))
        .fold(f64::INFINITY, f64::min);
    for (i, u) in words.iter().enumerate() {
        assert!(sound(u, &rules, asked), "{told}");
        for v in &words[i..] {
            assert!(
                wrong(u, v, &rules) <= (1.0 - gap) * weakest * (1.0 + 1e-9),
                "{told}"
            );
            assert!(
                u == v || (allowed(u, v, asked) && allowed(v, u, asked)),
                "{told}"
            );
        }
    }
}

/// The constraints besides the gap, one by one and together.
fn every_constraint() -> Vec<Constraints> {
    let none = Constraints::default();
    vec![
        Constraints {
            balanced: true,
            ..none.clone()
        },
        Constraints {
            longest_run: Some(2),
            ..none.clone()
        },
        Constraints {
            mismatches: 2,
            ..none.clone()
        },
        Constraints {
            complement_mismatches: 2,
            ..none.clone()
        },
        Constraints {
            slide_mismatches: 1,
            ..none.clone()
        },
        Constraints {
            consecutive: Some(1..=3),
            ..none.clone()
        },
        Constraints {
            least_bond: Some(0.0815),
            ..none.clone()
        },
        Constraints {
            balanced: true,
            longest_run: Some(3),
            mismatches: 1,
            complement_mismatches: 1,
            slide_mismatches: 1,
            consecutive: Some(0..=4),
            ..none.clone()
        },
        none,
    ]
}

#[test]
fn sets_are_the_largest_by_brute_force() {
    for rules in every_rule() {
        // Without slides the graphs of six places are too dense for exhaustive search. 0.5 of six
        // is a tie of contacts, which energies decide.
        let lengths = [
            (3, 0.5),
            (4, 0.37),
            (5, 0.5),
            (5, 0.3),
            (6, 0.6),
            (6, 0.5),
            (6, 0.42),
        ];
        for (places, gap) in lengths {
            if places < 6 || rules.slides() {
                check(places, gap, rules, &Constraints::default());
            }
        }
    }
}

#[test]
fn every_constraint_is_kept_and_costs_no_more_than_it_must() {
    for rules in every_rule() {
        for asked in every_constraint() {
            check(5, 0.3, rules, &asked);
        }
    }
}

#[test]
fn faults_are_tolerated() {
    for rules in every_rule() {
        for (fault, gap) in [(Fault::Missing, 0.2), (Fault::Flipped, 0.0)] {
            let fault = Some(fault);
            check(4, gap, Rules { fault, ..rules }, &Constraints::default());
            check(5, gap, Rules { fault, ..rules }, &Constraints::default());
        }
    }
    // A set valid with faults is valid without.
    let shared = Rules {
        shape: FaceShape::Shared,
        ..Rules::default()
    };
    let count = |fault| {
        largest(
            &task(8, Rules { fault, ..shared }),
            0.3,
            usize::MAX,
            &mut effort(20.0),
        )
        .words
        .len()
    };
    let [none, missing, flipped] = [None, Some(Fault::Missing), Some(Fault::Flipped)].map(count);
    assert!(
        none > missing && missing >= flipped && missing > 0,
        "{none} {missing} {flipped}"
    );
}

#[test]
fn thermodynamic_ranges_are_kept() {
    let asked = Constraints {
        ranges: [Some(-0.04..=0.0), Some(-0.04..=0.0), Some(-0.055..=0.0)],
        ..Constraints::default()
    };
    let task = Task {
        constraints: asked.clone(),
        ..task(6, Rules::default())
    };
    let found = largest(&task, 0.0, usize::MAX, &mut effort(20.0)).words;
    assert!(!found.is_empty());
    let lowest = |u: &[i32], v: &[i32], own: bool| {
        let slides = (-5..=5).filter(|slide| !own || *slide != 0);
        slides
            .map(|slide| energy(u, v, slide))
            .fold(f64::INFINITY, f64::min)
    };
    let words: Vec<Poles> = found.into_iter().map(poles).collect();
    for u in &words {
        for v in &words {
            let kinds = [
                lowest(u, v, false),
                lowest(u, &mate(v), u == v),
                lowest(&mate(u), &mate(v), false),
            ];
            for (range, energy) in asked.ranges.iter().flatten().zip(kinds) {
                assert!(range.contains(&energy), "{u:?} {v:?} {energy}");
            }
        }
    }
}
