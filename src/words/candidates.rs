//! The words that may belong to a set: each valid by itself, and only one of a word and its mate
//! where the two are interchangeable.

use rand::seq::index::sample;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tiles::parallel;

use super::Task;
use super::word::Word;

/// Up to this many words are all examined, if the effort suffices; otherwise a sample of at most
/// this size is drawn.
const MOST_ENUMERATED: f64 = (1u64 << 23) as f64;
const SAMPLE: u64 = 1 << 19;
/// A sample is small enough to judge all of it this many times with the available effort.
const JUDGED: u64 = 1000;
/// Units of work to draw a word.
const DRAWN: u64 = 100;
/// Number of words of a sample that share a random stream.
const CHUNK: usize = 1 << 12;

/// Words to choose from.
#[derive(Clone, Debug)]
pub struct Candidates {
    /// The words, in order.
    pub words: Vec<Word>,
    /// Whether these are all words.
    pub complete: bool,
    /// Units of work that their search took.
    pub work: u64,
}

impl Candidates {
    /// The words that satisfy a task's constraints and whose strongest wrong attraction among their
    /// own faces is at most `limit` (J). The available effort determines how many are drawn if
    /// there are too many.
    pub fn new(task: &Task, limit: f64, seed: u64, work: u64) -> Self {
        let number = number(task.places, task.magnets);
        let complete = number <= MOST_ENUMERATED && number * task.judgement() as f64 <= work as f64;
        if !complete {
            let count = (work / (JUDGED * task.judgement())).clamp(2 * CHUNK as u64, SAMPLE);
            return Self::sampled(task, limit, seed, count as usize);
        }
        let words: Vec<Word> = match task.magnets == task.places {
            true => parallel::flat_map(0..1 << task.places, |set| {
                let word = task.word(set as u64, !set as u64);
                Some(word).filter(|word| sound(task, limit, word))
            }),
            false => parallel::flat_map(&places_of(task.places, task.magnets), |places| {
                let words = with_poles(*places, |north, south| task.word(north, south));
                words.filter(|word| sound(task, limit, word))
            }),
        };
        Self::ordered(words, complete, number as u64 * task.judgement())
    }

    /// The suitable ones of about `count` words drawn at random.
    pub fn sampled(task: &Task, limit: f64, seed: u64, count: usize) -> Self {
        let words = parallel::flat_map(0..count / CHUNK, |chunk| {
            let words = drawn(task, seed, chunk).map(|word| match task.exchangeable() {
                true => word.min(word.mate()),
                false => word,
            });
            words.filter(|word| sound(task, limit, word))
        });
        Self::ordered(words, false, count as u64 * (DRAWN + task.judgement()))
    }

    fn ordered(mut words: Vec<Word>, complete: bool, work: u64) -> Self {
        words.sort_unstable();
        words.dedup();
        Self {
            words,
            complete,
            work,
        }
    }
}

/// Whether a word satisfies a task's constraints and its strongest wrong attraction among its own
/// faces is at most `limit` (J).
fn sound(task: &Task, limit: f64, word: &Word) -> bool {
    let (lags, rules) = (&task.lags, &task.rules);
    (!task.exchangeable() || *word <= word.mate())
        && task.constraints.allow(lags, rules, *word)
        && rules.within(lags, *word, *word, limit)
}

/// The number of words with this many places and magnets.
pub fn number(places: usize, magnets: usize) -> f64 {
    let choose = (0..magnets).map(|k| (places - k) as f64 / (k + 1) as f64);
    choose.map(|factor| 2.0 * factor).product()
}

/// All sets of this many places, ascending (Gosper's hack).
fn places_of(places: usize, magnets: usize) -> Vec<u64> {
    let mut all = Vec::new();
    let mut set: u128 = (1 << magnets) - 1;
    while set < 1 << places {
        all.push(set as u64);
        let (low, ripple) = (set & set.wrapping_neg(), set + (set & set.wrapping_neg()));
        set = (((ripple ^ set) >> 2) / low) | ripple;
    }
    all
}

/// All words with magnets in these places.
fn with_poles(set: u64, word: impl Fn(u64, u64) -> Word) -> impl Iterator<Item = Word> {
    let mut north = Some(0u64);
    std::iter::from_fn(move || {
        let now = north?;
        // The next subset.
        let next = now.wrapping_sub(set) & set;
        north = (next != 0).then_some(next);
        Some(word(now, set & !now))
    })
}

/// Words at random.
fn drawn(task: &Task, seed: u64, chunk: usize) -> impl Iterator<Item = Word> {
    let (places, magnets) = (task.places, task.magnets);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(chunk as u64);
    (0..CHUNK).map(move |_| {
        let chosen = sample(&mut rng, places, magnets).into_iter();
        let set = chosen.fold(0u64, |set, k| set | 1 << k);
        let north = rng.random::<u64>() & set;
        task.word(north, set & !north)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_places_are_all_there() {
        assert_eq!(places_of(6, 3).len(), 20);
        assert_eq!(number(28, 4), 327_600.0);
        assert_eq!(
            with_poles(0b1011, |north, south| Word::new(north, south, 4)).count(),
            8
        );
        assert_eq!(places_of(64, 1).len(), 64);
    }
}
