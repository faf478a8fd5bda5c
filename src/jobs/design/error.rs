//! The error of a design file: what is wrong, where, and how to fix it.

use std::fmt::{self, Write};
use std::ops::Range;

use crate::text::is_invisible;

/// The result of reading a design.
pub(super) type Result<T> = std::result::Result<T, DesignError>;

/// A fault of a design file.
///
/// Its `Display` is the user's message: the place, what is wrong, the line of the file with the
/// place marked, and the fix; then the same for every further fault:
///
/// ```text
/// flat.toml:12:8: `side` = 430 m: did you mean 0.43 (430 mm)?
///    |
/// 12 | side = 430
///    |        ^^^
///    = help: lengths are in metres
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DesignError {
    /// The file's name, as it was given.
    pub file: String,
    /// The place in the file; `None` if the file as a whole is at fault (it cannot be read).
    pub place: Option<Box<FilePlace>>,
    /// What is wrong.
    pub message: String,
    /// How to fix it.
    pub help: String,
    /// Further faults of the file, in order; these have no further ones themselves.
    pub also: Vec<DesignError>,
}

/// Largest number of faults shown at a time.
const MOST_TOLD: usize = 20;

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilePlace {
    /// Line, counted from 1.
    pub line: usize,
    /// Column in characters, counted from 1.
    pub column: usize,
    /// Number of characters, at least 1.
    pub width: usize,
    /// The line's text; `None` if it must not be shown, such as that of a drawing outside the
    /// design's folder.
    pub source: Option<String>,
}

impl FilePlace {
    /// The place of a range of bytes of `text`; a range over several lines ends with the first.
    pub(super) fn new(text: &str, span: Span) -> Self {
        let start = floor_char_boundary(text, span.start);
        let line_start = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |at| start + at);
        let end = floor_char_boundary(text, span.end).clamp(start, line_end);
        Self {
            line: text[..start].matches('\n').count() + 1,
            column: text[line_start..start].chars().count() + 1,
            width: text[start..end].chars().count().max(1),
            source: Some(text[line_start..line_end].trim_end_matches('\r').to_owned()),
        }
    }

    /// The place of a range of bytes of `text`.
    pub fn of(text: &str, range: Range<usize>) -> Self {
        Self::new(text, range.into())
    }

    /// The line as shown, and the column in it: for a long line (a drawing can be one line) the
    /// part around the place.
    fn window(&self) -> Option<(String, usize)> {
        const MOST: usize = 160;
        let source = self.source.as_ref()?.replace('\t', " ");
        if source.chars().count() <= MOST {
            return Some((source, self.column));
        }
        let start = (self.column - 1).saturating_sub(MOST / 2);
        let shown: String = source.chars().skip(start).take(MOST).collect();
        Some((shown, self.column - start))
    }
}

fn floor_char_boundary(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    (0..=at)
        .rev()
        .find(|&i| text.is_char_boundary(i))
        .unwrap_or(0)
}

impl fmt::Display for DesignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut told = String::new();
        self.write_one(&mut told)?;
        for fault in self.also.iter().take(MOST_TOLD - 1) {
            told.push_str("\n\n");
            fault.write_one(&mut told)?;
        }
        if let more @ 1.. = self.also.len().saturating_sub(MOST_TOLD - 1) {
            write!(told, "\n\nand {more} more")?;
        }
        f.write_str(&harmless(&told))
    }
}

/// Removes characters from lines and names that would control a terminal or a page.
fn harmless(told: &str) -> String {
    told.replace(|c: char| is_invisible(c) && c != '\n', "\u{fffd}")
}

impl DesignError {
    /// A single fault of a file.
    pub fn new(
        file: &str,
        place: Option<FilePlace>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            file: file.to_owned(),
            place: place.map(Box::new),
            message: message.into(),
            help: help.into(),
            also: Vec::new(),
        }
    }

    /// The fault and its help in a sentence, without the place.
    pub fn sentence(&self) -> String {
        harmless(&format!("{}; {}", self.message, self.help))
    }

    /// The fault without the further ones.
    fn write_one(&self, f: &mut String) -> fmt::Result {
        let Some(place) = &self.place else {
            writeln!(f, "{}: {}", self.file, self.message)?;
            return write!(f, "  = help: {}", self.help);
        };
        let number = place.line.to_string();
        let gutter = " ".repeat(number.len());
        writeln!(
            f,
            "{}:{number}:{}: {}",
            self.file, place.column, self.message
        )?;
        if let Some((source, column)) = place.window() {
            let indent = " ".repeat(column - 1);
            // Line ends do not belong to a line, so a place may be beyond the shown text.
            let left = (source.chars().count() + 1).saturating_sub(column);
            let carets = "^".repeat(place.width.min(left).max(1));
            writeln!(f, "{gutter} |")?;
            writeln!(f, "{number} | {source}")?;
            writeln!(f, "{gutter} | {indent}{carets}")?;
        }
        write!(f, "{gutter} = help: {}", self.help)
    }
}

impl std::error::Error for DesignError {}

/// A range of bytes of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Span {
    pub start: usize,
    pub end: usize,
}

impl From<Range<usize>> for Span {
    fn from(range: Range<usize>) -> Self {
        Self {
            start: range.start,
            end: range.end,
        }
    }
}
