//! Where minima may be expected besides where the roadmap has them: siblings of those known, where
//! magnets come to lie opposite each other as faces slide, and where the outlines fit.

use rayon::prelude::*;

use super::{Survey, SurveySettings, siblings, slides};
use crate::configuration::Configuration;
use crate::landscape::constrained::Point;
use crate::landscape::minimum::{Descent, descend_among};
use crate::problem::Problem;

/// No minimum is looked for closer than this (m) to a known one.
const KNOWN: f64 = 1e-4;
/// So many of the outlines' longest contacts are looked at.
const MOST_MATCHES: usize = 100;
/// Meetings are looked at where the energy is below this share of the bond's depth.
const HELD: f64 = 1e-3;

impl Survey {
    /// Looks for minima where those known so far, but for the first few, would be on other pairs of
    /// faces or in the mirror, until there are no more.
    pub(super) fn find_siblings(
        &mut self,
        problem: &Problem,
        mut known: usize,
        settings: &SurveySettings,
    ) {
        while known < self.states.len() {
            let fresh = self.states[known..].iter().map(|state| {
                let Point { q, energy, .. } = state.minimum.point;
                (q, energy)
            });
            let fresh: Vec<(Configuration, f64)> = fresh.collect();
            known = self.states.len();
            self.look_near(problem, siblings::siblings(problem, &fresh), settings);
        }
    }

    /// Looks for minima where faces slide along each other, and where the outlines lie on each other
    /// along much of their length, on faces or elsewhere.
    pub(super) fn find_meetings(&mut self, problem: &Problem, settings: &SurveySettings) {
        let known = self.states.len();
        let held = -HELD * problem.depth();
        let slid = slides::slid_meetings(problem);
        let places = slid.into_iter().chain(problem.matches(MOST_MATCHES));
        let places = places.filter(|q| problem.energy(q) < held && problem.is_free(q));
        self.look_near(problem, places.collect(), settings);
        self.find_siblings(problem, known, settings);
    }

    /// Follows the energy down from places that are not near known minima.
    fn look_near(
        &mut self,
        problem: &Problem,
        places: Vec<Configuration>,
        settings: &SurveySettings,
    ) {
        let places: Vec<Configuration> = places
            .into_iter()
            .filter(|q| self.state_at(problem, q, KNOWN).is_none())
            .collect();
        let verified = self.verified();
        let descents: Vec<Descent> = places
            .par_iter()
            .map(|q| descend_among(problem, q, &verified))
            .collect();
        for descent in &descents {
            if let Some(end) = self.arrive(problem, descent) {
                self.join(problem, end, settings);
            }
        }
    }
}
