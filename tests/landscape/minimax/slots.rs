//! Slots: deep ones without play, in which almost every configuration overlaps, and one with little play.

use tilebind::design::Design;
use tilebind::observer::Silent;
use tilebind::pipeline::{MILESTONES, Request, analyse};

use crate::designs;

/// Five square teeth of this depth (m).
fn teeth(depth: f64) -> Design {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/shapes/square-teeth-10mm.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let deeper = text.replace("depth = 0.010", &format!("depth = {depth}"));
    assert_ne!(deeper, text);
    Design::parse(&deeper, "deep.toml").unwrap()
}

/// Between teeth that stand on each other slots lead to other bonds. If the ways in are known, the
/// divide between two states lies outside the slots, not in them.
#[test]
fn no_cells_are_lost_in_slots_through_which_ways_are_known() {
    let settings = Request {
        complete_work: Some(0.0),
        ..Request::default().surveyed(4000, 100)
    };
    let analysis = analyse(&teeth(0.05), &settings, &Silent);
    // Three of them do not reach a worthwhile width after 20,000 to 50,000 cells each.
    let cells = analysis.counts.cells;
    assert!(cells < 300_000, "{cells}");
}

/// Between a tab and a slot, contacts near a point are closed on more than one side, and corners a
/// millimetre away are misleading when a pathway is lifted off contact.
#[test]
fn pathways_out_of_a_slot_are_proved_no_higher_than_they_lead() {
    let settings = Request {
        complete_work: Some(0.0),
        ..Request::default().surveyed(MILESTONES, 100)
    };
    let design = designs::load("shapes/dovetail.toml");
    let analysis = analyse(&design, &settings, &Silent);
    let told = analysis.catalogue.barriers.iter().filter(|b| b.has_way());
    let excess: Vec<f64> = told
        .map(|b| (b.bounds.upper.unwrap() - b.saddle_energy) / b.forward())
        .collect();
    // The worthwhile width.
    assert!(
        excess.len() >= 5 && excess.iter().all(|excess| *excess < 0.05),
        "{excess:?}"
    );
    // The barriers of two traps turned out to be a thousandth of their first estimates.
    let shallow = analysis
        .catalogue
        .barriers
        .iter()
        .filter(|b| b.has_way() && b.forward() < 1e-5);
    let widths: Vec<f64> = shallow.map(|b| b.bounds.width()).collect();
    let wanted = 1e-5 * analysis.problem.depth();
    assert!(
        widths.len() == 2 && widths.iter().all(|width| *width <= wanted),
        "{widths:?} {wanted}"
    );
}
