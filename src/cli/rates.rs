//! `tilebind rates`.

use clap::Args;
use tilebind::Configuration;
use tilebind::design::Design;
use tilebind::kinetics::exit::{ExitError, ExitSettings, exit};
use tilebind::report::{json, rates as report};

use super::options::{self, DesignOptions};
use super::{Failure, input, interrupt, print};

/// Part of the bond's energy below which a tile counts as bound.
const BASIN: f64 = 0.5;

/// Print how soon a shaken tile leaves a pose, and whether it is bound or free first
#[derive(Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Overdamped motion: D = kT / (RATE mass) in x and y and D / rho^2 in theta (rho: radius of gyration),
reflected where tiles touch. The mean exit time and the probabilities of the exits solve the backward
equation on a mesh of (x, y, theta) that is refined where it matters. Both ends are sets: without
them no rate means anything, so they are printed beside every number.

kT is an effective energy of shaking. It exists for drag of 50 /s and more and for knocks that take no
energy; tiles that glide far between knocks, or whose knocks take what shaking does not give back,
have none.

Examples:
  tilebind rates shapes/paper-tile.toml --kt 3e-3 --drag 50 --start 0.43,-0.04,0
  tilebind rates shapes/paper-tile.toml --kt 1e-3 --drag 50 --start \"43 cm,-4 cm,0\" \\
    --basin-energy -0.03 --free-at 0.75 --json"
)]
pub struct Rates {
    #[command(flatten)]
    design: DesignOptions,

    /// Effective energy of shaking (J)
    #[arg(long, value_name = "E_J", value_parser = input::positive)]
    kt: f64,

    /// Drag rate (1/s): the drag is this times the mass
    #[arg(long, value_name = "RATE", default_value_t = 50.0, value_parser = input::positive)]
    drag: f64,

    /// Pose at which the tile is let go (m, m, rad)
    #[arg(long, value_name = "X,Y,THETA", allow_hyphen_values = true, value_parser = input::pose)]
    start: Configuration,

    /// The tile is bound where U (J) is lower, in the basin of the bond or of one of its copies
    /// [default: half the bond's energy]
    #[arg(long, value_name = "E_J", allow_hyphen_values = true, value_parser = input::negative)]
    basin_energy: Option<f64>,

    /// The tile is free where the centres are so far apart (m) [default: where `analyse` has it]
    #[arg(long, value_name = "R", value_parser = input::length)]
    free_at: Option<f64>,

    /// Threads [default: all cores]; the results do not depend on them
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,

    /// Print JSON instead of text
    #[arg(long)]
    json: bool,
}

impl Rates {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        options::use_threads(self.threads)?;
        let design = self.design.load()?;
        input::doubt_pose(&design, &self.start);
        let asked = self.asked(&design);
        let found = exit(&design.problem(), &design.pair.bound, &asked);
        let found = found.map_err(|error| match error {
            ExitError::Unsolved(_) => Failure::Run(error.to_string()),
            _ => Failure::Usage(error.to_string()),
        })?;
        let motion = report::Motion::new(&design, self.kt, self.drag);
        print(&if self.json {
            json::text(&report::exit_entry(&asked, &motion, &found))
        } else {
            report::exit_summary(&design, &asked, &motion, &found)
        })
    }

    fn asked(&self, design: &Design) -> ExitSettings {
        let half = || BASIN * design.problem().energy(&design.pair.bound);
        ExitSettings::new(
            self.kt,
            self.start,
            self.basin_energy.unwrap_or_else(half),
            self.free_at.unwrap_or(design.space().free_distance),
        )
    }
}
