//! A tile set built of words, whole.

use std::path::Path;

use super::choice::Choice;
use super::slides::Slid;
use super::{Built, Request, TileSet, Wiring, lattice, proofread, square};
use crate::Refused;
use crate::design::{Design, WordSet};
use physics::kinetics::bond::Shaking;
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

impl Request {
    /// The tile set of a file, or one that is made to measure: `lattice`, `homogeneous`, `square`.
    ///
    /// # Errors
    /// Where there is none, or it is not asked for as it can be.
    pub fn tile_set(&self, name: &Path) -> Result<TileSet, Refused> {
        let name = name.to_str().unwrap_or("lattice");
        let wrong = match (name, self.lattice, self.side) {
            ("lattice", Some(size), None) => return Ok(lattice::unique(size)),
            ("homogeneous", Some(size), None) => return Ok(lattice::homogeneous(size)),
            ("lattice" | "homogeneous", None, _) => {
                "say how large the lattice is: --lattice 3x3".to_owned()
            }
            ("square", None, Some(side)) if square::SIDES.contains(&side) => {
                return Ok(square::counted(side));
            }
            ("square", None, Some(_)) => {
                let (least, most) = (square::SIDES.start(), square::SIDES.end());
                format!("a counted square has a side of {least} to {most} tiles")
            }
            ("square", ..) => "say how large the square is: --side 16".to_owned(),
            (_, Some(_), _) => "--lattice makes a tile set of its own: write lattice or \
                                homogeneous in place of a file"
                .to_owned(),
            (_, _, Some(_)) => "--side goes with square".to_owned(),
            (file, None, None) => return Ok(TileSet::load(Path::new(file))?),
        };
        Err(wrong.into())
    }

    /// A tile set built of words: those given, with the text of their file, or else searched.
    ///
    /// # Errors
    /// Where there are no such words, or not enough.
    pub fn build<'a>(
        &self,
        tiles: &TileSet,
        words: Option<(WordSet, String)>,
        design: Option<&'a Design>,
    ) -> Result<Assembly<'a>, Refused> {
        let set = proofread::blocks(tiles, self.proofread.into());
        let ((words, words_toml), tried) = match words {
            Some(given) => (given, Vec::new()),
            None => {
                let (text, tried) = self.search(&Wiring::new(&set)?, design)?;
                let found = WordSet::parse(&text, "the words found", self.model)?;
                ((found, text), tried)
            }
        };
        let shaking = Shaking {
            kt: self.kt,
            coverage: self.coverage,
        };
        Ok(Assembly {
            built: Built::new(&set, &words, shaking)?,
            request: self.clone(),
            words,
            words_toml,
            design,
            tried,
        })
    }
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
