//! The search for the words of an assembly.

use super::choice::{self, Choice, Class, WordsVerdict};
use super::{Request, Wiring};
use crate::design::Design;
use crate::word_sets::{self, file};
use physics::observer::Observer;
use physics::units::{counted, si};
use physics::words::{Bar, FaceShape, Word};

/// The result of a search.
pub(super) struct Sought {
    /// The magnets.
    pub bar: Bar,
    /// Side of the tiles (m).
    pub side: f64,
    /// The trials; the last one is the result.
    pub tried: Vec<Choice>,
}

impl Sought {
    /// The text of a word file with these magnets.
    pub fn text(&self, words: &[Word]) -> String {
        let places = words.first().map_or(0, |word| word.places());
        let headline = format!("{} words of {places} places", words.len());
        file::of_words(&headline, words, &self.bar, self.side, false)
    }

    /// The words found.
    pub fn words(&self) -> &[Word] {
        self.tried.last().map_or(&[], |last| &last.words)
    }
}

impl Request {
    /// Searches words for the bonds of a tile set, with the magnets of a design's target face or
    /// the paper's.
    pub(super) fn search(
        &self,
        wiring: &Wiring,
        design: Option<&Design>,
        observer: &dyn Observer,
    ) -> Result<Sought, String> {
        let (bar, face) = word_sets::bar(design, self.pitch, self.model)?;
        let most = self.most_places(&bar, face)?;
        let (demand, groups) = (wiring.demand(), wiring.groups());
        let demand = (&demand[..], &groups[..]);
        let tried = match self.length {
            Some(places) => choice::choose(demand, places, &bar, self),
            None => choice::shortest(demand, most, &bar, self, observer),
        };
        match tried.last() {
            Some(last) if last.verdict == WordsVerdict::Found => {
                let side = face.unwrap_or_else(|| word_sets::side(&bar, last.places));
                Ok(Sought { bar, side, tried })
            }
            Some(last) => Err(missing(last, self.shape)),
            None => Err("the face has no magnets".to_owned()),
        }
    }

    /// The longest face to try, given the length (m) of the design's face.
    fn most_places(&self, bar: &Bar, face: Option<f64>) -> Result<usize, String> {
        let fitting = |side: f64| ((side - bar.size[1]) / bar.pitch + 1e-9).floor() as usize + 1;
        let most = face.map_or(choice::MOST_PLACES, fitting);
        let most = most.min(choice::MOST_PLACES);
        let places = self.length.unwrap_or(most);
        let magnets = self.magnets.unwrap_or(0);
        Err(match self.length {
            Some(length) if length > most => format!(
                "a face of {length} positions is too long: at most {most}, {} apart",
                si(bar.pitch, "m", 3)
            ),
            Some(_) if magnets > places => format!(
                "{magnets} magnets do not fit into {places} positions: use a length of {magnets} \
                 or more"
            ),
            None if magnets > places => {
                format!("{magnets} magnets do not fit on a face of {places} positions")
            }
            _ => return Ok(most),
        })
    }
}

/// Describes which words are missing, and whether there can be more.
fn missing(choice: &Choice, shape: FaceShape) -> String {
    let classes = &choice.classes;
    let sum = |of: fn(&Class) -> usize| classes.iter().map(of).sum::<usize>();
    let magnets = |class: &Class| counted(class.magnets, "magnet");
    let needed = classes.iter();
    let needed = needed.map(|class| format!("{} with {}", class.needed, magnets(class)));
    let why = match classes.iter().find(|it| it.upper < it.needed) {
        Some(class) => format!(
            "proved that there are not enough: of those with {} at most {}",
            magnets(class),
            class.upper
        ),
        None => "more may exist; increase --seconds to search longer".to_owned(),
    };
    let shaped = match shape {
        FaceShape::None => "faces whose shape prevents slid contacts (--shape shared), ",
        _ => "",
    };
    format!(
        "{} words ({}) with a gap of {:.3} on faces of {} positions: {} were found, {why}; use \
         {shaped}a longer face, a narrower gap, or given words",
        sum(|it| it.needed),
        needed.collect::<Vec<_>>().join(", "),
        choice.gap,
        choice.places,
        sum(|it| it.found),
    )
}
