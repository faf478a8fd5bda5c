//! Designs side by side: depths, barriers with their bounds, and captures, the best design on top.

use plotters::style::{Color, RGBColor};

use super::axes::{Axis, Plot};
use super::canvas::{Box4, Canvas};
use super::composition::{Composition, Panel};
use super::picture::PictureError;
use super::style::{Anchor, BLUE, GREEN, GRID, LABEL, SMALL, SOFT, VERMILLION};
use super::{Figure, Sheet};
use crate::figures::Shown;
use jobs::comparison::quantity::{Measure, Slot, placed};
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
/// Room (pixels) for the line at zero.
const AXIS: f64 = 20.0;
/// File names of the panels, shares of the width, headings, and the space (pixels) beyond the
/// largest value.
const PLOTS: [(&str, f64, &str, f64); 3] = [
    ("depth", 550.0, "depth", 66.0),
    ("barrier", 320.0, "barrier, certified bounds", 10.0),
    ("captured", 250.0, "captured, 95 % interval", 0.0),
];
const COLOURS: [RGBColor; 3] = [BLUE, GREEN, VERMILLION];

/// A panel with one quantity or several of each design.
struct RankingPanel {
    /// Its index among the panels.
    number: usize,
    /// The unit of the numbers.
    shown: Shown,
    /// Largest number shown (SI).
    most: f64,
    entries: Vec<(Slot, &'static Quantity)>,
    /// Ratios, whose numbers are written beside the bars.
    ratios: Vec<&'static Quantity>,
}

/// One row per design in the order of the ranking `by` a figure; `numbers` are the same as CSV.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    designs: &[Assessment],
    by: &Quantity,
    numbers: String,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let rows = designs.len();
    let height = move |_| HEAD + ROW * rows as f64 + FOOT;
    let places = placed(|quantity| quantity.ranking).into_iter();
    let all = places.flat_map(|(place, of)| of.into_iter().map(move |one| (place, one)));
    let all: Vec<_> = all.collect();
    let entries = all.chunk_by(|(a, _), (b, _)| a.row == b.row);
    let panels = PLOTS.iter().zip(entries).enumerate();
    let panels = panels.map(|(number, (&(name, weight, ..), entries))| {
        let panel = RankingPanel::new(designs, number, entries);
        let draw = move |canvas: &mut Canvas, [left, top, right, bottom]: Box4| {
            let narrow = right - left < 0.5 * WIDTH;
            let names = if narrow { 0.6 * NAMES } else { NAMES };
            // The names are left of the first panel of each row.
            let gap = if left > 0.0 { GAP } else { names };
            panel.draw(canvas, designs, [left + gap - AXIS, top, right, bottom]);
            if left == 0.0 {
                for (row, design) in designs.iter().enumerate() {
                    let font = LABEL.within(names - 24.0, &design.name);
                    let at = (names - 14.0, top + HEAD + middle(row));
                    canvas.write(font, &design.name, at, Anchor::Right);
                }
            }
        };
        Panel::new(name, 0.8 * weight, height, draw).weighing(weight)
    });
    let composition = Composition {
        name: "ranking".to_owned(),
        title: format!("{rows} designs ranked by {}", by.label),
        width: WIDTH,
        panels: panels.collect(),
        ..Composition::default()
    };
    Figure::new(&composition, sheet, numbers)
}

fn colour(place: &Slot) -> RGBColor {
    COLOURS[usize::from(place.column) % COLOURS.len()]
}

/// The middle of a design's row below the first row's top (pixels).
fn middle(row: usize) -> f64 {
    ROW * (row as f64 + 0.5)
}

