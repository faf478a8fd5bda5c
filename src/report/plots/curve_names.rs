//! What the pictures, series and points of a sweep are called.

use super::curve_data::variables;
use crate::csv::number;
use crate::sweep::Sweep;
use jobs::sweep::{Point, Value};

/// Keys of the design that are lengths: their axes are in mm.
pub const LENGTHS: [&str; 12] = [
    "depth",
    "width",
    "offset",
    "span",
    "side",
    "thickness",
    "pitch",
    "inset",
    "fit",
    "size",
    "x",
    "y",
];

/// What all points of a picture of a map, or of a curve, have in common.
pub type Common = Vec<(String, String)>;

/// The design, where there are several, and the varied words of a point.
pub fn common(sweep: &Sweep, point: &Point, fixed: &[usize]) -> Common {
    let mut common = Vec::new();
    if sweep.plan.designs.len() > 1 {
        let name = sweep.plan.designs[point.design].name.clone();
        common.push(("design".to_owned(), name));
    }
    common.extend(fixed.iter().map(|&axis| {
        let key = sweep.plan.axes[axis].name().to_owned();
        let value = said(&key, &point.values[axis]);
        (key, value)
    }));
    common
}

/// A value with its unit, where it has one: `3 mm`.
pub fn said(key: &str, value: &Value) -> String {
    match value.number().filter(|_| LENGTHS.contains(&key)) {
        Some(metres) => format!("{} mm", number(1e3 * metres)),
        None => value.to_string(),
    }
}

/// What a picture of these points shows.
pub fn titled(sweep: &Sweep, common: &Common) -> String {
    let mut parts: Vec<String> = common
        .iter()
        .map(|(key, value)| format!("{key} {value}"))
        .collect();
    if let [design] = &sweep.plan.designs[..] {
        parts.insert(0, design.name.clone());
    }
    let keys = variables(sweep);
    let keys: Vec<&str> = keys
        .iter()
        .map(|number| sweep.plan.axes[number.axis].name())
        .collect();
    let over = format!("over {}", keys.join(" and "));
    if parts.is_empty() {
        over
    } else {
        format!("{}: {over}", parts.join(", "))
    }
}

/// What tells a point from others but the varied numbers.
pub fn series_name(sweep: &Sweep, point: &Point) -> String {
    let numbers = variables(sweep);
    let fixed = (0..sweep.plan.axes.len()).filter(|axis| {
        let several = sweep.plan.axes[*axis].values.len() > 1;
        several && numbers.iter().all(|number| number.axis != *axis)
    });
    let common = common(sweep, point, &fixed.collect::<Vec<_>>());
    let parts = common.into_iter().map(|(_, value)| value);
    parts.collect::<Vec<_>>().join(", ")
}

/// The stem of a picture's file.
pub fn file(kind: &str, common: &Common) -> String {
    let mut stem = kind.to_owned();
    for (_, value) in common {
        let plain = |c: char| {
            if c.is_alphanumeric() || c == '.' {
                c
            } else {
                '-'
            }
        };
        stem.push('-');
        stem.extend(value.chars().map(plain));
    }
    stem
}
