//! Ways out of regions where no single step leads downhill from every configuration: proved
//! pathways to minima.

use std::sync::Arc;

use ordered_float::OrderedFloat;

use crate::bounded::{A_STEP, Bounded};
use crate::minimax::upper::Sharpening;
use crate::minimum::{Outcome, descend};
use crate::stationary::Stationary;
use tiles::budget::Budget;
use tiles::configuration::Configuration;
use tiles::order::Order;
use tiles::parallel;
use tiles::problem::Problem;

/// Two minima closer than this (m, metric of the space) are the same.
pub(super) const SAME: f64 = 1e-5;
/// A descent that got stuck this close (m) to a minimum is continued into it: where corners of both
/// tiles meet, the last verification may fail nearby.
const STUCK: f64 = 1e-4;
/// Number of exits tried from one place.
const TRIED: usize = 3;
/// Number of descents made together, before the remaining places try their starts as exits; and of
/// places that try these together, between two checks of the remaining effort.
const BATCH: usize = 16;
const JOINED: usize = 256;
/// Units of work to measure the distance to an exit.
const AN_EXIT: u64 = 4;
/// A pathway's bound exceeds its highest energy by at most this fraction of the allowed rise.
pub(super) const SHARP: f64 = 0.1;
/// Units of work after which the bound of a pathway stays as it is; for very many magnets at least
/// what so many cells take.
const MOST_WORK: u64 = 1 << 24;
const LEAST_CELLS: u64 = 512;

/// A wholly free box about `at`, to which a step leads from all of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Opened {
    pub at: Configuration,
    /// The lowest energy (J) in the cell.
    pub lowest: f64,
}

/// A minimum, as the search needs it.
#[derive(Clone, Debug)]
pub(super) struct Ending {
    pub minimum: Stationary,
    /// Highest energy (J) on the proved path on to a listed state, if it is known not to be listed
    /// itself; minus infinity otherwise.
    pub beyond: f64,
    /// Whether the survey had not found it.
    pub is_new: bool,
}

/// Where a pathway to a minimum starts.
struct Exit {
    at: Configuration,
    /// Proved highest energy (J) on the path, up to a listed state if the minimum is known not to
    /// be listed.
    highest: f64,
    ending: usize,
}

/// The known exits, and the minima in which they end.
pub(super) struct Exits<'a> {
    problem: &'a Problem,
    pub bounded: Arc<Bounded<'a>>,
    pub rise: f64,
    exits: Vec<Exit>,
    pub endings: Vec<Ending>,
}

impl<'a> Exits<'a> {
    pub fn new(
        problem: &'a Problem,
        bounded: Arc<Bounded<'a>>,
        rise: f64,
        known: impl Iterator<Item = Stationary>,
    ) -> Self {
        let ending = |minimum| Ending {
            minimum,
            beyond: f64::NEG_INFINITY,
            is_new: false,
        };
        Self {
            problem,
            bounded,
            rise,
            exits: Vec::new(),
            endings: known.map(ending).collect(),
        }
    }

    /// For each place, the ending to which a path is proved, as far as the budget leads.
    pub fn find(&mut self, places: &[Opened], budget: &mut Budget) -> Vec<Option<usize>> {
        let mut found = vec![None; places.len()];
        let mut left: Vec<usize> = (0..places.len()).collect();
        let mut first = 0;
        while !left.is_empty() {
            for few in left.chunks(JOINED) {
                if self.is_over(budget) {
                    return found;
                }
                let joined = parallel::map(few, |&k| self.join(&places[k], first));
                for (&k, ending) in few.iter().zip(joined) {
                    found[k] = ending;
                }
            }
            left.retain(|&k| found[k].is_none());
            if self.is_over(budget) {
                break;
            }
            first = self.exits.len();
            let rest = left.split_off(left.len().min(BATCH));
            let ways = parallel::map(&left, |&k| self.descent(&places[k]));
            for (&k, way) in left.iter().zip(ways) {
                let Some((minimum, highest)) = way else {
                    continue;
                };
                let ending = self.ending(minimum);
                let highest = highest.max(self.endings[ending].beyond);
                if highest <= places[k].lowest + self.rise {
                    self.exits.push(Exit {
                        at: places[k].at,
                        highest,
                        ending,
                    });
                    found[k] = Some(ending);
                }
            }
            left = rest;
        }
        found
    }

