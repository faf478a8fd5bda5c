//! What an assembly is asked for.

use std::path::Path;

use clap::Args;

use super::choice::{self, Choice, Class, Verdict};
use super::{Assembly, Built, TileSet, Wiring, lattice, proofread, square};
use crate::Refused;
use crate::design::{Design, MagnetModel, WordSet};
use crate::request;
use crate::word_sets::{self, file};
use physics::kinetics::bond::Shaking;
use physics::units::si;
use physics::words::{Bar, Rules, Shape};

/// The least gap where none is asked for.
const GAP: f64 = 0.5;

/// How a tile set is built of magnets, and of which words.
#[derive(Clone, Debug, Args)]
pub struct Request {
    /// Effective energy kT of the shaking (J)
    #[arg(long, value_name = "E", value_parser = request::shaking)]
    pub kt: f64,

    /// Share of the table that loose tiles cover, all kinds together
    #[arg(long, value_name = "F", default_value_t = 0.3, value_parser = request::fraction)]
    pub coverage: f64,

    /// Rows and columns of a lattice
    #[arg(long, value_name = "MxN", value_parser = rows_and_columns)]
    pub lattice: Option<[usize; 2]>,

    /// Side of a counted square (tiles)
    #[arg(long, value_name = "N", value_parser = request::count)]
    pub side: Option<usize>,

    /// Blocks of K x K tiles in place of tiles, against errors
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = request::whole(1, 6))]
    pub proofread: u16,

    /// Places of a face [default: the fewest that carry the words]
    #[arg(long, value_name = "L", value_parser = request::count)]
    pub length: Option<usize>,

    /// Magnets of the strongest bonds' words, where spacing is code too [default: one a place]
    #[arg(long, value_name = "K", value_parser = request::count)]
    pub magnets: Option<usize>,

    /// Least gap of the words, from 0 to 1 [default: 0.5; with --length the widest there is]
    #[arg(long, value_name = "G", value_parser = word_sets::gap)]
    pub gap: Option<f64>,

    /// Complementary shapes of the faces: none; shared, one that any two have and that forbids
    /// slides; polar, knobs on words and slots on mates. Designs are written flat all the same
    #[arg(long, value_name = "KIND", default_value = "none", value_parser = word_sets::shape(),
          hide_possible_values = true)]
    pub shape: Shape,

    /// From place to place (m) [default: the design's, or 0.04]
    #[arg(long, value_name = "M", value_parser = request::length)]
    pub pitch: Option<f64>,

    /// Model of the magnets, dipole or cuboid [default: the design's]
    #[arg(long, value_name = "MODEL", value_parser = request::model(), hide_possible_values = true)]
    pub model: Option<MagnetModel>,

    /// Work to spend on words, as what takes about so many seconds of a core; it is counted, so
    /// that the same work gives the same words everywhere
    #[arg(long, value_name = "S", default_value_t = 20.0, value_parser = request::positive)]
    pub seconds: f64,

    /// Seed of all random numbers: the same seed gives the same results
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = request::seed)]
    pub seed: u64,
}

fn rows_and_columns(text: &str) -> Result<[usize; 2], String> {
    let most = lattice::MOST_TILES;
    let read = || {
        let (rows, columns) = text.split_once(['x', 'X', ','])?;
        let size: [usize; 2] = [rows.trim().parse().ok()?, columns.trim().parse().ok()?];
        let tiles = size[0].checked_mul(size[1])?;
        (2..=most).contains(&tiles).then_some(size)
    };
    read().ok_or_else(|| format!("a lattice is ROWSxCOLUMNS, such as 3x3, of 2 to {most} tiles"))
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

    /// Which meetings are wrong.
    pub fn rules(&self) -> Rules {
        Rules {
            shape: self.shape,
            ..Rules::default()
        }
    }

    /// Words for the bonds of a tile set, as the text of a set, and what was tried. Magnets are
    /// those of a design's target face, or the paper's.
    fn search(
        &self,
        wiring: &Wiring,
        design: Option<&Design>,
    ) -> Result<(String, Vec<Choice>), String> {
        let (bar, face) = word_sets::bar(design, self.pitch, self.model)?;
        let most = self.most_places(&bar, face)?;
        let demand = wiring.demand();
        let tried = match self.length {
            Some(places) => choice::choose(&demand, places, &bar, self),
            None => choice::shortest(&demand, most, &bar, self),
        };
        match tried.last() {
            Some(last) if last.verdict == Verdict::Found => {
                let (words, places) = (&last.words, last.places);
                let headline = format!("{} words of {places} places", words.len());
                let side = face.unwrap_or_else(|| word_sets::side(&bar, places));
                Ok((file::of_words(&headline, words, &bar, side), tried))
            }
            Some(last) => Err(missing(last)),
            None => Err("the face holds no magnet".to_owned()),
        }
    }

    /// The least gap of words; where `None` the widest there is.
    pub(super) fn least_gap(&self) -> Option<f64> {
        self.gap.or(self.length.is_none().then_some(GAP))
    }

    /// The longest face to look at, of which the design's may be this long (m).
    fn most_places(&self, bar: &Bar, face: Option<f64>) -> Result<usize, String> {
        let fitting = |side: f64| ((side - bar.size[1]) / bar.pitch + 1e-9).floor() as usize + 1;
        let most = face.map_or(choice::MOST_PLACES, fitting);
        let most = most.min(choice::MOST_PLACES);
        let places = self.length.unwrap_or(most);
        let magnets = self.magnets.unwrap_or(0);
        Err(match self.length {
            Some(length) if length > most => format!(
                "a face of {length} places is too long: {most} at most, {} apart",
                si(bar.pitch, "m", 3)
            ),
            Some(_) if magnets > places => format!(
                "{magnets} magnets do not fit into {places} places: give a length of {magnets} or more"
            ),
            None if magnets > places => {
                format!("{magnets} magnets do not fit into a face of {places} places")
            }
            _ => return Ok(most),
        })
    }
}

/// What there is too few of, and whether there can be more.
fn missing(choice: &Choice) -> String {
    let classes = &choice.classes;
    let sum = |of: fn(&Class) -> usize| classes.iter().map(of).sum::<usize>();
    let magnets = |class: &Class| match class.magnets {
        1 => "1 magnet".to_owned(),
        magnets => format!("{magnets} magnets"),
    };
    let needed = classes.iter();
    let needed = needed.map(|class| format!("{} with {}", class.needed, magnets(class)));
    let why = match classes.iter().find(|it| it.upper < it.needed) {
        Some(class) => format!(
            "there are not enough, proved: of those with {} at most {}",
            magnets(class),
            class.upper
        ),
        None => "whether there are more is open, and more seconds search longer".to_owned(),
    };
    format!(
        "{} words ({}) with a gap of {:.3} on faces of {} places: {} were found, {why}; give a \
         longer face, a narrower gap, or the words",
        sum(|it| it.needed),
        needed.collect::<Vec<_>>().join(", "),
        choice.gap,
        choice.places,
        sum(|it| it.found),
    )
}
