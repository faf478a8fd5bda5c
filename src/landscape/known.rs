//! Known ends of motions: verified minima, and earlier motions along the same stretches of contact.
//! On these, contact allows only one direction, so every motion that arrives there continues as the
//! earlier one did.

use std::collections::HashMap;
use std::sync::Arc;

use super::constrained::Heading;
use super::stationary::Stationary;
use tiles::configuration::Configuration;
use tiles::contact::Touch;
use tiles::problem::Problem;

/// A minimum this close (m, metric of the space) to a verified one is the same, found again.
const SAME: f64 = 1e-7;
/// How far (m, metric of the space) a configuration may lie outside a stretch and still count as on
/// it.
const ROUNDING: f64 = 1e-9;

/// Where a descent ended.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// At a minimum.
    Minimum(Box<Stationary>),
    /// The tiles are far apart.
    Free,
    /// No step leads downhill from here, but no minimum could be verified: the accuracy of the
    /// energy is exhausted, or corners of both tiles meet.
    Stuck(Configuration),
}

/// A step of a motion with the same two contacts pressed on at both ends.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// The contacts.
    pub pressed: [Touch; 2],
    /// Its ends, in the motion's order.
    pub ends: [Configuration; 2],
}

impl Stretch {
    /// The step between two configurations, if two contacts leave it no choice. Contacts pressed at
    /// the same time are independent, so two of them leave one of three coordinates free.
    pub fn between(ends: [Configuration; 2], [from, to]: [Option<&Heading>; 2]) -> Option<Self> {
        let [from, to] = [two(from?)?, two(to?)?];
        (from == to).then_some(Self {
            pressed: from,
            ends,
        })
    }

    /// Whether a motion is on the stretch: no farther from either end than they are from each
    /// other, and on its way to the second one.
    fn holds(&self, problem: &Problem, q: &Configuration, heading: &Heading) -> bool {
        let [a, b] = &self.ends;
        let distance = |a, b| problem.space.distance(a, b);
        let length = distance(a, b) + problem.scaled(ROUNDING);
        let onwards = || {
            let metric = problem.mass_metric(q.theta);
            heading.direction.dot(&(metric * a.step_to(b))) > 0.0
        };
        distance(a, q) <= length && distance(q, b) <= length && onwards()
    }
}

fn two(heading: &Heading) -> Option<[Touch; 2]> {
    let mut pressed: [Touch; 2] = heading.pressed.as_slice().try_into().ok()?;
    pressed.sort_unstable();
    Some(pressed)
}

/// Known ends of motions.
#[derive(Clone, Debug, Default)]
pub struct Known {
    /// Minima whose surroundings are known to lie higher: a motion that ends in one of them need
    /// not probe again.
    minima: Vec<Configuration>,
    /// Stretches of motions, and where these ended: a motion that reaches a stretch need not be
    /// followed further.
    slides: HashMap<[Touch; 2], Vec<(Stretch, Arc<Outcome>)>>,
}

impl Known {
    /// These minima.
    pub fn minima(minima: impl Iterator<Item = Configuration>) -> Self {
        Self {
            minima: minima.collect(),
            slides: HashMap::new(),
        }
    }

    /// Adds the stretches of a motion with this outcome.
    pub(super) fn add(&mut self, stretches: Vec<Stretch>, outcome: &Outcome) {
        let outcome = Arc::new(outcome.clone());
        for stretch in stretches {
            let known = self.slides.entry(stretch.pressed).or_default();
            known.push((stretch, outcome.clone()));
        }
    }

    /// Where a motion that heads this way from a configuration ends, if it is on a stretch.
    pub(super) fn lead(
        &self,
        problem: &Problem,
        q: &Configuration,
        heading: &Heading,
    ) -> Option<&Outcome> {
        let known = self.slides.get(&two(heading)?)?;
        let on = known
            .iter()
            .find(|(stretch, _)| stretch.holds(problem, q, heading));
        on.map(|(_, outcome)| &**outcome)
    }

    /// Whether a configuration is one of the minima.
    pub(super) fn holds(&self, problem: &Problem, q: &Configuration) -> bool {
        let is_same =
            |known: &Configuration| problem.space.distance(known, q) <= problem.scaled(SAME);
        self.minima.iter().any(is_same)
    }
}
