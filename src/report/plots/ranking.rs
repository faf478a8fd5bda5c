//! Designs side by side at a glance: depths, barriers between their bounds, and captures, the best
//! design on top.

use plotters::prelude::{Color, RGBColor, WHITE};
use plotters::style::text_anchor::{HPos, VPos};

use super::marks::{Pixel, polygon, polyline};
use super::picture::{Area, Picture, PictureError};
use super::style::{
    Axis, BLUE, Chart, GREEN, GRID, LABEL, SMALL, SOFT, Text, VERMILLION, chart, pixel, title,
    units,
};
use crate::comparison::{Assessment, Quantity};
use crate::report::comparison::Comparison;
use crate::units::prefix_of;

const WIDTH: f64 = 1120.0;
/// Above the panels: the title and their headings with keys (pixels).
const HEAD: f64 = 104.0;
/// Height of a design's row (pixels).
const ROW: f64 = 44.0;
/// Below the panels: axes (pixels).
const FOOT: f64 = 66.0;
/// Left and right of the three plots (pixels).
const DEPTHS: (f64, f64) = (230.0, 540.0);
const BARRIERS: (f64, f64) = (580.0, 860.0);
const CAPTURES: (f64, f64) = (900.0, 1090.0);

/// What a panel shows of each design.
struct Panel {
    place: (f64, f64),
    heading: &'static str,
    axis: String,
    /// What the axis' numbers are multiplied by to be SI.
    unit: f64,
    end: f64,
    shown: Vec<(Quantity, RGBColor)>,
}

/// One row a design in the order of the ranking.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(comparison: &Comparison) -> Result<Picture, PictureError> {
    let rows = comparison.designs.len();
    let height = HEAD + ROW * rows as f64 + FOOT;
    Picture::draw((WIDTH as u32, height as u32), |root, _| {
        let text = format!("{rows} designs ranked by {}", comparison.by.label());
        title(root, &text)?;
        let panels = panels(comparison);
        for (number, panel) in panels.iter().enumerate() {
            panel.draw(root, comparison, number)?;
        }
        for (row, design) in comparison.designs.iter().enumerate() {
            name(root, design, middle(row))?;
        }
        Ok(())
    })
}

fn panels(comparison: &Comparison) -> [Panel; 3] {
    let most = |quantities: &[Quantity]| {
        let values = comparison.designs.iter().flat_map(|design| {
            let estimates = quantities.iter().filter_map(|q| q.of(design));
            estimates.flat_map(|e| [Some(e.value), e.low, e.high])
        });
        values
            .flatten()
            .filter(|v| v.is_finite())
            .fold(f64::MIN_POSITIVE, f64::max)
    };
    let energies = |place, heading, shown: Vec<(Quantity, RGBColor)>, room: f64| {
        let quantities: Vec<Quantity> = shown.iter().map(|(q, _)| *q).collect();
        let most = most(&quantities);
        let (unit, prefix) = prefix_of(0.999 * most);
        Panel {
            place,
            heading,
            axis: format!("energy ({prefix}J)"),
            unit,
            end: room * most / unit,
            shown,
        }
    };
    let depths = vec![
        (Quantity::BondDepth, BLUE),
        (Quantity::TrapDepth, VERMILLION),
    ];
    let barriers = vec![
        (Quantity::Unbinding, BLUE),
        (Quantity::Binding, GREEN),
        (Quantity::TrapEscape, VERMILLION),
    ];
    [
        energies(DEPTHS, "depth", depths, 1.22),
        energies(BARRIERS, "barrier, certified bounds", barriers, 1.06),
        Panel {
            place: CAPTURES,
            heading: "captured, 95 % interval",
            axis: "far starts (%)".to_owned(),
            unit: 0.01,
            end: 100.0,
            shown: vec![(Quantity::Captured, BLUE)],
        },
    ]
}

/// The middle of a design's row (pixels).
fn middle(row: usize) -> f64 {
    HEAD + ROW * (row as f64 + 0.5)
}

