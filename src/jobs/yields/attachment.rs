//! How often shaken tiles attach, counted in docking runs.

use std::f64::consts::PI;

use clap::{Args, ValueEnum};
use nalgebra::DMatrix;

use super::{Question, YieldError};
use crate::pipeline::Analysis;
use crate::request::{self, ContactOptions};
use physics::dynamics::MotionSettings;
use physics::dynamics::docking::{self, Docking, DockingError, DockingSettings, End, Starts};
use physics::kinetics::OVERDAMPED;
use physics::kinetics::bond::Hold;
use physics::kinetics::rates::{Basin, RateSettings, rates};
use physics::landscape::Catalogue;
use physics::order::Order;
use physics::problem::Problem;

/// Two configurations closer than this (m, metric of the space) are the same state.
const SAME: f64 = 5e-3;
/// Tiles start between the distance of free tiles and this multiple of it.
const FARTHEST: f64 = 1.6;

/// The method for attachment rates, and the motion of tiles.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct Effort {
    /// Docking runs per kT
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = request::runs)]
    pub runs: usize,

    /// Duration of each docking run (s)
    #[arg(long, value_name = "S", default_value_t = 10.0, value_parser = request::time)]
    pub duration: f64,

    /// Source of attachment rates
    ///
    /// docking: docking runs. overdamped: overdamped motion, as in `tilebind rates`.
    #[arg(long = "rates", value_enum, default_value_t)]
    pub source: Source,

    /// Drag rate (1/s) [default: 0.005 for docking runs, 50 for overdamped motion]
    #[arg(long, value_name = "C", value_parser = request::positive)]
    pub drag: Option<f64>,

    /// Friction and restitution.
    #[command(flatten)]
    pub contact: ContactOptions,
}

impl Effort {
    /// The name of its progress stage.
    pub fn stage(&self) -> &'static str {
        match self.source {
            Source::Docking => "docking",
            Source::Overdamped => "rates",
        }
    }

    /// Drag, restitution and friction; the shaking is set by kT.
    pub fn motion(&self) -> MotionSettings {
        let usual = MotionSettings::default();
        let drag = match self.source {
            Source::Docking => usual.drag,
            Source::Overdamped => OVERDAMPED,
        };
        MotionSettings {
            drag: self.drag.unwrap_or(drag),
            restitution: self.contact.restitution,
            friction: self.contact.friction,
            ..usual
        }
    }

    /// A description of the source of its rates.
    pub fn told(&self) -> String {
        let MotionSettings {
            drag,
            restitution,
            friction,
            ..
        } = self.motion();
        match self.source {
            Source::Docking => format!(
                "attachment counted in {} docking runs for each kT (drag {drag} per s, restitution \
                 {restitution}, friction {friction})",
                self.runs
            ),
            Source::Overdamped => format!(
                "attachment of overdamped motion, solved on a mesh (drag {drag} per s, \
                 elastic collisions)"
            ),
        }
    }
}

/// The source of attachment rates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Source {
    /// Counted in docking runs of tiles with inertia, lossy contact and drag
    #[default]
    Docking,
    /// Overdamped motion solved on a mesh; ignores --runs, --duration, --friction, --restitution
    Overdamped,
}

/// Numbers of attachments of a pair on the design's table, by kind of state.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachments {
    /// To the bond, then to each kind of trap.
    pub counts: Vec<usize>,
    /// Number of runs that ended at rest elsewhere.
    pub elsewhere: usize,
    /// Total time of all runs until attachment or their end (s).
    pub time: f64,
    /// The table's area (m^2).
    pub area: f64,
    /// Runs.
    pub runs: usize,
    /// The rates of overdamped motion; `None` if attachments are counted.
    pub solved: Option<Solved>,
}

/// Rates of overdamped motion among kinds of states and free tiles, as in `tilebind rates`.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// Rates from free to each kind of state (1/s), and the relative difference of the two finest
    /// meshes.
    pub on: Vec<[f64; 2]>,
    /// Rates from each kind of state to free (1/s).
    pub off: Vec<f64>,
    /// Rates between kinds of states (1/s); the row is the initial one.
    pub turns: DMatrix<f64>,
}

impl Attachments {
    /// kappa (m^2/s) of a kind of state: the rate times the table's area.
    pub fn rate(&self, kind: usize) -> f64 {
        match &self.solved {
            Some(solved) => solved.on[kind][0] * self.area,
            None if self.time > 0.0 => self.counts[kind] as f64 * self.area / self.time,
            None => 0.0,
        }
    }

    /// The detachment rate (1/s) of a kind of state; `None` if it was not solved.
    pub fn off(&self, kind: usize) -> Option<f64> {
        self.solved.as_ref().map(|solved| solved.off[kind])
    }

    /// The rates (1/s) among some kinds of states without passing through free tiles.
    pub fn turns(&self, kinds: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(kinds.len(), kinds.len(), |i, j| match &self.solved {
            Some(solved) => solved.turns[(kinds[i], kinds[j])],
            None => 0.0,
        })
    }

