//! Typed reading of a TOML tree in which every key and value knows its place in the file.

use physics::order::Order;
use toml::de::DeTable;

use super::error::{DesignError, Span};
use super::faults::Faults;
use super::quantity::Quantity;
use super::source::Source;

pub(super) use super::entry::Entry;

pub(super) type Result<T> = std::result::Result<T, DesignError>;

/// A table of the file.
#[derive(Clone, Copy)]
pub(super) struct Section<'a> {
    pub(super) source: Source<'a>,
    /// What a message calls it: `[fixed.faces]`.
    pub(super) name: &'a str,
    /// The byte range that stands for it where something is missing from it.
    pub(super) span: Span,
    pub(super) table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    /// The whole file.
    pub fn root(source: Source<'a>, table: &'a DeTable<'a>) -> Self {
        let first = table.keys().map(|key| Span::from(key.span())).min();
        Self {
            source,
            name: "the design file",
            span: first.unwrap_or((0..0).into()),
            table,
        }
    }

    /// Notes every key that is not among `known`, naming the nearest one that is.
    pub fn allow(&self, known: &[&str]) {
        let entries = self.entries().into_iter();
        for entry in entries.filter(|entry| !known.contains(&entry.key)) {
            self.source.faults.add(entry.key_error(
                format!("{} has no key `{}`", self.name, entry.key),
                nearest_help(entry.key, known),
            ));
        }
    }

    /// What is wrong with the design so far.
    pub fn faults(&self) -> &'a Faults {
        self.source.faults
    }

    /// All keys, in the order of the file.
    pub fn entries(&self) -> Vec<Entry<'a>> {
        let mut entries: Vec<_> = self
            .table
            .iter()
            .map(|(key, value)| Entry {
                source: self.source,
                key: key.get_ref(),
                key_span: key.span().into(),
                value,
            })
            .collect();
        entries.order_by_key(|entry| entry.key_span);
        entries
    }

    pub fn get(&self, key: &str) -> Option<Entry<'a>> {
        self.table.get_key_value(key).map(|(key, value)| Entry {
            source: self.source,
            key: key.get_ref(),
            key_span: key.span().into(),
            value,
        })
    }

    /// The entry for `key`; where it is missing, `help` says what to write.
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

    pub fn span(&self) -> Span {
        self.span
    }

    /// A fault of the table as a whole.
    pub fn error(&self, message: impl Into<String>, help: impl Into<String>) -> DesignError {
        self.source.error(self.span(), message, help)
    }

    /// A fault at another place of the same file.
    pub fn error_at(
        &self,
        span: Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> DesignError {
        self.source.error(span, message, help)
    }
}

/// Names the known word nearest to `word`, or all of them where none is near.
pub(super) fn nearest_help(word: &str, known: &[&str]) -> String {
    // Of numbers none is near another.
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
        None => format!("known here: {}", known.join(", ")),
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
            "known here: side, sides, thickness, mass"
        );
        assert_eq!(nearest_help("9", &["0", "1"]), "known here: 0, 1");
    }
}
