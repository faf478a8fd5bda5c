//! The charts of rates: the committor with its reactive flux, and rates over kT.

use std::fmt::Write;

use super::word_charts::{AREA, chart, label};
use crate::plots::scale;
use crate::rates::{AtKt, Table};
use physics::kinetics::map::Map;
use physics::order::Order;
use physics::units::{plain, si};

/// Okabe and Ito's colours, told apart by colour-blind readers, from dark to light.
const COLOURS: [&str; 6] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9",
];
/// Side of a map (pixels), and where it begins.
const SIDE: f64 = 520.0;
const CORNER: [f64; 2] = [64.0, 20.0];
/// Steps of a map's colours.
const BANDS: f64 = 20.0;
/// Squares that an arrow stands for, along x and y.
const ARROW: usize = 5;
/// Arrows are left out that are this share of the longest.
const FAINT: f64 = 0.05;

/// The pictures: stem of the file, title, SVG.
pub fn all(table: &Table, over_kt: &[AtKt]) -> Vec<(&'static str, &'static str, String)> {
    let mut all = Vec::new();
    if let Some(map) = table.map() {
        let title =
            "Committor: how often the bond comes before free, and where the flux into it goes";
        all.push(("committor", title, committor(table, map)));
    }
    let mut rates_known = over_kt.iter().flat_map(|at| &at.leaving).flatten();
    if rates_known.any(|rate| *rate > 0.0) {
        let title = "Rates out of states over kT; dotted: with the wells as corners in closed form";
        all.push(("rates", title, rates(table, over_kt)));
    }
    all
}

/// The committor as colours, the flux as arrows, the fixed tile as an outline.
fn committor(table: &Table, map: &Map) -> String {
    let [left, top] = CORNER;
    let size = SIDE / map.side as f64;
    let at = |[x, y]: [f64; 2]| {
        let part = |x: f64| (x / map.radius + 1.0) / 2.0 * SIDE;
        [left + part(x), top + SIDE - part(y)]
    };
    let mut inner = String::new();
    let band = |q: f64| q.is_finite().then(|| (q * BANDS).round() as i32);
    for (row, line) in map.committor.chunks(map.side).enumerate() {
        let mut from = 0;
        for run in line.chunk_by(|a, b| band(*a) == band(*b)) {
            if let Some(band) = band(run[0]) {
                let [r, g, b] = scale::colour(f64::from(band) / BANDS);
                let _ = write!(
                    inner,
                    "<path fill=\"#{r:02x}{g:02x}{b:02x}\" d=\"M{:.1},{:.1}h{:.1}v{:.1}h-{2:.1}z\"/>",
                    left + size * from as f64,
                    top + SIDE - size * (row + 1) as f64,
                    size * run.len() as f64 + 0.1,
                    size + 0.1,
                );
            }
            from += run.len();
        }
    }
    let outline = &table.design.pair.fixed.outline;
    let corners = outline.vertices().iter().map(|v| at([v.x, v.y]));
    let corners: Vec<String> = corners.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let _ = write!(
        inner,
        "<polygon points=\"{}\" fill=\"#ddd\" stroke=\"#222\"/>",
        corners.join(" ")
    );
    inner += &arrows(map, &at);
    for step in -1..=1 {
        let (place, text) = (
            f64::from(step) * map.radius,
            si(f64::from(step) * map.radius, "m", 2),
        );
        let [x, y] = at([place, place]);
        inner += &label(x, top + SIDE + 18.0, "middle", &text);
        inner += &label(left - 6.0, y + 4.0, "end", &text);
    }
    framed(&(inner + &legend()))
}

/// The mean flux of some squares each; lengths go with its root.
fn arrows(map: &Map, at: &dyn Fn([f64; 2]) -> [f64; 2]) -> String {
    let count = map.side / ARROW;
    let flows: Vec<([f64; 2], [f64; 2])> = (0..count * count)
        .map(|number| {
            let (i, j) = (number % count * ARROW, number / count * ARROW);
            let squares = (0..ARROW * ARROW).map(|k| (j + k / ARROW) * map.side + i + k % ARROW);
            let middle = map.middle((j + ARROW / 2) * map.side + i + ARROW / 2);
            let sum = squares.map(|square| map.flux[square]);
            (
                middle,
                sum.fold([0.0; 2], |sum, flow| [sum[0] + flow[0], sum[1] + flow[1]]),
            )
        })
        .collect();
    let size = |flow: &[f64; 2]| libm::hypot(flow[0], flow[1]);
    let most = flows.iter().map(|(_, flow)| size(flow)).fold(0.0, f64::max);
    let mut text = String::new();
    let longest = 2.0 * map.radius / count as f64;
    for (middle, flow) in &flows {
        let share = (size(flow) / most.max(f64::MIN_POSITIVE)).sqrt();
        if share < FAINT.sqrt() {
            continue;
        }
        let along = flow.map(|part| part / size(flow));
        let tip = [0, 1].map(|k| middle[k] + 0.5 * share * longest * along[k]);
        let tail = [0, 1].map(|k| middle[k] - 0.5 * share * longest * along[k]);
        let side =
            |sign: f64| {
                let across = [-along[1], along[0]];
                at([0, 1]
                    .map(|k| tip[k] - (0.3 * along[k] + sign * 0.2 * across[k]) * share * longest))
            };
        let ([a, b], [c, d]) = (at(tail), at(tip));
        let [[e, f], [g, h]] = [side(1.0), side(-1.0)];
        let _ = write!(
            text,
            "M{a:.1},{b:.1}L{c:.1},{d:.1}M{e:.1},{f:.1}L{c:.1},{d:.1}L{g:.1},{h:.1}"
        );
    }
    format!(
        "<path d=\"{text}\" fill=\"none\" stroke=\"#fff\" stroke-width=\"3\"/><path d=\"{text}\" \
         fill=\"none\" stroke=\"#000\" stroke-width=\"1.3\"/>"
    )
}

