//! Simulated annealing of positions and poles.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::pose::Meetings;
use super::{SpacedWord, Wanted};
use crate::Effort;

/// Number of independent walks.
const WALKS: u64 = 4;
/// Units of work of a pair of magnets.
const PAIR: u64 = 4;
/// The temperatures at the start and at the end: by about this fraction a worse set may be
/// accepted.
const HEAT: [f64; 2] = [0.05, 5e-4];
/// Fractions of moves that try a word of the worst pair, exchange a pole, redraw a word.
const OF_WORST: f64 = 0.6;
const EXCHANGED: f64 = 0.15;
const REDRAWN: f64 = 0.05;
/// The smallest shift, in lengths of a face, and the largest factor of it.
const SHIFT: (f64, f64) = (2e-4 / 0.43, 400.0);
/// Weight of the mean of all pairs relative to the strongest.
const OF_MEAN: f64 = 0.02;

/// A set of words, and its strongest wrong attraction as a fraction of the weakest bond, as
/// estimated by annealing.
#[derive(Clone, Debug, PartialEq)]
pub struct Annealed {
    /// The words.
    pub words: Vec<SpacedWord>,
    /// At least 0; 1 if a wrong attraction is as strong as a bond.
    pub share: f64,
}

/// This many words with a small share, starting from known ones; stops at `enough`. `None` if the
/// face is too short or the poles cannot satisfy the constraints.
pub fn search(
    wanted: &Wanted,
    count: usize,
    known: &[SpacedWord],
    enough: f64,
    effort: &mut Effort,
) -> Option<Annealed> {
    let mut parts: Vec<_> = (0..WALKS)
        .map(|walk| effort.budget.share(1.0 / (WALKS - walk) as f64))
        .collect();
    let found: Vec<Option<Annealed>> = parts
        .par_iter_mut()
        .enumerate()
        .map(|(walk, budget)| {
            let mut rng = ChaCha8Rng::seed_from_u64(effort.seed);
            rng.set_stream(walk as u64);
            let mut set = Set::new(wanted, count, known, &mut rng)?;
            let all = budget.left() as f64;
            let mut best = set.annealed();
            while !budget.is_spent() && best.share > enough {
                let past = 1.0 - budget.left() as f64 / all;
                let heat = HEAT[0] * libm::pow(HEAT[1] / HEAT[0], past);
                set.step(heat, &mut rng);
                budget.spend(PAIR * set.meetings.pairs.take() + 50);
                if set.share() < best.share {
                    best = set.annealed();
                }
            }
            Some(best)
        })
        .collect();
    for part in &parts {
        effort.budget.give_back(part);
    }
    let better = |a: &Annealed, b: &Annealed| a.share.total_cmp(&b.share);
    found.into_iter().flatten().min_by(better)
}

struct Set<'a> {
    wanted: &'a Wanted,
    meetings: Meetings,
    words: Vec<SpacedWord>,
    /// Strongest wrong attraction (J) of every two words, i <= j.
    wrong: Vec<Vec<f64>>,
    bonds: Vec<f64>,
}

impl<'a> Set<'a> {
    fn new(
        wanted: &'a Wanted,
        count: usize,
        known: &[SpacedWord],
        rng: &mut ChaCha8Rng,
    ) -> Option<Self> {
        let mut words: Vec<SpacedWord> = known.iter().take(count).cloned().collect();
        while words.len() < count {
            words.push(drawn(wanted, rng)?);
        }
        let mut set = Self {
            wanted,
            meetings: Meetings::new(wanted),
            wrong: vec![vec![0.0; count]; count],
            bonds: vec![0.0; count],
            words,
        };
        for i in 0..count {
            set.judge(i);
        }
        Some(set)
    }

    /// Recomputes everything that involves a word.
    fn judge(&mut self, i: usize) {
        self.bonds[i] = self.meetings.bond(&self.words[i]);
        for j in 0..self.words.len() {
            let attraction = self.attraction(i.min(j), i.max(j));
            self.wrong[i][j] = attraction;
            self.wrong[j][i] = attraction;
        }
    }

