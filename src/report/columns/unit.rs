//! Units of quantities, and how they are printed for people.

use crate::figures::share;
use physics::units::{duration, plain, prefix_and_decimals, si};

/// The unit of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// No unit: a count, a ratio, a name.
    None,
    /// A share, shown in per cent.
    Share,
    /// A unit by its symbol.
    Of(&'static str),
}

/// Suffixes of keys and their units, longer ones first.
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
    /// The unit of a key's suffix.
    pub fn of_key(key: &str) -> Self {
        let found = UNITS.iter().find(|(end, _)| key.ends_with(end));
        found.map_or(Self::None, |(_, symbol)| Self::Of(symbol))
    }

    /// A key without its unit.
    pub(super) fn stripped(key: &str) -> &str {
        let mut found = UNITS.iter().filter_map(|(end, _)| key.strip_suffix(end));
        found.next().unwrap_or(key)
    }

    /// Its symbol; empty if there is none.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Share => "%",
            Self::Of(symbol) => symbol,
        }
    }
}

/// A number for people: with a number of digits, its unit, and an SI prefix where that is usual.
pub fn describe(value: f64, unit: Unit, digits: usize) -> String {
    match unit {
        _ if value.is_nan() => "-".to_owned(),
        Unit::Of("s") if value.is_infinite() => "never".to_owned(),
        _ if value.is_infinite() => "-".to_owned(),
        Unit::None => plain(value, digits),
        Unit::Share => share(value),
        Unit::Of("s") => duration(value, digits),
        Unit::Of("rad") => format!("{:.1}\u{b0}", value.to_degrees() + 0.0),
        Unit::Of("kT") => format!("{value:.1} kT"),
        Unit::Of(symbol) if PREFIXED.contains(&symbol) => si(value, symbol, digits),
        Unit::Of(symbol) => format!("{} {symbol}", plain(value, digits)),
    }
}

/// Units that stand with a prefix.
const PREFIXED: [&str; 6] = ["J", "m", "N", "T", "m/s", "N m"];
/// Decimals of small numbers of a column more than of its largest one.
const MORE: usize = 3;

/// A unit that many numbers are told in.
pub(super) struct Scale {
    /// What it is in SI units.
    size: f64,
    /// Its symbol with the prefix.
    pub(super) unit: String,
    /// Decimals of the largest number.
    decimals: usize,
}

impl Scale {
    /// For numbers up to `most`, told to so many digits; `None` for units without prefixes.
    pub(super) fn of(unit: Unit, most: f64, digits: usize) -> Option<Self> {
        match unit {
            Unit::Of(symbol) if PREFIXED.contains(&symbol) && most > 0.0 => {
                let (size, prefix, decimals) = prefix_and_decimals(most, digits);
                let unit = format!("{prefix}{symbol}");
                Some(Self {
                    size,
                    unit,
                    decimals,
                })
            }
            _ => None,
        }
    }

    /// A number without the unit: to so many digits, as far as the decimals go.
    pub(super) fn describe(&self, value: f64, digits: usize) -> String {
        if !value.is_finite() {
            return "-".to_owned();
        }
        let (scaled, most) = (value / self.size, self.decimals + MORE);
        let decimals = (0..most).find(|&decimals| {
            // So many digits stand before and after the point.
            scaled.abs() >= 10f64.powi(digits as i32 - 1 - decimals as i32)
        });
        let decimals = decimals.unwrap_or(most);
        let text = format!("{scaled:.decimals$}");
        match text.bytes().all(|c| b"-0.".contains(&c)) {
            true => "0".to_owned(),
            false => text,
        }
    }
}
