//! Barriers checked by moving tiles: true barriers pass, false ones fail.

use std::sync::OnceLock;

use tilebind::dynamics::Body;
use tilebind::dynamics::check::{BarrierCheck, CheckSettings, SideVerdict, check};
use tilebind::landscape::{Barrier, Place};
use tilebind::observer::Silent;
use tilebind::pipeline::{self, MILESTONES, Request};
use tilebind::{Analysis, Design};

use super::paper_tile;
use crate::designs;

/// Number of runs for each barrier, from either side of its height.
const RUNS: usize = 30;

fn few() -> CheckSettings {
    CheckSettings {
        runs: RUNS,
        controls: RUNS,
        ..CheckSettings::default()
    }
}

/// An analysis without a proof of its list of states.
fn analysis(design: Design, milestones: usize) -> (Design, Analysis) {
    let request = Request {
        complete_work: Some(0.0),
        ..Request::default().surveyed(milestones, 1000)
    };
    let analysis = pipeline::analyse(&design, &request, &Silent);
    (design, analysis)
}

/// The paper's tile and its analysis, made once for all tests.
fn paper() -> &'static (Design, Analysis) {
    static ONCE: OnceLock<(Design, Analysis)> = OnceLock::new();
    ONCE.get_or_init(|| analysis(paper_tile(), MILESTONES))
}

/// The check of an analysed design's barriers by moving tiles, after `change` has modified them.
fn checked(
    (design, analysis): &(Design, Analysis),
    change: impl Fn(&mut Vec<Barrier>),
) -> Vec<BarrierCheck> {
    let mut barriers = analysis.catalogue.barriers.clone();
    change(&mut barriers);
    check(
        &analysis.problem,
        Body::of_tile(&design.pair.moving),
        &analysis.catalogue.states,
        &barriers.iter().collect::<Vec<_>>(),
        &few(),
        &|_, _| (),
    )
}

fn is_out_of_the_slid_bond(barrier: &Barrier) -> bool {
    (barrier.from_energy + 16.026e-3).abs() < 1e-5
}

#[test]
fn no_barrier_of_the_papers_tile_is_contradicted() {
    let checks = checked(paper(), |_| ());
    assert!(checks.len() > 20);
    let mut crossed = 0;
    for check in &checks {
        assert!(!check.is_refuted(), "{check:?}");
        assert_eq!(check.below.runs, RUNS, "{check:?}");
        assert!(check.certified);
        crossed += check.above.0;
    }
    // With more energy than the barriers many do cross.
    assert!(crossed > RUNS / 6 * checks.len(), "{crossed}");
    let from_slid: Vec<_> = checks
        .iter()
        .filter(|check| matches!(check.to, Place::State(_)) && check.climb > 10e-3)
        .collect();
    assert!(!from_slid.is_empty());
    for check in from_slid {
        for side in check.sides {
            assert_eq!(side.unwrap().verdict, SideVerdict::OnThePathway);
        }
        assert!(check.kick.is_none_or(|kick| kick < 2.0 * check.climb));
    }
}

#[test]
fn a_barrier_said_to_be_higher_than_it_is_does_not_stand() {
    for certified in [true, false] {
        let checks = checked(paper(), |barriers| {
            barriers.retain(|b| is_out_of_the_slid_bond(b) && matches!(b.to, Place::State(_)));
            barriers.truncate(1);
            barriers[0].saddle_energy += 10e-3;
            barriers[0].bounds.lower = certified.then_some(barriers[0].saddle_energy);
        });
        assert!(checks[0].is_crossed(), "{checks:?}");
        assert!(checks[0].is_kicked_over(), "{checks:?}");
        assert_eq!(checks[0].is_contradicted(), certified);
        assert_eq!(checks[0].is_overestimated(), !certified);
        let loud = checks[0].describe().starts_with("CONTRADICTION");
        assert_eq!(loud, certified);
        assert!(checks[0].below.example.is_some());
    }
}

#[test]
fn a_pathway_between_other_states_does_not_stand() {
    let checks = checked(paper(), |barriers| {
        barriers.retain(|b| is_out_of_the_slid_bond(b) && matches!(b.to, Place::State(_)));
        barriers.truncate(1);
        let Barrier { from, to, .. } = &mut barriers[0];
        std::mem::swap(from, to);
    });
    assert!(checks[0].is_swapped(), "{checks:?}");
}

#[test]
fn a_caged_tile_stays_whatever_its_energy() {
    let dovetail = analysis(designs::load("shapes/dovetail.toml"), 2000);
    let checks = checked(&dovetail, |barriers| {
        barriers.retain(|b| b.bounds.caged);
    });
    assert_eq!(checks.len(), 1);
    assert!(checks[0].ceiling.is_infinite() && checks[0].below.runs == RUNS);
    assert!(!checks[0].is_refuted(), "{checks:?}");
}

#[test]
fn the_check_is_the_same_on_any_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            checked(paper(), |barriers| {
                barriers.truncate(3);
            })
        })
    };
    assert_eq!(on(1), on(3));
}
