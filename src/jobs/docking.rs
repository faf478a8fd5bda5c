//! Docking experiments: the request, and trajectories for display.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::design::{self, Design};
use crate::memory;
use crate::rates::diffusion;
use crate::request::{self, MotionOptions, options};
use physics::dynamics::docking::{
    Docking, DockingError, DockingRun, DockingSettings, End, Release, Starts, dock, releases,
    trajectory,
};
use physics::dynamics::{MotionSettings, Snapshot};
use physics::kinetics::rates::{Loosening, RatesError};
use physics::observer::Observer;
use physics::problem::Problem;
use physics::tile::Pair;

options! {
    /// The options of a docking experiment.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Request {
        /// Number of trajectories
        pub runs: usize = value("N", request::runs).or(DockingSettings::default().runs),

        /// Duration of each trajectory (s)
        pub duration: f64 = value("S", duration).or(DockingSettings::default().duration),

        /// How tiles move.
        pub motion: MotionOptions = group(),

        /// Distance (m) within which target magnets count as matched [default: 1.5 magnet lengths]
        pub threshold: Option<f64> = value("M", request::length),

        /// Where runs start.
        pub starts: StartOptions = group(),

        /// Let tiles leave the table
        pub no_walls: bool = flag(),

        /// Effective energy kT of random shaking (J)
        pub shaking: Option<f64> = value("E_J", request::shaking),

        /// Random seed; a trajectory depends only on it and on its own number
        pub seed: u64 = value("N", request::seed).or(1),
    }
}

/// Memory (bytes) of a run until its results are written, measured.
const OF_A_RUN: f64 = 2.6e3;

impl Request {
    /// Checks that the machine can hold the runs.
    ///
    /// # Errors
    /// If it does not have enough memory.
    pub fn check_memory(&self) -> Result<(), String> {
        let checked = memory::check_bytes(OF_A_RUN * self.runs as f64);
        checked.map_err(|told| format!("--runs {}: {told}: use fewer --runs", self.runs))
    }

    /// The settings of the experiment for these tiles.
    pub fn settings(&self, pair: &Pair) -> DockingSettings {
        DockingSettings {
            runs: self.runs,
            seed: self.seed,
            duration: self.duration,
            starts: self.starts.starts(Starts::of(pair)),
            motion: MotionSettings {
                walls: !self.no_walls,
                shaking: self.shaking,
                ..self.motion.settings()
            },
            threshold: self.threshold,
        }
    }
}

options! {
    /// The options for measuring how long bonds last.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct ReleaseOptions {
        /// Start bound, with a thermal velocity, and measure the detachment rate
        ///
        /// The options that set the start are ignored.
        pub from_bond: bool = flag().requires("shaking"),

        /// With --from-bond: also print the overdamped rate
        ///
        /// It is solved on a mesh at the same kT and drag, as in `tilebind rates`.
        pub overdamped: bool = flag().requires("from_bond"),
    }
}

/// Runs an experiment, and reports how many of its trajectories have ended.
///
/// # Errors
/// As [`dock`].
pub fn docked(
    problem: &Problem,
    settings: &DockingSettings,
    observer: &dyn Observer,
) -> Result<Docking, DockingError> {
    dock(problem, settings, &counted(settings, observer))
}

/// Runs trajectories from the bond, and reports how many have ended.
///
/// # Errors
/// As [`releases`].
pub fn released(
    problem: &Problem,
    settings: &DockingSettings,
    observer: &dyn Observer,
) -> Result<Vec<Release>, DockingError> {
    releases(problem, settings, &counted(settings, observer))
}

fn counted(settings: &DockingSettings, observer: &dyn Observer) -> impl Fn() + Sync {
    let (done, runs) = (AtomicUsize::new(0), settings.runs);
    observer.stage("trajectories", 0.0);
    move || {
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        observer.part("trajectories", done, runs);
    }
}

/// Fewer steps of all trajectories together take seconds.
const MANY_STEPS: f64 = 1e6;
/// Steps of the trial that shows how long one takes.
const OF_A_TRIAL: f64 = 1e3;

