//! Reads measurements from a CSV file.

use csv::StringRecord;

use super::lines::records;
use crate::request::FARTHEST;
use crate::text::decimal_comma;
use physics::configuration::Configuration;

/// The columns of a file of measurements: the pose, whether the shields were in place (1 or 0), and
/// the values measured on the moving tile (the torque about its reference point). The columns can
/// be in any order. Columns of measured values can be absent, and their entries empty.
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

/// Number of required columns.
const NEEDED: usize = 4;

/// A measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Its line in the file.
    pub line: usize,
    /// The pose at which it was taken.
    pub configuration: Configuration,
    /// Whether the shields were in place.
    pub iron: bool,
    /// Energy (J), force on the moving tile along x and y (N) and torque about its reference point
    /// (N m), if measured.
    pub measured: [Option<f64>; 4],
}

/// Reads measurements. Lines without entries and lines that begin with `#` are skipped.
///
/// # Errors
/// If the text is not a table of the given [`COLUMNS`]: what is wrong, and where.
pub fn read_rows(text: &str) -> Result<Vec<Measurement>, String> {
    let mut records = records(text);
    let (_, header) = records.next().ok_or_else(|| {
        let known = COLUMNS.join(",");
        format!("the file is empty; its first line must name the columns: {known}")
    })?;
    let columns = columns(&header)?;
    let rows = records.map(|(line, record)| row(line, &record, &columns));
    let rows = rows.collect::<Result<Vec<Measurement>, _>>()?;
    match rows.is_empty() {
        true => Err(
            "there are no rows of measurements below the line that names the columns".to_owned(),
        ),
        false => Ok(rows),
    }
}

/// Which of [`COLUMNS`] each column of the file is.
fn columns(header: &StringRecord) -> Result<Vec<usize>, String> {
    let mut columns = Vec::new();
    for name in header {
        let known = COLUMNS.iter().position(|column| *column == name);
        let column = known.ok_or_else(|| {
            let known = COLUMNS.join(", ");
            format!("unknown column `{name}`; the columns are {known}")
        })?;
        if columns.contains(&column) {
            return Err(format!("the column `{name}` is there twice"));
        }
        columns.push(column);
    }
    if let Some(missing) = (0..NEEDED).find(|column| !columns.contains(column)) {
        return Err(format!("there is no column `{}`", COLUMNS[missing]));
    }
    if columns.iter().all(|column| *column < NEEDED) {
        let known = COLUMNS[NEEDED..].join(", ");
        return Err(format!(
            "none of the columns {known} is present, so there are no measurements"
        ));
    }
    Ok(columns)
}

fn row(line: usize, entries: &StringRecord, columns: &[usize]) -> Result<Measurement, String> {
    let (found, expected) = (entries.len(), columns.len());
    if found != expected {
        let text = entries.iter().collect::<Vec<_>>().join(",");
        let comma = decimal_comma(&text).filter(|_| found > expected);
        let comma = comma.map_or(String::new(), |comma| format!("; {comma}"));
        return Err(format!(
            "line {line} has {found} entries, the first line names {expected} columns{comma}"
        ));
    }
    let mut values = [None; COLUMNS.len()];
    for (&column, entry) in columns.iter().zip(entries) {
        if column >= NEEDED && entry.is_empty() {
            continue;
        }
        let number = entry.parse().ok();
        let number = number.filter(|number: &f64| number.abs() <= FARTHEST);
        let name = COLUMNS[column];
        let wrong = || {
            format!(
                "line {line}: `{entry}` is not a number for {name} up to \
            {FARTHEST:e}"
            )
        };
        values[column] = Some(number.ok_or_else(wrong)?);
    }
    let [x, y, theta, iron] = [0, 1, 2, 3].map(|column| values[column].unwrap_or_default());
    if iron != 0.0 && iron != 1.0 {
        return Err(format!(
            "line {line}: iron is `{iron}`, but must be 1 (shields in place) or 0"
        ));
    }
    Ok(Measurement {
        line,
        configuration: Configuration::from([x, y, theta]),
        iron: iron == 1.0,
        measured: [values[4], values[5], values[6], values[7]],
    })
}
