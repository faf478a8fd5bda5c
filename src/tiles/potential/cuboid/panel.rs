//! The quadrature for pairs of blocks: nodes on the second block's pole faces.

use nalgebra::{Vector2, Vector3};

use super::block::{Block, BlockPair, Faces};
use super::quadrature::{Fineness, MOST, Panel, RULES, Rule, panels};
use super::sheet::{potential, subtended};
use crate::potential::far::PairEnergy;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// The energy (J) of pairs of blocks that have the same sizes and stand at the same angle to each
/// other, and its gradient if requested. This is the only place that instantiates the quadrature,
/// which takes long to compile. At least one pair.
pub struct Near<'a, const SLOPE: bool> {
    pairs: &'a [BlockPair],
    fineness: Fineness,
}

impl<'a, const SLOPE: bool> Near<'a, SLOPE> {
    /// The sum for these pairs, with the accuracy stated for energies.
    pub fn of(pairs: &'a [BlockPair]) -> Self {
        Self {
            pairs,
            fineness: Fineness::NORMAL,
        }
    }
}

impl<const SLOPE: bool> Task for Near<'_, SLOPE> {
    type Output = (f64, Vector3<f64>);

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let mut quadrature = Quadrature::new(l, &self.pairs[0], self.fineness);
        for pair in self.pairs {
            quadrature.add::<L, SLOPE>(l, pair);
        }
        quadrature.sum::<L, SLOPE>(l)
    }
}

/// The energy of two blocks and its derivatives by their pole faces, however far apart they are:
/// exact nearby, while far away (beyond about thirty times their size) digits are lost to
/// cancellation.
pub fn exact(first: &Block, second: &Block) -> PairEnergy {
    near::<true>(Level::best(), first, second)
}

/// [`exact`] for the given instruction set; the derivatives are zero unless requested.
pub fn near<const SLOPE: bool>(level: Level, first: &Block, second: &Block) -> PairEnergy {
    let pair = BlockPair::new(first, second, second.position);
    let (energy, gradient) = level.run(Near::<SLOPE>::of(&[pair]));
    PairEnergy {
        energy,
        gradient: gradient.xy(),
        slope: gradient.z,
    }
}

/// Number of nodes collected before they are evaluated.
const BATCH: usize = 64;

/// Room for a batch, for the rule that completes it, and for padding the last vector.
const ROOM: usize = BATCH + MOST + WIDTH;

/// The quadrature over pairs of blocks that have the same sizes and stand at the same angle to
/// each other, in the coordinates of a pole face of the first block (see [`super::sheet`]).
///
/// Nodes of all panels follow each other without gaps, so that vectors are full for rules of any
/// length.
struct Quadrature<F> {
    fineness: Fineness,
    rules: &'static [Rule],
    panels: Vec<Panel>,
    /// Half the width of the first blocks' pole faces (m), and half the sum and half the
    /// difference of the thicknesses.
    half_width: f64,
    heights: [f64; 2],
    /// The direction of h.
    normal: Vector2<f64>,
    /// Whether the gradient follows from the energy and closed forms alone, and the energy's
    /// contribution to the derivative by theta in that case.
    is_steep: bool,
    by_energy: f64,
    /// Number of collected nodes, their places (m), weights (J/m^2), and the levers of a force
    /// along h about the moving tile's reference point (m).
    count: usize,
    x: [f64; ROOM],
    h: [f64; ROOM],
    weight: [f64; ROOM],
    lever: [f64; ROOM],
    energy: F,
    gradient: [F; 3],
}

impl<F: Copy> Quadrature<F> {
    /// For pairs like this one.
    #[inline(always)]
    fn new<L: Lanes<F = F>>(l: L, pair: &BlockPair, fineness: Fineness) -> Self {
        Self {
            fineness,
            rules: &RULES[..],
            panels: Vec::with_capacity(8),
            half_width: pair.widths[0] / 2.0,
            heights: pair.heights,
            normal: -pair.axis,
            is_steep: pair.is_steep(),
            by_energy: pair.by_energy(),
            count: 0,
            x: [0.0; ROOM],
            h: [0.0; ROOM],
            weight: [0.0; ROOM],
            lever: [0.0; ROOM],
            energy: l.splat(0.0),
            gradient: [l.splat(0.0); 3],
        }
    }

