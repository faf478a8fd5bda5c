//! What the runs of a table will take, known before they start.

use super::Request;
use crate::memory;
use physics::table::TableSettings;
use physics::table::run::Start;

/// Largest number of steps of a run.
const MOST_STEPS: f64 = 1e9;
/// Shortest step (s): rounding of positions stays far below the path within a step.
const LEAST_STEP: f64 = 1e-6;

/// Memory (bytes), measured, for each tile and sample: of the numbers, of tiles that are bound, ...
const OF_A_SAMPLE: f64 = 250.0;
/// ... of the poses of the first run for its page and its trajectory ...
const OF_A_POSE: f64 = 300.0;
/// ... and of all poses in a table.
const OF_A_ROW: f64 = 3e3;
/// Time (s) on one core for each tile and step: measured, 0.2e-6 for tiles far apart, 4.5e-6 for
/// bound ones under shaking.
const OF_A_STEP: f64 = 1e-6;
/// Longer work (s) is told.
const WORTH_TELLING: f64 = 60.0;

/// The size of a request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Workload {
    /// Number of runs.
    pub runs: f64,
    /// Number of tiles.
    pub tiles: f64,
    /// Steps of a run.
    pub steps: f64,
    /// Samples of a run.
    pub samples: f64,
    /// Whether all poses go into a table.
    pub frames: bool,
}

impl Workload {
    /// That of a request for tiles with this usual step (s) and these starts.
    pub fn of(request: &Request, usual: f64, start: &Start) -> Self {
        let settings = request.settings(usual);
        let steps = (settings.duration / settings.step).ceil().max(1.0);
        Self {
            runs: request.made().len() as f64,
            tiles: start.tiles() as f64,
            steps,
            samples: 2.0 + (settings.duration / settings.sampling).min(steps),
            frames: request.keeps_frames(),
        }
    }

    /// Memory (bytes) until the results are written.
    pub fn bytes(&self) -> f64 {
        let moments = self.samples * self.tiles;
        let poses = match self.frames {
            true => OF_A_ROW * self.runs,
            false => OF_A_POSE,
        };
        moments * (OF_A_SAMPLE * self.runs + poses)
    }

    /// Checks that the machine can hold the runs, and that these end.
    ///
    /// # Errors
    /// If it does not have enough memory, or there are too many steps.
    pub fn check(&self) -> Result<(), String> {
        if self.steps > MOST_STEPS {
            return Err(format!(
                "{:.1e} steps of these tiles are more than {MOST_STEPS:e}: use a shorter --time or a longer --step",
                self.steps
            ));
        }
        memory::check_bytes(self.bytes()).map_err(|told| {
            let (frames, longer) = match self.frames {
                true => (" with their poses (--frames)", "longer --frames, "),
                false => ("", ""),
            };
            let Self { tiles, .. } = self;
            let (runs, samples) = (self.runs(), self.samples.floor());
            format!(
                "{runs} with {samples} samples of {tiles} tiles{frames}: {told}: use {longer}fewer --runs or \
                 fewer tiles"
            )
        })
    }

    /// The number of runs, in words.
    pub fn runs(&self) -> String {
        let plural = if self.runs > 1.0 { "s" } else { "" };
        format!("{} run{plural}", self.runs)
    }

    /// The expected time (s) on a number of threads, if it is long.
    pub fn long(&self, threads: usize) -> Option<f64> {
        let rounds = (self.runs / threads as f64).ceil();
        let time = OF_A_STEP * rounds * self.steps * self.tiles;
        (time > WORTH_TELLING).then_some(time)
    }
}

/// Checks the steps of a request.
///
/// # Errors
/// If there are too many, or they are too short, also for what is to be recorded.
pub fn check_steps(request: &Request) -> Result<(), String> {
    let settings = request.settings(TableSettings::USUAL_STEP);
    let (time, step) = (settings.duration, settings.step);
    if step < LEAST_STEP {
        return Err(format!(
            "the step of {step:e} s is shorter than {LEAST_STEP:e} s: use a longer --step, --time or \
             --correlation, less --drag, or slower fans and --orbital"
        ));
    }
    let steps = time / step;
    if steps > MOST_STEPS {
        return Err(format!(
            "--time {time:e}: {steps:.1e} steps of {step:e} s are more than {MOST_STEPS:e}: use a shorter --time \
             or a longer --step"
        ));
    }
    match request.frames {
        Some(frames) if frames < step => Err(format!(
            "--frames {frames:e} is shorter than the step of {step:e} s, which has one frame at most: use a \
             longer --frames or a shorter --step"
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::of_keywords;

    fn request(words: &[(&str, &str)]) -> Request {
        let words = words.iter();
        let words = words.map(|(key, value)| ((*key).to_owned(), vec![(*value).to_owned()]));
        of_keywords(words).unwrap_or_else(|_| panic!("a request"))
    }

    #[test]
    fn steps_have_limits() {
        assert_eq!(check_steps(&request(&[("time", "600")])), Ok(()));
        for (wrong, told) in [
            (&[("time", "1e12")][..], "--time"),
            (&[("time", "1e-12")], "--time"),
            (&[("time", "1"), ("step", "1e-9")], "--step"),
            (&[("time", "1"), ("frames", "1e-9")], "--frames"),
            (
                &[("time", "1"), ("correlation", "1e-9"), ("shaking", "1e-3")],
                "--correlation",
            ),
        ] {
            let error = check_steps(&request(wrong)).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
    }

    #[test]
    fn memory_and_time_are_known() {
        let start = Start::Random(vec![50_000, 50_000]);
        let asked = request(&[("time", "2"), ("frames", "0.0025")]);
        let much = Workload::of(&asked, TableSettings::USUAL_STEP, &start);
        assert!(much.bytes() > 1e11 && much.check().is_err());
        let few = Workload::of(
            &asked,
            TableSettings::USUAL_STEP,
            &Start::Random(vec![1, 1]),
        );
        assert!(few.bytes() < 1e7 && few.check() == Ok(()) && few.long(1).is_none());
        let long = Workload::of(
            &request(&[("time", "1e6")]),
            TableSettings::USUAL_STEP,
            &Start::Random(vec![1, 1]),
        );
        assert!(long.long(1).is_some_and(|time| (time - 800.0).abs() < 1.0));
    }
}
