//! `tilebind analyse`: the main job.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use tilebind::analysis::Settings;
use tilebind::design::MagnetModel;
use tilebind::dynamics::check::BarrierCheck;
use tilebind::pipeline::{self, Observer};
use tilebind::report::writer::{self, Extent, WriteError};
use tilebind::report::{arrays, summary};

use super::failure::fail_if_contradicted;
use super::progress::Progress;
use super::{Failure, input, interrupt, print};

/// Find the states, traps, barriers and pathways of a design, and draw them
#[derive(Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Where moving tiles contradict a barrier (--dynamics), all results are written, the contradiction is
told and the exit status is 1.

Examples:
  tilebind analyse shapes/paper-tile.toml --out target/paper-tile
  tilebind analyse my.toml --out my-results --milestones 20000 --repeats 5
  tilebind analyse my.toml --out my-results --dynamics
  tilebind analyse my.toml --out my-results --arrays
  tilebind analyse my.toml --out my-results --json | jq '.states[0].capture'"
)]
pub struct Analyse {
    /// The design file
    design: PathBuf,

    /// Model of the magnets, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = input::model)]
    model: Option<MagnetModel>,

    /// Folder for the results; made if need be
    #[arg(long, value_name = "DIR")]
    out: PathBuf,

    /// Seed of all random numbers: the same seed gives the same results
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,

    /// Milestones of the roadmap
    #[arg(long, value_name = "N", default_value_t = 8000,
          value_parser = clap::value_parser!(u32).range(1..))]
    milestones: u32,

    /// Neighbours of each milestone [default: e (1 + 1/3) ln N]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    neighbours: Option<u32>,

    /// Runs, each with the next seed; every barrier's spread over them is reported
    #[arg(long, value_name = "R", default_value_t = 1,
          value_parser = clap::value_parser!(u32).range(1..))]
    repeats: u32,

    /// A barrier is settled when it moves by less than this fraction
    #[arg(long, value_name = "F", default_value_t = 0.005, value_parser = input::fraction)]
    settled: f64,

    /// Far starts from which capture shares are counted
    #[arg(long, value_name = "N", default_value_t = 1000)]
    far_starts: u32,

    /// Accept milestones by Boltzmann's rule at this energy (J), not by the linear rule
    #[arg(long, value_name = "E_J", value_parser = input::positive)]
    boltzmann: Option<f64>,

    /// Thermal energy (J) of the transition probabilities [default: a hundredth of the bond]
    #[arg(long, value_name = "E_J", value_parser = input::positive)]
    thermal_energy: Option<f64>,

    /// Width (J) to which the certified bounds are narrowed [default: a hundredth of
    /// the bond or a twentieth of the barrier, whichever is less]
    #[arg(long, value_name = "E_J", value_parser = input::positive)]
    tolerance: Option<f64>,

    /// Seconds after which the certificate keeps the bounds it has; 0 for no certificate
    #[arg(long, value_name = "S", default_value_t = 60.0, value_parser = input::not_negative)]
    certify_seconds: f64,

    /// Check every barrier by moving tiles, with RUNS trajectories below each [default: 1000];
    /// 1000 take some two seconds of a core for each barrier (the paper's tile has 23)
    #[arg(long, value_name = "RUNS", num_args = 0..=1, require_equals = true,
          default_missing_value = "1000", value_parser = clap::value_parser!(u32).range(1..))]
    dynamics: Option<u32>,

    /// Threads [default: all cores]; the results do not depend on them
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    /// Leave out PNG pictures and the pathways of symmetric copies: for results that are kept
    #[arg(long)]
    compact: bool,

    /// Write maps, roadmap, states and barriers as NPY files too, for NumPy: folder arrays/
    #[arg(long)]
    arrays: bool,

    /// Print report.json instead of the summary
    #[arg(long)]
    json: bool,

    /// Print neither progress nor the summary
    #[arg(long)]
    quiet: bool,
}

impl Analyse {
    pub fn run(self) -> Result<(), Failure> {
        let start = Instant::now();
        let design = input::load_as(&self.design, self.model)?;
        input::check_folder(&self.out)?;
        input::use_threads(self.threads)?;
        interrupt::prepare()?;

        let progress = Progress::new(self.quiet);
        let analysis = pipeline::analyse(&design, &self.settings(), &progress);
        progress.stage("pictures", 0.95);
        let extent = if self.compact {
            Extent::Compact
        } else {
            Extent::Full
        };
        let mut files =
            writer::files(&design, &analysis, extent, start).map_err(WriteError::from)?;
        if self.arrays {
            files.extend(arrays::files(&design, &analysis));
        }
        interrupt::without(|| writer::write(&self.out, &files))?;
        progress.finish();

        if self.json {
            print(&String::from_utf8_lossy(&files[writer::REPORT]))?;
        } else if !self.quiet {
            let folder = self.out.display().to_string();
            print(&summary::summary(&design, &analysis, &folder))?;
        }
        fail_if_contradicted(analysis.contradicted().map(BarrierCheck::told))
    }

    fn settings(&self) -> Settings {
        Settings {
            seed: self.seed,
            milestones: self.milestones as usize,
            neighbours: self.neighbours.map(|k| k as usize),
            boltzmann: self.boltzmann,
            thermal_energy: self.thermal_energy,
            settled: self.settled,
            far_starts: self.far_starts as usize,
            repeats: self.repeats as usize,
            tolerance: self.tolerance,
            certify_seconds: self.certify_seconds,
            dynamics_runs: self.dynamics.unwrap_or(0) as usize,
            ..Settings::default()
        }
    }
}
