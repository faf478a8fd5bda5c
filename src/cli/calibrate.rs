//! `tilebind calibrate`.

use std::path::PathBuf;

use clap::Args;
use tilebind::calibration::{self, Specimen};
use tilebind::design::MagnetModel;
use tilebind::report::calibration as report;

use super::{Failure, input, print};

/// Fit the constants of soft-iron shields to measured forces or energies
#[derive(Args)]
#[command(after_help = "\
The table is a CSV file. Its first line names the columns, in any order: x_m, y_m, theta_rad (the
moving tile's pose in the fixed tile's frame), iron (1 with the shields in place, 0 without), and
at least one of energy_J, force_x_N, force_y_N, torque_Nm (on the moving tile, in the fixed tile's
frame, about its reference point). Entries of the last four may be left empty; lines that begin
with # are skipped.

Rows without iron give the strength of the magnets, rows with iron the shields' constants. The
shields sit on the faces that have one in the design, or on all faces if none has. Rows held out of
the fit say how good the model is for other poses.

Example:
  tilebind calibrate my.toml measured.csv")]
pub struct Calibrate {
    /// The design file of the tiles that were measured
    design: PathBuf,

    /// The measurements (CSV)
    table: PathBuf,

    /// Model of the magnets, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = input::model(),
          hide_possible_values = true)]
    model: Option<MagnetModel>,

    /// Of so many rows one is held out of the fit
    #[arg(long, value_name = "N", default_value_t = 5,
          value_parser = clap::value_parser!(u16).range(2..))]
    hold_out: u16,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Calibrate {
    pub fn run(self) -> Result<(), Failure> {
        let design = input::load_as(&self.design, self.model)?;
        let wrong = |error: &dyn std::fmt::Display| {
            Failure::Usage(format!("{}: {error}", self.table.display()))
        };
        let text = input::text(&self.table).map_err(|error| wrong(&error))?;
        let rows = calibration::read_rows(&text).map_err(|error| wrong(&error))?;
        let (specimen, settings) = Specimen::of(&design, self.hold_out.into());
        let found =
            calibration::calibrate(&specimen, &rows, &settings).map_err(|error| wrong(&error))?;
        print(&if self.json {
            report::json(&design, &found)
        } else {
            report::summary(&design, &found)
        })
    }
}
