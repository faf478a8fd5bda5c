//! Tables and their cells, and how people and programs read them.

use std::borrow::Cow;

use serde_json::{Value, json};

use super::unit::{Scale, Unit, describe};
use crate::figures::percent;
use crate::names::{place, place_name};
use crate::values::{pose, positive_zero, proportion, read_pose};
use physics::configuration::Configuration;
use physics::landscape::{Place, Proportion};
use physics::units::si_range;

/// A value of a table or a fact.
#[derive(Clone, Debug)]
pub enum Cell {
    /// Not known, or absent.
    Missing,
    /// A quantity; non-finite numbers mean not known, or never.
    Number(f64),
    /// A count or an index.
    Whole(i128),
    /// Whether something holds.
    Truth(bool),
    /// A name.
    Text(String),
    /// The ends of an interval; in tables of numbers two columns, `low` and `high` in place of
    /// `interval` or `bounds`.
    Interval([Option<f64>; 2]),
    /// A configuration (m, m, rad); in tables of numbers three columns.
    Pose(Configuration),
    /// A state or `free`.
    Place(Place),
    /// A sampled share with its 95 % interval.
    Sampled(Proportion),
    /// Nested rows; a table of numbers repeats the first column of the enclosing row.
    Rows(Table),
    /// Data for programs only.
    Data(Value),
}

impl Cell {
    /// As people read it.
    pub fn describe(&self, unit: Unit, digits: usize) -> String {
        match self {
            Self::Missing => "-".to_owned(),
            Self::Number(value) => describe(*value, unit, digits),
            Self::Whole(value) => value.to_string(),
            Self::Truth(value) => if *value { "yes" } else { "no" }.to_owned(),
            Self::Text(text) => text.clone(),
            Self::Interval([Some(low), Some(high)]) => match unit {
                Unit::Of(symbol @ ("J" | "m" | "N")) => si_range(*low, *high, symbol, digits),
                _ => {
                    let [low, high] = [*low, *high].map(|end| describe(end, unit, digits));
                    format!("{low} to {high}")
                }
            },
            Self::Interval([Some(low), None]) => {
                format!("{} or more", describe(*low, unit, digits))
            }
            Self::Interval([None, Some(high)]) => {
                format!("at most {}", describe(*high, unit, digits))
            }
            Self::Interval([None, None]) => "-".to_owned(),
            Self::Pose(q) => {
                let [x, y, theta] = read_pose(q);
                format!("{x}, {y}, {theta}\u{b0}")
            }
            Self::Place(place) => place_name(*place),
            Self::Sampled(sampled) => percent(sampled),
            Self::Rows(_) | Self::Data(_) => String::new(),
        }
    }

    /// The text for people, without the unit, which the heading states.
    fn describe_in(&self, scale: &Scale, digits: usize) -> String {
        let describe = |value: f64| scale.describe(value, digits);
        match self {
            Self::Number(value) => describe(*value),
            Self::Interval([Some(low), Some(high)]) => {
                format!("{} to {}", describe(*low), describe(*high))
            }
            Self::Interval([Some(low), None]) => format!("{} or more", describe(*low)),
            Self::Interval([None, Some(high)]) => format!("at most {}", describe(*high)),
            other => other.describe(Unit::None, digits),
        }
    }

    /// The sort key: a number, or the text itself.
    pub fn key(&self) -> Value {
        match self {
            Self::Number(value) if value.is_finite() => json!(value),
            Self::Whole(value) => json!(value),
            Self::Text(text) => json!(text),
            Self::Interval([low, high]) => json!(low.or(*high)),
            Self::Sampled(sampled) => json!(sampled.share()),
            Self::Truth(value) => json!(value.to_string()),
            _ => Value::Null,
        }
    }

    /// As JSON; non-finite numbers are null.
    pub fn json(&self) -> Value {
        match self {
            Self::Missing => Value::Null,
            Self::Number(value) => json!(positive_zero(*value)),
            Self::Whole(value) => json!(value),
            Self::Truth(value) => json!(value),
            Self::Text(text) => json!(text),
            Self::Interval([None, None]) => Value::Null,
            Self::Interval(ends) => json!(ends.map(|end| end.map(positive_zero))),
            Self::Pose(q) => json!(pose(q)),
            Self::Place(at) => place(*at),
            Self::Sampled(sampled) => proportion(*sampled),
            Self::Rows(table) => table.json(),
            Self::Data(value) => value.clone(),
        }
    }
}

macro_rules! cell_from {
    ($($from:ty => |$value:ident| $cell:expr;)*) => {
        $(impl From<$from> for Cell {
            fn from($value: $from) -> Self {
                $cell
            }
        })*
    };
}

