//! Partition functions of states: the integral of Boltzmann's factor over a basin, true contact
//! included.

use ordered_float::OrderedFloat;
use rayon::prelude::*;

use super::basin::Basin;
use super::line::Weight;
use crate::configuration::Configuration;
use crate::landscape::constrained::Point;
use crate::problem::Problem;

/// Abscissas and weights of Gauss' rule of five points on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];
/// A rectangle at the minimum is divided until a line in it weighs at least this share of the
/// minimum's own.
const SEEN: f64 = 0.2;
/// ... or it is this small a share of the whole.
const SMALLEST: f64 = 1e-6;
/// Most rectangles.
const MOST: usize = 4_000;

/// A number with its estimated error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// By how much it may be off, as the finer and the coarser rule differ.
    pub error: f64,
}

impl Estimate {
    /// The error as a share of the number; 0 of nothing.
    pub fn relative_error(&self) -> f64 {
        match self.value == 0.0 {
            true => 0.0,
            false => self.error / self.value,
        }
    }
}

/// A state that holds tiles, and its basin.
pub struct Well<'a> {
    basin: Basin<'a>,
}

impl<'a> Well<'a> {
    /// The well of a minimum whose lowest pass out lies at `pass` (J; infinite where none is known);
    /// no other minimum of `others` belongs to it. See [`Basin::flood`].
    pub fn new(problem: &'a Problem, minimum: &Point, pass: f64, others: &[Configuration]) -> Self {
        Self {
            basin: Basin::flood(problem, minimum, pass, others),
        }
    }

    /// The basin.
    pub fn basin(&self) -> &Basin<'a> {
        &self.basin
    }

    /// The integral (m^2 rad) of `exp(-(U - Umin) / kT)` over the basin, to the relative
    /// `tolerance`: adaptive over slide and tilt (Gauss' rule of five by five points, rectangles
    /// divided in four), and Gauss' rule over panels of the gap. The same on any number of threads.
    pub fn volume(&self, kt: f64, tolerance: f64) -> Estimate {
        self.volume_below(kt, self.basin.level, tolerance)
    }

    /// The same over what of the basin lies below `level` (J).
    pub fn volume_below(&self, kt: f64, level: f64, tolerance: f64) -> Estimate {
        let weight = Weight {
            lowest: self.basin.lowest,
            level: level.min(self.basin.level),
            kt,
        };
        Integral {
            basin: &self.basin,
            weight,
            peak: self.line([0.0, 0.0], &weight),
        }
        .adapt(tolerance)
    }

    fn line(&self, at: [f64; 2], weight: &Weight) -> f64 {
        line(&self.basin, at, weight)
    }
}

fn line(basin: &Basin, at: [f64; 2], weight: &Weight) -> f64 {
    let intervals = basin.intervals(at);
    let parts = intervals
        .iter()
        .map(|part| basin.lines.integral(at, *part, weight));
    parts.sum()
}

struct Integral<'a> {
    basin: &'a Basin<'a>,
    weight: Weight,
    /// What the minimum's own line weighs (m).
    peak: f64,
}

/// A rectangle of slides and tilts.
#[derive(Clone, Copy)]
struct Rectangle {
    sides: [[f64; 2]; 2],
    value: f64,
    /// How far the sum of the four parts was from the whole, shared among them.
    error: f64,
    /// Whether it has been divided enough to see the minimum.
    sees: bool,
}

impl Integral<'_> {
    fn adapt(&self, tolerance: f64) -> Estimate {
        let ends = self.basin.extent();
        let halves = [0, 1].map(|k| [[ends[k][0], 0.0], [0.0, ends[k][1]]]);
        let smallest = [0, 1].map(|k| SMALLEST * (ends[k][1] - ends[k][0]));
        let quarters = (0..4).map(|k| [halves[0][k % 2], halves[1][k / 2]]);
        let mut leaves: Vec<Rectangle> = quarters
            .map(|sides| Rectangle {
                error: f64::INFINITY,
                ..self.rectangle(sides)
            })
            .collect();
        loop {
            let total = sum(&leaves, |leaf| leaf.value);
            let error = sum(&leaves, |leaf| leaf.error);
            let is_done = error <= tolerance * total.max(f64::MIN_POSITIVE);
            if is_done || leaves.len() > MOST {
                return Estimate {
                    value: total,
                    error,
                };
            }
            let chosen = self.worst(&mut leaves, error, &smallest);
            if chosen == 0 {
                return Estimate {
                    value: total,
                    error,
                };
            }
            let split = leaves.split_off(leaves.len() - chosen);
            let parts: Vec<[Rectangle; 4]> =
                split.par_iter().map(|leaf| self.divided(leaf)).collect();
            leaves.extend(parts.into_iter().flatten());
        }
    }

    /// Brings those rectangles to the end that are to be divided next: those that do not see the
    /// minimum, and the worst that make up most of the error. How many.
    fn worst(&self, leaves: &mut [Rectangle], error: f64, smallest: &[f64; 2]) -> usize {
        let is_small =
            |leaf: &Rectangle| (0..2).all(|k| leaf.sides[k][1] - leaf.sides[k][0] <= smallest[k]);
        let key = |leaf: &Rectangle| match is_small(leaf) {
            true => 0.0,
            false if !leaf.sees => f64::INFINITY,
            false => leaf.error,
        };
        leaves.sort_by_key(|leaf| OrderedFloat(key(leaf)));
        let mut rest = 0.9 * error;
        let mut count = 0;
        for leaf in leaves.iter().rev() {
            let worth = key(leaf);
            if worth == 0.0 || (worth.is_finite() && rest <= 0.0) {
                break;
            }
            rest -= worth;
            count += 1;
        }
        count
    }

    fn divided(&self, leaf: &Rectangle) -> [Rectangle; 4] {
        let [a, b] = leaf.sides.map(|[low, high]| {
            let middle = (low + high) / 2.0;
            [[low, middle], [middle, high]]
        });
        let mut parts: [Rectangle; 4] =
            std::array::from_fn(|k| self.rectangle([a[k % 2], b[k / 2]]));
        let off = (sum(&parts, |part| part.value) - leaf.value).abs() / 4.0;
        for part in &mut parts {
            part.error = off;
        }
        parts
    }

    fn rectangle(&self, sides: [[f64; 2]; 2]) -> Rectangle {
        let place = |k: usize, x: f64| {
            let [low, high] = sides[k];
            (low + high) / 2.0 + (high - low) / 2.0 * x
        };
        let (mut value, mut heaviest) = (0.0, 0.0f64);
        for (x, wx) in GAUSS {
            for (y, wy) in GAUSS {
                let line = line(self.basin, [place(0, x), place(1, y)], &self.weight);
                heaviest = heaviest.max(line);
                value += wx * wy * line;
            }
        }
        let area = (sides[0][1] - sides[0][0]) * (sides[1][1] - sides[1][0]);
        let at_minimum = sides.iter().all(|[low, high]| *low <= 0.0 && 0.0 <= *high);
        Rectangle {
            sides,
            value: value * area / 4.0,
            error: 0.0,
            sees: !at_minimum || heaviest >= SEEN * self.peak,
        }
    }
}

fn sum(leaves: &[Rectangle], of: impl Fn(&Rectangle) -> f64) -> f64 {
    leaves.iter().map(of).sum()
}
