//! Designs side by side: tables for the terminal, CSV, JSON and Markdown.

use std::fmt::Write;
use std::iter::once;

use serde_json::{Map, Value, json};

use super::assessments::{capture_settings, cells, columns, merge, quantities};
use super::csv::table;
use super::figures::{WHY_NOT_HEAD_ON, cell, heading, misses_head_on};
use super::json;
use super::markdown::{markdown_table, without_html};
use super::terminal::write_folded;
use jobs::comparison::quantity::{CERTIFIED, NOT_HEAD_ON, QUANTITIES, placed};
use jobs::comparison::{Assessment, AssessmentSettings, Quantity, capture_range, ranking};
use physics::landscape::certificate::Ordering;

/// Designs in the order of a ranking.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Best first.
    pub designs: Vec<Assessment>,
    /// What designs are ranked by.
    pub by: &'static Quantity,
    /// How they were assessed.
    pub settings: AssessmentSettings,
}

impl Comparison {
    /// Designs ranked by a figure.
    pub fn new(
        designs: &[Assessment],
        by: &'static Quantity,
        settings: AssessmentSettings,
    ) -> Self {
        let order = ranking::ranked_for_use(designs, by);
        Self {
            designs: order.into_iter().map(|i| designs[i].clone()).collect(),
            by,
            settings,
        }
    }

    /// The tables and the proved order, for the terminal.
    pub fn summary(&self, columns: Option<usize>) -> String {
        let mut out = format!("{}\n", self.headline());
        for table in self.tables() {
            write_folded(&mut out, &table, columns);
            out.push('\n');
        }
        for line in self.obstacles() {
            let _ = writeln!(out, "{line}");
        }
        for line in self.orders() {
            let _ = writeln!(out, "{line}");
        }
        if self.designs.iter().any(has_estimates) {
            let _ = writeln!(out, "({ESTIMATES})");
        }
        let _ = writeln!(out, "(unlisted: {UNLISTED})");
        if self.designs.iter().any(misses_head_on) {
            let _ = writeln!(out, "({NOT_HEAD_ON}: {WHY_NOT_HEAD_ON})");
        }
        out + &checked(self.designs.iter())
    }

    /// The same for people, as Markdown.
    pub fn markdown(&self) -> String {
        let mut out = format!("# Designs ranked by {}\n", self.by.label);
        for table in self.tables() {
            out.push('\n');
            out += &markdown_table(&table);
        }
        out.push('\n');
        for line in self.obstacles().into_iter().chain(self.orders()) {
            let _ = writeln!(out, "- {}", without_html(&line));
        }
        let _ = writeln!(out, "\n{}", self.note());
        out
    }

    /// The sentence that answers: which design is best, and of how many.
    fn headline(&self) -> String {
        let docking = self
            .designs
            .iter()
            .filter(|one| one.obstacle().is_none())
            .count();
        let of = match self.designs.len() {
            1 => "1 design".to_owned(),
            many => format!("{many} designs"),
        };
        match self.designs.first() {
            Some(best) if docking > 0 => format!(
                "{of}, ranked by {}: {} is first with {}",
                self.by.label,
                self.name(best),
                cell(&[self.by], best)
            ),
            _ => format!(
                "{of}, ranked by {}: none finds into its bond",
                self.by.label
            ),
        }
    }

    /// Why designs stand last, a line for each.
    fn obstacles(&self) -> Vec<String> {
        let told = |one: &Assessment| {
            let (_, why) = one.obstacle()?;
            Some(format!(
                "{} stands behind those that dock: {why}",
                self.name(one)
            ))
        };
        self.designs.iter().filter_map(told).collect()
    }

    /// What the tables' figures mean.
    pub fn note(&self) -> String {
        let mut note = format!(
            "Brackets hold certified bounds; percentages are of {} far starts, with 95 % \
             intervals. The capture range is how far off a tile that touches head-on may be slid, \
             drawn back or tilted and still run downhill into the bond, to within {} % of its \
             depth.",
            self.settings.far_starts,
            100.0 * capture_range::ENERGY_SHARE,
        );
        let _ = write!(note, " \u{201c}Unlisted\u{201d}: {UNLISTED}.");
        if self.designs.iter().any(has_estimates) {
            let _ = write!(note, " (The {ESTIMATES}.)");
        }
        for line in self.obstacles() {
            let _ = write!(note, " {line}.");
        }
        if self.designs.iter().any(misses_head_on) {
            let _ = write!(note, " \u{201c}{NOT_HEAD_ON}\u{201d}: {WHY_NOT_HEAD_ON}.");
        }
        note
    }

    /// Row by row, the first one the head.
    fn tables(&self) -> Vec<Vec<Vec<String>>> {
        let names = self.designs.iter().map(|design| vec![self.name(design)]);
        let names: Vec<_> = once(vec!["design".to_owned()]).chain(names).collect();
        let mut tables = Vec::new();
        for (place, of) in placed(|quantity| quantity.column) {
            let number = usize::from(place.row);
            tables.resize(tables.len().max(number + 1), names.clone());
            let cells = self.designs.iter().map(|design| cell(&of, design));
            let column = once(heading(place.heading, of[0].measure)).chain(cells);
            for (row, cell) in tables[number].iter_mut().zip(column) {
                row.push(cell);
            }
        }
        tables
    }

