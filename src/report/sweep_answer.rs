//! What a sweep answers: one sentence, and a table of its points.

use super::figures::cell;
use super::summary::write_folded;
use super::sweep::Sweep;
use crate::comparison::quantity::QUANTITIES;
use crate::comparison::{Assessment, Quantity};

/// Points that the table lists; of more, the first ones.
const LISTED: usize = 12;
/// What the table says of each point.
const COLUMNS: [&str; 5] = [
    "bond_depth",
    "trap_depth",
    "selectivity",
    "unbinding",
    "captured",
];

fn quantity(key: &str) -> &'static Quantity {
    let found = QUANTITIES.iter().find(|quantity| quantity.key == key);
    found.unwrap_or(&QUANTITIES[0])
}

impl Sweep<'_> {
    /// The sentence that answers: the best point by selectivity (by the bond's depth where there
    /// are no traps), the least, and the first for comparison; empty where nothing was assessed.
    pub fn answer(&self) -> String {
        let done = self.done();
        let has = |key: &str| done.iter().any(|(_, one)| quantity(key).of(one).is_some());
        let by = quantity(if has("selectivity") {
            "selectivity"
        } else {
            "bond_depth"
        });
        let mut ranked: Vec<(usize, &Assessment)> = done.clone();
        let value = |one: &Assessment| by.of(one).map_or(f64::NEG_INFINITY, |e| e.value);
        let degree = |one: &Assessment| one.obstacle().map_or(0, |(degree, _)| degree);
        ranked.sort_by(|(_, a), (_, b)| {
            degree(a)
                .cmp(&degree(b))
                .then(value(b).total_cmp(&value(a)))
        });
        let (Some(&best), Some(&least), Some(&first)) =
            (ranked.first(), ranked.last(), done.first())
        else {
            return String::new();
        };
        let told = |(index, one): (usize, &Assessment)| {
            let called = self.called(&self.points[index]);
            let called = if called.is_empty() {
                one.name.clone()
            } else {
                called
            };
            let captured = cell(&[quantity("captured")], one);
            format!(
                "{called}: {} {}, captures {captured}",
                by.label,
                cell(&[by], one)
            )
        };
        if best.1.obstacle().is_some() {
            return format!("no point finds into its bond; {}\n", told(best));
        }
        let mut sentence = format!("best {}", told(best));
        let (high, base) = (value(best.1), value(first.1));
        if best.0 != first.0 && base > 0.0 && high.is_finite() {
            sentence += &format!(", {:.1} x the first point", high / base);
        }
        if least.0 != best.0 {
            sentence += &format!("; last {}", told(least));
            if let Some((_, why)) = least.1.obstacle() {
                sentence += &format!(" ({why})");
            }
        }
        sentence + "\n"
    }

    /// The points with their figures, in the order of the sweep; of many, the first ones.
    pub(super) fn table(&self, columns: Option<usize>) -> String {
        let done = self.done();
        let head = std::iter::once("point").chain(COLUMNS.map(|key| quantity(key).label));
        let mut rows = vec![head.map(str::to_owned).collect::<Vec<_>>()];
        rows.extend(done.iter().take(LISTED).map(|(index, one)| {
            let called = self.called(&self.points[*index]);
            let called = if called.is_empty() {
                one.name.clone()
            } else {
                called
            };
            let figures = COLUMNS.map(|key| cell(&[quantity(key)], one));
            std::iter::once(called).chain(figures).collect()
        }));
        let mut text = String::new();
        if done.is_empty() {
            return text;
        }
        write_folded(&mut text, &rows, columns);
        if done.len() > LISTED {
            text += &format!("and {} more points, see sweep.csv\n", done.len() - LISTED);
        }
        text
    }

    /// The points that were assessed, with their places.
    fn done(&self) -> Vec<(usize, &Assessment)> {
        let places = 0..self.outcomes.len();
        places
            .filter_map(|index| Some((index, self.assessment(index)?)))
            .collect()
    }
}
