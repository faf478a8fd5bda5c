//! `tilebind dock`.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Args;
use tilebind::Problem;
use tilebind::design::Design;
use tilebind::docking::Paths;
use tilebind::dynamics::docking::{self, DockingError, DockingSettings};
use tilebind::dynamics::{Fan, MotionSettings};
use tilebind::kinetics::rates::Loosening;
use tilebind::observer::Observer;
use tilebind::rates::diffusion;
use tilebind::report::files::DOCK;
use tilebind::report::{docking as report, release};
use tilebind::request;

use super::docking_starts::StartOptions;
use super::options::WorkOptions;
use super::results::ResultOptions;
use super::{Failure, input, interrupt};

const SEED: &str =
    "Seed of all random numbers; a trajectory depends on it and on its own number only";

/// Send the moving tile towards the fixed one many times and count how it ends
#[derive(Args)]
#[command(
    mut_arg("seed", |seed| seed.help(SEED)),
    after_help = "\
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
  tilebind dock my.toml --runs 1000 --fan 0.6,0.6,1e-3,0.2 --drag 0.5 --shaking 1e-5"
)]
pub struct Dock {
    /// The design file
    design: PathBuf,

    /// Trajectories
    #[arg(long, value_name = "N", default_value_t = DockingSettings::default().runs,
          value_parser = request::runs)]
    runs: usize,

    /// How long each trajectory lasts (s)
    #[arg(long, value_name = "S", default_value_t = DockingSettings::default().duration,
          value_parser = request::positive)]
    duration: f64,

    /// Drag rate (1/s)
    #[arg(long, value_name = "C", default_value_t = MotionSettings::default().drag,
          value_parser = request::not_negative)]
    drag: f64,

    /// Coefficient of friction between the tiles and of a tile and the rim
    #[arg(long, value_name = "MU", default_value_t = MotionSettings::default().friction,
          value_parser = request::not_negative)]
    friction: f64,

    /// Share of the approach velocity that a knock gives back
    #[arg(long, value_name = "E", default_value_t = MotionSettings::default().restitution,
          value_parser = request::share)]
    restitution: f64,

    /// Magnets of the target faces are matched within this distance (m) [default: 1.5 lengths of
    /// a magnet]
    #[arg(long, value_name = "M", value_parser = request::positive)]
    threshold: Option<f64>,

    #[command(flatten)]
    starts: StartOptions,

    /// Start bound instead, with a thermal velocity, and find the rate of detachment; the options of
    /// starts do not matter
    #[arg(long, requires = "shaking", conflicts_with = "trajectory")]
    from_bond: bool,

    /// With --from-bond: tell the rate of overdamped motion at the same kT and drag beside it, solved
    /// on a mesh as `tilebind rates` does
    #[arg(long, requires = "from_bond")]
    overdamped: bool,

    /// Lets tiles leave the table
    #[arg(long)]
    no_walls: bool,

    /// A fan at X,Y (m) that pushes the tile's centre away with the energy E_J over the width S (m);
    /// the energy may swing by the share A at the frequency F (Hz)
    #[arg(long, value_name = "X,Y,E_J,S[,A,F]", allow_hyphen_values = true, value_parser = fan)]
    fan: Vec<Fan>,

    /// Effective energy kT (J) of a random shaking force
    #[arg(long, value_name = "E_J", value_parser = request::not_negative)]
    shaking: Option<f64>,

    /// Number of the trajectory that is written to trajectory.csv and that the page plays first
    /// [default: the first bound one]
    #[arg(long, value_name = "N")]
    trajectory: Option<usize>,

    #[command(flatten)]
    work: WorkOptions,

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
        self.work.use_threads()?;
        let settings = self.settings();
        if let Some(index) = self.trajectory.filter(|index| *index >= self.runs) {
            return Err(Failure::Usage(format!(
                "--trajectory {index}: the {} trajectories are numbered from 0; ask for more --runs",
                self.runs
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
        let Some(kt) = self.shaking.filter(|_| self.overdamped) else {
            return Ok(None);
        };
        progress.stage("rates", 0.0);
        let diffusion = diffusion(design, kt, self.drag);
        let found = Loosening::new(problem, &design.pair.bound, kt);
        let found = found.map_err(|error| match Failure::from(error) {
            // What sets kT here.
            Failure::Usage(message) => Failure::Usage(message.replace("--kt", "--shaking")),
            other => other,
        })?;
        Ok(Some(found.times(diffusion)))
    }

    fn settings(&self) -> DockingSettings {
        let usual = DockingSettings::default();
        DockingSettings {
            runs: self.runs,
            seed: self.work.seed,
            duration: self.duration,
            starts: self.starts.starts(usual.starts),
            motion: MotionSettings {
                drag: self.drag,
                friction: self.friction,
                restitution: self.restitution,
                walls: !self.no_walls,
                fans: self.fan.clone(),
                shaking: self.shaking,
                ..usual.motion
            },
            threshold: self.threshold,
        }
    }
}

fn usage(error: DockingError) -> Failure {
    Failure::Usage(error.to_string())
}

/// A fan as `X,Y,E_J,S` or `X,Y,E_J,S,A,F`.
fn fan(text: &str) -> Result<Fan, String> {
    const FORM: &str = "a fan is X,Y,E_J,S in m, m, J and m, S above 0, such as \
                        0.6,0.6,1e-3,0.2, and perhaps ,A,F: the share by which it swings, and how \
                        often a second";
    match request::numbers(text).ok_or(FORM)?[..] {
        [x, y, energy, width] if width > 0.0 => Ok(Fan::steady([x, y], energy, width)),
        [x, y, energy, width, amplitude, frequency] if width > 0.0 => Ok(Fan {
            amplitude,
            frequency,
            ..Fan::steady([x, y], energy, width)
        }),
        _ => Err(FORM.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fans() {
        let steady = Fan::steady([0.6, -0.5], 1e-3, 0.2);
        assert_eq!(fan("0.6,-0.5, 1e-3,0.2"), Ok(steady));
        let swinging = Fan {
            amplitude: 0.5,
            frequency: 2.0,
            ..steady
        };
        assert_eq!(fan("0.6,-0.5,1e-3,0.2,0.5,2"), Ok(swinging));
        for wrong in ["", "1,2,3", "0,0,1,0", "0,0,1,-1", "0,0,1,1,1", "0,0,NaN,1"] {
            assert!(fan(wrong).is_err(), "{wrong}");
        }
    }
}