impl RankingPanel {
    fn new(designs: &[Assessment], number: usize, all: &[(Slot, &'static Quantity)]) -> Self {
        let (ratios, entries): (Vec<_>, Vec<(Slot, &'static Quantity)>) = all
            .iter()
            .copied()
            .partition(|(_, one)| one.measure == Measure::Ratio);
        let measure = entries[0].1.measure;
        let estimates = |design| entries.iter().filter_map(move |(_, one)| one.of(design));
        let values = designs.iter().flat_map(estimates);
        let values = values.flat_map(|estimate| estimate.finite()).flatten();
        let most = match measure {
            Measure::Share => 1.0,
            _ => values.fold(f64::MIN_POSITIVE, f64::max),
        };
        Self {
            number,
            shown: Shown::new(measure, most),
            most,
            entries,
            ratios: ratios.into_iter().map(|(_, one)| one).collect(),
        }
    }

    fn draw(&self, canvas: &mut Canvas, designs: &[Assessment], place: Box4) {
        let count = if place[2] - place[0] < 260.0 + AXIS {
            4
        } else {
            5
        };
        let width = place[2] - place[0] - AXIS - RIGHT;
        let end = self.most * width / (width - PLOTS[self.number].3);
        let axes = [
            Axis::even([0.0, end], self.shown.unit, count, self.shown.axis()),
            Axis::places(designs.len()),
        ];
        let plot = Plot::new(canvas, place, [HEAD, RIGHT, FOOT, AXIS], axes, true);
        let [left, top, right, _] = plot.frame;
        self.heading(canvas, plot.frame);
        for (row, design) in designs.iter().enumerate() {
            let y = top + middle(row);
            if row > 0 {
                let edge = y - ROW / 2.0;
                canvas.line(&[(left, edge), (right, edge)], GRID, 1.0);
            }
            match self.number {
                0 => self.bars(canvas, &plot, design, y),
                _ => self.points(canvas, &plot, design, y),
            }
        }
    }

    /// The heading with a key for each colour.
    fn heading(&self, canvas: &mut Canvas, [left, top, right, _]: Box4) {
        let heading = PLOTS[self.number].2;
        let font = LABEL.bold().within(right - left, heading);
        canvas.write(font, heading, (left, top - 34.0), Anchor::BottomLeft);
        let key = || self.entries.iter().filter(|_| self.entries.len() > 1);
        let wide = key().map(|(place, _)| 29.0 + SMALL.room(place.heading));
        // Further to the left where it is wider than the plot.
        let mut x = left.min(right + RIGHT - wide.sum::<f64>()).max(4.0);
        for (place, _) in key() {
            let y = top - 16.0;
            canvas.block([x, y - 5.0, x + 10.0, y + 5.0], colour(place));
            canvas.note(place.heading, (x + 15.0, y), Anchor::Left);
            x += 15.0 + SMALL.room(place.heading) + 14.0;
        }
    }

    fn at(&self, plot: &Plot, value: f64) -> f64 {
        plot.at(value.clamp(0.0, self.most), 0.0).0
    }

    /// Bars from zero, one below the other, with the ratios beside them.
    fn bars(&self, canvas: &mut Canvas, plot: &Plot, design: &Assessment, y: f64) {
        let left = plot.frame[0];
        let mut end = left;
        for (k, (place, quantity)) in self.entries.iter().enumerate() {
            if let Some(estimate) = quantity.of(design) {
                let x = self.at(plot, estimate.value);
                let top = y - 14.0 + 15.0 * k as f64;
                canvas.block([left, top, x, top + 13.0], colour(place));
                end = end.max(x);
            }
        }
        for ratio in &self.ratios {
            let text = match (ratio.read)(design) {
                Ok(ratio) => format!("\u{d7} {:.2}", ratio.estimate().value),
                Err(why) => why.to_owned(),
            };
            canvas.note(&text, (end + 7.0, y), Anchor::Left);
        }
    }

    /// Points with their bounds, one below the other.
    fn points(&self, canvas: &mut Canvas, plot: &Plot, design: &Assessment, y: f64) {
        let [left, _, right, _] = plot.frame;
        let count = self.entries.len() as f64;
        for (k, (place, quantity)) in self.entries.iter().enumerate() {
            let (y, colour) = (y + 12.0 * (k as f64 - (count - 1.0) / 2.0), colour(place));
            let Some(estimate) = quantity.of(design) else {
                continue;
            };
            if estimate.value.is_infinite() {
                let font = SMALL.colour(colour);
                canvas.write(font, "caged, proved", (right - 4.0, y), Anchor::Right);
                continue;
            }
            if let (Some(low), Some(high)) = (estimate.low, estimate.high) {
                let [low, high] = [low, high].map(|end| self.at(plot, end));
                canvas.block([low - 1.0, y - 5.5, high + 1.0, y + 5.5], colour.mix(0.45));
            }
            canvas.disc((self.at(plot, estimate.value), y), colour);
        }
        if let [(_, quantity)] = &self.entries[..]
            && let Err(why) = (quantity.read)(design)
        {
            canvas.write(SMALL.colour(SOFT), why, (left + 6.0, y), Anchor::Left);
        }
    }
}
