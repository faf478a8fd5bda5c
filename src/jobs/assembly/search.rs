//! The words of an assembly, searched.

use super::Wiring;
use super::choice::{self, Asked, Choice, Class, Verdict};
use crate::design::{Design, MagnetModel};
use crate::word_sets::{self, file};
use physics::words::{Bar, Rules};

/// The least gap where none is asked for.
const GAP: f64 = 0.5;

/// What words are searched.
#[derive(Clone, Debug)]
pub struct WordSearch {
    /// From place to place (m); the design's or the paper's where `None`.
    pub pitch: Option<f64>,
    /// Model of the magnets; the design's where `None`.
    pub model: Option<MagnetModel>,
    /// Places of a face; the fewest that carry the words where `None`.
    pub length: Option<usize>,
    /// Magnets of the strongest bonds' words; one a place where `None`.
    pub magnets: Option<usize>,
    /// Least gap; where `None` 0.5, or with a length the widest there is.
    pub gap: Option<f64>,
    /// Which meetings are wrong.
    pub rules: Rules,
    /// Of all random numbers.
    pub seed: u64,
    /// Work to spend, as what takes about so many seconds of a core.
    pub seconds: f64,
}

impl WordSearch {
    /// Words for the bonds of a tile set, as the text of a set, and what was tried. Magnets are
    /// those of a design's target face, or the paper's.
    ///
    /// # Errors
    /// Where there are none, or none were found: what is missing, and how to mend it.
    pub fn run(
        &self,
        wiring: &Wiring,
        design: Option<&Design>,
    ) -> Result<(String, Vec<Choice>), String> {
        let (bar, face) = word_sets::bar(design, self.pitch, self.model)?;
        let most = self.most_places(&bar, face)?;
        let asked = Asked {
            bar,
            magnets: self.magnets,
            rules: self.rules,
            gap: self.gap.or(self.length.is_none().then_some(GAP)),
            seed: self.seed,
            seconds: self.seconds,
        };
        let demand = wiring.demand();
        let tried = match self.length {
            Some(places) => choice::choose(&demand, places, &asked),
            None => choice::shortest(&demand, &asked, most),
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

    /// The longest face to look at, of which the design's may be this long (m).
    fn most_places(&self, bar: &Bar, face: Option<f64>) -> Result<usize, String> {
        let fitting = |side: f64| ((side - bar.size[1]) / bar.pitch + 1e-9).floor() as usize + 1;
        let most = face
            .map_or(choice::MOST_PLACES, fitting)
            .min(choice::MOST_PLACES);
        if let Some(length) = self.length.filter(|length| *length > most) {
            return Err(format!(
                "a face of {length} places is too long: {most} at most, {} apart",
                physics::units::si(bar.pitch, "m", 3)
            ));
        }
        let places = self.length.unwrap_or(most);
        if let Some(magnets) = self.magnets.filter(|magnets| *magnets > places) {
            return Err(match self.length {
                Some(_) => format!(
                    "{magnets} magnets do not fit into {places} places: give a length of \
                     {magnets} or more"
                ),
                None => format!("{magnets} magnets do not fit into a face of {places} places"),
            });
        }
        Ok(most)
    }
}

/// What there is too few of, and whether there can be more.
fn missing(choice: &Choice) -> String {
    let sum = |of: fn(&Class) -> usize| choice.classes.iter().map(of).sum::<usize>();
    let magnets = |class: &Class| match class.magnets {
        1 => "1 magnet".to_owned(),
        magnets => format!("{magnets} magnets"),
    };
    let needed: Vec<String> = choice
        .classes
        .iter()
        .map(|class| format!("{} with {}", class.needed, magnets(class)))
        .collect();
    let refuted = choice.classes.iter().find(|it| it.upper < it.needed);
    let why = match refuted {
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
        needed.join(", "),
        choice.gap,
        choice.places,
        sum(|it| it.found),
    )
}
