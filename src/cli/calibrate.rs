//! `tilebind calibrate`.

use std::path::PathBuf;

use clap::Args;
use tilebind::calibration::{Fitted, ForcesRequest, PairsRequest};
use tilebind::observer::Silent;
use tilebind::report::calibration::{FILES, document};

use super::options::DesignOptions;
use super::results::ResultOptions;
use super::{Asked, Failure, input};

/// Fit the magnets' strength or soft-iron shields to measured forces, or kT to observed pairs
#[derive(Args)]
#[command(
    mut_arg("area", |area| area.requires("bonds")),
    mut_arg("within", |within| within.requires("bonds")),
    mut_arg("hold_out", |hold_out| hold_out.conflicts_with_all(["bonds", "gaps"])),
    after_help = EXAMPLES,
    after_long_help = format!("{NOTES}\n\n{EXAMPLES}")
)]
pub struct Calibrate {
    #[command(flatten)]
    design: DesignOptions,

    /// Measured energies, forces or torques (CSV)
    #[arg(required_unless_present_any = ["bonds", "gaps"], conflicts_with_all = ["bonds", "gaps"])]
    table: Option<PathBuf>,

    /// Fit the remanence to forces over the gap (CSV: gap_mm,force_g)
    #[arg(long, value_name = "FILE", conflicts_with = "bonds")]
    gaps: Option<PathBuf>,

    /// Fit kT instead, from observed pairs (CSV: bound_s,apart_s or distance_m)
    #[arg(long, value_name = "FILE")]
    bonds: Option<PathBuf>,

    #[command(flatten)]
    pairs: Asked<PairsRequest>,

    #[command(flatten)]
    forces: Asked<ForcesRequest>,

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

Rows without iron determine the strength of the magnets, rows with iron the constants of the shields;
without any rows with iron only the strength is fitted.
Shields are on the faces that have one in the design, or on all faces if none has one. The held-out
rows measure how well the model predicts other poses.

FILE of --gaps has the force that pulls the target faces straight apart, or pushes them together, over
the gap between them, as a kitchen scale shows it. Its first line names two columns with their units:
  gap_mm, force_g        also cm, in, N, kg, lb; or gap,force with values such as 1.5 mm and 120 g
Attraction and repulsion are both written as positive numbers. The remanence and the zero of the gap
are fitted (the zero from four readings on). If no remanence fits, the command says so.

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
  tilebind calibrate my.toml --gaps scale.csv --out target/scale
  tilebind calibrate my.toml measured.csv
  tilebind calibrate my.toml --bonds distances.csv --within 0.75
  tilebind calibrate my.toml --bonds intervals.csv --area 0.6";

impl Calibrate {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        let file = self.bonds.as_ref().or(self.gaps.as_ref());
        let file = file.or(self.table.as_ref());
        let file = file.cloned().unwrap_or_default();
        let mut inputs = self.design.inputs(&design);
        inputs.push(file.clone());
        let output = self.results.output(&FILES, inputs)?;
        let progress = self.results.progress();
        let found = input::table(&file, |text| match (&self.bonds, &self.gaps) {
            (Some(_), _) => self.pairs.of_pairs(&design, text, &Silent),
            (_, Some(_)) => Fitted::of_gaps(&design, text),
            _ => self.forces.of_forces(&design, text),
        })?;
        self.results
            .deliver(&document(&design, &found), output, &progress)
    }
}
