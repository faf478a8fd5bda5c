//! Bounds of the interaction energy of uniformly magnetised blocks over a cell.
//!
//! # Far pairs
//! Blocks whose centres are farther apart than three times the sum of their half diagonals, and
//! four times the magnet's reach, are treated as the dipoles at their centres, with value, gradient
//! and Hessian as in [`DipoleBounds`], plus the value and the gradient of the difference between
//! blocks and dipoles, from the multipole series. The second-order remainder of that difference is
//! bounded by treating blocks as uniform distributions of dipoles (see `dipole::taylor`); it
//! decreases like `r^-7`. The series leaves out terms of less than 1e-9 of `K / r^3`, K = mu0 m1 m2
//! / (4 pi); with their gradients and turns over the cell, and the terms beyond the sixteenth,
//! which are less than 3e-10 at 2.5 sums of the half diagonals, 1e-7 is a safe bound.
//!
//! # Pairs that stay apart
//! Closer pairs whose blocks stay apart throughout the cell have the second-order Taylor form of
//! their own energy, from Gauss rules over the pole faces at the cell's centre. Its remainder is
//! that of uniform distributions of dipoles (see `apart`), if this is less than the remainder of
//! the individual pole faces. The error of the rules is bounded below for the value, and for slope
//! and second derivative by the bound of the derivatives on the same ellipse.
//!
//! # Near pairs
//! All other pairs are treated as charged pole faces: with Phi the potential of a face of the first
//! block, integrated over the heights of the second (in closed form, see `cuboid::sheet`), the
//! energy is the integral of Phi along the second block's faces. Each face is cut into panels, and
//! the nodes of the panels move with the cell.
//!
//! **Clear panels**, at least the distance D from the face throughout the cell, use a Gauss rule.
//! Phi is, along the panel's line, an integral of `((t - w)(t - w*))^(-1/2)` whose branch points w
//! are at least D from the panel in the complex plane (the points of the face, seen along and
//! across the panel's line, and what lies above them), so on an ellipse about the panel whose
//! points are no farther than b < D from it `|Phi| <= M = w1 c1 c2 / (D - b)`, and the error of the
//! rule of n nodes is at most `(half width) 64/15 M rho^(-2n) / (1 - rho^-2)`, rho the sum of the
//! ellipse's half axes in half widths: the rule is exact up to the degree 2n - 1, the Chebyshev
//! coefficients from there on are at most `2 M rho^-k`, and each integral and its rule together at
//! most 32/15 (Trefethen, *Is Gauss quadrature better than Clenshaw-Curtis?*, theorem 4.5,
//! doi:10.1137/060659831). This holds for every configuration of the cell. Each node has its value,
//! gradient and Hessian, and a third-order remainder from the bounds of the n-th directional
//! derivative of Phi by `n! int int int dz1 dz2 ds / r^(n+1)`, over the finite face or over an
//! infinite one, whichever is less.
//!
//! **Panels over a face**, nearly parallel to it and inside its upright edges by at least D, use a
//! Gauss rule whose nodes have value, gradient and the second derivatives along v and across. There
//! `Phi = A - int int ln(h^2 + z^2) dz1 dz2`, A the sum of `int int ln(u + r) dz1 dz2`, r^2 = u^2 +
//! h^2 + z^2, over both edges, u the distance from the edge. A is analytic up to the edges: on an
//! ellipse whose points are no farther than b < D from the panel the parts of u and of r that are
//! real are positive, so along a line of slope s `|d/dt ln(u + r)| <= (1 + |h s| / (D - b)) / (D -
//! b)`, and the rule's error is that of clear panels with M the half axis times the sum of these.
//! The rest depends on h alone; its second derivative is `4 ln(sqrt(h^2 + high^2) / sqrt(h^2 +
//! low^2))`, high and low half the sum and half the difference of the thicknesses, and the rule and
//! the integral are each no farther from its tangent than `4 e^2 (1/2 ln(sqrt(e^2 + high^2) /
//! sqrt(e^2 + low^2)) + 3/4)`, e how far h changes along half the panel. Along h the forms have a
//! constant second derivative (an *arch*): instead of the one just named, which decreases with h
//! like a logarithm, its value at a height near the middle of those within reach (see
//! `faces::arch`, which also bounds the error); and instead of `A_hh`, which is not negative while
//! u is at least h and at most the sum of `E(p) = 2 (r_high - r_low) / p` over both edges, half of
//! that. The rest is of third order: `A_vvv` and `A_vhh` are at most the sum of `2 E(p) / p`,
//! `A_vvh` of `3/2 E(p) / p`, and the deviation of a motion from its straight part.
//!
//! **Touching panels** are cut to about a quarter of the reach and have forms about their
//! midpoints. In the plane Phi has second derivatives `g'(p)`-like from the two upright edges of
//! the face, at most `2 (r_high - r_low) / p` each, plus `Phi_xx + Phi_hh`, between 0 and `4
//! asinh(w1 / 2 / sqrt(h^2 + low^2))`, from the level ones. The latter grows like a logarithm as h
//! tends to 0. Over the face the forms have an arch instead, the sum over both ends, s from there,
//! of `2 [asinh(s / sqrt(h^2 + low^2)) - asinh(s / sqrt(h^2 + high^2))]`. Beside the face, where h
//! may change its sign, its average over a straight motion adds at most 7/4 to half of the arc
//! function at the far end. Phi_h jumps at the face itself, but a panel over the face that reached
//! below it would be inside the first block, which lies in its own tile, and so not free. The forms
//! are hence those of the outer side. If a block sticks out of its tile, if the cell is too large,
//! and at the face's upright edges, the panel has an interval: Phi decreases with the distance from
//! the face's line and with the distance from its middle line.
//!
//! A pair whose bounds are weaker than `2 K <d^-3>` (d the smallest distances of the blocks'
//! dipoles) or `sqrt(U11 U22)` (Cauchy and Schwarz; Uii the energy of a block's charges with a copy
//! of themselves, bounded in the same way) has the smaller of these as its interval.
//!
//! # Slopes
//! The remainder of a form of order n changes along a motion by the fraction s of the cell's half
//! sizes by at most n s times its bound, as in `dipole::taylor`; separate terms are added if the
//! remainder is an average (`int ln(1/t) dt = 1`) or the error of a rule. Along h the slope jumps
//! where blocks that stick out of their tiles overlap: by at most 4 pi thicknesses over at most
//! that overlap.
//!
//! # Rounding
//! Dipoles as in [`DipoleBounds`]. Phi and its derivatives are sums of a few dozen terms on partial
//! results of at most `40 S^2`, with S the sum of all lengths, as no logarithm exceeds `ln(S /
//! 1e-15 m) < 40`; at most 20 of their operations are on results of that size, each accurate to
//! 1e-13 or better (the reciprocals): together less than `1e-10 S^2`, which times the face's charge
//! is added for each pair. Gradients and Hessians have the same relative errors and act over less
//! than the distance that their denominators hold. Distances have a margin of 1e-8 m for the
//! paper's tile, and in proportion for others. As elsewhere it is assumed that the platform's sine,
//! cosine and arc functions are accurate to 8 units in the last place.

