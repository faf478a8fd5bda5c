//! `tilebind analyse`: the analysis of one design.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use tilebind::dynamics::check::BarrierCheck;
use tilebind::observer::Observer;
use tilebind::output::Output;
use tilebind::pipeline::{self, Analysis, Request};
use tilebind::report::analysis::{self, Extent, FILES, document, files};
use tilebind::report::plots::Scene;

use super::failure::fail_if_contradicted;
use super::figures::{FigureOptions, command_line};
use super::options::{DesignOptions, ForceOption, PrintOptions, ThreadOption};
use super::{Asked, Failure, interrupt, style, workload};

/// Find and draw the states, traps, barriers and pathways of a design
#[derive(Args)]
#[command(
    mut_arg("json", |json| json.help("Print report.json instead of the summary")),
    after_help = "\
Examples:
  tilebind analyse shapes/paper-tile.toml --out target/paper-tile
  tilebind analyse my.toml --out my-results --milestones 20000 --repeats 5
  tilebind analyse my.toml --out my-results --quick
  tilebind analyse my.toml --out my-results --dynamics
  tilebind analyse my.toml --out my-results --figure-width 85mm --figure-font 8
  tilebind analyse my.toml --out my-results --json | jq '.states[0].capture'"
)]
pub struct Analyse {
    #[command(flatten)]
    design: DesignOptions,

    /// Folder for the results, created if missing
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,

    #[command(flatten)]
    force: ForceOption,

    #[command(flatten)]
    request: Asked<Request>,

    #[command(flatten)]
    threads: ThreadOption,

    /// Omit PNG pictures and the pathways of symmetric copies, to save space
    #[arg(long)]
    compact: bool,

    /// Omit all pictures, the page and the pathways of symmetric copies, to save time
    #[arg(long, conflicts_with = "compact")]
    no_pictures: bool,

    #[command(flatten)]
    figures: FigureOptions,

    #[command(flatten)]
    print: PrintOptions,
}

impl Analyse {
    pub fn run(self) -> Result<(), Failure> {
        let start = Instant::now();
        let design = self.design.load()?;
        let sheet = self.figures.sheet()?;
        let extent = match (self.compact, self.no_pictures) {
            (_, true) => Extent::Numbers,
            (true, _) => Extent::Compact,
            _ => Extent::Full,
        };
        let inputs = self.design.inputs(&design);
        let output = Output::folder(&FILES, &self.out).reading(inputs);
        let output = output.forced(self.force.force);
        output.check(|name| extent.may_hold(name))?;
        let request = self.request.of([&design]);
        workload::tell_memory(request.check_memory())?;
        self.threads.use_threads()?;
        workload::tell_of(&design, &request);
        workload::tell_time(&design, &request, self.threads.count());

        let progress = self.print.progress();
        let show = |first: &Analysis| {
            progress.print(&analysis::unproved(&design, first).text(style::columns()));
        };
        let is_shown = progress.is_shown() && request.has_proofs();
        let show: Option<&dyn Fn(&Analysis)> = if is_shown { Some(&show) } else { None };
        let problem = design.problem();
        let analysis = pipeline::analyse_showing(&design, problem, &request, &progress, show);
        progress.stage("pictures", 0.95);
        let scene = Scene::new(&design, &analysis.problem, &analysis.catalogue);
        let wall = start.elapsed().as_secs_f64();
        let document = document(&design, &analysis, &scene, extent, wall);
        let (files, drawn) = files(&document, extent, &sheet, &command_line());
        interrupt::without(|| output.write(&files))?;
        progress.finish();
        self.print.results(&document.report(), || {
            let told = document.text(style::columns());
            let files = match extent {
                Extent::Full => "open report.html; also report.json, tables, pathways/, pictures/",
                Extent::Compact => "report.json, tables, pathways/, pictures/",
                Extent::Numbers => "report.json, tables, pathways/",
            };
            format!("{told}results in {}: {files}\n", self.out.display())
        })?;
        drawn?;
        fail_if_contradicted(analysis.contradicted().map(BarrierCheck::describe))
    }
}