/// What the colours say.
fn legend() -> String {
    let left = CORNER[0] + SIDE + 16.0;
    let mut text = String::new();
    let tall = SIDE / (BANDS + 1.0);
    for band in 0..=BANDS as i32 {
        let [r, g, b] = scale::colour(f64::from(band) / BANDS);
        let y = CORNER[1] + SIDE - tall * f64::from(band + 1);
        let _ = write!(
            text,
            "<rect x=\"{left}\" y=\"{y:.1}\" width=\"16\" height=\"{:.1}\" fill=\"#{r:02x}{g:02x}{b:02x}\"/>",
            tall + 0.2
        );
        if band % 5 == 0 {
            let share = format!("{} %", 5 * band);
            text += &label(left + 22.0, y + 0.5 * tall + 4.0, "start", &share);
        }
    }
    text
}

fn framed(inner: &str) -> String {
    let [left, top] = CORNER;
    let (w, h) = (left + SIDE + 90.0, top + SIDE + 56.0);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" font-family=\"Noto Sans, Helvetica, Arial, \
         sans-serif\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" height=\"{h}\"><rect width=\"100%\" \
         height=\"100%\" fill=\"#fff\"/>{inner}<rect x=\"{left}\" y=\"{top}\" width=\"{SIDE}\" \
         height=\"{SIDE}\" fill=\"none\" stroke=\"#222\"/><text x=\"{x}\" y=\"{below}\" \
         font-size=\"14\" text-anchor=\"middle\" fill=\"#222\">x of the moving tile</text><text \
         x=\"16\" y=\"{y}\" font-size=\"14\" text-anchor=\"middle\" fill=\"#222\" \
         transform=\"rotate(-90 16 {y})\">y of the moving tile</text></svg>",
        x = left + SIDE / 2.0,
        y = top + SIDE / 2.0,
        below = top + SIDE + 44.0,
    )
}

/// Rates out of each state over kT, both by their logarithms; the closed form dotted.
fn rates(table: &Table, over_kt: &[AtKt]) -> String {
    let [left, top, width, height] = AREA;
    let known = over_kt
        .iter()
        .flat_map(|at| at.leaving.iter().chain(&at.corner).flatten());
    let logs: Vec<f64> = known
        .filter(|rate| **rate > 0.0)
        .map(|rate| libm::log10(*rate))
        .collect();
    let low = logs.iter().copied().fold(f64::INFINITY, f64::min).floor();
    let high = logs
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max)
        .ceil();
    if !low.is_finite() || !high.is_finite() {
        return chart("kT", "rate out (1/s)", "");
    }
    let high = high.max(low + 1.0);
    let (first, last) = (
        libm::log(over_kt[0].kt),
        libm::log(over_kt[over_kt.len() - 1].kt),
    );
    let x = |kt: f64| left + width * (0.03 + 0.75 * (libm::log(kt) - first) / (last - first));
    let y = |rate: f64| top + height * (high - libm::log10(rate)) / (high - low);
    let mut inner = String::new();
    let every = ((high - low) / 6.0).ceil() as usize;
    for power in (low as i32..=high as i32).step_by(every) {
        let rate = 10f64.powi(power);
        inner += &label(left - 6.0, y(rate) + 4.0, "end", &plain(rate, 1));
    }
    for at in over_kt {
        inner += &label(x(at.kt), top + height + 18.0, "middle", &si(at.kt, "J", 2));
    }
    let mut names: Vec<(f64, String)> = Vec::new();
    for (number, place) in table.places.iter().enumerate() {
        let colour = COLOURS[number % COLOURS.len()];
        let mut line = |of: &dyn Fn(&AtKt) -> Option<f64>, dashes: &str| {
            let points: Vec<[f64; 2]> = over_kt
                .iter()
                .filter_map(|at| Some([x(at.kt), y(of(at).filter(|rate| *rate > 0.0)?)]))
                .collect();
            let places: Vec<String> = points
                .iter()
                .map(|[x, y]| format!("{x:.1},{y:.1}"))
                .collect();
            let _ = write!(
                inner,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\" \
                 stroke-dasharray=\"{dashes}\"/>",
                places.join(" ")
            );
            for [x, y] in points.iter().filter(|_| dashes.is_empty()) {
                let _ = write!(
                    inner,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>"
                );
            }
            points.last().map(|point| point[1])
        };
        let end = line(&|at| at.leaving[number], "");
        let dotted = line(&|at| at.corner[number], "2 4");
        if let Some(end) = end.or(dotted) {
            let name = format!("<tspan fill=\"{colour}\">{} left</tspan>", place.name);
            names.push((end, name));
        }
    }
    names.order_by(|a, b| a.0.total_cmp(&b.0));
    let mut last = f64::NEG_INFINITY;
    for (end, name) in names {
        last = end.max(last + 16.0);
        inner += &label(left + width * 0.8, last + 4.0, "start", &name);
    }
    chart("kT", "rate out (1/s)", &inner)
}
