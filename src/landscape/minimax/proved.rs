//! Bounds of minimax energies proved by earlier queries, and what they imply for later ones.
//!
//! A path from A over B to C is no higher than the higher of its halves, so that minimax energies
//! are an ultrametric: of the three between A, B and C the two highest are equal. A lower bound for
//! paths from A to the first of several places also holds for each of them.

use super::Goal;
use crate::results::SaddleBounds;
use tiles::configuration::Configuration;

/// Bounds between a configuration and the first of some places.
struct Proved {
    from: Configuration,
    to: Goal,
    /// No path is lower (J).
    lower: f64,
    /// A path to this configuration is at most this high (J).
    way: Option<(Configuration, f64)>,
}

/// All proved bounds.
#[derive(Default)]
pub(super) struct Proofs(Vec<Proved>);

impl Proofs {
    /// Records the bounds of a query, and the end of the path that proves the upper one.
    pub fn add(
        &mut self,
        from: &Configuration,
        to: &Goal,
        bounds: &SaddleBounds,
        end: Option<&Configuration>,
    ) {
        self.0.push(Proved {
            from: *from,
            to: to.clone(),
            lower: bounds.lower.unwrap_or(f64::NEG_INFINITY),
            way: end.copied().zip(bounds.upper),
        });
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The implied lower bound (J) for paths from a configuration to a goal.
    pub fn least(&self, from: &Configuration, goal: &Goal) -> f64 {
        let direct = self.between(from, goal);
        // Via a place with a known path to it that is lower than every path from there.
        let known = self.0.iter().filter(|proved| proved.from == *from);
        let over = known.filter_map(|proved| {
            let (place, upper) = proved.way?;
            let on = self.between(&place, goal);
            (upper < on).then_some(on)
        });
        over.fold(direct, f64::max)
    }

    /// The greatest lower bound (J) that was proved.
    fn between(&self, from: &Configuration, goal: &Goal) -> f64 {
        let back = goal.only().map(|q| (*q, Goal::at(*from)));
        let leads = |proved: &Proved, from: &Configuration, to: &Goal| {
            proved.from == *from && proved.to.includes(to)
        };
        let is_between = |proved: &&Proved| {
            let is_back = back.iter().any(|(q, from)| leads(proved, q, from));
            is_back || leads(proved, from, goal)
        };
        let found = self.0.iter().filter(is_between);
        found
            .map(|proved| proved.lower)
            .fold(f64::NEG_INFINITY, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn at(k: usize) -> Configuration {
        Configuration::new(k as f64, 0.0, 0.0)
    }

    /// On a line, what lies between two places is the highest pass there.
    #[test]
    fn what_follows_is_never_more_than_is_true() {
        const PLACES: usize = 8;
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let (mut over_others, mut exactly) = (0, 0);
        for _ in 0..300 {
            let passes: Vec<f64> = (1..PLACES).map(|_| rng.random_range(0.0..1.0)).collect();
            let truth = |a: usize, b: usize| {
                let between = &passes[a.min(b)..a.max(b)];
                between.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            };
            let mut proofs = Proofs::default();
            for _ in 0..rng.random_range(1..8) {
                let [from, to] = [0, 1].map(|_| rng.random_range(0..PLACES));
                let other = rng.random_range(0..PLACES);
                if from == to || from == other {
                    continue;
                }
                let places = vec![at(to), at(other)];
                let first = truth(from, to).min(truth(from, other));
                let (goal, highest) = if rng.random_bool(0.3) {
                    (Goal { places, free: true }, first)
                } else {
                    (Goal::at(at(to)), truth(from, to))
                };
                let bounds = SaddleBounds {
                    lower: Some(highest - 1e-3),
                    upper: Some(truth(from, to) + 1e-3),
                    caged: false,
                };
                proofs.add(&at(from), &goal, &bounds, Some(&at(to)));
            }
            for (from, to) in (0..PLACES).flat_map(|a| (0..PLACES).map(move |b| (a, b))) {
                if from != to {
                    let goal = Goal::at(at(to));
                    let least = proofs.least(&at(from), &goal);
                    assert!(least <= truth(from, to), "{least}");
                    over_others += usize::from(least > proofs.between(&at(from), &goal));
                    exactly += usize::from(least > truth(from, to) - 2e-3);
                }
            }
        }
        assert!(
            over_others > 50 && exactly > 1000,
            "{over_others} {exactly}"
        );
    }
}
