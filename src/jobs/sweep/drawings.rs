//! The drawings that the designs of a sweep refer to. The manifest contains them, so that a point
//! is the same on every machine, and a changed drawing makes another point.

use std::collections::{BTreeMap, BTreeSet};

use toml::{Table, Value as Toml};

use super::vary::{Axis, Value};
use crate::design::drawings;

/// The key that names a drawing, in any table.
const FILE: &str = "file";

/// The drawings that a design names.
pub fn named(document: &Table) -> BTreeSet<&str> {
    fn below<'a>(value: &'a Toml, names: &mut BTreeSet<&'a str>) {
        match value {
            Toml::Table(table) => within(table, names),
            Toml::Array(items) => items.iter().for_each(|item| below(item, names)),
            _ => {}
        }
    }
    fn within<'a>(table: &'a Table, names: &mut BTreeSet<&'a str>) {
        for (key, value) in table {
            match value {
                Toml::String(name) if key == FILE => {
                    names.insert(name);
                }
                _ => below(value, names),
            }
        }
    }
    let mut names = BTreeSet::new();
    within(document, &mut names);
    names
}

/// The text of every readable drawing that the design at `file` names, as it is or with varied keys
/// set.
pub fn held(file: &str, document: &Table, axes: &[Axis]) -> BTreeMap<String, String> {
    let mut names = named(document);
    for axis in axes {
        if axis.key.rsplit('.').next().map(str::trim) == Some(FILE) {
            names.extend(axis.values.iter().filter_map(|value| match value {
                Value::Text(name) => Some(name.as_str()),
                _ => None,
            }));
        }
    }
    names
        .into_iter()
        .filter_map(|name| Some((name.to_owned(), drawings::read_text(file, name).ok()?)))
        .collect()
}
