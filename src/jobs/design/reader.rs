//! Typed reading of a TOML tree in which every key and value knows its position in the file.

use crate::text::check_visible;
use physics::order::Order;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::error::{DesignError, Result, Span};
use super::quantity::Quantity;
use super::source::Source;
use super::syntax::both_ways;

/// A table of the file.
#[derive(Clone, Copy)]
pub(super) struct Section<'a> {
    pub source: Source<'a>,
    /// Its name in messages: `[fixed.faces]`.
    name: &'a str,
    /// The byte range for faults about missing keys.
    pub span: Span,
    table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    /// The whole file.
    pub fn root(source: Source<'a>, table: &'a DeTable<'a>, name: &'a str) -> Self {
        let first = table.keys().map(|key| Span::from(key.span())).min();
        Self {
            source,
            name,
            span: first.unwrap_or((0..0).into()),
            table,
        }
    }

    /// Notes every key that is not among `known`, with the nearest known one.
    pub fn allow(&self, known: &[&str]) {
        let entries = self.entries().into_iter();
        for entry in entries.filter(|entry| !known.contains(&entry.key)) {
            let message = format!("{} has no key `{}`", self.name, entry.key);
            entry.key_error(message, nearest_help(entry.key, known));
        }
    }

    /// All keys, in the order of the file.
    pub fn entries(&self) -> Vec<Entry<'a>> {
        let mut entries: Vec<_> = self.table.iter().map(|it| self.entry(it)).collect();
        entries.order_by_key(|entry| entry.key_span);
        entries
    }

    pub fn get(&self, key: &str) -> Option<Entry<'a>> {
        self.table.get_key_value(key).map(|it| self.entry(it))
    }

    fn entry(
        &self,
        (key, value): (&'a Spanned<DeString<'a>>, &'a Spanned<DeValue<'a>>),
    ) -> Entry<'a> {
        Entry {
            source: self.source,
            key: key.get_ref(),
            key_span: key.span().into(),
            value,
        }
    }

    /// The entry for `key`; if it is missing, `help` says what to write.
    pub fn require(&self, key: &str, help: &str) -> Result<Entry<'a>> {
        self.get(key)
            .ok_or_else(|| self.error(format!("{} lacks `{key}`", self.name), help))
    }

    /// The table for `key`, named `name` in messages.
    pub fn section(&self, key: &str, name: &'a str) -> Result<Option<Section<'a>>> {
        self.get(key).map(|entry| entry.section(name)).transpose()
    }

    pub fn number(&self, key: &str, quantity: Quantity) -> Result<Option<f64>> {
        self.get(key)
            .map(|entry| entry.number(quantity))
            .transpose()
    }

    pub fn string(&self, key: &str) -> Result<Option<&'a str>> {
        self.get(key).map(|entry| entry.string()).transpose()
    }

    /// A fault of the table as a whole.
    pub fn error(&self, message: impl Into<String>, help: impl Into<String>) -> DesignError {
        self.source.error(self.span, message, help)
    }
}

/// The results of several readings; each is attempted even if an earlier one fails.
pub(super) fn all<T>(results: impl Iterator<Item = Result<T>>) -> Result<Vec<T>> {
    let results: Vec<Result<T>> = results.collect();
    results.into_iter().collect()
}

