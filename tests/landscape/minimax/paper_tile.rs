//! The paper's tile, against figures from a dense grid fitted to contact.

use std::sync::atomic::{self, AtomicUsize};

use tilebind::configuration::Configuration;
use tilebind::landscape::minimax::{Bracket, CertifyError, End, Goal, Ordering, Question};
use tilebind::potential::MagnetModel;

use super::scene::{Scene, effort};
use crate::shields;

#[test]
fn brackets_hold_the_reference_saddles() {
    let (scene, design) = Scene::shipped("paper-tile", MagnetModel::Dipole);
    let depth = 65.47e-3;
    let bound = End::At(design.pair.bound);
    let mut certifier = scene.certifier();
    // From, to, and the reference saddle's energy, known to about 0.05 uJ.
    let cases = [
        ([0.43, 0.04, 0.0], bound, -0.8391e-3),
        ([0.43, -0.04, 0.0], bound, -0.8391e-3),
        ([0.43, 0.1003, 0.0], bound, -0.0475e-3),
        ([0.43, 0.14, 0.0], bound, 0.0022e-3),
    ];
    let brackets = cases.map(|(from, to, saddle)| {
        let effort = effort(1e-3 * depth, 200_000);
        let bracket = certifier.bracket(&from.into(), &to, &[], &effort).unwrap();
        let upper = bracket.bounds.upper.unwrap();
        assert!(
            bracket.bounds.width() <= 1e-3 * depth,
            "{from:?} {bracket:?}"
        );
        assert!(
            bracket.bounds.least() <= saddle + 1e-7 && saddle - 1e-7 <= upper,
            "{from:?}: {saddle} not in [{}, {upper}]",
            bracket.bounds.least()
        );
        bracket
    });
    assert_eq!(
        brackets[2].bounds.compare(&brackets[0].bounds),
        Ordering::Higher
    );
    assert_eq!(
        brackets[0].bounds.compare(&brackets[1].bounds),
        Ordering::Undecided
    );
}

#[test]
fn brackets_of_blocks_are_as_narrow_as_asked_and_nest() {
    let (scene, design) = Scene::shipped("paper-tile", MagnetModel::Cuboid);
    let depth = -scene.potential.energy(&design.pair.bound);
    for (to, saddle) in [
        (End::At(design.pair.bound), -0.8996e-3),
        (End::Free, -0.0046e-3),
    ] {
        let from = Configuration::new(0.43, 0.04, 0.0);
        for share in [1e-2, 1e-3] {
            let bracket = scene.bracket(&from, &to, &effort(share * depth, 100_000));
            assert!(bracket.bounds.width() <= share * depth, "{bracket:?}");
            // What the roadmap finds is a saddle to within some 1e-6 J.
            assert!(bracket.bounds.least() <= saddle, "{bracket:?}");
            assert!(
                bracket.bounds.upper.unwrap() >= saddle - 2e-6,
                "{bracket:?}"
            );
        }
    }
}

/// Where large leaves that hold an end, or that meet in an edge alone, lie beside the pass, only
/// subdividing them tells the ends apart; the leaves at the pass are low at any size.
#[test]
fn searches_end_where_large_leaves_lie_beside_the_pass() {
    let (blocks, design) = Scene::shipped("paper-tile", MagnetModel::Cuboid);
    let shields = shields::behind_all_faces();
    let [fixed, moving] = blocks.tiles.clone();
    let shielded = Scene::shielded(fixed, moving, blocks.space.half_size, &shields);
    for (scene, depth) in [(blocks, 118.64e-3), (shielded, 65.47e-3)] {
        for from in [[0.43, 0.1003, 0.0], [0.43, -0.04, 0.0]] {
            let narrow = effort(1e-4 * depth, 1_000_000);
            let bracket = scene.bracket(&from.into(), &End::At(design.pair.bound), &narrow);
            assert!(bracket.bounds.width() <= 1e-4 * depth, "{bracket:?}");
            // 6,000 to 13,000; millions without subdividing them.
            assert!(bracket.cells < 50_000, "{from:?}: {}", bracket.cells);
        }
    }
}

