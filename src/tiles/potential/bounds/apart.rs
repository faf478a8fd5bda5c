//! Bounds for two magnets that stay apart throughout a cell, as uniform distributions of dipoles.
//!
//! The energy of two magnets is the mean energy of two dipoles over their places in the magnets. If
//! these are r apart at the cell's centre, they are at least `rho = r - v` apart anywhere in the
//! cell, with v the largest distance that the cell moves a point of the second magnet; on the
//! straight motion from the centre no point is faster than v and no turn faster than w, half the
//! cell's angle. With K = mu0 m1 m2 / (4 pi) the energy and its first and third derivatives along
//! the motion are hence (see [`motion`](crate::potential::motion), whose series in t continues in
//! the same way) at most
//!
//! ```text
//! |U|    <= 2 K <rho^-3>
//! |U'|   <= K [6 v <rho^-4> + 2 w <rho^-3>]
//! |U'''| <= K [120 v^3 <rho^-6> + 144 v^2 w <rho^-5> + 42 v w^2 <rho^-4> + 2 w^3 <rho^-3>]
//! ```
//!
//! in J. The means are taken over pairs of parts of the magnets: for parts whose centroids are `rho`
//! apart in this sense, the offset d of two dipoles from there is zero on average and at most `s` long, and
//! the largest second derivative of `rho^-n` is the radial one, so that by Taylor's theorem
//! `<rho^-n> <= rho^-n + n (n + 1) / 2 <d^2> (rho - s)^-(n+2)`. Only distances in the plane count:
//! points above or below are farther. A disc that lies counts by its chords, one that stands by rings.

use std::sync::LazyLock;

use nalgebra::Vector2;

use crate::potential::bodies::Body;
use crate::potential::cuboid::block::Block;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::tile::magnet::Shape;
use crate::units::MU0_OVER_4PI;

/// A magnet seen from above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Footprint {
    position: Vector2<f64>,
    axis: Vector2<f64>,
    moment: f64,
    /// Along the axis and across it (m).
    sides: [f64; 2],
    filled: Filled,
}

/// How much of a magnet is above the points of its footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Filled {
    /// The same everywhere: a block.
    Evenly,
    /// As long as the chords of a disc that lies.
    ByChords,
    /// A disc that stands.
    Round,
}

impl From<&Block> for Footprint {
    fn from(block: &Block) -> Self {
        Self {
            position: block.position,
            axis: block.axis,
            moment: block.moment,
            sides: [block.size[0], block.size[1]],
            filled: Filled::Evenly,
        }
    }
}

impl From<&Body> for Footprint {
    fn from(body: &Body) -> Self {
        Self {
            position: body.position,
            axis: body.direction,
            moment: body.moment,
            sides: [body.size[0], body.size[1]],
            filled: match (body.shape, body.stands) {
                (Shape::Block, _) => Filled::Evenly,
                (Shape::Disc, false) => Filled::ByChords,
                (Shape::Disc, true) => Filled::Round,
            },
        }
    }
}

impl Footprint {
    /// The largest distance (m) of its points from its centre.
    fn radius(&self) -> f64 {
        match self.filled {
            Filled::Round => self.sides[0] / 2.0,
            _ => libm::hypot(self.sides[0], self.sides[1]) / 2.0,
        }
    }
}

/// Most parts along a side of a block.
const MOST: usize = 4;

/// Beyond this many times its longest side, a block has one part along that side; beyond half of
/// that, two.
const WHOLE: f64 = 12.0;

/// If the centres are closer than this many times the distance that the cell moves them, bounds
/// from pole faces alone are weaker.
const COARSE: f64 = 3.0;

/// Finer parts are not used if the cell moves blocks by more than their distance divided by this.
const HOPELESS: f64 = 2.2;

/// Blocks closer than this fraction of their radii count as too close: they touch or nearly touch.
const NEAREST: f64 = 0.5;

/// Room for rounding.
const ROOM: f64 = 1.0 + 1e-9;

