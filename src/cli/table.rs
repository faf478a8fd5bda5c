//! `tilebind table`.

use std::path::{Path, PathBuf};

use clap::Args;
use tilebind::assembly::lattice;
use tilebind::design::MagnetModel;
use tilebind::many_bodies::usual_step;
use tilebind::report::files::TABLE;
use tilebind::report::hoomd;
use tilebind::report::table::document;
use tilebind::request;
use tilebind::table::{self, About, PART, Request, Wanted, Workload, compared};
use tilebind::text::{self, with_commas};
use tilebind::units::duration;

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Asked, By, Failure, input, tell};

/// Simulate many tiles on one table, with contact, friction and drives, and count bonds and traps
#[derive(Args)]
#[command(after_help = "\
All tiles move, including those of the fixed kind: --count 12,12 is twelve of each kind, --count 12 twelve
of a design of one kind. They start at random positions or at those of --start, a CSV file with the
columns tile,kind,x,y,theta,vx,vy,omega (m, rad, m/s, rad/s), without kind if there is only one.

A bond is a pair that lies as the target faces do, or as faces equal to them. A trap is any other pair in
contact that lacks the energy to separate, unless it follows from bonds to a common neighbour (the corners
in a sheet) or has less than 0.5 % of a bond's energy: these are counted as contacts. Tiles joined by bonds
are structures: rings, chains and sheets. Every run keeps an energy balance; if more than 1 % is missing, the run is repeated
with half the step.

Several designs share one table, the first design's. Their kinds are `NAME fixed` and `NAME moving`;
any contact that holds between tiles of different designs is a trap.

Tiles lie on an air table without friction, or rub on the table with --table-friction, which --orbital and
--linear move. Drag is relative to the table, not to the room. [table] in the design can be round.

With --out, OVITO (ovito.org) opens trajectory.gsd; ends.png shows the table at the end of every run; with
--frames, trajectory.png is the first run as an animated picture, which browsers play.

Examples:
  tilebind table shapes/paper-tile.toml --count 5,5 --time 60 --shaking 3e-3 --drag 0.5
  tilebind table shapes/ring-of-eight.toml --count 16 --time 20 --runs 40 --drag 0 --table-friction 0.2 \\
    --orbital \"10 mm,200 rpm\" --target ring:8 --out target/shaker
  tilebind table shapes/paper-tile.toml --count 5,5 --time 60 --runs 20 --shaking 3e-3 --drag 0.5 \\
    --out target/table
  tilebind table lattice --lattice 2x2 --count 3,3,3,3 --time 60 --shaking 5e-3 --drag 0.5 --compare
  tilebind table shapes/tab-10mm.toml shapes/arc-20mm.toml --count 3,3 --time 60 --shaking 3e-3 --drag 0.5
  tilebind table shapes/paper-tile.toml --count 5,5 --time 600 --runs 20 --shard 1/4 --out target/part-1
  tilebind table shapes/paper-tile.toml --count 5,5 --time 600 --runs 20 --merge target/part-* --out target/all
  tilebind table shapes/paper-tile.toml --count 50,50 --time 0.1 --shaking 3e-3 --drag 0.5 --hoomd \\
    --out target/hoomd
  tilebind table shapes/ring-of-eight.toml --count 16 --time 60 --runs 20 --shaking 4e-4 --drag 2 --target ring:8
  tilebind table my.toml --start start.csv --time 5 --friction 0 --restitution 1 --frames 0.02 --out run")]
pub struct TableCommand {
    /// Design files, whose tiles share the first one's table, or one tile set as for `tilebind assemble`:
    /// a file, lattice or homogeneous
    #[arg(value_name = "DESIGN|TILESET", required = true)]
    tiles: Vec<PathBuf>,