#[test]
fn the_certified_pathway_is_free_and_below_the_bound_wherever_it_is_looked_at() {
    let (scene, _) = Scene::shipped("paper-tile", MagnetModel::Dipole);
    let from = Configuration::new(0.43, 0.04, 0.0);
    for to in [End::Free, End::At(Configuration::new(0.43, 0.0, 0.0))] {
        let bracket = scene.bracket(&from, &to, &effort(1e-4, 100_000));
        let upper = bracket.bounds.upper.unwrap();
        let path = &bracket.pathway;
        assert_eq!(path[0], from);
        match to {
            End::At(to) => assert_eq!(path[path.len() - 1], to),
            End::Free => assert!(scene.space.is_far(&path[path.len() - 1])),
        }
        let mut highest = f64::NEG_INFINITY;
        for pair in path.windows(2) {
            for k in 0..=200 {
                let q = pair[0].interpolate(&pair[1], k as f64 / 200.0);
                assert!(scene.contact.is_free(&q), "{q:?}");
                highest = highest.max(scene.potential.energy(&q));
            }
        }
        assert!(highest <= upper + 1e-15);
        // The bound is sharp to the share of the tolerance that the query asks for.
        assert!(upper - highest <= 1e-5, "{highest} {upper}");
    }
}

#[test]
fn the_bracket_does_not_depend_on_the_number_of_threads() {
    let (scene, design) = Scene::shipped("paper-tile", MagnetModel::Dipole);
    let from = Configuration::new(0.43, -0.04, 0.0);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| scene.bracket(&from, &End::At(design.pair.bound), &effort(1e-4, 100_000)))
    };
    let one = on(1);
    assert_eq!(one, on(3));
    assert!(one.cells > 100);
}

/// More questions than are open at once: four times the same, one of which cannot be answered.
#[test]
fn barriers_asked_for_together_are_bracketed_as_those_asked_for_alone() {
    let (scene, design) = Scene::shipped("paper-tile", MagnetModel::Dipole);
    let slid = |by: f64| Configuration::new(0.43, by, 0.0);
    let ends = [
        Goal::free(),
        Goal::at(design.pair.bound),
        Goal::at(slid(0.04)),
    ];
    let effort = effort(2e-4, 100_000);
    let ask = |from: Configuration, to: &Goal| Question {
        from,
        to: to.clone(),
        known: Vec::new(),
        effort,
    };
    let starts = [-0.04, 0.08, -0.08];
    let mut questions: Vec<Question> = starts
        .iter()
        .flat_map(|by| ends.iter().map(|end| ask(slid(*by), end)))
        .collect();
    let alone: Vec<Bracket> = questions
        .iter()
        .map(|question| scene.certifier().answer(question).unwrap())
        .collect();
    questions.push(ask(Configuration::new(0.0, 0.0, 0.0), &ends[0]));
    let questions = vec![questions; 4].concat();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let most = AtomicUsize::new(0);
            let answered = |count| most.store(count, atomic::Ordering::Relaxed);
            let answers = scene.certifier().answers(&questions, &answered);
            (answers, most.into_inner())
        })
    };
    let (together, answered) = on(1);
    assert_eq!(answered, 4 * alone.len());
    for answers in together.chunks(alone.len() + 1) {
        for (alone, found) in alone.iter().zip(answers) {
            let found = found.as_ref().unwrap();
            assert!(found.bounds.width() <= 2e-4, "{found:?}");
            let [a, b] = [&alone.bounds, &found.bounds];
            assert_eq!(a.compare(b), Ordering::Undecided, "{a:?} {b:?}");
        }
        assert!(matches!(
            answers[alone.len()],
            Err(CertifyError::NotFree(_))
        ));
    }
    // They share what is subdivided.
    let cells = |brackets: &mut dyn Iterator<Item = &Bracket>| -> usize {
        brackets.map(|bracket| bracket.cells).sum()
    };
    let shared = cells(&mut together.iter().flatten());
    assert!(shared < cells(&mut alone.iter()), "{shared}");
    assert_eq!((together, answered), on(3));
}
