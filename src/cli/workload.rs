//! How long a survey takes, told beforehand where that is long.

use std::time::Instant;

use tilebind::Design;
use tilebind::units::si;

use super::tell;

/// Energies that a survey takes for each milestone and each far start, about: those of the paper's
/// tile.
const FOR_A_MILESTONE: f64 = 130.0;
const FOR_A_FAR_START: f64 = 150.0;
/// Pairs of magnets below which no time is worth telling: their energy takes microseconds.
const FEW_PAIRS: usize = 10_000;
/// Surveys that take longer (s) are told of.
const LONG: f64 = 60.0;

/// Tells of a design with very many magnets what takes no survey, the energy where the target faces
/// meet, how long the survey takes, about, and what makes it shorter.
pub fn tell_of(design: &Design, milestones: usize, far_starts: usize, threads: usize) {
    let pair = &design.pair;
    let pairs = pair.fixed.magnets.len() * pair.moving.magnets.len();
    if pairs < FEW_PAIRS {
        return;
    }
    let energy = design.interaction.between(&pair.fixed, &pair.moving);
    let bond = energy.potential.energy(&pair.bound);
    let once = |_| {
        let since = Instant::now();
        energy.potential.energy(&pair.bound);
        since.elapsed().as_secs_f64()
    };
    let seconds = (0..3).map(once).fold(f64::INFINITY, f64::min);
    let evaluations = FOR_A_MILESTONE * milestones as f64 + FOR_A_FAR_START * far_starts as f64;
    let total = seconds * evaluations / threads as f64;
    if total > LONG {
        let (minutes, bond) = ((total / 60.0).ceil(), si(bond, "J", 4));
        let fewer = match far_starts {
            0 => "--milestones take",
            _ => "--milestones and --far-starts take",
        };
        tell(format!(
            "note: {bond} where the target faces meet; {pairs} pairs of magnets: the survey takes \
             about {minutes:.0} min on {threads} threads; fewer {fewer} less, and the certificate \
             ends after --certify-seconds"
        ));
    }
}
