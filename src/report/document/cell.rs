//! A value, and how people read it.

use serde_json::{Value, json};

use super::Table;
use crate::names::{place, place_name};
use crate::values::{pose, positive_zero};
use physics::configuration::Configuration;
use physics::landscape::{Place, Proportion};
use physics::units::{duration, plain, si, si_range};

/// A value of a table or a fact.
#[derive(Clone, Debug)]
pub enum Cell {
    /// Not known, or there is none.
    Missing,
    /// A quantity; what is not finite is not known, or never.
    Number(f64),
    /// A count or a number by which something is called.
    Whole(i128),
    /// Whether something holds.
    Truth(bool),
    /// A name.
    Text(String),
    /// The ends between which a quantity lies; in tables of numbers two columns, `low` and `high` in
    /// place of `interval` or `bounds`.
    Interval([Option<f64>; 2]),
    /// A configuration (m, m, rad); in tables of numbers three columns.
    Pose(Configuration),
    /// A state or `free`.
    Place(Place),
    /// A sampled share with its 95 % interval.
    Sampled(Proportion),
    /// Rows of their own; a table of numbers repeats the first column of the row that they belong to.
    Rows(Table),
    /// What programs alone read.
    Data(Value),
}

/// What a quantity is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Nothing: a count, a ratio, a name.
    None,
    /// A part of all, which people read in percent.
    Share,
    /// A unit by its symbol.
    Of(&'static str),
}

/// Ends of keys and the units that they stand for, longer ones first.
const UNITS: [(&str, &str); 21] = [
    ("_m2_per_s", "m²/s"),
    ("_m2_s", "m²/s"),
    ("_per_m2", "1/m²"),
    ("_per_m", "1/m"),
    ("_m_per_s", "m/s"),
    ("_per_s", "/s"),
    ("_m2_rad", "m² rad"),
    ("_J_per_m", "J/m"),
    ("_rad", "rad"),
    ("_deg", "°"),
    ("_kT", "kT"),
    ("_Nm", "N m"),
    ("_Am2", "A m²"),
    ("_kg", "kg"),
    ("_m2", "m²"),
    ("_m_s", "m/s"),
    ("_m", "m"),
    ("_s", "s"),
    ("_J", "J"),
    ("_N", "N"),
    ("_T", "T"),
];

impl Unit {
    /// The unit in which a key ends.
    pub fn of_key(key: &str) -> Self {
        let found = UNITS.iter().find(|(end, _)| key.ends_with(end));
        found.map_or(Self::None, |(_, symbol)| Self::Of(symbol))
    }

    /// A key without its unit.
    pub(super) fn stripped(key: &str) -> &str {
        let mut found = UNITS.iter().filter_map(|(end, _)| key.strip_suffix(end));
        found.next().unwrap_or(key)
    }

    /// Its symbol; empty where there is none.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Share => "%",
            Self::Of(symbol) => symbol,
        }
    }
}

/// A number as people read it: with so many digits, its unit, and a prefix where that is usual.
pub fn told(value: f64, unit: Unit, digits: usize) -> String {
    match unit {
        _ if value.is_nan() => "-".to_owned(),
        Unit::Of("s") if value.is_infinite() => "never".to_owned(),
        _ if value.is_infinite() => "-".to_owned(),
        Unit::None => plain(value, digits),
        Unit::Share => share(value),
        Unit::Of("s") => duration(value, digits),
        Unit::Of("rad") => format!("{:.1}\u{b0}", value.to_degrees() + 0.0),
        Unit::Of("kT") => format!("{value:.1} kT"),
        Unit::Of(symbol @ ("J" | "m" | "N" | "T" | "m/s" | "N m")) => si(value, symbol, digits),
        Unit::Of(symbol) => format!("{} {symbol}", plain(value, digits)),
    }
}

/// `42 %`; two decimals below one percent.
fn share(value: f64) -> String {
    match 100.0 * value {
        percent if percent > 0.0 && percent < 1.0 => format!("{percent:.2} %"),
        percent => format!("{percent:.0} %"),
    }
}

impl Cell {
    /// As people read it.
    pub fn told(&self, unit: Unit, digits: usize) -> String {
        match self {
            Self::Missing => "-".to_owned(),
            Self::Number(value) => told(*value, unit, digits),
            Self::Whole(value) => value.to_string(),
            Self::Truth(value) => if *value { "yes" } else { "no" }.to_owned(),
            Self::Text(text) => text.clone(),
            Self::Interval([Some(low), Some(high)]) => match unit {
                Unit::Of(symbol @ ("J" | "m" | "N")) => si_range(*low, *high, symbol, digits),
                _ => {
                    let [low, high] = [*low, *high].map(|end| told(end, unit, digits));
                    format!("{low} to {high}")
                }
            },
            Self::Interval([Some(low), None]) => format!("{} or more", told(*low, unit, digits)),
            Self::Interval([None, Some(high)]) => format!("at most {}", told(*high, unit, digits)),
            Self::Interval([None, None]) => "-".to_owned(),
            Self::Pose(q) => {
                let parts = [1e3 * q.x, 1e3 * q.y, q.theta.to_degrees()];
                // To a tenth, and none of them -0.
                let [x, y, theta] = parts.map(|part| (10.0 * part).round() / 10.0 + 0.0);
                format!("{x:.1}, {y:.1}, {theta:.1}\u{b0}")
            }
            Self::Place(place) => place_name(*place),
            Self::Sampled(sampled) => crate::figures::percent(sampled),
            Self::Rows(_) | Self::Data(_) => String::new(),
        }
    }

    /// What a table sorts by: a number, or the text itself.
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

    /// As JSON has it; what is not finite is null.
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
            Self::Sampled(sampled) => crate::values::proportion(*sampled),
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
    fn people_read_units_with_prefixes_and_words_for_what_is_none() {
        let read = |cell: Cell, key| cell.told(Unit::of_key(key), 3);
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
        assert_eq!(Cell::from(0.004).told(Unit::Share, 3), "0.40 %");
    }
}