/// A key with its value.
#[derive(Clone, Copy)]
pub(super) struct Entry<'a> {
    pub source: Source<'a>,
    pub key: &'a str,
    pub key_span: Span,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Entry<'a> {
    pub fn span(&self) -> Span {
        self.value.span().into()
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
        self.wrong_type_but(wanted, format!("write {wanted} here"))
    }

    fn wrong_type_but(&self, wanted: &str, help: String) -> DesignError {
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
            help,
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

    /// The value as a text without control characters, except line ends and tabs: a terminal would
    /// obey them, and pictures and pages cannot contain them. `None` if it is not a string.
    pub fn text(&self) -> Option<&'a str> {
        self.value.get_ref().as_str()
    }

    pub fn string(&self) -> Result<&'a str> {
        let text = self.text();
        let text = text.ok_or_else(|| self.wrong_type("a string"))?;
        self.visible(text, |c| matches!(c, '\n' | '\r' | '\t'))
    }

    /// The path of a file. In double quotes a backslash begins an escape, so a path of Windows would
    /// become another one, or none.
    pub fn path(&self) -> Result<&'a str> {
        let written = &self.source.text[self.value.span()];
        let inside = written.trim_matches('"').replace("\\\\", "");
        if written.starts_with('"') && inside.replace("\\\"", "").contains('\\') {
            return Err(self.error(
                "a backslash in double quotes begins an escape, such as \\n for a new line",
                both_ways(written.trim_matches('"')),
            ));
        }
        self.line()
    }

    /// A text of one line.
    pub fn line(&self) -> Result<&'a str> {
        self.visible(self.string()?, |_| false)
    }

    fn visible(&self, text: &'a str, allowed: impl Fn(char) -> bool) -> Result<&'a str> {
        let wrong = |told| self.error(format!("`{}` {told}", self.key), "delete it");
        check_visible(text, allowed).map(|()| text).map_err(wrong)
    }

    /// The place of character `index` of a string: the character itself if the string is written
    /// plainly, the whole value if it has escapes or several lines.
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

    /// The word, one of `known`; the error for any other names the nearest one.
    pub fn word<T: Copy>(&self, known: &[(&str, T)]) -> Result<T> {
        let word = self.string()?;
        let found = known.iter().find(|(name, _)| *name == word);
        found.map(|(_, value)| *value).ok_or_else(|| {
            let names: Vec<_> = known.iter().map(|(name, _)| *name).collect();
            let message = format!("`{}` cannot be \"{word}\"", self.key);
            self.error(message, nearest_help(word, &names))
        })
    }

    /// Whether it is a number or a text that begins with one, for entries that can be a quantity or
    /// a word.
    pub fn is_quantity(&self) -> bool {
        let text = self.value.get_ref().as_str();
        text.is_none_or(|text| {
            text.trim_start()
                .starts_with(|c: char| c.is_ascii_digit() || ".+-".contains(c))
        })
    }

    /// A number; also one with a unit in quotes, if `quantity` gives the units.
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
                let wrong = || match quantity.unknown_unit(text) {
                    Some(unit) => self.error(
                        format!("`{unit}` is not a unit for `{}`", self.key),
                        quantity.example(text),
                    ),
                    None => self.wrong_type_but("a number", quantity.example(text)),
                };
                Some(quantity.read(text).ok_or_else(wrong)?)
            }
            _ => return Err(self.wrong_type("a number")),
        };
        parsed.ok_or_else(|| {
            self.error(
                format!("`{}` is not a valid number", self.key),
                "write a plain decimal number, such as 0.43",
            )
        })
    }

    /// A number; an invalid one is noted, and reading continues with a guess.
    pub fn number(&self, quantity: Quantity) -> Result<f64> {
        let value = self.raw_number(Some(quantity))?;
        match quantity.check(&format!("`{}`", self.key), value) {
            Ok(()) => Ok(value),
            Err((message, help)) => {
                let fault = self.error(message, help);
                if !value.is_finite() {
                    return Err(fault);
                }
                self.source.faults.guess();
                Ok(quantity.guess(value))
            }
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
        let entry = |value: &'a Spanned<DeValue<'a>>| Entry {
            key_span: value.span().into(),
            value,
            ..*self
        };
        Ok(items.iter().map(entry).collect())
    }

    /// An array of exactly N numbers, such as a size along N directions.
    pub fn numbers<const N: usize>(&self, quantity: Quantity, what: &str) -> Result<[f64; N]> {
        let items = self.array()?;
        let values = all(items.iter().map(|item| item.number(quantity)))?;
        values.try_into().map_err(|values: Vec<f64>| {
            self.error(
                format!("`{}` has {} numbers, not {N}", self.key, values.len()),
                match items.len() == 2 * N {
                    // `[2,0, 2,0]`
                    true => format!("give {N} numbers: {what}; use a decimal point, not a comma"),
                    false => format!("give {N} numbers: {what}"),
                },
            )
        })
    }
}

/// Common wrong words, each with the known word it replaces, and what to write.
const ELSEWHERE: [(&str, &str, &str); 9] = [
    ("length", "diameter", DISC_OR_BLOCK),
    ("thickness", "diameter", DISC_OR_BLOCK),
    ("width", "diameter", DISC_OR_BLOCK),
    ("radius", "diameter", "write its diameter, twice the radius"),
    ("br", "remanence", "write `remanence`, in T"),
    ("material", "grade", "write grade = \"N42\""),
    (
        "strength",
        "grade",
        "write grade = \"N42\", or remanence = 1.2 (T)",
    ),
    (
        "cylinder",
        "disc",
        "write \"disc\", with `diameter` and `height`",
    ),
    (
        "words",
        "fixed",
        "a set of words is not a design: read it with `tilebind crosstalk`",
    ),
];
const DISC_OR_BLOCK: &str = "a disc has `diameter` and `height`, where the height is along the \
    magnetic axis; a block has size = [...]";

/// Names the known word nearest to `word`, or all of them if none is near.
pub(crate) fn nearest_help(word: &str, known: &[&str]) -> String {
    let elsewhere = ELSEWHERE
        .iter()
        .find(|(other, own, _)| word.eq_ignore_ascii_case(other) && known.contains(own));
    if let Some((.., help)) = elsewhere {
        return (*help).to_owned();
    }
    // Numbers are never near each other.
    let number = word.bytes().all(|b| b.is_ascii_digit());
    let nearest = known
        .iter()
        .filter(|_| !number)
        .map(|name| {
            (
                strsim::damerau_levenshtein(&word.to_lowercase(), &name.to_lowercase()),
                name,
            )
        })
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, name)| *distance <= 1 + name.len().min(word.len()) / 4);
    match nearest {
        Some((_, name)) => format!("did you mean `{name}`?"),
        None => format!("known: {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_known_word_is_named_and_only_a_near_one() {
        let known = ["side", "sides", "thickness", "mass"];
        assert_eq!(
            nearest_help("thicknes", &known),
            "did you mean `thickness`?"
        );
        assert_eq!(nearest_help("Mass", &known), "did you mean `mass`?");
        assert_eq!(nearest_help("sdie", &known), "did you mean `side`?");
        assert_eq!(
            nearest_help("colour", &known),
            "known: side, sides, thickness, mass"
        );
        assert_eq!(nearest_help("9", &["0", "1"]), "known: 0, 1");
    }
}
