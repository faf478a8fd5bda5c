//! Reads text as programs save it: UTF-8 or UTF-16, with or without a byte-order mark, tables with
//! commas or, where commas are decimal, with semicolons.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use csv::StringRecord;

/// Largest table or manifest (bytes).
const LARGEST: u64 = 256 << 20;

/// Where a process finds the streams that it was started with.
const STREAMS: [&str; 3] = ["/dev/stdin", "/dev/fd/", "/proc/self/fd/"];

/// Longest name that a user gives to something in the names of files (bytes), which have at most
/// 255.
const LONGEST_NAME: usize = 60;

/// A name as a file name can have it: of ASCII letters, digits and `-`, with `_` for all else.
pub fn file_stem(name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
    name.chars()
        .map(|c| if is_plain(c) { c } else { '_' })
        .take(LONGEST_NAME)
        .collect()
}

/// Opens a regular file. Devices, pipes and folders are rejected: some never end, and opening
/// others blocks forever.
///
/// # Errors
/// If there is no such file, or it is not regular.
pub fn open(path: &Path) -> io::Result<File> {
    match path.metadata()? {
        found if found.is_file() => File::open(path),
        found if found.is_dir() => Err(io::Error::other("it is a folder")),
        _ => Err(io::Error::other("it is not a regular file")),
    }
}

/// The text of a table or manifest: a regular file, or a stream such as `/dev/stdin`.
///
/// # Errors
/// If it cannot be read, is too large or is not text.
pub fn read(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    let name = path.to_string_lossy();
    let file = match STREAMS.iter().any(|stream| name.starts_with(stream)) {
        true => File::open(path)?,
        false => open(path)?,
    };
    file.take(LARGEST + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST {
        let message = format!("it is larger than {} MB", LARGEST >> 20);
        return Err(io::Error::other(message));
    }
    decode(bytes).map_err(io::Error::other)
}

/// Whether a character of a name has no form of its own: control characters, marks that change the
/// direction in which the letters around them are shown, soft hyphens, and tags, which repeat ASCII unseen.
///
/// ```
/// use tilebind_jobs::text::is_invisible;
/// assert!(is_invisible('\u{7}') && is_invisible('\u{202e}') && !is_invisible('\u{e4}'));
/// assert!(is_invisible('\u{e0041}'));
/// ```
pub fn is_invisible(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{2069}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}'
            // These are not characters of XML either.
            | '\u{fffe}' | '\u{ffff}')
}

/// Checks that a text has no invisible characters, but for those that are `allowed`.
///
/// # Errors
/// The first that it has, in words.
pub fn check_visible(text: &str, allowed: impl Fn(char) -> bool) -> Result<(), String> {
    let Some(c) = text.chars().find(|&c| is_invisible(c) && !allowed(c)) else {
        return Ok(());
    };
    let kind = if c.is_control() {
        "control"
    } else {
        "invisible"
    };
    Err(format!("contains the {kind} character U+{:04X}", c as u32))
}

/// The error of bytes that are not text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it is not text in UTF-8 or UTF-16 (at byte {at})")]
pub struct NoText {
    /// The index of the first invalid byte, from 0.
    pub at: usize,
}

/// The text of a file, without a byte-order mark. UTF-16 is recognised by its mark, or by a zero
/// byte in the first letter.
///
/// ```
/// use tilebind_jobs::text::decode;
/// assert_eq!(decode(b"\xef\xbb\xbfname".to_vec()).unwrap(), "name");
/// assert_eq!(decode(b"\xff\xfen\0a\0".to_vec()).unwrap(), "na");
/// assert_eq!(decode(b"na\xff".to_vec()).unwrap_err().at, 2);
/// ```
///
/// # Errors
/// If it is not text.
pub fn decode(bytes: Vec<u8>) -> Result<String, NoText> {
    match bytes.as_slice() {
        [0xef, 0xbb, 0xbf, rest @ ..] => utf8(rest.to_vec(), 3),
        [0xff, 0xfe, rest @ ..] => utf16(rest, 2, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, 2, u16::from_be_bytes),
        [1..=0xff, 0, ..] => utf16(&bytes, 0, u16::from_le_bytes),
        [0, 1..=0xff, ..] => utf16(&bytes, 0, u16::from_be_bytes),
        _ => utf8(bytes, 0),
    }
}

/// The correct form of a number with a decimal comma in a text, if it contains one: digits, a comma
/// and digits immediately after it.
///
/// ```
/// use tilebind_jobs::text::with_point;
/// assert_eq!(with_point("0,43 m").as_deref(), Some("0.43 m"));
/// assert_eq!(with_point("0,43,0,0").as_deref(), Some("0.43,0,0"));
/// assert_eq!(with_point("0.43, 0"), None);
/// ```
pub fn with_point(text: &str) -> Option<String> {
    let bytes = text.as_bytes();
    let digit = |k: usize| bytes.get(k).is_some_and(u8::is_ascii_digit);
    let is_decimal = |at: usize| {
        let before = bytes[..at].iter().rposition(|b| !b.is_ascii_digit());
        // In `0.43,0` the comma separates two numbers.
        at > 0 && digit(at - 1) && digit(at + 1) && before.is_none_or(|k| bytes[k] != b'.')
    };
    let at = text.match_indices(',').find(|(at, _)| is_decimal(*at))?.0;
    Some(format!("{}.{}", &text[..at], &text[at + 1..]))
}

fn utf8(bytes: Vec<u8>, before: usize) -> Result<String, NoText> {
    String::from_utf8(bytes).map_err(|error| NoText {
        at: before + error.utf8_error().valid_up_to(),
    })
}

