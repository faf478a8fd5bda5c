//! Escape barriers: the lowest way out of a state leads to the nearest of all lower places, which
//! need not be the one that the roadmap suggests.

use crate::catalogue::Catalogue;
use crate::minimax::{Effort, Goal, Question};
use crate::results::{Barrier, Place, SAME_ENERGY};
use tiles::problem::Problem;

/// Cells spent on all ways out of a state together.
const CELLS: usize = 50_000;

/// The question of the escape that a barrier represents, if it does: over the paths to all lower
/// states and to `free`.
pub fn question(
    problem: &Problem,
    catalogue: &Catalogue,
    barrier: &Barrier,
    effort: &Effort,
) -> Option<Question> {
    let Place::State(from) = barrier.from else {
        return None;
    };
    let escape = catalogue.escape_of_kind(problem, catalogue.states[from].class)?;
    if (escape.from, escape.to) != (barrier.from, barrier.to) {
        return None;
    }
    let below = barrier.from_energy - SAME_ENERGY * barrier.from_energy.abs();
    let lower = catalogue.states.iter().filter(|state| state.energy < below);
    let places: Vec<_> = lower.map(|state| state.configuration).collect();
    // Of the deepest state there is one way out, the barrier itself.
    if places.is_empty() {
        return None;
    }
    let mut question = super::question(catalogue, barrier, effort)?;
    question.to = Goal { places, free: true };
    question.effort.cells = effort.cells.min(CELLS);
    Some(question)
}