mod faces;
mod nodes;
#[cfg(test)]
mod tests;

use nalgebra::Vector2;

use super::apart::Apart;
use super::dipole::{DipoleBounds, Spread};
use super::near::SLACK;
use super::{CellBounds, Enclosure, one_by_one};
use crate::cell::{Cell, Quadratic};
use crate::configuration::Configuration;
use crate::potential::cuboid::block::Block;
use crate::potential::cuboid::correction::Correction;
use crate::potential::simd::Level;
use crate::potential::{CuboidPotential, Potential};
use crate::scale::Scale;
use crate::tile::{Magnet, Outline, Tile};
use crate::units::MU0_OVER_4PI;
use faces::{CellMotion, Left, Pair};
use nodes::{NodeSum, Nodes, Totals};

/// Blocks closer than this many times the sum of their radii are bounded by their pole faces.
const CLOSE: f64 = 3.0;

/// A cell of blocks takes as long as about this many of dipoles: 12 to 28 over the shipped designs.
const CELLS_OF_DIPOLES: u64 = 18;

/// Units of work for a cell, for each pair of its blocks, for each pair that is bounded by its pole
/// faces, and for each node of these: 1.2 times the fit to 16,000 cells of random designs with
/// vectors of 8 numbers, most of which (5 to 95 %) take 0.86 to 1.37 times as long as the fit.
const A_CELL: u64 = 260;
const A_PAIR: u64 = 4;
const A_NEAR_PAIR: u64 = 90;
const A_NODE: u64 = 14;

