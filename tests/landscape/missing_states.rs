//! Proofs that a list of states is complete: they find states that were removed, claim nothing
//! about regions that were hidden from them, and report where they are unfinished.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::budget::Allowance;
use tilebind::landscape::exploration::{Exploration, ExplorationSettings};
use tilebind::landscape::minimum::{Outcome, descend};
use tilebind::landscape::missing_states::StateSearch;
use tilebind::landscape::{Catalogue, Completeness, CompletenessSettings};
use tilebind::observer::Silent;
use tilebind::pipeline::Request;
use tilebind::roadmap::Point;
use tilebind::roadmap::RoadmapSettings;
use tilebind::tile::face_to_face;
use tilebind::{Configuration, Design, Problem};

use crate::designs::load;
use crate::surveys;

/// Traps deeper than a hundredth of the bond with an escape barrier of half of that.
pub const USUAL: CompletenessSettings = CompletenessSettings {
    below: 0.01,
    escape: 0.005,
    cells: 1_000_000,
    allowed: Allowance::UNLIMITED,
};

/// Settings of a survey with this many milestones.
fn settings(problem: &Problem, milestones: usize) -> (RoadmapSettings, ExplorationSettings) {
    let request = Request::default().surveyed(milestones, 0);
    let roadmap = request.roadmap(problem);
    let settings = ExplorationSettings {
        edge: roadmap.edges,
        settled: request.survey.settled,
        most_kinds: None,
        added_milestones: 100,
        most_rounds: 8,
        seed: 1,
    };
    (roadmap, settings)
}

pub fn survey(problem: &Problem, milestones: usize) -> Exploration<'_> {
    let (roadmap, settings) = settings(problem, milestones);
    let built = surveys::weighed(problem, &roadmap);
    surveys::survey(problem, built, &settings)
}

fn conclude(survey: &Exploration, search: StateSearch) -> Completeness {
    let listed = Catalogue::of_survey(survey, 1e-4, &Silent);
    search.conclude(survey, &listed)
}

#[test]
fn minima_where_the_outlines_fit_need_no_milestones() {
    // Odd outlines: where notch and tip meet, no two faces do.
    let problem = load("shapes/arrowhead.toml").problem();
    let survey = survey(&problem, 10);
    let mut found = 0;
    for place in problem.matches(100) {
        let Outcome::Minimum(minimum) = descend(&problem, &place).outcome else {
            continue;
        };
        let Point { q, energy, .. } = minimum.point;
        if energy < -0.01 * problem.depth() {
            assert!(survey.state_at(&q, 1e-5).is_some(), "{q:?}");
            found += 1;
        }
    }
    assert!(found > 5, "{found}");
}

/// Shallow ones that few milestones lead into.
#[test]
fn tilted_traps_of_faces_that_slide_are_found_with_any_milestones() {
    let problem = load("tests/designs/good/bars.toml").problem();
    let survey = survey(&problem, 10);
    for [x, y, theta, energy] in [
        [0.065791671, -0.048002759, -0.028603450, -0.38688e-3],
        [0.054928775, 0.439586631, 0.026799278, -0.37194e-3],
        [0.067551874, -0.437652637, 0.030267079, -0.25002e-3],
    ] {
        let found = survey.state_at(&Configuration::new(x, y, theta), 1e-6);
        let found = &survey.states[found.unwrap()].minimum.point;
        assert!((found.energy - energy).abs() < 1e-8, "{found:?}");
    }
}

#[test]
fn forgotten_traps_are_found_again_and_the_list_is_proved() {
    let problem = load("shapes/paper-tile.toml").problem();
    let mut survey = survey(&problem, 2000);
    let energies = |survey: &Exploration| -> Vec<f64> {
        let deep = survey.states.iter().map(|state| state.minimum.point.energy);
        let mut deep: Vec<f64> = deep.filter(|energy| *energy < -0.7e-3).collect();
        deep.sort_by(f64::total_cmp);
        deep
    };
    let all = energies(&survey);
    survey
        .states
        .retain(|state| state.minimum.point.energy < -60e-3);
    assert!(survey.states.len() < all.len());
    let search = StateSearch::run(&problem, &survey, &USUAL, &Silent).unwrap();
    assert!(!search.missed().is_empty());
    survey.add(&search.missed());
    let found = energies(&survey);
    assert_eq!(found.len(), all.len());
    for (found, known) in found.iter().zip(&all) {
        assert!(
            (found - known).abs() < 1e-9 * known.abs(),
            "{found} {known}"
        );
    }
    let complete = conclude(&survey, search);
    assert!(complete.is_complete(), "{:?}", complete.open);
    assert_eq!(complete.share, 0.0);
    assert!((complete.below / problem.depth() + 0.01).abs() < 1e-12);
}