/// About how long (s on one core) the trajectories take that do not end early, from the beginning of the
/// first one; `None` if that are seconds.
///
/// # Errors
/// As [`dock`].
pub fn expected(
    problem: &Problem,
    settings: &DockingSettings,
) -> Result<Option<f64>, DockingError> {
    let scale = problem.scale();
    let step = settings.motion.of_size(scale).step(scale);
    let whole = settings.runs as f64 * settings.duration;
    if whole < MANY_STEPS * step {
        return Ok(None);
    }
    let trial = DockingSettings {
        runs: 1,
        duration: settings.duration.min(OF_A_TRIAL * step),
        ..settings.clone()
    };
    // The whole is checked as well.
    settings
        .motion
        .of_size(scale)
        .check_steps(scale, settings.duration)?;
    let found = dock(problem, &trial, &|| ())?;
    let simulated: f64 = found.runs.iter().map(|run| run.last.time).sum();
    Ok(Some(found.wall_s * whole / simulated.max(step)))
}

/// Checks that the meshes of [`loosening`] fit into memory beside a number of threads.
///
/// # Errors
/// See [`memory::check_meshes`].
pub fn check_memory(threads: usize) -> Result<(), String> {
    // The bond and free tiles.
    memory::check_meshes(2, threads)
}

/// The off-rates of overdamped motion (1/s) at the kT and the drag of an experiment.
///
/// # Errors
/// See [`RatesError`].
pub fn loosening(
    design: &Design,
    settings: &DockingSettings,
    observer: &dyn Observer,
) -> Result<Loosening, RatesError> {
    observer.stage("rates", 0.0);
    let kt = settings.motion.shaking.unwrap_or_default();
    let centred = design.centred();
    let found = Loosening::new(&centred.problem(), &centred.pair.bound, kt)?;
    Ok(found.times(diffusion(design, kt, settings.motion.drag)))
}

options! {
    /// Ranges from which starts are drawn.
    #[derive(Clone, Debug, PartialEq)]
    pub struct StartOptions {
        /// Initial distance between reference points (m) [default: 0.62,1 scaled with the tiles]
        ///
        /// 0.62,1 is the range for the paper's tiles.
        pub distance: Option<[f64; 2]> = value("LOW,HIGH", lengths),

        /// Largest angle (rad) from the target face's normal to the tile [default: 0.7854]
        pub direction: Option<f64> = value("RAD", request::turn),

        /// Largest angle (rad) from the bound orientation [default: 1.5]
        pub orientation: Option<f64> = value("RAD", request::turn),

        /// Initial speed (m/s) [default: 0,1.3]
        pub speed: Option<[f64; 2]> = value("LOW,HIGH", speeds),

        /// Largest angle (rad) between the velocity and the line to the fixed tile [default: 0.3]
        pub aim: Option<f64> = value("RAD", request::turn),

        /// Largest initial angular velocity, either way (rad/s) [default: 0]
        pub spin: Option<f64> = value("RATE", spin),
    }
}

impl StartOptions {
    /// The requested distribution, with missing options from `default`.
    pub fn starts(&self, default: Starts) -> Starts {
        Starts {
            distance: self.distance.unwrap_or(default.distance),
            direction: self.direction.unwrap_or(default.direction),
            orientation: self.orientation.unwrap_or(default.orientation),
            speed: self.speed.unwrap_or(default.speed),
            aim: self.aim.unwrap_or(default.aim),
            spin: self.spin.unwrap_or(default.spin),
        }
    }
}

/// Largest speed (m/s) and angular velocity (rad/s): the faster a tile, the shorter its steps.
const FASTEST: f64 = 1e2;
const FASTEST_SPIN: f64 = 1e3;

/// Longest trajectory (s): steps are at most tenths of a second.
const LONGEST: f64 = 1e6;

/// The duration (s) of a trajectory.
///
/// # Errors
/// If it is none, or too long.
pub fn duration(text: &str) -> Result<f64, String> {
    match request::time(text)? {
        long if long > LONGEST => Err(format!("a time of at most {LONGEST:e} s is needed")),
        time => Ok(time),
    }
}