fn name(root: &Area, design: &Assessment, y: f64) -> Result<(), PictureError> {
    let right = DEPTHS.0 - 14.0;
    let mut font = Text::new(LABEL);
    let width = font.width(&design.name);
    if width > right - 10.0 {
        font.size *= (right - 10.0) / width;
    }
    font.write(root, &design.name, (right, y), (HPos::Right, VPos::Center))
}

impl Panel {
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
        let x = Axis::linear(0.0..self.end, 5, self.axis.clone());
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
        let heading = Text::new(LABEL).bold();
        heading.write(
            root,
            self.heading,
            (left, HEAD - 34.0),
            (HPos::Left, VPos::Bottom),
        )?;
        if self.shown.len() < 2 {
            return Ok(());
        }
        let mut x = left;
        for (quantity, colour) in &self.shown {
            let label = match quantity {
                Quantity::Unbinding => "unbinding",
                Quantity::Binding => "binding",
                Quantity::TrapEscape => "escape from trap",
                other => other.label(),
            };
            let y = HEAD - 16.0;
            block(root, [x, y - 5.0, x + 10.0, y + 5.0], *colour)?;
            let font = Text::new(SMALL);
            font.write(root, label, (x + 15.0, y), (HPos::Left, VPos::Center))?;
            x += 15.0 + 1.08 * font.width(label) + 14.0;
        }
        Ok(())
    }

    fn at(&self, chart: &Chart, value: f64) -> f64 {
        pixel(chart, (value / self.unit).clamp(0.0, self.end), 0.0).0
    }

    /// Bars from zero, one below the other, with the selectivity beside them.
    fn bars(
        &self,
        root: &Area,
        chart: &Chart,
        design: &Assessment,
        y: f64,
    ) -> Result<(), PictureError> {
        let mut end = self.place.0;
        for (k, (quantity, colour)) in self.shown.iter().enumerate() {
            let Some(estimate) = quantity.of(design) else {
                continue;
            };
            let x = self.at(chart, estimate.value);
            let top = y - 14.0 + 15.0 * k as f64;
            block(root, [self.place.0, top, x, top + 13.0], *colour)?;
            end = end.max(x);
        }
        let text = match Quantity::Selectivity.of(design) {
            Some(selectivity) => format!("\u{d7} {:.2}", selectivity.value),
            None if design.bond.is_none() => "no bond".to_owned(),
            None => "no traps".to_owned(),
        };
        Text::new(SMALL).write(root, &text, (end + 7.0, y), (HPos::Left, VPos::Center))
    }

    /// Points with their bounds, one below the other.
    fn points(
        &self,
        root: &Area,
        chart: &Chart,
        design: &Assessment,
        y: f64,
    ) -> Result<(), PictureError> {
        let count = self.shown.len() as f64;
        for (k, (quantity, colour)) in self.shown.iter().enumerate() {
            let y = y + 12.0 * (k as f64 - (count - 1.0) / 2.0);
            let Some(estimate) = quantity.of(design) else {
                continue;
            };
            if estimate.value.is_infinite() {
                let font = Text::new(SMALL).colour(*colour);
                let at = (self.place.1 - 4.0, y);
                font.write(root, "no way", at, (HPos::Right, VPos::Center))?;
                continue;
            }
            if let (Some(low), Some(high)) = (estimate.low, estimate.high) {
                let (low, high) = (self.at(chart, low), self.at(chart, high));
                let band = [low - 1.0, y - 5.5, high + 1.0, y + 5.5];
                polygon(root, &corners(band), colour.mix(0.45), None)?;
            }
            disc(root, (self.at(chart, estimate.value), y), *colour)?;
        }
        if Quantity::Captured.of(design).is_none() && count == 1.0 {
            let font = Text::new(SMALL).colour(SOFT);
            font.write(
                root,
                "not counted",
                (self.place.0 + 6.0, y),
                (HPos::Left, VPos::Center),
            )?;
        }
        Ok(())
    }
}

fn corners([left, top, right, bottom]: [f64; 4]) -> [Pixel; 4] {
    [(left, top), (right, top), (right, bottom), (left, bottom)]
}

fn block(root: &Area, place: [f64; 4], colour: RGBColor) -> Result<(), PictureError> {
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
