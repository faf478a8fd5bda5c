//! Docking runs: probabilities against another engine's, and properties of every run.

use std::sync::Arc;

use tilebind::dynamics::MotionSettings;
use tilebind::dynamics::docking::{
    DockingError, DockingSettings, MatchRule, NoMagnets, dock, trajectory,
};
use tilebind::landscape::Proportion;
use tilebind::{Configuration, Design};

use super::paper_tile;

fn few(runs: usize) -> DockingSettings {
    DockingSettings {
        runs,
        motion: MotionSettings {
            drag: 0.5,
            walls: false,
            ..MotionSettings::default()
        },
        ..DockingSettings::default()
    }
}

/// What the Open Dynamics Engine found from such starts (2000, at steps of 1 to 0.2 ms): shares
/// bound and the half width of their intervals, as it is, when its mean restitution is 0.10
/// although 0.01 is set; and with the speed of its overlap correction limited to 1 cm/s (8000
/// starts), when it is 0.02.
const ENGINE: [(f64, [f64; 2]); 2] = [
    (0.10, [0.072 - 0.011, 0.082 + 0.011]),
    (0.01, [0.0905 - 0.0063, 0.0905 + 0.0063]),
];

/// The engine's share with its actual restitution, and with the one that is set.
#[test]
fn chances_agree_with_the_open_dynamics_engine() {
    for (restitution, [low, high]) in ENGINE {
        let mut settings = few(500);
        settings.motion.restitution = restitution;
        let docking = dock(&paper_tile().problem(), &settings, &|| ()).unwrap();
        let bound = docking.bound;
        assert!(
            bound.low < high && bound.high > low,
            "{restitution}: {bound:?}"
        );
        // The most frequent trap is the bond slid by one magnet.
        assert!((docking.traps[0].energy + 16.026e-3).abs() < 1e-5);
    }
}

#[test]
fn knocks_that_give_back_more_bind_fewer() {
    let share = |restitution| {
        let mut settings = few(500);
        settings.motion.restitution = restitution;
        dock(&paper_tile().problem(), &settings, &|| ())
            .unwrap()
            .bound
    };
    assert!(share(0.5).high < share(0.0).low);
}

#[test]
fn every_run_is_the_same_on_any_number_of_threads_and_by_itself() {
    let problem = paper_tile().problem();
    let settings = few(24);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| dock(&problem, &settings, &|| ()).unwrap().runs)
    };
    let runs = on(1);
    assert_eq!(runs, on(3));
    let snapshots = trajectory(&problem, &settings, 7, 1.0).unwrap();
    assert_eq!(snapshots[0].motion, runs[7].start.motion);
    assert_eq!(*snapshots.last().unwrap(), runs[7].last);
}

#[test]
fn mirrored_tiles_dock_alike_from_either_side() {
    // A code that reads the same both ways makes the pair its own mirror image.
    let text = std::fs::read_to_string("shapes/paper-tile.toml").unwrap();
    let text = text.replace("NNNS", "NSSN").replace("NSSS", "SNNS");
    let design = Design::parse(&text, "mirror.toml").unwrap();
    let mut settings = few(500);
    settings.starts.speed = [0.1, 0.7];
    let docking = dock(&design.problem(), &settings, &|| ()).unwrap();
    let share = |is_left: bool| {
        let runs = docking.runs.iter();
        let side = runs.filter(|run| (run.start.orientation < 0.0) == is_left);
        let bound = side.clone().filter(|run| run.is_bound());
        Proportion::new(bound.count(), side.count())
    };
    let [left, right] = [true, false].map(share);
    assert!(left.count + right.count > 20, "{left:?} {right:?}");
    assert!(
        left.low < right.high && right.low < left.high,
        "{left:?} {right:?}"
    );
}

#[test]
fn a_match_needs_every_pair_and_holds_for_all_alike_faces() {
    let design = paper_tile();
    let rule = MatchRule::new(&design.problem(), None).unwrap();
    assert!((rule.threshold - 0.015).abs() < 1e-12);
    assert!(rule.holds(&design.pair.bound));
    // Two faces on: the same bond of another pair of faces.
    assert!(rule.holds(&Configuration::new(0.0, 0.43, 0.0)));
    assert!(rule.holds(&Configuration::new(-0.43, 0.0, std::f64::consts::FRAC_PI_2)));
    // Partners 10 mm apart across the gap, slid by 11.1 mm: 14.9 mm; by 11.3 mm: 15.1 mm.
    assert!(rule.holds(&Configuration::new(0.43, 0.0111, 0.0)));
    assert!(!rule.holds(&Configuration::new(0.43, 0.0113, 0.0)));
    assert!(!rule.holds(&Configuration::new(0.43, 0.04, 0.0)));
}

#[test]
fn tiles_without_magnets_on_the_target_are_refused() {
    let mut design = paper_tile();
    let pair = Arc::make_mut(&mut design.pair);
    pair.moving.magnets.retain(|m| m.face != pair.target.1);
    let refused = dock(&design.problem(), &few(1), &|| ()).unwrap_err();
    assert_eq!(refused, DockingError::NoMagnets(NoMagnets));
}
