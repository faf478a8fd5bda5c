//! A tile set with its words and simulated growths: the complete result.

use std::path::Path;

use super::built::Verdict;
use super::choice::Choice;
use super::kinetic::{Growth, Kinetics};
use super::slides::Slid;
use super::{Built, Request, TileSet, Wiring, lattice, proofread, square};
use crate::Refused;
use crate::design::{Design, WordSet};
use physics::kinetics::bond::Shaking;
use physics::observer::Observer;
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
    /// What grows at the shaking asked for, errors included.
    pub growth: Growth,
    /// The same at others at which something may grow, the coldest first: kT (J) and what grows.
    pub others: Vec<(f64, Growth)>,
}

/// Growths at the shaking asked for, and at each other one; of large sets.
const RUNS: [usize; 2] = [100, 40];
const RUNS_OF_LARGE: [usize; 2] = [40, 20];
/// Sets that grow into more tiles are large.
const LARGE: usize = 100;
/// Shakings that are tried, as shares of the hardest at which anything grows.
const TRIED: [f64; 10] = [0.3, 0.4, 0.5, 0.6, 0.7, 0.78, 0.84, 0.89, 0.93, 0.97];
/// A shaking grows right where at least this share of growths does.
const RIGHT: f64 = 0.95;

impl Request {
    /// The tile set of a file, or one that is made to measure: `lattice`, `homogeneous`, `square`.
    ///
    /// # Errors
    /// Where there is none, or it is not asked for as it can be.
    pub fn tile_set(&self, file: &Path) -> Result<TileSet, Refused> {
        // Of a file whose name is no text this is some other text.
        let name = &file.to_string_lossy()[..];
        let wrong = match (name, self.lattice, self.side) {
            ("lattice", Some(size), None) => return Ok(lattice::unique(size)),
            ("homogeneous", Some(size), None) => return Ok(lattice::homogeneous(size)),
            ("lattice" | "homogeneous", None, _) => {
                "give the size of the lattice: --lattice 3x3".to_owned()
            }
            ("square", None, Some(side)) if square::SIDES.contains(&side) => {
                return Ok(square::counted(side));
            }
            ("square", None, Some(_)) => {
                let (least, most) = (square::SIDES.start(), square::SIDES.end());
                format!("a counted square has a side of {least} to {most} tiles")
            }
            ("square", ..) => "give the size of the square: --side 16".to_owned(),
            (_, Some(_), _) => "--lattice makes its own tile set: write lattice or homogeneous \
                instead of a file"
                .to_owned(),
            (_, _, Some(_)) => "--side is only for square".to_owned(),
            (_, None, None) => return Ok(TileSet::load(file)?),
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
        observer: &dyn Observer,
    ) -> Result<Assembly<'a>, Refused> {
        let set = proofread::blocks(tiles, self.proofread.into())?;
        let shaking = Shaking {
            kt: self.kt,
            coverage: self.coverage,
        };
        observer.stage("words", 0.0);
        let (words, built, words_toml, tried) = match words {
            Some((words, text)) => {
                let built = Built::new(&set, &words, shaking)?;
                let text = lettered(&text, &words, &built)?;
                (words, built, text, Vec::new())
            }
            None => {
                let sought = self.search(&Wiring::new(&set)?, design, observer)?;
                let text = sought.text(sought.words());
                let found = WordSet::parse(&text, "the words found", self.model)?;
                let built = Built::new(&set, &found, shaking)?;
                let text = sought.text(&built.matrix.words);
                (found, built, text, sought.tried)
            }
        };
        observer.stage("growth", 0.6);
        let engine = built.engine();
        let kinetics = |[gse, gmc]: [f64; 2]| Kinetics::new(&engine, &built.grown).at(gse, gmc);
        let runs = match built.grown.tiles.len() {
            ..=LARGE => RUNS,
            _ => RUNS_OF_LARGE,
        };
        let growth = kinetics([built.gse(), built.gmc]).growths(runs[0], self.seed);
        let hardest = built.window().map_or(0.0, |ends| ends[1]);
        let mut others = Vec::new();
        for (k, share) in TRIED.iter().enumerate() {
            observer.part("growth", k, TRIED.len());
            let kt = share * hardest;
            if let Some(costs) = built.at(&words, kt).filter(|_| kt > 0.0) {
                others.push((kt, kinetics(costs).growths(runs[1], self.seed)));
            }
        }
        Ok(Assembly {
            built,
            request: self.clone(),
            words,
            words_toml,
            design,
            tried,
            growth,
            others,
        })
    }
}

/// The text of a set of words with the words of an assembly in place of its own, in their order, so
/// that a letter means the same word in every file.
fn lettered(text: &str, words: &WordSet, built: &Built) -> Result<String, Refused> {
    let mut table: toml::Table = text.parse().map_err(|error| format!("{error}"))?;
    let matrix = &built.matrix;
    let face = |face: usize| {
        let code = matrix.code(face).to_string();
        let entry = match &words.places {
            None => format!("code = \"{code}\""),
            Some(places) => {
                let there = places.iter().zip(code.chars()).filter(|it| it.1 != '.');
                let one = |(at, pole)| format!("{{ at = {:?}, pole = \"{pole}\" }}", at + 0.0);
                format!(
                    "magnets = [{}]",
                    there.map(one).collect::<Vec<_>>().join(", ")
                )
            }
        };
        let name = matrix.name(face);
        match name.ends_with('*') {
            true => format!("\"{name}\" = {{ {entry} }}\n"),
            false => format!("{name} = {{ {entry} }}\n"),
        }
    };
    if words.places.is_none() {
        let codes = matrix.words.iter().map(ToString::to_string);
        table.insert("words".to_owned(), codes.collect::<Vec<_>>().into());
    }
    table.remove("faces");
    let faces: String = (0..matrix.energies.len()).map(face).collect();
    let unused = words.words.len() - matrix.words.len();
    let rest = match unused {
        0 => String::new(),
        unused => format!("; {unused} of its words are not needed"),
    };
    Ok(format!(
        "# The words of {}, by the letters of sheet.md and matrix.csv{rest}\n\n{table}\n[faces]\n{faces}",
        built.set.name
    ))
}

impl Assembly<'_> {
    /// Whether such a shaking grows what is wanted, and without errors that stay.
    pub fn verdict(&self) -> Verdict {
        let growth = &self.growth;
        match self.built.verdict() {
            holds @ (Verdict::TauHolds | Verdict::OneHolds) => match () {
                () if is_right(growth) => holds,
                () if growth.wrong > 0 => Verdict::ErrorsStay,
                () => Verdict::Slow,
            },
            other => other,
        }
    }

    /// The shaking (J) to be proposed: the one at which most growths are right, of several such in a
    /// row the one in the middle; `None` where none grows right more often than not.
    pub fn proposal(&self) -> Option<(f64, Growth)> {
        let share = |growth: &Growth| growth.right as f64 / growth.runs as f64;
        let shares = self.others.iter().map(|(_, growth)| share(growth));
        let most = shares.fold(0.0, f64::max);
        let is_best = |it: &&(f64, Growth)| share(&it.1) == most;
        let best: Vec<&(f64, Growth)> = self
            .others
            .iter()
            .skip_while(|it| !is_best(it))
            .take_while(is_best)
            .collect();
        let middle = best.get(best.len() / 2)?;
        (most > 0.5).then_some(**middle)
    }

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
        (0..word.places())
            .filter_map(|k| Some((at(k), word.pole(k)?.letter())))
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

/// Whether growths are right, all but few.
fn is_right(growth: &Growth) -> bool {
    growth.right as f64 >= RIGHT * growth.runs as f64
}
