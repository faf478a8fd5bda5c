//! `tilebind yield`.

use clap::Args;
use tilebind::report::yields::{FILES, document};
use tilebind::yields::{Request, expected, yields};

use super::design_job::DesignJob;
use super::{Failure, workload};

/// Print how many pairs are bound after a time on a shaken table, and which shaking binds most
#[derive(Args)]
#[command(after_help = EXAMPLES, after_long_help = format!("{NOTES}\n\n{EXAMPLES}"))]
pub struct YieldCommand {
    #[command(flatten)]
    job: DesignJob<Request>,
}

const NOTES: &str = "\
Half of the tiles are of the fixed tile's kind, half of the moving tile's kind, unless both are one kind.
Each tile binds at most one partner. Equal tiles that bind with two faces also make chains and rings:
their numbers by size are simulated (--simulations), with the rates of a pair for every two free ends.
A chain closes where the bond's turn brings its ends together, such as eight sectors of 45 degrees. The
rows named `bound` still say which pairs there would be if a tile bound one other at most.

Attachment rates are counted in docking runs of shaken tiles. These start in equilibrium where the tiles
are apart (|U| below kT), on a table just large enough for that, and end once the tiles are bound: matched,
with so little kinetic and potential energy that 3 kT are missing to become free, so that a tile that
only flies by does not count. Both tiles move: the simulated one has the pair's reduced mass and moment
of inertia. The rate is the number of attachments over the time apart, times the area
in which a pair is apart, and depends neither on --duration nor on the size of the table. With
--rates overdamped rates are solved for overdamped motion of both tiles (`tilebind rates` has one of
them at rest). Detachment rates
follow by detailed balance from the partition functions of the states (`tilebind bond`). This is valid
only if collisions lose no energy: otherwise the table has no temperature.

If several kT are given, those at which the bond does not hold, or at which bound tiles
move by less than the contact tolerance, are omitted, with the reason.";

const EXAMPLES: &str = "\
Examples:
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 600 --kt 3e-3
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 36000 --kt 3e-3 --rates overdamped
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 600 --kt 2e-3,4e-3,6e-3 --out target/yield";

impl YieldCommand {
    pub fn run(self) -> Result<(), Failure> {
        let (request, mut begun) = self.job.begin(&FILES)?;
        let (design, threads) = (&begun.design, begun.threads);
        request.check_memory(threads).map_err(Failure::of)?;
        let expected = expected(design, &request).map_err(Failure::of)?;
        workload::tell_expected(expected, threads);
        let found = yields(design, &request, &begun.progress).map_err(Failure::of)?;
        begun.deliver(|design| document(design, &request, &found))
    }
}