/// Bounds of the energy (J) of two magnets over a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Apart {
    /// Of its magnitude.
    pub energy: f64,
    /// Of its change along a motion by the cell's half sizes.
    pub slope: f64,
    /// Of its difference from the second-order Taylor form about the centre.
    pub remainder: f64,
    /// Whether the cell is so large that bounds from pole faces alone are weaker.
    pub is_coarse: bool,
}

impl Apart {
    /// The bounds of two magnets, placed as at the cell's centre, in a cell that moves no point of
    /// the second one by more than `reach` (m) and turns it by at most `turn` (rad). `None` if
    /// parts of them may get too close.
    pub fn of<F: Copy + Into<Footprint>>(
        level: Level,
        magnets: [F; 2],
        [reach, turn]: [f64; 2],
    ) -> Option<Self> {
        let [first, second] = magnets.map(Into::into);
        let distance = (second.position - first.position).norm() - reach;
        if distance <= NEAREST * (first.radius() + second.radius()) {
            return None;
        }
        let sides = first.sides.into_iter().chain(second.sides);
        let longest = sides.fold(0.0, f64::max);
        let count = match distance / longest {
            ratio if ratio >= WHOLE => 1.0,
            ratio if ratio >= WHOLE / 2.0 || HOPELESS * reach >= distance => 2.0,
            _ => MOST as f64,
        };
        let [one, other] = [&first, &second].map(|it| Parts::new(it, longest / count));
        let [third, fourth, fifth, sixth] = level.run(Means {
            parts: [&one, &other],
            reach,
        })?;
        let k = ROOM * (MU0_OVER_4PI * first.moment * second.moment).abs();
        let (v, w) = (reach, turn);
        let bend = 120.0 * v * v * v * sixth
            + 144.0 * v * v * w * fifth
            + 42.0 * v * w * w * fourth
            + 2.0 * w * w * w * third;
        Some(Self {
            energy: 2.0 * k * third,
            slope: k * (6.0 * v * fourth + 2.0 * w * third),
            remainder: k * bend / 6.0,
            is_coarse: COARSE * reach >= distance,
        })
    }
}

/// Parts of a magnet, padded to whole vectors.
struct Parts {
    count: usize,
    x: [f64; MOST * MOST],
    y: [f64; MOST * MOST],
    /// Their shares, 1 on average; 0 for padding.
    weight: [f64; MOST * MOST],
    /// The largest distance of a part's points from its centroid (m), and their mean square distance
    /// (m^2) at most.
    radius: f64,
    square: f64,
}

impl Parts {
    /// Cut so that no side of a part is longer than `side` (m), or into the largest number of
    /// parts.
    fn new(magnet: &Footprint, side: f64) -> Self {
        let [along, across] = magnet.sides;
        let count = |length: f64| ((length / side - 1e-9).ceil() as usize).clamp(1, MOST);
        let counts = [count(along), count(across)];
        let mut parts = match magnet.filled {
            Filled::Evenly => Self::even(magnet.sides, counts),
            Filled::ByChords => Self::by_chords(magnet.sides, counts),
            Filled::Round => Self::round(along / 2.0, counts[0]),
        };
        let side = Vector2::new(-magnet.axis.y, magnet.axis.x);
        for k in 0..parts.count {
            let at = magnet.position + magnet.axis * parts.x[k] + side * parts.y[k];
            (parts.x[k], parts.y[k]) = (at.x, at.y);
        }
        parts
    }

    fn even([along, across]: [f64; 2], counts: [usize; 2]) -> Self {
        let sides = [along / counts[0] as f64, across / counts[1] as f64];
        let mut parts = Self {
            count: 0,
            radius: libm::hypot(sides[0], sides[1]) / 2.0,
            square: (sides[0] * sides[0] + sides[1] * sides[1]) / 12.0,
            ..Self::NONE
        };
        for (i, j) in (0..counts[0]).flat_map(|i| (0..counts[1]).map(move |j| (i, j))) {
            let [x, y] = [(i, 0), (j, 1)].map(|(k, n)| sides[n] * place(k, counts[n]));
            parts.push(x, y, 1.0);
        }
        parts
    }

