//! `tilebind calibrate`.

use std::path::PathBuf;

use clap::Args;
use tilebind::calibration::{Request, check_magnets};
use tilebind::observer::Silent;
use tilebind::report::calibration::{FILES, document};

use super::options::DesignOptions;
use super::results::ResultOptions;
use super::{Failure, input};

/// Fit the constants of soft-iron shields to measured forces, or kT to observed pairs
#[derive(Args)]
#[command(
    mut_arg("area", |area| area.requires("bonds")),
    mut_arg("within", |within| within.requires("bonds")),
    after_help = EXAMPLES,
    after_long_help = format!("{NOTES}\n\n{EXAMPLES}")
)]
pub struct Calibrate {
    #[command(flatten)]
    design: DesignOptions,

    /// Measured energies, forces or torques (CSV)
    #[arg(required_unless_present = "bonds", conflicts_with = "bonds")]
    table: Option<PathBuf>,

    /// Fit kT instead, from observed pairs (CSV: bound_s,apart_s or distance_m)
    #[arg(long, value_name = "FILE")]
    bonds: Option<PathBuf>,

    #[command(flatten)]
    request: Request,

    #[command(flatten)]
    results: ResultOptions,
}

const NOTES: &str = "\
TABLE is a CSV file. Its first line names the columns, in any order:
  x_m, y_m, theta_rad    the moving tile's pose in the fixed tile's frame
  iron                   1 with the shields in place, 0 without
  energy_J, force_x_N, force_y_N, torque_Nm
                         at least one of these: on the moving tile, in the fixed tile's frame, about
                         the moving tile's reference point; cells may be empty
Lines that begin with # are skipped.

Rows without iron determine the strength of the magnets, rows with iron the constants of the shields.
Shields are on the faces that have one in the design, or on all faces if none has one. The held-out
rows measure how well the model predicts other poses.

FILE of --bonds has one of two forms:
  bound_s, apart_s       intervals (s) during which a pair was bound, and apart. Prefix unfinished
                         intervals with > (>120). Do not leave them out: without them long intervals
                         are under-represented. The mean intervals give K, and K gives kT.
  distance_m             distances (m) between the reference points of a pair, taken far enough apart
                         in time to be independent. The maximum-likelihood kT for the distances up to
                         --within is printed.
Do not infer kT from tile speeds (tenfold error in published experiments).";

const EXAMPLES: &str = "\
Examples:
  tilebind calibrate my.toml measured.csv
  tilebind calibrate my.toml --bonds distances.csv --within 0.75
  tilebind calibrate my.toml --bonds intervals.csv --area 0.6";

impl Calibrate {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        if self.bonds.is_none() {
            check_magnets(&design)?;
        }
        let file = self.bonds.as_ref().or(self.table.as_ref());
        let file = file.cloned().unwrap_or_default();
        let mut inputs = self.design.inputs(&design);
        inputs.push(file.clone());
        let output = self.results.output(&FILES, inputs)?;
        let progress = self.results.progress();
        let found = input::table(&file, |text| match self.bonds {
            None => self.request.of_forces(&design, text),
            Some(_) => self.request.of_pairs(&design, text, &Silent),
        })?;
        self.results
            .deliver(&document(&design, &found), output, &progress)
    }
}
