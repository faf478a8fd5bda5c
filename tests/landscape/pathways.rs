//! The written pathways are the proved ones: joined by straight motions (linear in x, y and theta,
//! theta the short way) they are free and rise nowhere above the stated peak. And tiles dock along
//! the natural way.

use tilebind::landscape::{Barrier, Place, highest_point, work};
use tilebind::observer::Silent;
use tilebind::pipeline::{Certify, MILESTONES, Request, analyse};
use tilebind::report::csv;
use tilebind::{Analysis, Configuration};

use crate::designs;

/// Deepest overlap (m) of the straight motions.
const OVERLAP: f64 = 1e-6;
/// Samples of each straight motion, and the longest step (m) between them.
const SAMPLES: usize = 6;
const STEP: f64 = 1e-3;

fn analysis(file: &str) -> Analysis {
    let settings = Request {
        certify: Certify::of(f64::INFINITY),
        certify_cells: 2000,
        complete_work: Some(0.0),
        ..Request::default().surveyed(600, 60)
    };
    analyse(&designs::load(file), &settings, &Silent)
}

/// The configurations of a pathway as its file has them.
fn written(barrier: &Barrier) -> Vec<Configuration> {
    let table = csv::pathway(&barrier.pathway);
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        Configuration::new(cells[1], cells[2], cells[3])
    };
    table.lines().skip(1).map(row).collect()
}

/// Samples every leg of every pathway, however it was found.
fn check(file: &str) {
    let analysis = analysis(file);
    let problem = &analysis.problem;
    let depth = problem.depth();
    let mut checked = 0;
    for barrier in analysis.catalogue.barriers.iter().filter(|b| b.has_way()) {
        let ends = (barrier.from, barrier.to);
        let mut highest = f64::NEG_INFINITY;
        for leg in written(barrier).windows(2) {
            let length = problem.space.distance(&leg[0], &leg[1]);
            let count = SAMPLES.max((length / STEP) as usize);
            for k in 0..=count {
                let q = leg[0].interpolate(&leg[1], k as f64 / count as f64);
                let clearance = problem.clearance(&q);
                assert!(
                    clearance >= -OVERLAP,
                    "{file} {ends:?}: {clearance} at {q:?}"
                );
                highest = highest.max(problem.energy(&q));
            }
        }
        let stated = barrier.saddle_energy;
        assert!(
            (highest - stated).abs() <= 1e-5 * depth,
            "{file} {ends:?}: {highest} for {stated}"
        );
        assert_eq!(highest_point(&barrier.pathway).unwrap().energy, stated);
        checked += 1;
    }
    assert!(checked > 0, "{file}");
}

#[test]
fn pathways_joined_by_straight_motions_are_free_and_as_high_as_stated() {
    for file in [
        "shapes/tab-20mm.toml",
        "shapes/dovetail.toml",
        "shapes/arc-20mm.toml",
        "tests/designs/good/ties.toml",
        "tests/designs/good/narrow-slot.toml",
        "tests/designs/good/triangles.toml",
    ] {
        check(file);
    }
}

/// More than half of all far starts are captured by the bond, so there are paths that never climb.
#[test]
fn the_papers_tile_docks_downhill_past_no_trap() {
    let analysis = analysis("shapes/paper-tile.toml");
    let problem = &analysis.problem;
    let way_out = analysis.catalogue.way_out_of_the_bond().unwrap();
    let [climbs, falls] = work(&way_out.pathway);
    assert!(falls < 1e-5 * problem.depth(), "{falls}");
    assert!((climbs - way_out.forward()).abs() < 1e-5 * problem.depth());
    for state in analysis.catalogue.states.iter().skip(1) {
        let passes = |q: &Configuration| problem.space.distance(q, &state.configuration) < 0.01;
        let pathway = &way_out.pathway;
        assert!(
            !pathway.iter().any(|p| passes(&p.configuration)),
            "{state:?}"
        );
    }
    // No farther than it has to go.
    let length = way_out.length().unwrap();
    assert!(length < 0.3, "{length}");
}

/// The ends of barriers, and the widths (J) of their brackets.
type Widths = Vec<([Place; 2], f64)>;

