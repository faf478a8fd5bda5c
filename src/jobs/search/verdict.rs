//! The answer of a search: the best point, and how far that is proved.

use super::interval::FigureBounds;
use super::manifest::Search;
use super::rank::{Standing, levels};
use super::tried::SearchResult;
use crate::sweep::Outcome;
use physics::order::Order;

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

impl SearchResult {
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
        let is_worse = |own: &[FigureBounds]| {
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
}
