//! Narrowing the bounds of many barriers together.

use super::{escapes, question};
use crate::catalogue::Catalogue;
use crate::minimax::{Bracket, Certifier, Effort, Question};
use crate::pathway::{self, PathLimits};
use crate::results::{Barrier, Pathway, Place, SaddleBounds, State, highest_point};
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// Energy tolerance of pathways, as a fraction of the bond's depth.
const BEND: f64 = 1e-3;

/// The result of narrowing the bounds of a barrier.
pub struct Narrowed {
    /// Cells that it took.
    pub cells: usize,
    /// The barrier to another place that was found to be lower, if any.
    pub beside: Option<Barrier>,
    /// Largest allowed lower bound (J).
    pub most: f64,
}

/// A question about the barrier of this number, the one in this place among those to narrow.
struct Asked {
    place: usize,
    number: usize,
    question: Question,
    /// Whether it is about all ways out.
    is_escape: bool,
}

/// Narrows the bounds of barriers, given by their numbers, those of escapes over all ways out. If the
/// lowest way out leads elsewhere, the way over the barrier is narrowed as well. `answered` is told
/// how many are done.
pub fn narrow(
    problem: &Problem,
    certifier: &mut Certifier,
    catalogue: &mut Catalogue,
    barriers: &[(usize, Effort)],
    answered: &dyn Fn(usize),
) -> Vec<Narrowed> {
    let new = |_| Narrowed {
        cells: 0,
        beside: None,
        most: f64::INFINITY,
    };
    let mut narrowed: Vec<Narrowed> = barriers.iter().map(new).collect();
    let ask = |catalogue: &Catalogue, place: usize, all_ways: bool| {
        let (number, effort) = &barriers[place];
        let barrier = &catalogue.barriers[*number];
        let all = all_ways.then(|| escapes::question(problem, catalogue, barrier, effort));
        let escape = all.flatten();
        Some(Asked {
            place,
            number: *number,
            is_escape: escape.is_some(),
            question: escape.or_else(|| question(catalogue, barrier, effort))?,
        })
    };
    let all: Vec<Asked> = (0..barriers.len())
        .filter_map(|place| ask(catalogue, place, true))
        .collect();
    let open = conclude(
        problem,
        certifier,
        catalogue,
        (&all, &mut narrowed),
        answered,
    );
    let done = barriers.len() - open.len();
    let answered = |count: usize| answered(done + count);
    let again: Vec<Asked> = open
        .into_iter()
        .filter_map(|place| ask(catalogue, place, false))
        .collect();
    conclude(
        problem,
        certifier,
        catalogue,
        (&again, &mut narrowed),
        &answered,
    );
    for Asked { place, number, .. } in again {
        let lower = &mut catalogue.barriers[number].bounds.lower;
        *lower = lower.map(|lower| lower.min(narrowed[place].most));
    }
    narrowed
}

/// Answers questions and takes over what was found; returns the places of escapes whose lowest way
/// out leads elsewhere.
fn conclude(
    problem: &Problem,
    certifier: &mut Certifier,
    catalogue: &mut Catalogue,
    (asked, narrowed): (&[Asked], &mut [Narrowed]),
    answered: &dyn Fn(usize),
) -> Vec<usize> {
    let questions: Vec<Question> = asked.iter().map(|asked| asked.question.clone()).collect();
    let brackets = certifier.answers(&questions, answered).into_iter();
    let brackets: Vec<(&Asked, Bracket)> = asked
        .iter()
        .zip(brackets)
        .filter_map(|(asked, bracket)| Some((asked, bracket.ok()?)))
        .collect();
    let found = parallel::map(&brackets, |(asked, bracket)| {
        found(
            problem,
            catalogue,
            &catalogue.barriers[asked.number],
            bracket,
        )
    });
    let mut elsewhere = Vec::new();
    for ((asked, bracket), found) in brackets.into_iter().zip(found) {
        let narrowed = &mut narrowed[asked.place];
        narrowed.cells += bracket.cells;
        if !asked.is_escape {
            take_over(&mut catalogue.barriers[asked.number], bracket.bounds, found);
        } else if !escaped(catalogue, asked.number, (&bracket, found), narrowed) {
            elsewhere.push(asked.place);
        }
    }
    elsewhere
}

/// Takes over what was found of the escape that a barrier represents; returns whether the bounds of
/// the barrier itself are narrowed by it as well.
fn escaped(
    catalogue: &mut Catalogue,
    number: usize,
    (bracket, found): (&Bracket, Option<Barrier>),
    narrowed: &mut Narrowed,
) -> bool {
    let barrier = &mut catalogue.barriers[number];
    let is_bound = catalogue.bound_state.map(Place::State) == Some(barrier.from);
    match found {
        None if !bracket.improved => take_over(barrier, bracket.bounds, None),
        // There is a lower path that cannot be reported: the escape is not higher than it.
        None => {
            narrowed.most = bracket.bounds.lower.unwrap_or(f64::NEG_INFINITY);
            return false;
        }
        Some(way) if way.to == barrier.to => take_over(barrier, bracket.bounds, Some(way)),
        Some(way) if !barrier.has_way() && !is_bound => *barrier = way,
        way => {
            narrowed.beside = way;
            return false;
        }
    }
    true
}

/// The barrier over which the pathway of a bracket leads, if it is not the `known` one's.
fn found(
    problem: &Problem,
    catalogue: &Catalogue,
    known: &Barrier,
    bracket: &Bracket,
) -> Option<Barrier> {
    if !bracket.improved {
        return None;
    }
    let (start, end) = (bracket.pathway.first()?, bracket.pathway.last()?);
    let is_there = |state: &&State| state.configuration == *end;
    let to = match catalogue.states.iter().find(is_there) {
        Some(state) => (Place::State(state.id), state.energy),
        None => (Place::Free, 0.0),
    };
    let mut found = Barrier::without_a_way((known.from, known.from_energy), *start, to);
    found.lead_along(shortest(problem, &bracket.pathway, bracket.bounds.upper?)?);
    found.bounds = bracket.bounds;
    Some(found)
}

/// Takes over bounds, and the pathway that was found, if it is lower: in place of one that could not
/// be proved, the certificate's own may lie higher.
fn take_over(barrier: &mut Barrier, bounds: SaddleBounds, found: Option<Barrier>) {
    barrier.bounds.tighten(bounds);
    let upper = bounds.upper.unwrap_or(f64::INFINITY);
    if let Some(found) = found.filter(|_| upper < barrier.saddle_energy) {
        barrier.lead_along(found.pathway);
    }
}

/// A pathway of the certificate, which leads through the middles of its cells, shortened, if it
/// does not rise above `upper` (J).
fn shortest(problem: &Problem, points: &[Configuration], upper: f64) -> Option<Pathway> {
    let bend = BEND * problem.depth();
    let limits = PathLimits::below(upper, problem);
    let direct = pathway::shortened(problem, points, &limits);
    let mut pathways = [direct.as_slice(), points]
        .into_iter()
        .map(|points| pathway::of_configurations(problem, points, bend));
    pathways.find(|pathway| highest_point(pathway).is_some_and(|highest| highest.energy <= upper))
}
