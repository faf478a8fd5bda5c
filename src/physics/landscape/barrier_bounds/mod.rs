//! Certified bounds for the barriers of a catalogue.

mod escapes;
mod joined;
mod schedule;

use std::collections::VecDeque;

use super::catalogue::{Catalogue, LEAST_GAIN};
use super::minimax::{Bracket, Certifier, Effort, End};
use super::pathway::{self, Limits};
use super::results::{Barrier, Pathway, Place, StateKind, Uncertified, highest_point};
use crate::budget::{Allowance, Ended};
use crate::configuration::Configuration;
use crate::observer::Observer;
use crate::order::Order;
use crate::problem::Problem;

pub use schedule::widths;

/// Bounds are narrowed once more if the requested width has shrunk to this fraction.
const LESS: f64 = 0.75;

/// Energy tolerance of pathways, as a fraction of the bond's depth.
const BEND: f64 = 1e-3;

/// Settings of the certification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CertificationSettings {
    /// Target width (J) of bounds; if `None`, a hundredth of the bond or a twentieth of the
    /// barrier, whichever is smaller.
    pub tolerance: Option<f64>,
    /// The limit of the total work; bounds known when it ends are kept.
    pub allowed: Allowance,
    /// Cells spent on the bounds of one barrier at most.
    pub cells: usize,
    /// Which barriers are certified.
    pub claims: Claims,
}

/// The barriers with claims beyond the roadmap's estimate: they are certified and, if requested,
/// checked by moving tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Claims {
    /// All that are reported.
    All,
    /// The ways out of the bond to `free` and out of the deepest trap.
    BondAndDeepestTrap,
}

impl Claims {
    /// Whether a barrier of a catalogue is among them.
    pub fn include(self, barrier: &Barrier, catalogue: &Catalogue) -> bool {
        let is_from = |kind| {
            let first = catalogue.first(kind).map(|state| Place::State(state.id));
            first == Some(barrier.from)
        };
        let is_out_of_the_bond = is_from(StateKind::Bond) && barrier.to == Place::Free;
        self == Self::All || is_out_of_the_bond || is_from(StateKind::Trap)
    }
}

/// The work of a certification.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Certified {
    /// Cells assessed.
    pub cells: usize,
    /// The reason for ending before all bounds were as narrow as requested; `None` if it was only
    /// the limit of cells per barrier.
    pub ended: Option<Ended>,
}

/// Brackets every barrier of a catalogue between two bounds that hold for the model, and takes over
/// lower pathways of the certificate. If the bound state has no path to `free`, tries to prove that
/// there is none.
///
/// Brackets are narrowed [step by step](widths), and the best bounds are kept: more work never
/// widens them and, if one width is requested for all, neither does a smaller width.
///
/// The results are the same on every machine, unless a time limit ends the work.
///
/// # Errors
/// If nothing is certified; the catalogue is then unchanged.
pub fn certify(
    problem: &Problem,
    catalogue: &mut Catalogue,
    settings: &CertificationSettings,
    observer: &dyn Observer,
) -> Result<Certified, Uncertified> {
    let bounds = problem.bounds()?;
    let depth = problem.depth();
    let contact = problem.contact.as_ref();
    let mut certifier = Certifier::within(bounds, contact, &problem.space, settings.allowed)?;
    let mut ended = None;
    let mut left: Vec<usize> = vec![settings.cells; catalogue.barriers.len()];
    let mut most = vec![f64::INFINITY; catalogue.barriers.len()];
    let mut rounds = VecDeque::from(schedule::rounds(catalogue, settings, depth));
    let mut count: usize = rounds.iter().map(|(_, numbers)| numbers.len()).sum();
    let mut done = 0;
    while let Some((width, numbers)) = rounds.pop_front() {
        // The width (J) that a barrier's bounds are to be narrowed to, if they are to be.
        let open = |catalogue: &Catalogue, left: &[usize], number: usize| {
            let barrier = &catalogue.barriers[number];
            let wanted = schedule::wanted(barrier, settings, depth);
            let is_done = barrier.bounds.width() <= width.max(wanted) || left[number] == 0;
            (!is_done).then(|| schedule::step(width, wanted, settings))
        };
        let foreseen = numbers.iter().filter_map(|&number| {
            let tolerance = open(catalogue, &left, number)?;
            let (start, _, known) = ends(catalogue, &catalogue.barriers[number])?;
            Some((start, known, tolerance))
        });
        certifier.foresee(&foreseen.collect::<Vec<_>>());
        // Barriers that turned out so much lower that narrower bounds are requested.
        let mut lowered = Vec::new();
        for number in numbers {
            observer.part("certificate", done, count);
            done += 1;
            let Some(tolerance) = open(catalogue, &left, number) else {
                continue;
            };
            ended = certifier.ended();
            if ended.is_some() {
                continue;
            }
            let effort = Effort {
                tolerance,
                cells: left[number],
            };
            let narrowed = narrow(problem, &mut certifier, catalogue, number, &effort);
            if catalogue.barriers[number].bounds.width() > tolerance {
                ended = certifier.ended();
            }
            most[number] = narrowed.most;
            left[number] = schedule::cells_left(
                left[number].saturating_sub(narrowed.cells),
                catalogue.barriers[number].bounds.width() <= effort.tolerance,
                settings,
            );
            if open(catalogue, &left, number).is_some_and(|next| next < LESS * effort.tolerance) {
                lowered.push(number);
                count += 1;
            }
            if narrowed.beside.is_some_and(|way| catalogue.add_way(way)) {
                // The new one is narrowed further where this one is.
                for (_, later) in rounds
                    .iter_mut()
                    .filter(|(_, later)| later.contains(&number))
                {
                    later.push(left.len());
                    count += 1;
                }
                left.push(left[number]);
                most.push(f64::INFINITY);
            }
        }
        joined::take_over_chains(&problem.space, catalogue, LEAST_GAIN * depth);
        if !lowered.is_empty() {
            rounds.push_front((width, lowered));
        }
    }
    raise(&certifier, catalogue, &most);
    // Barriers added meanwhile are sorted in.
    catalogue.barriers.order_by_key(|barrier| barrier.from);
    Ok(Certified {
        cells: certifier.assessed(),
        ended,
    })
}

