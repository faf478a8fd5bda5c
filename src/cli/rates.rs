//! `tilebind rates`.

use std::path::PathBuf;

use clap::Args;
use tilebind::design::Design;
use tilebind::dynamics::exits::{ExitRunSettings, ExitRuns, exits};
use tilebind::dynamics::{Body, MotionSettings};
use tilebind::kinetics::exit::{ExitSettings, exit, half_bond};
use tilebind::kinetics::rates::{RateSettings, rates};
use tilebind::kinetics::{Certify, OVERDAMPED, why_unprovable};
use tilebind::observer::Observer;
use tilebind::report::files::{RATES, with_report};
use tilebind::report::page::Page;
use tilebind::report::{json, rates as report};
use tilebind::{Configuration, Problem, Settings, pipeline};

use super::figures::command_line;
use super::options::{DesignOptions, ForceOption, PrintOptions, WorkOptions};
use super::{Failure, input, interrupt, memory, print};

/// Mean exit times after which a moving tile is given up.
const PATIENCE: f64 = 30.0;
/// Squares along x and y of the committor's map.
const SQUARES: usize = 120;

/// Print how fast shaken tiles bind, come off and change between states
#[derive(Args)]
#[command(after_help = "\
Overdamped motion: D = kT / (RATE mass) in x and y and D / rho^2 in theta (rho: radius of gyration),
reflected where tiles touch. Mean exit times and committors solve the backward equation on a mesh of
(x, y, theta) that is refined where it matters. Lower bounds of capacities come from fluxes without
sources (Thomson), for tiles whose contact every ray from the centre leaves once (convex ones, tabs,
slots, teeth, arcs; no dovetails or square teeth), upper ones from trial committors (Dirichlet), for all; what the mesh's integrals and basins made of whole cells are off by is not in them (the latter is
estimated): they are \"bracketed on the mesh\". --prove encloses integrals and sets too, and so proves
how often tiles set out from the well about the start for an end, or from each basin for another, and
bounds of the mean time until they are there: near each other only where the well holds next to all
that the ends do not, far below the passes; of dipoles, with shields (but by the nearest-face rule) or without. Without --start: rates between the
bond, the deepest traps and free tiles; between places without a known way nothing is claimed (? and
null), and 0 only where contact proves that there is none. The ends are sets; without them no rate means anything, so they are printed beside
every number.

kT is an effective energy of shaking. It exists for drag of 50 /s and more and for knocks that take no
energy; tiles that glide far between knocks, or whose knocks take what shaking does not give back,
have none.

Examples:
  tilebind rates shapes/paper-tile.toml --kt 3e-3 --out target/rates
  tilebind rates shapes/paper-tile.toml --kt 3e-3 --start 0.43,-0.04,0
  tilebind rates shapes/paper-tile.toml --kt 1e-3 --drag 80 --start \"43 cm,-4 cm,0\" \\
    --basin-energy -0.03 --free-at 0.75 --json
  tilebind rates shapes/paper-tile.toml --kt 3e-3 --start 0.43,-0.04,0 --certify 0.05 --prove
  tilebind rates shapes/paper-tile.toml --kt 1e-3 --prove")]
pub struct Rates {
    #[command(flatten)]
    design: DesignOptions,

    /// Effective energy of shaking (J)
    #[arg(long, value_name = "E_J", value_parser = input::shaking)]
    kt: f64,

    /// Drag rate (1/s): the drag is this times the mass
    #[arg(long, value_name = "RATE", default_value_t = OVERDAMPED, value_parser = input::positive)]
    drag: f64,

    /// Pose at which the tile is let go (m, m, rad); its mean exit time and its exits are printed
    #[arg(long, value_name = "X,Y,THETA", allow_hyphen_values = true, value_parser = input::pose)]
    start: Option<Configuration>,

    /// The tile is bound where U (J) is lower, in the basin of the bond or of one of its copies
    /// [default: half the bond's energy; without --start half way up to its lowest barrier]
    #[arg(long, value_name = "E_J", allow_hyphen_values = true, value_parser = input::negative)]
    basin_energy: Option<f64>,

    /// The tile is free where the centres are so far apart (m) [default: where `analyse` has it]
    #[arg(long, value_name = "R", value_parser = input::length)]
    free_at: Option<f64>,

    /// Refine until bounds are apart by this share of the lower one at most: those of the mean exit
    /// time, or those of the rates out of the bond and of the traps and of all that make up a tenth
    /// of these [default: 0.1, as far as it comes within seconds]
    #[arg(long, value_name = "REL", value_parser = input::positive)]
    certify: Option<f64>,

    /// Prove how often tiles set out from the well about the start, or from each basin, and bounds of
    /// the mean time until they are at an end, for tiles that are convex about their centres of mass,
    /// of few corners
    #[arg(long)]
    prove: bool,

    /// Kinds of traps with rates, the deepest first
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = input::count_or_none,
          conflicts_with = "start")]
    traps: usize,

    /// Folder for report.html, report.json, rates.csv, occupation.csv, over-kt.csv, committor.csv,
    /// pictures/ and, with --prove, proved.csv
    #[arg(long, value_name = "DIR", conflicts_with = "start")]
    out: Option<PathBuf>,

    #[command(flatten)]
    force: ForceOption,

    /// Let N rigid bodies with inertia go at the start, too, and print their mean exit time over
    /// that of overdamped motion
    #[arg(long, value_name = "N", requires = "start", value_parser = input::runs_of_a_mean)]
    check: Option<usize>,

    /// Share of the approach velocity that a knock gives back, in --check
    #[arg(long, value_name = "E", requires = "check", default_value_t = 1.0,
          value_parser = input::share)]
    restitution: f64,

    #[command(flatten)]
    work: WorkOptions,

    #[command(flatten)]
    print: PrintOptions,
}

