//! The energies of every two faces, flush and aligned.

use crate::design::WordSet;
use physics::words::Word;
use physics::words::crosstalk::Stage;

/// Energies (J) of faces that meet flush: rows and columns are words, then their mates.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// The words, without their mates.
    pub words: Vec<Word>,
    /// J.
    pub energies: Vec<Vec<f64>>,
}

impl Matrix {
    /// Of words of a set, in any order.
    pub fn new(set: &WordSet, words: &[Word]) -> Self {
        let stage = Stage::new(
            set.stage.pair.as_ref().clone(),
            set.stage.interaction.clone(),
        );
        let by_magnets = stage.flush();
        let places = words.first().map_or(0, |word| word.places());
        let faces: Vec<Word> = words
            .iter()
            .copied()
            .chain(words.iter().map(|it| it.mate()))
            .collect();
        let poles: Vec<Vec<f64>> = faces
            .iter()
            .map(|face| (0..places).map(|k| f64::from(face.at(k))).collect())
            .collect();
        let sum = |first: &[f64], second: &[f64]| -> f64 {
            let rows = first.iter().zip(by_magnets.chunks(places));
            let row = |row: &[f64]| row.iter().zip(second).map(|(e, p)| e * p).sum::<f64>();
            rows.map(|(pole, energies)| pole * row(energies)).sum()
        };
        let mut energies = vec![vec![0.0; faces.len()]; faces.len()];
        for i in 0..faces.len() {
            for j in i..faces.len() {
                let energy = sum(&poles[i], &poles[j]);
                energies[i][j] = energy;
                energies[j][i] = energy;
            }
        }
        Self {
            words: words.to_vec(),
            energies,
        }
    }

    /// The depth (J) of the bond of a word and its mate.
    pub fn bond(&self, word: usize) -> f64 {
        -self.energies[word][word + self.words.len()]
    }

    /// The code of a face: a word, or a mate behind the words.
    pub fn code(&self, face: usize) -> Word {
        match self.words.get(face) {
            Some(word) => *word,
            None => self.words[face - self.words.len()].mate(),
        }
    }

    /// The strongest wrong attraction of aligned faces (J, below zero), and whose.
    pub fn strongest_wrong(&self) -> Option<(usize, usize, f64)> {
        let (n, faces) = (self.words.len(), self.energies.len());
        let pairs = (0..faces).flat_map(|i| (i..faces).map(move |j| (i, j)));
        let wrong = pairs
            .filter(|(i, j)| j - i != n)
            .map(|(i, j)| (i, j, self.energies[i][j]));
        wrong
            .min_by(|a, b| a.2.total_cmp(&b.2))
            .filter(|it| it.2 < 0.0)
    }
}
