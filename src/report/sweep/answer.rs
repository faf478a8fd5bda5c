//! The answer of a sweep: one sentence, and a table of its points.

use crate::assessments::view;
use crate::document::{Table, rows};
use crate::figures::cell;
use crate::points::FinishedSweep;
use jobs::comparison::quantity::{QUANTITIES, placed};
use jobs::comparison::{Assessment, Quantity, ranking};
use jobs::sweep::SweepPoint;
use physics::order::Order;

/// Largest number of points in the table.
const LISTED: usize = 12;
/// The columns of the table.
const COLUMNS: [&str; 6] = [
    "bond_depth",
    "trap_depth",
    "selectivity",
    "unbinding",
    "captured",
    // Where errors of making are stated.
    "robust",
];

fn quantity(key: &str) -> &'static Quantity {
    let found = QUANTITIES.iter().find(|quantity| quantity.key == key);
    found.unwrap_or(&QUANTITIES[0])
}

impl FinishedSweep<'_> {
    /// The figure by which points are ranked: selectivity, or the bond's depth if there are no
    /// traps.
    fn by(&self) -> &'static Quantity {
        let selectivity = quantity("selectivity");
        let mut done = self.done().into_iter();
        match done.any(|(_, one)| selectivity.of(one).is_some()) {
            true => selectivity,
            false => quantity("bond_depth"),
        }
    }

    /// The headline: the best and the worst point, and how much better the best is than the
    /// baseline, or the first point; `None` if nothing was assessed.
    pub fn answer(&self) -> Option<String> {
        let done = self.done();
        let by = self.by();
        let mut ranked: Vec<(usize, &Assessment)> = done.clone();
        let value = |one: &Assessment| ranking::value(one, by);
        let degree = |one: &Assessment| one.obstacle().map_or(0, |(degree, _)| degree);
        ranked.order_by(|(_, a), (_, b)| {
            degree(a)
                .cmp(&degree(b))
                .then(value(b).total_cmp(&value(a)))
        });
        let (Some(&best), Some(&least)) = (ranked.first(), ranked.last()) else {
            return None;
        };
        let base = self.baseline();
        let is_base = |(index, _): &&(usize, &Assessment)| base.is_none_or(|base| base == *index);
        let base = done.iter().find(is_base).copied().unwrap_or(best);
        let describe = |(index, one): (usize, &Assessment)| {
            let called = self.called(&self.points[index]);
            let captured = cell(&[quantity("captured")], one);
            format!(
                "{called}: {} {}, captures {captured}",
                by.label,
                cell(&[by], one)
            )
        };
        if best.1.obstacle().is_some() {
            return Some(format!("no point reaches its bond; {}", describe(best)));
        }
        let is_best = |(_, one): &&(usize, &Assessment)| {
            degree(one) == 0 && value(one) >= (1.0 - 1e-6) * value(best.1)
        };
        let equal = ranked.iter().filter(is_best).count();
        let mut sentence = match equal {
            ..2 => format!("best {}", describe(best)),
            _ => format!(
                "best undecided between {equal} points, such as {}",
                describe(best)
            ),
        };
        let ratio = value(best.1) / value(base.1);
        if best.0 != base.0 && ratio.is_finite() && value(base.1) > 0.0 {
            sentence += &format!(", {ratio:.1} x {}", self.called(&self.points[base.0]));
        }
        if self.baseline().is_some() && ![best.0, least.0].contains(&base.0) {
            sentence += &format!("; {}", describe(base));
        }
        if least.0 != best.0 {
            sentence += &format!("; last {}", describe(least));
            if let Some((_, why)) = least.1.obstacle() {
                sentence += &format!(" ({why})");
            }
        }
        Some(sentence)
    }

    /// The points with their figures, in the order of the sweep.
    pub(super) fn listed<'a>(&'a self) -> Table {
        let by = self.by();
        let base = self.baseline().and_then(|index| {
            let value = by.of(self.assessment(index)?)?.value;
            Some((index, value)).filter(|_| value > 0.0)
        });
        let points = self.points.iter();
        let of = |(_, one): &(&SweepPoint, Option<&'a Assessment>)| *one;
        let mut table = rows(points.map(|point| (point, self.assessment(point.index)))).shown(
            "point",
            "",
            |(point, _)| self.called(point),
        );
        for key in COLUMNS {
            let shown = quantity(key);
            table = view(table, shown.label, vec![shown], of);
            if let Some((index, base)) = base.filter(|_| key == by.key) {
                // The improvement, after the value.
                let ratio = move |(_, one): &(_, Option<&Assessment>)| {
                    let value = by.of((*one)?)?.value / base;
                    value.is_finite().then_some(value)
                };
                table = table.shown(format!("x {}", self.called(&self.points[index])), "", ratio);
            }
        }
        for (place, of_place) in placed(|quantity| quantity.column) {
            if of_place.iter().all(|one| !COLUMNS.contains(&one.key)) {
                table = view(table, place.heading, of_place, of).on_page();
            }
        }
        table
            .shown("impossible", "", |(point, _)| {
                self.reason(point.index).map(str::to_owned)
            })
            .on_page()
            .table("")
            .in_view()
            .listing(LISTED)
    }

    /// The assessed points, with their indices.
    fn done(&self) -> Vec<(usize, &Assessment)> {
        let places = 0..self.outcomes.len();
        places
            .filter_map(|index| Some((index, self.assessment(index)?)))
            .collect()
    }
}
