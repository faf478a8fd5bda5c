//! Tables for programs: as JSON, and their numbers as CSV.

use serde_json::Value;

use super::table::{Cell, Head, Parts, Table};
use crate::csv::{self, number};
use crate::names::place_name;

impl Table {
    /// The file of its numbers, without nested tables.
    pub fn csv(&self) -> String {
        let mut sheets = Vec::new();
        collect(&self.clone().in_file(""), None, &mut sheets);
        sheets.swap_remove(0).text()
    }

    /// An object for each row.
    pub fn json(&self) -> Value {
        let row = |cells: &Vec<(Cell, Option<String>)>| -> Value {
            let cells = self.heads.iter().zip(cells);
            let shown = cells.filter(|(head, _)| head.is_data);
            let entry =
                |(head, (cell, _)): (&Head, &(Cell, _))| (head.key.to_string(), cell.json());
            Value::Object(shown.map(entry).collect())
        };
        self.rows.iter().map(row).collect()
    }

    /// The columns of its file of numbers, each with its cells.
    pub fn columns(&self) -> Vec<(String, Vec<Cell>)> {
        let shown = (0..self.heads.len()).filter(|k| self.heads[*k].is_csv);
        let columns = shown.flat_map(|k| {
            let cells: Vec<Vec<Cell>> = self
                .rows
                .iter()
                .map(|row| parts(&self.heads[k], &row[k].0))
                .collect();
            let keys = keys(&self.heads[k]).into_iter().enumerate();
            keys.map(move |(part, key)| {
                let cells = cells.iter().map(|cells| cells[part].clone());
                (key, cells.collect())
            })
            .collect::<Vec<_>>()
        });
        columns.collect()
    }
}

/// A file of numbers.
pub struct Numbers {
    /// The stem of its name.
    pub file: &'static str,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Numbers {
    /// As CSV.
    pub fn text(self) -> String {
        csv::table(self.columns, self.rows)
    }
}

/// Adds a table with its nested tables; `outer` is the cell of the enclosing row.
pub fn collect(table: &Table, outer: Option<(&str, &str)>, sheets: &mut Vec<Numbers>) {
    let shown: Vec<usize> = (0..table.heads.len())
        .filter(|k| table.heads[*k].is_csv)
        .collect();
    if let Some(file) = table.file {
        let place = sheets.iter().position(|sheet| sheet.file == file);
        let place = place.unwrap_or_else(|| {
            let own = shown.iter().flat_map(|k| keys(&table.heads[*k]));
            let outer = outer.map(|(key, _)| key.to_owned());
            sheets.push(Numbers {
                file,
                columns: outer.into_iter().chain(own).collect(),
                rows: Vec::new(),
            });
            sheets.len() - 1
        });
        let rows = table.rows.iter().map(|row| {
            let outer = outer.map(|(_, cell)| cell.to_owned());
            let own = shown
                .iter()
                .flat_map(|k| texts(&table.heads[*k], &row[*k].0));
            outer.into_iter().chain(own).collect()
        });
        sheets[place].rows.extend(rows);
    }
    for row in &table.rows {
        let first = texts(&table.heads[0], &row[0].0).swap_remove(0);
        for (cell, _) in row {
            if let Cell::Rows(inner) = cell {
                collect(inner, Some((&table.heads[0].key, &first)), sheets);
            }
        }
    }
}

/// The keys of a column's columns of numbers.
fn keys(head: &Head) -> Vec<String> {
    let key = &head.key;
    match head.parts {
        Parts::One => vec![key.to_string()],
        Parts::Ends => ["low", "high"]
            .map(|end| key.replace("interval", end).replace("bounds", end))
            .to_vec(),
        Parts::Pose => ["x_m", "y_m", "theta_rad"]
            .map(|axis| key.replace("pose", axis))
            .to_vec(),
        Parts::Sampled => ["share", "low", "high"]
            .map(|part| format!("{key}_{part}"))
            .to_vec(),
    }
}

/// A cell in those columns.
fn parts(head: &Head, cell: &Cell) -> Vec<Cell> {
    match cell {
        Cell::Interval(ends) => ends.map(Cell::from).to_vec(),
        Cell::Pose(q) => q.to_array().map(Cell::from).to_vec(),
        Cell::Sampled(sampled) => [sampled.share(), sampled.low, sampled.high]
            .map(Cell::from)
            .to_vec(),
        Cell::Missing | Cell::Rows(_) | Cell::Data(_) => vec![Cell::Missing; keys(head).len()],
        cell => vec![cell.clone()],
    }
}

/// A cell's text in those columns; empty if nothing is known.
fn texts(head: &Head, cell: &Cell) -> Vec<String> {
    let text = |cell: Cell| match cell {
        Cell::Number(value) if value.is_finite() => number(value),
        Cell::Whole(value) => value.to_string(),
        Cell::Truth(value) => value.to_string(),
        Cell::Text(text) => text,
        Cell::Place(place) => place_name(place),
        _ => String::new(),
    };
    parts(head, cell).into_iter().map(text).collect()
}
