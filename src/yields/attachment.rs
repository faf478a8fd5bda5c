//! How often shaken tiles attach: counted in docking runs.

use std::f64::consts::PI;

use crate::dynamics::MotionSettings;
use crate::dynamics::docking::{self, Docking, DockingError, DockingSettings, End, Starts};
use crate::landscape::Inventory;
use crate::problem::Problem;

/// Two configurations closer than this (m, metric of the space) are the same state.
const SAME: f64 = 5e-3;
/// Tiles start between the distance at which they are free and this multiple of it.
const FARTHEST: f64 = 1.6;

/// How many docking runs, and how tiles move in them.
#[derive(Clone, Debug, PartialEq)]
pub struct Effort {
    /// Runs.
    pub runs: usize,
    /// How long each lasts (s).
    pub duration: f64,
    /// Drag, restitution and friction; the shaking is set by kT.
    pub motion: MotionSettings,
}

/// Attachments of a pair on the design's table, by kind of state.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachments {
    /// To the bond, then to each kind of trap.
    pub counts: Vec<usize>,
    /// How many came to rest elsewhere.
    pub elsewhere: usize,
    /// Time of all runs together until attachment or their end (s).
    pub time: f64,
    /// The table's area (m^2).
    pub area: f64,
    /// Runs.
    pub runs: usize,
}

impl Attachments {
    /// kappa (m^2/s) of so many attachments: their rate times the table's area.
    pub fn rate(&self, count: usize) -> f64 {
        if self.time > 0.0 {
            count as f64 * self.area / self.time
        } else {
            0.0
        }
    }

    /// Its 95 % interval, that of a Poisson count.
    pub fn interval(&self, count: usize) -> [f64; 2] {
        docking::poisson_interval(count).map(|ends| ends * self.area / self.time)
    }
}

/// Counts attachments in docking runs: the moving tile starts anywhere about the fixed one, turned
/// anyhow, at any speed up to twice the thermal one, and is shaken at `kt` (J) until it is matched or
/// the run ends. Traps are counted where tiles are caught at the end, so that a trap which lets go
/// within a run is counted too low; it holds little then.
///
/// # Errors
/// As [`docking::dock`].
pub fn count(
    problem: &Problem,
    inventory: &Inventory,
    kt: f64,
    effort: &Effort,
    seed: u64,
) -> Result<Attachments, DockingError> {
    let mass = problem.pair.as_ref().map_or(1.0, |pair| pair.moving.mass);
    let thermal = (2.0 * kt / mass).sqrt();
    let near = 1.02 * problem.space.free_distance;
    let [x, y] = problem.space.half_size;
    let starts = Starts {
        distance: [near, (FARTHEST * near).min(x.min(y)).max(near)],
        direction: PI,
        orientation: PI,
        speed: [0.0, 2.0 * thermal],
        aim: PI,
        spin: 0.0,
    };
    let settings = DockingSettings {
        runs: effort.runs,
        seed,
        duration: effort.duration,
        starts,
        motion: MotionSettings {
            shaking: Some(kt),
            ..effort.motion.clone()
        },
        threshold: None,
    };
    let docking = docking::dock(problem, &settings, &|| ())?;
    Ok(tally(problem, inventory, &docking))
}

fn tally(problem: &Problem, inventory: &Inventory, docking: &Docking) -> Attachments {
    let kinds: Vec<_> = inventory.kinds().collect();
    // The bond first, then the traps, as their holds are listed.
    let mut order: Vec<usize> = (0..kinds.len()).collect();
    order.sort_by_key(|&k| !kinds[k].is_bond());
    let kind_of = |trap: usize| {
        let q = docking.traps[trap].configuration;
        let distance = |k: usize| {
            let states = kinds[k].states.iter();
            let distances = states.map(|s| problem.space.distance(&s.configuration, &q));
            distances.fold(f64::INFINITY, f64::min)
        };
        (0..order.len()).find(|&place| distance(order[place]) < SAME)
    };
    let mut found = Attachments {
        counts: vec![0; kinds.len()],
        elsewhere: 0,
        time: 0.0,
        area: problem
            .space
            .half_size
            .iter()
            .map(|half| 2.0 * half)
            .product(),
        runs: docking.runs.len(),
    };
    for run in &docking.runs {
        found.time += match run.end {
            End::Bound { since } => since,
            _ => run.last.time,
        };
        match run.end {
            End::Bound { .. } => found.counts[0] += 1,
            End::Trapped { trap } => match trap.and_then(kind_of) {
                Some(kind) => found.counts[kind] += 1,
                None => found.elsewhere += 1,
            },
            End::Free => {}
        }
    }
    found
}
