//! Documents for programs: the report as JSON, tables of numbers as CSV.

use serde_json::{Map, Value};

use super::{Document, Entries, Entry};
use crate::columns::numbers::{Numbers, collect};
use crate::files::Files;
use crate::json;

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
        let alone = tables
            .iter()
            .find(|table| Some(&*table.key) == self.printed);
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
                map.insert(table.key.to_string(), table.json());
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
