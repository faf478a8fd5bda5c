//! Reads the starting positions of tiles from a CSV file.

use csv::{ReaderBuilder, Trim};

use crate::request::FARTHEST;
use crate::text::{column, not_too_long};
use physics::configuration::Configuration;
use physics::dynamics::Motion;
use physics::table::start::check;
use physics::table::{Crowd, Mover, StartError};

/// The columns.
const COLUMNS: [&str; 8] = ["tile", "kind", "x", "y", "theta", "vx", "vy", "omega"];

/// What is wrong with the file, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct StartFileError {
    /// The line, from 1.
    pub line: u64,
    /// What is wrong, and how to fix it.
    pub message: String,
}

/// Reads the starting tiles, one per line; returns them in the order of their numbers.
///
/// # Errors
/// If a line cannot be read, or tiles overlap or extend beyond the rim.
pub fn read(text: &str, crowd: &Crowd) -> Result<Vec<Mover>, StartFileError> {
    let mut reader = ReaderBuilder::new()
        .flexible(true)
        .trim(Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let wrong = |line: u64, message: String| StartFileError { line, message };
    let headers = reader
        .headers()
        .map_err(|it| wrong(1, it.to_string()))?
        .clone();
    let mut places = [None; COLUMNS.len()];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        *place = column(&headers, &[name]).map_err(|it| wrong(1, it))?;
    }
    if let Some(missing) = places.iter().position(Option::is_none) {
        let message = format!(
            "there is no column `{}`: the first line names the columns {}",
            COLUMNS[missing],
            COLUMNS.join(",")
        );
        return Err(wrong(1, message));
    }
    let places = places.map(Option::unwrap_or_default);
    let columns = headers.len();
    let mut found: Vec<(usize, u64, Mover)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(0, csv::Position::line);
            wrong(line, error.to_string())
        })?;
        let line = record.position().map_or(0, csv::Position::line);
        not_too_long(&record, columns).map_err(|it| wrong(line, it))?;
        let entry = |column: usize| record.get(places[column]).unwrap_or_default();
        let tile: usize = entry(0).parse().map_err(|_| {
            let message = format!("`{}` is not a tile number: count tiles from 0", entry(0));
            wrong(line, message)
        })?;
        let kind = crowd.kinds.iter().position(|kind| kind.name == entry(1));
        let kind = kind.ok_or_else(|| {
            let names: Vec<&str> = crowd.kinds.iter().map(|it| it.name.as_str()).collect();
            let message = format!(
                "`{}` is not a kind of tile; the kinds are {}",
                entry(1),
                names.join(", ")
            );
            wrong(line, message)
        })?;
        let mut numbers = [0.0; 6];
        for (k, number) in numbers.iter_mut().enumerate() {
            let text = entry(k + 2);
            let read: Option<f64> = text.parse().ok().filter(|it: &f64| it.abs() <= FARTHEST);
            *number = read.ok_or_else(|| {
                wrong(
                    line,
                    format!(
                        "`{text}` in the column `{}` is not a number",
                        COLUMNS[k + 2]
                    ),
                )
            })?;
        }
        if let Some((_, other, _)) = found.iter().find(|it| it.0 == tile) {
            let message = format!("tile {tile} is already on line {other}");
            return Err(wrong(line, message));
        }
        let [x, y, theta, vx, vy, omega] = numbers;
        let motion = Motion {
            configuration: Configuration::from([x, y, theta]),
            velocity: [vx, vy, omega].into(),
        };
        found.push((tile, line, Mover::new(crowd, kind, &motion)));
    }
    if found.is_empty() {
        return Err(wrong(
            1,
            "there are no tiles: write one line per tile".to_owned(),
        ));
    }
    found.sort_by_key(|it| it.0);
    if let Some((k, it)) = found.iter().enumerate().find(|(k, it)| it.0 != *k) {
        let message = format!("tile {k} is missing: number the tiles from 0, each once");
        return Err(wrong(it.1, message));
    }
    let lines: Vec<u64> = found.iter().map(|it| it.1).collect();
    let movers: Vec<Mover> = found.into_iter().map(|it| it.2).collect();
    check(crowd, &movers, true).map_err(|error| misplaced(&error, &lines))?;
    Ok(movers)
}

/// The error of a tile in a place where it cannot be; `lines` are those of the tiles.
fn misplaced(error: &StartError, lines: &[u64]) -> StartFileError {
    let (tile, message) = match error {
        StartError::Overlap { first, second, .. } => (
            *second,
            format!(
                "{error}: move it away from tile {first} (line {})",
                lines[*first]
            ),
        ),
        StartError::BeyondRim { tile, .. } => {
            let help = "move it inwards; x and y are in m from the centre of the table";
            (*tile, format!("{error}: {help}"))
        }
        other => (0, other.to_string()),
    };
    StartFileError {
        line: lines[tile],
        message,
    }
}
