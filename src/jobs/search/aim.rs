//! What a search is for: objectives and conditions.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::interval::FigureBounds;
use crate::comparison::quantity::{Measure, QUANTITIES};
use crate::comparison::{Assessment, Quantity};
use crate::design;
use crate::request::{self, options};

/// Number of points that are tried if nothing else is asked for.
const POINTS: usize = 60;
/// Largest number of points.
const MOST_POINTS: usize = 10_000;
/// Largest number of objectives.
const MOST_OBJECTIVES: usize = 2;

options! {
    /// The options of a search.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct Request {
        /// Search for the largest value of a figure, such as bond_depth; two give their front
        pub maximise: Vec<Objective> = value("FIGURE", largest),

        /// Search for the smallest value of a figure, such as trap_depth
        pub minimise: Vec<Objective> = value("FIGURE", smallest),

        /// Condition of a search, such as "captured > 0.5" or "bond_depth > 20 mJ"; may be repeated
        pub subject: Vec<Condition> = value("CONDITION", str::parse::<Condition>),

        /// Number of designs that a search tries [default: 60]
        pub points: Option<usize> = value("N", points),
    }
}

fn points(text: &str) -> Result<usize, String> {
    let count = request::count(text)?;
    match count {
        2..=MOST_POINTS => Ok(count),
        _ => Err(format!("a search tries from 2 to {MOST_POINTS} designs")),
    }
}

impl Request {
    /// The aim; `None` without an objective.
    ///
    /// # Errors
    /// If there are conditions or a number of points but no objective, or more than two objectives,
    /// or one twice.
    pub fn aim(&self) -> Result<Option<Aim>, String> {
        let objectives: Vec<Objective> = [&self.maximise[..], &self.minimise].concat();
        let is_search = !self.subject.is_empty() || self.points.is_some();
        match objectives.len() {
            0 if is_search => Err(
                "--subject and --points belong to a search: add --maximise FIGURE or --minimise \
                 FIGURE"
                    .to_owned(),
            ),
            0 => Ok(None),
            1 | MOST_OBJECTIVES => {
                if let [one, other] = &objectives[..]
                    && one.quantity == other.quantity
                {
                    return Err(format!("`{}` is an objective twice", one.quantity));
                }
                Ok(Some(Aim {
                    objectives,
                    subject: self.subject.clone(),
                    points: self.points.unwrap_or(POINTS),
                }))
            }
            count => Err(format!(
                "a search has one objective, or two and their front, not {count}: make a \
                 condition of the others, such as --subject \"captured > 0.5\""
            )),
        }
    }
}

/// What is sought, and how much is tried.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aim {
    /// One, or two.
    pub objectives: Vec<Objective>,
    /// All of them must hold.
    pub subject: Vec<Condition>,
    /// The number of designs that are analysed.
    pub points: usize,
}

impl Aim {
    /// Checks an aim that may come from a file.
    ///
    /// # Errors
    /// If it has no objective or too many, or no points or too many.
    pub fn check(&self) -> Result<(), String> {
        if !(1..=MOST_OBJECTIVES).contains(&self.objectives.len()) {
            return Err("a search has one objective or two".to_owned());
        }
        points(&self.points.to_string()).map(drop)
    }
}

/// A figure that is to be as large or as small as possible.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Objective {
    /// The key of the figure.
    #[serde(deserialize_with = "known")]
    pub quantity: String,
    /// Whether the largest is sought.
    pub largest: bool,
}

/// The key of a figure in a manifest.
fn known<'de, D: serde::Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let key = String::deserialize(from)?;
    let found = quantity(&key).map_err(serde::de::Error::custom)?;
    Ok(found.key.to_owned())
}

fn largest(text: &str) -> Result<Objective, String> {
    Ok(Objective {
        quantity: quantity(text)?.key.to_owned(),
        largest: true,
    })
}

fn smallest(text: &str) -> Result<Objective, String> {
    Ok(Objective {
        largest: false,
        ..largest(text)?
    })
}

impl Objective {
    /// The figure.
    pub fn quantity(&self) -> &'static Quantity {
        quantity(&self.quantity).unwrap_or(&QUANTITIES[0])
    }

    /// The figure of a design with its bounds; negated if the smallest is sought, so that more is
    /// better.
    ///
    /// # Errors
    /// The reason why there is no such figure.
    pub fn gain(&self, design: &Assessment) -> Result<FigureBounds, &'static str> {
        let interval = FigureBounds::of(self.quantity(), design)?;
        Ok(match self.largest {
            true => interval,
            false => interval.negated(),
        })
    }
}

impl fmt::Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let most = if self.largest { "largest" } else { "smallest" };
        write!(f, "{most} {}", self.quantity)
    }
}

/// A condition: a figure is above or below a value.
///
/// ```
/// use tilebind_jobs::search::Condition;
/// let condition: Condition = "bond > 20 mJ".parse()?;
/// assert_eq!(condition.to_string(), "bond_depth > 0.02 J");
/// assert!("bond".parse::<Condition>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Condition {
    /// The key of the figure.
    #[serde(deserialize_with = "known")]
    pub quantity: String,
    /// Whether the figure is above the value.
    pub above: bool,
    /// Whether the figure may equal the value.
    pub or_equal: bool,
    /// In SI units.
    pub value: f64,
}

