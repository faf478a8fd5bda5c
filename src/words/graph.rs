//! The compatibility graph of words: a vertex for each word, an edge between words that can be in
//! one set.

use std::borrow::Cow;
use tiles::parallel;

use fixedbitset::FixedBitSet;

use super::Task;
use super::word::Word;

/// Up to this many vertices the whole graph is stored.
const MOST_HELD: usize = 20_000;

/// The words of a task that may be in a set. Two of them are joined if no wrong attraction among
/// them and their mates exceeds a limit.
pub struct Graph<'a> {
    task: &'a Task,
    /// The word at each vertex.
    pub words: Vec<Word>,
    /// Strongest wrong attraction (J).
    limit: f64,
    /// Neighbours of each vertex; empty if they are computed on demand.
    rows: Vec<FixedBitSet>,
}

impl<'a> Graph<'a> {
    /// The graph of individually valid words; stored as a whole only if this takes at most this
    /// much work.
    pub fn new(task: &'a Task, words: Vec<Word>, limit: f64, work: u64) -> Self {
        let mut graph = Self {
            task,
            words,
            limit,
            rows: Vec::new(),
        };
        if graph.len() <= MOST_HELD && graph.work_to_hold() <= work {
            graph.rows = graph.all_rows();
        }
        graph
    }

    /// The graph of some of its words, ascending.
    pub fn among(&self, words: Vec<Word>, work: u64) -> Self {
        Self::new(self.task, words, self.limit, work)
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// Whether it has no vertices.
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// Whether the whole graph is stored.
    pub fn is_held(&self) -> bool {
        self.rows.len() == self.len()
    }

    /// Units of work to compute it.
    pub fn work(&self) -> u64 {
        match self.is_held() {
            true => self.work_to_hold(),
            false => 0,
        }
    }

    fn work_to_hold(&self) -> u64 {
        self.judgement() * (self.len() * self.len()) as u64 / 2
    }

    /// Units of work to check whether two words are compatible.
    pub fn judgement(&self) -> u64 {
        self.task.judgement()
    }

    /// The graph of pairs of vertices that a symmetry exchanges, for sets with this symmetry: half
    /// as large. Also returns the vertices of each pair.
    pub fn folded(&self, image: &[usize]) -> (Self, Vec<[usize; 2]>) {
        let goes = |v: usize| image[v] == v || self.rows[v].contains(image[v]);
        let firsts = (0..self.len()).filter(|v| image[image[*v]] == *v && *v <= image[*v]);
        let pairs: Vec<[usize; 2]> = firsts.filter(|v| goes(*v)).map(|v| [v, image[v]]).collect();
        let row = |pair: &[usize; 2]| {
            let both = |other: &[usize; 2]| {
                self.rows[pair[0]].contains(other[0]) && self.rows[pair[1]].contains(other[0])
            };
            let mut row = FixedBitSet::with_capacity(pairs.len());
            row.extend((0..pairs.len()).filter(|k| both(&pairs[*k])));
            row
        };
        let folded = Self {
            task: self.task,
            words: pairs.iter().map(|pair| self.words[pair[0]]).collect(),
            limit: self.limit,
            rows: parallel::map(&pairs, row),
        };
        (folded, pairs)
    }

    /// Whether two words are compatible.
    pub fn joined(&self, a: usize, b: usize) -> bool {
        a != b
            && self
                .task
                .compatible([self.words[a], self.words[b]], self.limit)
    }

    /// The words compatible with one.
    pub fn row(&self, vertex: usize) -> Cow<'_, FixedBitSet> {
        match self.rows.get(vertex) {
            Some(row) => Cow::Borrowed(row),
            None => Cow::Owned(self.worked_out(vertex)),
        }
    }

    /// Neighbours of a vertex of a stored graph.
    pub fn neighbours(&self, vertex: usize) -> &FixedBitSet {
        &self.rows[vertex]
    }

    fn worked_out(&self, vertex: usize) -> FixedBitSet {
        let blocks: Vec<usize> = parallel::map(0..self.len().div_ceil(BITS), |block| {
            self.block(vertex, block, 0)
        });
        FixedBitSet::with_capacity_and_blocks(self.len(), blocks)
    }

    /// Whether the vertices of a block, from `from` on, are joined to a vertex.
    fn block(&self, vertex: usize, block: usize, from: usize) -> usize {
        let first = block * BITS;
        (first.max(from)..(first + BITS).min(self.len()))
            .filter(|other| self.joined(vertex, *other))
            .fold(0, |bits, other| bits | 1 << (other - first))
    }

    /// All rows: the part above the diagonal is computed, the rest mirrored.
    fn all_rows(&self) -> Vec<FixedBitSet> {
        let n = self.len();
        let mut rows: Vec<FixedBitSet> = parallel::map(0..n, |a| {
            let blocks = (0..n.div_ceil(BITS)).map(|block| match (block + 1) * BITS <= a {
                true => 0,
                false => self.block(a, block, a + 1),
            });
            FixedBitSet::with_capacity_and_blocks(n, blocks)
        });
        for a in 0..n {
            let (before, rest) = rows.split_at_mut(a + 1);
            for b in before[a].ones().filter(|b| *b > a) {
                rest[b - a - 1].insert(a);
            }
        }
        rows
    }

    /// Permutations of the vertices that preserve the graph, without the identity: poles exchanged,
    /// words reversed, both.
    pub fn symmetries(&self) -> Vec<Vec<usize>> {
        let class = |word: Word| match self.task.exchangeable() {
            true => word.min(word.mate()),
            false => word,
        };
        let maps: [fn(Word) -> Word; 3] = [Word::negated, Word::reversed, |word| {
            word.negated().reversed()
        }];
        let image = |map: fn(Word) -> Word| -> Option<Vec<usize>> {
            let images = self.words.iter().map(|word| class(map(*word)));
            images
                .map(|word| self.words.binary_search(&word).ok())
                .collect()
        };
        let mut found: Vec<Vec<usize>> = maps.into_iter().filter_map(image).collect();
        found.retain(|image| image.iter().enumerate().any(|(a, b)| a != *b) && self.keeps(image));
        found.sort();
        found.dedup();
        found
    }

    /// Whether a permutation preserves the graph: energies of mirrored words may differ in their
    /// last bits.
    fn keeps(&self, image: &[usize]) -> bool {
        (0..self.len()).all(|a| {
            let row = &self.rows[image[a]];
            row.count_ones(..) == self.rows[a].count_ones(..)
                && self.rows[a].ones().all(|b| row.contains(image[b]))
        })
    }
}

const BITS: usize = usize::BITS as usize;
