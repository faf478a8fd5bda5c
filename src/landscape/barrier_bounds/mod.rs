//! Certified bounds for the barriers of a catalogue.

mod escapes;
mod joined;
mod narrowing;
mod schedule;

use std::collections::VecDeque;

use super::catalogue::{Catalogue, LEAST_GAIN};
use super::minimax::{Certifier, Effort, Goal, Question};
use super::results::{Barrier, Place, StateKind, Uncertified};
use tiles::budget::{Allowance, Ended};
use tiles::configuration::Configuration;
use tiles::observer::Observer;
use tiles::order::Order;
use tiles::problem::Problem;

pub use schedule::widths;

/// Bounds are narrowed once more if the requested width has shrunk to this fraction.
const LESS: f64 = 0.75;

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
#[serde(rename_all = "kebab-case")]
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
    /// The effort spent, in core-seconds as it is counted.
    pub work: f64,
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
        // The effort for a barrier's bounds, if they are to be narrowed.
        let effort = |catalogue: &Catalogue, left: &[usize], number: usize| {
            let barrier = &catalogue.barriers[number];
            let wanted = schedule::wanted(barrier, settings, depth);
            let is_done = barrier.bounds.width() <= width.max(wanted) || left[number] == 0;
            (!is_done).then(|| Effort {
                tolerance: schedule::step(width, wanted, settings),
                cells: left[number],
            })
        };
        let open: Vec<(usize, Effort)> = numbers
            .iter()
            .filter_map(|&number| Some((number, effort(catalogue, &left, number)?)))
            .collect();
        done += numbers.len() - open.len();
        if let Some(over) = certifier.ended() {
            ended = ended.or((!open.is_empty()).then_some(over));
            continue;
        }
        let answered = |more: usize| observer.part("certificate", done + more, count);
        answered(0);
        let narrowed = narrowing::narrow(problem, &mut certifier, catalogue, &open, &answered);
        done += open.len();
        // Barriers that turned out so much lower that narrower bounds are requested.
        let mut lowered = Vec::new();
        for ((number, before), narrowed) in open.into_iter().zip(narrowed) {
            let is_reached = catalogue.barriers[number].bounds.width() <= before.tolerance;
            let is_cut_short = !is_reached && certifier.ended().is_some();
            if is_cut_short {
                ended = certifier.ended();
                most[number] = most[number].min(narrowed.most);
            } else {
                most[number] = narrowed.most;
            }
            let unspent = left[number].saturating_sub(narrowed.cells);
            left[number] = schedule::cells_left(unspent, is_reached, settings);
            if effort(catalogue, &left, number)
                .is_some_and(|next| next.tolerance < LESS * before.tolerance)
            {
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
        work: certifier.spent_of(settings.allowed),
        ended,
    })
}

/// Raises lower bounds to what follows from everything proved, including later proofs, but not
/// above the limit `most` (J) of each barrier.
fn raise(certifier: &Certifier, catalogue: &mut Catalogue, most: &[f64]) {
    for (number, most) in most.iter().enumerate() {
        let barrier = &catalogue.barriers[number];
        let (Some(lower), Some((from, to))) = (barrier.bounds.lower, ends(catalogue, barrier))
        else {
            continue;
        };
        let follows = certifier.proved(&from, &to).min(*most);
        catalogue.barriers[number].bounds.lower = Some(lower.max(follows));
    }
}

/// The question of a barrier's bounds, with its known pathway.
fn question(catalogue: &Catalogue, barrier: &Barrier, effort: &Effort) -> Option<Question> {
    let (from, to) = ends(catalogue, barrier)?;
    let mut known: Vec<Configuration> = barrier.pathway.iter().map(|p| p.configuration).collect();
    let end = to.places.first();
    known.extend(end.filter(|end| known.last().is_some_and(|last| last != *end)));
    Some(Question {
        from,
        to,
        known,
        effort: *effort,
    })
}

/// The start and end of a barrier's paths; `None` for what comes from `free`.
fn ends(catalogue: &Catalogue, barrier: &Barrier) -> Option<(Configuration, Goal)> {
    let Place::State(from) = barrier.from else {
        return None;
    };
    let to = match barrier.to {
        Place::State(to) => Goal::at(catalogue.states[to].configuration),
        Place::Free => Goal::free(),
    };
    Some((catalogue.states[from].configuration, to))
}