    /// The strongest wrong attraction (J) of two words and their mates.
    fn attraction(&self, i: usize, j: usize) -> f64 {
        let (first, second) = (&self.words[i], &self.words[j]);
        let mut faces = vec![(second.mate(), i == j)];
        if self.wanted.words_meet {
            faces.push((second.clone(), false));
        }
        if self.wanted.flip {
            let over: Vec<_> = faces
                .iter()
                .map(|(face, _)| (face.turned_over(), false))
                .collect();
            faces.extend(over);
        }
        let strongest = faces
            .iter()
            .map(|(face, own)| self.meetings.strongest(first, face, *own));
        strongest.fold(0.0, f64::max)
    }

    fn weakest_bond(&self) -> f64 {
        self.bonds
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min)
            .max(f64::MIN_POSITIVE)
    }

    /// The worst two words.
    fn worst(&self) -> [usize; 2] {
        let n = self.words.len();
        let pairs = (0..n).flat_map(|i| (i..n).map(move |j| [i, j]));
        let strength = |pair: &[usize; 2]| self.wrong[pair[0]][pair[1]];
        pairs
            .max_by(|a, b| strength(a).total_cmp(&strength(b)))
            .unwrap_or([0, 0])
    }

    fn share(&self) -> f64 {
        let [i, j] = self.worst();
        self.wrong[i][j] / self.weakest_bond()
    }

    /// The cost that annealing minimises.
    fn cost(&self) -> f64 {
        let all = self.wrong.iter().flatten();
        let mean = all.sum::<f64>() / (self.words.len() * self.words.len()) as f64;
        self.share() + OF_MEAN * mean / self.weakest_bond()
    }

    fn annealed(&self) -> Annealed {
        Annealed {
            words: self.words.clone(),
            share: self.share(),
        }
    }

    /// Tries a change of one word.
    fn step(&mut self, heat: f64, rng: &mut ChaCha8Rng) {
        let i = match rng.random_bool(OF_WORST) {
            true => self.worst()[rng.random_range(0..2usize)],
            false => rng.random_range(0..self.words.len()),
        };
        let Some(word) = changed(self.wanted, &self.words[i], rng) else {
            return;
        };
        let before = (
            self.cost(),
            self.words[i].clone(),
            self.wrong.clone(),
            self.bonds[i],
        );
        self.words[i] = word;
        self.judge(i);
        let allowed = before.0 - heat * libm::log(1.0 - rng.random::<f64>());
        if self.cost() > allowed {
            self.words[i] = before.1;
            self.wrong = before.2;
            self.bonds[i] = before.3;
        }
    }
}

/// A word at random.
fn drawn(wanted: &Wanted, rng: &mut ChaCha8Rng) -> Option<SpacedWord> {
    const TRIED: usize = 1000;
    let room = wanted.room();
    if room < 0.0 {
        return None;
    }
    (0..TRIED).find_map(|_| {
        let mut free: Vec<f64> = (0..wanted.magnets)
            .map(|_| room * rng.random::<f64>())
            .collect();
        free.sort_by(f64::total_cmp);
        let first = (wanted.bar.size[1] - wanted.face) / 2.0;
        let at = |(k, free): (usize, &f64)| first + free + k as f64 * wanted.bar.pitch;
        let pole = |at: f64, north: bool| (at, if north { 1 } else { -1 });
        let positions: Vec<f64> = free.iter().enumerate().map(at).collect();
        let word = SpacedWord {
            magnets: positions
                .into_iter()
                .map(|at| pole(at, rng.random()))
                .collect(),
        };
        wanted.allows(&word).then_some(word)
    })
}

/// A word changed a little; `None` if it is not allowed.
fn changed(wanted: &Wanted, word: &SpacedWord, rng: &mut ChaCha8Rng) -> Option<SpacedWord> {
    let kind = rng.random::<f64>();
    if kind < REDRAWN {
        return drawn(wanted, rng);
    }
    let mut word = word.clone();
    let k = rng.random_range(0..word.magnets.len());
    if kind < REDRAWN + EXCHANGED {
        word.magnets[k].1 *= -1;
        if wanted.balanced {
            let other = rng.random_range(0..word.magnets.len());
            word.magnets[other].1 *= -1;
        }
    } else {
        let size = wanted.face * SHIFT.0 * libm::pow(SHIFT.1, rng.random::<f64>());
        word.magnets[k].0 += if rng.random() { size } else { -size };
        word.magnets.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    wanted.allows(&word).then_some(word)
}
