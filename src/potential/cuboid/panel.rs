//! The quadrature over a pair of blocks: panels on the second block's pole faces.

use nalgebra::{Vector2, Vector3};

use super::block::BlockPair;
use super::quadrature::{EIGHT, Fineness, Rules, panels};
use super::sheet::potential;
use crate::potential::batch::lanes::Lanes;

/// Distances from a sheet below this share of its width count as touching.
const TOUCHING: f64 = 1e-10;

/// The panels for the energy.
pub const FOR_ENERGY: Fineness = Fineness { finest: 0.125 };

/// The panels for the gradient, whose integrand has a step near the first sheet's edges.
pub const FOR_GRADIENT: Fineness = Fineness { finest: 0.02 };

/// A piece of a pole face of the second block, in the coordinates of a pole face of the first.
/// What varies along it is linear in a coordinate u in [-1, 1].
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    /// Whether eight nodes are enough; else it takes sixteen.
    eight: bool,
    /// Place (m) at u = 0, and its change with u.
    x: [f64; 2],
    h: [f64; 2],
    /// Half the first sheet's width (m), and half the sum and half the difference of the heights.
    half_width: f64,
    heights: [f64; 2],
    /// The sign of h where the second block's body lies.
    side: f64,
    /// The product of the charge densities and half the panel's width (J/m^2).
    weight: f64,
    /// The direction of h.
    normal: Vector2<f64>,
    /// The lever of a force along h about the moving tile's reference point (m), and its change
    /// with u.
    lever: [f64; 2],
    /// What the energy adds to the derivative by theta.
    by_energy: f64,
}

/// The panels of pairs of blocks, by what they are for, and the part of the gradient that needs
/// none.
#[derive(Debug, Default)]
pub struct Panels {
    energy: Vec<Panel>,
    gradient: Vec<Panel>,
    both: Vec<Panel>,
    closed: Vector3<f64>,
}

impl Panels {
    /// Adds a pair of blocks.
    #[inline(always)]
    pub fn append<L: Lanes, const SLOPE: bool>(&mut self, l: L, pair: &BlockPair) {
        if !SLOPE {
            append(pair, FOR_ENERGY, &mut self.energy);
            return;
        }
        self.closed += pair.closed_gradient(l);
        if pair.is_steep() {
            append(pair, FOR_ENERGY, &mut self.energy);
            return;
        }
        let before = self.both.len();
        if append(pair, FOR_ENERGY, &mut self.both) {
            self.energy.extend(self.both.drain(before..));
            append(pair, FOR_GRADIENT, &mut self.gradient);
        }
    }

    /// The energy and, if asked for, the gradient.
    #[inline(always)]
    pub fn sum<L: Lanes, const SLOPE: bool>(&self, l: L) -> (f64, Vector3<f64>) {
        let mut sums = Sums::zero(l);
        add::<L, true, false>(l, &self.energy, &mut sums);
        if SLOPE {
            add::<L, true, true>(l, &self.both, &mut sums);
            add::<L, false, true>(l, &self.gradient, &mut sums);
        }
        let [x, y, turn] = sums.gradient;
        let gradient = if SLOPE {
            self.closed + Vector3::new(l.sum(x), l.sum(y), l.sum(turn))
        } else {
            Vector3::zeros()
        };
        (l.sum(sums.energy), gradient)
    }
}

/// Appends the panels of all four pairs of pole faces. Returns whether some are coarser than the
/// gradient wants.
#[inline(always)]
fn append(pair: &BlockPair, fineness: Fineness, list: &mut Vec<Panel>) -> bool {
    let mut coarse = false;
    for number in 0..4 {
        let face = pair.faces(number);
        let half = pair.widths[1] / 2.0;
        let corners = [face.corner(pair, -1.0), face.corner(pair, 1.0)];
        let normal = -pair.axis;
        let lever = (pair.arm + face.offset).perp(&normal);
        let turn = pair.direction.perp(&normal);
        coarse |= panels(half, corners, fineness, &mut |start, end, eight| {
            let (middle, half) = ((start + end) / 2.0, (end - start) / 2.0);
            list.push(Panel {
                eight,
                x: [face.x + middle * pair.cos, half * pair.cos],
                h: [face.h + middle * pair.sin, half * pair.sin],
                half_width: pair.widths[0] / 2.0,
                heights: pair.heights,
                side: face.side,
                // Phi is twice what `potential` gives.
                weight: 2.0 * face.sign * pair.strength * half,
                normal,
                lever: [lever + middle * turn, half * turn],
                by_energy: pair.by_energy(),
            });
        });
    }
    coarse
}

/// Sums over panels: energy, gradient by the second block's place, and by theta.
#[derive(Clone, Copy)]
struct Sums<F> {
    energy: F,
    gradient: [F; 3],
}

impl<F: Copy> Sums<F> {
    #[inline(always)]
    fn zero<L: Lanes<F = F>>(l: L) -> Self {
        Self {
            energy: l.splat(0.0),
            gradient: [l.splat(0.0); 3],
        }
    }
}

/// Adds the panels' energy or the share of the gradient that comes from forces along h, or both.
#[inline(always)]
fn add<L: Lanes, const ENERGY: bool, const SLOPE: bool>(
    l: L,
    list: &[Panel],
    sums: &mut Sums<L::F>,
) {
    let rules = Rules::get();
    for panel in list {
        let (nodes, weights): (&[f64], &[f64]) = if panel.eight {
            (&rules.eight[0], &rules.eight[1])
        } else {
            (&rules.sixteen[0], &rules.sixteen[1])
        };
        let mut from = 0;
        while from < nodes.len() {
            let u = l.load(&nodes[from..]);
            let weight = l.mul(l.load(&weights[from..]), l.splat(panel.weight));
            let x = l.mul_add(u, l.splat(panel.x[1]), l.splat(panel.x[0]));
            let h = l.mul_add(u, l.splat(panel.h[1]), l.splat(panel.h[0]));
            let half = l.splat(panel.half_width);
            let (phi, slope) = potential(l, [l.sub(x, half), l.add(x, half)], h, panel.heights);
            if ENERGY {
                let energy = l.mul(weight, phi);
                sums.energy = l.add(sums.energy, energy);
                let turn = &mut sums.gradient[2];
                *turn = l.mul_add(energy, l.splat(panel.by_energy), *turn);
            }
            if SLOPE {
                let above = l.select(h, h, l.sub(l.splat(0.0), h));
                let clear = l.sub(above, l.splat(2.0 * TOUCHING * panel.half_width));
                let sign = l.select(clear, h, l.splat(panel.side));
                let weighted = l.mul(weight, slope);
                // Phi_h has the opposite sign of h.
                let weighted = l.select(sign, l.sub(l.splat(0.0), weighted), weighted);
                let lever = l.mul_add(u, l.splat(panel.lever[1]), l.splat(panel.lever[0]));
                let [x, y, turn] = sums.gradient;
                sums.gradient = [
                    l.mul_add(weighted, l.splat(panel.normal.x), x),
                    l.mul_add(weighted, l.splat(panel.normal.y), y),
                    l.mul_add(weighted, lever, turn),
                ];
            }
            from += L::WIDTH;
        }
    }
}
