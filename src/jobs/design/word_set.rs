//! Files of words: `words.toml`, and sets from elsewhere.
//!
//! ```toml
//! words = ["NNSN", "NSSN"]       # without their mates
//! [magnet]                       # as in a design; what is not given is the paper's
//! pitch = 0.040
//! [tile]
//! side = 0.43                    # of the square tiles; as long as a word if it is not given
//! [potential]
//! model = "cuboid"
//! [faces]                        # in place of `words`: names with codes; mates (A*) are left out
//! A = { code = "NNSN" }          # or magnets anywhere: { magnets = [{ at = 0.02, pole = "N" }] }
//! ```

use std::ops::Range;
use std::path::Path;

use super::word_places::{self, MagnetAt};
use super::word_stage::{Entries, PITCH, SIZE, stage};
use super::{Design, DesignError, MagnetModel, Place, file};
use physics::words::Word;
use physics::words::crosstalk::Stage;

/// A set of words and what carries them.
#[derive(Clone, Debug)]
pub struct WordSet {
    /// The words, in the order of the file, of one length.
    pub words: Vec<Word>,
    /// The faces' names, where the file gives them.
    pub names: Vec<String>,
    /// Where the places lie along the face (m), where they are not a pitch apart.
    pub places: Option<Vec<f64>>,
    /// Two square tiles whose target faces, east and west, carry a north pole in every place, and
    /// nothing elsewhere.
    pub stage: Design,
}

/// Most words of a set.
const MOST_WORDS: usize = 500;

impl WordSet {
    /// Reads a set; magnets as `model` says, if it says so.
    ///
    /// # Errors
    /// Where the file cannot be read or is no set of words.
    pub fn load(path: &Path, model: Option<MagnetModel>) -> Result<Self, DesignError> {
        let name = path.display().to_string();
        let error = |message: String, help: &str| DesignError {
            also: Vec::new(),
            file: name.clone(),
            place: None,
            message,
            help: help.to_owned(),
        };
        let text = file::read_text(path).map_err(|found| {
            error(
                format!("cannot read the set of words: {found}"),
                "check the path; `tilebind words --out DIR` writes one",
            )
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
    /// Where it is no set of words.
    pub fn parse(text: &str, name: &str, model: Option<MagnetModel>) -> Result<Self, DesignError> {
        let error = |at: Option<Range<usize>>, message: String, help: &str| DesignError {
            also: Vec::new(),
            file: name.to_owned(),
            place: at.map(|span| Place::new(text, span.into()).into()),
            message,
            help: help.to_owned(),
        };
        let entries: Entries = toml::from_str(text).map_err(|found| {
            let help = "write words = [\"NNSN\", ...], with [magnet] and [tile] below";
            error(found.span(), found.message().trim().to_owned(), help)
        })?;
        let place_of = |code: &str| {
            let at = text.find(&format!("\"{code}\""))?;
            Some(at + 1..at + 1 + code.len())
        };
        let faces = entries
            .faces
            .iter()
            .filter(|(name, _)| !name.ends_with('*'));
        let spaced: Vec<(String, Vec<MagnetAt>)> = faces
            .clone()
            .filter_map(|(name, face)| Some((name.clone(), face.magnets.clone()?)))
            .collect();
        if entries.words.is_none() && !spaced.is_empty() {
            return Self::of_spaced(&entries, &spaced, model, name);
        }
        let codes = match &entries.words {
            Some(words) => words.clone(),
            None => faces.filter_map(|(_, face)| face.code.clone()).collect(),
        };
        let mut words: Vec<Word> = Vec::new();
        for code in &codes {
            let word = Word::parse(code).map_err(|found| {
                error(
                    place_of(code),
                    format!("`{code}`: {found}"),
                    "write it of N, S and .",
                )
            })?;
            let first = words.first().copied().unwrap_or(word);
            if first.places() != word.places() {
                let message = format!(
                    "`{code}` has {} places and `{first}` {}",
                    word.places(),
                    first.places()
                );
                let help = "words of a set are of one length; fill up with . (no magnet)";
                return Err(error(place_of(code), message, help));
            }
            if word.magnets() == 0 {
                let message = format!("`{code}` has no magnets");
                return Err(error(place_of(code), message, "write it of N, S and ."));
            }
            if words.contains(&word) {
                let message = format!("`{code}` is there twice");
                return Err(error(place_of(code), message, "take one away"));
            }
            words.push(word);
        }
        let Some(first) = words.first() else {
            let help = "list them: words = [\"NNSN\", \"NSSN\"]";
            return Err(error(None, "it holds no words".to_owned(), help));
        };
        if words.len() > MOST_WORDS {
            let message = format!("it holds {} words, more than {MOST_WORDS}", words.len());
            return Err(error(None, message, "split the set"));
        }
        let pitch = entries.magnet.pitch.unwrap_or(PITCH);
        let middle = (first.places() as f64 - 1.0) / 2.0;
        let places: Vec<f64> = (0..first.places())
            .map(|k| (k as f64 - middle) * pitch)
            .collect();
        let width = entries.magnet.size.unwrap_or(SIZE)[1];
        let needed = pitch * (places.len() as f64 - 1.0) + width;
        let side = entries
            .tile
            .side
            .unwrap_or(needed.max(pitch * places.len() as f64));
        if side > 0.0 && needed > side * (1.0 + 1e-9) {
            let message = format!(
                "words of {} places {pitch} m apart need a face of {needed:.4} m, not {side} m",
                places.len()
            );
            return Err(error(
                None,
                message,
                "make [tile] side longer, or leave it out",
            ));
        }
        let stage = stage(&entries, side, model, &places, name)?;
        let names = match entries.words {
            Some(_) => Vec::new(),
            None => entries
                .faces
                .keys()
                .filter(|name| !name.ends_with('*'))
                .cloned()
                .collect(),
        };
        Ok(Self {
            words,
            names,
            places: None,
            stage,
        })
    }

    /// A set of words with magnets anywhere.
    fn of_spaced(
        entries: &Entries,
        spaced: &[(String, Vec<MagnetAt>)],
        model: Option<MagnetModel>,
        name: &str,
    ) -> Result<Self, DesignError> {
        let error = |(message, help): (String, String)| DesignError {
            also: Vec::new(),
            file: name.to_owned(),
            place: None,
            message,
            help,
        };
        let codes = entries.faces.values().filter(|face| face.magnets.is_none());
        if codes.count() > 0 {
            let message = "some of its faces have `code` and others `magnets`".to_owned();
            let help = "give all of them the one or the other";
            return Err(error((message, help.to_owned())));
        }
        let Some(side) = entries.tile.side else {
            let message = "it does not say how long its faces are".to_owned();
            return Err(error((
                message,
                "write side = 0.43 under [tile]".to_owned(),
            )));
        };
        let width = entries.magnet.size.unwrap_or(SIZE)[1];
        let (places, words) = word_places::common(spaced, width, side).map_err(error)?;
        Ok(Self {
            words,
            names: spaced.iter().map(|(name, _)| name.clone()).collect(),
            stage: stage(entries, side, model, &places, name)?,
            places: Some(places),
        })
    }
}