/// The work for a wide bracket is reused for the narrow one.
#[test]
fn a_smaller_tolerance_never_gives_a_wider_bracket() {
    let design = designs::load("tests/designs/good/ties.toml");
    let brackets = |tolerance: f64, cells: usize| -> Widths {
        let settings = Request {
            certify: Certify::of(f64::INFINITY),
            certify_cells: cells,
            tolerance: Some(tolerance),
            ..Request::default().surveyed(1000, 50)
        };
        let catalogue = analyse(&design, &settings, &Silent).catalogue;
        let barriers = catalogue.barriers.iter();
        let brackets = barriers.map(|b| ([b.from, b.to], b.bounds.width()));
        brackets.collect()
    };
    let depth = 32e-3;
    let wide = brackets(0.02 * depth, 4000);
    let narrow = brackets(0.003 * depth, 4000);
    let narrowest = brackets(1e-5 * depth, 4000);
    assert!(wide.len() > 5);
    // More work may also find lower ways to other places, which are listed beside.
    let of = |brackets: &Widths, ends: &[Place; 2]| {
        brackets
            .iter()
            .find(|found| found.0 == *ends)
            .map(|found| found.1)
    };
    let no_wider = |narrow: &Widths, wide: &Widths| {
        let is_no_wider =
            |(ends, wide): &([Place; 2], f64)| of(narrow, ends).is_some_and(|it| it <= *wide);
        wide.iter().all(is_no_wider)
    };
    assert!(no_wider(&narrow, &wide), "{narrow:?} {wide:?}");
    assert!(no_wider(&narrowest, &narrow), "{narrowest:?} {narrow:?}");
    let total =
        |of_all: &Widths| -> f64 { wide.iter().filter_map(|(ends, _)| of(of_all, ends)).sum() };
    assert!(total(&narrowest) < 0.9 * total(&wide));
}

/// Parallel searches share weighed motions, in any order: the choice between two equally good
/// routes does not depend on it.
#[test]
fn ways_are_the_same_on_any_number_of_threads() {
    let design = designs::load("shapes/square-teeth-10mm.toml");
    let settings = Request::default().unproved().surveyed(MILESTONES, 60);
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| analyse(&design, &settings, &Silent))
    });
    assert_eq!(one.catalogue.barriers, two.catalogue.barriers);
    assert_eq!(one.catalogue.alternatives, two.catalogue.alternatives);
    assert_eq!(one.counts.energy_evaluations, two.counts.energy_evaluations);
}

/// The exchange of two equal tiles bends straight motions that turn: pathways of copies follow the bent
/// ones, with lengths of their own.
#[test]
fn pathways_of_exchanged_copies_are_free() {
    let analysis = analysis("shapes/ring-of-eight.toml");
    let (problem, catalogue) = (&analysis.problem, &analysis.catalogue);
    let exchange = problem.exchange.expect("equal tiles");
    let least = |path: &[Configuration]| {
        let legs = path.windows(2).flat_map(|leg| {
            (0..=50).map(move |k| leg[0].interpolate(&leg[1], f64::from(k) / 50.0))
        });
        legs.map(|q| problem.clearance(&q))
            .fold(f64::INFINITY, f64::min)
    };
    let mut bent: f64 = 0.0;
    for state in catalogue.states.iter().filter(|it| it.id != it.class) {
        let Some(escape) = catalogue.escape(problem, state.id) else {
            continue;
        };
        let path: Vec<Configuration> = escape.pathway.iter().map(|it| it.configuration).collect();
        let found = least(&path);
        assert!(found > -5e-7, "state {}: {found:e} m", state.id);
        let length: f64 = path
            .windows(2)
            .map(|leg| problem.space.distance(&leg[0], &leg[1]))
            .sum();
        let stated = escape.pathway.last().map_or(0.0, |last| last.s);
        assert!(
            (stated - length).abs() <= 1e-9 * length,
            "{stated} {length}"
        );
        // The images of the points alone, joined by straight motions.
        let of_first = catalogue
            .escape(problem, state.class)
            .expect("that of the kind");
        let images: Vec<_> = of_first
            .pathway
            .iter()
            .map(|it| exchange.apply(&it.configuration))
            .collect();
        bent = bent.min(least(&images));
    }
    assert!(bent < -5e-7, "nothing is bent: {bent:e} m");
}
