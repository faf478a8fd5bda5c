//! From text to TOML.

use std::ops::Range;

use toml::de::DeTable;

use super::error::Result;
use super::quantity::four_digits;
use super::source::Source;
use super::units;

const HELP: &str = "the file is TOML: `key = value` lines under [section] headers";

/// The keys and values of a file.
///
/// # Errors
/// Where it is no TOML; every place is noted.
pub(super) fn parse<'a>(source: Source<'a>) -> Result<DeTable<'a>> {
    let (root, errors) = DeTable::parse_recoverable(source.text);
    for error in errors {
        let span = error.span().unwrap_or_default();
        // A number with its unit, but not in quotes: the fault may be at either.
        let written = source.text.get(..span.start).unwrap_or_default();
        let word = written.rfind(|c: char| c.is_whitespace() || "=[,".contains(c));
        let from = word.map_or(0, |at| at + 1);
        match source.text.get(from..).and_then(units::beginning) {
            Some((value, with_unit)) => source.error(
                (from..from + with_unit.len()).into(),
                "a number with a unit goes in quotes",
                match value {
                    Some(value) => format!(
                        "write \"{with_unit}\", or {} in SI units",
                        four_digits(value)
                    ),
                    None => format!("write \"{with_unit}\""),
                },
            ),
            None => match mistaken(source.text, span.start) {
                Some((range, message, help)) => source.error(range.into(), message, help),
                None => source.error(span.into(), error.message().trim(), HELP),
            },
        };
    }
    source.faults.check()?;
    Ok(root.into_inner())
}

/// What is no TOML but easily meant, at or about a place of the text: a decimal comma, or text without
/// its quotes. Where it stands, what is wrong with it and what to write.
fn mistaken(text: &str, at: usize) -> Option<(Range<usize>, &'static str, String)> {
    let begin = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    let end = text[at..]
        .find(['\n', '\r', '#'])
        .map_or(text.len(), |end| at + end);
    let line = &text[begin..end];
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    // `side = 0,43`
    let (_, value) = line.split_once('=')?;
    if let Some((whole, part)) = value.trim().split_once(',')
        && digits(whole.trim_start_matches(['-', '+']))
        && digits(part)
    {
        let from = begin + line.find(value.trim())?;
        let told = format!("write {whole}.{part}");
        let range = from..from + value.trim().len();
        return Some((range, "a decimal number has a point, not a comma", told));
    }
    // `code = NNS`, as a value of its own, in a table or in an array.
    let before = &text[begin..at];
    let from = before.rfind(|c: char| c.is_whitespace() || "=[,{".contains(c));
    let from = begin + from.map_or(0, |at| at + 1);
    let word = &text[from..end];
    let word = &word[..word
        .find(|c: char| c.is_whitespace() || ",]}".contains(c))
        .unwrap_or(word.len())];
    let is_value =
        text[begin..from].trim_end().ends_with(['=', '[', ',']) && text[begin..from].contains('=');
    let plain = |c: char| c.is_alphanumeric() || "._-/".contains(c);
    let is_word = word.contains(char::is_alphabetic) && word.chars().all(plain);
    let told = format!("write \"{word}\"");
    (is_value && is_word).then(|| (from..from + word.len(), "text goes in quotes", told))
}