/// An angular velocity (rad/s) of 0 or more.
fn spin(text: &str) -> Result<f64, String> {
    let found = design::spin(text).filter(|x| (0.0..=FASTEST_SPIN).contains(x));
    found.ok_or_else(|| {
        format!(
            "a number from 0 to {FASTEST_SPIN} is needed, in rad/s or with a unit: \"90 deg/s\""
        )
    })
}

/// A range of speeds (m/s).
fn speeds(text: &str) -> Result<[f64; 2], String> {
    range_of(text, |end| {
        let found = design::speed(end).filter(|x| (0.0..=FASTEST).contains(x));
        found.ok_or_else(|| {
            format!("a number from 0 to {FASTEST} is needed, in m/s or with a unit: \"40 cm/s\"")
        })
    })
}

/// A range of lengths (m), also with units.
fn lengths(text: &str) -> Result<[f64; 2], String> {
    range_of(text, request::length_or_none)
}

fn range_of(text: &str, read: fn(&str) -> Result<f64, String>) -> Result<[f64; 2], String> {
    const FORM: &str = "a range is LOW,HIGH with 0 <= LOW <= HIGH, such as 0.4,0.8";
    let ends = text.split_once(',').ok_or(FORM)?;
    let [low, high] = [ends.0, ends.1].map(|end| read(end.trim()));
    let describe = |why: String| format!("{FORM}; {why}");
    match (low.map_err(describe)?, high.map_err(describe)?) {
        (low, high) if low <= high => Ok([low, high]),
        _ => Err(FORM.to_owned()),
    }
}

/// Number of paths in one picture.
const DRAWN: usize = 60;
/// Time between two points of a path (s), and the number of points from which they are fewer.
const INTERVAL: f64 = 0.02;
const POINTS: f64 = 1e4;

/// A run with its recorded points.
pub type Path = (DockingRun, Vec<Snapshot>);

/// Some of an experiment's runs with their recorded points.
#[derive(Clone, Debug)]
pub struct Paths {
    /// Runs for animation: the requested run, or else the first bound one, and a few of each kind
    /// of end.
    pub played: Vec<Path>,
    /// Runs for one picture.
    pub drawn: Vec<Path>,
}

impl Paths {
    /// Selects paths of a finished experiment; `asked` is the run to animate first.
    ///
    /// # Errors
    /// As [`trajectory`].
    pub fn new(
        problem: &Problem,
        docking: &Docking,
        asked: Option<usize>,
    ) -> Result<Self, DockingError> {
        let interval = INTERVAL.max(docking.settings.duration / POINTS);
        let trace = |run: &DockingRun| -> Result<Path, DockingError> {
            let snapshots = trajectory(problem, &docking.settings, run.index, interval)?;
            Ok((*run, snapshots))
        };
        Ok(Self {
            played: chosen(docking, asked)
                .iter()
                .map(trace)
                .collect::<Result<_, _>>()?,
            drawn: docking
                .runs
                .iter()
                .take(DRAWN)
                .map(trace)
                .collect::<Result<_, _>>()?,
        })
    }
}

fn chosen(docking: &Docking, asked: Option<usize>) -> Vec<DockingRun> {
    let runs = &docking.runs;
    let asked = asked.and_then(|index| runs.get(index));
    let mut chosen: Vec<DockingRun> = asked.copied().into_iter().collect();
    let mut take = |count: usize, is: &dyn Fn(&DockingRun) -> bool| {
        let fitting = runs.iter().filter(|run| is(run)).take(count);
        let new = fitting.filter(|run| !chosen.contains(run));
        let new: Vec<_> = new.copied().collect();
        chosen.extend(new);
    };
    take(4, &DockingRun::is_bound);
    for trap in 0..4 {
        take(1, &|run| run.end == End::Trapped { trap: Some(trap) });
    }
    take(2, &|run| run.end == End::Free);
    if chosen.is_empty() {
        chosen.extend(runs.first());
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges() {
        assert_eq!(speeds("0, 1.3"), Ok([0.0, 1.3]));
        for wrong in ["", "1", "1,0", "-1,1", "a,b", "0,1,2", "0,inf", "0,1e300"] {
            assert!(speeds(wrong).is_err(), "{wrong}");
        }
    }
}
