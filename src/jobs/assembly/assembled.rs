//! A tile set with its words and simulated growths: the complete result.

use std::path::Path;

use super::built::{GrowthVerdict, Plan, Shaken};
use super::choice::Choice;
use super::kinetic::{Growth, Kinetics};
use super::matrix::Matrix;
use super::slides::{self, Slid};
use super::{Built, Request, TileSet, Wiring, lattice, proofread, square};
use crate::design::{Design, WordSet};
use crate::{Refused, word_sets};
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
    /// Its growth on a shaken table; `None` for a set that is laid by hand.
    pub growing: Option<Growing>,
    /// The slid contacts of every two faces; empty if words have no pitch.
    pub slides: Vec<Slid>,
}

/// The growth of a set on a shaken table.
pub struct Growing {
    /// Energies at the requested kT.
    pub shaken: Shaken,
    /// Simulated growth at the requested kT, with errors.
    pub growth: Growth,
    /// The same at other kT at which something may grow, in ascending order: kT (J) and growth.
    pub others: Vec<(f64, Growth)>,
}

impl Growing {
    /// Whether the assembly grows at this kT, and without permanent errors.
    pub fn verdict(&self, built: &Built) -> GrowthVerdict {
        let growth = &self.growth;
        match built.verdict(&self.shaken) {
            holds @ (GrowthVerdict::TauHolds | GrowthVerdict::OneHolds) => match () {
                () if is_right(growth) => holds,
                () if growth.wrong > 0 => GrowthVerdict::ErrorsStay,
                () => GrowthVerdict::Slow,
            },
            GrowthVerdict::TooHard if is_right(growth) => GrowthVerdict::MoreHold,
            GrowthVerdict::FewerHold if is_right(growth) => GrowthVerdict::FewerSuffice,
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

    /// The same as [`Request::build`], without checking the designs.
    pub(super) fn assembled<'a>(
        &self,
        tiles: &TileSet,
        words: Option<(WordSet, String)>,
        design: Option<&'a Design>,
        observer: &dyn Observer,
    ) -> Result<Assembly<'a>, Refused> {
        let set = proofread::blocks(tiles, self.proofread.into())?;
        let plan = Plan {
            laid: self.kt.is_none(),
            given: words.is_some(),
        };
        observer.stage("words", 0.0);
        let (words, built, words_toml, tried) = match words {
            Some((words, text)) => {
                let words = match design {
                    Some(design) => words.on_side(word_sets::face(design))?,
                    None => words,
                };
                let built = Built::new(&set, &words, plan)?;
                let text = lettered(&text, &words, &built)?;
                (words, built, text, Vec::new())
            }
            None => {
                let sought = self.search(&Wiring::new(&set)?, design, observer)?;
                let text = sought.text(sought.words());
                let found = WordSet::parse(&text, "the words found", self.model)?;
                let mut built = Built::new(&set, &found, plan)?;
                // Letters in the order of the bonds.
                let text = sought.text(&built.matrix.words);
                let found = WordSet::parse(&text, "the words found", self.model)?;
                built.matrix = Matrix::new(&found, &built.matrix.words);
                (found, built, text, sought.tried)
            }
        };
        let growing = match self.kt {
            Some(kt) => Some(self.grow(&built, &words, kt, observer)?),
            None => None,
        };
        Ok(Assembly {
            slides: slides::of_all(&built, &words, &self.rules()),
            built,
            request: self.clone(),
            words,
            words_toml,
            design,
            tried,
            growing,
        })
    }

    /// Simulates growth on a table shaken at kT (J), and at other kT.
    fn grow(
        &self,
        built: &Built,
        words: &WordSet,
        kt: f64,
        observer: &dyn Observer,
    ) -> Result<Growing, String> {
        observer.stage("growth", 0.6);
        let at = |kt: f64| {
            let coverage = self.coverage;
            built.shaken(words, Shaking { kt, coverage })
        };
        let shaken = at(kt)?;
        let engine = built.engine(&shaken);
        let grown = |it: &Shaken, runs: usize| {
            let kinetics = Kinetics::new(&engine, &built.grown).at(it.gse, it.gmc);
            kinetics.growths(runs, self.seed)
        };
        let runs = match built.grown.tiles.len() {
            ..=LARGE => RUNS,
            _ => RUNS_OF_LARGE,
        };
        let growth = grown(&shaken, runs[0]);
        let hardest = built.window(&shaken).map_or(0.0, |ends| ends[1]);
        let mut others = Vec::new();
        for (k, share) in TRIED.iter().enumerate() {
            observer.part("growth", k, TRIED.len());
            let kt = share * hardest;
            if kt > 0.0
                && let Ok(other) = at(kt)
            {
                others.push((kt, grown(&other, runs[1])));
            }
        }
        Ok(Growing {
            shaken,
            growth,
            others,
        })
    }
}

/// The text of a given set of words with the letters of its faces, which are the same in every file
/// of the assembly, and with the side of the tiles that carry them.
fn lettered(text: &str, words: &WordSet, built: &Built) -> Result<String, Refused> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut table: toml::Table = text.parse().map_err(|error| format!("{error}"))?;
    let all = Matrix::new(words, &words.words);
    let face = |face: usize| {
        let code = all.code(face).to_string();
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
        let name = all.name(face);
        let is_bare = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
        let name = match !name.is_empty() && name.chars().all(is_bare) {
            true => name,
            false => toml::Value::from(name).to_string(),
        };
        format!("{name} = {{ {entry} }}\n")
    };
    if words.places.is_none() && words.names.is_empty() {
        let codes = all.words.iter().map(ToString::to_string);
        table.insert("words".to_owned(), codes.collect::<Vec<_>>().into());
    }
    let side = words.stage.pair.fixed.faces[0].length();
    let side = toml::Table::from_iter([("side".to_owned(), ((side * 1e9).round() / 1e9).into())]);
    table.insert("tile".to_owned(), side.into());
    table.remove("faces");
    let n = all.words.len();
    let faces: String = (0..n).flat_map(|k| [face(k), face(k + n)]).collect();
    let unused = n - built.matrix.words.len();
    let rest = match unused {
        0 => String::new(),
        1 => "; 1 of them is not needed".to_owned(),
        unused => format!("; {unused} of them are not needed"),
    };
    Ok(format!(
        "# The words of {}, by the letters of sheet.md and matrix.csv{rest}\n\n{table}\n[faces]\n{faces}",
        built.set.name
    ))
}

impl Assembly<'_> {
    /// The number of each tile: in the growth without errors, or to be laid by hand.
    pub fn counts(&self) -> Vec<usize> {
        let set = &self.built.set;
        match self.growing {
            Some(_) => self.built.grown.counts(set.tiles.len()),
            None => set.laid(),
        }
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