    /// Adds a pair of blocks.
    #[inline(always)]
    fn add<L: Lanes<F = F>, const SLOPE: bool>(&mut self, l: L, pair: &BlockPair) {
        let faces = pair.all_faces();
        if SLOPE {
            pair.add_closed_gradient(l, &faces, &mut self.gradient);
        }
        let axes = self.axes(l, pair, &faces);
        let half = pair.widths[1] / 2.0;
        for (face, axis) in faces.iter().zip(axes) {
            if let Some(rule) = self.fineness.rule(axis) {
                let (start, end) = (-half, half);
                self.put::<L, SLOPE>(l, pair, face, Panel { start, end, rule });
                continue;
            }
            self.panels.clear();
            panels(half, &face.corners(pair), &self.fineness, &mut self.panels);
            for i in 0..self.panels.len() {
                self.put::<L, SLOPE>(l, pair, face, self.panels[i]);
            }
        }
    }

    /// The long axes of the four pole faces as panels (see [`panels`]).
    #[inline(always)]
    fn axes<L: Lanes<F = F>>(&self, l: L, pair: &BlockPair, faces: &[Faces; 4]) -> [f64; 4] {
        let (mut x, mut h) = ([0.0; WIDTH], [0.0; WIDTH]);
        for (i, face) in faces.iter().enumerate() {
            x[2 * i] = face.x + self.half_width;
            x[2 * i + 1] = face.x - self.half_width;
            (h[2 * i], h[2 * i + 1]) = (face.h, face.h);
        }
        let half = l.splat(pair.widths[1] / 2.0);
        let [foot, height] = pair.foot(l, [l.load(&x), l.load(&h)]);
        let square = l.mul(height, height);
        let (a, b) = (l.sub(foot, half), l.add(foot, half));
        let start = l.sqrt(l.mul_add(a, a, square));
        let end = l.sqrt(l.mul_add(b, b, square));
        let mut sums = [0.0; WIDTH];
        l.store(l.add(start, end), &mut sums);
        let width = 1.0 / pair.widths[1];
        let mut axes = [0.0; 4];
        for (i, face) in faces.iter().enumerate() {
            axes[i] = sums[2 * i].min(sums[2 * i + 1]) * width;
            if let Some(t) = face.passage(pair) {
                axes[i] = axes[i].min((2.0 * t.abs() * width).max(1.0));
            }
        }
        axes
    }

    /// Appends the nodes of a panel on a pole face of the second block.
    #[inline(always)]
    fn put<L: Lanes<F = F>, const SLOPE: bool>(
        &mut self,
        l: L,
        pair: &BlockPair,
        face: &Faces,
        panel: Panel,
    ) {
        let (middle, half) = (
            (panel.start + panel.end) / 2.0,
            (panel.end - panel.start) / 2.0,
        );
        // Phi is twice what `potential` gives.
        let weight = l.splat(2.0 * face.sign * pair.strength * half);
        let lever = (pair.arm + face.offset).perp(&self.normal);
        let turn = pair.direction.perp(&self.normal);
        let rule = &self.rules[panel.rule];
        for from in (0..rule.count).step_by(WIDTH) {
            let at = self.count + from;
            let t = l.mul_add(l.load(&rule.nodes[from..]), l.splat(half), l.splat(middle));
            let x = l.mul_add(t, l.splat(pair.cos), l.splat(face.x));
            let h = l.mul_add(t, l.splat(pair.sin), l.splat(face.h));
            l.store(x, &mut self.x[at..]);
            l.store(h, &mut self.h[at..]);
            l.store(
                l.mul(l.load(&rule.weights[from..]), weight),
                &mut self.weight[at..],
            );
            if SLOPE {
                let lever = l.mul_add(t, l.splat(turn), l.splat(lever));
                l.store(lever, &mut self.lever[at..]);
            }
        }
        self.count += rule.count;
        if self.count >= BATCH {
            self.evaluate::<L, SLOPE>(l);
        }
    }