fn utf16(bytes: &[u8], before: usize, unit: fn([u8; 2]) -> u16) -> Result<String, NoText> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        let at = before + bytes.len() - 1;
        return Err(NoText { at });
    }
    let mut text = String::new();
    let mut at = before;
    for found in char::decode_utf16(pairs.iter().map(|pair| unit(*pair))) {
        let letter = found.map_err(|_| NoText { at })?;
        at += 2 * letter.len_utf16();
        text.push(letter);
    }
    Ok(text)
}

/// Converts a table with semicolons or tabs between columns, and possibly decimal commas, to one
/// with commas between columns and decimal points. Line numbers are unchanged.
///
/// ```
/// use tilebind_jobs::text::with_commas;
/// assert_eq!(with_commas("x;y\n0,43;0\n"), "x,y\n0.43,0\n");
/// assert_eq!(with_commas("x,y\n0.43,0\n"), "x,y\n0.43,0\n");
/// ```
pub fn with_commas(table: &str) -> Cow<'_, str> {
    let mut lines = table.lines().map(str::trim);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with('#'));
    let first = first.unwrap_or_default();
    let between = match first {
        // Text in quotes may contain anything.
        _ if first.contains('"') => None,
        // A comma between digits may be a decimal one.
        _ if first.contains(';') && first.matches(';').count() >= commas_between(first) => {
            Some(';')
        }
        _ if first.contains('\t') && !first.contains(',') => Some('\t'),
        _ => None,
    };
    let Some(between) = between else {
        return Cow::Borrowed(table);
    };
    let changed = table.split_inclusive('\n').map(|line| {
        if line.trim_start().starts_with('#') {
            return line.to_owned();
        }
        let points = line.replace(',', ".");
        points.replace(between, ",")
    });
    Cow::Owned(changed.collect())
}

/// The number of commas in a line that are not between two digits.
fn commas_between(line: &str) -> usize {
    let digit = |c: Option<u8>| c.is_some_and(|c| c.is_ascii_digit());
    let bytes = line.as_bytes();
    let is_decimal =
        |at: usize| digit(at.checked_sub(1).map(|k| bytes[k])) && digit(bytes.get(at + 1).copied());
    line.match_indices(',')
        .filter(|(at, _)| !is_decimal(*at))
        .count()
}

/// The message for a text that contains a number with a decimal comma, and what to write (see
/// [`with_point`]).
pub fn decimal_comma(text: &str) -> Option<String> {
    let meant = with_point(text)?;
    Some(format!("use a decimal point, not a comma: {meant}"))
}

/// The index of the column that a table's first line names by one of the given names, if any.
///
/// # Errors
/// If two columns have such a name.
pub(crate) fn column(header: &StringRecord, names: &[&str]) -> Result<Option<usize>, String> {
    let mut named = (0..header.len()).filter(|place| names.contains(&&header[*place]));
    match (named.next(), named.next()) {
        (_, Some(second)) => Err(format!("the column `{}` is there twice", &header[second])),
        (first, None) => Ok(first),
    }
}

/// Rejects a line with more entries than columns: with decimal commas, its numbers would be wrong.
///
/// # Errors
/// If it has more, and what to write.
pub(crate) fn not_too_long(record: &StringRecord, entries: usize) -> Result<(), String> {
    if record.iter().skip(entries).all(str::is_empty) {
        return Ok(());
    }
    let text = record.iter().collect::<Vec<_>>().join(",");
    let comma = decimal_comma(&text).map_or(String::new(), |comma| format!("; {comma}"));
    let found = record.len();
    Err(format!(
        "it has {found} entries instead of {entries}{comma}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_gives_the_same_text() {
        let text = "name = \"\u{e4}\u{1f600}\"\nsize = 1\n";
        let wide = |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
            text.encode_utf16().flat_map(bytes).collect()
        };
        let [little, big] = [wide(u16::to_le_bytes), wide(u16::to_be_bytes)];
        let marked = |mark: &[u8], bytes: &[u8]| [mark, bytes].concat();
        for bytes in [
            text.as_bytes().to_vec(),
            marked(b"\xef\xbb\xbf", text.as_bytes()),
            marked(b"\xff\xfe", &little),
            marked(b"\xfe\xff", &big),
            little,
            big,
        ] {
            assert_eq!(decode(bytes).as_deref(), Ok(text));
        }
        assert_eq!(decode(Vec::new()).as_deref(), Ok(""));
        for (bytes, at) in [
            (&b"\xff\xfen\0a"[..], 4),
            (b"\xff\xfen\0\0\xd8n\0", 4),
            (b"a\xc3", 1),
        ] {
            assert_eq!(decode(bytes.to_vec()), Err(NoText { at }), "{bytes:?}");
        }
    }

    #[test]
    fn tables_of_other_countries_are_read() {
        let wanted = "x,y,theta\n0.43,0,0\n# a; b, c\n0.44,0,0\n";
        for table in [
            "x;y;theta\n0,43;0;0\n# a; b, c\n0,44;0;0\n",
            "x;y;theta\n0.43;0;0\n# a; b, c\n0.44;0;0\n",
            "x\ty\ttheta\n0,43\t0\t0\n# a; b, c\n0,44\t0\t0\n",
            wanted,
        ] {
            assert_eq!(with_commas(table), wanted);
        }
        assert_eq!(with_commas("0,43;0;0\n"), "0.43,0,0\n");
        assert_eq!(with_commas("0,43;0,1;0,2\n"), "0.43,0.1,0.2\n");
        let noted = "x,y,theta,note;more\n0.43,0,0,a;b\n";
        assert_eq!(with_commas(noted), noted);
    }
}