/// They need a path on to a listed one that does not rise more than allowed.
#[test]
fn traps_too_shallow_to_list_lead_on_to_listed_ones() {
    let problem = load("tests/designs/good/triangles.toml").problem();
    let survey = survey(&problem, 1000);
    let allowed = CompletenessSettings {
        escape: 0.03,
        ..USUAL
    };
    let without = |least_depth| {
        let search = StateSearch::run(&problem, &survey, &allowed, &Silent).unwrap();
        let listed = Catalogue::of_survey(&survey, least_depth, &Silent);
        (listed.states.len(), search.conclude(&survey, &listed))
    };
    let (most, complete) = without(0.025);
    let all = Catalogue::of_survey(&survey, 1e-4, &Silent).states.len();
    assert!(most < all, "{most} {all}");
    assert!(complete.is_complete(), "{:?}", complete.open);
    let (few, open) = without(0.3);
    assert!(few < most, "{few} {most}");
    assert!(open.lowest() < -0.2 * problem.depth(), "{:?}", open.open);
}

#[test]
fn tilted_traps_behind_a_tab_are_found() {
    let problem = load("tests/designs/good/square-tab.toml").problem();
    let mut survey = survey(&problem, 500);
    let deep = CompletenessSettings {
        below: 0.1,
        escape: 0.05,
        ..USUAL
    };
    let search = StateSearch::run(&problem, &survey, &deep, &Silent).unwrap();
    let trap = Configuration::new(0.170439631, -0.046621664, 2.903201968);
    let is_trap = |q: &Configuration| problem.space.distance(q, &trap) < 1e-5;
    let missed = search.missed();
    assert!(
        survey
            .states
            .iter()
            .any(|state| is_trap(&state.minimum.point.q))
            || missed.iter().any(|minimum| is_trap(&minimum.point.q)),
        "{missed:?}"
    );
    survey.add(&missed);
    assert!(conclude(&survey, search).is_complete());
}

#[test]
fn what_was_not_looked_at_is_open_and_covers_all_that_may_hide_something() {
    let problem = load("shapes/paper-tile.toml").problem();
    let survey = survey(&problem, 500);
    let hasty = CompletenessSettings {
        cells: 10_000,
        ..USUAL
    };
    let search = StateSearch::run(&problem, &survey, &hasty, &Silent).unwrap();
    let known = conclude(&survey, search);
    assert!(!known.is_complete());
    assert!(known.share > 0.0 && known.share < 1.0);
    assert!(known.open.is_sorted_by(|a, b| a.lowest <= b.lowest));
    assert!(
        known.open[0].lowest < -60e-3,
        "the bond's surroundings take longer"
    );
}

#[test]
fn an_energy_without_bounds_or_no_work_proves_nothing() {
    let problem = load("shapes/shielded-nearest-face.toml").problem();
    let survey = survey(&problem, 100);
    assert!(StateSearch::run(&problem, &survey, &USUAL, &Silent).is_err());
    let none = CompletenessSettings {
        allowed: Allowance::NONE,
        ..USUAL
    };
    let problem = load("shapes/paper-tile.toml").problem();
    assert!(StateSearch::run(&problem, &survey, &none, &Silent).is_err());
}

