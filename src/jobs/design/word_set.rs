//! Word files: `words.toml`, and sets from other sources.
//!
//! ```toml
//! words = ["NNSN", "NSSN"]       # without their mates
//! [magnet]                       # as in a design; what is not given is the paper's
//! pitch = 0.040
//! [tile]
//! side = 0.43                    # of the square tiles; as long as a word if it is not given
//! [potential]
//! model = "cuboid"               # dipoles where not given
//! [faces]                        # in place of `words`: names with codes; mates (A*) are left out
//! A = { code = "NNSN" }          # or magnets anywhere: { magnets = [{ at = 0.02, pole = "N" }] }
//! ```

use std::path::Path;

use toml::de::DeTable;

use super::drawings::Drawings;
use super::error::{DesignError, Result};
use super::face::not_placed_twice;
use super::faults::Faults;
use super::magnet::{AxisDirection, MAGNET_KEYS, MagnetKeys, missing_key};
use super::reader::{Entry, Section};
use super::source::Source;
use super::{Design, MagnetModel, file, potential, quantity, syntax, word_places, word_stage};
use physics::order::Order;
use physics::words::crosstalk::Stage;
use physics::words::{Bar, Word};

/// A set of words and the tiles that carry them.
#[derive(Clone, Debug)]
pub struct WordSet {
    /// The words, in the order of the file, of one length.
    pub words: Vec<Word>,
    /// The faces' names, if the file gives them.
    pub names: Vec<String>,
    /// The positions of the places along the face (m), if they are not one pitch apart.
    pub places: Option<Vec<f64>>,
    /// Two square tiles whose target faces, east and west, have a north pole at every place; the
    /// other faces are empty.
    pub stage: Design,
    /// The magnets.
    bar: Bar,
}

/// The keys of a set of words.
const KEYS: [&str; 7] = [
    "name",
    "description",
    "words",
    "magnet",
    "tile",
    "potential",
    "faces",
];
/// Largest number of words of a set.
const MOST_WORDS: usize = 500;

impl WordSet {
    /// Reads a set; `model` overrides the magnet model of the file.
    ///
    /// # Errors
    /// If the file cannot be read or is not a set of words.
    pub fn load(path: &Path, model: Option<MagnetModel>) -> Result<Self> {
        let name = path.display().to_string();
        let text = file::read_text(path).map_err(|found| {
            let message = format!("cannot read the set of words: {found}");
            let help = "check the path; `tilebind words --out DIR` writes one";
            DesignError::new(&name, None, message, help)
        })?;
        Self::parse(&text, &name, model)
    }

    /// The two tiles, for words of the set.
    pub fn carriers(&self) -> Stage {
        let (pair, interaction) = (&self.stage.pair, &self.stage.interaction);
        Stage::new(pair.as_ref().clone(), interaction.clone())
    }

    /// Reads a set from the text of its file.
    ///
    /// # Errors
    /// If it is not a set of words.
    pub fn parse(text: &str, name: &str, model: Option<MagnetModel>) -> Result<Self> {
        let (drawings, faults) = (Drawings::default(), Faults::default());
        let source = Source {
            file: name,
            text,
            quoted: true,
            drawings: &drawings,
            faults: &faults,
        };
        let set = syntax::parse(source).and_then(|root| Self::of(source, &root, model));
        faults.conclude(set)
    }

    fn of(source: Source, root: &DeTable, model: Option<MagnetModel>) -> Result<Self> {
        let root = Section::root(source, root, "the set of words");
        root.allow(&KEYS);
        let magnet = root.section("magnet", "[magnet]")?.map(|section| {
            section.allow(&MAGNET_KEYS);
            let keys = MagnetKeys::read(&section)?;
            if let (Some(AxisDirection::Lying(_)), Some(entry)) = (keys.axis, section.get("axis")) {
                let help = "the magnets of words are square to their face, or have axis = \"up\"";
                return Err(entry.key_error("the magnets of words are not turned", help));
            }
            Ok(keys)
        });
        let tile = root.section("tile", "[tile]")?;
        let side = tile.map(|section| {
            section.allow(&["side"]);
            section.number("side", quantity::TILE_SIDE)
        });
        let told = potential::read(&root, MagnetModel::Dipole);
        let faces = faces(&root);
        let words = root.get("words").map(|entry| entry.array());
        let (magnet, side, faces) = (magnet.transpose()?, side.transpose()?.flatten(), faces?);
        let bar = word_stage::bar(magnet.unwrap_or_default(), model.unwrap_or(told?));
        let bar = bar.map_err(|key| missing_key(key, |message, help| root.error(message, help)));
        source.faults.check()?;
        let bar = bar?;
        let own = |key: &str| {
            let own = faces.iter().filter(|(name, _)| !name.ends_with('*'));
            let own = own.filter_map(|(name, face)| Some((*name, face.get(key)?)));
            own.collect::<Vec<(&str, Entry)>>()
        };
        let (given, width, spaced) = (words.transpose()?, bar.size[1], own("magnets"));
        if given.is_none() && !spaced.is_empty() {
            if let Some((_, face)) = faces.iter().find(|(_, face)| face.get("magnets").is_none()) {
                let message = "some of its faces have `code` and others `magnets`";
                return Err(face.error(message, "use one of the two for all"));
            }
            let side = side.ok_or_else(|| {
                let message = "the length of its faces is missing";
                root.error(message, "write side = 0.43 under [tile]")
            })?;
            let (places, words) = word_places::common(&spaced, &bar, side)?;
            return Ok(Self {
                words,
                names: spaced.iter().map(|(name, _)| (*name).to_owned()).collect(),
                stage: word_stage::stage(&bar, side, &places, source.file)?,
                places: Some(places),
                bar,
            });
        }
        let (names, codes) = match given {
            Some(entries) => (Vec::new(), entries),
            None => own("code")
                .into_iter()
                .map(|(name, code)| (name.to_owned(), code))
                .unzip(),
        };
        let words = read_words(&codes, &bar)?;
        let count = words.first().map_or(0, |word| word.places());
        if words.is_empty() {
            let help = "list them: words = [\"NNSN\", \"NSSN\"]";
            return Err(DesignError::new(source.file, None, "it has no words", help));
        }
        let pitch = bar.pitch;
        let needed = pitch * (count as f64 - 1.0) + width;
        let side = side.unwrap_or(needed.max(pitch * count as f64));
        if needed > side * (1.0 + 1e-9) {
            let message = format!(
                "words of {count} positions {pitch} m apart need a face of {needed:.4} m, not \
                 {side} m"
            );
            return Err(root.error(message, "make [tile] side longer, or leave it out"));
        }
        Ok(Self {
            words,
            names,
            places: None,
            stage: word_stage::stage(&bar, side, &even(count, pitch), source.file)?,
            bar,
        })
    }