    /// Adds up the collected nodes, except those that do not fill a vector.
    #[inline(always)]
    fn evaluate<L: Lanes<F = F>, const SLOPE: bool>(&mut self, l: L) {
        let whole = self.count / WIDTH * WIDTH;
        if SLOPE && self.is_steep {
            self.evaluate_vectors::<L, true, false>(l, whole);
        } else {
            self.evaluate_vectors::<L, false, SLOPE>(l, whole);
        }
        for list in [&mut self.x, &mut self.h, &mut self.weight, &mut self.lever] {
            l.store(l.load(&list[whole..]), list);
        }
        self.count -= whole;
    }

    /// Adds up the energy and, from it (`TURN`) or from the forces along h (`FORCE`), the gradient.
    #[inline(always)]
    fn evaluate_vectors<L: Lanes<F = F>, const TURN: bool, const FORCE: bool>(
        &mut self,
        l: L,
        count: usize,
    ) {
        let half = l.splat(self.half_width);
        for from in (0..count).step_by(WIDTH) {
            let (x, h) = (l.load(&self.x[from..]), l.load(&self.h[from..]));
            let weight = l.load(&self.weight[from..]);
            let s = [l.sub(x, half), l.add(x, half)];
            let (phi, slope) = potential(l, s, h, self.heights);
            let energy = l.mul(weight, phi);
            self.energy = l.add(self.energy, energy);
            let [x, y, turn] = self.gradient;
            if TURN {
                let turn = l.mul_add(energy, l.splat(self.by_energy), turn);
                self.gradient = [x, y, turn];
            }
            if FORCE {
                // The part in closed form is omitted, and Phi_h has the opposite sign of h.
                let high = l.splat(self.heights[0] - self.heights[1]);
                let rest = l.mul(weight, l.neg_mul_add(high, subtended(l, s, h), slope));
                let rest = l.select(h, l.sub(l.splat(0.0), rest), rest);
                let lever = l.load(&self.lever[from..]);
                self.gradient = [
                    l.mul_add(rest, l.splat(self.normal.x), x),
                    l.mul_add(rest, l.splat(self.normal.y), y),
                    l.mul_add(rest, lever, turn),
                ];
            }
        }
    }

