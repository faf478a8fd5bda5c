//! `tilebind table`.

use std::path::PathBuf;

use clap::Args;
use tilebind::design::MagnetModel;
use tilebind::report::files::TABLE;
use tilebind::report::table::document;
use tilebind::request;
use tilebind::table::{self, About, Request};
use tilebind::text::{self, with_commas};

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Failure, input};

/// Simulate many tiles on one table, with contact, friction and drives, and count bonds and traps
#[derive(Args)]
#[command(after_help = "\
All tiles move, including those of the fixed kind: --count 12,12 is twelve of each kind. They start at
random positions or at those of --start, a CSV file with the columns tile,kind,x,y,theta,vx,vy,omega
(m, rad, m/s, rad/s).

A bond is a pair whose target magnets have met. A trap is any other pair in contact that lacks the
energy to separate. Every run keeps an energy balance; if more than 1 % is missing, the run is repeated
with half the step.

Examples:
  tilebind table shapes/paper-tile.toml --count 5,5 --time 60 --shaking 3e-3 --drag 0.5
  tilebind table shapes/paper-tile.toml --count 5,5 --time 60 --runs 20 --shaking 3e-3 --drag 0.5 \\
    --out target/table
  tilebind table my.toml --start start.csv --time 5 --friction 0 --restitution 1 --frames 0.02 --out run")]
pub struct TableCommand {
    /// Design file, or tile set as for `tilebind assemble`
    #[arg(value_name = "DESIGN|TILESET")]
    tiles: PathBuf,

    /// Magnet model, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = request::model(),
          hide_possible_values = true)]
    model: Option<MagnetModel>,

    #[command(flatten)]
    request: Request,

    /// Initial tiles (CSV), instead of --count tiles at random positions
    #[arg(long, value_name = "FILE.csv", conflicts_with = "count")]
    start: Option<PathBuf>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl TableCommand {
    pub fn run(self) -> Result<(), Failure> {
        self.request.check().map_err(Failure::Usage)?;
        let is_design = self.tiles.extension().is_some_and(|it| it == "toml");
        let design = is_design.then(|| input::load_as(&self.tiles, self.model));
        let design = design.transpose()?;
        let mut inputs = match &design {
            Some(design) => input::files_of(&self.tiles, design),
            None => vec![self.tiles.clone()],
        };
        inputs.extend(self.start.clone());
        let output = self.results.output(&TABLE, inputs)?;
        self.threads.use_threads()?;
        let (about, crowd) = match &design {
            Some(design) => About::of_design(design).map_err(Failure::Usage)?,
            None => About::of_set(&self.tiles, &self.request, self.model)?,
        };
        let file = self.start.as_ref().map(|path| -> Result<_, Failure> {
            let name = path.display().to_string();
            let text = text::read(path).map_err(|error| {
                Failure::Usage(format!("cannot read the start {name}: {error}"))
            })?;
            Ok((name, with_commas(&text).into_owned()))
        });
        let file = file.transpose()?;
        let start = self.request.start(
            &crowd,
            file.as_ref().map(|it| (it.0.as_str(), it.1.as_str())),
        );
        let start = start.map_err(Failure::Usage)?;
        let progress = self.results.progress();
        let found = table::table(crowd, &self.request, &start, &progress);
        let found = found.map_err(Failure::of)?;
        let document = document(&about, &found, self.request.seed);
        self.results.deliver(&document, output, &progress)
    }
}
