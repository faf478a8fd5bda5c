//! Barriers of real tiles: none lower by way of a third state, and a way out without play.

use tilebind::Settings;
use tilebind::landscape::{Barrier, Place};
use tilebind::observer::Silent;
use tilebind::pipeline::analyse;

use crate::designs;

#[test]
fn no_two_barriers_of_the_papers_tile_lead_lower_than_a_third_one() {
    let design = designs::load("shapes/paper-tile.toml");
    let analysis = analyse(&design, &Settings::default(), &Silent);
    let barriers = &analysis.inventory.barriers;
    let mut compared = 0;
    for first in barriers {
        for second in barriers.iter().filter(|b| b.from == first.to) {
            let direct = |b: &&Barrier| b.from == first.from && b.to == second.to;
            for direct in barriers.iter().filter(direct) {
                let upper = |barrier: &Barrier| barrier.bounds.upper.unwrap();
                let chain = upper(first).max(upper(second));
                assert!(upper(direct) <= chain + 1e-6 * 65.5e-3, "{direct:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 10, "{compared}");
}

#[test]
fn teeth_without_play_are_pulled_out_straight() {
    let design = designs::load("shapes/square-teeth-10mm.toml");
    let settings = Settings {
        milestones: 300,
        certify_seconds: 0.0,
        far_starts: 1,
        ..Settings::default()
    };
    let analysis = analyse(&design, &settings, &Silent);
    let way_out = analysis.inventory.way_out_of_the_bond().unwrap();
    assert_eq!((way_out.from, way_out.to), (Place::State(0), Place::Free));
    // It never climbs.
    assert!(way_out.saddle_energy < 0.0, "{}", way_out.saddle_energy);
    assert!(way_out.pathway.iter().all(|point| point.clearance > -1e-9));
}
