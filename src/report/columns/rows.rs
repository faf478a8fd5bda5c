//! Tables built column by column; each column is declared once with its key, name, meaning and
//! value.

use std::borrow::Cow;

use super::table::{Cell, Head, Parts, Table};
use super::unit::Unit;

/// Rows from which a table is built, column by column.
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
#[must_use]
pub struct Rows<'a, Row> {
    rows: Vec<Row>,
    columns: Vec<Column<'a, Row>>,
}

/// A function of a row.
type Of<'a, Row, T> = dyn Fn(&Row) -> T + 'a;

/// A column whose cells are made from `Row`s.
struct Column<'a, Row> {
    head: Head,
    get: Box<Of<'a, Row, Cell>>,
    view: Option<Box<Of<'a, Row, String>>>,
}

/// Starts a table with one row per item.
pub fn rows<'a, Row>(rows: impl IntoIterator<Item = Row>) -> Rows<'a, Row> {
    Rows {
        rows: rows.into_iter().collect(),
        columns: Vec::new(),
    }
}

impl<'a, Row> Rows<'a, Row> {
    /// The items that the rows are made from.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Adds a column: its key in files, which ends in its unit, its name for people, its meaning,
    /// and its value in a row.
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

    /// Adds a column for programs alone: its key, and its value in a row.
    pub fn data<C: Into<Cell>>(
        self,
        key: impl Into<Cow<'static, str>>,
        get: impl Fn(&Row) -> C + 'a,
    ) -> Self {
        self.column(key, "", "", get)
    }

    /// Adds a column for people alone: its name, its meaning, and its value in a row.
    pub fn shown<C: Into<Cell>>(
        self,
        name: impl Into<Cow<'static, str>>,
        meaning: &'static str,
        get: impl Fn(&Row) -> C + 'a,
    ) -> Self {
        self.column("", name, meaning, get).in_view()
    }

    /// Sets the text of the last column for people, if that is more than the value.
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

    /// Marks the last column as shares.
    pub fn share(self) -> Self {
        self.last(|head| head.unit = Unit::Share)
    }

    /// Sets the number of digits of the last column for people.
    pub fn digits(self, digits: usize) -> Self {
        self.last(|head| head.digits = digits)
    }

    /// Gives the last column the same unit for people as the column before it.
    pub fn beside(self) -> Self {
        self.last(|head| head.is_beside = true)
    }

    /// Marks the last column as sampled shares.
    pub fn sampled(self) -> Self {
        self.last(|head| head.parts = Parts::Sampled)
    }

    /// Restricts the last column to programs.
    pub fn in_data(self) -> Self {
        self.last(|head| head.is_viewed = false)
    }

    /// Restricts the last column to JSON.
    pub fn in_json(self) -> Self {
        self.in_data().without_csv()
    }

    /// Excludes the last column from tables of numbers.
    pub fn without_csv(self) -> Self {
        self.last(|head| head.is_csv = false)
    }

    /// Restricts the last column to tables of numbers.
    pub fn in_csv(self) -> Self {
        self.in_data().last(|head| head.is_data = false)
    }

    /// Restricts the last column to people.
    pub fn in_view(self) -> Self {
        self.last(|head| (head.is_data, head.is_csv, head.is_viewed) = (false, false, true))
    }

    /// Restricts the last column to the page.
    pub fn on_page(self) -> Self {
        self.in_view().last(|head| head.is_printed = false)
    }

    /// Sets the number of digits of all energies for people.
    pub fn energies(mut self, digits: usize) -> Self {
        let heads = self.columns.iter_mut().map(|column| &mut column.head);
        let energies = heads.filter(|head| head.unit == Unit::Of("J"));
        energies.for_each(|head| head.digits = digits);
        self
    }

    /// A table for people alone: of the columns with these names, in this order.
    pub fn view(mut self, names: &[&str]) -> Table {
        let place = |column: &Column<Row>| names.iter().position(|name| *name == column.head.name);
        self.columns.retain(|column| place(column).is_some());
        self.columns.sort_by_key(place);
        for column in &mut self.columns {
            column.head.is_viewed = true;
        }
        self.table("").in_view()
    }

    /// The finished table, with its key in JSON.
    pub fn table(self, key: impl Into<Cow<'static, str>>) -> Table {
        let cells = |row: &Row| -> Vec<_> {
            let cell = |column: &Column<Row>| {
                let view = column.view.as_ref().map(|view| view(row));
                ((column.get)(row), view)
            };
            self.columns.iter().map(cell).collect()
        };
        Table {
            key: key.into(),
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
