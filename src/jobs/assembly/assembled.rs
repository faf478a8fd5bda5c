//! A tile set that was built, whole.

use super::choice::Choice;
use super::slides::Slid;
use super::{Built, Request};
use crate::design::{Design, WordSet};
use physics::tile::Magnet;
use physics::words::Word;

/// A tile set that was built, and all that reproduces it.
pub struct Assembly<'a> {
    /// It.
    pub built: Built,
    /// What was asked.
    pub request: Request,
    /// Where its words come from.
    pub words: WordSet,
    /// The text of `words.toml`.
    pub words_toml: String,
    /// The design of which thickness, mass and table are taken, if one was given.
    pub design: Option<&'a Design>,
    /// What was tried to find words; empty where they were given.
    pub tried: Vec<Choice>,
}

impl Assembly<'_> {
    /// What a face is called.
    pub fn face(&self, face: usize) -> String {
        self.built.matrix.name(face)
    }

    /// Where a word's magnets lie along the face (m), and their poles.
    pub fn magnets(&self, word: Word) -> Vec<(f64, char)> {
        let pitch = self.words.stage.pitch.unwrap_or_default();
        let middle = (word.places() as f64 - 1.0) / 2.0;
        let at = |k: usize| match &self.words.places {
            Some(places) => places[k],
            None => (k as f64 - middle) * pitch,
        };
        let pole = |k: usize| match word.at(k) {
            1 => Some('N'),
            -1 => Some('S'),
            _ => None,
        };
        (0..word.places())
            .filter_map(|k| Some((at(k), pole(k)?)))
            .collect()
    }

    /// From the face to the magnets' outer pole faces (m).
    pub fn inset(&self) -> f64 {
        let (tile, magnet) = (&self.words.stage.pair.fixed, self.magnet());
        let face = &tile.faces[magnet.face];
        let depth = -(magnet.position - face.middle()).dot(&face.normal());
        let inset = depth - magnet.size[0] / 2.0;
        // What rounding leaves.
        match inset.abs() < 1e-9 {
            true => 0.0,
            false => (inset * 1e12).round() / 1e12,
        }
    }

    /// A magnet like all of them.
    pub fn magnet(&self) -> &Magnet {
        &self.words.stage.pair.fixed.magnets[0]
    }

    /// Of every two faces what holds them slid, where words have a pitch.
    pub fn slides(&self) -> Vec<Slid> {
        let rules = self.request.rules();
        let lags = Built::lags(&self.words).filter(|_| rules.slides());
        let Some(lags) = lags else {
            return Vec::new();
        };
        let matrix = &self.built.matrix;
        let faces = matrix.energies.len();
        let pairs = (0..faces).flat_map(|i| (i..faces).map(move |j| [i, j]));
        let of =
            |faces: [usize; 2]| Slid::of(&lags, &rules, faces, faces.map(|it| matrix.code(it)));
        pairs.map(of).collect()
    }
}
