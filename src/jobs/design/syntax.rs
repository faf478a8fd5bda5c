//! Parses text as TOML.

use std::ops::Range;

use toml::de::DeTable;

use super::error::Result;
use super::quantity::four_digits;
use super::source::Source;
use super::units;
use crate::text::with_point;

const HELP: &str = "the file is TOML: `key = value` lines under [section] headers";

/// The keys and values of a file.
///
/// # Errors
/// If the text is not TOML; every fault is noted.
pub(super) fn parse<'a>(source: Source<'a>) -> Result<DeTable<'a>> {
    let (root, errors) = DeTable::parse_recoverable(source.text);
    for error in errors {
        let span = error.span().unwrap_or_default();
        // A number with its unit but without quotes: the parser's position may be at either.
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
            None => match curly(source.text, span.start)
                .or_else(|| escaped(source.text, span.start))
                .or_else(|| mistaken(source.text, span.start))
            {
                Some((range, message, help)) => source.error(range.into(), message, help),
                None => source.error(span.into(), error.message().trim(), HELP),
            },
        };
    }
    source.faults.check()?;
    Ok(root.into_inner())
}

/// Recognises quotes of word processors on the line of a position.
fn curly(text: &str, at: usize) -> Option<Mistake> {
    const QUOTES: [char; 8] = [
        '\u{201c}', '\u{201d}', '\u{201e}', '\u{201f}', '\u{ab}', '\u{bb}', '\u{2018}', '\u{2019}',
    ];
    let line = line_of(text, at)?;
    let found = text[line.clone()].find(QUOTES)?;
    let from = line.start + found;
    // Inside straight quotes they are letters like others.
    if text[line.start..from].matches('"').count() % 2 == 1 {
        return None;
    }
    let quote = text[from..].chars().next()?;
    Some((
        from..from + quote.len_utf8(),
        "text goes in straight quotes, not in curly ones",
        format!("replace {quote} by \": name = \"...\""),
    ))
}

/// Recognises a backslash in double quotes that is not meant to begin an escape: a path of Windows.
fn escaped(text: &str, at: usize) -> Option<Mistake> {
    let line = line_of(text, at)?;
    let before = text.get(line.start..at)?;
    // The parser's position is at the backslash or a few letters after it.
    let from = match text[at..].starts_with('\\') {
        true => at,
        false => line.start + before.rfind('\\')?,
    };
    let open = text[line.start..from].rfind('"')?;
    let written = &text[line.start + open + 1..line.end];
    let written = &written[..written.find('"').unwrap_or(written.len())];
    Some((
        from..from + 1,
        "a backslash in double quotes begins an escape, such as \\n for a new line",
        both_ways(written),
    ))
}

/// The two ways to write a path with backslashes.
pub(super) fn both_ways(path: &str) -> String {
    format!(
        "write the path with slashes, \"{}\", or in single quotes, '{path}'",
        path.replace('\\', "/")
    )
}

/// The line around a position.
fn line_of(text: &str, at: usize) -> Option<Range<usize>> {
    let begin = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    let end = text[at..]
        .find(['\n', '\r'])
        .map_or(text.len(), |end| at + end);
    Some(begin..end)
}

/// A place, what is wrong there and what to write.
type Mistake = (Range<usize>, &'static str, String);

/// Recognises common mistakes at or around a position: a decimal comma, or text without quotes.
/// Returns the position, what is wrong and what to write.
fn mistaken(text: &str, at: usize) -> Option<Mistake> {
    let begin = text.get(..at)?.rfind('\n').map_or(0, |end| end + 1);
    let end = text[at..]
        .find(['\n', '\r', '#'])
        .map_or(text.len(), |end| at + end);
    // `side = 0,43`, also in a table or an array: the parser's position is at the comma or after
    // it.
    let in_number = |c: char| c.is_ascii_digit() || ",-+".contains(c);
    let from = last_word(text[begin..at].trim_end_matches([' ', '\t']), |c| {
        !in_number(c)
    });
    let from = begin + from;
    let number = text[from..end].split(|c: char| !in_number(c)).next()?;
    let number = number.trim_end_matches(',');
    let to = from + number.len();
    if let Some(meant) = with_point(number) {
        let told = format!("write {meant}");
        return Some((from..to, "use a decimal point, not a comma", told));
    }
    // `code = NNS`, as a single value, in a table or in an array.
    let between = |c: char| c.is_whitespace() || "=[,{".contains(c);
    let from = begin + last_word(&text[begin..at], between);
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

/// The start of the last word of a text, with given separators.
fn last_word(text: &str, between: impl Fn(char) -> bool) -> usize {
    text.len() - text.rsplit(between).next().map_or(0, str::len)
}
