//! Pathways into states from far apart along overdamped motion, which never climbs.

use std::collections::HashMap;

use super::Exploration;
use crate::minimum::{Outcome, approach, descend_among};
use crate::roadmap::Point;
use crate::stationary::Stationary;
use tiles::configuration::Configuration;
use tiles::parallel;

/// Number of paths followed into one state.
const FOLLOWED: usize = 3;
/// Number of paths followed into the bound configuration, one of which is the docking motion.
const FOLLOWED_INTO_BOND: usize = 12;
/// A start that is known to end this close (m, metric of the space) to a state ends in it.
const SAME: f64 = 1e-4;
/// So close (m, metric of the space) to the bound configuration a state is the bond.
const BOUND: f64 = 5e-3;

impl Exploration<'_> {
    /// Adds minima below an energy (J) in which far starts are known to end and that are not yet
    /// states.
    pub fn add_rests(&mut self, ends: &[Option<Configuration>], below: f64) {
        let same = self.problem.scaled(SAME);
        let is_new = |end: &&Configuration| self.state_at(end, same).is_none();
        let new: Vec<&Configuration> = ends.iter().flatten().filter(is_new).collect();
        let known = self.known();
        let found: Vec<Stationary> = parallel::flat_map(&new, |end| {
            match descend_among(self.problem, end, &known).outcome {
                Outcome::Minimum(found) if found.point.energy < below => Some(*found),
                _ => None,
            }
        });
        if !found.is_empty() {
            self.add(&found);
        }
    }

    /// Adds the descents of some far starts, each given with its known end, to the network: the
    /// first ones of those that end in a state.
    pub fn add_arrivals(&mut self, far: &[(Configuration, Configuration)]) {
        let problem = self.problem;
        let mut followed: HashMap<usize, usize> = HashMap::new();
        let wanted = |(_, end): &&(Configuration, Configuration)| {
            let Some(state) = self.state_at(end, problem.scaled(SAME)) else {
                return false;
            };
            let count = followed.entry(state).or_default();
            *count += 1;
            *count <= self.most_followed(state)
        };
        let starts: Vec<Configuration> =
            far.iter().filter(wanted).map(|(start, _)| *start).collect();
        let known = self.known();
        let descents: Vec<_> = parallel::map(&starts, |q| approach(problem, q, &known));
        for mut descent in descents {
            // Configurations behind it are free as well.
            let is_far = |point: &Point| problem.space.is_far(&point.q);
            let last = descent.way.iter().rposition(is_far);
            let (Some(last), Outcome::Minimum(_)) = (last, &descent.outcome) else {
                continue;
            };
            descent.way.drain(..last);
            let Some(end) = self.arrive(&descent) else {
                continue;
            };
            let first = descent.way[0];
            let node = self.network.add_node(Some((first.q, first.energy)));
            self.network.add_same(node, self.free, first.energy);
            self.network.add_way(node, end, descent.way);
        }
        self.network.span();
    }

    fn most_followed(&self, state: usize) -> usize {
        let problem = self.problem;
        let q = self.states[state].minimum.point.q;
        if problem.distance_to_bond(&q) < problem.scaled(BOUND) {
            FOLLOWED_INTO_BOND
        } else {
            FOLLOWED
        }
    }
}
