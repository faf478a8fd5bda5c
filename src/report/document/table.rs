//! Tables: their columns are declared once, each with its key, name, meaning and value.

use std::borrow::Cow;

use super::{Cell, Unit};

/// What a figure or a column is.
#[derive(Clone, Debug)]
pub struct Head {
    /// What files call it; ends in the unit.
    pub key: Cow<'static, str>,
    /// What people call it; empty for what programs only read.
    pub name: Cow<'static, str>,
    /// What it means, in a sentence.
    pub meaning: &'static str,
    /// What it is measured in.
    pub unit: Unit,
    /// Which columns it is in tables of numbers.
    pub(super) parts: Parts,
    /// Digits that people see.
    pub digits: usize,
    /// Whether programs read it, in JSON ...
    pub is_data: bool,
    /// ... and in tables of numbers.
    pub is_csv: bool,
    /// Whether people see it ...
    pub is_viewed: bool,
    /// ... and on a terminal, too.
    pub is_printed: bool,
}

/// What a column of figures is in tables of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parts {
    /// One column.
    One,
    /// `low` and `high`, where the key has `interval` or `bounds`.
    Ends,
    /// x, y and theta, where the key ends in `pose`.
    Pose,
    /// A share with the ends of its interval.
    Sampled,
}

impl Parts {
    fn of_key(key: &str) -> Self {
        let of = Unit::stripped(key);
        match key {
            _ if key.ends_with("pose") => Self::Pose,
            _ if ["interval", "bounds"].iter().any(|end| of.ends_with(end)) => Self::Ends,
            _ => Self::One,
        }
    }
}

impl Head {
    /// Of a quantity whose unit its key says.
    pub fn new(
        key: impl Into<Cow<'static, str>>,
        name: impl Into<Cow<'static, str>>,
        meaning: &'static str,
    ) -> Self {
        let (key, name) = (key.into(), name.into());
        Self {
            unit: Unit::of_key(&key),
            parts: Parts::of_key(&key),
            is_viewed: !name.is_empty(),
            key,
            name,
            meaning,
            digits: 3,
            is_data: true,
            is_csv: true,
            is_printed: true,
        }
    }

    /// A value as people read it.
    pub fn told(&self, cell: &Cell) -> String {
        cell.told(self.unit, self.digits)
    }
}

/// Rows of which a table is made, column by column.
///
/// ```
/// use tilebind_report::document::rows;
///
/// let table = rows([(1e-3, 0.25), (2e-3, 0.5)])
///     .column("kT_J", "kT", "energy of shaking", |row| row.0)
///     .column("yield", "bound", "share of all pairs", |row| row.1).share()
///     .table("settings");
/// assert_eq!(table.text(1, 0), "2.00 mJ");
/// assert_eq!(table.text(1, 1), "50 %");
/// ```
pub struct Rows<'a, Row> {
    rows: Vec<Row>,
    columns: Vec<Column<'a, Row>>,
}

/// What makes something of a row.
type Of<'a, Row, T> = dyn Fn(&Row) -> T + 'a;

/// A column whose cells are made from `Row`s.
struct Column<'a, Row> {
    head: Head,
    get: Box<Of<'a, Row, Cell>>,
    view: Option<Box<Of<'a, Row, String>>>,
}

/// Rows for some things.
pub fn rows<'a, Row>(rows: impl IntoIterator<Item = Row>) -> Rows<'a, Row> {
    Rows {
        rows: rows.into_iter().collect(),
        columns: Vec::new(),
    }
}

impl<'a, Row> Rows<'a, Row> {
    /// A column more: its key in files, which ends in its unit, what people call it, what it means,
    /// and its value in a row.
    #[must_use]
    pub fn column<C: Into<Cell>>(
        mut self,
        key: impl Into<Cow<'static, str>>,
        name: impl Into<Cow<'static, str>>,
        meaning: &'static str,
        get: impl Fn(&Row) -> C + 'a,
    ) -> Self {
        self.columns.push(Column {
            head: Head::new(key, name, meaning),
            get: Box::new(move |row| get(row).into()),
            view: None,
        });
        self
    }

    /// The last column as people read it, where that is more than the value.
    #[must_use]
    pub fn viewed(mut self, view: impl Fn(&Row) -> String + 'a) -> Self {
        if let Some(column) = self.columns.last_mut() {
            column.view = Some(Box::new(view));
        }
        self
    }

    fn last(mut self, change: impl Fn(&mut Head)) -> Self {
        if let Some(column) = self.columns.last_mut() {
            change(&mut column.head);
        }
        self
    }

    /// The last column has shares of all.
    #[must_use]
    pub fn share(self) -> Self {
        self.last(|head| head.unit = Unit::Share)
    }

    /// People see so many digits of the last column.
    #[must_use]
    pub fn digits(self, digits: usize) -> Self {
        self.last(|head| head.digits = digits)
    }

    /// The last column has sampled shares of all.
    #[must_use]
    pub fn sampled(self) -> Self {
        self.last(|head| (head.unit, head.parts) = (Unit::Share, Parts::Sampled))
    }

