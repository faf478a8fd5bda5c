//! The charts of a yield: over time, over the number of tiles and the coverage, over kT.

use std::fmt::Write;

use super::word_charts::{AREA, chart, label};
use jobs::yields::{Outcome, Question, Yields};
use physics::order::Order;
use physics::units::{duration, si};

/// Okabe and Ito's colours, told apart by colour-blind readers, from dark to light.
const COLOURS: [&str; 6] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9",
];

/// Curves take this share of a plot's width; the rest is their key's.
const CURVES: f64 = 0.7;

/// The pictures: stem of the file, title, SVG.
pub fn all(question: &Question, found: &Yields) -> Vec<(&'static str, &'static str, String)> {
    let best = found.best();
    let mut all = vec![
        ("course", "Bound and trapped over time", course(best)),
        (
            "yield",
            "Bound over number of tiles and coverage",
            crowds(question, best),
        ),
    ];
    if found.outcomes.len() > 1 {
        all.push(("shaking", "Bound over kT", over_kt(found)));
    }
    all
}

/// A curve through points of the plot (shares of the curves' width and its height), and its line in
/// the key beside them, the k-th from the top.
fn curve(points: &[[f64; 2]], k: usize, name: &str) -> String {
    let [left, top, width, height] = AREA;
    let places = points.iter().filter(|p| p[1].is_finite());
    let places: Vec<String> = places
        .map(|[x, y]| {
            let x = left + CURVES * width * x;
            format!("{x:.1},{:.1}", top + height * (1.0 - y))
        })
        .collect();
    let style = format!(
        "fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"",
        COLOURS[k % COLOURS.len()],
        ["", "6 4", "2 3"][k % 3]
    );
    let (key, y) = (left + (CURVES + 0.03) * width, top + 10.0 + 18.0 * k as f64);
    format!(
        "<polyline points=\"{}\" {style}/><path d=\"M{key:.1},{y:.1}h24\" {style}/>{}",
        places.join(" "),
        label(key + 30.0, y + 4.0, "start", name)
    )
}

fn shares() -> String {
    let [left, top, _, height] = AREA;
    let tick = |k: i32| {
        let y = top + height * (1.0 - f64::from(k) / 4.0);
        label(left - 6.0, y + 4.0, "end", &format!("{} %", 25 * k))
    };
    (0..=4).map(tick).collect()
}

fn below(x: f64, text: &str) -> String {
    let [left, top, width, height] = AREA;
    label(
        left + CURVES * width * x,
        top + height + 18.0,
        "middle",
        text,
    )
}

/// Shares in the bond and in traps over the logarithm of time.
fn course(outcome: &Outcome) -> String {
    let times: Vec<f64> = outcome
        .course
        .iter()
        .map(|point| libm::log10(point[0]))
        .collect();
    let (first, last) = (times[0], times[times.len() - 1]);
    let x = |log: f64| (log - first) / (last - first);
    let line = |k: usize| -> Vec<[f64; 2]> {
        let points = outcome.course.iter().zip(&times);
        points.map(|(point, log)| [x(*log), point[k]]).collect()
    };
    let mut inner = shares();
    for power in first.ceil() as i32..=last.floor() as i32 {
        inner += &below(x(f64::from(power)), &si(10f64.powi(power), "s", 1));
    }
    inner += &curve(&line(1), 0, "in the bond");
    inner += &curve(&line(2), 1, "in traps");
    chart("time", "share of all pairs", &inner)
}

/// Share in the bond over the logarithm of the number of tiles, a curve for each coverage.
fn crowds(question: &Question, outcome: &Outcome) -> String {
    let mut tiles: Vec<usize> = outcome.table.iter().map(|row| row.0).collect();
    tiles.dedup();
    let mut coverages: Vec<f64> = outcome.table.iter().map(|row| row.1).collect();
    coverages.order_by(f64::total_cmp);
    coverages.dedup();
    let most = libm::log(*tiles.last().unwrap_or(&2) as f64 / 2.0).max(1e-9);
    let x = |tiles: usize| libm::log(tiles as f64 / 2.0) / most;
    let mut inner = shares();
    for count in &tiles {
        inner += &below(x(*count), &count.to_string());
    }
    for (k, coverage) in coverages.iter().enumerate() {
        let rows = outcome.table.iter().filter(|row| row.1 == *coverage);
        let points: Vec<[f64; 2]> = rows.map(|row| [x(row.0), row.2]).collect();
        let name = format!("{} % covered", (1e3 * coverage).round() / 10.0);
        inner += &curve(&points, k, &name);
    }
    let name = format!("tiles (after {})", duration(question.time, 3));
    chart(&name, "share of all pairs in the bond", &inner)
}

/// Share in the bond over kT, with its interval, and in traps.
fn over_kt(found: &Yields) -> String {
    let [left, top, width, height] = AREA;
    let mut by_kt: Vec<&Outcome> = found.outcomes.iter().collect();
    by_kt.order_by(|a, b| a.kt.total_cmp(&b.kt));
    let most = by_kt.iter().map(|outcome| outcome.kt).fold(0.0, f64::max);
    let x = |kt: f64| 0.02 + 0.93 * kt / most;
    let points = |of: &dyn Fn(&Outcome) -> f64| -> Vec<[f64; 2]> {
        by_kt
            .iter()
            .map(|outcome| [x(outcome.kt), of(outcome)])
            .collect()
    };
    let mut inner = shares();
    for outcome in &by_kt {
        inner += &below(x(outcome.kt), &si(outcome.kt, "J", 2));
        let [low, high] = outcome.interval.map(|share| top + height * (1.0 - share));
        let at = left + CURVES * width * x(outcome.kt);
        if low.is_finite() && high.is_finite() {
            let _ = write!(
                inner,
                "<path d=\"M{at:.1},{low:.1}V{high:.1}\" stroke=\"{}\" stroke-width=\"4\" \
                 opacity=\"0.4\"/>",
                COLOURS[0]
            );
        }
    }
    inner += &curve(&points(&|outcome| outcome.bound), 0, "in the bond");
    inner += &curve(&points(&|outcome| outcome.trapped), 1, "in traps");
    let equilibrium = points(&|outcome| outcome.equilibrium.unwrap_or(f64::NAN));
    inner += &curve(&equilibrium, 2, "in the bond in the end");
    chart("kT", "share of all pairs", &inner)
}
