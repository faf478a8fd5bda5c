//! A finished search, with what became of its points.

use crate::points::FinishedSweep;
use jobs::search::{Search, SearchResult, Standing, Verdict};
use jobs::sweep::Plan;
use ordered_float::OrderedFloat;
use physics::order::Order;

/// A finished search.
pub struct Searched<'a> {
    /// The search.
    pub search: &'a Search,
    /// What it found.
    pub found: &'a SearchResult,
    /// How each point stands, and what became of it.
    pub standings: Vec<Standing>,
    /// What became of each point.
    pub verdicts: Vec<Verdict>,
    /// The best points: one, or the front.
    pub front: Vec<usize>,
    /// Its plan, with the values that were tried.
    pub(super) plan: Plan,
}

impl<'a> Searched<'a> {
    /// The answers of a search.
    pub fn new(search: &'a Search, found: &'a SearchResult) -> Self {
        let mut plan = search.plan.clone();
        for (k, axis) in plan
            .axes
            .iter_mut()
            .enumerate()
            .filter(|(_, axis)| axis.is_range)
        {
            axis.values = found
                .tried
                .iter()
                .map(|one| one.point.values[k].clone())
                .collect();
            axis.values
                .order_by_key(|value| value.number().map(OrderedFloat));
            axis.values.dedup();
        }
        Self {
            search,
            found,
            standings: found.standings(search),
            verdicts: found.verdicts(search),
            front: found.front(search),
            plan,
        }
    }

    /// Its points as those of a sweep.
    pub fn sweep(&self) -> FinishedSweep<'_> {
        FinishedSweep {
            plan: &self.plan,
            points: self
                .found
                .tried
                .iter()
                .map(|one| one.point.clone())
                .collect(),
            outcomes: self
                .found
                .tried
                .iter()
                .map(|one| one.known().clone())
                .collect(),
        }
    }

    /// The same in the order of the table, as the page wants them.
    pub(super) fn ranked(&self) -> FinishedSweep<'_> {
        let mut sweep = self.sweep();
        let order = self.order();
        sweep.outcomes = order.iter().map(|&k| sweep.outcomes[k].clone()).collect();
        sweep.points = order.iter().map(|&k| sweep.points[k].clone()).collect();
        for (index, point) in sweep.points.iter_mut().enumerate() {
            point.index = index;
        }
        sweep
    }

    /// The best point, if there is one alone.
    pub fn best(&self) -> Option<usize> {
        match (&self.front[..], &self.search.aim.objectives[..]) {
            ([best, ..], [_]) => Some(*best),
            _ => None,
        }
    }

    /// The number of points that were analysed.
    pub fn analysed(&self) -> usize {
        self.found
            .tried
            .iter()
            .filter(|one| one.is_analysed())
            .count()
    }

    /// The number of points with this verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.verdicts.iter().filter(|one| **one == verdict).count()
    }

    /// The points, the best first.
    pub(super) fn order(&self) -> Vec<usize> {
        let levels = self.found.levels(self.search);
        let mut order: Vec<usize> = (0..levels.len()).collect();
        order.order_by(|&a, &b| levels[b].total_cmp(&levels[a]));
        // The front, and the best that is proved, come first.
        let place = |k: &usize| self.front.iter().position(|one| one == k);
        order.order_by_key(|k| place(k).unwrap_or(usize::MAX));
        order
    }
}
