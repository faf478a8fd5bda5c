//! Guesses for minima that the roadmap may have missed: siblings of known minima, faces slid until
//! magnets lie opposite each other, and poses in which the outlines fit.

use ordered_float::OrderedFloat;

use super::{BATCH, Exploration, siblings, slides};
use crate::minimum::{Descent, descend_among};
use crate::roadmap::Point;
use tiles::configuration::Configuration;
use tiles::observer::Observer;
use tiles::order::Order;
use tiles::parallel;
use tiles::problem::Problem;

/// No minimum is searched closer than this (m) to a known one.
const KNOWN: f64 = 1e-4;
/// Number of longest contacts of the outlines that are tried.
const MOST_MATCHES: usize = 100;
/// Number of contacts tried for each kind of states to be kept, lowest first.
const MEETINGS_A_KIND: usize = 3;
/// Contacts shallower than this share of the bond's depth hold nothing.
const LEAST_DEPTH: f64 = 1e-3;
/// With very many magnets, contacts this close to a lower one (in pitches) are skipped.
const AROUND: f64 = 0.75;

impl Exploration<'_> {
    /// Searches minima at the siblings of known ones (except for the first few), on other pairs of
    /// faces and mirrored, until there are no more.
    pub(super) fn find_siblings(&mut self, mut known: usize, observer: &dyn Observer) {
        while known < self.states.len() {
            // Copies have the same siblings.
            let is_asked = |number: usize| {
                !self.problem.has_many_copies() || self.states[number].class == number
            };
            let fresh = (known..self.states.len()).filter(|number| is_asked(*number));
            let fresh = fresh.map(|number| {
                let Point { q, energy, .. } = self.states[number].minimum.point;
                (q, energy)
            });
            let fresh = fresh.filter(|(_, energy)| self.is_followed(*energy));
            let fresh: Vec<(Configuration, f64)> = fresh.collect();
            known = self.states.len();
            self.look_near(siblings::siblings(self.problem, &fresh), observer);
        }
    }

    /// Searches minima along sliding faces, and where the outlines are in contact along much of
    /// their length, on faces or elsewhere.
    pub(super) fn find_meetings(&mut self, observer: &dyn Observer) {
        let problem = self.problem;
        let known = self.states.len();
        let held = -LEAST_DEPTH * problem.depth();
        let slid = slides::slid_meetings(problem);
        let places = slid.into_iter().chain(problem.matches(MOST_MATCHES));
        let places: Vec<Configuration> = places.collect();
        let mut places: Vec<(f64, Configuration)> = parallel::flat_map(&places, |q| {
            let energy = problem.energy(q);
            (energy < held && problem.is_free(q)).then_some((energy, *q))
        });
        if problem.is_expensive() {
            places = lowest_around(problem, places, AROUND * slides::pitch(problem));
            let most = self
                .settings
                .most_kinds
                .map(|kinds| MEETINGS_A_KIND * kinds);
            places.truncate(most.unwrap_or(usize::MAX));
        }
        let places = places.into_iter().map(|(_, q)| q).collect();
        self.look_near(places, observer);
        self.find_siblings(known, observer);
    }

    /// Descends from configurations that are not near known minima.
    fn look_near(&mut self, places: Vec<Configuration>, observer: &dyn Observer) {
        let places: Vec<Configuration> = places
            .into_iter()
            .filter(|q| self.state_at(q, self.problem.scaled(KNOWN)).is_none())
            .collect();
        let verified = self.known();
        for (turn, some) in places.chunks(BATCH).enumerate() {
            observer.part("states like those found", turn * BATCH, places.len());
            let descents: Vec<Descent> =
                parallel::map(some, |q| descend_among(self.problem, q, &verified));
            for descent in &descents {
                if let Some(end) = self.arrive(descent) {
                    self.join(end);
                }
            }
        }
    }
}

/// The configurations without a lower one within `radius` (m, metric of the space), lowest first.
fn lowest_around(
    problem: &Problem,
    mut places: Vec<(f64, Configuration)>,
    radius: f64,
) -> Vec<(f64, Configuration)> {
    places.order_by_key(|(energy, _)| OrderedFloat(*energy));
    let mut kept: Vec<(f64, Configuration)> = Vec::new();
    for place in places {
        let is_near = |(_, q): &(f64, Configuration)| problem.space.distance(q, &place.1) < radius;
        if !kept.iter().any(is_near) {
            kept.push(place);
        }
    }
    kept
}