/// The error of the multipole series, in value and in the change by its gradient and turn over a
/// cell, as a fraction of `mu0 m1 m2 / (4 pi r^3)`.
const SERIES: f64 = 1e-7;

/// Relative rounding error of the nodes' values.
const ROUNDING: f64 = 1e-10;

/// Depth up to which a block may stick out of its tile and still count as inside, as a fraction of
/// the slack of touching.
const STICKING_OUT: f64 = 0.1;

/// Cell bounds of the interaction energy of two tiles' blocks.
#[derive(Clone, Debug)]
pub struct CuboidBounds {
    level: Level,
    /// The blocks' dipoles.
    dipoles: DipoleBounds,
    potential: CuboidPotential,
    fixed: Vec<Enclosed>,
    moving: Vec<Enclosed>,
    /// How much (m) blocks may overlap in configurations that count as free, with a margin.
    slack: f64,
}

/// A block and its properties.
#[derive(Clone, Copy, Debug)]
struct Enclosed {
    block: Block,
    /// Whether it lies inside its own tile's outline.
    inside: bool,
    /// Square root of the greatest energy (J) its charges may have with a copy of themselves.
    own: f64,
}

impl CuboidBounds {
    /// Bounds for the magnets of two tiles, with the best available instruction set.
    pub fn new(fixed: &Tile, moving: &Tile) -> Self {
        Self::with_level(fixed, moving, Level::best())
    }

    /// Bounds for the given instruction set.
    pub fn with_level(fixed: &Tile, moving: &Tile, level: Level) -> Self {
        let enclosed = [fixed, moving].map(|tile| enclosed(tile, level));
        Self::of_enclosed([fixed, moving], enclosed, level)
    }

    /// The enclosure of every single pair of magnets, those of the first moving one first.
    pub(super) fn of_pairs(fixed: &Tile, moving: &Tile, level: Level) -> Vec<Self> {
        let [first, second] = [fixed, moving].map(|tile| {
            let each = one_by_one(tile).into_iter();
            each.zip(enclosed(tile, level)).collect::<Vec<_>>()
        });
        let pairs = second
            .iter()
            .flat_map(|b| first.iter().map(move |a| (a, b)));
        pairs
            .map(|((a, first), (b, second))| {
                Self::of_enclosed([a, b], [vec![*first], vec![*second]], level)
            })
            .collect()
    }

    fn of_enclosed(tiles: [&Tile; 2], enclosed: [Vec<Enclosed>; 2], level: Level) -> Self {
        let [fixed, moving] = tiles;
        let potential = CuboidPotential::with_level(&fixed.magnets, &moving.magnets, level);
        let largest = |size: &dyn Fn(&[f64; 3]) -> f64, tile: &Tile| {
            let sizes = tile.magnets.iter().map(|magnet| size(&magnet.size));
            sizes.fold(0.0, f64::max)
        };
        let both = |size: &dyn Fn(&[f64; 3]) -> f64| largest(size, fixed) + largest(size, moving);
        let diagonals = both(&|[a, b, c]| libm::hypot(libm::hypot(*a, *b), *c) / 2.0);
        let spread = Spread {
            near: (CLOSE * diagonals).max(potential.hand_over()),
            radii: both(&|[a, b, _]| libm::hypot(*a, *b) / 2.0),
            square: both(&|[a, b, c]| (a * a + b * b + c * c) / 12.0),
            error: SERIES,
        };
        let [first, second] = enclosed;
        Self {
            level,
            dipoles: DipoleBounds::with_level(fixed, moving, level).with_spread(spread),
            potential,
            fixed: first,
            moving: second,
            slack: Scale::of(tiles.map(|tile| tile.outline.circumradius())).length(SLACK),
        }
    }
}

