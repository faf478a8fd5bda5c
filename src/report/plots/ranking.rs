//! Designs side by side at a glance: depths, barriers between their bounds, and captures, the best
//! design on top.

use plotters::prelude::{Color, RGBColor, WHITE};
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, part};
use super::curve::caption;
use super::marks::{Box4, Pixel, polygon, polyline};
use super::picture::{Area, PictureError};
use super::style::{
    Axis, BLUE, Chart, GREEN, GRID, LABEL, SMALL, SOFT, Text, VERMILLION, chart, pixel,
};
use super::{Figure, Sheet};
use crate::comparison::Comparison;
use crate::figures::Shown;
use jobs::comparison::quantity::{Measure, Place, placed};
use jobs::comparison::{Assessment, Quantity};

const WIDTH: f64 = 1120.0;
/// Above the rows: the heading and its key (pixels).
const HEAD: f64 = 54.0;
/// Height of a design's row (pixels).
const ROW: f64 = 44.0;
/// Below the rows: the axis (pixels).
const FOOT: f64 = 66.0;
/// Space for the names of designs left of the first panel of a row, and left of others (pixels).
const NAMES: f64 = 230.0;
const GAP: f64 = 40.0;
/// Space right of a plot (pixels).
const RIGHT: f64 = 20.0;
/// Names of the panels' files, their shares of the width, their headings, and how far beyond the
/// greatest value their axes go.
const PLOTS: [(&str, f64, &str, f64); 3] = [
    ("depth", 550.0, "depth", 1.22),
    ("barrier", 320.0, "barrier, certified bounds", 1.06),
    ("captured", 250.0, "captured, 95 % interval", 1.0),
];
const COLOURS: [RGBColor; 3] = [BLUE, GREEN, VERMILLION];

/// What a panel shows of each design.
struct RankingPanel {
    heading: &'static str,
    /// How numbers are shown.
    shown: Shown,
    /// Greatest number on the axis.
    end: f64,
    entries: Vec<(Place, &'static Quantity)>,
    /// Ratios, whose numbers stand beside the bars.
    ratios: Vec<&'static Quantity>,
}

/// One row a design in the order of the ranking.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(comparison: &Comparison, sheet: &Sheet) -> Result<Figure, PictureError> {
    let rows = comparison.designs.len();
    let height = move |_| HEAD + ROW * rows as f64 + FOOT;
    let panels = PLOTS.iter().zip(panels(comparison)).enumerate();
    let panels = panels.map(|(number, (&(name, weight, ..), panel))| {
        let draw = move |root: &Area, _: &mut Vec<_>, place: Box4| {
            let narrow = place[2] - place[0] < 0.5 * WIDTH;
            let names = if narrow { 0.6 * NAMES } else { NAMES };
            // The names stand left of the first panel of each row.
            let gap = if place[0] > 0.0 { GAP } else { names };
            let [left, top, right, bottom] = place;
            let plot = [left + gap, top + HEAD, right - RIGHT, bottom - FOOT];
            if place[0] == 0.0 {
                for (row, design) in comparison.designs.iter().enumerate() {
                    name_of(root, design, [left, names], plot[1] + middle(row))?;
                }
            }
            panel.draw(root, comparison, number, plot)
        };
        Panel::new(name, 0.8 * weight, height, draw).weighing(weight)
    });
    let composition = Composition {
        name: "ranking".to_owned(),
        title: format!("{rows} designs ranked by {}", comparison.by.label),
        note: None,
        width: WIDTH,
        panels: panels.collect(),
        key: None,
    };
    Figure::new(&composition, sheet, comparison.table().csv())
}

fn panels(comparison: &Comparison) -> Vec<RankingPanel> {
    let places = placed(|quantity| quantity.ranking).into_iter();
    let all = places.flat_map(|(place, of)| of.into_iter().map(move |one| (place, one)));
    let all: Vec<_> = all.collect();
    let rows = all.chunk_by(|(a, _), (b, _)| a.row == b.row);
    let panels = PLOTS.iter().zip(rows);
    panels
        .map(|((.., heading, room), all)| panel(comparison, heading, *room, all))
        .collect()
}

