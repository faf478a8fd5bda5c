//! `tilebind sweep`: many variants of a design.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;
use tilebind::output::{Output, OutputError};
use tilebind::report::files::REPORT;
use tilebind::report::json;
use tilebind::report::sweep::{FILES, FinishedSweep, counts};
use tilebind::request;
use tilebind::search::{Request as Aims, Search, SearchError};
use tilebind::sweep::{
    self, Axis, DesignSource, Plan, Progress as Counts, Request, Shard, Store, SweepPoint,
};

use super::failure::tell_refuted;
use super::figures::FigureOptions;
use super::options::{ForceOption, PrintOptions, ThreadOption};
use super::results::describe_of;
use super::search::Searching;
use super::sweep_progress::PointBar;
use super::{Asked, Failure, input, interrupt, print, tell, workload};

/// The default manifest file.
const PLAN: &str = "plan.json";

/// The command that gives the same results, however the work was divided.
const AGAIN: &str = "tilebind sweep --run plan.json; tilebind sweep --merge plan.json";

/// Options of a sweep, and of the manifest of a search that has been planned.
const NOT_IN_A_SEARCH: [&str; 5] = ["refine", "baseline", "run", "merge", "status"];

const THREADS: &str = "\
Points computed at the same time; results do not depend on it [default: all cores]";

/// Vary keys of a design and analyse every resulting design
#[derive(Args)]
#[command(
    mut_arg("refine", |refine| refine.conflicts_with_all(["plan", "run", "merge", "status"])),
    mut_arg("baseline", |baseline| baseline.conflicts_with_all(["run", "merge", "status"])),
    mut_arg("maximise", |one| one.conflicts_with_all(NOT_IN_A_SEARCH)),
    mut_arg("minimise", |one| one.conflicts_with_all(NOT_IN_A_SEARCH)),
    mut_arg("subject", |one| one.conflicts_with_all(NOT_IN_A_SEARCH)),
    mut_arg("points", |one| one.conflicts_with_all(NOT_IN_A_SEARCH)),
    mut_arg("seed", |seed| seed.help("Random seed of every point, so that all have the same far starts")),
    mut_arg("threads", |threads| threads.help(THREADS)),
    after_help = "\
The command writes report.html, report.json, sweep.csv and pictures: curves for one varied number,
maps for two. Each point's results are saved in DIR/points. If a sweep is interrupted, rerun the
command to resume; the results are identical.

Examples:
  tilebind sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0:0.05:11 \\
      --out target/tab
  tilebind sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0.01,0.02 \\
      --vary fixed.faces.east.profile.width=0.1:0.3:5 --out target/tabs
  tilebind sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0:0.04:5 \\
      --baseline depth=0 --refine 6 --out target/depth

With --maximise or --minimise it searches for the best design, with certified bounds, and writes it
as best.toml. KEY=a:b is then any number from a to b. Figures are those of compare --by. Two
objectives give their front:
  tilebind sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0:0.05 \\
      --vary fixed.faces.east.profile.width=0.1:0.3 --maximise selectivity \\
      --subject 'captured > 0.5' --subject 'bond_depth > 20 mJ' --points 40 --out target/best

In parts, on one or several machines:
  tilebind sweep shapes/tab-20mm.toml --vary magnet.pitch=0.02:0.06:9 --plan target/pitch/plan.json
  tilebind sweep --run target/pitch/plan.json --shard 1/4 --threads 1     # and 2/4, 3/4, 4/4
  tilebind sweep --status target/pitch/plan.json
  tilebind sweep --merge target/pitch/plan.json
The parts of a search wait for each other: rerun them until the search is finished."
)]
pub struct Sweep {
    /// Design files, usually one
    #[arg(required_unless_present_any = ["run", "merge", "status"])]
    designs: Vec<PathBuf>,

    /// Key of the design (dotted path) and its values; repeat for a grid
    ///
    /// KEY=a:b:n for n values from a to b, or KEY=v,w,... for a list. For a search also KEY=a:b, any
    /// number from a to b.
    #[arg(long, value_name = "KEY=VALUES")]
    vary: Vec<Axis>,

    /// Folder for the results, created if missing [default with a manifest: its folder]
    #[arg(long, short, value_name = "DIR",
          required_unless_present_any = ["plan", "run", "merge", "status"])]
    out: Option<PathBuf>,

    #[command(flatten)]
    force: ForceOption,

    #[command(flatten)]
    request: Asked<Request>,

    #[command(flatten)]
    aim: Asked<Aims>,

    /// Only write the manifest [default: plan.json in the folder of --out]
    #[arg(long, value_name = "PLAN", num_args = 0..=1, conflicts_with_all = ["run", "merge", "status"])]
    plan: Option<Option<PathBuf>>,

    /// Compute the points of a manifest that have no results yet
    #[arg(long, value_name = "PLAN",
          conflicts_with_all = ["designs", "vary", "merge", "status"])]
    run: Option<PathBuf>,

    /// Compute only part i of n (every nth point), from 1/n to n/n
    #[arg(long, value_name = "i/n", requires = "run", value_parser = request::shard)]
    shard: Option<Shard>,

    /// Write the tables and pictures of a finished sweep
    #[arg(long, value_name = "PLAN", conflicts_with_all = ["designs", "vary", "status"])]
    merge: Option<PathBuf>,

    /// Print the progress of a sweep
    #[arg(long, value_name = "PLAN", conflicts_with_all = ["designs", "vary"])]
    status: Option<PathBuf>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    figures: FigureOptions,

    #[command(flatten)]
    print: PrintOptions,
}

