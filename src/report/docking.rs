//! Docking experiments as JSON, CSV and a summary.

use serde::Serialize;
use serde_json::{Value, json};

use super::inspection::pole;
use super::json;
use jobs::design::Design;
use physics::dynamics::docking::{
    Docking, DockingMap, DockingSettings, ENGINE, End, MatchRule, OnRate, share_within,
};
use physics::landscape::Proportion;
use physics::order::Order;
use physics::problem::Problem;
use physics::tile::Tile;
use physics::tile::barcode::Pole;
use physics::units::si;

pub use super::docking_tables::{map_csv, runs_csv, trajectory_csv};

/// Where the paper's figure 6 says that the chance of a match is above [`PAPER_CHANCE`]: relative
/// orientation (rad) and speed (m/s).
pub const PAPER_REGION: [[f64; 2]; 2] = [[-0.5, 1.5], [0.4, 0.8]];
/// See [`PAPER_REGION`].
pub const PAPER_CHANCE: f64 = 0.04;

/// `dock.json`: the counts, and everything that reproduces them.
pub fn json(design: &Design, docking: &Docking, map: &DockingMap) -> String {
    let settings = &docking.settings;
    let (motion, starts) = (&settings.motion, &settings.starts);
    let rate = OnRate::new(docking);
    let [orientation, speed] = PAPER_REGION;
    let traps: Vec<_> = docking
        .traps
        .iter()
        .map(|trap| {
            json!({
                "pose": trap.configuration.to_array(),
                "energy_J": trap.energy,
                "caught": proportion(&trap.caught),
            })
        })
        .collect();
    let fans: Vec<_> = motion
        .fans
        .iter()
        .map(|fan| {
            json!({
                "place_m": fan.place, "energy_J": fan.energy, "width_m": fan.width,
                "amplitude": fan.amplitude, "frequency_Hz": fan.frequency,
            })
        })
        .collect();
    json::text(&json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "design": {"name": design.name, "sha256": design.sha256},
        "seed": settings.seed,
        "settings": {
            "runs": settings.runs, "duration_s": settings.duration,
            "match_threshold_m": docking.threshold,
            "starts": {
                "distance_m": starts.distance, "direction_rad": starts.direction,
                "orientation_rad": starts.orientation, "speed_m_per_s": starts.speed,
                "aim_rad": starts.aim, "spin_rad_per_s": starts.spin,
            },
            "motion": {
                "drag_per_s": motion.drag, "restitution": motion.restitution,
                "friction": motion.friction, "walls": motion.walls, "fans": fans,
                "shaking_J": motion.shaking, "tolerance_m": motion.tolerance,
                "contact_step_s": motion.contact_step, "contact_travel_m": motion.contact_travel,
            },
        },
        "bound": proportion(&docking.bound),
        "misbound": proportion(&docking.trapped),
        "free": proportion(&docking.free),
        "traps": traps,
        "time_to_bind_s": times(docking),
        "on_rate": rate_entry("attachments", &rate),
        // Both are of the paper's tile, and null for any other.
        "paper_figure_6": is_paper_tile(design).then(|| json!({
            "claim": PAPER_CHANCE, "orientation_rad": orientation, "speed_m_per_s": speed,
            "matched": proportion(&share_within(docking, orientation, speed)),
            "cells_below_claim": below_claim(map),
        })),
        "open_dynamics_engine": is_engine_comparison(design, settings).then(|| json!({
            "matched": ENGINE.matched, "slid": ENGINE.slid, "margin": ENGINE.margin,
            "restitution_in_the_mean": ENGINE.restitution,
            "matched_with_correction_limited": ENGINE.corrected.0,
            "margin_with_correction_limited": ENGINE.corrected.1,
            "core_s_per_step": ENGINE.cost,
            "core_s_per_simulated_s": ENGINE.steps.map(|step| ENGINE.cost / step),
            "best_speed_m_per_s": ENGINE.best.0, "best_matched": ENGINE.best.1,
            "here_at_best_speed":
                proportion(&share_within(docking, [-starts.orientation, starts.orientation], ENGINE.best.0)),
        })),
        "timing": timing(docking),
    }))
}