impl Rates {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        let design = self.design.load()?;
        let model = design.interaction.model;
        let problem = design.problem();
        if self.prove
            && let Some(why) = why_unprovable(&problem, model)
        {
            return Err(Failure::Usage(why));
        }
        self.work.use_threads()?;
        match self.start {
            Some(start) => self.exit(&design, &problem, start),
            None => self.table(&design, problem),
        }
    }

    fn exit(
        &self,
        design: &Design,
        problem: &Problem,
        start: Configuration,
    ) -> Result<(), Failure> {
        input::doubt_pose(design, &start);
        let half = || half_bond(problem, &design.pair.bound);
        let basin = self.basin_energy.unwrap_or_else(half);
        let asked = ExitSettings {
            certify: Some(self.certified(Certify::of_exit)),
            ..ExitSettings::new(self.kt, start, basin, self.free_at(design))
        };
        let found = exit(problem, &design.pair.bound, &asked)?;
        let motion = report::Motion::new(design, self.kt, self.drag);
        let mean = found.time() / motion.diffusion;
        let checked = self.check.map(|runs| {
            let runs = self.runs(&asked, runs, mean);
            self.let_go(problem, &Body::of_tile(&design.pair.moving), &runs)
        });
        let checked = checked.transpose()?;
        print(&if self.print.json {
            let mut entry = report::exit_entry(&asked, &motion, &found);
            if let Some(runs) = &checked {
                entry["check"] = report::check_entry(&motion, &found, runs);
            }
            json::text(&entry)
        } else {
            let text = report::exit_summary(design, &asked, &motion, &found);
            let check = checked.map(|runs| report::check_summary(&motion, &found, &runs));
            text + &check.unwrap_or_default()
        })
    }

    /// How closely things are bounded, and whether that is proved.
    fn certified(&self, usual: fn() -> Certify) -> Certify {
        let certify = self.certify.map_or_else(usual, Certify::to);
        match self.prove {
            true => certify.proved(),
            false => certify,
        }
    }

    fn runs(&self, asked: &ExitSettings, runs: usize, mean: f64) -> ExitRunSettings {
        ExitRunSettings {
            start: asked.start,
            basin_energy: asked.basin_energy,
            free_at: asked.free_at,
            runs,
            seed: self.work.seed,
            longest: PATIENCE * mean,
        }
    }

    /// Tiles that really move.
    fn let_go(
        &self,
        problem: &Problem,
        body: &Body,
        asked: &ExitRunSettings,
    ) -> Result<ExitRuns, Failure> {
        let motion = MotionSettings {
            drag: self.drag,
            restitution: self.restitution,
            friction: 0.0,
            walls: false,
            shaking: Some(self.kt),
            ..MotionSettings::default()
        };
        exits(problem, *body, &motion, asked).map_err(|error| Failure::Usage(error.to_string()))
    }

    fn free_at(&self, design: &Design) -> f64 {
        self.free_at.unwrap_or(design.space().free_distance)
    }

    fn table(&self, design: &Design, problem: Problem) -> Result<(), Failure> {
        let output = self.out.as_ref();
        let output = output.map(|it| self.force.folder(&RATES, it, self.design.inputs(design)));
        let output = output.transpose()?;
        let settings = self.survey();
        memory::check(settings.milestones, None, 1)?;
        let progress = self.print.progress();
        let analysis = pipeline::analyse_problem(design, problem, &settings, &progress);
        progress.stage("rates", 0.9);
        let places = report::Place::held(&analysis, self.kt, self.traps, self.basin_energy);
        let basins = places.iter().map(report::Place::basin);
        let asked = RateSettings {
            certify: Some(self.certified(Certify::default)),
            map: self.out.as_ref().map(|_| SQUARES),
            ..RateSettings::new(self.kt, basins.collect(), self.free_at(design))
        };
        let found = rates(&analysis.problem, &asked)?;
        let motion = report::Motion::new(design, self.kt, self.drag);
        let table = report::Table {
            design,
            asked: &asked,
            motion: &motion,
            places: &places,
            found: &found,
        };
        let Some((output, folder)) = output.zip(self.out.as_ref()) else {
            progress.finish();
            return self
                .print
                .results(&json::text(&table.entry()), || table.summary());
        };
        let over_kt = report::over_kt(
            design,
            &analysis.problem,
            &places,
            (&asked, &found),
            &motion,
        );
        let value = report::report(&table, &over_kt, self.work.seed);
        let page = Page::of_rates(&table, &over_kt);
        let tables = report::files(&table, &over_kt);
        let files = with_report(tables, Some(page), &value, &command_line());
        interrupt::without(|| output.write(&files))?;
        progress.finish();
        self.print.results(&json::text(&value), || {
            format!(
                "{}results in {}: report.html to look at; report.json, tables, pictures\n",
                table.summary(),
                folder.display()
            )
        })
    }

    /// States and their lowest barriers are needed, and no proofs.
    fn survey(&self) -> Settings {
        Settings {
            milestones: Settings::default().milestones,
            ..Settings::without_proofs(self.work.seed)
        }
    }
}
