//! `tilebind calibrate`.

use std::path::PathBuf;

use clap::Args;
use tilebind::calibration::Request;
use tilebind::observer::Silent;
use tilebind::report::calibration::document;
use tilebind::report::files::CALIBRATE;

use super::options::DesignOptions;
use super::results::ResultOptions;
use super::{Failure, input};

/// Fit the constants of soft-iron shields to measured forces, or kT to pairs that bind and part
#[derive(Args)]
#[command(
    mut_arg("area", |area| area.requires("bonds")),
    mut_arg("within", |within| within.requires("bonds")),
    after_help = "\
The table is a CSV file. Its first line names the columns, in any order: x_m, y_m, theta_rad (the
moving tile's pose in the fixed tile's frame), iron (1 with the shields in place, 0 without), and
at least one of energy_J, force_x_N, force_y_N, torque_Nm (on the moving tile, in the fixed tile's
frame, about its reference point). Entries of the last four may be left empty; lines that begin
with # are skipped.

Rows without iron give the strength of the magnets, rows with iron the shields' constants. The
shields sit on the faces that have one in the design, or on all faces if none has. Rows held out of
the fit say how good the model is for other poses.

With --bonds the table has two columns, bound_s and apart_s: the intervals for which a pair was
bound, and for which it was apart (s); what still lasted when watching ended has a > before it (>120) and
has to be there, for short intervals are seen to their ends more often than long ones. Their means give K
and so the effective kT of the shaking. Speeds of tiles do not: where both were measured, they differed tenfold. Or the table has the column
distance_m: how far apart the reference points of a pair were (m) when it was looked at, each time long
after the last. The kT of the greatest likelihood is printed, for the distances up to --within.

Examples:
  tilebind calibrate my.toml measured.csv
  tilebind calibrate my.toml --bonds distances.csv --within 0.75
  tilebind calibrate my.toml --bonds intervals.csv --area 0.6")]
pub struct Calibrate {
    #[command(flatten)]
    design: DesignOptions,

    /// The measurements (CSV)
    #[arg(required_unless_present = "bonds", conflicts_with = "bonds")]
    table: Option<PathBuf>,

    /// Fit kT instead, to intervals for which pairs were bound and apart (CSV: bound_s,apart_s), or
    /// to distances of pairs (CSV: distance_m)
    #[arg(long, value_name = "FILE")]
    bonds: Option<PathBuf>,

    #[command(flatten)]
    request: Request,

    #[command(flatten)]
    results: ResultOptions,
}

impl Calibrate {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        let file = self.bonds.as_ref().or(self.table.as_ref());
        let file = file.cloned().unwrap_or_default();
        let mut inputs = self.design.inputs(&design);
        inputs.push(file.clone());
        let output = self.results.output(&CALIBRATE, inputs)?;
        let progress = self.results.progress();
        let found = input::table(&file, |text| match self.bonds {
            None => self.request.of_forces(&design, text),
            Some(_) => self.request.of_pairs(&design, text, &Silent),
        })?;
        self.results
            .deliver(&document(&design, &found), output, &progress)
    }
}
