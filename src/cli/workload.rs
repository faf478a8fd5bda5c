//! Says before an analysis that it takes much memory, or, for many magnets, that it is sampled less.

use tilebind::units::si;
use tilebind::{Design, Settings};

use super::{Failure, tell};

/// For a design with very many magnets, prints the energy of the bond, which needs no survey, and
/// the reduced amounts of work.
pub fn tell_of(design: &Design, asked: &Settings) {
    if Settings::of([design]) == Settings::default() {
        return;
    }
    let pair = &design.pair;
    let pairs = pair.fixed.magnets.len() * pair.moving.magnets.len();
    let bond = si(design.problem().energy(&pair.bound), "J", 4);
    let mut less = vec![format!("{} milestones (--milestones)", asked.milestones)];
    if let Some(kinds) = asked.most_kinds {
        less.push(format!("the {kinds} deepest kinds of state (--kinds)"));
    }
    if asked.far_starts > 0 {
        less.push(format!("{} far starts (--far-starts)", asked.far_starts));
    }
    if asked.certify.is_none() && asked.completeness.allowed.is_none() {
        less.push("no proofs (--certify-work, --complete-work)".to_owned());
    }
    tell(format!(
        "note: {pairs} pairs of magnets, {bond} where the target faces meet, take long; the \
         defaults are reduced to {}",
        less.join(", ")
    ));
}

/// Reports a check of the memory: an error if the machine does not have it.
pub fn tell_memory(checked: Result<Option<String>, String>) -> Result<(), Failure> {
    if let Some(told) = checked.map_err(Failure::Usage)? {
        tell(format!("note: {told}"));
    }
    Ok(())
}
