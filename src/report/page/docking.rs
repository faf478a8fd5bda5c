//! The page of a docking experiment.

use serde_json::{Value, json};

use super::pathways::Played;
use super::{Column, Fact, Illustration, Landscape, Page, Table, finite};
use crate::plots::Scene;
use jobs::design::Design;
use physics::configuration::Configuration;
use physics::dynamics::Snapshot;
use physics::dynamics::docking::{Docking, DockingRun, End, MatchRule, OnRate};
use physics::landscape::{Inventory, State, StateKind};
use physics::problem::Problem;
use physics::units::si;

/// Traps that are marked and listed.
const LISTED: usize = 12;

impl Page {
    /// The page of a docking experiment, with the trajectories that it plays.
    pub fn of_docking(
        design: &Design,
        problem: &Problem,
        docking: &Docking,
        trajectories: &[(DockingRun, Vec<Snapshot>)],
        pictures: Vec<Illustration>,
    ) -> Self {
        let inventory = Inventory {
            states: states(problem, docking, design.pair.bound),
            ..Inventory::default()
        };
        let scene = Scene::new(design, problem, &inventory);
        let played = trajectories
            .iter()
            .map(|(run, snapshots)| Played::of_trajectory(name(docking, run), snapshots, problem));
        let landscape = Some(Landscape::new(design, &scene, played.collect()));
        Self {
            subtitle: design.description.clone(),
            facts: facts(docking),
            landscape,
            pictures,
            tables: vec![traps(docking), settings(design, docking)],
            origin: format!(
                "tilebind {}, seed {}, design sha256 {}",
                env!("CARGO_PKG_VERSION"),
                docking.settings.seed,
                design.sha256
            ),
            ..Self::titled(format!("{}: docking", design.name))
        }
    }
}

/// The bond and the traps, to be marked.
fn states(problem: &Problem, docking: &Docking, bound: Configuration) -> Vec<State> {
    let rule = MatchRule::new(problem, docking.settings.threshold);
    let is_bond = |q: &Configuration| rule.as_ref().is_ok_and(|rule| rule.holds(q));
    let traps = docking.traps.iter().take(LISTED);
    let traps = traps.filter(|trap| !is_bond(&trap.configuration));
    let traps = traps.map(|trap| (StateKind::Trap, trap.configuration, trap.energy));
    let all = std::iter::once((StateKind::Bond, bound, problem.energy(&bound))).chain(traps);
    all.enumerate()
        .map(|(id, (kind, configuration, energy))| State {
            id,
            kind,
            configuration,
            energy,
            class: id,
            faces: Vec::new(),
            attracting: 0,
            repelling: 0,
            block_energy: None,
            capture: None,
            sideways: None,
        })
        .collect()
}

fn name(docking: &Docking, run: &DockingRun) -> String {
    let end = match run.end {
        End::Bound { since } => format!("bound after {since:.2} s"),
        End::Free => "free".to_owned(),
        End::Trapped { trap } => trap.and_then(|trap| docking.traps.get(trap)).map_or_else(
            || "caught".to_owned(),
            |trap| format!("caught above {}", si(trap.energy, "J", 3)),
        ),
    };
    format!("trajectory {}: {end}", run.index)
}

fn facts(docking: &Docking) -> Vec<Fact> {
    let shares = [
        ("bond", &docking.bound),
        ("traps", &docking.trapped),
        ("free", &docking.free),
    ];
    let of_share = |(name, share)| Fact::of_share(name, share);
    let mut facts: Vec<Fact> = shares.map(of_share).into();
    let rate = OnRate::new(docking);
    facts.push(Fact {
        name: "on-rate".to_owned(),
        value: format!("{:.4} per s", rate.rate),
        note: format!("95 %: {:.4} to {:.4}", rate.interval[0], rate.interval[1]),
    });
    facts
}

fn number(value: f64) -> Value {
    json!(finite(value, 6))
}

fn traps(docking: &Docking) -> Table {
    let rows = docking.traps.iter().take(LISTED).map(|trap| {
        let [x, y, theta] = trap.configuration.to_array().map(number);
        let share = number(trap.caught.share());
        vec![
            json!(trap.caught.count),
            share,
            number(trap.energy),
            x,
            y,
            theta,
        ]
    });
    Table {
        title: "Where tiles are caught without a match".to_owned(),
        note: "The minimum below where they ended, symmetric copies taken together; the bond is \
               among them where friction or lack of time held tiles short of it."
            .to_owned(),
        columns: vec![
            Column::new("tiles", ""),
            Column::new("share", "%"),
            Column::new("energy", "J"),
            Column::new("x", "m"),
            Column::new("y", "m"),
            Column::new("\u{3b8}", "rad"),
        ],
        rows: rows.collect(),
        states: Vec::new(),
        paths: Vec::new(),
    }
}

fn settings(design: &Design, docking: &Docking) -> Table {
    let settings = &docking.settings;
    let (motion, starts) = (&settings.motion, &settings.starts);
    let range = |[low, high]: [f64; 2], unit: &str| json!(format!("{low} to {high} {unit}"));
    let most = |value: f64, unit: &str| json!(format!("up to {value:.4} {unit} either way"));
    let rows = [
        ("magnets", json!(design.interaction.model.name())),
        ("trajectories", json!(settings.runs)),
        ("each lasts", json!(si(settings.duration, "s", 3))),
        ("distance", range(starts.distance, "m")),
        ("direction about the face", most(starts.direction, "rad")),
        (
            "orientation about the bond",
            most(starts.orientation, "rad"),
        ),
        ("speed", range(starts.speed, "m/s")),
        ("aim about the fixed tile", most(starts.aim, "rad")),
        ("drag", json!(format!("{} per s", motion.drag))),
        ("restitution", json!(motion.restitution)),
        ("friction", json!(motion.friction)),
        ("rim", json!(if motion.walls { "yes" } else { "no" })),
        ("fans", json!(motion.fans.len())),
        ("match within", json!(si(docking.threshold, "m", 3))),
    ];
    Table::of_settings(rows)
}
