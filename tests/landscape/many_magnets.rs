//! Tiles with so many magnets that their energy is evaluated as rarely as possible.

use tilebind::design::Design;
use tilebind::landscape::{Barrier, Place};
use tilebind::observer::Silent;
use tilebind::pipeline::{MILESTONES, Request, analyse};

use crate::designs::load;

/// Two squares, each with a face with this many magnets.
fn of_magnets(count: usize) -> Design {
    let codes = ["NSSN", "SNNS"].map(|code| code.repeat(count / 4));
    let [east, west] = codes.map(|code| format!("{{ code = \"{code}\" }}"));
    let faces = [format!("east = {east}"), format!("west = {west}")];
    squares(0.4 / count as f64, &faces)
}

/// Two squares with magnets at this pitch (m) on these faces.
fn squares(pitch: f64, [fixed, moving]: &[String; 2]) -> Design {
    let tile = "side = 0.43\nthickness = 0.013\nmass = 0.1";
    let text = format!(
        "name = \"many\"\n[table]\nsize = [2.0, 2.0]\n\
         [magnet]\nsize = [0.002, {}, 0.003]\nremanence = 1.2\npitch = {pitch}\ninset = 0.0\n\
         [fixed]\n{tile}\n[fixed.faces]\n{fixed}\n\
         [moving]\n{tile}\n[moving.faces]\n{moving}\n\
         [target]\nfixed = \"east\"\nmoving = \"west\"\n[potential]\nmodel = \"dipole\"\n",
        0.6 * pitch
    );
    Design::parse(&text, "many.toml").unwrap()
}

fn of_kinds(kinds: usize, mut request: Request) -> Request {
    request.survey.kinds = Some(kinds);
    request
}

#[test]
fn of_very_many_magnets_less_is_asked_for() {
    let [few, many, most] = [
        load("shapes/paper-tile.toml"),
        of_magnets(256),
        of_magnets(800),
    ];
    assert_eq!(Request::usual([&few]), Request::default());
    let [of_many, of_most] = [&many, &most].map(|design| Request::usual([design]));
    assert_eq!(Request::usual([&few, &most, &many]), of_most);
    for (more, less) in [(&Request::default(), &of_many), (&of_many, &of_most)] {
        let (more, less) = (&more.survey, &less.survey);
        assert!(more.milestones > less.milestones);
        assert!(more.far_starts > less.far_starts);
        assert!(more.kinds.unwrap_or(usize::MAX) > less.kinds.unwrap());
    }
    // With four times as many pairs, the effort is reduced by 4^(2/3).
    let ratio = MILESTONES as f64 / of_many.survey.milestones() as f64;
    assert!((ratio / 4f64.powf(2.0 / 3.0) - 1.0).abs() < 1e-3, "{ratio}");
    assert!(of_many.has_proofs() && !of_most.has_proofs());
}

#[test]
fn from_every_trap_the_bond_is_reached_through_free_space() {
    let codes = [
        "NSSNSSSNNNNSSNSSSSNNNNSSSNSSNNNN",
        "SSSSNNSNNNSSSSNNNNSNNSSSSNNNSNNS",
    ];
    let faces = codes.map(|code| format!("all = {{ code = \"{code}\" }}"));
    let design = squares(0.0125, &faces);
    let settings = of_kinds(4, Request::usual([&design]).unproved().surveyed(60, 0));
    let analysis = analyse(&design, &settings, &Silent);
    let catalogue = &analysis.catalogue;
    let bond = catalogue.bound_state.unwrap();
    let depth = analysis.problem.depth();
    let is_bond = |place: Place| match place {
        Place::State(state) => catalogue.states[state].class == bond,
        Place::Free => false,
    };
    let to_bond = |barrier: &&Barrier| is_bond(barrier.to) && !is_bond(barrier.from);
    let ways: Vec<_> = catalogue.barriers.iter().filter(to_bond).collect();
    assert!(ways.len() >= 2, "{}", ways.len());
    for way in ways {
        // Far apart the energy is negligible.
        let highest = way.saddle_energy / depth;
        assert!(highest < 1e-3, "{highest} from {:?}", way.from);
    }
}

#[test]
fn the_deepest_kinds_are_kept_and_what_is_left_out_is_said() {
    let design = load("shapes/paper-tile.toml");
    let all = Request::default().unproved().surveyed(500, 0);
    let few = of_kinds(2, all.clone());
    let kinds = |settings: &Request| {
        let analysis = analyse(&design, settings, &Silent);
        let kinds = analysis.catalogue.kinds();
        let energies: Vec<f64> = kinds.map(|kind| kind.first().energy).collect();
        (energies, analysis.counts.left_out)
    };
    let ((all, none), (kept, left)) = (kinds(&all), kinds(&few));
    let left = left.unwrap();
    assert_eq!(none, None);
    assert!(kept.len() < all.len());
    for (kept, deepest) in kept.iter().zip(&all).take(2) {
        assert!((kept / deepest - 1.0).abs() < 1e-9);
    }
    assert!(left.kinds > 0 && left.lowest >= kept[1]);
}

#[test]
fn what_far_starts_come_to_rest_in_is_listed() {
    let design = load("shapes/paper-tile.toml");
    let settings = of_kinds(1, Request::default().unproved().surveyed(20, 300));
    let analysis = analyse(&design, &settings, &Silent);
    let kinds = analysis.catalogue.kinds();
    assert!(kinds.filter(|kind| kind.captured().count > 0).count() > 1);
    assert_eq!(analysis.uncaptured.at_rest.count, 0);
}
