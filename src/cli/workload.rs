//! How long a survey takes, told beforehand where that is long.

use std::time::Instant;

use tilebind::Design;

use super::options::{SurveyOptions, WorkOptions};
use super::tell;

/// Energies that a survey takes for each milestone and each far start, about: those of the paper's
/// tile.
const FOR_A_MILESTONE: f64 = 130.0;
const FOR_A_FAR_START: f64 = 150.0;
/// Pairs of magnets below which no time is worth telling: their energy takes microseconds.
const FEW_PAIRS: usize = 10_000;
/// Surveys that take longer (s) are told of.
const LONG: f64 = 60.0;

/// Tells how long the survey of a design with very many magnets takes, about, and what makes it
/// shorter.
pub fn tell_of(design: &Design, survey: &SurveyOptions, work: &WorkOptions) {
    let pair = &design.pair;
    let pairs = pair.fixed.magnets.len() * pair.moving.magnets.len();
    if pairs < FEW_PAIRS {
        return;
    }
    let energy = design.interaction.between(&pair.fixed, &pair.moving);
    let once = |_| {
        let since = Instant::now();
        energy.potential.energy(&pair.bound);
        since.elapsed().as_secs_f64()
    };
    let seconds = (0..3).map(once).fold(f64::INFINITY, f64::min);
    let evaluations =
        FOR_A_MILESTONE * survey.milestones as f64 + FOR_A_FAR_START * survey.far_starts as f64;
    let threads = work.threads();
    let total = seconds * evaluations / threads as f64;
    if total > LONG {
        let minutes = (total / 60.0).ceil();
        tell(format!(
            "note: {pairs} pairs of magnets: the survey takes about {minutes:.0} min on {threads} \
             threads; fewer --milestones and --far-starts take less, and the certificate ends after \
             --certify-seconds"
        ));
    }
}
