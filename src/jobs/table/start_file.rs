//! Reads the starting positions of tiles from a CSV file.

use std::collections::BTreeMap;

use csv::{ReaderBuilder, Trim};

use super::crowds::{MOST_TILES, Named};
use crate::measured::{ANGLE, LENGTH, Measured, SPEED, SPIN};
use crate::request::FARTHEST;
use crate::text::{column, not_too_long};
use physics::configuration::Configuration;
use physics::dynamics::Motion;
use physics::observer::Observer;
use physics::table::settle::settle;
use physics::table::start::check;
use physics::table::{Crowd, Mover, StartError};

/// The columns.
const COLUMNS: [&str; 8] = ["tile", "kind", "x", "y", "theta", "vx", "vy", "omega"];
/// What the columns from the third on measure.
const MEASURED: [Measured; 6] = [LENGTH, LENGTH, ANGLE, SPEED, SPEED, SPIN];

/// The place of the kind among them: it may be missing if there is only one.
const KIND: usize = 1;

/// What is wrong with the file, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct StartFileError {
    /// The line, from 1.
    pub line: u64,
    /// What is wrong, and how to fix it.
    pub message: String,
}

/// Reads the starting tiles, one per line; returns them in the order of their numbers. Columns may
/// carry a unit in their name (`x_mm`), and entries one of their own (`12 mm`). Tiles that overlap
/// slightly are moved apart, and the observer is warned.
///
/// # Errors
/// If a line cannot be read, or tiles overlap or extend beyond the rim.
pub fn read(
    text: &str,
    (crowd, named): (&Crowd, &Named),
    observer: &dyn Observer,
) -> Result<Vec<Mover>, StartFileError> {
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
    let mut measures = [None; MEASURED.len()];
    for (k, (place, name)) in places.iter_mut().zip(COLUMNS).enumerate() {
        let Some(measured) = k.checked_sub(2).map(|k| MEASURED[k]) else {
            *place = column(&headers, &[name]).map_err(|it| wrong(1, it))?;
            continue;
        };
        let found = measured.column(&headers, name);
        let found = found.map_err(|it| wrong(1, it))?;
        *place = found.map(|column| column.place);
        measures[k - 2] = found;
    }
    let is_needed = |column: &usize| *column != KIND || named.only().is_none();
    let mut missing = (0..COLUMNS.len()).filter(|it| places[*it].is_none());
    if let Some(missing) = missing.find(is_needed) {
        let message = format!(
            "there is no column `{}`: the first line names the columns {}",
            COLUMNS[missing],
            COLUMNS.join(",")
        );
        return Err(wrong(1, message));
    }
    // A column that is missing is empty.
    let places = places.map(|place| place.unwrap_or(usize::MAX));
    let columns = headers.len();
    let mut found: BTreeMap<usize, (u64, Mover)> = BTreeMap::new();
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
        let called = |name: &str| {
            let own = crowd.kinds.iter().position(|kind| kind.name == name);
            let aliases = || named.aliases.iter().find(|it| it.0 == name);
            own.or_else(|| aliases().map(|it| it.1))
        };
        let kind = match entry(KIND) {
            "" => named.only(),
            name => called(name),
        };
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
            let read = measures[k].and_then(|column| column.number(text));
            let read = read.filter(|it| it.abs() <= FARTHEST);
            *number = read.ok_or_else(|| {
                let unit = measures[k].map_or("m", |column| column.unit());
                let name = COLUMNS[k + 2];
                wrong(
                    line,
                    format!(
                        "`{text}` in the column `{name}` is not a number in {unit} or with a unit"
                    ),
                )
            })?;
        }
        if let Some((other, _)) = found.get(&tile) {
            let message = format!("tile {tile} is already on line {other}: number it otherwise");
            return Err(wrong(line, message));
        }
        if found.len() == MOST_TILES {
            let message = format!("a table can have at most {MOST_TILES} tiles: remove the rest");
            return Err(wrong(line, message));
        }
        let [x, y, theta, vx, vy, omega] = numbers;
        let motion = Motion {
            configuration: Configuration::from([x, y, theta]),
            velocity: [vx, vy, omega].into(),
        };
        found.insert(tile, (line, Mover::from_reference(crowd, kind, &motion)));
    }
    if found.is_empty() {
        return Err(wrong(
            1,
            "there are no tiles: write one line per tile".to_owned(),
        ));
    }
    if let Some((k, (_, it))) = found.iter().enumerate().find(|(k, (tile, _))| *tile != k) {
        let message = format!("tile {k} is missing: number the tiles from 0, each once");
        return Err(wrong(it.0, message));
    }
    let (lines, mut movers): (Vec<u64>, Vec<Mover>) = found.into_values().unzip();
    let moved = settle(crowd, &mut movers, true);
    check(crowd, &movers, true).map_err(|error| misplaced(&error, &lines))?;
    if moved > 0.0 {
        observer.warn(&format!(
            "tiles of the start overlap slightly: they are moved out to contact, by up to {:.3} um",
            1e6 * moved
        ));
    }
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
