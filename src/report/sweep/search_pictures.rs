//! The pictures of a search: its course, and the front of two objectives.

use super::searched::Searched;
use crate::plots::Drawing;
use crate::plots::chart::{Chart, ChartPoint, Dimension, Look};
use jobs::comparison::Quantity;
use jobs::comparison::quantity::Measure;
use jobs::search::{FigureBounds, Objective, Verdict};
use jobs::sweep::Outcome;

/// The pictures.
pub fn drawings(searched: &Searched) -> Vec<Drawing<'static>> {
    let objectives = &searched.search.aim.objectives;
    let courses = objectives.iter().enumerate();
    let mut charts: Vec<Chart> = Vec::new();
    if let [one, other] = &objectives[..] {
        charts.push(front(searched, one, other));
    }
    charts.extend(courses.map(|(k, one)| course(searched, k, one)));
    charts.into_iter().map(Drawing::from).collect()
}

/// The axis of a figure.
fn dimension(quantity: &Quantity) -> Dimension {
    let key = match quantity.measure {
        Measure::Share => return Dimension::share("figure", quantity.label),
        Measure::Energy => "figure_J",
        Measure::Length => "figure_m",
        Measure::Angle => "figure_rad",
        // Selectivities span powers of ten.
        Measure::Ratio => return Dimension::new("figure", quantity.label).logarithmic(),
        Measure::Count => "figure",
    };
    Dimension::new(key, quantity.label)
}

fn figure(searched: &Searched, quantity: &Quantity, index: usize) -> Option<FigureBounds> {
    match searched.found.tried[index].known() {
        Outcome::Done { result } => FigureBounds::of(quantity, result).ok(),
        Outcome::Impossible { .. } | Outcome::Failed { .. } => None,
    }
}

/// Bounds that are known and apart.
fn ends(interval: &FigureBounds) -> Option<[f64; 2]> {
    let ends = [interval.low, interval.high];
    let are_drawn = ends.iter().all(|end| end.is_finite()) && interval.low < interval.high;
    are_drawn.then_some(ends)
}

/// An objective in the order of the points.
fn course(searched: &Searched, number: usize, objective: &Objective) -> Chart {
    let quantity = objective.quantity();
    let all = || {
        (0..searched.found.tried.len()).filter_map(|k| Some((k, figure(searched, quantity, k)?)))
    };
    let is_fit = |k: usize| searched.standings[k].gains().is_some();
    let is_proved = |k: usize| searched.found.tried[k].proved.is_some();
    let point = |(k, it): (usize, FigureBounds)| ChartPoint {
        x: (k + 1) as f64,
        y: it.value,
        ends: ends(&it),
    };
    let fit = all()
        .filter(|(k, _)| is_fit(*k) && !is_proved(*k))
        .map(point);
    let unfit = all().filter(|(k, _)| !is_fit(*k)).map(point);
    let proved = all()
        .filter(|(k, _)| is_fit(*k) && is_proved(*k))
        .map(point);
    let sign = if objective.largest { 1.0 } else { -1.0 };
    let mut best = f64::NEG_INFINITY;
    let mut steps: Vec<[f64; 2]> = Vec::new();
    for (k, it) in all().filter(|(k, it)| is_fit(*k) && it.value.is_finite()) {
        let x = (k + 1) as f64;
        if sign * it.value > best {
            if !steps.is_empty() {
                steps.push([x, sign * best]);
            }
            best = sign * it.value;
        }
        steps.push([x, sign * best]);
    }
    Chart::new(
        ["history", "history-2"][number.min(1)],
        format!("{objective}: the course of the search"),
        Dimension::new("point", "point"),
        dimension(quantity),
    )
    .remarked("bars: certified bounds, 95 % intervals; ^ infinite")
    .with("the best so far", Look::Steps, steps)
    .with("without proofs", Look::Dots, fit)
    .with("with proofs", Look::Dots, proved)
    .with("a condition does not hold", Look::Rings, unfit)
}

/// The points by two objectives.
fn front(searched: &Searched, one: &Objective, other: &Objective) -> Chart {
    let places = |verdict: &dyn Fn(usize) -> bool| {
        let tried = 0..searched.found.tried.len();
        let places = tried.filter(|&k| verdict(k)).filter_map(|k| {
            let [x, y] = [one, other].map(|it| figure(searched, it.quantity(), k));
            let place = [x?.value, y?.value];
            place.iter().all(|value| value.is_finite()).then_some(place)
        });
        let mut places: Vec<[f64; 2]> = places.collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        places
    };
    let is_best = |k: usize| searched.verdicts[k] == Verdict::Best;
    let is_fit = |k: usize| searched.standings[k].gains().is_some();
    Chart::new(
        "front",
        format!("{one} and {other}: the front"),
        dimension(one.quantity()),
        dimension(other.quantity()),
    )
    .remarked("^ infinite")
    .with("front", Look::Line, places(&is_best))
    .with(
        "surpassed",
        Look::Dots,
        places(&|k| is_fit(k) && !is_best(k)),
    )
    .with(
        "a condition does not hold",
        Look::Rings,
        places(&|k| !is_fit(k)),
    )
}
