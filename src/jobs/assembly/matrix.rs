//! The energies of every two faces, flush and aligned.

use crate::design::WordSet;
use physics::words::Word;
use physics::words::set::name;

/// Energies (J) of faces that meet flush: rows and columns are words, then their mates.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// The words, without their mates.
    pub words: Vec<Word>,
    /// Their letters: those that the set of words gives them, with `*` for a mate of the set's.
    letters: Vec<String>,
    /// J.
    pub energies: Vec<Vec<f64>>,
}

impl Matrix {
    /// Computes the matrix for words of a set, in any order.
    pub fn new(set: &WordSet, words: &[Word]) -> Self {
        let by_magnets = set.carriers().flush();
        let places = words.first().map_or(0, |word| word.places());
        let mates = words.iter().map(|it| it.mate());
        let poles = |face: Word| -> Vec<f64> { (0..places).map(|k| face.at(k).into()).collect() };
        let poles: Vec<Vec<f64>> = words.iter().copied().chain(mates).map(poles).collect();
        let sum = |first: &[f64], second: &[f64]| -> f64 {
            let rows = first.iter().zip(by_magnets.chunks(places));
            let row = |row: &[f64]| row.iter().zip(second).map(|(e, p)| e * p).sum::<f64>();
            rows.map(|(pole, energies)| pole * row(energies)).sum()
        };
        let count = poles.len();
        let mut energies = vec![vec![0.0; count]; count];
        for i in 0..count {
            for j in i..count {
                energies[i][j] = sum(&poles[i], &poles[j]);
                energies[j][i] = energies[i][j];
            }
        }
        Self {
            words: words.to_vec(),
            letters: words.iter().map(|word| letter(set, *word)).collect(),
            energies,
        }
    }

    /// The depth (J) of the bond of a word or a mate.
    pub fn bond(&self, face: usize) -> f64 {
        let word = face % self.words.len();
        -self.energies[word][self.mate(word)]
    }

    /// The face that binds a face.
    pub fn mate(&self, face: usize) -> usize {
        (face + self.words.len()) % self.energies.len()
    }

    /// The face on a given side for a bond that has this word on east or north faces.
    pub fn on(&self, side: usize, word: usize) -> usize {
        match side < 2 {
            true => word,
            false => self.mate(word),
        }
    }

    /// `A` for a word, `A*` for its mate.
    pub fn name(&self, face: usize) -> String {
        match face.checked_sub(self.words.len()) {
            None => self.letters[face].clone(),
            Some(word) => turned(&self.letters[word]),
        }
    }

    /// The code of a face: a word, or a mate (after the words).
    pub fn code(&self, face: usize) -> Word {
        match self.words.get(face) {
            Some(word) => *word,
            None => self.words[face - self.words.len()].mate(),
        }
    }

    /// The strongest attraction of aligned faces among some pairs (J, negative), and the two faces.
    pub fn strongest(&self, of: &dyn Fn(usize, usize) -> bool) -> Option<(usize, usize, f64)> {
        let faces = self.energies.len();
        let pairs = (0..faces).flat_map(|i| (i..faces).map(move |j| (i, j)));
        let wrong = pairs
            .filter(|(i, j)| of(*i, *j))
            .map(|(i, j)| (i, j, self.energies[i][j]));
        wrong
            .min_by(|a, b| a.2.total_cmp(&b.2))
            .filter(|it| it.2 < 0.0)
    }
}

/// The letter of a word or a mate in a set.
fn letter(set: &WordSet, word: Word) -> String {
    let given = |k: usize| set.names.get(k).cloned().unwrap_or_else(|| name(k));
    let find = |word: Word| set.words.iter().position(|other| *other == word);
    let mate = || find(word.mate()).map(|k| turned(&given(k)));
    // Every word of a matrix is one of its set, or a mate.
    find(word).map(given).or_else(mate).unwrap_or_default()
}

/// The letter of the mate.
fn turned(letter: &str) -> String {
    match letter.strip_suffix('*') {
        Some(word) => word.to_owned(),
        None => format!("{letter}*"),
    }
}
