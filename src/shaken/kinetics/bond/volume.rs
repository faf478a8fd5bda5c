//! Partition functions of states: the integral of the Boltzmann factor over a basin, with exact
//! contact.

use ordered_float::OrderedFloat;

use super::line::Weight;
use super::well::Well;
use tiles::order::Order;
use tiles::parallel;

/// Abscissas and weights of Gauss' rule of five points on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];
/// The extent of the well is measured at lines whose weight is this share of the minimum's.
const EXTENT_WEIGHT: f64 = 0.2;
/// A slide (m) or tilt (rad) that counts as no play: the contact tolerance.
pub const NO_PLAY: f64 = 1e-8;
/// Most rectangles.
const MOST: usize = 4_000;

/// A number with its estimated error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its estimated error, from the difference of the finer and the coarser rule.
    pub error: f64,
}

impl Estimate {
    /// The relative error; 0 for the number 0.
    pub fn relative_error(&self) -> f64 {
        match self.value == 0.0 {
            true => 0.0,
            false => self.error / self.value,
        }
    }
}

impl Well<'_> {
    /// The integral (m^2 rad) of `exp(-(U - Umin) / kT)` over the basin, to the relative
    /// `tolerance`: adaptive over slide and tilt (Gauss' rule of five by five points, rectangles
    /// divided in four), and Gauss' rule over panels of the gap. The same on any number of threads.
    pub fn volume(&self, kt: f64, tolerance: f64) -> Estimate {
        self.volume_below(kt, self.level, tolerance)
    }

    /// The same over what of the basin lies below `level` (J).
    pub fn volume_below(&self, kt: f64, level: f64, tolerance: f64) -> Estimate {
        self.weighed(kt, level).adapt(tolerance)
    }

    /// Whether tiles have play in it at kT (J), both along contact and in tilt: more than
    /// [`NO_PLAY`]. Otherwise its volume is 0.
    pub fn has_play(&self, kt: f64) -> bool {
        self.weighed(kt, self.level).spreads().is_some()
    }

    fn weighed(&self, kt: f64, level: f64) -> Integral<'_> {
        let weight = Weight {
            lowest: self.lowest,
            level: level.min(self.level),
            kt,
        };
        Integral { well: self, weight }
    }
}

struct Integral<'a> {
    well: &'a Well<'a>,
    weight: Weight,
}

/// A map from [0, 1] to the slide or the tilt that gives regions near the minimum as much room as
/// distant ones: `x = end sinh(u range) / sinh(range)`.
#[derive(Clone, Copy, Debug)]
struct Spread {
    end: f64,
    range: f64,
}

impl Spread {
    /// The place at u from 0 to 1, and by how much it moves with u.
    fn place(&self, u: f64) -> [f64; 2] {
        let unit = self.end / libm::sinh(self.range);
        let (sinh, cosh) = (libm::sinh(u * self.range), libm::cosh(u * self.range));
        [unit * sinh, (unit * self.range * cosh).abs()]
    }
}

/// A rectangle of spread slides and tilts, on one side of the minimum each.
#[derive(Clone, Copy)]
struct Rectangle {
    spreads: [Spread; 2],
    sides: [[f64; 2]; 2],
    value: f64,
    /// The difference between the sum of the four parts and the whole, divided among them.
    error: f64,
}

impl Integral<'_> {
    /// The integral over a line of gaps.
    fn line(&self, at: [f64; 2]) -> f64 {
        let Self { well, weight } = self;
        let parts = well.intervals(at).into_iter();
        parts
            .map(|part| well.lines.integral(at, part, weight))
            .sum()
    }

    fn adapt(&self, tolerance: f64) -> Estimate {
        let Some(spreads) = self.spreads() else {
            return Estimate::default();
        };
        let halves = [[0.0, 0.5], [0.5, 1.0]];
        let whole = (0..16).map(|k: usize| {
            let spreads = [spreads[0][k % 2], spreads[1][k / 2 % 2]];
            (spreads, [halves[k / 4 % 2], halves[k / 8]])
        });
        let whole: Vec<_> = whole.collect();
        let mut leaves: Vec<Rectangle> =
            parallel::map(&whole, |(spreads, sides)| self.rectangle(*spreads, *sides));
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
            leaves.order_by_key(|leaf| OrderedFloat(leaf.error));
            let split = leaves.split_off(leaves.len() - worst(&leaves, error));
            let parts: Vec<[Rectangle; 4]> = parallel::map(&split, |leaf| self.divided(leaf));
            leaves.extend(parts.into_iter().flatten());
        }
    }

    /// To either side along slide and tilt; `None` if the minimum has no play along one of them.
    fn spreads(&self) -> Option<[[Spread; 2]; 2]> {
        let peak = self.line([0.0, 0.0]);
        let spread = |axis: usize, end: f64| {
            let at = |x: f64| match axis {
                0 => [x, 0.0],
                _ => [0.0, x],
            };
            let mut scale = end;
            while self.line(at(scale)) < EXTENT_WEIGHT * peak && scale.abs() > NO_PLAY {
                scale /= 2.0;
            }
            let range = libm::asinh(end / scale).max(1e-3);
            (Spread { end, range }, scale.abs() > NO_PLAY)
        };
        let ends = self.well.extent();
        let found = [0, 1].map(|axis| ends[axis].map(|end| spread(axis, end)));
        let has_play = found.iter().all(|sides| sides.iter().any(|side| side.1));
        has_play.then(|| found.map(|sides| sides.map(|side| side.0)))
    }

    fn divided(&self, leaf: &Rectangle) -> [Rectangle; 4] {
        let [a, b] = leaf.sides.map(|[low, high]| {
            let middle = (low + high) / 2.0;
            [[low, middle], [middle, high]]
        });
        let mut parts: [Rectangle; 4] =
            std::array::from_fn(|k| self.rectangle(leaf.spreads, [a[k % 2], b[k / 2]]));
        let off = (sum(&parts, |part| part.value) - leaf.value).abs() / 4.0;
        for part in &mut parts {
            part.error = off;
        }
        parts
    }

    /// Gauss' rule over a rectangle; of the error nothing is known yet.
    fn rectangle(&self, spreads: [Spread; 2], sides: [[f64; 2]; 2]) -> Rectangle {
        let place = |k: usize, x: f64| {
            let [low, high] = sides[k];
            spreads[k].place((low + high) / 2.0 + (high - low) / 2.0 * x)
        };
        let mut value = 0.0;
        for (x, wx) in GAUSS {
            let [slide, by_slide] = place(0, x);
            for (y, wy) in GAUSS {
                let [tilt, by_tilt] = place(1, y);
                value += wx * wy * by_slide * by_tilt * self.line([slide, tilt]);
            }
        }
        let area = (sides[0][1] - sides[0][0]) * (sides[1][1] - sides[1][0]);
        Rectangle {
            spreads,
            sides,
            value: value * area / 4.0,
            error: f64::INFINITY,
        }
    }
}

/// The number of the worst rectangles, at the end of the list, that make up most of the error;
/// includes all without an error estimate.
fn worst(leaves: &[Rectangle], error: f64) -> usize {
    let mut rest = 0.9 * error;
    let chosen = leaves.iter().rev().take_while(|leaf| {
        let take = leaf.error.is_infinite() || (error.is_finite() && rest > 0.0);
        rest -= if error.is_finite() { leaf.error } else { 0.0 };
        take && leaf.error > 0.0
    });
    chosen.count()
}

fn sum(leaves: &[Rectangle], of: impl Fn(&Rectangle) -> f64) -> f64 {
    leaves.iter().map(of).sum()
}