/// Raises lower bounds to what follows from everything proved, including later proofs, but not
/// above the limit `most` (J) of each barrier.
fn raise(certifier: &Certifier, catalogue: &mut Catalogue, most: &[f64]) {
    for (number, most) in most.iter().enumerate() {
        let barrier = &catalogue.barriers[number];
        let (Some(lower), Some((start, to, _))) = (barrier.bounds.lower, ends(catalogue, barrier))
        else {
            continue;
        };
        let follows = certifier.proved(&start, &to).min(*most);
        catalogue.barriers[number].bounds.lower = Some(lower.max(follows));
    }
}

/// The result of narrowing the bounds of a barrier.
struct Narrowed {
    /// Cells that it took.
    cells: usize,
    /// The barrier to another place that was found to be lower, if any.
    beside: Option<Barrier>,
    /// Largest allowed lower bound (J).
    most: f64,
}

/// Narrows the bounds of a barrier, those of an escape over all ways out.
fn narrow(
    problem: &Problem,
    certifier: &mut Certifier,
    catalogue: &mut Catalogue,
    number: usize,
    effort: &Effort,
) -> Narrowed {
    let mut narrowed = Narrowed {
        cells: 0,
        beside: None,
        most: f64::INFINITY,
    };
    let bend = BEND * problem.depth();
    let barrier = &catalogue.barriers[number];
    let (Place::State(from), Some((start, to, known))) = (barrier.from, ends(catalogue, barrier))
    else {
        return narrowed;
    };
    let escape = escapes::bracket(problem, certifier, catalogue, (barrier, &known), effort);
    let barrier = &mut catalogue.barriers[number];
    if let Some((escape, found)) = escape {
        narrowed.cells = escape.cells;
        match found {
            None if !escape.improved => {
                barrier.bounds.tighten(escape.bounds);
                return narrowed;
            }
            // There is a lower path that cannot be reported: the escape is not higher than it.
            None => narrowed.most = escape.bounds.lower.unwrap_or(f64::NEG_INFINITY),
            Some(way) if way.to == barrier.to => {
                take_over(problem, barrier, &escape, bend);
                return narrowed;
            }
            Some(way) if !barrier.has_way() && catalogue.bound_state != Some(from) => {
                *barrier = way;
                return narrowed;
            }
            way => narrowed.beside = way,
        }
    }
    if let Ok(bracket) = certifier.bracket(&start, &to, &known, effort) {
        narrowed.cells += bracket.cells;
        take_over(problem, barrier, &bracket, bend);
    }
    barrier.bounds.lower = barrier.bounds.lower.map(|lower| lower.min(narrowed.most));
    narrowed
}

/// The start and end of a barrier's paths, and the known path including its end.
fn ends(
    catalogue: &Catalogue,
    barrier: &Barrier,
) -> Option<(Configuration, End, Vec<Configuration>)> {
    let Place::State(from) = barrier.from else {
        return None;
    };
    let to = match barrier.to {
        Place::State(to) => End::At(catalogue.states[to].configuration),
        Place::Free => End::Free,
    };
    let mut known: Vec<Configuration> = barrier.pathway.iter().map(|p| p.configuration).collect();
    if let End::At(to) = to
        && known.last().is_some_and(|last| *last != to)
    {
        known.push(to);
    }
    Some((catalogue.states[from].configuration, to, known))
}

fn take_over(problem: &Problem, barrier: &mut Barrier, bracket: &Bracket, bend: f64) {
    barrier.bounds.tighten(bracket.bounds);
    // In place of a pathway that could not be proved the certificate's own may lie higher.
    let lower = |upper: &f64| bracket.improved && *upper < barrier.saddle_energy;
    let Some(upper) = bracket.bounds.upper.filter(lower) else {
        return;
    };
    if let Some(pathway) = shortest(problem, &bracket.pathway, upper, bend) {
        barrier.lead_along(pathway);
    }
}

/// A pathway of the certificate, which leads through the middles of its cells, shortened, if it
/// does not rise above `upper` (J).
fn shortest(problem: &Problem, points: &[Configuration], upper: f64, bend: f64) -> Option<Pathway> {
    let limits = Limits::below(upper, problem);
    let direct = pathway::shortened(problem, points, &limits);
    let mut pathways = [direct.as_slice(), points]
        .into_iter()
        .map(|points| pathway::of_configurations(problem, points, bend));
    pathways.find(|pathway| highest_point(pathway).is_some_and(|highest| highest.energy <= upper))
}
