//! `tilebind tolerance`.

use clap::Args;
use tilebind::report::tolerance::{FILES, document};
use tilebind::tolerance::Request;

use super::Failure;
use super::design_job::DesignJob;

/// Print what errors of making do: tiles drawn with them, and the share that still binds as designed
#[derive(Args)]
#[command(after_help = EXAMPLES, after_long_help = format!("{NOTES}\n\n{EXAMPLES}"))]
pub struct ToleranceCommand {
    #[command(flatten)]
    job: DesignJob<Request>,
}

const NOTES: &str = "\
A pair of tiles works if its bond is its deepest state, and at least --selectivity times as deep as its
deepest trap. The bond is the stated contact. Contacts that are equal to it in the design count neither
as bond nor as trap.

Each magnet of both tiles is drawn by itself, with normally distributed errors; the options give
standard deviations. --strength changes the moment, --place shifts the magnet along the face and across
it, --turn turns it about its centre in the tiles' plane, --flip exchanges its poles. --batch B makes
the share B of the strength's variance common to all magnets of a draw (1: all have the same strength).
--gap L puts a layer of L |z| / 2 on every face, z normal, so that touching faces are 0.8 L apart on
average. No magnet sticks out of its face: it stops at the surface. Turns do not change upright discs;
magnets do not tip out of the tiles' plane.

States are searched once, without errors, and followed to each draw: strengths and poles exactly, places
and turns by second-order expansions of each pair of magnets and at most three Newton steps of the pose. The
report has the error of that, from draws minimised with exact energies, and --checks draws with their
own search of states.

A flipped magnet is noticed if the bond with it is weaker than 95 % of the draws without flips.
Intervals of shares are 95 % (Wilson).";

const EXAMPLES: &str = "\
Examples:
  tilebind tolerance shapes/paper-tile.toml --strength 5% --place \"0.3 mm\" --turn \"3 deg\"
  tilebind tolerance shapes/sine-teeth-20mm.toml --strength 5% --gap \"0.1 mm\" --flip 0.01 \\
      --selectivity 1.1 --out target/tolerance";

impl ToleranceCommand {
    pub fn run(self) -> Result<(), Failure> {
        let (request, mut begun) = self.job.begin(&FILES)?;
        let found = request.run(&begun.design, &begun.progress);
        let found = found.map_err(Failure::of)?;
        begun.deliver(|design| document(design, &found))
    }
}