    /// The energy and, if requested, the gradient of everything added.
    #[inline(always)]
    fn sum<L: Lanes<F = F>, const SLOPE: bool>(mut self, l: L) -> (f64, Vector3<f64>) {
        // Nodes without weight pad the last vector.
        l.store(l.splat(0.0), &mut self.weight[self.count..]);
        l.store(l.splat(0.0), &mut self.x[self.count..]);
        l.store(l.splat(self.half_width), &mut self.h[self.count..]);
        self.count = self.count.next_multiple_of(WIDTH);
        self.evaluate::<L, SLOPE>(l);
        let [x, y, turn] = self.gradient;
        let gradient = if SLOPE {
            Vector3::new(l.sum(x), l.sum(y), l.sum(turn))
        } else {
            Vector3::zeros()
        };
        (l.sum(self.energy), gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::cuboid::cloud;
    use crate::units::{MU0, MU0_OVER_4PI};
    use rand::{RngExt, SeedableRng};
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Panels so fine that finer ones change nothing.
    const FINE: Fineness = Fineness {
        finest: 1e-9,
        axes: [
            f64::INFINITY,
            f64::INFINITY,
            f64::INFINITY,
            f64::INFINITY,
            11.0,
            11.0,
            11.0,
            11.0,
            1.9,
        ],
    };

    /// A block at the origin and one whose nearest corner or side is `gap` beyond the first one's
    /// pole face, turned by `angle` and slid along that face.
    fn pair(size: [f64; 3], gap: f64, angle: f64, slide: f64) -> BlockPair {
        let first = Block::new(0.3, [0.010, 0.010, 0.003]);
        let reach = (size[0] * libm::cos(angle).abs() + size[1] * libm::sin(angle).abs()) / 2.0;
        let second = Block {
            position: Vector2::new(0.005 + gap + reach, slide),
            axis: Vector2::new(libm::cos(angle), libm::sin(angle)),
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
                    let pairs = &[pair];
                    let (energy, gradient) = level.run(Near::<true>::of(pairs));
                    let fineness = FINE;
                    let (fine, slope) = level.run(Near::<true> { pairs, fineness });
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

    fn block(x: f64, y: f64, angle: f64, size: [f64; 3], remanence: f64) -> Block {
        Block {
            position: Vector2::new(x, y),
            axis: Vector2::new(libm::cos(angle), libm::sin(angle)),
            moment: remanence * size.iter().product::<f64>() / MU0,
            size,
        }
    }

    const SIZE: [f64; 3] = [0.010, 0.012, 0.003];
    const OTHER: [f64; 3] = [0.006, 0.008, 0.005];

    /// The derivatives by x, y and the angle, from central differences of the given steps.
    fn differences(at: impl Fn(f64, f64, f64) -> f64, h: f64, a: f64) -> [f64; 3] {
        [
            (at(h, 0.0, 0.0) - at(-h, 0.0, 0.0)) / (2.0 * h),
            (at(0.0, h, 0.0) - at(0.0, -h, 0.0)) / (2.0 * h),
            (at(0.0, 0.0, a) - at(0.0, 0.0, -a)) / (2.0 * a),
        ]
    }

    #[test]
    fn the_gradient_is_the_derivative_of_the_energy() {
        let first = block(0.0, 0.0, 0.3, SIZE, 1.2);
        for (x, y, angle) in [
            (0.02, 0.004, 0.4),
            (0.013, 0.001, 0.35),
            (0.0, 0.015, 1.8),
            (-0.016, 0.003, -2.7),
            (0.04, 0.03, 2.0),
        ] {
            for size in [SIZE, OTHER] {
                let at = |dx: f64, dy: f64, da: f64| {
                    exact(&first, &block(x + dx, y + dy, angle + da, size, 0.9)).energy
                };
                let pair = exact(&first, &block(x, y, angle, size, 0.9));
                let fd = differences(at, 1e-6, 1e-4);
                let scale = pair.gradient.norm();
                assert!((pair.gradient.x - fd[0]).abs() < 1e-6 * scale);
                assert!((pair.gradient.y - fd[1]).abs() < 1e-6 * scale);
                assert!((pair.slope - fd[2]).abs() < 1e-6 * scale * 0.01);
                assert!((at(0.0, 0.0, 0.0) - pair.energy).abs() < 1e-13 * pair.energy.abs());
            }
        }
    }

    #[test]
    fn the_gradient_is_the_derivative_where_faces_pass_through_each_others_lines() {
        let first = block(0.0, 0.0, 0.3, SIZE, 1.2);
        // Overlapping to both sides, and beside each other.
        for (x, y, angle) in [
            (0.009, 0.002, 0.4),
            (0.008, -0.003, 0.1),
            (-0.007, 0.004, 0.7),
            (-0.009, -0.001, 0.3 + 2.9),
            (-0.004, 0.013, 0.5),
            (0.004, -0.014, 0.9),
            (0.003, -0.013, -0.2),
        ] {
            let at = |dx: f64, dy: f64, da: f64| {
                exact(&first, &block(x + dx, y + dy, angle + da, OTHER, 0.9)).energy
            };
            let pair = exact(&first, &block(x, y, angle, OTHER, 0.9));
            let fd = differences(at, 2e-5, 2e-3);
            let scale = pair.gradient.norm();
            assert!((pair.gradient.x - fd[0]).abs() < 3e-4 * scale, "{x} {y}");
            assert!((pair.gradient.y - fd[1]).abs() < 3e-4 * scale, "{x} {y}");
            assert!((pair.slope - fd[2]).abs() < 3e-4 * scale * 0.01, "{x} {y}");
        }
    }

    #[test]
    fn the_pole_faces_agree_with_a_cloud_of_charges() {
        let first = block(0.0, 0.0, 0.3, SIZE, 1.2);
        for i in 0..60 {
            let (direction, distance) = (0.37 * i as f64, 0.022 + 0.0004 * i as f64);
            let (x, y) = (
                distance * libm::cos(direction),
                distance * libm::sin(direction),
            );
            let second = block(
                x,
                y,
                1.7 * i as f64,
                if i % 2 == 0 { SIZE } else { OTHER },
                0.9,
            );
            let got = exact(&first, &second);
            let cloud = cloud::energy_and_gradient::<16>(&first, &second);
            let scale = MU0_OVER_4PI * first.moment * second.moment / distance.powi(3);
            assert!((got.energy - cloud.energy).abs() < 1e-8 * scale);
            assert!((got.gradient - cloud.gradient).norm() < 1e-7 * scale / distance);
            assert!((got.slope - cloud.slope).abs() < 1e-7 * scale);
        }
    }
}
