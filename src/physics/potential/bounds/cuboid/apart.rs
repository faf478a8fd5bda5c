//! Two blocks that stay apart throughout a cell, as even spreads of dipoles.
//!
//! The energy of two blocks is the mean, over the places of a dipole in either, of that of the two
//! dipoles. Where these are r apart at the cell's centre, they are at least `rho = r - v` apart
//! anywhere in the cell, v the farthest that the cell moves a point of the second block; on the
//! straight way from the centre no point is faster than v and nothing turns faster than w, half the
//! cell's angle. With K = mu0 m1 m2 / (4 pi) the energy and its first and third derivatives along
//! the way are hence (see [`motion`](crate::potential::motion), whose series in t goes on in the
//! same way) at most
//!
//! ```text
//! |U|    <= 2 K <rho^-3>
//! |U'|   <= K [6 v <rho^-4> + 2 w <rho^-3>]
//! |U'''| <= K [120 v^3 <rho^-6> + 144 v^2 w <rho^-5> + 42 v w^2 <rho^-4> + 2 w^3 <rho^-3>]
//! ```
//!
//! in J. The means are those over pairs of parts of the blocks: for parts whose centres are `rho`
//! apart in this sense, the offset d of two dipoles from there is even and at most `s` long, and the
//! largest second derivative of `rho^-n` is the radial one, so that by Taylor's theorem
//! `<rho^-n> <= rho^-n + n (n + 1) / 2 <d^2> (rho - s)^-(n+2)`. Places are those in the plane: what
//! lies above or below is farther.

use nalgebra::Vector2;

use crate::potential::batch::Level;
use crate::potential::batch::lanes::{Lanes, Task, WIDTH};
use crate::potential::cuboid::block::Block;
use crate::units::MU0_OVER_4PI;

/// Most parts along a side of a block.
const MOST: usize = 4;

/// A block has one part along its longest side from a distance of this many times that side on, and
/// two from half of that on.
const WHOLE: f64 = 12.0;

/// Pole faces by themselves say less where the centres are not this many times as far apart as the
/// cell moves them.
const COARSE: f64 = 3.0;

/// A form is not worth finer parts where the cell moves blocks by more than their distance over this.
const HOPELESS: f64 = 2.2;

/// Blocks nearer than this share of their radii count as too close: they touch, or might as well.
const NEAREST: f64 = 0.5;

/// Room for rounding.
const ROOM: f64 = 1.0 + 1e-9;

/// What the energy (J) of two blocks does over a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Apart {
    /// The most it is in magnitude.
    pub energy: f64,
    /// The most that it changes along a motion by the cell's half sizes.
    pub slope: f64,
    /// The most by which it differs from its Taylor form of second order about the centre.
    pub remainder: f64,
    /// Whether the cell is so large that pole faces by themselves say less.
    pub is_coarse: bool,
}

impl Apart {
    /// Of two blocks as the cell's centre places them, in a cell that moves no point of the second
    /// one by more than `reach` (m) and turns it by at most `turn` (rad). `None` where parts of them
    /// may get too close.
    pub fn of(
        level: Level,
        [first, second]: [&Block; 2],
        [reach, turn]: [f64; 2],
    ) -> Option<Self> {
        let distance = (second.position - first.position).norm() - reach;
        if distance <= NEAREST * (first.radius() + second.radius()) {
            return None;
        }
        let sides = [first.size[0], first.size[1], second.size[0], second.size[1]];
        let longest = sides.into_iter().fold(0.0, f64::max);
        let count = match distance / longest {
            ratio if ratio >= WHOLE => 1.0,
            ratio if ratio >= WHOLE / 2.0 || HOPELESS * reach >= distance => 2.0,
            _ => MOST as f64,
        };
        let [one, other] = [first, second].map(|block| Parts::new(block, longest / count));
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

/// Parts of a block of one size, filled up to whole vectors.
struct Parts {
    count: usize,
    x: [f64; MOST * MOST],
    y: [f64; MOST * MOST],
    /// 1 for a part, 0 for what fills up.
    weight: [f64; MOST * MOST],
    /// Half the diagonal (m), and the mean square distance of a part's points from its centre (m^2).
    radius: f64,
    square: f64,
}

impl Parts {
    /// Cut so that no side of a part is longer than `side` (m), or into as many parts as there may
    /// be.
    fn new(block: &Block, side: f64) -> Self {
        let [along, across] = [block.size[0], block.size[1]];
        let count = |length: f64| ((length / side - 1e-9).ceil() as usize).clamp(1, MOST);
        let counts = [count(along), count(across)];
        let sides = [along / counts[0] as f64, across / counts[1] as f64];
        let mut parts = Self {
            count: counts[0] * counts[1],
            x: [0.0; MOST * MOST],
            y: [0.0; MOST * MOST],
            weight: [0.0; MOST * MOST],
            radius: libm::hypot(sides[0], sides[1]) / 2.0,
            square: (sides[0] * sides[0] + sides[1] * sides[1]) / 12.0,
        };
        let across = Vector2::new(-block.axis.y, block.axis.x);
        let place = |k: usize, count: usize| k as f64 - (count as f64 - 1.0) / 2.0;
        for k in 0..parts.count {
            let (i, j) = (k / counts[1], k % counts[1]);
            let at = block.position
                + block.axis * (sides[0] * place(i, counts[0]))
                + across * (sides[1] * place(j, counts[1]));
            parts.x[k] = at.x;
            parts.y[k] = at.y;
            parts.weight[k] = 1.0;
        }
        parts
    }
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
        // Parts nearer than this share of their radii count as too close.
        let tiny = 0.1 * (first.radius + second.radius);
        let (zero, least, smallest) = (l.splat(0.0), l.splat(tiny), l.splat(tiny * tiny));
        let mut sums = [zero; 4];
        let mut closest = l.splat(f64::MAX);
        for i in 0..first.count {
            let (x, y) = (l.splat(first.x[i]), l.splat(first.y[i]));
            for from in (0..second.count).step_by(WIDTH) {
                let dx = l.sub(l.load(&second.x[from..]), x);
                let dy = l.sub(l.load(&second.y[from..]), y);
                let weight = l.load(&second.weight[from..]);
                let square = l.mul_add(dx, dx, l.mul(dy, dy));
                let square = l.select(l.sub(square, smallest), square, smallest);
                let rho = l.sub(l.mul(square, l.reciprocal_sqrt(square)), reach);
                let near = l.sub(rho, radii);
                // What fills up is not close.
                let known = l.select(l.sub(weight, l.splat(0.5)), near, l.splat(f64::MAX));
                closest = l.min(closest, known);
                let near = l.select(l.sub(near, least), near, least);
                let rho = l.select(l.sub(rho, least), rho, least);
                let (inverse, other) = (l.reciprocal(rho), l.reciprocal(near));
                let (inverse2, other2) = (l.mul(inverse, inverse), l.mul(other, other));
                let mut power = l.mul(weight, l.mul(inverse2, inverse));
                let mut wide = l.mul(weight, l.mul(l.mul(other2, other2), other));
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
