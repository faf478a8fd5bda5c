//! `tilebind bond`.

use clap::Args;
use tilebind::bond::Request;
use tilebind::report::bond::{FILES, document};

use super::Failure;
use super::design_job::DesignJob;

/// Print how strongly the bond and the traps hold shaken tiles: depth, docking cost and ln K
#[derive(Args)]
#[command(after_help = "\
kT is the effective energy of the shaking. `tilebind calibrate --bonds` fits it to observed pairs.

The docking cost in kT is -ln(rho Z0 s / 2 pi). rho is the number of tiles per square metre, Z0 the
integral of exp(-(U - Umin) / kT) over the state's basin, and s the number of the state's copies
under rotations of the moving tile. ln K is the depth in kT minus the docking cost. Above 0, a pair
is bound more than half of the time.

Examples:
  tilebind bond shapes/paper-tile.toml --kt 3e-3 --coverage 0.3
  tilebind bond shapes/paper-tile.toml --kt 3e-3 --coverage 0.3 --out target/bond
  tilebind bond shapes/tab-20mm.toml --kt 3e-3 --coverage 0.3 --model cuboid --json")]
pub struct BondCommand {
    #[command(flatten)]
    job: DesignJob<Request>,
}

impl BondCommand {
    pub fn run(self) -> Result<(), Failure> {
        let (request, mut begun) = self.job.begin(&FILES)?;
        let held = request.run(&begun.design, begun.is_written(), &begun.progress);
        let held = held.map_err(Failure::of)?;
        begun.deliver(|design| document(design, &held))
    }
}
