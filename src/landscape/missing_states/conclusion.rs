//! The proved statement about a list of states.

use std::collections::{BTreeSet, HashSet};

use super::exits::{SAME, SHARP};
use super::search::{Queue, StateSearch, push};
use super::{Completeness, OpenRegion, regions};
use crate::catalogue::Catalogue;
use crate::exploration::Exploration;
use crate::minimax::{Certifier, Effort, Goal, Question};
use crate::pathway;
use crate::results::Uncertified;
use tiles::configuration::Configuration;
use tiles::observer::Silent;

/// Cells spent on finding a way on from a minimum that is not listed.
const CELLS: usize = 50_000;
/// The part of the remaining effort that all of these may take.
const WAYS_ON: f64 = 0.5;

impl<'a> StateSearch<'a> {
    /// The proved statement about the listed states. Minima that are not listed must have a path on
    /// to a listed one, or to `free`. Cells from whose lowest energy this path rises too far are
    /// examined again, because bounds of smaller cells are tighter. All that is left of the effort
    /// may be spent on it.
    pub fn conclude(mut self, survey: &Exploration, listed: &Catalogue) -> Completeness {
        self.budget.give_back(&self.reserve);
        let mut certifier = None;
        let (mut judged, mut closed) = (BTreeSet::new(), Vec::new());
        loop {
            let reached: BTreeSet<usize> = self.explained.iter().map(|cell| cell.2).collect();
            let mut again = Queue::none();
            for ending in reached {
                let at = self.exits.endings[ending].minimum.point;
                if !judged.insert(ending) || listed.holds(self.problem, &at.q) {
                    continue;
                }
                let beyond = self.way_on(survey, listed, ending, &mut certifier);
                let Some(beyond) = beyond else {
                    closed.push(OpenRegion {
                        pose: at.q,
                        volume: 0.0,
                        lowest: at.energy,
                    });
                    continue;
                };
                self.exits.lead_on(ending, beyond);
                let least = beyond - self.exits.rise;
                for (cell, lowest, _) in self
                    .explained
                    .extract_if(.., |cell| cell.2 == ending && cell.1 < least)
                {
                    push(&mut again, cell, lowest);
                }
            }
            if again.is_empty() {
                break;
            }
            self.look_through(again, &Silent);
        }
        if let Some(ways) = certifier.and_then(Result::ok) {
            let budget = ways.into_budget();
            self.budget.give_back(&budget);
        }
        let volume: f64 = self.open.iter().map(|(cell, _)| cell.volume()).sum();
        let mut open = regions::of_cells(&self.problem.space, &self.open);
        open.extend(closed);
        Completeness {
            // An empty sum is minus zero.
            share: volume / self.volume + 0.0,
            below: self.below,
            escape: self.exits.rise,
            open,
            cells: self.cells,
            work: self.budget.spent_of(self.settings.allowed),
            ended: self.ended,
        }
    }

    /// Proved highest energy (J) of a path from a minimum that is not listed to a listed one, or to
    /// `free`, if it does not rise more than allowed: a path known from the survey, or one that the
    /// certificate finds.
    fn way_on(
        &mut self,
        survey: &Exploration,
        listed: &Catalogue,
        ending: usize,
        certifier: &mut Option<Result<Certifier<'a>, Uncertified>>,
    ) -> Option<f64> {
        let problem = self.problem;
        let minimum = self.exits.endings[ending].minimum.point;
        let allowed = minimum.energy + self.exits.rise;
        if self.exits.is_over(&mut self.budget) {
            self.ended = self.ended.or(self.budget.ended());
            return None;
        }
        let known = known_way(survey, listed, &minimum.q).unwrap_or_default();
        self.exits.prove(&known, allowed).or_else(|| {
            let places = listed.states.iter().map(|s| s.configuration).collect();
            let contact = problem.contact.as_ref();
            let bounds = problem.bounds().ok()?;
            let budget = &mut self.budget;
            let certifier = certifier.get_or_insert_with(|| {
                Certifier::with(bounds, contact, &problem.space, budget.share(WAYS_ON))
            });
            let certifier = certifier.as_mut().ok()?;
            let question = Question {
                from: minimum.q,
                to: Goal { places, free: true },
                known,
                effort: Effort {
                    tolerance: SHARP * self.exits.rise,
                    cells: CELLS,
                },
            };
            let way = certifier.answer(&question).ok()?;
            self.ended = self.ended.or(certifier.ended());
            way.bounds.upper.filter(|upper| *upper <= allowed)
        })
    }
}

/// The lowest path of a survey from a minimum to a listed one, or to `free`.
fn known_way(
    survey: &Exploration,
    listed: &Catalogue,
    minimum: &Configuration,
) -> Option<Vec<Configuration>> {
    let problem = survey.problem;
    let from = survey.states[survey.state_at(minimum, problem.scaled(SAME))?].node;
    let is_listed = survey
        .states
        .iter()
        .filter(|state| listed.holds(problem, &state.minimum.point.q));
    let mut goals: HashSet<usize> = is_listed.map(|state| state.node).collect();
    goals.insert(survey.free);
    let depth = problem.depth();
    let scale = [depth, 2e-3 * depth];
    let (_, way) = pathway::lowest(&survey.network, from, [&goals, &goals], scale)?;
    Some(way.iter().map(|point| point.configuration).collect())
}
