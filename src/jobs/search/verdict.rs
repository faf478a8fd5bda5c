//! The answer of a search: the best point, how far that is proved, and which key matters.

use super::interval::Interval;
use super::manifest::Search;
use super::rank::{Standing, levels};
use super::space::{STEP, Space};
use super::tried::Found;
use crate::sweep::Outcome;
use physics::order::Order;

/// The relative change of the figure by a step below which a key does not matter.
const FLAT: f64 = 0.01;

/// What became of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The best, or on the front.
    Best,
    /// Bounds prove that the best is better, or that a condition does not hold.
    Worse,
    /// Its value is lower, or a condition does not hold by its value, but bounds do not prove it.
    Undecided,
    /// The design is impossible.
    Impossible,
    /// The analysis failed by a fault of tilebind.
    Failed,
}

impl Verdict {
    /// In files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Best => "best",
            Self::Worse => "worse",
            Self::Undecided => "undecided",
            Self::Impossible => "impossible",
            Self::Failed => "failed",
        }
    }
}

/// What a key does about the best point.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// The index of its axis in the plan; `None` for the choice among designs.
    pub axis: Option<usize>,
    /// A step down and up: the value of the key, and by how much the objective gets better
    /// (negative: worse) relative to its value at the best; `None` at the end of the range or where
    /// the point is not fit.
    pub steps: [Option<(f64, f64)>; 2],
    /// Whether the best is at the lower or upper end of its range.
    pub ends: [bool; 2],
}

impl Effect {
    /// Whether the objective hardly changes to either side.
    pub fn is_flat(&self) -> bool {
        let known = self.steps.iter().flatten();
        known.clone().count() > 0 && known.clone().all(|(_, change)| change.abs() < FLAT)
    }
}

impl Found {
    /// How each point stands.
    pub fn standings(&self, search: &Search) -> Vec<Standing> {
        let all = self.tried.iter();
        all.map(|one| Standing::of(&search.aim, one)).collect()
    }

    /// The points that no other surpasses, the best in the first objective first: the best alone
    /// with one objective. A point that was proved comes before all others.
    pub fn front(&self, search: &Search) -> Vec<usize> {
        let standings = self.standings(search);
        let value = |k: usize| {
            standings[k]
                .gains()
                .map_or(f64::NEG_INFINITY, |all| all[0].value)
        };
        let depth = |k: usize| standings[k].figures().map_or(0.0, |figures| figures.depth);
        let mut fit: Vec<usize> = (0..standings.len())
            .filter(|&k| standings[k].gains().is_some())
            .collect();
        fit.order_by(|&a, &b| {
            value(b)
                .total_cmp(&value(a))
                .then(depth(b).total_cmp(&depth(a)))
        });
        if search.aim.objectives.len() == 1 {
            let proved = fit
                .iter()
                .copied()
                .find(|&k| self.tried[k].proved.is_some());
            return proved.or(fit.first().copied()).into_iter().collect();
        }
        let surpassed = |k: usize| {
            standings
                .iter()
                .any(|other| standings[k].is_surpassed_by(other))
        };
        fit.retain(|&k| !surpassed(k));
        fit
    }

    /// A level for each point, by which they are ranked.
    pub fn levels(&self, search: &Search) -> Vec<f64> {
        let weights = vec![1.0; search.aim.objectives.len()];
        levels(&self.standings(search), &weights)
    }

    /// What became of each point.
    pub fn verdicts(&self, search: &Search) -> Vec<Verdict> {
        let standings = self.standings(search);
        let front = self.front(search);
        let is_worse = |own: &[Interval]| {
            front.iter().any(|&best| {
                let gains = standings[best].gains().unwrap_or_default();
                let mut pairs = own.iter().zip(gains);
                pairs.all(|(own, best)| own.high < best.low)
            })
        };
        let verdict = |k: usize| match (&standings[k], self.tried[k].known()) {
            (_, Outcome::Failed { .. }) => Verdict::Failed,
            (Standing::Impossible, _) => Verdict::Impossible,
            _ if front.contains(&k) => Verdict::Best,
            (
                Standing::Unfit {
                    is_proved: true, ..
                },
                _,
            ) => Verdict::Worse,
            (Standing::Fit { figures, .. }, _) if is_worse(&figures.gains) => Verdict::Worse,
            _ => Verdict::Undecided,
        };
        (0..standings.len()).map(verdict).collect()
    }

    /// What each number does about the best point, and each end of a range at which it is.
    pub fn effects(&self, search: &Search) -> Vec<Effect> {
        let (space, standings) = (Space::of(&search.plan), self.standings(search));
        let (Some(&best), [_]) = (self.front(search).first(), &search.aim.objectives[..]) else {
            return Vec::new();
        };
        let Some([gain]) = standings[best].gains() else {
            return Vec::new();
        };
        let place = &self.tried[best].place;
        let numbers = space
            .dimensions
            .iter()
            .enumerate()
            .filter(|(_, one)| one.is_ordered);
        let effect = |(k, one): (usize, &super::space::Dimension)| {
            let levels = one.levels - 1;
            let near = ((0.01 * levels as f64) as usize).min(levels / 2);
            let change = |is_up: bool| {
                // The nearest point that differs in this key alone, no farther than two steps.
                let most = 2.0 * (STEP * levels as f64).max(1.0);
                let beside = (0..self.tried.len()).filter(|&other| {
                    let its = &self.tried[other].place;
                    let others = (0..its.len()).filter(|&j| j != k);
                    let step = its[k].abs_diff(place[k]);
                    (its[k] > place[k]) == is_up
                        && step > 0
                        && step as f64 <= most
                        && others.into_iter().all(|j| its[j] == place[j])
                });
                let other =
                    beside.min_by_key(|&other| self.tried[other].place[k].abs_diff(place[k]))?;
                let [its] = standings[other].gains()? else {
                    return None;
                };
                let value = self.tried[other].point.values[one.axis?].number()?;
                let change = match (its.value.is_infinite(), gain.value.is_infinite()) {
                    (true, true) => 0.0,
                    // From no trap at all to one.
                    (false, true) => -1.0,
                    _ => (its.value - gain.value) / gain.value.abs(),
                };
                change.is_finite().then_some((value, change))
            };
            Effect {
                axis: one.axis,
                steps: [change(false), change(true)],
                ends: [place[k] <= near, place[k] + near >= levels],
            }
        };
        numbers.map(effect).collect()
    }
}
