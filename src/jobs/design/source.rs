//! The text that a design is read from.

use super::drawings::Drawings;
use super::error::{DesignError, FilePlace, Span};
use super::faults::Faults;

/// A design file's name and text, to which the places of faults refer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    pub file: &'a str,
    pub text: &'a str,
    /// Whether messages may quote lines of it.
    pub quoted: bool,
    /// The drawings that the design refers to.
    pub drawings: &'a Drawings<'a>,
    /// The faults of the design so far.
    pub faults: &'a Faults,
}

impl Source<'_> {
    /// Adds a fault to the design's.
    pub fn error(
        &self,
        span: Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> DesignError {
        let fault = self.doubt(span, message, help);
        self.faults.add(fault.clone());
        fault
    }

    /// Adds a non-fatal warning.
    pub fn doubt(
        &self,
        span: Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> DesignError {
        let mut place = FilePlace::new(self.text, span);
        place.source = place.source.filter(|_| self.quoted);
        DesignError::new(self.file, Some(place), message, help)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ops::Range;

    #[test]
    fn a_fault_shows_its_place_and_its_mend() {
        let source = Source {
            file: "a.toml",
            quoted: true,
            drawings: &Drawings::default(),
            faults: &Faults::default(),
            text: "name = \"ä\"\nside = 430 # m\n",
        };
        let at = source.text.find("430").unwrap();
        let error = source.error((at..at + 3).into(), "too large", "use metres");
        assert_eq!(
            error.to_string(),
            "a.toml:2:8: too large\n  |\n2 | side = 430 # m\n  |        ^^^\n  = help: use metres"
        );
    }

    #[test]
    fn columns_count_characters_and_places_never_leave_the_text() {
        let source = Source {
            file: "a.toml",
            quoted: false,
            drawings: &Drawings::default(),
            faults: &Faults::default(),
            text: "ä = ü",
        };
        let place = |span: Range<usize>| *source.error(span.into(), "", "").place.unwrap();
        assert_eq!((place(5..7).column, place(5..7).width), (5, 1));
        assert_eq!((place(90..99).line, place(90..99).column), (1, 6));
        assert_eq!(place(6..6).column, 5);
    }
}
