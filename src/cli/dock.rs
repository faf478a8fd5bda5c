//! `tilebind dock`.

use std::path::PathBuf;

use clap::Args;
use tilebind::Problem;
use tilebind::design::Design;
use tilebind::dynamics::docking::{
    self, Docking, DockingError, DockingMap, DockingRun, DockingSettings, End,
};
use tilebind::dynamics::{Fan, MotionSettings, Snapshot};
use tilebind::kinetics::rates::Loosening;
use tilebind::observer::Observer;
use tilebind::report::files::{DOCK, Files, PICTURES, with_page};
use tilebind::report::page::{Illustration, Page};
use tilebind::report::plots::{Figure, PictureError, Sheet, dock, paths};
use tilebind::report::rates::Motion;
use tilebind::report::{docking as report, release};

use super::docking_starts::StartOptions;
use super::figures::{FigureOptions, command_line};
use super::options::{ForceOption, PrintOptions, WorkOptions};
use super::{Failure, input, interrupt};

const SEED: &str =
    "Seed of all random numbers; a trajectory depends on it and on its own number only";

/// Send the moving tile towards the fixed one many times and count how it ends
#[derive(Args)]
#[command(
    mut_arg("seed", |seed| seed.help(SEED)),
    mut_arg("json", |json| json.help("Print dock.json instead of the summary")),
    after_help = "\
Starts are drawn uniformly: distance, direction about the target face, orientation about the bound
one, speed, and the velocity's direction about that to the fixed tile. Without --engine the table
has its rim and the drag is 0.005 per second. On the paper's tile a trajectory takes some 4 ms of
a core.

Examples:
  tilebind dock shapes/paper-tile.toml --runs 2000 --engine
  tilebind dock shapes/paper-tile.toml --runs 2000 --engine --restitution 0.1
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
          value_parser = input::runs)]
    runs: usize,

    /// Folder for report.html, dock.json, runs.csv, map.csv, trajectory.csv and pictures/
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,

    #[command(flatten)]
    force: ForceOption,

    /// How long each trajectory lasts (s)
    #[arg(long, value_name = "S", default_value_t = DockingSettings::default().duration,
          value_parser = input::positive)]
    duration: f64,

    /// The experiment made with the Open Dynamics Engine too: drag 0.5 per second, no rim
    #[arg(long, conflicts_with_all = ["drag", "no_walls", "fan", "shaking", "duration"])]
    engine: bool,

    /// Drag rate (1/s)
    #[arg(long, value_name = "C", default_value_t = MotionSettings::default().drag,
          value_parser = input::not_negative)]
    drag: f64,

    /// Coefficient of friction between the tiles and of a tile and the rim
    #[arg(long, value_name = "MU", default_value_t = MotionSettings::default().friction,
          value_parser = input::not_negative)]
    friction: f64,

    /// Share of the approach velocity that a knock gives back
    #[arg(long, value_name = "E", default_value_t = MotionSettings::default().restitution,
          value_parser = input::share)]
    restitution: f64,

    /// Magnets of the target faces are matched within this distance (m) [default: 1.5 lengths of
    /// a magnet]
    #[arg(long, value_name = "M", value_parser = input::positive)]
    threshold: Option<f64>,

    #[command(flatten)]
    starts: StartOptions,

    /// Start bound instead, with a thermal velocity, and find the rate of detachment; the options of
    /// starts do not matter
    #[arg(long, requires = "shaking", conflicts_with_all = ["engine", "out", "trajectory"])]
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
    #[arg(long, value_name = "E_J", value_parser = input::not_negative)]
    shaking: Option<f64>,

    /// Number of the trajectory that is written to trajectory.csv and that the page plays first
    /// [default: the first bound one]
    #[arg(long, value_name = "N")]
    trajectory: Option<usize>,

    #[command(flatten)]
    work: WorkOptions,

    #[command(flatten)]
    figures: FigureOptions,

    #[command(flatten)]
    print: PrintOptions,
}

/// Cells of the map along the orientation and the speed.
const CELLS: [usize; 2] = [12, 13];
/// Trajectories on the picture.
const DRAWN: usize = 60;
/// Time between two points of a trajectory that is drawn or written (s).
const INTERVAL: f64 = 0.02;

