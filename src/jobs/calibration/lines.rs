//! The lines of measurement files.

use std::io::Read;

use csv::{ReaderBuilder, StringRecord, Terminator, Trim};

/// The non-empty lines with their numbers, split into trimmed entries.
pub(super) fn records(text: &str) -> impl Iterator<Item = (usize, StringRecord)> {
    // Every line ends with a line feed, including the last one, so the reader has passed exactly
    // one more than it has read, whatever it skipped.
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .comment(Some(b'#'))
        .terminator(Terminator::Any(b'\n'))
        .from_reader(text.as_bytes().chain(&b"\n"[..]));
    let records = std::iter::from_fn(move || {
        let mut record = StringRecord::new();
        // Text that is in memory cannot fail to be read.
        let found = reader.read_record(&mut record).unwrap_or(false);
        found.then(|| (reader.position().line() as usize - 1, record))
    });
    records.filter(|(_, record)| !record.iter().all(str::is_empty) && !record[0].starts_with('#'))
}

/// A positive number.
pub(super) fn positive(text: &str) -> Option<f64> {
    let number = text.trim().parse().ok();
    number.filter(|number: &f64| number.is_finite() && *number > 0.0)
}
