//! What queries proved of minimax energies, and what follows for the next ones.
//!
//! A path from A over B to C is no higher than the higher of its halves, so that minimax energies are
//! an ultrametric: of the three between A, B and C the two highest are equal. What leads from A to the
//! first of some places leads to none of them lower.

use super::query::Goal;
use crate::configuration::Configuration;
use crate::landscape::results::SaddleBounds;

/// Between a configuration and the first of some places.
struct Proved {
    from: Configuration,
    /// Whether far apart is one of the places, beside these.
    free: bool,
    to: Vec<Configuration>,
    /// No path is lower (J).
    lower: f64,
    /// A path to this configuration is no higher (J).
    way: Option<(Configuration, f64)>,
}

impl Proved {
    /// Whether what it says of its places it says of a goal too.
    fn includes(&self, goal: &Goal) -> bool {
        match goal {
            Goal::At(q) => self.to.contains(q),
            Goal::Free => self.free,
            Goal::Any(goals) => self.free && goals.iter().all(|q| self.to.contains(q)),
        }
    }
}

/// All that was proved.
#[derive(Default)]
pub(super) struct Proofs(Vec<Proved>);

impl Proofs {
    /// Notes the bounds of a query, and the end of the way that proves the upper one.
    pub fn add(
        &mut self,
        from: &Configuration,
        goal: &Goal,
        bounds: &SaddleBounds,
        end: Option<&Configuration>,
    ) {
        let (free, to) = match goal {
            Goal::At(q) => (false, vec![*q]),
            Goal::Free => (true, Vec::new()),
            Goal::Any(goals) => (true, goals.to_vec()),
        };
        self.0.push(Proved {
            from: *from,
            free,
            to,
            lower: bounds.lower.unwrap_or(f64::NEG_INFINITY),
            way: end.copied().zip(bounds.upper),
        });
    }

    /// What follows for the paths from a configuration to a goal: none is lower (J).
    pub fn least(&self, from: &Configuration, goal: &Goal) -> f64 {
        let direct = self.between(from, goal);
        // Over a place to which a way is known to lie lower than what leads on from there.
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
        let is_between = |proved: &&Proved| {
            let back = || match goal {
                Goal::At(q) => proved.from == *q && proved.includes(&Goal::At(*from)),
                _ => false,
            };
            proved.from == *from && proved.includes(goal) || back()
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
                let goals = [at(to), at(other)];
                let first = truth(from, to).min(truth(from, other));
                let (goal, highest) = if rng.random_bool(0.3) {
                    (Goal::Any(&goals), first)
                } else {
                    (Goal::At(at(to)), truth(from, to))
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
                    let goal = Goal::At(at(to));
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
