//! What `tilebind words` is asked: places, magnets, constraints.

use tilebind::design::Design;
use tilebind::word_sets;
use tilebind::words::word::MOST_PLACES;
use tilebind::words::{Bar, Constraints, PAPER_FACE};

use super::super::{Failure, input};
use super::Words;

impl Words {
    /// Places and magnets of a word.
    pub(super) fn places(&self) -> Result<(usize, usize), Failure> {
        let wrong = |message: String| Err(Failure::Usage(message));
        let (places, magnets) = match (self.slots, self.length) {
            (Some(slots), length) => match (self.magnets, length) {
                (Some(magnets), Some(length)) if length != magnets && length != slots => {
                    return wrong(format!(
                        "--length {length} is neither --magnets {magnets} nor --slots {slots}: \
                         leave it out"
                    ));
                }
                (Some(magnets), _) => (slots, magnets),
                (None, Some(length)) => (slots, length),
                (None, None) => {
                    return wrong("say how many of the slots hold magnets: --magnets 4".to_owned());
                }
            },
            (None, length) if self.continuous => match (self.magnets, length) {
                (Some(magnets), Some(length)) if length != magnets => {
                    return wrong(format!(
                        "--length {length} is not --magnets {magnets}: leave it out"
                    ));
                }
                (Some(magnets), _) | (None, Some(magnets)) => (magnets, magnets),
                (None, None) => return wrong("say how many magnets: --magnets 4".to_owned()),
            },
            (None, _) if self.magnets.is_some() => {
                return wrong(
                    "--magnets goes with --slots or --continuous; else say --length".to_owned(),
                );
            }
            (None, Some(length)) => (length, length),
            (None, None) => return wrong("say how long words are: --length 8".to_owned()),
        };
        if places > MOST_PLACES {
            return wrong(format!(
                "a word of {places} places is too long: give at most {MOST_PLACES}"
            ));
        }
        if magnets > places {
            return wrong(format!(
                "{magnets} magnets do not fit into {places} slots: give --slots {magnets} or more"
            ));
        }
        if let Some(most) = self.contacts.filter(|most| *most >= magnets) {
            return wrong(format!(
                "--contacts {most} forbids nothing: words of {magnets} magnets have at most \
                 {magnets}; give fewer"
            ));
        }
        Ok((places, magnets))
    }

    /// The magnets, the length of the face (m), and the design that they are of.
    pub(super) fn bar(&self) -> Result<(Bar, f64, Option<Design>), Failure> {
        let path = self.design.as_ref();
        let design = path.map(|path| input::load_as(path, self.model));
        let design = design.transpose()?;
        let usage = |message| match path {
            Some(path) => Failure::Usage(format!("{}: {message}", path.display())),
            None => Failure::Usage(message),
        };
        let (bar, face) = word_sets::bar(design.as_ref(), self.pitch, self.model).map_err(usage)?;
        Ok((bar, face.unwrap_or(PAPER_FACE), design))
    }

    pub(super) fn constraints(
        &self,
        bar: &Bar,
        places: usize,
        magnets: usize,
    ) -> Result<Constraints, Failure> {
        let width = bar.size[1];
        let least_spacing = (width / bar.pitch * (1.0 - 1e-9)).ceil() as usize;
        if (magnets - 1) * least_spacing >= places {
            return Err(Failure::Usage(format!(
                "magnets {} mm wide do not fit side by side {} mm apart: give --pitch {width} or \
                 more, or more --slots",
                1e3 * width,
                1e3 * bar.pitch
            )));
        }
        let [mismatches, complement_mismatches, slide_mismatches] =
            self.min_mismatch.unwrap_or_default();
        let range = |range: Option<[f64; 2]>| range.map(|[low, high]| low..=high);
        Ok(Constraints {
            balanced: self.balanced,
            longest_run: self.max_run,
            least_spacing,
            mismatches,
            complement_mismatches,
            slide_mismatches,
            consecutive: self.consecutive.map(|[low, high]| low..=high),
            least_bond: self.min_bond,
            ranges: [self.word_word, self.word_mate, self.mate_mate].map(range),
        })
    }
}