cell_from! {
    f64 => |value| Self::Number(value);
    u64 => |value| Self::Whole(value.into());
    i32 => |value| Self::Whole(value.into());
    usize => |value| Self::Whole(value as i128);
    bool => |value| Self::Truth(value);
    &str => |value| Self::Text(value.to_owned());
    String => |value| Self::Text(value);
    [f64; 2] => |value| Self::Interval(value.map(|end| end.is_finite().then_some(end)));
    [Option<f64>; 2] => |value| Self::Interval(value);
    Configuration => |value| Self::Pose(value);
    Place => |value| Self::Place(value);
    Proportion => |value| Self::Sampled(value);
    Table => |value| Self::Rows(value);
    Value => |value| Self::Data(value);
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Missing, Into::into)
    }
}

/// The description of a figure or a column.
#[derive(Clone, Debug)]
pub struct Head {
    /// Its key in files, which ends in the unit.
    pub key: Cow<'static, str>,
    /// Its name for people; empty for data for programs.
    pub name: Cow<'static, str>,
    /// Its meaning, in a sentence.
    pub meaning: &'static str,
    /// Its unit.
    pub unit: Unit,
    /// Its columns in tables of numbers.
    pub(super) parts: Parts,
    /// Number of digits for people.
    pub digits: usize,
    /// Whether its unit for people has the prefix of the column before it.
    pub is_beside: bool,
    /// Whether programs read it, in JSON ...
    pub is_data: bool,
    /// ... and in tables of numbers.
    pub is_csv: bool,
    /// Whether people see it ...
    pub is_viewed: bool,
    /// ... also on a terminal.
    pub is_printed: bool,
}

/// The columns of a figure in tables of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parts {
    /// One column.
    One,
    /// `low` and `high`, if the key has `interval` or `bounds`.
    Ends,
    /// x, y and theta, if the key ends in `pose`.
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
    /// Creates the description of a quantity whose unit is in its key.
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
            is_beside: false,
            is_data: true,
            is_csv: true,
            is_printed: true,
        }
    }

    /// A value for people.
    pub fn describe(&self, cell: &Cell) -> String {
        cell.describe(self.unit, self.digits)
    }
}

/// What a page shows when a row of a table is clicked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// A state, by its id.
    State(usize),
    /// A path, by its index among the animated ones.
    Way(usize),
}

/// Rows of figures.
#[must_use]
#[derive(Clone, Debug)]
pub struct Table {
    /// Its key in JSON.
    pub key: Cow<'static, str>,
    /// The stem of its file of numbers, if it has one.
    pub file: Option<&'static str>,
    /// Its title.
    pub title: String,
    /// A note on it.
    pub note: String,
    /// Whether it is in JSON.
    pub is_data: bool,
    /// Whether people see it ...
    pub is_viewed: bool,
    /// ... on a terminal, ...
    pub is_printed: bool,
    /// ... and on the page.
    pub is_paged: bool,
    /// What the page shows when a row is clicked; empty for nothing.
    pub links: Vec<Option<Link>>,
    /// Largest number of rows on a terminal.
    pub listed: usize,
    /// The descriptions of its columns.
    pub heads: Vec<Head>,
    /// The cells, with their texts if these are more than the values.
    pub rows: Vec<Vec<(Cell, Option<String>)>>,
}

impl Table {
    /// Adds a file of numbers with this name.
    pub fn in_file(mut self, stem: &'static str) -> Self {
        self.file = Some(stem);
        self
    }

    /// Sets the title and the note.
    pub fn titled(mut self, title: impl Into<String>, note: impl Into<String>) -> Self {
        self.title = title.into();
        self.note = note.into();
        self
    }

    /// Restricts the table to programs.
    pub fn in_data(mut self) -> Self {
        self.is_viewed = false;
        self
    }

    /// Restricts the table to programs, with a file of numbers with this name.
    pub fn in_csv(mut self, stem: &'static str) -> Self {
        (self.is_data, self.is_viewed) = (false, false);
        self.in_file(stem)
    }

    /// Excludes the table from the terminal.
    pub fn on_page(mut self) -> Self {
        self.is_printed = false;
        self
    }

    /// Excludes the table from the page.
    pub fn on_terminal(mut self) -> Self {
        self.is_paged = false;
        self
    }

    /// Sets what the page shows when a row is clicked.
    pub fn linked(mut self, links: impl IntoIterator<Item = Option<Link>>) -> Self {
        self.links = links.into_iter().collect();
        self
    }

    /// Sets the largest number of rows on a terminal.
    pub fn listing(mut self, most: usize) -> Self {
        self.listed = most;
        self
    }

    /// Restricts the table to people.
    pub fn in_view(mut self) -> Self {
        self.is_data = false;
        self.file = None;
        self
    }

    /// The indices of the columns for people that have any known value.
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