/// A rate, with the number of what was counted under its name.
pub(super) fn rate_entry(events: &str, rate: &OnRate) -> Value {
    json!({
        events: rate.attachments, "time_s": rate.time, "rate_per_s": rate.rate,
        "interval_per_s": rate.interval, "statistic": rate.statistic,
        "critical": OnRate::CRITICAL, "exponential": rate.is_exponential(),
    })
}

/// Whether both tiles are the paper's: straight squares of 43 cm with four magnets of 0.2865 A m^2,
/// 40 mm apart, on every face, NNNS on the fixed tile and NSSS on the moving one.
pub fn is_paper_tile(design: &Design) -> bool {
    let is_one = |tile: &Tile, code: &str| {
        let faces = &tile.faces;
        let square = faces.len() == 4
            && tile.outline.vertices().len() == 4
            && faces.iter().all(|face| (face.length() - 0.43).abs() < 1e-9);
        let carries_code = |k: usize| {
            let magnets = tile.magnets.iter().filter(|magnet| magnet.face == k);
            let found: Vec<(f64, Pole, f64)> = magnets
                .map(|magnet| {
                    let s = (magnet.position - faces[k].middle()).dot(&faces[k].tangent());
                    (s, pole(tile, magnet), magnet.moment)
                })
                .collect();
            found.len() == code.len()
                && found
                    .iter()
                    .zip(code.chars())
                    .enumerate()
                    .all(|(i, (magnet, letter))| {
                        let place = 0.04 * (i as f64 - 1.5);
                        (magnet.0 - place).abs() < 1e-9
                            && (magnet.1 == Pole::North) == (letter == 'N')
                            && (magnet.2 - 0.2865).abs() < 1e-4
                    })
        };
        square && (0..4).all(carries_code)
    };
    is_one(&design.pair.fixed, "NNNS") && is_one(&design.pair.moving, "NSSS")
}

/// Whether this is the experiment that was made with the Open Dynamics Engine as well, with
/// whatever restitution.
pub fn is_engine_comparison(design: &Design, settings: &DockingSettings) -> bool {
    let mut other = DockingSettings::engine_comparison();
    other.motion.restitution = settings.motion.restitution;
    is_paper_tile(design)
        && settings.motion == other.motion
        && settings.starts == other.starts
        && settings.duration == other.duration
        && settings.threshold.is_none()
}

/// Cells of the paper's region in which the chance is below its claim with its whole interval, and
/// all cells of the region.
pub fn below_claim(map: &DockingMap) -> [usize; 2] {
    let [orientation, speed] = PAPER_REGION;
    let inside = |cell: [f64; 2], region: [f64; 2]| {
        cell[0] >= region[0] - 1e-9 && cell[1] <= region[1] + 1e-9
    };
    let cells = map.cells.iter().filter(|cell| {
        inside(cell.orientation, orientation) && inside(cell.speed, speed) && cell.matched.of > 0
    });
    cells.fold([0, 0], |[below, all], cell| {
        [
            below + usize::from(cell.matched.high < PAPER_CHANCE),
            all + 1,
        ]
    })
}

fn proportion(p: &Proportion) -> impl Serialize + use<> {
    json!({"count": p.count, "of": p.of, "share": p.share(), "low": p.low, "high": p.high})
}

/// Least, middle and largest time to bind (s).
fn times(docking: &Docking) -> Option<[f64; 3]> {
    let mut times: Vec<f64> = docking
        .runs
        .iter()
        .filter_map(|run| match run.end {
            End::Bound { since } => Some(since),
            _ => None,
        })
        .collect();
    times.order_by(f64::total_cmp);
    Some([*times.first()?, times[times.len() / 2], *times.last()?])
}

fn timing(docking: &Docking) -> serde_json::Value {
    let contact: usize = docking.runs.iter().map(|run| run.contact_steps).sum();
    let free: usize = docking.runs.iter().map(|run| run.free_steps).sum();
    let simulated = docking.settings.duration * docking.runs.len() as f64;
    let core_seconds = docking.wall_s * docking.threads as f64;
    json!({
        "wall_s": docking.wall_s, "threads": docking.threads,
        "free_steps": free, "contact_steps": contact, "simulated_s": simulated,
        "core_s_per_step": core_seconds / (free + contact).max(1) as f64,
        "core_s_per_simulated_s": core_seconds / simulated.max(f64::MIN_POSITIVE),
    })
}

