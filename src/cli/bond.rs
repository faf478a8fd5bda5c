//! `tilebind bond`.

use clap::Args;
use tilebind::bond::{Request, held};
use tilebind::report::bond::document;
use tilebind::report::files::BOND;
use tilebind::{Settings, pipeline};

use super::Failure;
use super::options::{DesignOptions, ThreadOption};
use super::results::ResultOptions;

/// How strongly bond and traps hold shaken tiles: depths, docking costs and ln K at kT
#[derive(Args)]
#[command(after_help = "\
kT is an effective energy of the shaking, to be fitted to pairs that bind and part: `tilebind
calibrate --bonds`. The docking cost is -ln(rho Z0 s / 2 pi): rho tiles on a square metre, Z0 the
integral of exp(-(U - Umin) / kT) over the state's basin with true contact, s its copies by turns of
the moving tile. ln K is the depth less this cost: above 0 a pair is bound more often than not.

Examples:
  tilebind bond shapes/paper-tile.toml --kt 3e-3 --coverage 0.3
  tilebind bond shapes/paper-tile.toml --kt 3e-3 --coverage 0.3 --out target/bond
  tilebind bond shapes/tab-20mm.toml --kt 3e-3 --coverage 0.3 --model cuboid --json")]
pub struct BondCommand {
    #[command(flatten)]
    design: DesignOptions,

    #[command(flatten)]
    request: Request,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl BondCommand {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        let output = self.results.output(&BOND, self.design.inputs(&design))?;
        self.threads.use_threads()?;
        let progress = self.results.progress();
        let settings = Settings::without_proofs(self.request.seed);
        let analysis = pipeline::analyse(&design, &settings, &progress);
        let found = (&*analysis.problem, &analysis.catalogue);
        let shaking = self.request.shaking();
        let held = held(&design, found, shaking, output.is_some()).map_err(Failure::of)?;
        self.results
            .deliver(&document(&design, &held), output, &progress)
    }
}
