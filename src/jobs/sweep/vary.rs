//! The varied keys of a design, and their values.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::design::{angle, length};
use physics::units::to_digits;

/// Largest number of points of a range.
const MOST_VALUES: usize = 100_000;

/// A value of a key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// `true` or `false`.
    Truth(bool),
    /// A whole number, in the key's unit.
    Whole(i64),
    /// Any other finite number, in the key's unit.
    Number(f64),
    /// A word.
    Text(String),
}

impl Value {
    /// The value in the notation of design files.
    pub fn toml(&self) -> toml::Value {
        match self {
            Self::Truth(truth) => toml::Value::Boolean(*truth),
            Self::Whole(whole) => toml::Value::Integer(*whole),
            Self::Number(number) => toml::Value::Float(*number),
            Self::Text(text) => toml::Value::String(text.clone()),
        }
    }

    /// The value as a number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Whole(whole) => Some(*whole as f64),
            Self::Number(number) => Some(*number),
            Self::Truth(_) | Self::Text(_) => None,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Truth(truth) => truth.fmt(f),
            Self::Whole(whole) => whole.fmt(f),
            Self::Number(number) => number.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

/// A key by its dotted path, such as `fixed.faces.east.profile.depth`, and its values in order. A
/// number in the path counts the items of an array from 0.
///
/// Written as `KEY=a:b:n`, n evenly spaced numbers from a to b (`0 mm:30 mm:4` too), or as a list `KEY=v,w,...` of
/// numbers, `true` and `false`, and words; a word that looks like a number goes in double quotes.
/// `KEY=a:b` is a range, of which a search takes any number.
///
/// ```
/// use tilebind_jobs::sweep::{Axis, Value};
/// let axis: Axis = "fixed.faces.east.profile.depth=0:0.03:4".parse()?;
/// let values: Vec<String> = axis.values.iter().map(Value::to_string).collect();
/// assert_eq!(values, ["0", "0.01", "0.02", "0.03"]);
/// let axis: Axis = "potential.model=dipole,cuboid".parse()?;
/// assert_eq!(axis.values[1], Value::Text("cuboid".into()));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// The dotted path.
    pub key: String,
    /// In the order of the sweep; the two ends of a range.
    pub values: Vec<Value>,
    /// Whether all numbers between its two values are meant, as in `KEY=a:b`: in a search only.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_range: bool,
}

impl Axis {
    /// A key with listed values.
    pub fn listed(key: String, values: Vec<Value>) -> Self {
        Self {
            key,
            values,
            is_range: false,
        }
    }

    /// Its values; of a range also the middle.
    pub(super) fn samples(&self) -> Vec<Value> {
        let mut samples = self.values.clone();
        if let ([from, to], true) = (&self.numbers().unwrap_or_default()[..], self.is_range) {
            samples.push(Value::Number(rounded((from + to) / 2.0)));
        }
        samples
    }

    /// The last part of its path.
    pub fn name(&self) -> &str {
        self.key.rsplit('.').next().unwrap_or(&self.key)
    }

    /// Its values as numbers, if all are.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        self.values.iter().map(Value::number).collect()
    }
}

impl std::str::FromStr for Axis {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "write KEY=a:b:n, such as fixed.faces.east.profile.depth=0:0.05:11, or \
                            KEY=v,w,..., such as potential.model=dipole,cuboid";
        let (key, values) = text.split_once('=').ok_or(FORM)?;
        let key = key.trim();
        if key.is_empty() || key.split('.').any(|part| part.trim().is_empty()) {
            return Err(format!("`{key}` is not a dotted path; {FORM}"));
        }
        let values = match values.split(':').collect::<Vec<_>>()[..] {
            [from, to, count] => range(from, to, count)?,
            [from, to] if !values.contains('"') && end(from).is_ok() && end(to).is_ok() => {
                return between(key, end(from)?, end(to)?);
            }
            _ => values
                .split(',')
                .map(|word| value(word.trim()))
                .collect::<Result<_, _>>()?,
        };
        Ok(Self::listed(key.to_owned(), values))
    }
}

/// All numbers from one to another.
fn between(key: &str, from: f64, to: f64) -> Result<Axis, String> {
    if from >= to {
        return Err(format!(
            "the range of `{key}` is empty: write the smaller end first, such as {key}=0:0.05"
        ));
    }
    Ok(Axis {
        key: key.to_owned(),
        values: [from, to].map(Value::Number).to_vec(),
        is_range: true,
    })
}

/// `count` evenly spaced numbers; whole ones if all are whole and both ends are written so.
fn range(from: &str, to: &str, count: &str) -> Result<Vec<Value>, String> {
    let (first, last) = (end(from)?, end(to)?);
    let steps = count.trim().parse().ok();
    let count: usize = steps
        .filter(|n| (1..=MOST_VALUES).contains(n))
        .ok_or_else(|| format!("`{count}` is not a whole number from 1 to {MOST_VALUES}"))?;
    let number = |k: usize| {
        let share = k as f64 / (count - 1).max(1) as f64;
        let value = rounded(first + (last - first) * share);
        // Removes rounding errors where the ends cancel: -0.01:0.02:4 passes through 0.
        if value.abs() < 1e-12 * first.abs().max(last.abs()) {
            0.0
        } else {
            value
        }
    };
    let numbers: Vec<f64> = (0..count).map(number).collect();
    let written_whole = [from, to].iter().all(|t| t.trim().parse::<i64>().is_ok());
    let whole = written_whole && numbers.iter().all(|x| x.fract() == 0.0 && x.abs() < 1e15);
    let value = |x: f64| {
        if whole {
            Value::Whole(x as i64)
        } else {
            Value::Number(x)
        }
    };
    Ok(numbers.into_iter().map(value).collect())
}

/// A number, also a length or an angle with a unit.
pub(super) fn number(text: &str) -> Option<f64> {
    length(text).or_else(|| angle(text))
}

/// An end of a range.
fn end(text: &str) -> Result<f64, String> {
    number(text).ok_or_else(|| format!("`{text}` is not a number; a range is a:b:n"))
}

/// A number to twelve significant digits: 0.03, not 0.030000000000000002. Never -0.
pub(crate) fn rounded(value: f64) -> f64 {
    to_digits(value, 12) + 0.0
}

fn value(word: &str) -> Result<Value, String> {
    if let Some(quoted) = word.strip_prefix('"').and_then(|w| w.strip_suffix('"')) {
        return Ok(Value::Text(quoted.to_owned()));
    }
    if word.is_empty() {
        return Err("a value of the list is missing".to_owned());
    }
    if let Ok(whole) = word.parse() {
        // `04` only occurs as the part after a decimal comma.
        return match word.len() > 1 && word.starts_with('0') {
            true => Err(format!(
                "`{word}` begins with 0: use a decimal point, not a comma: 0.{word}"
            )),
            false => Ok(Value::Whole(whole)),
        };
    }
    Ok(match (word, word.parse::<f64>()) {
        ("true", _) => Value::Truth(true),
        ("false", _) => Value::Truth(false),
        (_, Ok(number)) if number.is_finite() => Value::Number(number),
        _ => Value::Text(word.to_owned()),
    })
}
