//! Axes, and where values stand between them.

use super::canvas::{Anchor, Box4, Canvas, Pixel};
use super::scale::{EnergyScale, round_step};
use super::style::{GRID, INK, LABEL, SMALL, minus};
use physics::units::prefix_of;

/// Space left of and below the names of axes (pixels).
const EDGE: f64 = 12.0;

/// How values stand along an axis.
#[derive(Clone, Copy, Debug)]
pub enum Spacing {
    /// As multiples of a unit.
    Even(f64),
    /// By the decimal logarithms of what they are more than minus this.
    Logarithms(f64),
    /// By a scale of energies.
    Energies(EnergyScale),
}

impl Spacing {
    /// Where a value stands, on an axis without ends.
    pub fn of(self, value: f64) -> f64 {
        match self {
            Self::Even(unit) => value / unit,
            Self::Logarithms(offset) => libm::log10(value + offset),
            Self::Energies(scale) => scale.position(value),
        }
    }
}

/// One axis: from where to where, the values that are marked with their texts, what is told.
#[derive(Clone, Debug)]
pub struct Axis {
    pub spacing: Spacing,
    /// As they are spaced.
    pub ends: [f64; 2],
    /// Places of marks, as they are spaced.
    pub marks: Vec<(f64, String)>,
    pub name: String,
}

impl Axis {
    /// An axis of multiples of a unit with about `count` marks at round numbers.
    pub fn even(range: [f64; 2], unit: f64, count: usize, name: impl Into<String>) -> Self {
        let [low, high] = range.map(|end| end / unit);
        let step = round_step((high - low) / count as f64);
        let decimals = (-libm::log10(step).floor()).max(0.0) as usize;
        let numbers = (low / step - 1e-9).ceil() as i64..=(high / step + 1e-9).floor() as i64;
        let mark = |k: i64| {
            let value = k as f64 * step;
            (value, minus(&format!("{value:.decimals$}")))
        };
        Self {
            spacing: Spacing::Even(unit),
            ends: [low, high],
            marks: numbers.map(mark).collect(),
            name: name.into(),
        }
    }

    /// An axis of a quantity in the SI unit `symbol`, with the prefix that suits its size.
    pub fn quantity(range: [f64; 2], symbol: &str, count: usize, name: &str) -> Self {
        // Just below a power of a thousand still counts as the smaller unit: 1000 mm, not 1 m.
        let (unit, prefix) = prefix_of(0.999 * range[0].abs().max(range[1].abs()));
        Self::even(range, unit, count, format!("{name} ({prefix}{symbol})"))
    }

    /// An axis on which nothing is told but which of some things one is.
    pub fn places(count: usize) -> Self {
        Self {
            spacing: Spacing::Even(1.0),
            ends: [0.0, count as f64],
            marks: Vec::new(),
            name: String::new(),
        }
    }

    /// How far along the axis a value stands, from 0 to 1.
    fn share(&self, value: f64) -> f64 {
        part(self.spacing.of(value), self.ends)
    }
}

/// A rectangle between axes.
#[derive(Clone, Debug)]
pub struct Plot {
    /// Pixels.
    pub frame: Box4,
    pub x: Axis,
    pub y: Axis,
}

impl Plot {
    /// Draws axes within a place but for the margins (pixels: top, right, bottom, left), which hold
    /// the texts of marks and the names of axes as well; with a grid or without.
    pub fn new(
        canvas: &mut Canvas,
        [left, top, right, bottom]: Box4,
        margin: [f64; 4],
        [x, y]: [Axis; 2],
        grid: bool,
    ) -> Self {
        let frame = [
            left + margin[3],
            top + margin[0],
            right - margin[1],
            bottom - margin[2],
        ];
        let plot = Self { frame, x, y };
        let [inner, high, far, low] = frame;
        let across = |place: f64| inner + (far - inner) * part(place, plot.x.ends);
        let up = |place: f64| low + (high - low) * part(place, plot.y.ends);
        let marks = |axis: &Axis| {
            let [from, to] = axis.ends;
            let room = 1e-9 * (to - from);
            let mut marks = axis.marks.clone();
            marks.retain(|(place, _)| (from - room..=to + room).contains(place));
            marks
        };
        let (below, beside) = (marks(&plot.x), marks(&plot.y));
        if grid {
            for x in below.iter().map(|mark| across(mark.0)) {
                canvas.line(&[(x, low), (x, high)], GRID, 1.0);
            }
            for y in beside.iter().map(|mark| up(mark.0)) {
                canvas.line(&[(inner, y), (far, y)], GRID, 1.0);
            }
        }
        canvas.line(&[(inner, high), (inner, low), (far, low)], INK, 1.0);
        for (place, text) in below {
            let x = across(place);
            canvas.line(&[(x, low), (x, low + 5.0)], INK, 1.0);
            canvas.write(SMALL, &text, (x, low + 10.0), Anchor::Top);
        }
        for (place, text) in beside {
            let y = up(place);
            canvas.line(&[(inner - 5.0, y), (inner, y)], INK, 1.0);
            canvas.write(SMALL, &text, (inner - 10.0, y), Anchor::Right);
        }
        let below = ((inner + far) / 2.0, bottom - EDGE);
        canvas.write(LABEL, &plot.x.name, below, Anchor::Bottom);
        if !plot.y.name.is_empty() {
            let beside = (left + EDGE, (high + low) / 2.0);
            canvas.write_upwards(LABEL, &plot.y.name, beside);
        }
        plot
    }

    /// Where a point lies (pixels).
    pub fn at(&self, x: f64, y: f64) -> Pixel {
        let [left, top, right, bottom] = self.frame;
        (
            left + (right - left) * self.x.share(x),
            bottom + (top - bottom) * self.y.share(y),
        )
    }

    /// A level line across the plot.
    pub fn level(&self, y: f64) -> [Pixel; 2] {
        let [left, _, right, _] = self.frame;
        let y = self.at(0.0, y).1;
        [(left, y), (right, y)]
    }

    /// Says above the plot what it shows.
    pub fn heading(&self, canvas: &mut Canvas, text: &str) {
        let at = (self.frame[0], self.frame[1] - 8.0);
        canvas.write(LABEL.bold(), text, at, Anchor::BottomLeft);
    }
}

fn part(place: f64, [low, high]: [f64; 2]) -> f64 {
    (place - low) / (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        let labels = |axis: Axis| -> Vec<String> {
            axis.marks.into_iter().map(|(_, label)| label).collect()
        };
        let wide = labels(Axis::even([-0.73, 0.73], 1.0, 7, "x (m)"));
        assert_eq!(wide, ["\u{2212}0.5", "0.0", "0.5"]);
        let gaps = labels(Axis::even([0.0, 86.0], 1.0, 9, "gap (mm)"));
        assert_eq!(gaps[..3], ["0", "10", "20"]);
        assert_eq!(gaps.len(), 9);
    }
}