impl FromStr for Condition {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "a condition is FIGURE > VALUE or FIGURE < VALUE (also >= and <=), such \
                            as \"captured > 0.5\" or \"bond_depth > 20 mJ\"";
        let at = text.find(['<', '>']).ok_or(FORM)?;
        let (name, rest) = text.split_at(at);
        let (sign, rest) = rest.split_at(1);
        let or_equal = rest.starts_with('=');
        let written = rest.trim_start_matches('=').trim();
        if name.trim().is_empty() || rest.starts_with("==") || written.contains(['<', '>', '=']) {
            return Err(FORM.to_owned());
        }
        let quantity = quantity(name.trim())?;
        let (value, form) = match quantity.measure {
            Measure::Energy => (design::energy(written), "an energy, such as 20 mJ"),
            Measure::Length => (design::length(written), "a length, such as 5 mm"),
            Measure::Angle => (design::angle(written), "an angle, such as 10 deg"),
            Measure::Share => (share(written), "a share from 0 to 1, such as 0.5 or 50 %"),
            Measure::Ratio | Measure::Count => (plain(written), "a number"),
        };
        let value = value
            .filter(|value| value.is_finite())
            .ok_or_else(|| format!("`{written}` is no value of {}: it is {form}", quantity.key))?;
        Ok(Self {
            quantity: quantity.key.to_owned(),
            above: sign == ">",
            or_equal,
            value,
        })
    }
}

fn plain(text: &str) -> Option<f64> {
    text.parse().ok()
}

fn share(text: &str) -> Option<f64> {
    let value = match text.strip_suffix('%') {
        Some(percent) => plain(percent.trim())? / 100.0,
        None => plain(text)?,
    };
    Some(value).filter(|value| (0.0..=1.0).contains(value))
}

impl Condition {
    /// The figure.
    pub fn quantity(&self) -> &'static Quantity {
        quantity(&self.quantity).unwrap_or(&QUANTITIES[0])
    }

    /// By how much a design violates the condition, relative to its value; 0 if it holds.
    ///
    /// # Errors
    /// The reason why the design has no such figure.
    pub fn violation(&self, design: &Assessment) -> Result<f64, &'static str> {
        Ok(self.violation_of(FigureBounds::of(self.quantity(), design)?.value))
    }

    /// The same for a value of the figure.
    pub(super) fn violation_of(&self, value: f64) -> f64 {
        if self.admits(value) {
            return 0.0;
        }
        // At the limit itself `>` is violated, though by nothing.
        ((value - self.value).abs() / self.scale()).max(f64::MIN_POSITIVE)
    }

    /// By how much a design satisfies the condition (negative: violates it), relative to its value.
    ///
    /// # Errors
    /// As [`Condition::violation`].
    pub fn margin(&self, design: &Assessment) -> Result<f64, &'static str> {
        let value = FigureBounds::of(self.quantity(), design)?.value;
        let above = (value - self.value) / self.scale();
        Ok(if self.above { above } else { -above })
    }

    fn scale(&self) -> f64 {
        match self.value {
            0.0 => 1.0,
            value => value.abs(),
        }
    }

    fn admits(&self, value: f64) -> bool {
        match (self.above, self.or_equal) {
            (_, true) if value == self.value => true,
            (true, _) => value > self.value,
            (false, _) => value < self.value,
        }
    }

    /// Whether the bounds prove that the condition holds, or that it does not; `None` if neither.
    pub fn is_proved(&self, design: &Assessment) -> Option<bool> {
        let FigureBounds { low, high, .. } = FigureBounds::of(self.quantity(), design).ok()?;
        match (self.admits(low), self.admits(high)) {
            (true, true) => Some(true),
            (false, false) => Some(false),
            _ => None,
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.above { ">" } else { "<" };
        let equal = if self.or_equal { "=" } else { "" };
        let unit = match self.quantity().measure.unit() {
            "" => String::new(),
            unit => format!(" {unit}"),
        };
        write!(f, "{} {sign}{equal} {}{unit}", self.quantity, self.value)
    }
}

/// A figure by its name in the tables of `compare`, or by its beginning if that is unique.
fn quantity(name: &str) -> Result<&'static Quantity, String> {
    let known = || QUANTITIES.iter();
    if let Some(found) = known().find(|one| one.key == name) {
        return Ok(found);
    }
    let mut begin = known().filter(|one| !name.is_empty() && one.key.starts_with(name));
    match (begin.next(), begin.next()) {
        (Some(found), None) => Ok(found),
        _ => {
            let names: Vec<&str> = known().map(|one| one.key).collect();
            Err(format!(
                "there is no figure `{name}`: known: {}",
                names.join(", ")
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_are_read_with_units_and_signs() {
        for (text, read) in [
            ("captured>50 %", "captured > 0.5"),
            ("bond_depth >= 20 mJ", "bond_depth >= 0.02 J"),
            ("trap_depth<1e-3", "trap_depth < 0.001 J"),
            ("capture_gap > 5 mm", "capture_gap > 0.005 m"),
            ("selectivity <= 3", "selectivity <= 3"),
        ] {
            assert_eq!(text.parse::<Condition>().unwrap().to_string(), read);
        }
        for wrong in [
            "captured",
            "captured > 2",
            "captured > x",
            "> 1",
            "captured == 1",
            "captured >== 1",
            "0.1 < captured < 0.5",
            "bond_depth > 5 mm",
            "depth > 1",
            "captured > nan",
        ] {
            assert!(wrong.parse::<Condition>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn figures_are_known_by_unique_beginnings() {
        assert_eq!(quantity("bond").unwrap().key, "bond_depth");
        assert_eq!(quantity("captured").unwrap().key, "captured");
        for ambiguous in ["", "trap", "capture", "bonds"] {
            let error = quantity(ambiguous).unwrap_err();
            assert!(error.contains("known: bond_depth"), "{error}");
        }
    }
}