    /// Magnet model, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = By(request::model()),
          hide_possible_values = true)]
    model: Option<MagnetModel>,

    /// Rows and columns of the tile set `lattice` or `homogeneous`
    #[arg(long, value_name = "MxN", value_parser = lattice::size)]
    lattice: Option<[usize; 2]>,

    #[command(flatten)]
    request: Asked<Request>,

    /// Initial tiles (CSV), instead of --count tiles at random positions
    #[arg(long, value_name = "FILE.csv", conflicts_with = "count")]
    start: Option<PathBuf>,

    /// Join all parts of the same command, by their folders, instead of simulating
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with = "shard")]
    merge: Vec<PathBuf>,

    /// Also write hoomd_table.py, to continue in HOOMD-blue with more tiles than one machine can
    /// simulate
    #[arg(long, requires = "out")]
    hoomd: bool,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl TableCommand {
    pub fn run(self) -> Result<(), Failure> {
        self.request.check().map_err(Failure::Usage)?;
        let set = match &self.tiles[..] {
            [one] if one.extension().is_none_or(|it| it != "toml") => Some(one),
            _ => None,
        };
        if self.lattice.is_some() && set.is_none() {
            return Err(Failure::Usage(
                "--lattice is the size of the tile set lattice or homogeneous: write one of them instead of a \
                 design"
                    .into(),
            ));
        }
        let mut designs = Vec::new();
        let target = self.request.target.iter().filter_map(|it| match it {
            Wanted::File(file) => Some(file),
            Wanted::Known(_) => None,
        });
        let files = set.into_iter().chain(&self.start).chain(target);
        let mut inputs: Vec<PathBuf> = files.cloned().collect();
        for path in self.tiles.iter().filter(|_| set.is_none()) {
            let design = input::load_as(path, self.model)?;
            inputs.extend(input::files_of(path, &design));
            designs.push(design);
        }
        let parts: Vec<PathBuf> = self.merge.iter().map(|it| it.join(PART)).collect();
        inputs.extend(parts.iter().cloned());
        let output = self.results.output(&TABLE, inputs)?;
        self.threads.use_threads()?;
        let (about, mut crowd) = match set {
            None => About::of_designs(&designs).map_err(Failure::Usage)?,
            Some(set) => About::of_set(set, &self.request, self.model, self.lattice)?,
        };
        let file = self.start.as_ref().map(|path| named("start", path));
        let file = file.transpose()?;
        let file = file
            .as_ref()
            .map(|(name, text)| (&name[..], with_commas(text)));
        let progress = self.results.progress();
        let start = self.request.start(
            (&about, &crowd),
            file.as_ref().map(|(name, text)| (*name, &text[..])),
            &progress,
        );
        let start = start.map_err(Failure::Usage)?;
        let workload = Workload::of(&self.request, usual_step(&crowd), &start);
        workload.check().map_err(Failure::Usage)?;
        let long = workload.long(self.threads.count());
        if let Some(time) = long.filter(|_| self.merge.is_empty()) {
            let Workload { steps, tiles, .. } = workload;
            let runs = workload.runs();
            tell(format!(
                "note: {runs} of {steps} steps with {tiles} tiles: expect some {}, at about 1 us for each \
                 tile and step",
                duration(time, 2)
            ));
        }
        crowd.goal = self
            .request
            .goal((&about, &crowd), &start, &progress)
            .map_err(Failure::Usage)?;
        let parts = parts.iter().map(|path| named("part", path));
        let parts = parts.collect::<Result<Vec<_>, Failure>>()?;
        let found = table::table((&about, crowd), &self.request, start, &parts, &progress);
        let found = found.map_err(Failure::of)?;
        let beside = compared((&about, &designs), &self.request, &found, &progress);
        let mut document = document(&about, &found, &self.request, beside.as_ref());
        if self.hoomd {
            document.beside.extend(hoomd::files(&about, &found));
        }
        self.results.deliver(&document, output, &progress)
    }
}

/// A file of text with its name.
fn named(what: &str, path: &Path) -> Result<(String, String), Failure> {
    let name = path.display().to_string();
    let text = text::read(path);
    let text =
        text.map_err(|error| Failure::usage(format!("cannot read the {what} {name}: {error}")))?;
    Ok((name, text))
}
