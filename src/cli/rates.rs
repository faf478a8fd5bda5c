//! `tilebind rates`.

use clap::Args;
use tilebind::observer::Observer;
use tilebind::rates::Request;
use tilebind::report::rates::{FILES, document, exit_document};

use super::design_job::DesignJob;
use super::{Failure, input, workload};

/// Print how fast shaken tiles bind, unbind and change between states
#[derive(Args)]
#[command(after_help = EXAMPLES, after_long_help = format!("{NOTES}\n\n{EXAMPLES}"))]
pub struct Rates {
    #[command(flatten)]
    job: DesignJob<Request>,
}

const NOTES: &str = "\
Model: overdamped motion with diffusion constants D = kT / (RATE mass) in x and y and D / rho^2 in theta
(rho: radius of gyration), and reflecting contact. Mean exit times and committors solve the backward
equation on an adaptive mesh of (x, y, theta).

With --start: the mean exit time from that pose and the share of each exit. Without it: the rates
between the bond, the deepest traps and free tiles. A rate depends on the sets between which it is
defined, so these are always printed. Where no path between two sets is known, no rate is given (- or
null). A rate of 0 is printed only where contact proves that there is no path.

Errors are estimated, not proved: from the difference of the two finest meshes and from how smooth
solutions are on the finest. --check compares an exit with simulated tiles.

kT is the effective energy of the shaking. The rates hold for a drag of at least 50 /s and
elastic collisions. At less drag tiles are not overdamped; with lossy collisions no kT exists.";

const EXAMPLES: &str = "\
Examples:
  tilebind rates shapes/paper-tile.toml --kt 3e-3 --out target/rates
  tilebind rates shapes/paper-tile.toml --kt 3e-3 --start 0.43,-0.04,0
  tilebind rates shapes/paper-tile.toml --kt 1e-3 --drag 80 --start \"43 cm,-4 cm,0\" \\
    --basin-energy -0.03 --free-at 0.75 --json
  tilebind rates shapes/paper-tile.toml --kt 6e-3 --start 0.43,-0.04,0 --check 200";

impl Rates {
    pub fn run(self) -> Result<(), Failure> {
        let (request, mut begun) = self.job.begin(&FILES)?;
        let (design, progress) = (&begun.design, &begun.progress);
        request.check_memory(begun.threads).map_err(Failure::of)?;
        if let Some(start) = request.start {
            input::doubt_pose(design, &start);
            progress.stage("exit", 0.1);
            let problem = design.problem();
            let (found, check) = request
                .exit((design, &problem), start, progress)
                .map_err(Failure::of)?;
            return begun.deliver(|design| exit_document(design, &found, check.as_ref()));
        }
        workload::tell_memory(request.survey().check_memory())?;
        let found = request.rates(design, begun.is_written(), progress);
        let found = found.map_err(Failure::of)?;
        begun.deliver(|design| document(design, &found, request.seed))
    }
}
