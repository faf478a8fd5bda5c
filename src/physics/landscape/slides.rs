//! Slides: stretches of known motions along which contact leaves the tiles one way only, so that
//! every motion that comes there goes on as the known one did.

use std::collections::HashMap;
use std::sync::Arc;

use super::constrained::Heading;
use super::minimum::Outcome;
use crate::configuration::Configuration;
use crate::contact::Touch;
use crate::problem::Problem;

/// How far (m, metric of the space) a configuration may lie outside a stretch and count as within.
const ROUNDING: f64 = 1e-9;

/// A step of a motion with the same two contacts pressed on at both ends.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// The contacts.
    pub pressed: [Touch; 2],
    /// Its ends, in the motion's order.
    pub ends: [Configuration; 2],
}

impl Stretch {
    /// The step between two configurations, if two contacts leave it no choice. Contacts pressed on
    /// at once do not depend on each other: of three coordinates they leave one.
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
        let length = distance(a, b) + ROUNDING;
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

/// Stretches of motions, and where each of these ended.
#[derive(Clone, Debug, Default)]
pub struct Slides(HashMap<[Touch; 2], Vec<(Stretch, Arc<Outcome>)>>);

impl Slides {
    /// Adds the stretches of a motion that ended so.
    pub fn add(&mut self, stretches: Vec<Stretch>, outcome: &Outcome) {
        let outcome = Arc::new(outcome.clone());
        for stretch in stretches {
            let known = self.0.entry(stretch.pressed).or_default();
            known.push((stretch, outcome.clone()));
        }
    }

    /// Where a motion that heads this way from a configuration ends, if it is on a stretch.
    pub fn lead(
        &self,
        problem: &Problem,
        q: &Configuration,
        heading: &Heading,
    ) -> Option<&Outcome> {
        let known = self.0.get(&two(heading)?)?;
        let on = known
            .iter()
            .find(|(stretch, _)| stretch.holds(problem, q, heading));
        on.map(|(_, outcome)| &**outcome)
    }
}
