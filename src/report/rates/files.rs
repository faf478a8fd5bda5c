//! The files of rates.

use serde_json::{Value, json};

use super::{AtKt, Table};
use crate::csv::{self, number};
use crate::files::{Files, PICTURES};
use crate::page::rate_charts;
use physics::kinetics::map::Map;

/// The answer as `report.json` has it.
pub fn report(table: &Table, over_kt: &[AtKt], seed: u64) -> Value {
    let mut report = table.entry();
    report["tilebind"] = json!(env!("CARGO_PKG_VERSION"));
    report["design"] = json!({"name": table.design.name, "sha256": table.design.sha256});
    report["model"] = json!(table.design.interaction.model.name());
    report["seed"] = json!(seed);
    let of = |rates: &[Option<f64>]| -> Value {
        let named = table.places.iter().zip(rates);
        named
            .map(|(place, rate)| (place.name.clone(), json!(rate)))
            .collect()
    };
    report["over_kT"] = over_kt
        .iter()
        .map(|at| {
            json!({
                "kT_J": at.kt,
                "leaving_per_s": of(&at.leaving),
                "corner_leaving_per_s": of(&at.corner),
            })
        })
        .collect();
    report
}

/// Tables and pictures, by their names.
pub fn files(table: &Table, over_kt: &[AtKt]) -> Files {
    let mut files = Files::from([
        ("rates.csv".to_owned(), table.rates_csv().into_bytes()),
        (
            "occupation.csv".to_owned(),
            table.occupation_csv().into_bytes(),
        ),
        (
            "over-kt.csv".to_owned(),
            courses(table, over_kt).into_bytes(),
        ),
    ]);
    if let Some(proved) = table.proved_csv() {
        files.insert("proved.csv".to_owned(), proved.into_bytes());
    }
    if let Some(map) = table.map() {
        files.insert("committor.csv".to_owned(), squares(map).into_bytes());
    }
    let pictures = rate_charts::all(table, over_kt).into_iter();
    files.extend(
        pictures.map(|(name, _, svg)| (format!("{PICTURES}/{name}.svg"), svg.into_bytes())),
    );
    files
}

/// Rates out of states over kT; empty where there are none.
fn courses(table: &Table, over_kt: &[AtKt]) -> String {
    let shown = |rate: Option<f64>| rate.map_or(String::new(), number);
    let rows = over_kt.iter().flat_map(|at| {
        table.places.iter().enumerate().map(move |(k, place)| {
            vec![
                number(at.kt),
                place.name.clone(),
                shown(at.leaving[k]),
                shown(at.corner[k]),
            ]
        })
    });
    csv::table(
        &["kT_J", "from", "leaving_per_s", "corner_leaving_per_s"],
        rows,
    )
}

/// The squares of a map that hold free configurations.
fn squares(map: &Map) -> String {
    let all = (0..map.committor.len()).filter(|&square| map.committor[square].is_finite());
    let rows = all.map(|square| {
        let ([x, y], [along_x, along_y]) = (map.middle(square), map.flux[square]);
        [x, y, map.committor[square], along_x, along_y]
            .map(number)
            .to_vec()
    });
    let head = ["x_m", "y_m", "committor", "flux_x_per_m", "flux_y_per_m"];
    csv::table(&head, rows)
}