impl Sweep {
    pub fn run(self) -> Result<(), Failure> {
        // Checked before any work.
        self.figures.sheet()?;
        if let Some(file) = &self.status {
            let (manifest, folder) = self.read(file)?;
            return match manifest {
                Manifest::Sweep(plan) => self.status(&plan, &folder),
                Manifest::Search(search) => self.searching(&search, &folder).status(),
            };
        }
        if let Some(file) = &self.merge {
            let (manifest, folder) = self.read(file)?;
            let output = self.output(manifest.plan(), &folder, Some(file))?;
            interrupt::is_resumable();
            return match manifest {
                Manifest::Sweep(plan) => self.merge(&plan, &folder, &output),
                Manifest::Search(search) => {
                    self.searching(&search, &folder)
                        .merge(&output, &self.figures, PLAN)
                }
            };
        }
        if let Some(file) = &self.run {
            let (manifest, folder) = self.read(file)?;
            Store::new(&folder).check()?;
            interrupt::is_resumable();
            workload::tell_memory(manifest.plan().check_memory(self.threads.count()))?;
            let shard = self.shard.unwrap_or(Shard::WHOLE);
            return match manifest {
                Manifest::Sweep(plan) => self.work(&plan, &folder, shard),
                Manifest::Search(search) => self.searching(&search, &folder).part(shard),
            };
        }
        let mut designs = Vec::new();
        for file in &self.designs {
            let (source, design) = DesignSource::read(file)?;
            input::tell_doubts(&design);
            designs.push((source, design));
        }
        let aim = self.aim.aim().map_err(Failure::Usage)?;
        if let Some(aim) = aim {
            let search = Search::asked(&self.request.assessments, designs, self.vary.clone(), aim);
            return self.search(&search.map_err(Failure::usage)?);
        }
        let plan = self.request.plan(designs, self.vary.clone());
        let plan = plan.map_err(Failure::usage)?;
        let file = self.plan_file()?;
        let manifest = self.force.file(&FILES, &file, inputs(&plan, None))?;
        interrupt::is_resumable();
        if self.plan.is_some() {
            interrupt::without(|| manifest.write_file(plan.to_text()))?;
            if self.print.quiet {
                return Ok(());
            }
            let count = plan.count();
            return print(&format!("{count} points planned in {}\n", file.display()));
        }
        let folder = folder_of(&file);
        let output = self.output(&plan, &folder, None)?;
        workload::tell_memory(plan.check_memory(self.threads.count()))?;
        begin(plan.to_text(), &manifest, &folder)?;
        self.work(&plan, &folder, Shard::WHOLE)?;
        let store = Store::new(&folder);
        let known = |plan: &Plan| {
            plan.points()
                .iter()
                .map(|point| store.load(point))
                .collect()
        };
        let (plan, left) = self.request.refined(plan, known, |plan| {
            begin(plan.to_text(), &manifest, &folder)?;
            self.work(plan, &folder, Shard::WHOLE)
        })?;
        if let (1.., Some(asked), false) = (left, self.request.refine, self.print.quiet) {
            tell(format!(
                "{} of {asked} points added: the curves bend by less than a twentieth elsewhere",
                asked - left
            ));
        }
        self.merge(&plan, &folder, &output)
    }

