//! The document of a result, from which every output is made.
//!
//! One function makes the [`Document`] of a result; the terminal's text, JSON, CSV, the page and
//! pictures ([`super::plots`]) are made from it. A new figure or column is one entry of the document
//! and appears in all of them; `.in_data()` and `.in_view()` keep one to programs or to people.

mod data;
mod page;
mod text;

pub use crate::columns::{Cell, Head, Link, Rows, Table, Unit, describe, rows};
pub use crate::plots::Drawing;

use std::borrow::Cow;

use serde::Serialize;
use serde_json::{Value, json};

use crate::braille::Braille;
use crate::files::Files;
use crate::page::{Charts, Crowd, Landscape, Meetings};
use jobs::design::Design;

/// The document of a result.
#[derive(Default)]
pub struct Document<'a> {
    /// The heading.
    pub title: String,
    /// The headline, in one sentence.
    pub answer: String,
    /// Remarks before the results.
    pub remarks: Vec<String>,
    /// Drawn with characters, for a terminal.
    pub sketch: Option<Braille>,
    /// All results, in the order of the report.
    pub entries: Entries,
    /// The only table printed with `--json`; `None` for the whole report.
    pub printed: Option<&'static str>,
    /// Its pictures, in order.
    pub pictures: Vec<Drawing<'a>>,
    /// The interactive part of its page, if any.
    pub part: Option<PagePart>,
    /// Additional files, by name.
    pub beside: Files,
    /// Notes after the results.
    pub notes: Vec<String>,
    /// How it was made: version, model, method.
    pub origin: String,
}

/// A part of the results.
pub enum Entry {
    /// One figure.
    Fact(Fact),
    /// Rows of figures.
    Table(Table),
    /// Entries that belong together, under one key.
    Group(&'static str, Vec<Entry>),
    /// Data for programs only.
    Data(&'static str, Value),
}

/// One figure.
pub struct Fact {
    /// Its description.
    pub head: Head,
    /// Its value.
    pub cell: Cell,
    /// The value as shown to people, if that is more than the value.
    pub view: Option<String>,
    /// A note on it.
    pub note: String,
}

/// An interactive part of a page.
#[derive(Clone)]
pub enum PagePart {
    /// The energy over configurations, with pathways.
    Landscape(Box<Landscape>),
    /// Curves and maps of a sweep.
    Charts(Charts),
    /// All pairs of faces of a set of words.
    Meetings(Meetings),
    /// Many tiles on a table, over time.
    Crowd(Crowd),
}

/// Entries one after another.
#[must_use]
#[derive(Default)]
pub struct Entries(Vec<Entry>);

/// The first entries of every report: the version, the design by its name and checksum, its model.
pub fn entries(design: &Design) -> Entries {
    let identity = json!({"name": design.name, "sha256": design.sha256});
    Entries::default()
        .data("tilebind", env!("CARGO_PKG_VERSION"))
        .data("design", identity)
        .data("model", design.interaction.model.name())
}

impl Entries {
    /// Adds a figure: its key in files, which ends in its unit, its name for people (empty if it is
    /// not shown to them), and its value.
    pub fn fact(
        mut self,
        key: impl Into<Cow<'static, str>>,
        name: impl Into<Cow<'static, str>>,
        cell: impl Into<Cell>,
    ) -> Self {
        self.0.push(Entry::Fact(Fact {
            head: Head::new(key, name, ""),
            cell: cell.into(),
            view: None,
            note: String::new(),
        }));
        self
    }

    fn last(mut self, change: impl FnOnce(&mut Fact)) -> Self {
        if let Some(Entry::Fact(fact)) = self.0.last_mut() {
            change(fact);
        }
        self
    }

    /// Adds a note to the last figure.
    pub fn noted(self, note: impl Into<String>) -> Self {
        self.last(|fact| fact.note = note.into())
    }

    /// Sets the text of the last figure for people.
    pub fn viewed(self, view: impl Into<String>) -> Self {
        self.last(|fact| fact.view = Some(view.into()))
    }

    /// Marks the last figure as a share.
    pub fn share(self) -> Self {
        self.last(|fact| fact.head.unit = Unit::Share)
    }

    /// Sets the number of digits of the last figure for people.
    pub fn digits(self, digits: usize) -> Self {
        self.last(|fact| fact.head.digits = digits)
    }

    /// Restricts the last figure to people.
    pub fn in_view(self) -> Self {
        self.last(|fact| (fact.head.is_data, fact.head.is_viewed) = (false, true))
    }

    /// Appends other entries.
    pub fn and(mut self, others: Self) -> Self {
        self.0.extend(others.0);
        self
    }

    /// Adds a table.
    pub fn table(mut self, table: Table) -> Self {
        self.0.push(Entry::Table(table));
        self
    }

    /// Adds the figures of a table's first row.
    pub fn row(self, mut table: Table) -> Self {
        let row = table.rows.drain(..).next().unwrap_or_default();
        let fact = |(head, (cell, view))| Fact {
            head,
            cell,
            view,
            note: String::new(),
        };
        let facts = table.heads.into_iter().zip(row).map(fact);
        self.more(facts.map(Entry::Fact))
    }

    /// Adds optional entries.
    pub fn more(mut self, entries: impl IntoIterator<Item = Entry>) -> Self {
        self.0.extend(entries);
        self
    }

    /// Adds entries under one key.
    pub fn group(mut self, key: &'static str, entries: Self) -> Self {
        self.0.push(Entry::Group(key, entries.0));
        self
    }

    /// Adds data for programs under a key.
    pub fn data(mut self, key: &'static str, value: impl Serialize) -> Self {
        self.0.push(Entry::Data(key, json!(value)));
        self
    }
}

impl Fact {
    /// The text for people.
    pub fn to_text(&self) -> String {
        let describe = || self.head.describe(&self.cell);
        self.view.clone().unwrap_or_else(describe)
    }
}

impl Document<'_> {
    /// Visits all facts and tables, including those of groups.
    fn walk<'b>(entries: &'b [Entry], see: &mut dyn FnMut(&'b Entry)) {
        for entry in entries {
            match entry {
                Entry::Group(_, inner) => Self::walk(inner, see),
                entry => see(entry),
            }
        }
    }

    /// The tables, in order.
    pub fn tables(&self) -> Vec<&Table> {
        let mut tables = Vec::new();
        Self::walk(&self.entries.0, &mut |entry| {
            if let Entry::Table(table) = entry {
                tables.push(table);
            }
        });
        tables
    }

    /// The known figures for people, in order.
    pub fn facts(&self) -> Vec<&Fact> {
        let mut facts = Vec::new();
        Self::walk(&self.entries.0, &mut |entry| {
            if let Entry::Fact(fact) = entry
                && fact.head.is_viewed
                && !matches!(fact.cell, Cell::Missing)
            {
                facts.push(fact);
            }
        });
        facts
    }
}
