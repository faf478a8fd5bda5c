//! From text to TOML.

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
            None => source.error(span.into(), error.message().trim(), HELP),
        };
    }
    source.faults.check()?;
    Ok(root.into_inner())
}