    fn searching<'a>(&'a self, search: &'a Search, folder: &'a Path) -> Searching<'a> {
        Searching {
            search,
            folder,
            threads: self.threads.count(),
            print: &self.print,
        }
    }

    /// Plans a search, or makes it.
    fn search(&self, search: &Search) -> Result<(), Failure> {
        let file = self.plan_file()?;
        let folder = folder_of(&file);
        let searching = self.searching(search, &folder);
        searching.check()?;
        let manifest = self.force.file(&FILES, &file, inputs(&search.plan, None))?;
        interrupt::is_resumable();
        if self.plan.is_some() {
            interrupt::without(|| manifest.write_file(search.to_text()))?;
            return match self.print.quiet {
                true => Ok(()),
                false => print(&format!("search planned in {}\n", file.display())),
            };
        }
        let output = self.output(&search.plan, &folder, None)?;
        workload::tell_memory(search.plan.check_memory(self.threads.count()))?;
        begin(search.to_text(), &manifest, &folder)?;
        match searching.work(Shard::WHOLE)? {
            Err(SearchError::NonePossible(error)) => Err(Failure::usage(error)),
            _ => searching.merge(&output, &self.figures, PLAN),
        }
    }

    /// The destination of tables and pictures; an error if files are in the way.
    fn output(
        &self,
        plan: &Plan,
        folder: &Path,
        manifest: Option<&Path>,
    ) -> Result<Output, Failure> {
        let output = Output::folder(&FILES, folder).reading(inputs(plan, manifest));
        let output = output.forced(self.force.force);
        // A manifest that is read is not changed.
        output.check(|name| name != PLAN || !output.reads(name))?;
        Store::new(folder).check()?;
        Ok(output)
    }

    /// The destination of the manifest.
    fn plan_file(&self) -> Result<PathBuf, Failure> {
        match (&self.plan, &self.out) {
            (Some(Some(file)), _) => Ok(file.clone()),
            (_, Some(folder)) => Ok(folder.join(PLAN)),
            (_, None) => Err(Failure::Usage(
                "give the manifest's place: --plan DIR/plan.json, or --out DIR".to_owned(),
            )),
        }
    }

    /// A manifest, and the folder of its results.
    fn read(&self, file: &Path) -> Result<(Manifest, PathBuf), Failure> {
        let file = if file.is_dir() {
            file.join(PLAN)
        } else {
            file.to_owned()
        };
        let named = |message: String| Failure::Usage(format!("{}: {message}", file.display()));
        let text = tilebind::text::read(&file)
            .map_err(|error| named(format!("cannot read the manifest: {error}")))?;
        let manifest = match Search::parse(&text) {
            Ok(Some(search)) => Ok(Manifest::Search(search)),
            Ok(None) => Plan::parse(&text).map(Manifest::Sweep),
            Err(error) => Err(error),
        };
        let manifest = manifest.map_err(|error| named(error.to_string()))?;
        let folder = self.out.clone().unwrap_or_else(|| folder_of(&file));
        Ok((manifest, folder))
    }

    fn work(&self, plan: &Plan, folder: &Path, shard: Shard) -> Result<(), Failure> {
        let store = Store::new(folder);
        let mine = plan
            .points()
            .into_iter()
            .filter(|p| shard.contains(p.index));
        let (known, missing): (Vec<SweepPoint>, Vec<SweepPoint>) =
            mine.partition(|point| store.load(point).is_some());
        let bar = PointBar::new(known.len(), missing.len(), self.print.quiet);
        sweep::run(plan, &missing, self.threads.count(), |point, outcome| {
            interrupt::without(|| store.save(point, outcome))?;
            bar.finished_one();
            Ok(())
        })
        .map_err(|error: OutputError| Failure::from(error))?;
        bar.finish();
        if self.run.is_some() && !self.print.quiet {
            let (number, of) = (shard.number, shard.of);
            let count = known.len() + missing.len();
            print(&format!(
                "part {number}/{of}: all {count} points have results\n"
            ))?;
        }
        Ok(())
    }

    fn status(&self, plan: &Plan, folder: &Path) -> Result<(), Failure> {
        let store = Store::new(folder);
        let progress = Counts::of(plan, &store);
        if self.print.json {
            return print(&json::text(&json!(progress)));
        }
        print(&format!("{}\n", counts(&progress)))
    }

    fn merge(&self, plan: &Plan, folder: &Path, output: &Output) -> Result<(), Failure> {
        let store = Store::new(folder);
        let report = FinishedSweep::read(plan, &store).map_err(|progress| {
            Failure::Run(format!(
                "the sweep is not finished, {}: rerun its parts to resume",
                counts(&progress)
            ))
        })?;
        let document = report.document();
        let (mut files, drawn) = document.files(&self.figures.sheet()?, AGAIN);
        if !output.reads(PLAN) {
            files.insert(PLAN.to_owned(), plan.to_text().into_bytes());
        }
        interrupt::without(|| output.write(&files))?;
        self.print
            .results(&document.report(), || describe_of(&document, folder))?;
        drawn?;
        match report.progress().failed {
            0 => {
                let point = |index| Some((format!("point {index}"), report.assessment(index)?));
                let points = (0..report.outcomes.len()).filter_map(point);
                tell_refuted(&points.collect::<Vec<_>>())
            }
            failed => Err(Failure::Run(format!(
                "{failed} points failed because of a bug in tilebind; sweep.csv lists them with \
                 the reason"
            ))),
        }
    }
}

/// The two kinds of manifest.
enum Manifest {
    Sweep(Plan),
    Search(Search),
}

impl Manifest {
    fn plan(&self) -> &Plan {
        match self {
            Self::Sweep(plan) => plan,
            Self::Search(search) => &search.plan,
        }
    }
}

/// The input files of a sweep.
fn inputs(plan: &Plan, manifest: Option<&Path>) -> Vec<PathBuf> {
    let designs = plan.designs.iter().flat_map(DesignSource::files);
    let manifest = manifest.map(|file| match file.is_dir() {
        true => file.join(PLAN),
        false => file.to_owned(),
    });
    designs.chain(manifest).collect()
}

/// Writes the manifest of a new sweep. The manifest of existing results stays with them until they
/// are replaced.
fn begin(plan: String, manifest: &Output, folder: &Path) -> Result<(), Failure> {
    if folder.join(REPORT).exists() {
        return Ok(());
    }
    Ok(interrupt::without(|| manifest.write_file(plan))?)
}

fn folder_of(file: &Path) -> PathBuf {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}