fn enclosed(tile: &Tile, level: Level) -> Vec<Enclosed> {
    let slack = Scale::of([tile.outline.circumradius(); 2]).length(SLACK);
    let inside = |magnet: &Magnet| {
        magnet
            .corners()
            .iter()
            .all(|corner| tile.outline.signed_distance(*corner) <= STICKING_OUT * slack)
            && !is_cut(&Block::from(magnet), &tile.outline, STICKING_OUT * slack)
    };
    tile.magnets
        .iter()
        .map(|magnet| {
            let block = Block::from(magnet);
            let motion = still(slack);
            let (totals, left) = faces(level, [&block; 2], &motion, None, &mut Nodes::new());
            Enclosed {
                block,
                inside: inside(magnet),
                own: (totals.value + left.spread).max(0.0).sqrt(),
            }
        })
        .collect()
}

/// Nothing moves.
fn still(slack: f64) -> CellMotion {
    CellMotion {
        arm: Vector2::zeros(),
        reach: 0.0,
        sides: Vector2::zeros(),
        turn: 0.0,
        apart: false,
        slack,
    }
}

/// The form of two blocks by their pole faces, in the frame of the first one's axis, and its
/// remainder including rounding: face by face, or for whole blocks if they stay apart and this is
/// tighter.
fn faces(
    level: Level,
    [first, second]: [&Block; 2],
    motion: &CellMotion,
    apart: Option<&Apart>,
    nodes: &mut Nodes,
) -> (Totals, Left) {
    let volume = |block: &Block| block.size.iter().product::<f64>();
    let strength = MU0_OVER_4PI * first.moment * second.moment / (volume(first) * volume(second));
    let pair = Pair::new(first, second, strength, motion);
    nodes.clear();
    let left = match apart.filter(|apart| !pair.says_more_than(apart)) {
        None => pair.append(nodes),
        Some(Apart { remainder, .. }) => {
            let together = Left {
                spread: *remainder,
                slope: 3.0 * remainder,
                jump: 0.0,
            };
            pair.append_at_rest(nodes) + together
        }
    };
    let totals = level.run(NodeSum {
        nodes,
        half: first.size[1] / 2.0,
        heights: [
            (first.size[2] + second.size[2]) / 2.0,
            (first.size[2] - second.size[2]).abs() / 2.0,
        ],
    });
    let whole: f64 = first.size.iter().chain(&second.size).sum();
    let whole = whole + (second.position - first.position).norm();
    let rounding = ROUNDING * strength.abs() * second.size[1] * whole * whole;
    let left = Left {
        spread: left.spread + totals.spread + rounding,
        slope: left.slope + 3.0 * totals.turned + rounding,
        jump: left.jump,
    };
    (totals, left)
}

/// Whether the outline runs through a block's inner part, farther than this (m) inside.
fn is_cut(block: &Block, outline: &Outline, inside: f64) -> bool {
    let half = [block.size[0], block.size[1]].map(|size| size / 2.0 - inside);
    let local = |p: Vector2<f64>| {
        let d = p - block.position;
        [block.axis.dot(&d), block.axis.perp(&d)]
    };
    (0..outline.vertices().len()).any(|i| {
        let (a, b) = outline.edge(i);
        let (a, b) = (local(a), local(b));
        // The part of the edge, from 0 to 1, between each two sides (Liang and Barsky 1984).
        let mut part = [0.0f64, 1.0];
        for k in 0..2 {
            let step = b[k] - a[k];
            if step == 0.0 {
                if a[k].abs() >= half[k] {
                    return false;
                }
                continue;
            }
            let ends = [(-half[k] - a[k]) / step, (half[k] - a[k]) / step];
            part = [
                part[0].max(ends[0].min(ends[1])),
                part[1].min(ends[0].max(ends[1])),
            ];
        }
        part[0] < part[1]
    })
}

