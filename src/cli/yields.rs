//! `tilebind yield`.

use clap::Args;
use tilebind::dynamics::MotionSettings;
use tilebind::kinetics::OVERDAMPED;
use tilebind::report::files::YIELD;
use tilebind::report::yields::document;
use tilebind::yields::attachment::{Effort, Source};
use tilebind::yields::{Question, YieldError, yields};

use super::options::{DesignOptions, WorkOptions};
use super::results::ResultOptions;
use super::{Failure, input, interrupt};

/// How many pairs are bound after a time on a shaken table, and at which shaking most are
#[derive(Args)]
#[command(after_help = "\
Half of the tiles are of the fixed tile's kind, half of the moving one's; each binds one partner at
most. Attachment rates are counted in docking runs of shaken tiles (or, with --rates overdamped, solved
for overdamped motion as `tilebind rates` does), detachment rates follow by detailed balance from the states' partition functions (`tilebind bond`). That is honest for a table
that has a temperature: contact that swallows energy, which shaking does not give back, has none. Of
several kT those at which the bond holds nothing, or moves less than contact is known, are left out, and
it is said why.

Examples:
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 600 --kt 3e-3
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 36000 --kt 3e-3 --rates overdamped
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 600 --kt 2e-3,4e-3,6e-3 --out target/yield")]
pub struct YieldCommand {
    #[command(flatten)]
    design: DesignOptions,

    /// Tiles on the table, half of either kind
    #[arg(long, value_name = "N", value_parser = tiles)]
    tiles: usize,

    /// How long the table is shaken (s)
    #[arg(long, value_name = "S", value_parser = input::positive)]
    time: f64,

    /// Effective energy kT of the shaking (J); of several, the best and a schedule are found
    #[arg(long, value_name = "E_J[,E_J...]", value_parser = input::shaking,
          value_delimiter = ',', required = true)]
    kt: Vec<f64>,

    /// Share of the table that tiles cover
    #[arg(long, value_name = "F", default_value_t = 0.3, value_parser = input::fraction)]
    coverage: f64,

    /// Docking runs for each kT
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = input::runs)]
    runs: usize,

    /// How long each docking run lasts (s)
    #[arg(long, value_name = "S", default_value_t = 10.0, value_parser = input::positive)]
    duration: f64,

    /// Where attachment rates come from: docking runs, or overdamped motion as in `tilebind rates`
    #[arg(long, value_enum, default_value_t = Rates::Docking)]
    rates: Rates,

    /// Drag rate (1/s) [default: 0.005 of docking runs, 50 of overdamped motion]
    #[arg(long, value_name = "C", value_parser = input::positive)]
    drag: Option<f64>,

    /// Share of the approach velocity that a knock gives back
    #[arg(long, value_name = "E", default_value_t = MotionSettings::default().restitution,
          value_parser = input::share)]
    restitution: f64,

    /// Runs of the exact simulation by which the numbers are checked; 0 for none
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = input::runs_or_none)]
    simulations: usize,

    #[command(flatten)]
    work: WorkOptions,

    #[command(flatten)]
    results: ResultOptions,
}

/// Where attachment rates come from.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Rates {
    Docking,
    Overdamped,
}

/// Most tiles.
const MOST_TILES: usize = 10_000;
/// Most settings.
const MOST_SETTINGS: usize = 20;

impl YieldCommand {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        if self.kt.len() > MOST_SETTINGS {
            let message = format!("--kt: at most {MOST_SETTINGS} energies are compared");
            return Err(Failure::Usage(message));
        }
        let design = self.design.load()?;
        let output = self.results.output(&YIELD, self.design.inputs(&design))?;
        self.work.use_threads()?;
        let question = self.question();
        let progress = self.results.progress();
        let found = yields(&design, &question, &progress).map_err(failure)?;
        let document = document(&design, &question, &found);
        self.results.deliver(&document, output, &progress)
    }

    fn question(&self) -> Question {
        let (source, usual) = match self.rates {
            Rates::Docking => (Source::Docking, MotionSettings::default().drag),
            Rates::Overdamped => (Source::Overdamped, OVERDAMPED),
        };
        Question {
            kts: self.kt.clone(),
            coverage: self.coverage,
            tiles: self.tiles,
            time: self.time,
            effort: Effort {
                runs: self.runs,
                duration: self.duration,
                motion: MotionSettings {
                    drag: self.drag.unwrap_or(usual),
                    restitution: self.restitution,
                    ..MotionSettings::default()
                },
                source,
            },
            simulations: self.simulations,
            seed: self.work.seed,
        }
    }
}

fn failure(error: YieldError) -> Failure {
    match error {
        YieldError::Docking(error) => Failure::Usage(error.to_string()),
        YieldError::Hot(..) | YieldError::Cold(_) | YieldError::Lost => {
            Failure::Usage(error.to_string())
        }
        YieldError::Rates(error) => error.into(),
        error => Failure::Run(error.to_string()),
    }
}

fn tiles(text: &str) -> Result<usize, String> {
    match input::count(text)? {
        count @ 2..=MOST_TILES => Ok(count),
        _ => Err(format!(
            "a number of tiles from 2 to {MOST_TILES} is needed"
        )),
    }
}
