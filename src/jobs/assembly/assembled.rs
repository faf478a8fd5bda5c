//! A tile set with its words and simulated growths: the complete result.

use std::path::Path;

use super::built::Verdict;
use super::choice::Choice;
use super::kinetic::{Growth, Kinetics};
use super::slides::{self, Slid};
use super::{Built, Request, TileSet, Wiring, lattice, proofread, square};
use crate::Refused;
use crate::design::{Design, WordSet};
use physics::kinetics::bond::Shaking;
use physics::observer::Observer;
use physics::tile::Magnet;
use physics::words::Word;

/// A tile set built from magnets, with everything needed to reproduce it.
pub struct Assembly<'a> {
    /// The built set.
    pub built: Built,
    /// The request.
    pub request: Request,
    /// The source of its words.
    pub words: WordSet,
    /// The text of `words.toml`.
    pub words_toml: String,
    /// The design that thickness, mass and table are taken from, if one is given.
    pub design: Option<&'a Design>,
    /// The attempts of the search for words; empty if the words were given.
    pub tried: Vec<Choice>,
    /// Simulated growth at the requested kT, with errors.
    pub growth: Growth,
    /// The same at other kT at which something may grow, in ascending order: kT (J) and growth.
    pub others: Vec<(f64, Growth)>,
    /// The slid contacts of every two faces; empty if words have no pitch.
    pub slides: Vec<Slid>,
}

/// Numbers of simulated growths at the requested kT and at each other kT, for large sets.
const RUNS: [usize; 2] = [100, 40];
const RUNS_OF_LARGE: [usize; 2] = [40, 20];
/// Sets that grow into more tiles than this are large.
const LARGE: usize = 100;
/// The other kT, as shares of the highest at which anything grows.
const TRIED: [f64; 10] = [0.3, 0.4, 0.5, 0.6, 0.7, 0.78, 0.84, 0.89, 0.93, 0.97];
/// A kT counts as right if at least this share of growths is.
const RIGHT: f64 = 0.95;

impl Request {
    /// The tile set of a file, or a generated one: `lattice`, `homogeneous`, `square`.
    ///
    /// # Errors
    /// If there is no such set, or options contradict it.
    pub fn tile_set(&self, file: &Path) -> Result<TileSet, Refused> {
        // If a file name is not valid text, this is some other text.
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

    /// Builds a tile set from words: from the given ones, with the text of their file, or else from
    /// a search.
    ///
    /// # Errors
    /// If there are no such words, or too few.
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
            slides: slides::of_all(&built, &words, &self.rules()),
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

/// The text of a set of words in the order of an assembly, so that a letter means the same word in
/// every file.
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
    /// Whether the assembly grows at this kT, and without permanent errors.
    pub fn verdict(&self) -> Verdict {
        let growth = &self.growth;
        match self.built.verdict() {
            holds @ (Verdict::TauHolds | Verdict::OneHolds) => match () {
                () if is_right(growth) => holds,
                () if growth.wrong > 0 => Verdict::ErrorsStay,
                () => Verdict::Slow,
            },
            Verdict::TooHard if is_right(growth) => Verdict::MoreHold,
            other => other,
        }
    }

    /// The suggested kT (J): the one at which most growths are right, the middle one of several
    /// equal ones in a row; `None` if at no kT more than half of the growths are right.
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

    /// The name of a face.
    pub fn face(&self, face: usize) -> String {
        self.built.matrix.name(face)
    }

    /// The positions of a word's magnets along the face (m), and their poles.
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

    /// The distance from the face to the magnets' outer pole faces (m).
    pub fn inset(&self) -> f64 {
        let (tile, magnet) = (&self.words.stage.pair.fixed, self.magnet());
        let face = &tile.faces[magnet.face];
        let depth = -(magnet.position - face.middle()).dot(&face.normal());
        let inset = depth - magnet.size[0] / 2.0;
        // Rounding errors only.
        match inset.abs() < 1e-9 {
            true => 0.0,
            false => (inset * 1e12).round() / 1e12,
        }
    }

    /// One of the magnets, which are all alike.
    pub fn magnet(&self) -> &Magnet {
        &self.words.stage.pair.fixed.magnets[0]
    }
}

/// Whether nearly all growths are right.
fn is_right(growth: &Growth) -> bool {
    growth.right as f64 >= RIGHT * growth.runs as f64
}
