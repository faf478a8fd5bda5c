//! Documents for programs: the report as JSON, tables of numbers as CSV.

use serde_json::{Map, Value};

use super::table::Parts;
use super::{Cell, Document, Entries, Entry, Head, Table};
use crate::csv::{self, number};
use crate::files::Files;
use crate::json;
use crate::names::place_name;

impl Entries {
    /// The report's text.
    pub fn report(&self) -> String {
        json::text(&object(&self.0))
    }
}

impl Document<'_> {
    /// The output with `--json`.
    pub fn printed(&self) -> String {
        let tables = self.tables();
        let alone = tables.iter().find(|table| Some(table.key) == self.printed);
        alone.map_or_else(|| self.report(), |table| json::text(&table.json()))
    }

    /// The report's text.
    pub fn report(&self) -> String {
        self.entries.report()
    }

    /// Tables of numbers by file name: those of the document, and those nested in their rows.
    pub fn numbers(&self) -> Files {
        let mut sheets: Vec<Numbers> = Vec::new();
        for table in self.tables() {
            collect(table, None, &mut sheets);
        }
        let file = |sheet: Numbers| (format!("{}.csv", sheet.file), sheet.text().into_bytes());
        sheets.into_iter().map(file).collect()
    }
}

fn object(entries: &[Entry]) -> Value {
    let mut map = Map::new();
    for entry in entries {
        match entry {
            Entry::Fact(fact) if fact.head.is_data => {
                map.insert(fact.head.key.to_string(), fact.cell.json());
            }
            Entry::Table(table) if table.is_data => {
                map.insert(table.key.to_owned(), table.json());
            }
            Entry::Group(key, inner) => {
                map.insert((*key).to_owned(), object(inner));
            }
            Entry::Data(key, value) => {
                map.insert((*key).to_owned(), value.clone());
            }
            Entry::Fact(_) | Entry::Table(_) => {}
        }
    }
    Value::Object(map)
}

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
struct Numbers {
    file: &'static str,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Numbers {
    fn text(self) -> String {
        csv::table(self.columns, self.rows)
    }
}

/// Adds a table with its nested tables; `outer` is the cell of the enclosing row.
fn collect(table: &Table, outer: Option<(&str, &str)>, sheets: &mut Vec<Numbers>) {
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
