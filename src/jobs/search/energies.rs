//! The cheapest stage: what energies alone say of a design.

use super::aim::Aim;
use crate::design::Design;
use physics::landscape::minimum::{Known, Outcome, learn};
use physics::units::si;

/// A condition on the bond counts as violated if it is by more than this, relative to its value:
/// the bond of the analysis may lie slightly deeper.
const MARGIN: f64 = 0.05;

/// Why a design need not be analysed, and by how much it violates the conditions on the bond's
/// depth: the minimum that is reached from the target pose settles them.
pub fn refusal(aim: &Aim, design: &Design) -> Option<(f64, String)> {
    let mut conditions = aim
        .subject
        .iter()
        .filter(|one| one.quantity == "bond_depth")
        .peekable();
    conditions.peek()?;
    let problem = design.problem();
    let start = [design.pair.bound];
    let Some(Outcome::Minimum(end)) = learn(&problem, &start, &mut Known::default(), &|_| ()).pop()
    else {
        return None;
    };
    let depth = -end.point.energy;
    let violations = conditions.map(|one| (one.violation_of(depth), one));
    let worst = violations.max_by(|(a, _), (b, _)| a.total_cmp(b));
    worst
        .filter(|(violation, _)| *violation > MARGIN)
        .map(|(violation, condition)| {
            let depth = si(depth, "J", 4);
            (
                violation,
                format!("not {condition}: by its energy the bond is {depth} deep"),
            )
        })
}
