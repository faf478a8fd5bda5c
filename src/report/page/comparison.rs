//! The pages of `compare` and `sweep`.

use serde_json::{Value, json};

use super::charts::Charts;
use super::{Column, Fact, Illustration, Page, Table};
use crate::comparison::Comparison;
use crate::figures::{cell, heading};
use crate::sweep::{Sweep, counts};
use jobs::comparison::quantity::QUANTITIES;
use jobs::comparison::ranking::ranked;
use jobs::comparison::{Assessment, Quantity};

/// What ranks above every number: a barrier that nothing crosses.
const BEYOND: f64 = 1e300;

impl Page {
    /// The page of designs side by side; `ranking` is the picture, as SVG.
    pub fn of_comparison(comparison: &Comparison, ranking: String) -> Self {
        let by = comparison.by.label;
        let mut facts: Vec<Fact> = Vec::new();
        let best = QUANTITIES.iter().filter(|quantity| quantity.most.is_some());
        for quantity in std::iter::once(comparison.by).chain(best) {
            let highest = || format!("highest {}", quantity.label);
            let name = quantity.most.map_or_else(highest, str::to_owned);
            if facts.iter().all(|fact| fact.name != name) {
                facts.extend(first(comparison, quantity, name));
            }
        }
        let mut columns = vec![Column::new("rank", ""), Column::new("design", "")];
        columns.extend(figure_columns());
        let designs = comparison.designs.iter().enumerate();
        let rows = designs
            .map(|(k, design)| {
                let mut row = vec![json!(k + 1), json!(comparison.name(design))];
                row.extend(figures(design));
                row
            })
            .collect();
        let orders = comparison.certified_orders();
        let mut tables = vec![Table {
            title: "Designs".to_owned(),
            note: comparison.note(),
            columns,
            rows,
            states: Vec::new(),
            paths: Vec::new(),
        }];
        if !orders.is_empty() {
            tables.push(Table {
                title: "Certified order".to_owned(),
                note: "From the highest to the lowest: > is proved for the stated model, ~ is \
                       undecided, as the bounds overlap."
                    .to_owned(),
                columns: vec![Column::new("figure", ""), Column::new("order", "")],
                rows: orders
                    .into_iter()
                    .map(|(figure, order)| vec![json!(figure), json!(order)])
                    .collect(),
                states: Vec::new(),
                paths: Vec::new(),
            });
        }
        let seeds: Vec<u64> = comparison.designs.iter().map(|d| d.seed).collect();
        Self {
            subtitle: format!("ranked by {by}"),
            facts,
            pictures: vec![Illustration {
                is_titled: false,
                title: format!("Ranked by {by}"),
                svg: ranking,
            }],
            tables,
            origin: format!(
                "tilebind {}, seed {}; compare.json holds what reproduces it",
                env!("CARGO_PKG_VERSION"),
                seeds.first().copied().unwrap_or_default()
            ),
            ..Self::titled(format!("{} designs side by side", comparison.designs.len()))
        }
    }

    /// The page of a finished sweep.
    pub fn of_sweep(sweep: &Sweep) -> Self {
        let plan = sweep.plan;
        let several = plan.designs.len() > 1;
        let mut columns = Vec::new();
        if several {
            columns.push(Column::new("design", ""));
        }
        columns.extend(plan.axes.iter().map(|axis| Column::new(&axis.key, "")));
        columns.extend(figure_columns());
        columns.push(Column::new("impossible", ""));
        let rows = sweep
            .points
            .iter()
            .map(|point| {
                let mut row = Vec::new();
                if several {
                    row.push(json!(plan.designs[point.design].name));
                }
                row.extend(point.values.iter().map(|value| json!(value)));
                match sweep.assessment(point.index) {
                    Some(design) => row.extend(figures(design)),
                    None => row.extend(QUANTITIES.iter().map(|_| Value::Null)),
                }
                row.push(json!(sweep.reason(point.index)));
                row
            })
            .collect();
        let names: Vec<&str> = plan.designs.iter().map(|d| d.name.as_str()).collect();
        let keys: Vec<&str> = plan.axes.iter().map(|axis| axis.key.as_str()).collect();
        Self {
            subtitle: format!("over {}", keys.join(", ")),
            facts: vec![Fact {
                name: "points".to_owned(),
                value: sweep.points.len().to_string(),
                note: counts(&sweep.progress()),
            }],
            charts: Some(Charts::new(sweep)),
            tables: vec![Table {
                title: "Points".to_owned(),
                note: "Varied keys as the design file has them, in SI units; brackets hold \
                       certified bounds, percentages 95 % intervals."
                    .to_owned(),
                columns,
                rows,
                states: Vec::new(),
                paths: Vec::new(),
            }],
            origin: format!(
                "tilebind {}, seed {}; plan.json holds what reproduces it",
                plan.tilebind, plan.seed
            ),
            command: "tilebind sweep --run plan.json; tilebind sweep --merge plan.json".to_owned(),
            ..Self::titled(format!("{}: a sweep", names.join(", ")))
        }
    }
}

/// The design with the largest value of a figure.
fn first(comparison: &Comparison, quantity: &Quantity, name: String) -> Option<Fact> {
    let order = ranked(&comparison.designs, quantity);
    let design = &comparison.designs[*order.first()?];
    quantity.of(design)?;
    Some(Fact {
        name,
        value: comparison.name(design),
        note: cell(&[quantity], design),
    })
}

fn figure_columns() -> impl Iterator<Item = Column> {
    QUANTITIES
        .iter()
        .map(|quantity| Column::new(&heading(quantity.label, quantity.measure), ""))
}

/// The figures of a design, each as what it sorts by and what is shown.
fn figures(design: &Assessment) -> impl Iterator<Item = Value> {
    QUANTITIES.iter().map(|quantity| {
        let estimate = quantity.of(design);
        let value = estimate.map(|estimate| estimate.value.min(BEYOND));
        json!([value, cell(&[quantity], design)])
    })
}
