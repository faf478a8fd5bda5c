//! Barriers of real tiles: no barrier is higher than a path via a third state, nor are its bounds
//! worse than that path's; and an exit without play.

use tilebind::landscape::{Barrier, Claims, Place};
use tilebind::observer::Silent;
use tilebind::pipeline::{Certify, MILESTONES, Request, analyse};
use tilebind::{Analysis, Configuration};

use crate::designs;

/// Barriers, those that start where they end, and those that lead to the same places at once.
fn triples(barriers: &[Barrier]) -> impl Iterator<Item = [&Barrier; 3]> {
    barriers.iter().flat_map(move |first| {
        let onward = barriers.iter().filter(|b| b.from == first.to);
        onward.flat_map(move |second| {
            let direct = move |b: &&Barrier| b.from == first.from && b.to == second.to;
            let direct = barriers.iter().filter(direct);
            direct.map(move |direct| [first, second, direct])
        })
    })
}

#[test]
fn no_two_barriers_of_the_papers_tile_lead_lower_than_a_third_one() {
    let design = designs::load("shapes/paper-tile.toml");
    let analysis = analyse(&design, &Request::default(), &Silent);
    let mut compared = 0;
    for [first, second, direct] in triples(&analysis.catalogue.barriers) {
        let upper = |barrier: &Barrier| barrier.bounds.upper.unwrap();
        let chain = upper(first).max(upper(second));
        // A natural path to free is not replaced by one that is lower by a hundredth of the
        // barrier.
        let allowed = match direct.to {
            Place::Free => 0.01 * direct.forward(),
            Place::State(_) => 1e-6 * 65.5e-3,
        };
        assert!(upper(direct) <= chain + allowed, "{direct:?}");
        compared += 1;
    }
    assert!(compared > 10, "{compared}");
}

/// The two highest of the minimax energies between three places are equal: a bound for the second
/// part of a path holds for the whole path if the first part is lower, in whichever order they were
/// proved.
#[test]
fn what_is_proved_of_a_ways_end_is_proved_of_the_way() {
    let settings = Request {
        complete_work: Some(0.0),
        ..Request::default().surveyed(MILESTONES, 100)
    };
    let design = designs::load("shapes/arrowhead.toml");
    let analysis = analyse(&design, &settings, &Silent);
    let mut compared = 0;
    for [first, second, direct] in triples(&analysis.catalogue.barriers) {
        let upper = first.bounds.upper.unwrap();
        if let Some(lower) = second.bounds.lower.filter(|lower| upper < *lower) {
            assert!(direct.bounds.least() >= lower, "{direct:?}");
            compared += 1;
        }
    }
    assert!(compared > 3, "{compared}");
}

/// Few milestones and no certificate.
fn square_teeth() -> Analysis {
    let design = designs::load("shapes/square-teeth-10mm.toml");
    let settings = Request::default().unproved().surveyed(300, 1);
    analyse(&design, &settings, &Silent)
}

#[test]
fn teeth_without_play_are_pulled_out_straight() {
    let analysis = square_teeth();
    let way_out = analysis.catalogue.way_out_of_the_bond().unwrap();
    assert_eq!((way_out.from, way_out.to), (Place::State(0), Place::Free));
    // It never climbs.
    assert!(way_out.saddle_energy < 0.0, "{}", way_out.saddle_energy);
    assert!(way_out.pathway.iter().all(|point| point.clearance > -1e-9));
}

/// Where the teeth's tips meet, a tile rests 0.07 mm beside the entrance, which has no play; the
/// climb to it is 0.3 uJ.
#[test]
fn what_rests_beside_the_way_in_is_no_trap() {
    let analysis = square_teeth();
    let tips = Configuration::new(0.44, 0.0, 0.0);
    for state in &analysis.catalogue.states {
        let away = analysis.problem.space.distance(&state.configuration, &tips);
        assert!(away > 1e-3, "{:?}", state.configuration);
    }
}

