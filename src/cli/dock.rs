//! `tilebind dock`.

use std::path::PathBuf;

use clap::Args;
use tilebind::docking::{
    Paths, ReleaseOptions, Request, check_memory, docked, expected, loosening, released,
};
use tilebind::report::{docking as report, release};

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Asked, Failure, input, workload};

/// Launch the moving tile at the fixed one many times and count the outcomes
#[derive(Args)]
#[command(after_help = "\
Starting conditions are uniformly random: distance, direction from the target face, orientation
relative to the bound state, speed, and direction of the velocity relative to the line to the fixed
tile. For the paper's tile a trajectory takes about 4 ms on one core.

Examples:
  tilebind dock shapes/paper-tile.toml --runs 2000
  tilebind dock shapes/paper-tile.toml --runs 2000 --drag 0.5 --no-walls --restitution 0.1
  tilebind dock shapes/paper-tile.toml --runs 20000 --out target/dock
  tilebind dock my.toml --runs 1000 --speed 0.4,0.8 --orientation 0.5
  tilebind dock shapes/halbach.toml --from-bond --shaking 3e-3 --drag 5 --duration 60 --runs 200
  tilebind dock shapes/halbach.toml --from-bond --shaking 1.5e-3 --drag 50 --restitution 1 \\
      --friction 0 --duration 60 --runs 200 --overdamped
  tilebind dock my.toml --runs 1000 --fan 0.6,0.6,1e-3,0.2 --drag 0.5 --shaking 1e-5")]
pub struct Dock {
    /// The design file
    design: PathBuf,

    #[command(flatten)]
    request: Asked<Request>,

    #[command(flatten)]
    release: Asked<ReleaseOptions>,

    /// Trajectory to write to trajectory.csv and show first [default: the first that binds]
    #[arg(long, value_name = "N", conflicts_with = "from_bond")]
    trajectory: Option<usize>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl Dock {
    pub fn run(self) -> Result<(), Failure> {
        let design = input::load(&self.design)?;
        let problem = design.problem();
        let inputs = input::files_of(&self.design, &design);
        let output = self.results.output(&report::FILES, inputs)?;
        self.request.check_memory().map_err(Failure::Usage)?;
        self.threads.use_threads()?;
        if self.release.overdamped {
            check_memory(self.threads.count()).map_err(Failure::of)?;
        }
        let settings = self.request.settings(&design.pair);
        if let Some(index) = self.trajectory.filter(|index| *index >= settings.runs) {
            return Err(Failure::Usage(format!(
                "--trajectory {index}: the {} trajectories are numbered from 0; ask for more --runs",
                settings.runs
            )));
        }
        let expected = expected(&problem, &settings).map_err(Failure::of)?;
        workload::tell_expected(expected, self.threads.count());
        let progress = self.results.progress();
        if self.release.from_bond {
            let beside = self.release.overdamped;
            let beside = beside.then(|| loosening(&design, &settings, &progress));
            let beside = beside
                .transpose()
                .map_err(|error| match Failure::of(error) {
                    // The options that set kT here.
                    Failure::Usage(message) => Failure::Usage(message.replace("--kt", "--shaking")),
                    other => other,
                })?;
            let found = released(&problem, &settings, &progress).map_err(Failure::of)?;
            let document = release::document(&design, &settings, &found, beside);
            return self.results.deliver(&document, output, &progress);
        }
        let docking = docked(&problem, &settings, &progress).map_err(Failure::of)?;
        let paths = output.as_ref();
        let paths = paths.map(|_| Paths::new(&problem, &docking, self.trajectory));
        let paths = paths.transpose().map_err(Failure::of)?;
        let document = report::document((&design, &problem), &docking, paths.as_ref());
        self.results.deliver(&document, output, &progress)
    }
}
