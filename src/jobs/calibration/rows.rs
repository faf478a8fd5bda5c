//! Measurements from a CSV file.

use std::io::Read;

use csv::{ReaderBuilder, StringRecord, Terminator, Trim};

use super::Row;
use physics::configuration::Configuration;

/// The columns of a file of measurements: the pose, whether the shields were in place (1 or 0),
/// and what was measured on the moving tile (the torque about its reference point). The columns
/// may come in any order and those of the measured values may be left out, as may their entries.
pub const COLUMNS: [&str; 8] = [
    "x_m",
    "y_m",
    "theta_rad",
    "iron",
    "energy_J",
    "force_x_N",
    "force_y_N",
    "torque_Nm",
];

/// How many of the columns must be there.
const NEEDED: usize = 4;

/// What is wrong with a file of measurements, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CsvError {
    /// It has no line at all.
    #[error("the file is empty; its first line should name the columns: {known}", known = COLUMNS.join(","))]
    Empty,
    /// A column is none of those known.
    #[error("unknown column `{0}`; the columns are {known}", known = COLUMNS.join(", "))]
    UnknownColumn(String),
    /// A column is named twice.
    #[error("the column `{0}` is there twice")]
    TwiceColumn(String),
    /// A column that every file needs is not there.
    #[error("there is no column `{0}`")]
    MissingColumn(&'static str),
    /// There is nothing below the line of names.
    #[error("there are no rows of measurements below the line that names the columns")]
    NoRows,
    /// No column holds a measured quantity.
    #[error("none of the columns {known} is there: nothing was measured", known = COLUMNS[NEEDED..].join(", "))]
    NothingMeasured,
    /// A line has too many or too few entries.
    #[error("line {line} has {found} entries, the first line names {expected} columns")]
    WrongCount {
        /// Which line, from 1.
        line: usize,
        /// How many entries it has.
        found: usize,
        /// How many columns there are.
        expected: usize,
    },
    /// An entry is no finite number.
    #[error("line {line}: `{text}` is no finite number for {column}")]
    NotANumber {
        /// Which line, from 1.
        line: usize,
        /// The name of its column.
        column: &'static str,
        /// The entry.
        text: String,
    },
    /// The column of the shields holds something else than 0 and 1.
    #[error("line {line}: iron is `{text}`, but must be 1 (shields in place) or 0")]
    NotZeroOrOne {
        /// Which line, from 1.
        line: usize,
        /// The entry.
        text: String,
    },
}

/// Reads measurements. Lines without entries and lines that begin with `#` are skipped.
///
/// # Errors
/// Where the text is not a table of the given [`COLUMNS`].
pub fn read_rows(text: &str) -> Result<Vec<Row>, CsvError> {
    let mut records = records(text);
    let (_, header) = records.next().ok_or(CsvError::Empty)?;
    let columns = columns(&header)?;
    let rows: Vec<Row> = records
        .map(|(line, record)| row(line, &record, &columns))
        .collect::<Result<_, _>>()?;
    if rows.is_empty() {
        return Err(CsvError::NoRows);
    }
    Ok(rows)
}

/// The lines that say something, with their numbers, cut into trimmed entries.
fn records(text: &str) -> impl Iterator<Item = (usize, StringRecord)> {
    // Every line ends with a line feed, also the last one: so the reader has passed just one more
    // than those it has read, whatever it skipped.
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

/// Which of [`COLUMNS`] each column of the file is.
fn columns(header: &StringRecord) -> Result<Vec<usize>, CsvError> {
    let mut columns = Vec::new();
    for name in header {
        let known = COLUMNS.iter().position(|column| *column == name);
        let column = known.ok_or_else(|| CsvError::UnknownColumn(name.to_owned()))?;
        if columns.contains(&column) {
            return Err(CsvError::TwiceColumn(name.to_owned()));
        }
        columns.push(column);
    }
    if let Some(missing) = (0..NEEDED).find(|column| !columns.contains(column)) {
        return Err(CsvError::MissingColumn(COLUMNS[missing]));
    }
    if columns.iter().all(|column| *column < NEEDED) {
        return Err(CsvError::NothingMeasured);
    }
    Ok(columns)
}

fn row(line: usize, entries: &StringRecord, columns: &[usize]) -> Result<Row, CsvError> {
    if entries.len() != columns.len() {
        return Err(CsvError::WrongCount {
            line,
            found: entries.len(),
            expected: columns.len(),
        });
    }
    let mut values = [None; COLUMNS.len()];
    for (&column, entry) in columns.iter().zip(entries) {
        if column >= NEEDED && entry.is_empty() {
            continue;
        }
        let number = entry
            .parse::<f64>()
            .ok()
            .filter(|number| number.is_finite());
        values[column] = Some(number.ok_or_else(|| CsvError::NotANumber {
            line,
            column: COLUMNS[column],
            text: entry.to_owned(),
        })?);
    }
    let [x, y, theta, iron] = [0, 1, 2, 3].map(|column| values[column].unwrap_or_default());
    if iron != 0.0 && iron != 1.0 {
        return Err(CsvError::NotZeroOrOne {
            line,
            text: iron.to_string(),
        });
    }
    Ok(Row {
        line,
        configuration: Configuration::from([x, y, theta]),
        iron: iron == 1.0,
        measured: [values[4], values[5], values[6], values[7]],
    })
}
