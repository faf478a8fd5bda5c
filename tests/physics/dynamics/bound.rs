//! A tile in the bond or beside it, by the conservation of energy.

use tilebind::dynamics::docking::{DockingSettings, trajectory};

use super::*;

/// The total energy (J) of each step of a tile released from rest in contact, slid along the face by
/// `slide` (m), and the largest kinetic energy (J).
fn slid(settings: &MotionSettings, slide: f64, duration: f64) -> (Vec<f64>, f64) {
    let design = paper_tile();
    let problem = design.problem();
    let body = Body::of_tile(&design.pair.moving);
    let bound = design.pair.bound;
    // Where the engine keeps the outlines apart: nothing is lost in a first knock.
    let start = ([bound.x + 3.2e-7, bound.y + slide, bound.theta], [0.0; 3]);
    let (run, snapshots) = run(&problem, body, settings, start, duration);
    assert!(run.contact_steps > 5, "{run:?}");
    let kinetic = snapshots.iter().map(|it| it.kinetic).fold(0.0, f64::max);
    (snapshots.iter().map(Snapshot::total).collect(), kinetic)
}

/// Without friction a tile that slides to and fro along the face keeps its energy: the error does not
/// grow, and is less in shorter steps.
#[test]
fn sliding_without_friction_keeps_energy() {
    let worst = |share: f64| {
        let usual = MotionSettings::default();
        let settings = MotionSettings {
            contact_step: share * usual.contact_step,
            ..ideal()
        };
        let (totals, kinetic) = slid(&settings, 1e-3, 10.0);
        let error = totals.iter().map(|it| (it - totals[0]).abs());
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let (early, late) = totals.split_at(totals.len() / 2);
        let drift = (mean(late) - mean(early)).abs();
        [error.fold(0.0, f64::max) / kinetic, drift / kinetic]
    };
    let found = [1.0, 0.5, 0.25].map(worst);
    let [whole, half, quarter] = found.map(|it| it[0]);
    assert!(
        whole < 2e-3 && half < whole / 3.0 && quarter < whole / 3.0,
        "{found:?}"
    );
    assert!(found.iter().all(|it| it[1] < 1e-3), "{found:?}");
}

/// Elastic and without friction, a tile that bounces in the bond keeps its energy. Where it grazes the other tile,
/// a knock in the middle of a step gives or takes some for a while, in a start of twenty or so more than 2 %.
#[test]
fn elastic_bounces_in_the_bond_keep_energy() {
    let settings = MotionSettings {
        restitution: 1.0,
        ..ideal()
    };
    let design = paper_tile();
    let problem = design.problem();
    let body = Body::of_tile(&design.pair.moving);
    let bound = design.pair.bound;
    let mut errors = Vec::new();
    for k in 0..20 {
        let across = if k % 2 == 0 { [0.0, 0.0] } else { [0.05, 0.3] };
        let velocity = [0.1 + 0.002 * f64::from(k), across[0], across[1]];
        let start = ([bound.x + 1e-4, bound.y + 1e-4, bound.theta], velocity);
        let (run, snapshots) = run(&problem, body, &settings, start, 4.0);
        assert!(k > 1 || run.contact_steps > 1000, "{run:?}");
        let off = snapshots.iter().map(|it| it.total() - snapshots[0].total());
        let most = off.map(f64::abs).fold(0.0, f64::max);
        errors.push(most / snapshots[0].kinetic);
    }
    errors.sort_by(f64::total_cmp);
    assert!(errors[14] < 0.02 && errors[19] < 0.1, "{errors:?}");
}

/// A tile that is wedged between a tab and a face is stopped, though this takes many sweeps.
#[test]
fn a_tile_wedged_in_a_knock_is_stopped() {
    let problem = designs::load("shapes/tab-20mm.toml").problem();
    let found = trajectory(&problem, &DockingSettings::default(), 592, 0.1);
    assert!(found.is_ok_and(|it| it.len() > 50));
}

/// Whatever the friction and the restitution, contact gives no energy.
#[test]
fn contact_with_friction_only_takes_energy() {
    let depth = paper_tile().problem().depth();
    for friction in [0.1, 0.3, 1.0, 2.0] {
        for restitution in [0.0, 0.01, 0.5, 1.0] {
            let settings = MotionSettings {
                friction,
                restitution,
                ..ideal()
            };
            for slide in [4e-3, 0.03] {
                let (totals, _) = slid(&settings, slide, 2.0);
                for pair in totals.windows(2) {
                    let rise = pair[1] - pair[0];
                    assert!(
                        rise < 1e-4 * depth,
                        "{friction} {restitution} {slide}: {rise}"
                    );
                }
                let whole = totals[totals.len() - 1] - totals[0];
                assert!(
                    whole < 1e-4 * depth,
                    "{friction} {restitution} {slide}: {whole}"
                );
            }
        }
    }
}