/// A few lines for the terminal.
pub fn summary(design: &Design, problem: &Problem, docking: &Docking, map: &DockingMap) -> String {
    let share = |p: &Proportion| {
        format!(
            "{:.1} % ({:.1} to {:.1} %)",
            100.0 * p.share(),
            100.0 * p.low,
            100.0 * p.high
        )
    };
    let mut text = format!(
        "{}: {} of {} trajectories of {} each end in the bond (seed {})\n",
        design.name,
        docking.runs.iter().filter(|run| run.is_bound()).count(),
        docking.runs.len(),
        si(docking.settings.duration, "s", 2),
        docking.settings.seed
    );
    text += &format!("  bond  {}\n", share(&docking.bound));
    text += &format!("  traps {}\n", share(&docking.trapped));
    // Cannot fail: the experiment had a rule.
    let rule = MatchRule::new(problem, docking.settings.threshold).ok();
    for trap in docking.traps.iter().take(4) {
        let q = trap.configuration;
        let is_bond = rule.as_ref().is_some_and(|rule| rule.holds(&q));
        text += &format!(
            "    {} at ({:.4}, {:.4}, {:.3}), {}{}\n",
            share(&trap.caught),
            q.x,
            q.y,
            q.theta,
            si(trap.energy, "J", 4),
            if is_bond {
                ": the bond, not reached yet or held short of it by friction"
            } else {
                ""
            }
        );
    }
    text += &format!("  free  {}\n", share(&docking.free));
    if let Some([least, middle, most]) = times(docking) {
        text +=
            &format!("  bound after {least:.2} s to {most:.2} s, half of them by {middle:.2} s\n");
    }
    let rate = OnRate::new(docking);
    text += &format!(
        "  on-rate {:.4} per s ({:.4} to {:.4}); times between attachments {} exponential\n",
        rate.rate,
        rate.interval[0],
        rate.interval[1],
        if rate.is_exponential() {
            "are compatible with an"
        } else {
            "refute an"
        }
    );
    text = text.replace("an exponential\n", "an exponential distribution\n");
    if is_paper_tile(design) {
        let [orientation, speed] = PAPER_REGION;
        let region = share_within(docking, orientation, speed);
        let [below, cells] = below_claim(map);
        text += &format!(
            "  paper, figure 6 (above 4 % at -0.5 to 1.5 rad, 0.4 to 0.8 m/s): {} there, below 4 % \
             for certain in {below} of {cells} cells\n",
            share(&region)
        );
    }
    if is_engine_comparison(design, &docking.settings) {
        let starts = &docking.settings.starts;
        let all = [-starts.orientation, starts.orientation];
        text += &format!(
            "  Open Dynamics Engine: {:.1} to {:.1} % bound (+- {:.1} %), with a restitution of {:.2} \
             in the mean where 0.01 is asked for; here {} with {}\n  \
             with its correction of overlap limited, which leaves 0.02: {:.1} % (+- {:.1} %)\n  at {} to {} m/s: {:.0} %; here {}\n",
            100.0 * ENGINE.matched[0],
            100.0 * ENGINE.matched[1],
            100.0 * ENGINE.margin,
            ENGINE.restitution,
            share(&docking.bound),
            docking.settings.motion.restitution,
            100.0 * ENGINE.corrected.0,
            100.0 * ENGINE.corrected.1,
            ENGINE.best.0[0],
            ENGINE.best.0[1],
            100.0 * ENGINE.best.1,
            share(&share_within(docking, all, ENGINE.best.0))
        );
    }
    let contact: usize = docking
        .runs
        .iter()
        .map(|run| run.contact_steps + run.free_steps)
        .sum();
    let core = docking.wall_s * docking.threads as f64;
    text += &format!(
        "  {} a step, {} a simulated second (of one core that has nothing else to do){}\n",
        si(core / contact.max(1) as f64, "s", 2),
        si(
            core / (docking.settings.duration * docking.runs.len().max(1) as f64),
            "s",
            2
        ),
        if is_engine_comparison(design, &docking.settings) {
            format!(
                "; Open Dynamics Engine {} and {} to {}",
                si(ENGINE.cost, "s", 2),
                si(ENGINE.cost / ENGINE.steps[0], "s", 2),
                si(ENGINE.cost / ENGINE.steps[1], "s", 2)
            )
        } else {
            String::new()
        }
    );
    text
}
