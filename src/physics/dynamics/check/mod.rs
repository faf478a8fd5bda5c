//! A check of barriers that is independent of the roadmap: trajectories of moving tiles must not
//! contradict them.
//!
//! A barrier says: every free path from a state to another place reaches at least the saddle's
//! energy. A tile without drag keeps its energy, so one that starts in the state's basin with less
//! total energy (kinetic and potential) than that never gets to the other place, wherever knocks
//! and turns take it. For each barrier three things are tried:
//!
//! - **Below.** Many trajectories with less total energy than the barrier's certified lower bound
//!   ([`Below`]); none may cross. So that this could fail at all, some more start with as much
//!   energy too much and are counted too ([`BarrierCheck::above`]).
//! - **Sides.** Released at rest on the pathway before and behind the saddle, just below what is
//!   certified, with light drag, the tile ends where the pathway comes from and where it leads
//!   ([`Side`]).
//! - **Kick.** The least of a ladder of kicks along the pathway's beginning that throws the tile
//!   out has at least the barrier's energy ([`BarrierCheck::kick`]).
//!
//! # What counts as below, and what as free
//!
//! Energy alone does not tell on which side of a barrier a configuration lies, and `free` is no
//! level of energy: tiles just out of each other's reach still attract or repel by some µJ, so a
//! barrier to `free` may lie below 0 and below the energy of far configurations. Therefore
//!
//! - a start lies on the pathway before it first reaches the start's total energy, so that it is
//!   joined to the state by a free path below the barrier: it lies in the basin, not merely low;
//! - `free` is the set that the roadmap and the certificate mean by it, the configurations whose
//!   reference points are at least [`free_distance`](crate::ConfigurationSpace::free_distance)
//!   apart; a trajectory crosses when it enters that set, with whatever energy;
//! - another state is entered when overdamped motion leads from the tile's configuration into its
//!   minimum, which is a path that nowhere climbs (asked where a rough descent leads there too);
//! - the rim keeps the reference point on the table, as in the certificate, and each knock takes
//!   energy away, never adds any. A trajectory that the integration's error lifts to the barrier
//!   proves nothing: it is counted as spoilt and replaced by another one.
//!
//! With these definitions a crossing is a path below the lower bound: either the bound or this
//! simulation is wrong. Where a barrier has no certified bound, trajectories stay below its saddle
//! energy less the fraction to which it was settled, and a crossing only shows that the estimate
//! was too high ([`BarrierCheck::is_overestimated`]).

mod checker;

use super::{Body, Motion};
use crate::configuration::Configuration;
use crate::landscape::minimum::{Known, learn};
use crate::landscape::{Barrier, Place, State};
use crate::parallel;
use crate::problem::Problem;
use crate::units::si;
use checker::Checker;

/// Slow motions followed from each pathway, at most.
const SLOW: usize = 16;

/// What the check does.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckSettings {
    /// Of all random numbers.
    pub seed: u64,
    /// Trajectories below each barrier.
    pub runs: usize,
    /// Trajectories above each barrier.
    pub controls: usize,
    /// Share of a barrier by which its saddle energy may be too high where it is not certified.
    pub settled: f64,
}

impl Default for CheckSettings {
    fn default() -> Self {
        Self {
            seed: 1,
            runs: 1000,
            controls: 100,
            settled: 0.005,
        }
    }
}

/// Trajectories with less total energy than a barrier.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Below {
    /// How many there were.
    pub runs: usize,
    /// How many of them crossed.
    pub crossed: usize,
    /// How many more proved nothing, lifted over the barrier by the integration's error.
    pub spoilt: usize,
    /// The start of one that crossed.
    pub example: Option<Motion>,
}

/// Where a trajectory from one side of a saddle ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Side {
    /// `None` for no reported state, and where the integration's error lifted the tile over the
    /// ceiling.
    pub ended: Option<Place>,
    /// How the end fits the pathway.
    pub verdict: SideVerdict,
}

/// Whether that is where the pathway comes from, or leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SideVerdict {
    /// At the pathway's end on this side, or in a state that it passes on the way there.
    OnThePathway,
    /// In another place. From there the saddle is no lower: nothing is refuted.
    Elsewhere,
    /// At the pathway's other end, which lies behind the barrier. (States that it passes on the way
    /// there need not: there may be a lower way to them.)
    Opposite,
}

/// What moving tiles say of one barrier.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct BarrierCheck {
    /// The state that the pathway leaves.
    pub from: Place,
    /// The state that it leads to, or free tiles.
    pub to: Place,
    /// The energy (J) that trajectories stayed below: the barrier's certified lower bound, or the
    /// saddle energy less what it may be off. Infinite where the state is proved caged.
    pub ceiling: f64,
    /// Whether the ceiling is a certified bound, not an estimate.
    pub certified: bool,
    /// Trajectories with less energy than the ceiling.
    pub below: Below,
    /// Trajectories that crossed with 0.1 to 2 barriers more energy than the pathway needs, and how
    /// many there were.
    pub above: (usize, usize),
    /// From before and from behind the saddle. `None` if that is not asked: behind a saddle to
    /// `free`, which may lie where the tiles part, with no slope behind it.
    pub sides: [Option<Side>; 2],
    /// Least energy (J) among those tried that kicked the tile out along the pathway; `None` if
    /// none did, up to eight times the barrier.
    pub kick: Option<f64>,
    /// What the kick is held against (J): the ceiling, seen from the start.
    pub climb: f64,
    /// Steps of all its trajectories.
    pub steps: usize,
}

