//! Escape barriers: the lowest way out of a state leads to the nearest of all lower places, which
//! need not be the one that the roadmap suggests.

use super::{BEND, shortest};
use crate::configuration::Configuration;
use crate::landscape::catalogue::Catalogue;
use crate::landscape::minimax::{Bracket, Certifier, Effort};
use crate::landscape::results::{Barrier, Place, SAME_ENERGY, State};
use crate::problem::Problem;

/// Cells spent on all ways out of a state together.
const CELLS: usize = 50_000;

/// The bracket of the escape that a barrier represents, over the paths to all lower states and to
/// `free`. If a pathway lower than the barrier's was found, also the barrier to its end.
pub fn bracket(
    problem: &Problem,
    certifier: &mut Certifier,
    catalogue: &Catalogue,
    (barrier, known): (&Barrier, &[Configuration]),
    effort: &Effort,
) -> Option<(Bracket, Option<Barrier>)> {
    let Place::State(from) = barrier.from else {
        return None;
    };
    let escape = catalogue.escape_of_kind(problem, catalogue.states[from].class)?;
    if (escape.from, escape.to) != (barrier.from, barrier.to) {
        return None;
    }
    let below = barrier.from_energy - SAME_ENERGY * barrier.from_energy.abs();
    let lower = catalogue.states.iter().filter(|state| state.energy < below);
    let goals: Vec<Configuration> = lower.map(|state| state.configuration).collect();
    let start = catalogue.states[from].configuration;
    let effort = Effort {
        cells: effort.cells.min(CELLS),
        ..*effort
    };
    let bracket = certifier.escape(&start, &goals, known, &effort).ok()?;
    let found = bracket
        .improved
        .then(|| found(problem, catalogue, barrier, &bracket));
    Some((bracket, found.flatten()))
}

/// The barrier over which the pathway of a bracket leads.
fn found(
    problem: &Problem,
    catalogue: &Catalogue,
    known: &Barrier,
    bracket: &Bracket,
) -> Option<Barrier> {
    let (start, end) = (bracket.pathway.first()?, bracket.pathway.last()?);
    let is_there = |state: &&State| state.configuration == *end;
    let to = match catalogue.states.iter().find(is_there) {
        Some(state) => (Place::State(state.id), state.energy),
        None => (Place::Free, 0.0),
    };
    let mut found = Barrier::without_a_way((known.from, known.from_energy), *start, to);
    let bend = BEND * problem.depth();
    let upper = bracket.bounds.upper?;
    found.lead_along(shortest(problem, &bracket.pathway, upper, bend)?);
    found.bounds = bracket.bounds;
    Some(found)
}
