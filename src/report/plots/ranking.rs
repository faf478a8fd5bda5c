//! Designs side by side at a glance: depths, barriers between their bounds, and captures, the best
//! design on top.

use plotters::prelude::{Color, RGBColor, WHITE};
use plotters::style::text_anchor::{HPos, VPos};

use super::curves::caption;
use super::marks::{Pixel, polygon, polyline};
use super::picture::{Area, Picture, PictureError};
use super::style::{
    Axis, BLUE, Chart, GREEN, GRID, LABEL, SMALL, SOFT, Text, VERMILLION, chart, pixel, title,
    units,
};
use crate::comparison::quantity::{Measure, Place, placed};
use crate::comparison::{Assessment, Quantity};
use crate::report::comparison::Comparison;
use crate::report::figures::Shown;

const WIDTH: f64 = 1120.0;
/// Above the panels: the title and their headings with keys (pixels).
const HEAD: f64 = 104.0;
/// Height of a design's row (pixels).
const ROW: f64 = 44.0;
/// Below the panels: axes (pixels).
const FOOT: f64 = 66.0;
/// Left and right of the plots (pixels), their headings, and how far beyond the greatest value their
/// axes go.
const PLOTS: [((f64, f64), &str, f64); 3] = [
    ((230.0, 540.0), "depth", 1.22),
    ((580.0, 860.0), "barrier, certified bounds", 1.06),
    ((900.0, 1090.0), "captured, 95 % interval", 1.0),
];
const COLOURS: [RGBColor; 3] = [BLUE, GREEN, VERMILLION];

/// What a panel shows of each design.
struct RankingPanel {
    place: (f64, f64),
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
pub fn draw(comparison: &Comparison) -> Result<Picture, PictureError> {
    let rows = comparison.designs.len();
    let height = HEAD + ROW * rows as f64 + FOOT;
    Picture::draw((WIDTH as u32, height as u32), |root, _| {
        let text = format!("{rows} designs ranked by {}", comparison.by.label);
        title(root, &text)?;
        for (number, panel) in panels(comparison).iter().enumerate() {
            panel.draw(root, comparison, number)?;
        }
        for (row, design) in comparison.designs.iter().enumerate() {
            name(root, design, middle(row))?;
        }
        Ok(())
    })
}

fn panels(comparison: &Comparison) -> Vec<RankingPanel> {
    let places = placed(|quantity| quantity.ranking).into_iter();
    let all = places.flat_map(|(place, of)| of.into_iter().map(move |one| (place, one)));
    let all: Vec<_> = all.collect();
    let rows = all.chunk_by(|(a, _), (b, _)| a.row == b.row);
    let panels = PLOTS.iter().zip(rows);
    panels
        .map(|(plot, all)| panel(comparison, plot, all))
        .collect()
}

fn panel(
    comparison: &Comparison,
    &(place, heading, room): &((f64, f64), &'static str, f64),
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
        place,
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

/// The middle of a design's row (pixels).
fn middle(row: usize) -> f64 {
    HEAD + ROW * (row as f64 + 0.5)
}

fn name(root: &Area, design: &Assessment, y: f64) -> Result<(), PictureError> {
    let right = PLOTS[0].0.0 - 14.0;
    let mut font = Text::new(LABEL);
    let width = font.width(&design.name);
    if width > right - 10.0 {
        font.size *= (right - 10.0) / width;
    }
    font.write(root, &design.name, (right, y), (HPos::Right, VPos::Center))
}

impl RankingPanel {
    fn draw(
        &self,
        root: &Area,
        comparison: &Comparison,
        number: usize,
    ) -> Result<(), PictureError> {
        let rows = comparison.designs.len();
        let (left, right) = self.place;
        let bottom = HEAD + ROW * rows as f64;
        let area = root
            .split_horizontally(units(right))
            .0
            .split_vertically(units(bottom + FOOT))
            .0;
        let area = area.split_horizontally(units(left - 20.0)).1;
        let x = Axis::linear(0.0..self.end, 5, self.shown.axis());
        let y = Axis {
            range: 0.0..rows as f64,
            ticks: Vec::new(),
            name: String::new(),
        };
        let chart = chart(&area, [HEAD, 0.0, FOOT, 20.0], &x, &y, true)?;
        self.heading(root)?;
        for (row, design) in comparison.designs.iter().enumerate() {
            let y = middle(row);
            if row > 0 {
                let edge = y - ROW / 2.0;
                polyline(root, &[(left, edge), (right, edge)], GRID, 1.0)?;
            }
            match number {
                0 => self.bars(root, &chart, design, y)?,
                _ => self.points(root, &chart, design, y)?,
            }
        }
        Ok(())
    }

    /// The heading with a key for each colour.
    fn heading(&self, root: &Area) -> Result<(), PictureError> {
        let left = self.place.0;
        caption(root, self.heading, (left, HEAD - 34.0))?;
        if self.entries.len() < 2 {
            return Ok(());
        }
        let mut x = left;
        for (place, _) in &self.entries {
            let name = place.heading;
            let y = HEAD - 16.0;
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
        y: f64,
    ) -> Result<(), PictureError> {
        let mut end = self.place.0;
        for (k, (place, quantity)) in self.entries.iter().enumerate() {
            let Some(estimate) = quantity.of(design) else {
                continue;
            };
            let x = self.at(chart, estimate.value);
            let top = y - 14.0 + 15.0 * k as f64;
            block(root, [self.place.0, top, x, top + 13.0], colour(place))?;
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
                let at = (self.place.1 - 4.0, y);
                font.write(root, "no way", at, (HPos::Right, VPos::Center))?;
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
            let at = (self.place.0 + 6.0, y);
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
                let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 24.0).sin_cos();
                (x + radius * cos, y + radius * sin)
            })
            .collect()
    };
    polygon(root, &ring(4.2), WHITE, None)?;
    polygon(root, &ring(3.2), colour, None)
}