    /// Whether nothing is left of a budget that pays for what was done.
    pub fn is_over(&self, budget: &mut Budget) -> bool {
        self.bounded.pay(budget);
        budget.ended().is_some()
    }

    /// Extends all exits to an ending by a path over this energy (J).
    pub fn lead_on(&mut self, ending: usize, beyond: f64) {
        self.endings[ending].beyond = beyond;
        for exit in self.exits.iter_mut().filter(|exit| exit.ending == ending) {
            exit.highest = exit.highest.max(beyond);
        }
    }

    /// The minimum that a straight motion to one of the exits from number `first` on leads to.
    fn join(&self, place: &Opened, first: usize) -> Option<usize> {
        let highest = place.lowest + self.rise;
        self.bounded
            .count(AN_EXIT * (self.exits.len() - first) as u64);
        let mut near: Vec<(f64, &Exit)> = self.exits[first..]
            .iter()
            .filter(|exit| exit.highest <= highest)
            .map(|exit| (self.problem.space.distance(&place.at, &exit.at), exit))
            .collect();
        near.order_by_key(|(distance, _)| OrderedFloat(*distance));
        near.truncate(TRIED);
        let leads_there = |exit: &&Exit| self.prove(&[place.at, exit.at], highest).is_some();
        let exit = near.into_iter().map(|(_, exit)| exit).find(leads_there);
        exit.map(|exit| exit.ending)
    }

    /// The minimum in which a descent ends, and the proved highest energy (J) on the path.
    fn descent(&self, place: &Opened) -> Option<(Stationary, f64)> {
        let descent = descend(self.problem, &place.at);
        let a_step = A_STEP + self.bounded.work();
        self.bounded.count(descent.steps as u64 * a_step);
        let mut way: Vec<Configuration> = descent.way.iter().map(|point| point.q).collect();
        let minimum = match descent.outcome {
            Outcome::Minimum(minimum) => *minimum,
            Outcome::Stuck(q) => {
                let beside = self.near(&q, self.problem.scaled(STUCK))?;
                self.endings[beside].minimum.clone()
            }
            Outcome::Free => return None,
        };
        way.push(minimum.point.q);
        let highest = self.prove(&way, place.lowest + self.rise)?;
        Some((minimum, highest))
    }

    /// The proved highest energy (J) of a pathway, if it is not above `allowed`.
    pub fn prove(&self, way: &[Configuration], allowed: f64) -> Option<f64> {
        let mut sharpening = Sharpening {
            tolerance: SHARP * self.rise,
            give_up: allowed,
            work: MOST_WORK.max(LEAST_CELLS * self.bounded.work()),
        };
        let proved = self.bounded.prove(way, &mut sharpening);
        proved.ok().map(|proved| proved.upper)
    }

    /// The known minimum within `distance` (m) of a configuration or of one of its images.
    fn near(&self, q: &Configuration, distance: f64) -> Option<usize> {
        let images: Vec<Configuration> =
            self.problem.symmetries.iter().map(|s| s.apply(q)).collect();
        let is_near = |ending: &Ending| {
            let at = &ending.minimum.point.q;
            images
                .iter()
                .any(|q| self.problem.space.distance(q, at) <= distance)
        };
        self.endings.iter().position(is_near)
    }

    fn ending(&mut self, minimum: Stationary) -> usize {
        self.near(&minimum.point.q, self.problem.scaled(SAME))
            .unwrap_or_else(|| {
                self.endings.push(Ending {
                    minimum,
                    beyond: f64::NEG_INFINITY,
                    is_new: true,
                });
                self.endings.len() - 1
            })
    }
}
