//! `tilebind rates`.

use clap::Args;
use tilebind::observer::Observer;
use tilebind::rates::Request;
use tilebind::report::files::RATES;
use tilebind::report::rates::{document, exit_document};
use tilebind::{Settings, pipeline};

use super::options::{DesignOptions, ThreadOption};
use super::results::ResultOptions;
use super::{Failure, input, memory};

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
bond, the deepest traps and free tiles; between places without a known way nothing is claimed (- and
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

    #[command(flatten)]
    request: Request,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl Rates {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        let output = self.results.output(&RATES, self.design.inputs(&design))?;
        let (problem, request) = (design.problem(), &self.request);
        request.check(&design, &problem).map_err(Failure::of)?;
        self.threads.use_threads()?;
        let progress = self.results.progress();
        if let Some(start) = request.start {
            input::doubt_pose(&design, &start);
            let (found, check) = request
                .exit((&design, &problem), start)
                .map_err(Failure::of)?;
            let document = exit_document(&design, &found, check.as_ref());
            return self.results.deliver(&document, output, &progress);
        }
        // States and their lowest barriers are needed, and no proofs.
        let settings = Settings {
            milestones: Settings::default().milestones,
            ..Settings::without_proofs(request.seed)
        };
        memory::check(settings.milestones, None, 1)?;
        let analysis = pipeline::analyse_problem(&design, problem, &settings, &progress);
        progress.stage("rates", 0.9);
        let found = request.rates(&design, &analysis, output.is_some());
        let found = found.map_err(Failure::of)?;
        let document = document(&design, &found, request.seed);
        self.results.deliver(&document, output, &progress)
    }
}