    /// The same words on square tiles of another side (m).
    ///
    /// # Errors
    /// If they do not fit there.
    pub fn on_side(self, side: f64) -> Result<Self> {
        let count = self.words.first().map_or(0, |word| word.places());
        let even = even(count, self.bar.pitch);
        let places = self.places.as_ref().unwrap_or(&even);
        let reach = places.iter().fold(0.0, |most: f64, at| most.max(at.abs()));
        let needed = 2.0 * reach + self.bar.size[1];
        if needed > side * (1.0 + 1e-9) {
            let message = format!(
                "words of {count} positions need a face of {needed:.4} m, and the design's has \
                 {side} m"
            );
            let help = "use shorter words, a smaller pitch or a longer side";
            return Err(DesignError::new("words", None, message, help));
        }
        let stage = word_stage::stage(&self.bar, side, places, "words")?;
        Ok(Self { stage, ..self })
    }
}

/// Places (m) one pitch apart, with their middle in the middle of the face.
fn even(count: usize, pitch: f64) -> Vec<f64> {
    let middle = (count as f64 - 1.0) / 2.0;
    (0..count).map(|k| (k as f64 - middle) * pitch).collect()
}

/// The faces of a set, including mates, by name.
fn faces<'a>(root: &Section<'a>) -> Result<Vec<(&'a str, Section<'a>)>> {
    let Some(section) = root.section("faces", "[faces]")? else {
        return Ok(Vec::new());
    };
    let mut entries = section.entries();
    entries.order_by_key(|entry| entry.key);
    let face = |entry: &Entry<'a>| {
        let face = entry.section(entry.key)?;
        face.allow(&["code", "magnets"]);
        not_placed_twice(&face)?;
        Ok((entry.key, face))
    };
    entries.iter().map(face).collect()
}

/// Reads words of equal length, each once.
fn read_words(codes: &[Entry], bar: &Bar) -> Result<Vec<Word>> {
    let mut words: Vec<Word> = Vec::new();
    let [first, second] = word_places::letters(bar);
    for entry in codes {
        let code = entry.string()?;
        let help = format!("use {first}, {second} and .");
        let word =
            Word::parse(code).map_err(|found| entry.error(format!("`{code}`: {found}"), &help))?;
        if word.magnets() > 0 && word.standing(bar.form.stands.is_some()) != word {
            let message = match bar.form.stands {
                Some(_) => format!("`{code}` is for magnets in the plane, but these are upright"),
                None => format!(
                    "`{code}` is for upright magnets (axis = \"up\"), but these are \
                    in the plane"
                ),
            };
            return Err(entry.error(message, &help));
        }
        let first = words.first().copied().unwrap_or(word);
        if first.places() != word.places() {
            let (own, others) = (word.places(), first.places());
            let message = format!("`{code}` has {own} positions and `{first}` has {others}");
            let help = "words of a set have the same length; fill up with . (no magnet)";
            return Err(entry.error(message, help));
        }
        if word.magnets() == 0 {
            return Err(entry.error(format!("`{code}` has no magnets"), help));
        }
        if words.contains(&word) {
            return Err(entry.error(format!("`{code}` is there twice"), "remove one"));
        }
        if words.len() == MOST_WORDS {
            let message = format!("it has {} words, more than {MOST_WORDS}", codes.len());
            return Err(entry.error(message, "split the set"));
        }
        words.push(word);
    }
    Ok(words)
}
