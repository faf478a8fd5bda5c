//! `tilebind calibrate`.

use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::Settings;
use tilebind::calibration::bonds::PairTimes;
use tilebind::calibration::distances::PairDistances;
use tilebind::calibration::{self, Specimen};
use tilebind::design::MagnetModel;
use tilebind::kinetics::Hold;
use tilebind::observer::Silent;
use tilebind::pipeline;
use tilebind::report::calibration as report;
use tilebind::report::files::CALIBRATE;
use tilebind::request;

use super::progress::Progress;
use super::results::ResultOptions;
use super::{Failure, input};

/// Fit the constants of soft-iron shields to measured forces, or kT to pairs that bind and part
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
    /// The design file of the tiles that were measured
    design: PathBuf,

    /// The measurements (CSV)
    #[arg(required_unless_present = "bonds", conflicts_with = "bonds")]
    table: Option<PathBuf>,

    /// Fit kT instead, to intervals for which pairs were bound and apart (CSV: bound_s,apart_s), or
    /// to distances of pairs (CSV: distance_m)
    #[arg(long, value_name = "FILE")]
    bonds: Option<PathBuf>,

    /// Area that a pair had for itself (m^2) [default: the design's table]
    #[arg(long, value_name = "M2", value_parser = request::positive, requires = "bonds")]
    area: Option<f64>,

    /// Distances (m) up to which those of --bonds count, for the rim of the table is felt beyond
    /// [default: where tiles are free]
    #[arg(long, value_name = "R", value_parser = request::length, requires = "bonds")]
    within: Option<f64>,

    /// Model of the magnets, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = input::model(),
          hide_possible_values = true)]
    model: Option<MagnetModel>,

    /// Of so many rows one is held out of the fit
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = request::whole(2, u16::MAX))]
    hold_out: u16,

    #[command(flatten)]
    results: ResultOptions,
}

impl Calibrate {
    pub fn run(self) -> Result<(), Failure> {
        let design = input::load_as(&self.design, self.model)?;
        let file = self.bonds.as_ref().or(self.table.as_ref());
        let file = file.map_or(Path::new(""), PathBuf::as_path);
        let mut inputs = input::files_of(&self.design, &design);
        inputs.push(file.to_owned());
        let output = self.results.output(&CALIBRATE, inputs)?;
        let wrong =
            |error: &dyn std::fmt::Display| Failure::Usage(format!("{}: {error}", file.display()));
        let text = input::text(file).map_err(|error| wrong(&error))?;
        let document = match () {
            () if self.bonds.is_none() => {
                let rows = calibration::read_rows(&text).map_err(|error| wrong(&error))?;
                let (specimen, settings) = Specimen::of(&design, self.hold_out.into());
                let found = calibration::calibrate(&specimen, &rows, &settings);
                report::shields(&design, &found.map_err(|error| wrong(&error))?)
            }
            () if PairDistances::is_named_in(&text) => {
                let within = self.within.unwrap_or(design.space().free_distance);
                let fit = PairDistances::read(&text)
                    .and_then(|read| read.fit(&design.problem(), &design.pair.bound, within));
                report::distances(&design, &fit.map_err(|error| wrong(&error))?)
            }
            () => {
                let times = PairTimes::read(&text).map_err(|error| wrong(&error))?;
                let settings = Settings::without_proofs(Settings::default().seed);
                let analysis = pipeline::analyse(&design, &settings, &Silent);
                let bond = Hold::bond(&analysis.problem, &analysis.catalogue)
                    .map_err(|error| Failure::Run(error.to_string()))?;
                let area = self.area.unwrap_or(design.table[0] * design.table[1]);
                report::intervals(&design, &times, &bond, area)
            }
        };
        self.results
            .deliver(&document, output, &Progress::new(true))
    }
}