    /// Strips of a disc.
    fn by_chords([along, across]: [f64; 2], counts: [usize; 2]) -> Self {
        let radius = across / 2.0;
        let length = along / counts[0] as f64;
        let mut parts = Self::NONE;
        for strip in &STRIPS[counts[1] - 1] {
            let aside = radius * strip.farthest;
            parts.radius = parts.radius.max(libm::hypot(length / 2.0, aside));
            let square = strip.square * radius * radius;
            parts.square = parts.square.max(length * length / 12.0 + square);
            for i in 0..counts[0] {
                parts.push(length * place(i, counts[0]), radius * strip.y, strip.share);
            }
        }
        parts
    }

    /// A disc as a whole, or cut into rings and those into sectors.
    fn round(radius: f64, count: usize) -> Self {
        const RINGS: [(f64, f64, usize); 3] = [(0.0, 0.35, 1), (0.35, 0.7, 5), (0.7, 1.0, 10)];
        let mut parts = Self::NONE;
        if count == 1 {
            parts.push(0.0, 0.0, 1.0);
            (parts.radius, parts.square) = (radius, radius * radius / 2.0);
            return parts;
        }
        let all: usize = RINGS.iter().map(|(_, _, sectors)| sectors).sum();
        for (from, to, sectors) in RINGS {
            let half = std::f64::consts::PI / sectors as f64;
            let squares = to * to - from * from;
            let mean = (to * to + from * from) / 2.0;
            // Of the centroid from the middle.
            let out = if sectors == 1 {
                0.0
            } else {
                2.0 / 3.0 * (to * to * to - from * from * from) / squares * libm::sin(half) / half
            };
            let corner = |r: f64| {
                let (sin, cos) = libm::sincos(half);
                libm::hypot(r * cos - out, r * sin)
            };
            let farthest = match sectors {
                1 => to,
                _ => corner(to).max(corner(from)).max(to - out).max(out - from),
            };
            parts.radius = parts.radius.max(radius * farthest);
            parts.square = parts.square.max(radius * radius * (mean - out * out));
            for k in 0..sectors {
                let (sin, cos) = libm::sincos(2.0 * half * k as f64);
                let share = squares / sectors as f64 * all as f64;
                parts.push(radius * out * cos, radius * out * sin, share);
            }
        }
        parts
    }

    const NONE: Self = Self {
        count: 0,
        x: [0.0; MOST * MOST],
        y: [0.0; MOST * MOST],
        weight: [0.0; MOST * MOST],
        radius: 0.0,
        square: 0.0,
    };

    fn push(&mut self, x: f64, y: f64, weight: f64) {
        let k = self.count;
        (self.x[k], self.y[k], self.weight[k]) = (x, y, weight);
        self.count += 1;
    }
}

/// A strip of a disc of radius 1.
struct Strip {
    /// Its centroid.
    y: f64,
    /// How far its points are from there across the strip: at most, and squared on average.
    farthest: f64,
    square: f64,
    /// Its area, in units of the mean of all strips.
    share: f64,
}

/// The strips of a disc that is cut into 1, 2 .. of equal widths.
static STRIPS: LazyLock<[Vec<Strip>; MOST]> =
    LazyLock::new(|| std::array::from_fn(|k| (0..=k).map(|j| Strip::new(j, k + 1)).collect()));

impl Strip {
    /// Number j of `count`, with `a(y)` the area of the disc up to y, `m` its first moment and `s` its second
    /// one: the integrals of `2 sqrt(1 - y^2)` times 1, y and y^2.
    fn new(j: usize, count: usize) -> Self {
        let moments = |y: f64| {
            let chord = ((1.0 - y) * (1.0 + y)).max(0.0).sqrt();
            let area = y * chord + libm::asin(y);
            let first = -2.0 / 3.0 * chord * chord * chord;
            let second = (area - 2.0 * y * chord * chord * chord) / 4.0;
            [area, first, second]
        };
        let ends = [j, j + 1].map(|k| 2.0 * k as f64 / count as f64 - 1.0);
        let [from, to] = ends.map(moments);
        let [area, first, second] = [0, 1, 2].map(|n| to[n] - from[n]);
        let y = first / area;
        let farthest = ends.into_iter().map(|end| (end - y).abs());
        Self {
            y,
            farthest: farthest.fold(0.0, f64::max),
            square: (second / area - y * y).max(0.0),
            share: area / std::f64::consts::PI * count as f64,
        }
    }
}