impl Dock {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        let design = input::load(&self.design)?;
        let problem = design.problem();
        let output = self.out.as_ref().map(|folder| {
            let inputs = input::files_of(&self.design, &design);
            self.force.folder(&DOCK, folder, inputs)
        });
        let output = output.transpose()?;
        let sheet = self.figures.sheet()?;
        self.work.use_threads()?;
        let settings = self.settings();
        if let Some(index) = self.trajectory.filter(|index| *index >= self.runs) {
            return Err(Failure::Usage(format!(
                "--trajectory {index}: the {} trajectories are numbered from 0; ask for more --runs",
                self.runs
            )));
        }
        let progress = self.print.progress();
        let done = std::sync::atomic::AtomicUsize::new(0);
        let step = || {
            let done = 1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            progress.share("trajectories", done as f64 / settings.runs as f64);
        };
        if self.from_bond {
            let beside = self.overdamped(&design, &problem, &progress)?;
            let found = docking::releases(&problem, &settings, &step).map_err(usage)?;
            progress.finish();
            let json = release::json(&design, &settings, &found, beside);
            return self.print.results(&json, || {
                release::summary(&design, &settings, &found, beside)
            });
        }
        let docking = docking::dock(&problem, &settings, &step).map_err(usage)?;
        let map = DockingMap::new(&docking, CELLS);
        let json = report::json(&design, &docking, &map);
        if let Some(output) = output {
            let mut files = Files::from([
                ("dock.json".to_owned(), json.clone().into_bytes()),
                (
                    "runs.csv".to_owned(),
                    report::runs_csv(&docking).into_bytes(),
                ),
                ("map.csv".to_owned(), report::map_csv(&map).into_bytes()),
            ]);
            let trace = |run: &DockingRun| {
                let snapshots = docking::trajectory(&problem, &settings, run.index, INTERVAL);
                Ok((*run, snapshots.map_err(usage)?))
            };
            let played = self.played(&docking);
            let played = played.iter().map(trace);
            let played: Vec<_> = played.collect::<Result<_, Failure>>()?;
            let picked = &played[0].1;
            files.insert(
                "trajectory.csv".to_owned(),
                report::trajectory_csv(picked).into_bytes(),
            );
            let drawn: Vec<(End, Vec<Snapshot>)> = docking
                .runs
                .iter()
                .take(DRAWN)
                .map(|run| Ok((run.end, trace(run)?.1)))
                .collect::<Result<_, Failure>>()?;
            let coarse = DockingMap::new(&docking, dock::cells(docking.runs.len()));
            let figures = |sheet: &Sheet| -> Result<_, PictureError> {
                let chances = dock::chances(&design, &coarse, sheet)?;
                Ok([chances, paths::trajectories(&design, &drawn, sheet)?])
            };
            let titles = ["Chance of a match", "Paths"].into_iter();
            let shown = titles
                .zip(&figures(&Sheet::SCREEN)?)
                .map(illustration)
                .collect();
            let page = Page::of_docking(&design, &problem, &docking, &played, shown);
            let named = |(name, bytes)| (format!("{}/{name}", PICTURES), bytes);
            files.extend(
                figures(&sheet)?
                    .into_iter()
                    .flat_map(Figure::files)
                    .map(named),
            );
            let files = with_page(files, Some(page), &command_line());
            interrupt::without(|| output.write(&files))?;
        }
        progress.finish();
        let summary = || {
            let told = report::summary(&design, &problem, &docking, &map);
            match &self.out {
                Some(folder) => format!(
                    "{told}results in {}: report.html to look at; dock.json, tables, pictures\n",
                    folder.display()
                ),
                None => format!("{told}nothing was written: --out DIR keeps page and tables\n"),
            }
        };
        self.print.results(&json, summary)
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
        let diffusion = Motion::new(design, kt, self.drag).diffusion;
        let found = Loosening::new(problem, &design.pair.bound, kt);
        let found = found.map_err(|error| match Failure::from(error) {
            // What sets kT here.
            Failure::Usage(message) => Failure::Usage(message.replace("--kt", "--shaking")),
            other => other,
        })?;
        Ok(Some(found.times(diffusion)))
    }

    fn settings(&self) -> DockingSettings {
        let mut settings = if self.engine {
            DockingSettings::engine_comparison()
        } else {
            DockingSettings::default()
        };
        if !self.engine {
            settings.motion.drag = self.drag;
            settings.motion.walls = !self.no_walls;
            settings.motion.fans.clone_from(&self.fan);
            settings.motion.shaking = self.shaking;
            settings.duration = self.duration;
        }
        settings.motion.friction = self.friction;
        settings.motion.restitution = self.restitution;
        settings.starts = self.starts.starts(settings.starts);
        settings.threshold = self.threshold;
        settings.runs = self.runs;
        settings.seed = self.work.seed;
        settings
    }

    /// The trajectory that was asked for, or else the first bound one, and a few of each end.
    fn played(&self, docking: &Docking) -> Vec<DockingRun> {
        let runs = &docking.runs;
        let asked = self.trajectory.and_then(|index| runs.get(index));
        let mut chosen: Vec<DockingRun> = asked.copied().into_iter().collect();
        let mut take = |count: usize, is: &dyn Fn(&DockingRun) -> bool| {
            let fitting = runs.iter().filter(|run| is(run)).take(count);
            let new: Vec<_> = fitting
                .filter(|run| !chosen.contains(run))
                .copied()
                .collect();
            chosen.extend(new);
        };
        take(4, &DockingRun::is_bound);
        for trap in 0..4 {
            take(1, &|run| run.end == End::Trapped { trap: Some(trap) });
        }
        take(2, &|run| run.end == End::Free);
        if chosen.is_empty() {
            chosen.extend(runs.first());
        }
        chosen
    }
}

fn illustration((title, figure): (&str, &Figure)) -> Illustration {
    Illustration {
        is_titled: false,
        title: title.to_owned(),
        svg: figure.svg().to_owned(),
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
    match input::numbers(text).ok_or(FORM)?[..] {
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
