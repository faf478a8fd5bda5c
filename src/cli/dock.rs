//! `tilebind dock`.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Args;
use tilebind::Problem;
use tilebind::design::Design;
use tilebind::docking::{Paths, Request};
use tilebind::dynamics::docking::{self, DockingError};
use tilebind::kinetics::rates::Loosening;
use tilebind::observer::Observer;
use tilebind::rates::diffusion;
use tilebind::report::files::DOCK;
use tilebind::report::{docking as report, release};

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Failure, input, interrupt};

/// Send the moving tile towards the fixed one many times and count how it ends
#[derive(Args)]
#[command(after_help = "\
Starts are drawn uniformly: distance, direction about the target face, orientation about the bound
one, speed, and the velocity's direction about that to the fixed tile. On the paper's tile a
trajectory takes some 4 ms of a core.

Examples:
  tilebind dock shapes/paper-tile.toml --runs 2000
  tilebind dock shapes/paper-tile.toml --runs 2000 --drag 0.5 --no-walls --restitution 0.1
  tilebind dock shapes/paper-tile.toml --runs 20000 --out target/dock
  tilebind dock my.toml --runs 1000 --speed 0.4,0.8 --orientation 0.5
  tilebind dock shapes/halbach.toml --from-bond --shaking 3e-3 --drag 5 --duration 60 --runs 200
  tilebind dock shapes/halbach.toml --from-bond --shaking 1.5e-3 --drag 50 --restitution 1 \
      --friction 0 --duration 60 --runs 200 --overdamped
  tilebind dock my.toml --runs 1000 --fan 0.6,0.6,1e-3,0.2 --drag 0.5 --shaking 1e-5")]
pub struct Dock {
    /// The design file
    design: PathBuf,

    #[command(flatten)]
    request: Request,

    /// Start bound instead, with a thermal velocity, and find the rate of detachment; the options of
    /// starts do not matter
    #[arg(long, requires = "shaking", conflicts_with = "trajectory")]
    from_bond: bool,

    /// With --from-bond: tell the rate of overdamped motion at the same kT and drag beside it, solved
    /// on a mesh as `tilebind rates` does
    #[arg(long, requires = "from_bond")]
    overdamped: bool,

    /// Number of the trajectory that is written to trajectory.csv and that the page plays first
    /// [default: the first bound one]
    #[arg(long, value_name = "N")]
    trajectory: Option<usize>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl Dock {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        let design = input::load(&self.design)?;
        let problem = design.problem();
        let inputs = input::files_of(&self.design, &design);
        let output = self.results.output(&DOCK, inputs)?;
        self.threads.use_threads()?;
        let settings = self.request.settings();
        if let Some(index) = self.trajectory.filter(|index| *index >= settings.runs) {
            return Err(Failure::Usage(format!(
                "--trajectory {index}: the {} trajectories are numbered from 0; ask for more --runs",
                settings.runs
            )));
        }
        let progress = self.results.progress();
        let done = AtomicUsize::new(0);
        let step = || {
            let done = 1 + done.fetch_add(1, Ordering::Relaxed);
            progress.share("trajectories", done as f64 / settings.runs as f64);
        };
        if self.from_bond {
            let beside = self.overdamped(&design, &problem, &progress)?;
            let found = docking::releases(&problem, &settings, &step).map_err(usage)?;
            let document = release::document(&design, &settings, &found, beside);
            return self.results.deliver(&document, output, &progress);
        }
        let docking = docking::dock(&problem, &settings, &step).map_err(usage)?;
        let paths = output.as_ref();
        let paths = paths.map(|_| Paths::new(&problem, &docking, self.trajectory));
        let paths = paths.transpose().map_err(usage)?;
        let document = report::document((&design, &problem), &docking, paths.as_ref());
        self.results.deliver(&document, output, &progress)
    }

    /// The off-rates of overdamped motion (1/s), if they are asked for.
    fn overdamped(
        &self,
        design: &Design,
        problem: &Problem,
        progress: &dyn Observer,
    ) -> Result<Option<Loosening>, Failure> {
        let Some(kt) = self.request.shaking.filter(|_| self.overdamped) else {
            return Ok(None);
        };
        progress.stage("rates", 0.0);
        let diffusion = diffusion(design, kt, self.request.drag);
        let found = Loosening::new(problem, &design.pair.bound, kt);
        let found = found.map_err(|error| match Failure::from(error) {
            // What sets kT here.
            Failure::Usage(message) => Failure::Usage(message.replace("--kt", "--shaking")),
            other => other,
        })?;
        Ok(Some(found.times(diffusion)))
    }
}

fn usage(error: DockingError) -> Failure {
    Failure::Usage(error.to_string())
}