/// The middle of a part, in parts from the middle of the whole.
fn place(k: usize, count: usize) -> f64 {
    k as f64 - (count as f64 - 1.0) / 2.0
}

/// The bounds of the means of rho^-3 to rho^-6 (m^-3 to m^-6), if there are any.
struct Means<'a> {
    parts: [&'a Parts; 2],
    reach: f64,
}

impl Task for Means<'_> {
    type Output = Option<[f64; 4]>;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let [first, second] = self.parts;
        let square = first.square + second.square;
        let spread = [6.0, 10.0, 15.0, 21.0].map(|factor| factor * square);
        let radii = l.splat(first.radius + second.radius);
        let reach = l.splat(self.reach);
        // Parts closer than this fraction of their radii count as too close.
        let tiny = 0.1 * (first.radius + second.radius);
        let (zero, least, smallest) = (l.splat(0.0), l.splat(tiny), l.splat(tiny * tiny));
        let mut sums = [zero; 4];
        let mut closest = l.splat(f64::MAX);
        for i in 0..first.count {
            let (x, y) = (l.splat(first.x[i]), l.splat(first.y[i]));
            let own = l.splat(first.weight[i]);
            for from in (0..second.count).step_by(WIDTH) {
                let dx = l.sub(l.load(&second.x[from..]), x);
                let dy = l.sub(l.load(&second.y[from..]), y);
                let weight = l.load(&second.weight[from..]);
                let square = l.mul_add(dx, dx, l.mul(dy, dy));
                let square = l.select(l.sub(square, smallest), square, smallest);
                let rho = l.sub(l.mul(square, l.reciprocal_sqrt(square)), reach);
                let near = l.sub(rho, radii);
                // Padding is not close.
                let known = l.select(l.sub(weight, l.splat(0.5)), near, l.splat(f64::MAX));
                closest = l.min(closest, known);
                let near = l.select(l.sub(near, least), near, least);
                let rho = l.select(l.sub(rho, least), rho, least);
                let (inverse, other) = (l.reciprocal(rho), l.reciprocal(near));
                let (inverse2, other2) = (l.mul(inverse, inverse), l.mul(other, other));
                let both = l.mul(own, weight);
                let mut power = l.mul(both, l.mul(inverse2, inverse));
                let mut wide = l.mul(both, l.mul(l.mul(other2, other2), other));
                for (sum, factor) in sums.iter_mut().zip(spread) {
                    let mean = l.mul_add(l.splat(factor), wide, power);
                    *sum = l.add(*sum, mean);
                    power = l.mul(power, inverse);
                    wide = l.mul(wide, other);
                }
            }
        }
        if l.least(closest) <= tiny {
            return None;
        }
        let pairs = (first.count * second.count) as f64;
        let mut means = [0.0; 4];
        for (mean, sum) in means.iter_mut().zip(sums) {
            *mean = l.sum(sum) / pairs;
        }
        Some(means)
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::potential::cuboid::exact;

    /// Asserts that the bounds hold for the energy (J) and its first and third derivatives by time, by differences
    /// over h of energies with errors of `lost` in units of their bound; returns the bounds over these.
    pub fn check(
        apart: &Apart,
        at: &dyn Fn(f64) -> f64,
        (t, h, lost): (f64, f64, f64),
        name: &str,
    ) -> [f64; 3] {
        let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| at(t + k * h));
        let found = [
            at(t).abs(),
            (c - b).abs() / (2.0 * h),
            (d - 2.0 * c + 2.0 * b - a).abs() / (2.0 * h * h * h),
        ];
        let bounds = [apart.energy, apart.slope, 6.0 * apart.remainder];
        for i in 0..3 {
            // Rounding of energies over the differences.
            let lost = lost * apart.energy / h.powi([0, 1, 3][i]);
            assert!(
                found[i] <= bounds[i] + lost,
                "{name} {t} {i}: {found:?} {apart:?}"
            );
        }
        [0, 1, 2].map(|i| bounds[i] / found[i])
    }

    /// The energy and its first and third derivatives by time, by differences, along motions that
    /// turn the second block about a point and shift it.
    #[test]
    fn energies_and_derivatives_stay_within_their_bounds() {
        let sizes = [[0.010, 0.010, 0.003], [0.006, 0.012, 0.004]];
        let (mut count, mut closest) = (0, [f64::INFINITY; 3]);
        for (k, r) in (0..240u32).map(|k| (k, 0.016 + 0.001 * f64::from(k % 60))) {
            let angle = 0.37 * f64::from(k);
            let (sin, cos) = libm::sincos(1.3 * f64::from(k));
            let first = Block::placed([0.0, 0.0], 0.2, sizes[0]);
            let second = Block::placed([r * cos, r * sin], angle, sizes[k as usize % 2]);
            let centre = second.position - Vector2::new(0.02, 0.01);
            let (turn, half) = (0.04, 0.0012);
            let radius = (second.position - centre).norm() + second.radius();
            let reach = half + radius * turn;
            let Some(apart) = Apart::of(Level::best(), [&first, &second], [reach, turn]) else {
                continue;
            };
            let way = Vector2::new(libm::cos(angle), libm::sin(angle)) * half;
            let at = |t: f64| {
                let (sin, cos) = libm::sincos(turn * t);
                let back = Block {
                    position: second.position - centre,
                    ..second
                };
                exact(&first, &back.moved(cos, sin, centre + way * t)).energy
            };
            let h = 0.1;
            for t in [-0.7, -0.2, 0.0, 0.4, 0.7] {
                let ratios = check(&apart, &at, (t, h, 1e-9), &k.to_string());
                closest = [0, 1, 2].map(|i| f64::min(closest[i], ratios[i]));
                count += 1;
            }
        }
        // The closest bounds are tight; a meaningless bound would not be.
        assert!(count > 900, "{count}");
        let most = [1.5, 3.0, 6.0];
        assert!(
            closest.iter().zip(most).all(|(ratio, most)| *ratio < most),
            "{closest:?}"
        );
    }

    #[test]
    fn blocks_that_may_touch_have_no_bound() {
        let size = [0.010, 0.010, 0.003];
        let (first, second) = (
            Block::placed([0.0, 0.0], 0.0, size),
            Block::placed([0.012, 0.0], 0.1, size),
        );
        for reach in [0.001, 0.004, 0.1] {
            assert!(Apart::of(Level::best(), [&first, &second], [reach, 0.0]).is_none());
        }
        let second = Block::placed([0.05, 0.0], 0.1, size);
        assert!(Apart::of(Level::best(), [&first, &second], [0.001, 0.0]).is_some());
    }

    /// With many parts the means are those of the rays of a fine grid.
    #[test]
    fn the_means_are_close_to_those_of_points() {
        let size = [0.010, 0.010, 0.003];
        let (first, second) = (
            Block::placed([0.0, 0.0], 0.3, size),
            Block::placed([0.03, 0.01], 1.0, size),
        );
        let reach = 0.002;
        let points = |block: &Block| {
            let across = Vector2::new(-block.axis.y, block.axis.x);
            let mut list = Vec::new();
            for (i, j) in (0..20).flat_map(|i| (0..20).map(move |j| (i, j))) {
                let place = |k: i32| (f64::from(k) + 0.5) / 20.0 - 0.5;
                list.push(
                    block.position
                        + block.axis * (block.size[0] * place(i))
                        + across * (block.size[1] * place(j)),
                );
            }
            list
        };
        let (a, b) = (points(&first), points(&second));
        let [one, other] = [&first, &second].map(|block| Parts::new(&block.into(), 0.0025));
        for level in Level::available() {
            let parts = [&one, &other];
            let means = level.run(Means { parts, reach }).unwrap();
            for (mean, power) in means.into_iter().zip([3, 4, 5, 6]) {
                let sum: f64 = a
                    .iter()
                    .flat_map(|p| b.iter().map(move |q| (p - q).norm() - reach))
                    .map(|rho| rho.powi(-power))
                    .sum();
                let known = sum / (a.len() * b.len()) as f64;
                assert!(
                    mean >= known && mean < 1.3 * known,
                    "{power}: {mean} {known}"
                );
            }
        }
    }
}