impl CellBounds for CuboidBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let (form, remainder, weights) = self.dipoles.far::<true>(cell);
        let (energy, gradient) = self.level.run(Correction {
            potential: &self.potential,
            q: &cell.centre,
            weights: &weights,
            stride: self.dipoles.stride(),
        });
        let mut out = Enclosure::of_order(3.0, form, remainder);
        out.form.value += energy;
        for (total, share) in out.form.gradient.iter_mut().zip(gradient.iter()) {
            *total += share;
        }
        out.work = A_CELL + A_PAIR * (self.fixed.len() * self.moving.len()) as u64;
        let mut nodes = None;
        for (i, j) in self.dipoles.near(&weights) {
            let nodes = nodes.get_or_insert_with(Nodes::new);
            self.add_near(&mut out, cell, i, j, nodes);
            out.work += A_NEAR_PAIR;
        }
        out.work += A_NODE * nodes.map_or(0, |nodes| nodes.all);
        out
    }

    fn energy(&self, q: &Configuration) -> f64 {
        self.potential.energy(q)
    }

    fn work(&self) -> u64 {
        CELLS_OF_DIPOLES * self.dipoles.work()
    }
}

impl CuboidBounds {
    /// Adds the pair of the fixed block `i` and the moving block `j`.
    fn add_near(&self, out: &mut Enclosure, cell: &Cell, i: usize, j: usize, nodes: &mut Nodes) {
        let (fixed, moving) = (&self.fixed[i], &self.moving[j]);
        let first = &fixed.block;
        let (sin, cos) = libm::sincos(cell.centre.theta);
        let second = moving.block.moved(cos, sin, cell.centre.position());
        let moment = (MU0_OVER_4PI * first.moment * second.moment).abs();
        if moment == 0.0 {
            return;
        }
        let reach = cell.reach(moving.block.position.norm() + second.radius());
        let apart = Apart::of(self.level, [first, &second], [reach, cell.half[2]]);
        let most = apart.map_or(f64::INFINITY, |apart| apart.energy);
        let most = most.min(fixed.own * moving.own) * (1.0 + ROUNDING);
        let motion = CellMotion {
            arm: second.position - cell.centre.position(),
            reach,
            sides: Vector2::new(cell.half[0], cell.half[1]),
            turn: cell.half[2],
            apart: fixed.inside && moving.inside,
            slack: self.slack,
        };
        let is_coarse = apart.is_some_and(|apart| apart.is_coarse);
        let useful = apart.filter(|apart| apart.remainder < most);
        let by_faces = (useful.is_some() || !is_coarse)
            .then(|| {
                faces(
                    self.level,
                    [first, &second],
                    &motion,
                    useful.as_ref(),
                    nodes,
                )
            })
            .filter(|(_, left)| left.spread < most);
        let left = by_faces.map_or_else(
            || {
                let steepest = self.potential.limits(i, j).gradient(0.0, 0.0);
                let strength = (first.moment * second.moment).abs();
                let slope = strength * steepest * reach * (1.0 + ROUNDING);
                Left {
                    spread: most,
                    slope: apart.map_or(slope, |apart| slope.min(apart.slope)),
                    ..Left::default()
                }
            },
            |(totals, left)| {
                out.form = out.form.minus(-1.0, &in_the_plane(&totals, first.axis));
                left
            },
        );
        out.low -= left.spread;
        out.high += left.spread;
        out.slope += left.slope;
        out.jump += left.jump;
    }
}

/// The form of totals in the frame whose first axis is `axis`.
fn in_the_plane(totals: &Totals, axis: Vector2<f64>) -> Quadratic {
    let (c, s) = (axis.x, axis.y);
    let turned = |u: f64, v: f64| [c * u - s * v, s * u + c * v];
    let [uu, vv, tt, uv, ut, vt] = totals.hessian;
    let [u, v, turn] = totals.gradient;
    let [x, y] = turned(u, v);
    let [xt, yt] = turned(ut, vt);
    Quadratic {
        value: totals.value,
        gradient: [x, y, turn],
        hessian: [
            c * c * uu - 2.0 * c * s * uv + s * s * vv,
            s * s * uu + 2.0 * c * s * uv + c * c * vv,
            tt,
            c * s * (uu - vv) + (c * c - s * s) * uv,
            xt,
            yt,
        ],
    }
}