/// The lowest exit of the teeth's trap, slid by one pitch, leads to the bond. It is hardly lower
/// than the one to `free`, and too narrow for any roadmap.
#[test]
fn no_way_out_is_left_out_because_the_roadmap_does_not_hold_it() {
    let design = designs::load("shapes/square-teeth-10mm.toml");
    let settings = Request {
        certify: Certify::of(f64::INFINITY),
        certify_cells: 50_000,
        claims: Claims::BondAndDeepestTrap,
        complete_work: Some(0.0),
        ..Request::default().surveyed(MILESTONES, 1)
    };
    let analysis = analyse(&design, &settings, &Silent);
    let escape = analysis.escape(1).unwrap();
    assert_eq!((escape.from, escape.to), (Place::State(1), Place::State(0)));
    let to_free = |b: &&Barrier| (b.from, b.to) == (Place::State(1), Place::Free);
    let to_free = analysis.catalogue.barriers.iter().find(to_free).unwrap();
    let upper = escape.bounds.upper.unwrap();
    assert!(
        upper < to_free.bounds.lower.unwrap(),
        "{escape:?} {to_free:?}"
    );
    assert!(escape.saddle_energy <= upper);
}

/// Two pointed teeth meet point to point: this is on a slope, although no step tried there led
/// downhill.
#[test]
fn what_the_certificate_finds_a_way_down_from_is_no_trap() {
    let design = designs::load("tests/designs/good/vertex-points.toml");
    let settings = Request {
        certify: Certify::of(2.0),
        complete_work: Some(0.0),
        ..Request::default().surveyed(2000, 20)
    };
    let analysis = analyse(&design, &settings, &Silent);
    let states = &analysis.catalogue.states;
    let deepest = states.iter().map(|state| state.energy.abs());
    let least = Request::default().least_depth * deepest.fold(0.0, f64::max);
    for (id, state) in states.iter().enumerate() {
        assert_eq!(
            (state.id, analysis.catalogue.kinds().count()),
            (id, states.len())
        );
        let escape = analysis.escape(id).unwrap();
        assert_eq!(escape.from, Place::State(id));
        assert!(escape.forward() >= least, "{state:?}: {escape:?}");
        let beside = [
            state.configuration.x - 0.16,
            state.configuration.y - 0.046875,
        ];
        assert!(beside[0].hypot(beside[1]) > 1e-4, "{state:?}");
    }
    let is_listed = |place: Place| match place {
        Place::State(id) => id < states.len(),
        Place::Free => true,
    };
    let barriers = &analysis.catalogue.barriers;
    assert!(
        barriers
            .iter()
            .all(|b| is_listed(b.from) && is_listed(b.to))
    );
}

/// Corners of both tiles meet in the bond: a tile that rests a micrometre from it is bound.
#[test]
fn far_starts_that_rest_beside_the_bond_are_bound() {
    let design = designs::load("tests/designs/good/triangles.toml");
    let settings = Request::default().unproved().surveyed(2000, 4000);
    let analysis = analyse(&design, &settings, &Silent);
    let bound = analysis
        .catalogue
        .kinds()
        .find(|kind| kind.is_bond())
        .unwrap();
    // An independent flow finds 7.8 % there.
    let share = bound.captured();
    assert!(share.low < 0.078 && share.high > 0.078, "{share:?}");
    let uncaptured = analysis.uncaptured;
    assert_eq!(
        uncaptured.at_rest.count + uncaptured.gone.count,
        uncaptured.all().count
    );
    let kinds = analysis.catalogue.kinds();
    let captured: usize = kinds.map(|kind| kind.captured().count).sum();
    assert_eq!(
        captured + uncaptured.all().count,
        settings.survey.far_starts()
    );
}

/// The deepest state's only way out is its barrier, which has all the cells that barriers have: with those
/// of an escape over several ways out, the bracket is 9 % of the depth.
#[test]
#[ignore = "slow"]
fn the_bonds_bracket_is_as_narrow_as_is_sought() {
    let design = designs::load("shapes/self-binding-hexagon.toml");
    let settings = Request {
        claims: Claims::BondAndDeepestTrap,
        complete_work: Some(0.0),
        ..Request::default()
    };
    let analysis = analyse(&design, &settings, &Silent);
    let way_out = analysis.catalogue.way_out_of_the_bond().unwrap();
    let width = way_out.bounds.width();
    assert!(width <= 0.01 * analysis.problem.depth(), "{width}");
}
