//! Tables are made of rows, column by column, each declared once with its key, name, meaning and value.

use std::borrow::Cow;

use super::table::Parts;
use super::{Cell, Head, Table, Unit};

/// Rows of which a table is made, column by column.
///
/// ```
/// use tilebind_report::document::rows;
///
/// let table = rows([(1e-3, 0.25), (2e-3, 0.5)])
///     .column("kT_J", "kT", "energy of shaking", |row| row.0)
///     .column("yield", "bound", "share of all pairs", |row| row.1).share()
///     .table("settings");
/// let texts = |column| table.column(column);
/// assert_eq!(texts(0), ("kT (mJ)".to_owned(), vec!["1.00".to_owned(), "2.00".to_owned()]));
/// assert_eq!(texts(1).1, ["25 %", "50 %"]);
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
    /// What it is made of.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

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