impl BarrierCheck {
    /// Whether trajectories below the barrier crossed it.
    pub fn is_crossed(&self) -> bool {
        self.below.crossed > 0
    }

    /// Whether a kick of less energy than the barrier threw the tile out.
    pub fn is_kicked_over(&self) -> bool {
        self.kick.is_some_and(|kick| kick < self.climb)
    }

    /// Whether a trajectory from one side of the saddle ended on the other.
    pub fn is_swapped(&self) -> bool {
        let opposite = |side: &Side| side.verdict == SideVerdict::Opposite;
        self.sides.iter().flatten().any(opposite)
    }

    /// Whether any of these is so.
    pub fn is_refuted(&self) -> bool {
        self.is_crossed() || self.is_kicked_over() || self.is_swapped()
    }

    /// Whether what is proved of the barrier is refuted: either the proof or the simulation is
    /// wrong.
    pub fn is_contradicted(&self) -> bool {
        self.certified && self.is_refuted()
    }

    /// Whether an estimate, of which nothing is proved, is refuted: a lower way was found.
    pub fn is_overestimated(&self) -> bool {
        !self.certified && self.is_refuted()
    }

    /// What refutes the barrier, told loudly where it is a proof that is contradicted.
    pub fn describe(&self) -> String {
        let name = |place| match place {
            Place::State(id) => format!("state {id}"),
            Place::Free => "free".to_owned(),
        };
        let ceiling = si(self.ceiling, "J", 4);
        let claim = match self.certified {
            _ if self.ceiling.is_infinite() => "proved to have no path over it".to_owned(),
            true => format!("certified to be above {ceiling}"),
            false => format!("estimated to be above {ceiling}"),
        };
        let mut found = Vec::new();
        if self.is_crossed() {
            let Below { crossed, runs, .. } = self.below;
            found.push(format!("{crossed} of {runs} trajectories below it crossed"));
        }
        if let Some(kick) = self.kick.filter(|_| self.is_kicked_over()) {
            let [kick, climb] = [kick, self.climb].map(|energy| si(energy, "J", 4));
            found.push(format!(
                "a kick of {kick} threw the tile over it, less than {climb}"
            ));
        }
        if self.is_swapped() {
            found.push("from beside the saddle a tile ended on the other side".to_owned());
        }
        let verdict = if self.certified {
            "CONTRADICTION"
        } else {
            "estimate too high"
        };
        format!(
            "{verdict}: the barrier from {} to {}, {claim}: {}",
            name(self.from),
            name(self.to),
            found.join("; ")
        )
    }
}

/// Checks the barriers that lead out of a state: those with a pathway, and those proved to be
/// without one. `done` is told after each how many are done, of how many.
///
/// The same arguments give the same result on any number of threads. A trajectory below a barrier
/// takes some hundred steps: the way of 15 cm at the speed of a tile with the barrier's energy, in
/// steps of at most 0.5 mm.
pub fn check(
    problem: &Problem,
    body: Body,
    states: &[State],
    barriers: &[&Barrier],
    settings: &CheckSettings,
    done: &(dyn Fn(usize, usize) + Sync),
) -> Vec<BarrierCheck> {
    let chosen: Vec<(usize, &Barrier)> = barriers
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, barrier)| is_checkable(barrier))
        .collect();
    let known = slides_below(problem, states, &chosen);
    let checked = std::sync::atomic::AtomicUsize::new(0);
    parallel::map(&chosen, |&(number, barrier)| {
        let checker = Checker::new(problem, body, (states, &known), barrier, settings);
        let check = checker.check(settings.seed.wrapping_add(number as u64));
        let before = checked.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        done(before + 1, chosen.len());
        check
    })
}

/// The ways on which slow motion leads down from the pathways: trajectories end on the same ones.
fn slides_below(problem: &Problem, states: &[State], barriers: &[(usize, &Barrier)]) -> Known {
    let mut known = Known::minima(states.iter().map(|state| state.configuration));
    let points = barriers.iter().flat_map(|(_, barrier)| {
        let every = barrier.pathway.len().div_ceil(SLOW).max(1);
        barrier.pathway.iter().step_by(every)
    });
    let starts: Vec<Configuration> = points.map(|point| point.configuration).collect();
    learn(problem, &starts, &mut known);
    known
}

fn is_checkable(barrier: &Barrier) -> bool {
    matches!(barrier.from, Place::State(_))
        && (barrier.bounds.caged || (barrier.pathway.len() > 1 && barrier.forward() > 0.0))
}
