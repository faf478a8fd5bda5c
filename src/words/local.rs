//! Large cliques by local search: sets of words are grown, exchanged and perturbed.
//!
//! As in Tulpan, Hoos and Condon (DNA8, 2002) a set of words is improved by exchanging conflicting
//! words, by the rules of Pullan and Hoos, *Dynamic local search for the maximum clique problem*
//! (JAIR 25 (2006) 159): add a word compatible with all; otherwise exchange one for a word
//! compatible with all others; prefer rarely used words (penalties); when stuck, keep only the
//! words compatible with a random one.

use std::borrow::Cow;

use fixedbitset::FixedBitSet;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use tiles::budget::Budget;
use tiles::parallel;

use super::effort::Effort;
use super::graph::Graph;

/// Number of independent walks through the same graph.
const WALKS: usize = 4;
/// Work of a walk (s) between comparisons of the walks.
const ROUND: f64 = 0.1;
/// Units of work of every step, however small the graph.
const STEP: u64 = 24;
/// After getting stuck this often, all penalties decrease by one.
const FORGET_AFTER: u32 = 2;

/// A large clique, starting from a known one; stops at the size `enough`.
pub fn search(graph: &Graph, known: Vec<usize>, enough: usize, effort: &mut Effort) -> Vec<usize> {
    let (seed, budget) = (effort.seed, &mut effort.budget);
    let mut best = known;
    if graph.is_empty() {
        return best;
    }
    let walks = if graph.is_held() { WALKS } else { 1 };
    let mut walks: Vec<Walk> = (0..walks)
        .map(|walk| Walk::new(graph, &best, seed, walk as u64))
        .collect();
    if !graph.is_held() {
        budget.spend((best.len() * graph.len()) as u64 * graph.judgement());
    }
    while best.len() < enough && !budget.is_spent() {
        let mut parts: Vec<Budget> = walks.iter().map(|_| budget.part(ROUND)).collect();
        let mut each: Vec<_> = walks.iter_mut().zip(&mut parts).collect();
        parallel::for_each(&mut each, |(walk, part)| walk.go(enough, part));
        for (walk, part) in walks.iter().zip(&parts) {
            budget.give_back(part);
            if walk.best.len() > best.len() {
                best.clone_from(&walk.best);
            }
        }
    }
    best.sort_unstable();
    best
}

struct Walk<'a> {
    graph: &'a Graph<'a>,
    rng: ChaCha8Rng,
    /// The set, each with its row.
    members: Vec<(usize, Cow<'a, FixedBitSet>)>,
    /// For each word, how many of the set are incompatible with it (including itself).
    conflicts: Vec<u32>,
    penalties: Vec<u32>,
    /// Words that left or entered since the set last grew or was perturbed.
    used: FixedBitSet,
    stuck: u32,
    best: Vec<usize>,
}

impl<'a> Walk<'a> {
    fn new(graph: &'a Graph<'a>, known: &[usize], seed: u64, stream: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(stream);
        let n = graph.len();
        let mut walk = Self {
            graph,
            rng,
            members: Vec::new(),
            conflicts: vec![0; n],
            penalties: vec![0; n],
            used: FixedBitSet::with_capacity(n),
            stuck: 0,
            best: Vec::new(),
        };
        if stream == 0 {
            for vertex in known {
                walk.add(*vertex);
            }
        }
        walk
    }

    fn go(&mut self, enough: usize, budget: &mut Budget) {
        let scan = (self.graph.len() / 2) as u64 + STEP;
        let judged = match self.graph.is_held() {
            true => 0,
            false => self.graph.judgement() * self.graph.len() as u64,
        };
        while !budget.is_spent() && self.best.len() < enough {
            budget.spend(scan + judged);
            match self.choose() {
                [Some(vertex), _] => {
                    self.add(vertex);
                    if self.members.len() > self.best.len() {
                        self.best = self.members.iter().map(|(vertex, _)| *vertex).collect();
                    }
                }
                [None, Some(vertex)] => {
                    self.drop_conflicting(vertex);
                    self.add(vertex);
                }
                [None, None] => self.shake(),
            }
        }
    }

    /// Among the words not used before, a word without conflicts and one with a single conflict,
    /// each with the lowest penalty, at random.
    fn choose(&mut self) -> [Option<usize>; 2] {
        let mut chosen = [None; 2];
        let (mut least, mut ties) = ([u32::MAX; 2], [0u32; 2]);
        for (vertex, count) in self.conflicts.iter().enumerate() {
            let kind = *count as usize;
            if kind > 1 || self.used.contains(vertex) {
                continue;
            }
            let penalty = self.penalties[vertex];
            if penalty < least[kind] {
                (least[kind], ties[kind]) = (penalty, 0);
            }
            if penalty == least[kind] {
                ties[kind] += 1;
                if self.rng.random_range(0..ties[kind]) == 0 {
                    chosen[kind] = Some(vertex);
                }
            }
        }
        chosen
    }

    fn add(&mut self, vertex: usize) {
        let row = self.graph.row(vertex);
        for other in row.zeroes() {
            self.conflicts[other] += 1;
        }
        self.members.push((vertex, row));
        self.used.insert(vertex);
    }

    fn drop_conflicting(&mut self, vertex: usize) {
        let (stay, go): (Vec<_>, Vec<_>) = std::mem::take(&mut self.members)
            .into_iter()
            .partition(|(member, row)| *member != vertex && row.contains(vertex));
        self.members = stay;
        for (member, row) in go {
            for other in row.zeroes() {
                self.conflicts[other] -= 1;
            }
            self.used.insert(member);
        }
    }

    /// Increases the penalties of the set's words, and keeps those compatible with a random one.
    fn shake(&mut self) {
        self.used.clear();
        for (member, _) in &self.members {
            self.penalties[*member] += 1;
            self.used.insert(*member);
        }
        self.stuck += 1;
        if self.stuck.is_multiple_of(FORGET_AFTER) {
            for penalty in &mut self.penalties {
                *penalty = penalty.saturating_sub(1);
            }
        }
        let vertex = self.rng.random_range(0..self.graph.len());
        if self.conflicts[vertex] > 0 {
            self.drop_conflicting(vertex);
        }
        self.add(vertex);
    }
}
