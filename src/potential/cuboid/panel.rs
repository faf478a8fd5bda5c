//! The quadrature over a pair of blocks: panels on the second block's pole faces.

use nalgebra::{Vector2, Vector3};

use super::block::BlockPair;
use super::quadrature::{Fineness, Rule, Rules, panels};
use super::sheet::potential;
use crate::potential::batch::lanes::Lanes;

/// Distances from a sheet below this share of its width count as touching.
const TOUCHING: f64 = 1e-10;

/// The panels for the energy: cut at the corners' feet only. The integrand is of the kind
/// `s^2 ln s` there at worst, for which sixteen nodes give some 1e-7.
const FOR_ENERGY: Fineness = Fineness::new(1.0);

/// The panels for the gradient, whose integrand has a step near the first sheet's edges.
const FOR_GRADIENT: Fineness = Fineness::new(0.02);

/// A piece of a pole face of the second block, in the coordinates of a pole face of the first.
/// What varies along it is linear in a coordinate u in [-1, 1].
#[derive(Clone, Copy, Debug)]
pub struct Panel {
    rule: Rule,
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
        coarse |= panels(half, corners, fineness, &mut |start, end, rule| {
            let (middle, half) = ((start + end) / 2.0, (end - start) / 2.0);
            list.push(Panel {
                rule,
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
        let (nodes, weights): (&[f64], &[f64]) = match panel.rule {
            Rule::Eight => (&rules.eight[0], &rules.eight[1]),
            Rule::Sixteen => (&rules.sixteen[0], &rules.sixteen[1]),
            Rule::CrowdedEight => (&rules.crowded_eight[0], &rules.crowded_eight[1]),
            Rule::CrowdedSixteen => (&rules.crowded_sixteen[0], &rules.crowded_sixteen[1]),
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

#[cfg(test)]
mod tests {
    use super::super::block::Block;
    use super::*;
    use crate::potential::batch::Level;
    use crate::potential::batch::lanes::Task;
    use rand::{RngExt, SeedableRng};
    use std::f64::consts::{FRAC_PI_2, PI};

    struct Job<'a>(&'a BlockPair, Option<Fineness>);

    impl Task for Job<'_> {
        type Output = (f64, Vector3<f64>);

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Self::Output {
            let mut panels = Panels::default();
            match self.1 {
                None => panels.append::<L, true>(l, self.0),
                Some(fineness) => {
                    panels.closed = self.0.closed_gradient(l);
                    let steep = self.0.is_steep();
                    append(
                        self.0,
                        fineness,
                        if steep {
                            &mut panels.energy
                        } else {
                            &mut panels.both
                        },
                    );
                }
            }
            panels.sum::<L, true>(l)
        }
    }

    /// Panels so fine that nothing is left to gain.
    const FINE: Fineness = Fineness {
        finest: 1e-9,
        eight: 11.0,
        sixteen: 1.9,
    };

    /// A block at the origin and one whose nearest corner or side is `gap` beyond the first one's
    /// pole face, turned by `angle` and slid along that face.
    fn pair(size: [f64; 3], gap: f64, angle: f64, slide: f64) -> BlockPair {
        let first = Block::new(0.3, [0.010, 0.010, 0.003]);
        let reach = (size[0] * angle.cos().abs() + size[1] * angle.sin().abs()) / 2.0;
        let second = Block {
            position: Vector2::new(0.005 + gap + reach, slide),
            axis: Vector2::new(angle.cos(), angle.sin()),
            ..Block::new(0.3, size)
        };
        BlockPair::new(&first, &second, second.position)
    }

    #[test]
    fn the_panels_keep_the_stated_accuracy_at_every_gap_and_angle() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for gap in [0.0, 1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2] {
            let tolerance = if gap < 1e-3 { 1e-4 } else { 1e-6 };
            for tilt in [0.0, 1e-3, 0.03, 0.3, 0.7, 1.2, FRAC_PI_2] {
                for trial in 0..60 {
                    let slide = match trial % 6 {
                        0 => 0.0,
                        1 => 0.010,
                        _ => rng.random_range(-0.012..0.012),
                    };
                    let sign = if trial % 2 == 0 { 1.0 } else { -1.0 };
                    let turn = if trial % 3 == 0 { PI } else { 0.0 };
                    let size = [[0.010, 0.010, 0.003], [0.008, 0.007, 0.005]][trial / 3 % 2];
                    let pair = pair(size, gap, sign * tilt + turn, slide);
                    let level = Level::best();
                    let (energy, gradient) = level.run(Job(&pair, None));
                    let (fine, slope) = level.run(Job(&pair, Some(FINE)));
                    // Relative to the force where sliding takes the energy through zero.
                    let force = slope.xy().norm();
                    let scale = fine.abs().max(0.001 * force);
                    let at = format!("{size:?}, gap {gap}, tilt {tilt}, slide {slide}");
                    assert!((energy - fine).abs() < tolerance * scale, "{at}");
                    let off = gradient - slope;
                    assert!(off.xy().norm() < tolerance * force, "{at}");
                    assert!(off.z.abs() < tolerance * 0.01 * force, "{at}");
                }
            }
        }
    }
}
