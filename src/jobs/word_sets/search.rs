//! The search for the requested words.

use super::spaced::Spaced;
use super::{Request, Sought, bar};
use crate::Refused;
use crate::design::Design;
use physics::budget::Budget;
use physics::words::continuous::Wanted;
use physics::words::{Effort, Faces, Lags, PAPER_FACE, Question, Task, answer};

/// The result of a search.
pub enum WordsResult {
    /// Words with a pitch.
    Even(Box<Sought>),
    /// Words with magnets anywhere along the face.
    Anywhere(Box<Spaced>),
}

const UPSIDE_DOWN: &str = "--flip: upright magnets exchange their poles when their tile lies \
    upside down, so every face is its own mate and no such words exist; leave it out";

impl Request {
    /// Searches words with the magnets of a design's target face or the paper's.
    ///
    /// # Errors
    /// If such words cannot exist.
    pub fn search(&self, design: Option<&Design>) -> Result<WordsResult, Refused> {
        let (places, magnets) = self.places()?;
        let (bar, face) = bar(design, self.pitch, self.model)?;
        if self.flip && bar.form.stands.is_some() {
            return Err(UPSIDE_DOWN.to_owned().into());
        }
        let effort = Effort::new(self.seed, Budget::seconds(self.seconds));
        if self.continuous {
            let wanted = Wanted {
                magnets,
                bar,
                face: self.face.or(face).unwrap_or(PAPER_FACE),
                words_meet: self.faces == Faces::All,
                flip: self.flip,
                balanced: self.balanced,
                longest_run: self.max_run,
            };
            let spaced = Spaced::search(&wanted, self, effort)?;
            return Ok(WordsResult::Anywhere(Box::new(spaced)));
        }
        let constraints = self.constraints(&bar, places, magnets)?;
        let energies = Lags::new(&bar, places);
        let (question, lags) = match (self.contacts, self.gap, self.count) {
            (Some(most), _, _) => {
                let gap = 1.0 - (most as f64 + 0.5) / magnets as f64;
                (Question::Gap(gap.max(0.0)), Lags::contacts(places))
            }
            (_, Some(gap), _) => (Question::Gap(gap), energies.clone()),
            (_, _, Some(count)) => (Question::Count(count), energies.clone()),
            _ => (Question::Frontier, energies.clone()),
        };
        let task = Task {
            places,
            magnets,
            stands: bar.form.stands.is_some(),
            lags,
            rules: self.rules()?,
            constraints,
        };
        Ok(WordsResult::Even(Box::new(Sought {
            answer: answer(&task, question, &energies, &mut effort.clone()),
            request: self.clone(),
            design: design.map(|design| design.name.clone()),
            bar,
            face: face.unwrap_or(PAPER_FACE),
            task,
            question,
            energies,
        })))
    }
}
