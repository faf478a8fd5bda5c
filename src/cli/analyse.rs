//! `tilebind analyse`: the main job.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use tilebind::dynamics::check::BarrierCheck;
use tilebind::landscape::CompletenessSettings;
use tilebind::observer::Observer;
use tilebind::output::Output;
use tilebind::pipeline;
use tilebind::report::analysis::{Extent, document, files};
use tilebind::report::files::ANALYSE;
use tilebind::report::plots::Scene;
use tilebind::request;
use tilebind::{Design, Settings};

use super::failure::fail_if_contradicted;
use super::figures::{FigureOptions, command_line};
use super::options::{
    CertifyOptions, DesignOptions, ForceOption, PrintOptions, SurveyOptions, WorkOptions,
};
use super::{Failure, interrupt, memory, style, workload};

const DYNAMICS: &str = "\
Check every barrier by moving tiles, with RUNS trajectories below each [default: 1000]; \
1000 take about a second of a core for each barrier (the paper's tile has 23), for curved \
shapes up to five";

/// Find the states, traps, barriers and pathways of a design, and draw them
#[derive(Args)]
#[command(
    mut_arg("dynamics", |dynamics| dynamics.help(DYNAMICS)),
    mut_arg("json", |json| json.help("Print report.json instead of the summary")),
    after_help = "\
Where moving tiles contradict a barrier (--dynamics), all results are written, the contradiction is
told and the exit status is 1.

Examples:
  tilebind analyse shapes/paper-tile.toml --out target/paper-tile
  tilebind analyse my.toml --out my-results --milestones 20000 --repeats 5
  tilebind analyse my.toml --out my-results --dynamics
  tilebind analyse my.toml --out my-results --figure-width 85mm --figure-font 8
  tilebind analyse my.toml --out my-results --json | jq '.states[0].capture'"
)]
pub struct Analyse {
    #[command(flatten)]
    design: DesignOptions,

    /// Folder for the results; made if need be
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,

    #[command(flatten)]
    force: ForceOption,

    #[command(flatten)]
    survey: SurveyOptions,

    /// Runs, each with the next seed; every barrier's spread over them is reported
    #[arg(long, value_name = "R", default_value_t = Settings::default().repeats,
          value_parser = request::count)]
    repeats: usize,

    /// Accept milestones by Boltzmann's rule at this energy (J), not by the linear rule
    #[arg(long, value_name = "E_J", value_parser = request::positive)]
    boltzmann: Option<f64>,

    /// Thermal energy (J) of the transition probabilities [default: a hundredth of the bond]
    #[arg(long, value_name = "E_J", value_parser = request::positive)]
    thermal_energy: Option<f64>,

    /// Width (J) to which the certified bounds are narrowed [default: a hundredth of
    /// the bond or a twentieth of the barrier, whichever is less]
    #[arg(long, value_name = "E_J", value_parser = request::positive)]
    tolerance: Option<f64>,

    #[command(flatten)]
    certify: CertifyOptions,

    /// Work given to the proof that no state is missing from the list, as what takes about so many
    /// seconds of a core; it is counted. 0 for no proof [default: 180; of very many magnets 0]
    #[arg(long, value_name = "W", value_parser = request::not_negative)]
    complete_work: Option<f64>,

    /// Seconds by the clock after which that proof ends too, so that another run may differ; 0 for no
    /// proof [default: no limit]
    #[arg(long, value_name = "S", value_parser = request::not_negative)]
    complete_seconds: Option<f64>,

    /// Traps are looked for below this share of the bond's energy
    #[arg(long, value_name = "F", default_value_t = Settings::default().completeness.below,
          value_parser = request::fraction)]
    complete_below: f64,

    /// Traps are to be listed that need more than this share of the bond's energy to leave
    #[arg(long, value_name = "F", default_value_t = Settings::default().completeness.escape,
          value_parser = request::fraction)]
    complete_escape: f64,

    #[command(flatten)]
    work: WorkOptions,

    /// Leave out PNG pictures and the pathways of symmetric copies: for results that are kept
    #[arg(long)]
    compact: bool,

    #[command(flatten)]
    figures: FigureOptions,

    #[command(flatten)]
    print: PrintOptions,
}

impl Analyse {
    pub fn run(self) -> Result<(), Failure> {
        let start = Instant::now();
        interrupt::prepare()?;
        let design = self.design.load()?;
        let sheet = self.figures.sheet()?;
        let extent = match self.compact {
            true => Extent::Compact,
            false => Extent::Full,
        };
        let inputs = self.design.inputs(&design);
        let output = Output::folder(&ANALYSE, &self.out).reading(inputs);
        let output = output.forced(self.force.force);
        output.check(|name| extent.may_hold(name))?;
        let settings = self.settings(&design);
        memory::check(settings.milestones, settings.neighbours, 1)?;
        self.work.use_threads()?;
        workload::tell_of(&design, &settings);

        let progress = self.print.progress();
        let analysis = pipeline::analyse(&design, &settings, &progress);
        progress.stage("pictures", 0.95);
        let scene = Scene::new(&design, &analysis.problem, &analysis.inventory);
        let wall = start.elapsed().as_secs_f64();
        let document = document(&design, &analysis, &scene, extent, wall);
        let files = files(&document, extent, &sheet, &command_line())?;
        interrupt::without(|| output.write(&files))?;
        progress.finish();
        self.print.results(&document.report(), || {
            let told = document.text(style::columns());
            format!(
                "{told}results in {}: report.html to look at; report.json, tables, pathways/, pictures/\n",
                self.out.display()
            )
        })?;
        fail_if_contradicted(analysis.contradicted().map(BarrierCheck::describe))
    }

    fn settings(&self, design: &Design) -> Settings {
        let default = Settings::of([design]);
        let complete = default.completeness;
        Settings {
            seed: self.work.seed,
            milestones: self.survey.milestones.unwrap_or(default.milestones),
            neighbours: self.survey.neighbours,
            boltzmann: self.boltzmann,
            thermal_energy: self.thermal_energy,
            settled: self.survey.settled,
            far_starts: self.survey.far_starts.unwrap_or(default.far_starts),
            most_kinds: self.survey.kinds.or(default.most_kinds),
            repeats: self.repeats,
            tolerance: self.tolerance,
            certify: self.certify.allowed(default.certify),
            completeness: CompletenessSettings {
                below: self.complete_below,
                escape: self.complete_escape,
                allowed: complete.allowed.or(
                    self.complete_work,
                    self.complete_seconds,
                    Settings::default().completeness.allowed,
                ),
                ..complete
            },
            dynamics_runs: self.survey.dynamics_runs(),
            ..default
        }
    }
}
