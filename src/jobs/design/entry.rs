//! A key of a design file with its value, and how values are read.

use toml::Spanned;
use toml::de::DeValue;

use super::error::{DesignError, Span};
use super::quantity::Quantity;
use super::reader::{Result, Section, nearest_help};
use super::source::Source;

/// A key with its value.
#[derive(Clone, Copy)]
pub(super) struct Entry<'a> {
    pub(super) source: Source<'a>,
    pub key: &'a str,
    pub(super) key_span: Span,
    pub(super) value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Entry<'a> {
    pub fn span(&self) -> Span {
        self.value.span().into()
    }

    pub fn key_span(&self) -> Span {
        self.key_span
    }

    /// The result itself; its fault is added to the design's.
    pub fn noted<T>(&self, result: Result<T>) -> Result<T> {
        self.source.faults.note(result)
    }

    pub fn source(&self) -> Source<'a> {
        self.source
    }

    /// A fault of the value.
    pub fn error(&self, message: impl Into<String>, help: impl Into<String>) -> DesignError {
        self.source.error(self.span(), message, help)
    }

    /// A fault of the key.
    pub fn key_error(&self, message: impl Into<String>, help: impl Into<String>) -> DesignError {
        self.source.error(self.key_span, message, help)
    }

    fn wrong_type(&self, wanted: &str) -> DesignError {
        let found = match self.value.get_ref() {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) | DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        self.error(
            format!("`{}` must be {wanted}, not {found}", self.key),
            format!("write {wanted} here"),
        )
    }

    /// The table, named `name` in messages. Its place is that of its key.
    pub fn section(&self, name: &'a str) -> Result<Section<'a>> {
        let DeValue::Table(table) = self.value.get_ref() else {
            return Err(self.wrong_type("a table"));
        };
        Ok(Section {
            source: self.source,
            name,
            span: self.key_span,
            table,
        })
    }

    /// `true` or `false`, if it is one of them.
    pub fn boolean(&self) -> Option<bool> {
        self.value.get_ref().as_bool()
    }

    /// A text without control characters: a terminal would obey them, and no picture or page can
    /// hold them. Lines may end in it, and have tabs.
    pub fn string(&self) -> Result<&'a str> {
        let text = self.value.get_ref().as_str();
        let text = text.ok_or_else(|| self.wrong_type("a string"))?;
        self.without(text, |c| !matches!(c, '\n' | '\r' | '\t'))
    }

    /// A text of one line.
    pub fn line(&self) -> Result<&'a str> {
        self.without(self.string()?, |_| true)
    }

    fn without(&self, text: &'a str, refused: impl Fn(char) -> bool) -> Result<&'a str> {
        // The last two are no characters of XML either.
        let odd = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
        match text.chars().find(|&c| odd(c) && refused(c)) {
            None => Ok(text),
            Some(c) => Err(self.error(
                format!(
                    "`{}` holds the control character U+{:04X}",
                    self.key, c as u32
                ),
                "delete it, or write what is meant in letters",
            )),
        }
    }

    /// The place of character `index` of a string: the character itself where the string is
    /// written out plainly, the whole value where escapes or several lines hide it.
    pub fn character_span(&self, index: usize) -> Span {
        let span = self.value.span();
        let written = &self.source.text[span.clone()];
        let plain = self.value.get_ref().as_str().is_some_and(|value| {
            written.len() == value.len() + 2 && &written[1..written.len() - 1] == value
        });
        let inside = written.char_indices().nth(index + 1).filter(|_| plain);
        match inside {
            Some((at, c)) => (span.start + at..span.start + at + c.len_utf8()).into(),
            None => span.into(),
        }
    }

    /// A string, or a whole number as a string: the name of a face.
    pub fn name_or_number(&self) -> Result<String> {
        match self.value.get_ref() {
            DeValue::Integer(integer) => Ok(integer.as_str().to_owned()),
            _ => self.string().map(str::to_owned),
        }
    }

    /// A fault at `span` rather than at the whole value.
    pub fn error_at(
        &self,
        span: Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> DesignError {
        self.source.error(span, message, help)
    }

    /// The word, one of `known`; any other is answered with the nearest of them.
    pub fn word<T: Copy>(&self, known: &[(&str, T)]) -> Result<T> {
        let word = self.string()?;
        let names: Vec<_> = known.iter().map(|(name, _)| *name).collect();
        known
            .iter()
            .find(|(name, _)| *name == word)
            .map(|(_, value)| *value)
            .ok_or_else(|| {
                self.error(
                    format!("`{}` cannot be \"{word}\"", self.key),
                    nearest_help(word, &names),
                )
            })
    }

    /// A number; one with a unit in quotes, where `quantity` says which units there are.
    fn raw_number(&self, quantity: Option<Quantity>) -> Result<f64> {
        let parsed = match self.value.get_ref() {
            DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
                .ok()
                .map(|value| value as f64),
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::String(text) => {
                let Some(quantity) = quantity else {
                    return Err(self.wrong_type("a number"));
                };
                let wrong = || DesignError {
                    help: quantity.example(text),
                    ..self.wrong_type("a number")
                };
                Some(quantity.read(text).ok_or_else(wrong)?)
            }
            _ => return Err(self.wrong_type("a number")),
        };
        parsed.ok_or_else(|| {
            self.error(
                format!("`{}` is a number that cannot be read", self.key),
                "write a plain decimal number, such as 0.43",
            )
        })
    }

    /// A number; one that cannot stand is noted, and reading goes on with a guess.
    pub fn number(&self, quantity: Quantity) -> Result<f64> {
        let value = self.raw_number(Some(quantity))?;
        match quantity.check(&format!("`{}`", self.key), value) {
            Ok(()) => Ok(value),
            Err((message, help)) if value.is_finite() => {
                self.source.faults.guess(self.error(message, help));
                Ok(quantity.guess(value))
            }
            Err((message, help)) => Err(self.error(message, help)),
        }
    }

    /// A whole number from 1 to `largest`.
    pub fn count(&self, largest: u32) -> Result<u32> {
        let value = self.raw_number(None)?;
        if value.fract() == 0.0 && value >= 1.0 && value <= f64::from(largest) {
            return Ok(value as u32);
        }
        Err(self.error(
            format!(
                "`{}` = {value} is not a whole number from 1 to {largest}",
                self.key
            ),
            "give a whole number",
        ))
    }

    pub fn array(&self) -> Result<Vec<Entry<'a>>> {
        let DeValue::Array(items) = self.value.get_ref() else {
            return Err(self.wrong_type("an array"));
        };
        Ok(items
            .iter()
            .map(|value| Entry {
                source: self.source,
                key: self.key,
                key_span: value.span().into(),
                value,
            })
            .collect())
    }

    /// An array of exactly N numbers, such as a size along N directions.
    pub fn numbers<const N: usize>(&self, quantity: Quantity, what: &str) -> Result<[f64; N]> {
        let items = self.array()?;
        let read = |item: &Entry| self.source.faults.note(item.number(quantity));
        let values = items.iter().map(read).collect::<Vec<_>>();
        let values = values.into_iter().collect::<Result<Vec<_>>>()?;
        values.try_into().map_err(|values: Vec<f64>| {
            self.error(
                format!("`{}` holds {} numbers, not {N}", self.key, values.len()),
                format!("give {N} numbers: {what}"),
            )
        })
    }
}
