//! Options of the commands that assess designs.

use clap::Args;
use tilebind::comparison::AssessmentSettings;

use super::input;

/// How much work a design is worth.
#[derive(Args)]
pub struct AssessmentOptions {
    /// Milestones of the roadmap
    #[arg(long, value_name = "N", default_value_t = 8000,
          value_parser = clap::value_parser!(u32).range(1..))]
    milestones: u32,

    /// Neighbours of each milestone [default: e (1 + 1/3) ln N]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    neighbours: Option<u32>,

    /// A barrier is settled when it moves by less than this fraction
    #[arg(long, value_name = "F", default_value_t = 0.005, value_parser = input::fraction)]
    settled: f64,

    /// Far starts from which capture shares are counted
    #[arg(long, value_name = "N", default_value_t = 1000)]
    far_starts: u32,

    /// Width (J) to which the certified bounds are narrowed [default: a hundredth of the bond]
    #[arg(long, value_name = "E_J", value_parser = input::positive)]
    tolerance: Option<f64>,

    /// Cells spent on the certified bounds of a barrier at most; 0 for no bounds
    #[arg(long, value_name = "N", default_value_t = 200_000)]
    certify_cells: u32,

    /// Check every barrier by moving tiles, with RUNS trajectories below each [default: 1000]; a
    /// contradiction ends the command with status 1 after all results are written. 1000 take some
    /// two seconds of a core for each barrier
    #[arg(long, value_name = "RUNS", num_args = 0..=1, require_equals = true,
          default_missing_value = "1000", value_parser = clap::value_parser!(u32).range(1..))]
    dynamics: Option<u32>,
}

impl AssessmentOptions {
    pub fn settings(&self) -> AssessmentSettings {
        AssessmentSettings {
            milestones: self.milestones as usize,
            neighbours: self.neighbours.map(|k| k as usize),
            settled: self.settled,
            far_starts: self.far_starts as usize,
            tolerance: self.tolerance,
            certify_cells: self.certify_cells as usize,
            dynamics_runs: self.dynamics.unwrap_or(0) as usize,
        }
    }
}
