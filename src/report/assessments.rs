//! Assessments in files: JSON, and rows of tables.

use std::iter::once;

use serde_json::{Value, json};

use super::csv::number;
use jobs::comparison::quantity::QUANTITIES;
use jobs::comparison::{Assessment, Quantity, capture_range};

/// Columns of what moving tiles say of the barriers: how many they checked, contradict, and show to
/// be estimated too high.
const CHECKED: [&str; 3] = [
    "barriers_checked",
    "barriers_contradicted",
    "barriers_overestimated",
];

/// What a capture range depends on.
pub fn capture_settings() -> Value {
    json!({
        "steps": capture_range::STEPS,
        "halvings": capture_range::HALVINGS,
        "same_bond_m": capture_range::SAME_BOND,
        "energy_share": capture_range::ENERGY_SHARE,
    })
}

/// Adds the keys of one object to another.
pub fn merge(object: &mut Value, more: Value) {
    if let (Value::Object(object), Value::Object(more)) = (object, more) {
        object.extend(more);
    }
}

/// The figures of a design as JSON: a number, or an object with its bounds.
pub fn quantities(design: &Assessment) -> Value {
    let entry = |quantity: &Quantity| {
        let [value, low, high] = finite(quantity, design);
        let entry = match quantity.bounds {
            Some([below, above]) => json!({"value": value, below: low, above: high}),
            None => json!(value),
        };
        (quantity.name(""), entry)
    };
    QUANTITIES.iter().map(entry).collect()
}

/// A figure and its bounds, `None` for what is not known or not finite.
fn finite(quantity: &Quantity, design: &Assessment) -> [Option<f64>; 3] {
    let estimate = quantity.of(design);
    estimate.map_or([None; 3], |estimate| estimate.finite())
}

/// Columns of a table of assessments.
pub fn columns() -> Vec<String> {
    let mut columns = Vec::new();
    for quantity in QUANTITIES {
        columns.push(quantity.name(""));
        let bounds = quantity.bounds.into_iter().flatten();
        columns.extend(bounds.map(|bound| quantity.name(&format!("_{bound}"))));
    }
    columns.extend(["caged", "target_energy_J", "seed", "sha256"].map(str::to_owned));
    columns.extend(CHECKED.map(str::to_owned));
    columns
}

/// The cells of [`columns`]; empty where there is nothing to say, or no way at all.
pub fn cells(design: &Assessment) -> Vec<String> {
    let mut cells = Vec::new();
    for quantity in QUANTITIES {
        let [value, bounds @ ..] = finite(quantity, design);
        let bounds = quantity.bounds.map(|_| bounds);
        let numbers = once(value).chain(bounds.into_iter().flatten());
        cells.extend(numbers.map(|value| value.map(number).unwrap_or_default()));
    }
    let caged = design.bond.as_ref().is_some_and(|b| b.way_out.bounds.caged);
    cells.extend([
        caged.to_string(),
        number(design.target_energy),
        design.seed.to_string(),
        design.sha256.clone(),
    ]);
    let counts = design.checks();
    let counts = counts.map(|checks| checks.map(|count| count.to_string()));
    cells.extend(counts.unwrap_or_else(|| CHECKED.map(|_| String::new())));
    cells
}
