//! Exit times of simulated tiles: how long a shaken tile takes from a start to one of two ends.

use super::docking::stream;
use super::{Body, Motion, MotionSettings, SettingsError, Simulation};
use crate::rigid::thermal_velocity;
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// The settings of exits of moving tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct ExitRunSettings {
    /// The starting configuration; velocities are drawn at kT.
    pub start: Configuration,
    /// Tiles are bound if U (J) is lower, in any basin.
    pub basin_energy: f64,
    /// Tiles are free if the reference points are at least this far apart (m).
    pub free_at: f64,
    /// Number of runs.
    pub runs: usize,
    /// The seed of all random numbers.
    pub seed: u64,
    /// Time (s) after which a run is abandoned.
    pub longest: f64,
}

/// The results of moving tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExitRuns {
    /// Numbers of runs that ended bound, and free.
    pub ends: [usize; 2],
    /// Number of abandoned runs: those over time, and those whose contact is not solved.
    pub given_up: usize,
    /// Mean exit time (s) and its standard error. Abandoned runs count with their time so far, so
    /// the true mean is then longer.
    pub time: [f64; 2],
    /// Mean kinetic energy over 3/2 kT, which is 1 if the shaking maintains its temperature; and
    /// its standard error.
    pub warmth: [f64; 2],
}

/// Moving tiles have no temperature if their kinetic energy is below that of kT by more than this
/// share, ...
const WARM: f64 = 0.1;
/// ... and by more than this number of standard errors.
const SURE: f64 = 3.0;

impl ExitRuns {
    /// Whether the shaking replaces the energy dissipated by collisions.
    pub fn has_temperature(&self) -> bool {
        let [warmth, error] = self.warmth;
        !(warmth < 1.0 - WARM && warmth < 1.0 - SURE * error)
    }
}

/// Runs of shaken tiles to the first of two ends.
///
/// # Errors
/// If a setting is invalid, the tiles are not shaken, or runs would take too many steps.
pub fn exits(
    problem: &Problem,
    body: Body,
    motion: &MotionSettings,
    asked: &ExitRunSettings,
) -> Result<ExitRuns, SettingsError> {
    let simulation = Simulation::new(problem, body, motion)?;
    let scaled = &simulation.settings;
    scaled.check_steps(problem.scale(), asked.longest)?;
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
                (libm::hypot(q.x, q.y) >= asked.free_at).then_some(1)
            };
            end.is_some()
        });
        (end, run.last.time, kinetic)
    };
    let runs: Vec<(Option<usize>, f64, f64)> = parallel::map(0..asked.runs, one);
    let count = |end: Option<usize>| runs.iter().filter(|run| run.0 == end).count();
    let times: Vec<f64> = runs.iter().map(|run| run.1).collect();
    let warm: Vec<[f64; 2]> = runs
        .iter()
        .map(|&(_, time, kinetic)| [kinetic / (1.5 * kt), time])
        .collect();
    Ok(ExitRuns {
        ends: [count(Some(0)), count(Some(1))],
        given_up: count(None),
        time: mean_and_error(&times),
        warmth: ratio_and_error(&warm),
    })
}

/// The mean of a sample and its standard error; the former is NaN for an empty sample, the latter
/// for a single value.
pub fn mean_and_error(sample: &[f64]) -> [f64; 2] {
    let n = sample.len() as f64;
    let mean = sample.iter().sum::<f64>() / n;
    let variance = sample.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
    [mean, (variance / n).sqrt()]
}

/// The ratio of the sums of pairs of numbers, and its standard error, which is NaN for one pair.
fn ratio_and_error(pairs: &[[f64; 2]]) -> [f64; 2] {
    let [above, below] = [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<f64>());
    let ratio = above / below;
    let squares = pairs.iter().map(|[a, b]| (a - ratio * b).powi(2));
    let n = pairs.len() as f64;
    let error = (squares.sum::<f64>() * n / (n - 1.0)).sqrt() / below;
    [ratio, error]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_of_equal_weights_is_a_mean() {
        let sample = [0.3, 1.9, 1.1, 0.7];
        let pairs = sample.map(|value| [2.0 * value, 2.0]);
        let [mean, error] = mean_and_error(&sample);
        let [ratio, of_ratio] = ratio_and_error(&pairs);
        assert!((ratio - mean).abs() < 1e-14 && (of_ratio - error).abs() < 1e-14);
    }
}
