//! The columns of assessed designs.

use serde_json::{Value, json};

use crate::columns::Rows;
use crate::figures::{Shown, cell_in};
use jobs::comparison::quantity::{Measure, QUANTITIES, placed};
use jobs::comparison::{Assessment, Quantity, capture_range};

/// The parameters of a capture range.
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
        let [value, low, high] = finite(quantity, Some(design));
        let entry = match quantity.bounds {
            Some([below, above]) => json!({"value": value, below: low, above: high}),
            None => json!(value),
        };
        (quantity.name(""), entry)
    };
    let known = QUANTITIES
        .iter()
        .filter(|it| !it.is_left_out([design].into_iter()));
    known.map(entry).collect()
}

/// A figure and its bounds, `None` if not known or not finite.
fn finite(quantity: &Quantity, design: Option<&Assessment>) -> [Option<f64>; 3] {
    let estimate = design.and_then(|design| quantity.of(design));
    estimate.map_or([None; 3], |estimate| estimate.finite())
}

/// Adds all figures of designs for programs, each with its bounds; cells without a design are
/// empty.
pub fn numbers<'a, Row>(
    mut rows: Rows<'a, Row>,
    of: impl Fn(&Row) -> Option<&'a Assessment> + Copy + 'a,
) -> Rows<'a, Row> {
    for quantity in QUANTITIES {
        if quantity.is_left_out(rows.rows().iter().filter_map(of)) {
            continue;
        }
        let bounds = quantity.bounds.into_iter().flatten();
        let parts = [String::new()].into_iter();
        let parts = parts.chain(bounds.map(|bound| format!("_{bound}")));
        for (k, part) in parts.enumerate() {
            let key = quantity.name(&part);
            rows = rows.data(key, move |row| finite(quantity, of(row))[k]);
        }
    }
    let checks = |k: usize| move |row: &Row| Some(of(row)?.checks()?[k]);
    rows.data("caged", move |row| Some(of(row)?.is_caged()))
        .data("target_energy_J", move |row| Some(of(row)?.target_energy))
        .data("seed", move |row| Some(of(row)?.seed))
        .data("sha256", move |row| Some(of(row)?.sha256.clone()))
        // The check of the barriers by moving tiles.
        .data("barriers_checked", checks(0))
        .data("barriers_contradicted", checks(1))
        .data("barriers_overestimated", checks(2))
}

/// Adds a figure of designs for people, or two that share a place, with bounds or a word that says
/// why there is none.
pub fn view<'a, Row>(
    rows: Rows<'a, Row>,
    name: &str,
    of_place: Vec<&'static Quantity>,
    of: impl Fn(&Row) -> Option<&'a Assessment> + Copy + 'a,
) -> Rows<'a, Row> {
    let first = of_place[0];
    if first.is_left_out(rows.rows().iter().filter_map(of)) {
        return rows;
    }
    let known = rows.rows().iter().filter_map(|row| first.of(of(row)?));
    // Proved absences have no size.
    let told = known.filter(|it| it.value.is_finite() && it.high.is_none_or(|high| high > 0.0));
    let most = told.map(|it| it.value.abs()).fold(0.0, f64::max);
    let shown = Shown::new(first.measure, most);
    let name = match (first.measure, most) {
        // Their cells contain the sign.
        (Measure::Share, _) | (_, 0.0) => name.to_owned(),
        _ => shown.named(name),
    };
    // A barrier that cannot be crossed ranks above every number.
    let value = move |row: &Row| Some(first.of(of(row)?)?.value.min(f64::MAX));
    let unit = Some(shown.unit);
    let describe =
        move |row: &Row| of(row).map_or("-".to_owned(), |one| cell_in(&of_place, one, unit));
    rows.shown(name, first.label, value).viewed(describe)
}

/// Adds the figures of one of the tables of designs, by its number.
pub fn views<'a, Row>(
    mut rows: Rows<'a, Row>,
    table: u8,
    of: impl Fn(&Row) -> Option<&'a Assessment> + Copy + 'a,
) -> Rows<'a, Row> {
    for (place, of_place) in placed(|quantity| quantity.column) {
        if place.row == table {
            rows = view(rows, place.heading, of_place, of);
        }
    }
    rows
}

/// The number of tables of figures.
pub fn tables() -> u8 {
    let rows = QUANTITIES.iter().filter_map(|quantity| quantity.column);
    rows.map(|place| place.row + 1).max().unwrap_or(0)
}

/// A line on the check of all barriers by moving tiles; `None` without the check.
pub fn checked<'a>(designs: impl Iterator<Item = &'a Assessment>) -> Option<String> {
    let sums = designs
        .filter_map(Assessment::checks)
        .reduce(|sums, checks| std::array::from_fn(|k| sums[k] + checks[k]));
    let [checked, contradicted, high] = sums?;
    Some(format!(
        "simulated tiles checked {checked} barriers: {contradicted} contradicted, {high} \
         estimated too high"
    ))
}