    /// The last column is for programs only.
    #[must_use]
    pub fn in_data(self) -> Self {
        self.last(|head| head.is_viewed = false)
    }

    /// The last column is in JSON only.
    #[must_use]
    pub fn in_json(self) -> Self {
        self.in_data().without_csv()
    }

    /// The last column is no number, and in no table of them.
    #[must_use]
    pub fn without_csv(self) -> Self {
        self.last(|head| head.is_csv = false)
    }

    /// The last column is in tables of numbers only.
    #[must_use]
    pub fn in_csv(self) -> Self {
        self.in_data().last(|head| head.is_data = false)
    }

    /// The last column is for people only.
    #[must_use]
    pub fn in_view(self) -> Self {
        self.last(|head| (head.is_data, head.is_csv, head.is_viewed) = (false, false, true))
    }

    /// The last column is for people only, and not for the terminal.
    #[must_use]
    pub fn on_page(self) -> Self {
        self.in_view().last(|head| head.is_printed = false)
    }

    /// The table, by what JSON calls it.
    pub fn table(self, key: &'static str) -> Table {
        let cells = |row: &Row| -> Vec<_> {
            let cell = |column: &Column<Row>| {
                let view = column.view.as_ref().map(|view| view(row));
                ((column.get)(row), view)
            };
            self.columns.iter().map(cell).collect()
        };
        Table {
            key,
            file: None,
            title: String::new(),
            note: String::new(),
            is_data: true,
            is_viewed: true,
            is_printed: true,
            is_paged: true,
            links: Vec::new(),
            listed: usize::MAX,
            rows: self.rows.iter().map(cells).collect(),
            heads: self.columns.into_iter().map(|it| it.head).collect(),
        }
    }
}

/// What a page shows when a row of a table is clicked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// A state, by its id.
    State(usize),
    /// A way, by its number among those that are played.
    Way(usize),
}

/// Rows of figures.
#[derive(Clone, Debug)]
pub struct Table {
    /// What JSON calls it.
    pub key: &'static str,
    /// The stem of its file of numbers, if it has one.
    pub file: Option<&'static str>,
    /// What its rows are.
    pub title: String,
    /// What else there is to know of it.
    pub note: String,
    /// Whether JSON has it.
    pub is_data: bool,
    /// Whether people see it ...
    pub is_viewed: bool,
    /// ... on a terminal, ...
    pub is_printed: bool,
    /// ... and on the page.
    pub is_paged: bool,
    /// What the page shows when a row is clicked; nothing where it is empty.
    pub links: Vec<Option<Link>>,
    /// Rows that a terminal has at most, the first ones.
    pub listed: usize,
    /// What its columns are.
    pub heads: Vec<Head>,
    /// The cells, with their texts where these are more than the values.
    pub rows: Vec<Vec<(Cell, Option<String>)>>,
}

impl Table {
    /// With a file of numbers of this name.
    #[must_use]
    pub fn in_file(mut self, stem: &'static str) -> Self {
        self.file = Some(stem);
        self
    }

    /// With what its rows are, and what else there is to know of it.
    #[must_use]
    pub fn titled(mut self, title: impl Into<String>, note: impl Into<String>) -> Self {
        self.title = title.into();
        self.note = note.into();
        self
    }

    /// For programs only.
    #[must_use]
    pub fn in_data(mut self) -> Self {
        self.is_viewed = false;
        self
    }

    /// For programs only, as a file of numbers of this name.
    #[must_use]
    pub fn in_csv(mut self, stem: &'static str) -> Self {
        (self.is_data, self.is_viewed) = (false, false);
        self.in_file(stem)
    }

    /// Not on the terminal.
    #[must_use]
    pub fn on_page(mut self) -> Self {
        self.is_printed = false;
        self
    }

    /// Not on the page.
    #[must_use]
    pub fn on_terminal(mut self) -> Self {
        self.is_paged = false;
        self
    }

    /// With what the page shows when a row is clicked.
    #[must_use]
    pub fn linked(mut self, links: impl IntoIterator<Item = Option<Link>>) -> Self {
        self.links = links.into_iter().collect();
        self
    }

    /// With so many rows on a terminal at most.
    #[must_use]
    pub fn listing(mut self, most: usize) -> Self {
        self.listed = most;
        self
    }

    /// For people only.
    #[must_use]
    pub fn in_view(mut self) -> Self {
        self.is_data = false;
        self.file = None;
        self
    }

    /// The columns that people see, by their numbers: those of which anything is known.
    pub fn viewed(&self) -> impl Iterator<Item = usize> {
        let is_known = |k: usize| {
            self.rows
                .iter()
                .any(|row| !matches!(row[k].0, Cell::Missing))
        };
        let heads = self.heads.iter().enumerate();
        heads
            .filter(move |(k, head)| head.is_viewed && is_known(*k))
            .map(|(k, _)| k)
    }

    /// A cell as people read it.
    pub fn text(&self, row: usize, column: usize) -> String {
        let (cell, view) = &self.rows[row][column];
        view.clone()
            .unwrap_or_else(|| self.heads[column].told(cell))
    }
}