fn panel(
    comparison: &Comparison,
    heading: &'static str,
    room: f64,
    all: &[(Place, &'static Quantity)],
) -> RankingPanel {
    let (ratios, entries): (Vec<_>, Vec<_>) = all
        .iter()
        .partition(|(_, one)| one.measure == Measure::Ratio);
    let estimates = |design| entries.iter().filter_map(move |(_, one)| one.of(design));
    let estimates = comparison.designs.iter().flat_map(estimates);
    let measure = entries[0].1.measure;
    let most = match measure {
        Measure::Share => 1.0,
        _ => estimates
            .flat_map(|e| e.finite())
            .flatten()
            .fold(f64::MIN_POSITIVE, f64::max),
    };
    let shown = Shown::new(measure, most);
    RankingPanel {
        heading,
        end: room * most / shown.unit,
        shown,
        entries,
        ratios: ratios.into_iter().map(|(_, one)| one).collect(),
    }
}

fn colour(place: &Place) -> RGBColor {
    COLOURS[usize::from(place.column) % COLOURS.len()]
}

/// The middle of a design's row below the first row's top (pixels).
fn middle(row: usize) -> f64 {
    ROW * (row as f64 + 0.5)
}

/// A design's name, right-aligned in a column that begins at `left` and is so wide (pixels).
fn name_of(
    root: &Area,
    design: &Assessment,
    [left, width]: [f64; 2],
    y: f64,
) -> Result<(), PictureError> {
    let right = left + width - 14.0;
    let mut font = Text::new(LABEL);
    let (room, wide) = (right - left - 10.0, font.width(&design.name));
    font.size *= (room / wide).min(1.0);
    font.write(root, &design.name, (right, y), (HPos::Right, VPos::Center))
}

impl RankingPanel {
    fn draw(
        &self,
        root: &Area,
        comparison: &Comparison,
        number: usize,
        plot: Box4,
    ) -> Result<(), PictureError> {
        let rows = comparison.designs.len();
        let [left, top, right, bottom] = plot;
        let area = part(root, [left - 20.0, top, right, bottom + FOOT]);
        let count = if right - left < 240.0 { 4 } else { 5 };
        let x = Axis::linear(0.0..self.end, count, self.shown.axis());
        let y = Axis {
            range: 0.0..rows as f64,
            ticks: Vec::new(),
            name: String::new(),
        };
        let chart = chart(&area, [0.0, 0.0, FOOT, 20.0], &x, &y, true)?;
        self.heading(root, (left, top))?;
        for (row, design) in comparison.designs.iter().enumerate() {
            let y = top + middle(row);
            if row > 0 {
                let edge = y - ROW / 2.0;
                polyline(root, &[(left, edge), (right, edge)], GRID, 1.0)?;
            }
            match number {
                0 => self.bars(root, &chart, design, (left, y))?,
                _ => self.points(root, &chart, design, [left, right], y)?,
            }
        }
        Ok(())
    }

    /// The heading with a key for each colour.
    fn heading(&self, root: &Area, (left, top): Pixel) -> Result<(), PictureError> {
        caption(root, self.heading, (left, top - 34.0))?;
        if self.entries.len() < 2 {
            return Ok(());
        }
        let mut x = left;
        for (place, _) in &self.entries {
            let name = place.heading;
            let y = top - 16.0;
            block(root, [x, y - 5.0, x + 10.0, y + 5.0], colour(place))?;
            let font = Text::new(SMALL);
            font.write(root, name, (x + 15.0, y), (HPos::Left, VPos::Center))?;
            x += 15.0 + 1.08 * font.width(name) + 14.0;
        }
        Ok(())
    }

    fn at(&self, chart: &Chart, value: f64) -> f64 {
        pixel(chart, (value / self.shown.unit).clamp(0.0, self.end), 0.0).0
    }

    /// Bars from zero, one below the other, with the ratios beside them.
    fn bars(
        &self,
        root: &Area,
        chart: &Chart,
        design: &Assessment,
        (left, y): Pixel,
    ) -> Result<(), PictureError> {
        let mut end = left;
        for (k, (place, quantity)) in self.entries.iter().enumerate() {
            let Some(estimate) = quantity.of(design) else {
                continue;
            };
            let x = self.at(chart, estimate.value);
            let top = y - 14.0 + 15.0 * k as f64;
            block(root, [left, top, x, top + 13.0], colour(place))?;
            end = end.max(x);
        }
        for ratio in &self.ratios {
            let text = match (ratio.read)(design) {
                Ok(ratio) => format!("\u{d7} {:.2}", ratio.estimate().value),
                Err(why) => why.to_owned(),
            };
            Text::new(SMALL).write(root, &text, (end + 7.0, y), (HPos::Left, VPos::Center))?;
        }
        Ok(())
    }

    /// Points with their bounds, one below the other.
    fn points(
        &self,
        root: &Area,
        chart: &Chart,
        design: &Assessment,
        [left, right]: [f64; 2],
        y: f64,
    ) -> Result<(), PictureError> {
        let count = self.entries.len() as f64;
        for (k, (place, quantity)) in self.entries.iter().enumerate() {
            let y = y + 12.0 * (k as f64 - (count - 1.0) / 2.0);
            let Some(estimate) = quantity.of(design) else {
                continue;
            };
            if estimate.value.is_infinite() {
                let font = Text::new(SMALL).colour(colour(place));
                let at = (right - 4.0, y);
                font.write(root, "caged, proved", at, (HPos::Right, VPos::Center))?;
                continue;
            }
            if let (Some(low), Some(high)) = (estimate.low, estimate.high) {
                let (low, high) = (self.at(chart, low), self.at(chart, high));
                let band = [low - 1.0, y - 5.5, high + 1.0, y + 5.5];
                polygon(root, &corners(band), colour(place).mix(0.45), None)?;
            }
            disc(root, (self.at(chart, estimate.value), y), colour(place))?;
        }
        if let [(_, quantity)] = &self.entries[..]
            && let Err(why) = (quantity.read)(design)
        {
            let font = Text::new(SMALL).colour(SOFT);
            let at = (left + 6.0, y);
            font.write(root, why, at, (HPos::Left, VPos::Center))?;
        }
        Ok(())
    }
}

fn corners([left, top, right, bottom]: [f64; 4]) -> [Pixel; 4] {
    [(left, top), (right, top), (right, bottom), (left, bottom)]
}

/// A filled rectangle: left, top, right, bottom (pixels).
pub(super) fn block(root: &Area, place: [f64; 4], colour: RGBColor) -> Result<(), PictureError> {
    polygon(root, &corners(place), colour, None)
}

/// A small disc with a white rim.
pub(super) fn disc(root: &Area, (x, y): Pixel, colour: RGBColor) -> Result<(), PictureError> {
    let ring = |radius: f64| -> Vec<Pixel> {
        (0..24)
            .map(|k| {
                let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 24.0);
                (x + radius * cos, y + radius * sin)
            })
            .collect()
    };
    polygon(root, &ring(4.2), WHITE, None)?;
    polygon(root, &ring(3.2), colour, None)
}
