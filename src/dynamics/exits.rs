//! Exits of moving tiles: how long a shaken tile takes from a start to one of two ends.

use rayon::prelude::*;

use super::docking::stream;
use super::trajectory::thermal_velocity;
use super::{Body, Motion, MotionSettings, SettingsError, Simulation};
use crate::configuration::Configuration;
use crate::problem::Problem;

/// What is asked of moving tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct ExitRunSettings {
    /// Where they start, with velocities drawn at kT.
    pub start: Configuration,
    /// They are bound where U (J) is lower, in whatever basin.
    pub basin_energy: f64,
    /// They are free where the reference points are so far apart (m).
    pub free_at: f64,
    /// How many there are.
    pub runs: usize,
    /// Of all random numbers.
    pub seed: u64,
    /// Time (s) after which a run is given up.
    pub longest: f64,
}

/// What moving tiles did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExitRuns {
    /// How many got bound, and free.
    pub ends: [usize; 2],
    /// How many were given up.
    pub given_up: usize,
    /// Mean exit time (s) of those that got to an end, and its standard error.
    pub time: [f64; 2],
    /// Mean kinetic energy over 3/2 kT: 1 where the shaking keeps its temperature.
    pub warmth: f64,
}

/// Runs of shaken tiles to the first of two ends.
///
/// # Errors
/// Where a setting makes no sense, or the tiles are not shaken.
pub fn exits(
    problem: &Problem,
    body: Body,
    motion: &MotionSettings,
    asked: &ExitRunSettings,
) -> Result<ExitRuns, SettingsError> {
    let simulation = Simulation::new(problem, body, motion)?;
    let kt = motion.shaking.unwrap_or(0.0);
    let one = |number: usize| {
        let mut rng = stream(asked.seed, number);
        let start = Motion {
            configuration: asked.start,
            velocity: thermal_velocity(&body, kt, &mut rng),
        };
        let mut before = 0.0;
        let mut kinetic = 0.0;
        let mut end = None;
        let run = simulation.run(&start, asked.longest, &mut rng, &mut |now| {
            kinetic += now.kinetic * (now.time - before);
            before = now.time;
            let q = now.motion.configuration;
            end = if now.potential < asked.basin_energy {
                Some(0)
            } else {
                (q.x.hypot(q.y) >= asked.free_at).then_some(1)
            };
            end.is_some()
        });
        (end, run.last.time, kinetic)
    };
    let runs: Vec<(Option<usize>, f64, f64)> = (0..asked.runs).into_par_iter().map(one).collect();
    let count = |end: Option<usize>| runs.iter().filter(|run| run.0 == end).count();
    let times: Vec<f64> = runs
        .iter()
        .filter(|run| run.0.is_some())
        .map(|run| run.1)
        .collect();
    let all: f64 = runs.iter().map(|run| run.1).sum();
    let kinetic: f64 = runs.iter().map(|run| run.2).sum();
    Ok(ExitRuns {
        ends: [count(Some(0)), count(Some(1))],
        given_up: count(None),
        time: mean_and_error(&times),
        warmth: kinetic / all / (1.5 * kt),
    })
}

/// The mean of a sample and its standard error; the one is NaN of none, the other of one.
pub fn mean_and_error(sample: &[f64]) -> [f64; 2] {
    let n = sample.len() as f64;
    let mean = sample.iter().sum::<f64>() / n;
    let variance = sample.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    [mean, (variance / n).sqrt()]
}
