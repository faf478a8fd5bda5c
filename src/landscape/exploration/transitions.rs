//! Transition states between states, and the ways down from them on both sides.

use std::collections::HashSet;

use nalgebra::Vector3;

use super::copies::distinct;
use super::{BATCH, Exploration, SAME};
use crate::constrained;
use crate::minimum::{Descent, Known, descend_among};
use crate::roadmap::Point;
use crate::stationary::{self, Stationary};
use crate::transition_network::Merge;
use tiles::configuration::Configuration;
use tiles::observer::Observer;
use tiles::parallel;
use tiles::problem::{Problem, Symmetry};

/// How far (m, mass metric) from a transition state its descents start.
const OFF_SADDLE: f64 = 2e-4;

impl Exploration<'_> {
    /// Searches the transition states of passes and adds those found, with their symmetric images.
    pub(super) fn polish(
        &mut self,
        open: &[Merge],
        tried: &mut HashSet<usize>,
        observer: &dyn Observer,
    ) {
        let places: Vec<(Configuration, Vector3<f64>)> = open
            .iter()
            .filter(|merge| tried.insert(merge.link))
            .filter_map(|merge| self.meeting_place(merge.link))
            .collect();
        self.add_transition_states_near(&places, &self.problem.symmetries, observer);
    }

    /// Searches transition states near some configurations, each given with its direction of
    /// passage, and adds those found, with their symmetric images.
    pub fn add_transition_states_near(
        &mut self,
        places: &[(Configuration, Vector3<f64>)],
        symmetries: &[Symmetry],
        observer: &dyn Observer,
    ) {
        let problem = self.problem;
        let near = |(q, along): &(Configuration, Vector3<f64>)| {
            stationary::transition_state(problem, q, along)
                .filter(|found| problem.is_free(&found.point.q))
        };
        let tell = |done| observer.part("transition states", done, places.len());
        let found = parallel::map_in_batches(places, BATCH, tell, near);
        let mut known: Vec<Configuration> =
            self.transition_states.iter().map(|s| s.0.point.q).collect();
        let mut fresh: Vec<Stationary> = Vec::new();
        for found in found.into_iter().flatten() {
            let is_same = |q: &Configuration| {
                problem.space.distance(q, &found.point.q) <= problem.scaled(SAME)
            };
            if !known.iter().any(is_same) {
                known.extend(symmetries.iter().map(|s| s.apply(&found.point.q)));
                fresh.push(found);
            }
        }
        let known = self.known();
        let joined: Vec<[Option<Descent>; 2]> = parallel::map(&fresh, |saddle| {
            [1.0, -1.0].map(|sign| off_saddle(problem, saddle, sign, &known))
        });
        for (saddle, sides) in fresh.into_iter().zip(joined) {
            let [Some(first), Some(second)] = sides else {
                continue;
            };
            for symmetry in distinct(problem, symmetries, &saddle.point.q) {
                let sides = [&first, &second].map(|side| side.image(symmetry));
                self.add_transition_state(saddle.image(symmetry), sides);
            }
        }
    }

    fn add_transition_state(&mut self, saddle: Stationary, [first, second]: [Descent; 2]) {
        let ends = [&first, &second].map(|side| self.arrive(side));
        let [Some(from), Some(to)] = ends else {
            return;
        };
        let mut way: Vec<Point> = first.way;
        way.reverse();
        way.push(saddle.point);
        way.extend(second.way);
        let link = self.network.add_way(from, to, way);
        self.transition_states.push((saddle, link));
    }

    /// The highest configuration of a link and the direction of the link there.
    pub(super) fn meeting_place(&self, number: usize) -> Option<(Configuration, Vector3<f64>)> {
        let q = self.network.peak_configuration(number)?;
        let along = match self.network.way(number) {
            Some(points) => points.first()?.q.step_to(&points.last()?.q),
            None => {
                let link = &self.network.links[number];
                let [a, b] = [link.from, link.to].map(|node| self.network.nodes[node as usize]);
                a?.0.step_to(&b?.0)
            }
        };
        Some((q, along))
    }
}

/// The descent from a transition state to one of its sides.
fn off_saddle(problem: &Problem, saddle: &Stationary, sign: f64, known: &Known) -> Option<Descent> {
    let unstable = saddle.modes.first()?.1;
    let aim = saddle
        .point
        .q
        .moved(unstable * (sign * problem.scaled(OFF_SADDLE)));
    let start = constrained::settle(problem, &aim, problem.scaled(OFF_SADDLE))?;
    let descent = descend_among(problem, &start, known);
    (descent.way[0].energy <= saddle.point.energy).then_some(descent)
}