/// A small square tile with a hole for a peg in a random place of a random face, a magnet behind
/// its floor and one in the peg's tip; a few random magnets elsewhere. The intended bond is a
/// different one. Returns also the indices of the two faces, and the slide at which they meet.
fn planted(rng: &mut ChaCha8Rng) -> (Design, [usize; 2], f64) {
    let slots = 9;
    let [fixed, moving] = [0; 2].map(|_| rng.random_range(1..4usize));
    let slot = rng.random_range(2..slots - 2usize);
    let half = rng.random_range(2.4e-3..4.5e-3);
    let depth: f64 = rng.random_range(3e-3..9e-3);
    let play = rng.random_range(0.1e-3..0.6e-3);
    let single = |at: usize, pole: char| -> String {
        (0..slots)
            .map(|k| if k == at { pole } else { '.' })
            .collect()
    };
    let mut code = |pole: bool| -> String {
        let letter = |_| match rng.random_range(0..6) {
            0 if pole => 'N',
            0 => 'S',
            _ => '.',
        };
        (0..slots).map(letter).collect()
    };
    let at = |slot: usize| 5e-3 * (slot as f64 - (slots - 1) as f64 / 2.0);
    let profile = |slot: usize, half: f64, depth: f64| {
        let (a, b) = (at(slot) - half, at(slot) + half);
        format!(
            "{{ shape = \"points\", points = [[{a}, 0.0], [{a}, {depth}], [{b}, {depth}], [{b}, 0.0]] }}"
        )
    };
    let mirrored = slots - 1 - slot;
    let text = format!(
        "name = \"planted\"\n[table]\nsize = [0.5, 0.5]\n\
         [magnet]\nsize = [0.004, 0.003, 0.003]\nremanence = 1.2\npitch = 0.005\ninset = 0.001\n\
         [fixed]\nside = 0.06\nthickness = 0.008\nmass = 0.03\n[fixed.faces]\n\
         0 = {{ code = \"{}\" }}\n{fixed} = {{ code = \"{}\", profile = {} }}\n\
         [moving]\nside = 0.06\nthickness = 0.008\nmass = 0.03\n[moving.faces]\n\
         0 = {{ mates = \"0\" }}\n{moving} = {{ code = \"{}\", profile = {} }}\n\
         [target]\nfixed = \"0\"\nmoving = \"0\"\n[potential]\nmodel = \"dipole\"\n",
        code(true).replace("........", "N......."),
        single(slot, 'N'),
        profile(slot, half, -depth),
        single(mirrored, 'S'),
        profile(mirrored, half - play, depth - play),
    );
    let design = Design::parse(&text, "planted").unwrap_or_else(|error| panic!("{error}\n{text}"));
    (design, [fixed, moving], play)
}

#[test]
fn a_planted_trap_is_found_or_completeness_is_not_claimed() {
    plant(15);
}

#[test]
#[ignore = "slow"]
fn none_of_a_hundred_planted_traps_is_denied() {
    plant(100);
}

fn plant(number_of_traps: usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(14);
    let (mut found, mut claimed) = (0, 0);
    for number in 0..number_of_traps {
        let (design, [fixed, moving], play) = planted(&mut rng);
        let problem = design.problem();
        let faces = problem.faces();
        let (fixed, moving) = (&faces[0][fixed], &faces[1][moving]);
        let flush = face_to_face(fixed, moving, 0.0, 0.0);
        let lifted = flush.position() + fixed.normal() * 0.5 * play;
        let start = Configuration::new(lifted.x, lifted.y, flush.theta);
        assert!(problem.is_free(&start), "{number}");
        let Outcome::Minimum(trap) = descend(&problem, &start).outcome else {
            continue;
        };
        // A survey with almost no effort.
        let (roadmap, settings) = settings(&problem, 20);
        let built = surveys::weighed(&problem, &roadmap);
        let survey = Exploration::of_roadmap(&problem, built, &settings);
        let looked_for = CompletenessSettings {
            below: 0.3,
            escape: 0.15,
            cells: 60_000,
            ..USUAL
        };
        let search = StateSearch::run(&problem, &survey, &looked_for, &Silent).unwrap();
        let is_trap = |q: &Configuration| problem.space.distance(q, &trap.point.q) < 1e-4;
        let is_found = search
            .missed()
            .iter()
            .any(|minimum| is_trap(&minimum.point.q));
        let is_deep = trap.point.energy < -0.3 * problem.depth();
        let is_claimed = search.open.is_empty();
        found += usize::from(is_found);
        claimed += usize::from(is_claimed);
        assert!(
            is_found || !is_deep || !is_claimed,
            "{number}: {:?}",
            trap.point
        );
    }
    assert!(
        found.min(claimed) > number_of_traps * 3 / 5,
        "found {found}, claimed {claimed} of {number_of_traps}"
    );
}