    /// Its 95 % interval, that of a Poisson count; for solved rates, from the difference of meshes.
    pub fn interval(&self, kind: usize) -> [f64; 2] {
        match &self.solved {
            Some(solved) => {
                let [rate, spread] = solved.on[kind];
                [1.0 - spread, 1.0 + spread].map(|part| part.max(0.0) * rate * self.area)
            }
            None => docking::poisson_interval(self.counts[kind])
                .map(|ends| ends * self.area / self.time),
        }
    }
}

/// Attachments to each kind of state, from the requested source.
pub(super) fn attached(
    analysis: &Analysis,
    holds: &[&Hold],
    kt: f64,
    question: &Question,
) -> Result<Attachments, YieldError> {
    let (problem, effort) = (&analysis.problem, &question.effort);
    if effort.source == Source::Docking {
        let catalogue = &analysis.catalogue;
        return Ok(count(problem, catalogue, kt, effort, question.seed)?);
    }
    let basins: Vec<Option<Basin>> = holds
        .iter()
        .enumerate()
        .map(|(kind, hold)| {
            let height = hold.well.level - hold.energy;
            let basin = Basin::of_state(hold.configuration, hold.energy, height);
            (kind == 0 || Basin::holds(height, kt)).then_some(basin)
        })
        .collect();
    solve(problem, &basins, kt, effort.motion().drag)
}

/// The rates of overdamped motion at `kt` (J) and a drag rate (1/s) to the kinds of states with these
/// basins; 0 to those that are `None`.
///
/// # Errors
/// As [`rates()`], and where nothing is known of the bond's rate, the first one.
pub fn solve(
    problem: &Problem,
    basins: &[Option<Basin>],
    kt: f64,
    drag: f64,
) -> Result<Attachments, YieldError> {
    let held: Vec<Basin> = basins.iter().copied().flatten().collect();
    let settings = RateSettings {
        certify: None,
        ..RateSettings::new(kt, held, problem.space.free_distance)
    };
    let found = rates(problem, &settings)?;
    let mass = problem.pair.as_ref().map_or(1.0, |pair| pair.moving.mass);
    let free = settings.basins.len();
    if !found.is_known(free, 0) {
        return Err(YieldError::Lost);
    }
    // The indices of the kinds that hold a tile.
    let mut place = 0;
    let places = basins.iter().map(|basin| {
        basin.map(|_| {
            place += 1;
            place - 1
        })
    });
    let places: Vec<Option<usize>> = places.collect();
    let diffusion = kt / (drag * mass);
    let rate = |from: Option<usize>, to: Option<usize>| match (from, to) {
        (Some(from), Some(to)) if from != to => found.finest().rates[from][to] * diffusion,
        _ => 0.0,
    };
    let on = |place: &Option<usize>| {
        let spread = place.map_or(0.0, |place| found.spread(free, place));
        [rate(Some(free), *place), spread]
    };
    let solved = Solved {
        on: places.iter().map(on).collect(),
        off: places
            .iter()
            .map(|place| rate(*place, Some(free)))
            .collect(),
        turns: DMatrix::from_fn(places.len(), places.len(), |i, j| {
            rate(places[i], places[j])
        }),
    };
    Ok(Attachments {
        counts: vec![0; basins.len()],
        elsewhere: 0,
        time: 0.0,
        area: table(problem),
        runs: 0,
        solved: Some(solved),
    })
}

/// The table's area (m^2).
fn table(problem: &Problem) -> f64 {
    let sides = problem.space.half_size.iter().map(|half| 2.0 * half);
    sides.product()
}

/// Counts attachments in docking runs: the moving tile starts anywhere around the fixed one, in any
/// orientation, at any speed up to twice the thermal one, and is shaken at `kt` (J) until it is
/// matched or the run ends. Traps are counted at the end of runs, so a trap that releases tiles
/// within a run is underestimated; but such a trap holds few tiles.
///
/// # Errors
/// As [`docking::dock`].
pub fn count(
    problem: &Problem,
    catalogue: &Catalogue,
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
            ..effort.motion()
        },
        threshold: None,
    };
    let docking = docking::dock(problem, &settings, &|| ())?;
    Ok(tally(problem, catalogue, &docking))
}

fn tally(problem: &Problem, catalogue: &Catalogue, docking: &Docking) -> Attachments {
    let kinds: Vec<_> = catalogue.kinds().collect();
    // The bond first, then the traps, in the order of their holds.
    let mut order: Vec<usize> = (0..kinds.len()).collect();
    order.order_by_key(|&k| !kinds[k].is_bond());
    let kind_of = |trap: usize| {
        let q = docking.traps[trap].configuration;
        let distance = |k: usize| {
            let states = kinds[k].states.iter();
            let distances = states.map(|s| problem.space.distance(&s.configuration, &q));
            distances.fold(f64::INFINITY, f64::min)
        };
        (0..order.len()).find(|&place| distance(order[place]) < problem.scaled(SAME))
    };
    let mut found = Attachments {
        counts: vec![0; kinds.len()],
        elsewhere: 0,
        time: 0.0,
        area: table(problem),
        runs: docking.runs.len(),
        solved: None,
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
