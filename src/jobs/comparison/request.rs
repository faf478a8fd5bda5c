//! What is asked of an assessment.

use clap::Args;

use super::AssessmentSettings;
use crate::design::Design;
use crate::pipeline::{Settings, Thoroughness};
use crate::request;

const DYNAMICS: &str = "\
Check the way out of the bond and the deepest trap's escape by moving tiles, with RUNS \
trajectories below each [default: 1000]; a contradiction ends the command with status 1 after all \
results are written. 1000 take a second of a core and, for curved shapes, up to five";

/// How much work a design is worth.
#[derive(Clone, Debug, PartialEq, Args)]
#[command(mut_arg("dynamics", |dynamics| dynamics.help(DYNAMICS)))]
pub struct Request {
    /// How thoroughly landscapes are surveyed.
    #[command(flatten)]
    pub survey: Thoroughness,

    /// Width (J) to which the certified bounds are narrowed [default: a hundredth of the
    /// bond or a twentieth of the barrier, whichever is less]
    #[arg(long, value_name = "E_J", value_parser = request::positive)]
    pub tolerance: Option<f64>,

    /// Cells spent on the certified bounds of a barrier at most; 0 for no bounds [default: 200000; of
    /// very many magnets 0]
    #[arg(long, value_name = "N", value_parser = request::count_or_none)]
    pub certify_cells: Option<usize>,

    /// Cells spent on the search for states that the survey missed, at most; 0 for no search
    /// [default: 300000; of very many magnets 0]
    #[arg(long, value_name = "N", value_parser = request::count_or_none)]
    pub complete_cells: Option<usize>,

    /// Seed of all random numbers: the same seed gives the same results
    #[arg(long, value_name = "N", default_value_t = Settings::default().seed,
          value_parser = request::seed)]
    pub seed: u64,
}

impl Request {
    /// The settings for designs, the same for all.
    pub fn settings<'a>(
        &self,
        designs: impl IntoIterator<Item = &'a Design>,
    ) -> AssessmentSettings {
        let default = AssessmentSettings::of(designs);
        AssessmentSettings {
            milestones: self.survey.milestones.unwrap_or(default.milestones),
            neighbours: self.survey.neighbours,
            settled: self.survey.settled,
            far_starts: self.survey.far_starts.unwrap_or(default.far_starts),
            most_kinds: self.survey.kinds.or(default.most_kinds),
            tolerance: self.tolerance,
            certify_cells: self.certify_cells.unwrap_or(default.certify_cells),
            complete_cells: self.complete_cells.unwrap_or(default.complete_cells),
            dynamics_runs: self.survey.dynamics_runs(),
        }
    }
}
