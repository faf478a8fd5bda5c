//! Queries for one barrier: what an answer states about itself is true, and a missing answer has a
//! reason.

use tilebind::landscape::Uncertified;
use tilebind::landscape::minimax::End;
use tilebind::observer::Silent;
use tilebind::pipeline::Certify;
use tilebind::query::{Answer, QueryError, Request, barrier};
use tilebind::{Configuration, Design};

use crate::designs;

fn design() -> Design {
    designs::load("shapes/tab-20mm.toml")
}

/// From the bond, or a pose, to anywhere free.
fn query(from: Configuration, to: End) -> Request {
    Request {
        from,
        to,
        tolerance: None,
        certify: Certify::default(),
        milestones: Some(800),
        seed: 1,
    }
}

/// Checks for every answer.
fn check(design: &Design, query: &Request, answer: &Answer) {
    let problem = design.problem();
    let barrier = &answer.barrier;
    assert_eq!(barrier.from_energy, problem.energy(&query.from));
    let way = &barrier.pathway;
    let (first, last) = (&way[0], &way[way.len() - 1]);
    assert!(problem.space.distance(&first.configuration, &query.from) < 1e-9);
    match &query.to {
        End::At(to) => assert!(problem.space.distance(&last.configuration, to) < 1e-9),
        End::Free => assert!(problem.space.is_far(&last.configuration)),
    }
    assert_eq!(first.s, 0.0);
    assert!(way.windows(2).all(|pair| pair[0].s <= pair[1].s));
    let highest = way
        .iter()
        .map(|p| p.energy)
        .fold(f64::NEG_INFINITY, f64::max);
    let scale = problem.depth();
    assert!((highest - barrier.saddle_energy).abs() < 1e-6 * scale);
    assert!((problem.energy(&barrier.saddle) - barrier.saddle_energy).abs() < 1e-6 * scale);
    for point in way {
        let energy = problem.energy(&point.configuration);
        assert!((energy - point.energy).abs() < 1e-9 * scale);
        assert!(point.clearance > -1e-6);
    }
}

#[test]
fn answers_are_what_they_say() {
    let design = design();
    let bound = design.pair.bound;
    for to in [End::Free, End::At(Configuration::new(0.6, 0.1, 0.3))] {
        let query = query(bound, to);
        let answer = barrier(&design, &query, &Silent).unwrap();
        check(&design, &query, &answer);
        let bounds = answer.barrier.bounds;
        let (lower, upper) = (bounds.lower.unwrap(), bounds.upper.unwrap());
        let width = 0.01 * design.problem().depth();
        assert!(upper - lower <= width, "{lower} {upper}");
        assert!((lower..=upper + 1e-12).contains(&answer.barrier.saddle_energy));
        assert_eq!(answer.uncertified, None);
    }
}

#[test]
fn a_tolerance_is_kept() {
    let design = design();
    let tolerance = 1e-3 * design.problem().depth();
    let query = Request {
        tolerance: Some(tolerance),
        ..query(design.pair.bound, End::Free)
    };
    let answer = barrier(&design, &query, &Silent).unwrap();
    check(&design, &query, &answer);
    assert!(answer.barrier.bounds.width() <= tolerance);
}

#[test]
fn without_work_for_the_certificate_the_roadmap_answers() {
    let design = design();
    let certified = query(design.pair.bound, End::Free);
    let uncertified = Request {
        certify: Certify::of(0.0),
        ..certified.clone()
    };
    let answer = barrier(&design, &uncertified, &Silent).unwrap();
    check(&design, &uncertified, &answer);
    assert_eq!(answer.uncertified, Some(Uncertified::Unasked));
    assert_eq!(answer.barrier.bounds.lower, None);
    // It is an upper estimate of what the certificate encloses.
    let proved = barrier(&design, &certified, &Silent).unwrap();
    let lower = proved.barrier.bounds.lower.unwrap();
    assert!(answer.barrier.saddle_energy >= lower);
}

#[test]
fn ends_that_no_tile_can_be_at_are_refused() {
    let design = design();
    let bound = design.pair.bound;
    let half = design.space().half_size;
    let off = Configuration::new(1.01 * half[0], 0.0, 0.0);
    let inside = Configuration::new(0.2, 0.0, 0.0);
    for (from, to, wrong) in [
        (off, End::Free, off),
        (bound, End::At(off), off),
        (inside, End::Free, inside),
        (bound, End::At(inside), inside),
    ] {
        let error = barrier(&design, &query(from, to), &Silent).unwrap_err();
        match error {
            QueryError::OffTheTable(at, size) => assert_eq!((at, size), (wrong, half)),
            QueryError::Overlap(at, clearance) => {
                assert_eq!(at, wrong);
                assert!(clearance < 0.0 && wrong == inside);
            }
            QueryError::NoWay => panic!("no way to {wrong:?}"),
        }
    }
}

#[test]
fn between_tiles_without_magnets_there_is_no_barrier() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/shapes/tab-20mm.toml");
    let text = std::fs::read_to_string(file).unwrap();
    let bare = Design::parse(&text.replace("code = \"NNNS\", ", ""), "bare.toml").unwrap();
    assert!(bare.problem().is_inert() && !design().problem().is_inert());
    let query = query(bare.pair.bound, End::Free);
    let answer = barrier(&bare, &query, &Silent).unwrap();
    assert_eq!(answer.barrier.saddle_energy, 0.0);
    assert_eq!(answer.barrier.bounds.upper, Some(0.0));
}