    /// A design's name, with the model where models differ.
    pub fn name(&self, design: &Assessment) -> String {
        let models = |d: &Assessment| d.model != self.designs[0].model;
        if self.designs.iter().any(models) {
            format!("{} ({})", design.name, design.model)
        } else {
            design.name.clone()
        }
    }

    /// A line for each figure whose order may be proved, from the highest to the lowest.
    fn orders(&self) -> Vec<String> {
        let mut lines: Vec<String> = self
            .certified_orders()
            .into_iter()
            .map(|(figure, order)| format!("certified order of the {figure}: {order}"))
            .collect();
        if !lines.is_empty() {
            lines.push("(> proved for the stated model, ~ undecided: bounds overlap)".to_owned());
        }
        lines
    }

    /// Figures with bounds, and the designs from the highest to the lowest: `a > b ~ c`.
    pub fn certified_orders(&self) -> Vec<(&'static str, String)> {
        let mut orders = Vec::new();
        for (heading, quantity) in ordered() {
            let order = ranking::ranked(&self.designs, quantity);
            let known: Vec<&Assessment> = order
                .into_iter()
                .map(|i| &self.designs[i])
                .filter(|design| quantity.of(design).is_some_and(|e| e.low.is_some()))
                .collect();
            if known.len() < 2 {
                continue;
            }
            let mut line = self.name(known[0]);
            for pair in known.windows(2) {
                let sign = match ranking::order(pair[0], pair[1], quantity) {
                    Ordering::Higher => ">",
                    Ordering::Lower | Ordering::Undecided => "~",
                };
                let _ = write!(line, " {sign} {}", self.name(pair[1]));
            }
            orders.push((heading, line));
        }
        orders
    }

    /// One line a design, best first.
    pub fn csv(&self) -> String {
        let mut head = ["rank", "name", "model"].map(str::to_owned).to_vec();
        head.extend(columns());
        let rows = self.designs.iter().zip(1..).map(|(design, rank)| {
            let first = [rank.to_string(), design.name.clone(), design.model.clone()];
            [first.to_vec(), cells(design)].concat()
        });
        table(head, rows)
    }

    /// Everything, with what reproduces it.
    pub fn json(&self) -> String {
        let designs: Vec<Value> = self
            .designs
            .iter()
            .enumerate()
            .map(|(k, design)| {
                let mut entry = json!({"rank": k + 1});
                merge(&mut entry, json!(design));
                merge(&mut entry, json!({"quantities": quantities(design)}));
                entry
            })
            .collect();
        json::text(&json!({
            "tilebind": env!("CARGO_PKG_VERSION"),
            "ranked_by": self.by.key,
            "settings": self.settings,
            "capture_range": capture_settings(),
            "designs": designs,
            "certified_order": self.proved(),
        }))
    }

    /// For each figure the pairs of designs whose order is proved, by their places in the ranking.
    fn proved(&self) -> Value {
        let mut all = Map::new();
        for (_, quantity) in ordered() {
            let mut pairs = Vec::new();
            for (i, a) in self.designs.iter().enumerate() {
                for (j, b) in self.designs.iter().enumerate() {
                    if ranking::order(a, b, quantity) == Ordering::Higher {
                        pairs.push(json!({
                            "higher": a.name, "higher_rank": i + 1,
                            "lower": b.name, "lower_rank": j + 1,
                        }));
                    }
                }
            }
            all.insert(quantity.key.to_owned(), Value::Array(pairs));
        }
        Value::Object(all)
    }
}

/// What is proved of traps that were not found.
const UNLISTED: &str = "proved that no state deeper than this, and harder to leave than 0.5 % of the \
                        bond, was missed";
/// What barriers are of which nothing is proved.
const ESTIMATES: &str = "barriers without brackets are estimates of a roadmap: too high where \
                         it misses a passage";

/// Whether nothing is proved of a barrier that is shown.
fn has_estimates(design: &Assessment) -> bool {
    let is_estimate = |quantity: &&Quantity| {
        let estimate = quantity.of(design);
        quantity.bounds == CERTIFIED
            && estimate.is_some_and(|e| e.low.is_none() && e.value.is_finite())
    };
    QUANTITIES.iter().any(|quantity| is_estimate(&quantity))
}

/// A line on what moving tiles say of all barriers that they checked; empty where they were not
/// asked.
pub fn checked<'a>(designs: impl Iterator<Item = &'a Assessment>) -> String {
    let sums = designs
        .filter_map(Assessment::checks)
        .reduce(|sums, checks| std::array::from_fn(|k| sums[k] + checks[k]));
    sums.map_or_else(String::new, |[checked, contradicted, high]| {
        format!(
            "moving tiles checked {checked} barriers: {contradicted} contradicted, {high} estimated \
             too high\n"
        )
    })
}

/// The quantities whose order may be proved, with their headings in the tables.
fn ordered() -> impl Iterator<Item = (&'static str, &'static Quantity)> {
    let certified = |quantity: &Quantity| quantity.column.filter(|_| quantity.bounds == CERTIFIED);
    let places = placed(certified).into_iter();
    places.flat_map(|(place, shared)| shared.into_iter().map(move |one| (place.heading, one)))
}
