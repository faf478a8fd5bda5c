//! What a sweep answers: one sentence, and a table of its points.

use super::figures::cell;
use super::sweep::Sweep;
use super::terminal::write_folded;
use jobs::comparison::quantity::QUANTITIES;
use jobs::comparison::{Assessment, Quantity};
use physics::order::Order;

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
    /// What the points are ranked by: selectivity, or the bond's depth where there are no traps.
    fn by(&self) -> &'static Quantity {
        let selectivity = quantity("selectivity");
        let mut done = self.done().into_iter();
        match done.any(|(_, one)| selectivity.of(one).is_some()) {
            true => selectivity,
            false => quantity("bond_depth"),
        }
    }

    /// The sentence that answers: the best point, the least, and how much better the best is than
    /// the one that all are set against, or the first; empty where nothing was assessed.
    pub fn answer(&self) -> String {
        let done = self.done();
        let by = self.by();
        let mut ranked: Vec<(usize, &Assessment)> = done.clone();
        let value = |one: &Assessment| by.of(one).map_or(f64::NEG_INFINITY, |e| e.value);
        let degree = |one: &Assessment| one.obstacle().map_or(0, |(degree, _)| degree);
        ranked.order_by(|(_, a), (_, b)| {
            degree(a)
                .cmp(&degree(b))
                .then(value(b).total_cmp(&value(a)))
        });
        let (Some(&best), Some(&least)) = (ranked.first(), ranked.last()) else {
            return String::new();
        };
        let base = self.baseline();
        let is_base = |(index, _): &&(usize, &Assessment)| base.is_none_or(|base| base == *index);
        let base = done.iter().find(is_base).copied().unwrap_or(best);
        let told = |(index, one): (usize, &Assessment)| {
            let called = self.called(&self.points[index]);
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
        let ratio = value(best.1) / value(base.1);
        if best.0 != base.0 && ratio.is_finite() && value(base.1) > 0.0 {
            sentence += &format!(", {ratio:.1} x {}", self.called(&self.points[base.0]));
        }
        if self.baseline().is_some() && ![best.0, least.0].contains(&base.0) {
            sentence += &format!("; {}", told(base));
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
            let figures = COLUMNS.map(|key| cell(&[quantity(key)], one));
            std::iter::once(called).chain(figures).collect()
        }));
        let by = self.by();
        let base = self.baseline().and_then(|index| {
            let value = by.of(self.assessment(index)?)?.value;
            Some((index, value)).filter(|_| value > 0.0)
        });
        if let Some((index, base)) = base {
            // How much better, beside what it is.
            let place = COLUMNS.iter().position(|key| *key == by.key);
            let place = place.map_or(1, |place| place + 2);
            rows[0].insert(place, format!("x {}", self.called(&self.points[index])));
            for (row, (_, one)) in rows[1..].iter_mut().zip(&done) {
                let ratio = by.of(one).map(|own| own.value / base);
                let ratio = ratio.filter(|ratio| ratio.is_finite());
                row.insert(place, ratio.map_or("-".to_owned(), |x| format!("{x:.2}")));
            }
        }
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
