//! What changes the best point: each key by itself, and two keys together.

use super::manifest::Search;
use super::space::{GridPoint, Space};
use super::tried::SearchResult;

/// The relative change of the objective by a step below which the step does not matter.
const FLAT: f64 = 0.01;

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
        is_flat(self.steps.iter().flatten().map(|(_, change)| *change))
    }
}

/// What a step of two keys at once does about the best point: the first key up and down, the second
/// along with it or against it.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The indices of the axes in the plan.
    pub axes: [usize; 2],
    /// Whether the second key goes down where the first goes up.
    pub is_opposed: bool,
    /// With the first key a step down and up: the values of both, and by how much the objective gets
    /// better, as in [`Effect::steps`].
    pub steps: [Option<([f64; 2], f64)>; 2],
}

impl Direction {
    /// Whether the objective hardly changes to either side.
    pub fn is_flat(&self) -> bool {
        is_flat(self.steps.iter().flatten().map(|(_, change)| *change))
    }
}

fn is_flat(mut changes: impl Iterator<Item = f64>) -> bool {
    let first = changes.next();
    first.is_some_and(|first| first.abs() < FLAT) && changes.all(|change| change.abs() < FLAT)
}

/// The tried points about the best.
struct About<'a> {
    found: &'a SearchResult,
    space: Space,
    /// The objective of each point that is fit.
    values: Vec<Option<f64>>,
    best: usize,
    value: f64,
}

impl<'a> About<'a> {
    /// `None` with two objectives, and if nothing is fit.
    fn best(found: &'a SearchResult, search: &Search) -> Option<Self> {
        let [_] = &search.aim.objectives[..] else {
            return None;
        };
        let best = *found.front(search).first()?;
        let standings = found.standings(search);
        let values = standings.iter().map(|one| Some(one.gains()?[0].value));
        let values: Vec<Option<f64>> = values.collect();
        Some(Self {
            found,
            space: Space::of(&search.plan),
            value: values[best]?,
            values,
            best,
        })
    }

    fn place(&self) -> &GridPoint {
        &self.found.tried[self.best].place
    }

    /// The point that differs in these dimensions alone, each to its side (up or not), and comes nearest
    /// to one step of each; none farther than two steps.
    fn beside(&self, sides: &[(usize, bool)]) -> Option<usize> {
        let place = self.place();
        let step = |k: usize| self.space.step(k);
        let moved = |other: usize, k: usize| self.found.tried[other].place[k].abs_diff(place[k]);
        let is_beside = |other: &usize| {
            let its = &self.found.tried[*other].place;
            (0..its.len()).all(|k| match sides.iter().find(|(own, _)| *own == k) {
                None => its[k] == place[k],
                Some((_, is_up)) => {
                    let moved = moved(*other, k);
                    (its[k] > place[k]) == *is_up && moved > 0 && moved <= 2 * step(k)
                }
            })
        };
        let off = |other: &usize| {
            let off = sides
                .iter()
                .map(|(k, _)| moved(*other, *k).abs_diff(step(*k)));
            off.sum::<usize>()
        };
        (0..self.values.len()).filter(is_beside).min_by_key(off)
    }

    /// The value of a dimension's key at a point.
    fn number(&self, dimension: usize, point: usize) -> Option<f64> {
        let axis = self.space.dimensions[dimension].axis?;
        self.found.tried[point].point.values[axis].number()
    }

    /// By how much a point is better than the best, relative to it.
    fn change(&self, point: usize) -> Option<f64> {
        let value = self.values[point]?;
        let change = match (value.is_infinite(), self.value.is_infinite()) {
            (true, true) => 0.0,
            // From no trap at all to one.
            (false, true) => -1.0,
            _ => (value - self.value) / self.value.abs(),
        };
        change.is_finite().then_some(change)
    }

    /// What one dimension does.
    fn effect(&self, k: usize) -> Effect {
        let one = &self.space.dimensions[k];
        let levels = one.levels - 1;
        let near = ((0.01 * levels as f64) as usize).min(levels / 2);
        let own = self.place()[k];
        let step = |is_up| {
            let other = self.beside(&[(k, is_up)])?;
            Some((self.number(k, other)?, self.change(other)?))
        };
        Effect {
            axis: one.axis,
            steps: [false, true].map(step),
            ends: [own <= near, own + near >= levels],
        }
    }

    /// The pairs of dimensions that each matter by themselves.
    fn that_matter(&self) -> Vec<[usize; 2]> {
        let matters = |k: usize| {
            let effect = self.effect(k);
            effect.steps.iter().any(Option::is_some) && !effect.is_flat()
        };
        let mut pairs = self.space.pairs();
        pairs.retain(|pair| pair.iter().all(|&k| matters(k)));
        pairs
    }

    /// What two dimensions do together.
    fn direction(&self, [j, k]: [usize; 2], is_opposed: bool) -> Option<Direction> {
        let dimensions = [j, k].map(|one| self.space.dimensions[one].axis);
        // Of just one step each: along other lines keys do not cancel.
        let is_whole = |other: usize| {
            let moved = |k: usize| self.found.tried[other].place[k].abs_diff(self.place()[k]);
            [j, k].iter().all(|&k| moved(k) == self.space.step(k))
        };
        let step = |is_up: bool| {
            let other = self.beside(&[(j, is_up), (k, is_up != is_opposed)])?;
            if !is_whole(other) {
                return None;
            }
            let values = [self.number(j, other)?, self.number(k, other)?];
            Some((values, self.change(other)?))
        };
        let steps = [false, true].map(step);
        steps.iter().any(Option::is_some).then_some(Direction {
            axes: [dimensions[0]?, dimensions[1]?],
            is_opposed,
            steps,
        })
    }
}

impl SearchResult {
    /// What each number does about the best point, and each end of a range at which it is.
    pub fn effects(&self, search: &Search) -> Vec<Effect> {
        let Some(about) = About::best(self, search) else {
            return Vec::new();
        };
        let numbers = about.space.numbers();
        numbers.map(|k| about.effect(k)).collect()
    }

    /// What steps of two keys at once do about the best point, where such points were tried and each
    /// key matters by itself.
    pub fn directions(&self, search: &Search) -> Vec<Direction> {
        let Some(about) = About::best(self, search) else {
            return Vec::new();
        };
        let pairs = about.that_matter().into_iter();
        let both = pairs.flat_map(|pair| [(pair, false), (pair, true)]);
        both.filter_map(|(pair, is_opposed)| about.direction(pair, is_opposed))
            .collect()
    }

    /// The pairs of dimensions that may cancel each other about the best point.
    pub(super) fn that_matter(&self, search: &Search) -> Vec<[usize; 2]> {
        About::best(self, search).map_or_else(Vec::new, |about| about.that_matter())
    }
}