    /// The heading of a column, with the unit if its cells share one, and the texts of its cells.
    pub fn column(&self, column: usize) -> (String, Vec<String>) {
        let (head, scale) = (&self.heads[column], self.scale(column));
        let describe = |cell: &Cell| match &scale {
            Some(scale) => cell.describe_in(scale, head.digits),
            None => head.describe(cell),
        };
        let cells = self.rows.iter().map(|row| &row[column]);
        let cells = cells.map(|(cell, view)| view.clone().unwrap_or_else(|| describe(cell)));
        let name = match &scale {
            Some(scale) => format!("{} ({})", head.name, scale.unit),
            None => head.name.to_string(),
        };
        (name, cells.collect())
    }

    /// The common unit of a column, and of those beside it that share its prefix, chosen by the
    /// largest value; `None` if cells have their own.
    fn scale(&self, column: usize) -> Option<Scale> {
        let first = (0..=column).rev().find(|k| !self.heads[*k].is_beside);
        let first = first.unwrap_or(0);
        let beside = self.heads[first + 1..].iter();
        let last = first + beside.take_while(|head| head.is_beside).count();
        let cells = || self.rows.iter().map(|row| &row[column]);
        let shared = self.rows.iter().flat_map(|row| &row[first..=last]);
        let sizes = shared.flat_map(|(cell, _)| match cell {
            Cell::Number(value) => [Some(*value), None],
            Cell::Interval(ends) => *ends,
            _ => [None; 2],
        });
        let sizes = sizes
            .flatten()
            .map(f64::abs)
            .filter(|size| size.is_finite());
        let most = sizes.fold(0.0, f64::max);
        match cells().any(|(_, view)| view.is_some()) {
            true => None,
            false => Scale::of(self.heads[column].unit, most, self.heads[column].digits),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_says_the_unit() {
        for (key, unit) in [
            ("energy_J", "J"),
            ("off_per_s", "/s"),
            ("on_interval_m2_per_s", "m²/s"),
            ("depth_kT", "kT"),
            ("theta_rad", "rad"),
            ("ln_K", ""),
            ("copies", ""),
        ] {
            assert_eq!(Unit::of_key(key).symbol(), unit, "{key}");
        }
    }

    #[test]
    fn a_column_has_one_unit() {
        let table = crate::columns::rows([0.065_47, -0.000_221_6, 1e-12, 0.0, f64::NAN])
            .column("energy_J", "energy", "", |it| *it)
            .digits(4)
            .column("bounds_J", "bounds", "", |it| [1e-6, it.abs()])
            .column("part", "part", "", |it| *it)
            .table("energies");
        let column = |k: usize| {
            let (name, cells) = table.column(k);
            [vec![name], cells].concat()
        };
        let energies = ["energy (mJ)", "65.47", "-0.2216", "0", "0", "-"];
        assert_eq!(column(0), energies);
        assert_eq!(
            column(1)[..3],
            ["bounds (mJ)", "0.0010 to 65.5", "0.0010 to 0.222"]
        );
        assert_eq!(column(2)[..2], ["part", "0.0655"]);
    }

    #[test]
    fn columns_beside_each_other_share_a_unit() {
        let table = crate::columns::rows([(2e-5, 0.016), (-3e-6, 0.002)])
            .column("saddle_J", "saddle", "", |it| it.0)
            .column("barrier_J", "barrier", "", |it| it.1)
            .beside()
            .column("bounds_J", "certified", "", |it| [it.1, 1.1 * it.1])
            .beside()
            .column("least_J", "least", "", |it| it.0)
            .table("barriers");
        let column = |k: usize| table.column(k);
        let one = |name: &str, cells: [&str; 2]| (name.to_owned(), cells.map(str::to_owned).into());
        assert_eq!(column(0), one("saddle (mJ)", ["0.0200", "-0.0030"]));
        assert_eq!(column(1), one("barrier (mJ)", ["16.0", "2.00"]));
        assert_eq!(
            column(2),
            one("certified (mJ)", ["16.0 to 17.6", "2.00 to 2.20"])
        );
        assert_eq!(column(3), one("least (\u{b5}J)", ["20.0", "-3.00"]));
    }

    #[test]
    fn people_read_units_with_prefixes_and_words_for_what_is_none() {
        let read = |cell: Cell, key| cell.describe(Unit::of_key(key), 3);
        assert_eq!(read((-0.065_47).into(), "energy_J"), "-65.5 mJ");
        assert_eq!(read(f64::INFINITY.into(), "time_s"), "never");
        assert_eq!(read(f64::NAN.into(), "energy_J"), "-");
        assert_eq!(
            read([0.014_54, 0.015_19].into(), "escape_J"),
            "14.5 to 15.2 mJ"
        );
        assert_eq!(
            read([Some(2.0), None].into(), "rate_per_s"),
            "2.00 /s or more"
        );
        assert_eq!(Cell::from(0.004).describe(Unit::Share, 3), "0.40 %");
    }
}
