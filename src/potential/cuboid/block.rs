//! A pair of uniformly magnetised blocks: four pairs of charge sheets.

use nalgebra::Vector2;

use super::sheet::{ENERGY, GRADIENT, SheetPair};
use crate::potential::batch::Level;
use crate::potential::batch::lanes::{Lanes, Task};
use crate::tile::Magnet;
use crate::units::MU0;

/// A uniformly magnetised block, standing on the tiles' plane, in whatever frame is in use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Centre (m).
    pub position: Vector2<f64>,
    /// Unit vector of the magnetic axis.
    pub axis: Vector2<f64>,
    /// Moment (A m^2).
    pub moment: f64,
    /// Size along the axis, across it in the plane, and through the thickness (m).
    pub size: [f64; 3],
}

impl From<&Magnet> for Block {
    fn from(magnet: &Magnet) -> Self {
        Self {
            position: magnet.position,
            axis: Vector2::new(magnet.angle.cos(), magnet.angle.sin()),
            moment: magnet.moment,
            size: magnet.size,
        }
    }
}

impl Block {
    /// The block moved by a rotation (cos, sin) and a shift.
    pub fn moved(&self, cos: f64, sin: f64, shift: Vector2<f64>) -> Self {
        let turn = |v: Vector2<f64>| Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y);
        Self {
            position: turn(self.position) + shift,
            axis: turn(self.axis),
            ..*self
        }
    }

    /// The unit vector across the axis, a quarter turn counter-clockwise from it: the direction
    /// of the pole faces.
    fn across(&self) -> Vector2<f64> {
        Vector2::new(-self.axis.y, self.axis.x)
    }
}

/// Energy (J) of two blocks, its gradient by the second block's centre (J/m) and its derivative
/// by the second block's angle about its own centre (J/rad).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairEnergy {
    pub energy: f64,
    pub gradient: Vector2<f64>,
    pub slope: f64,
}

/// The four pairs of pole faces: the product of the two poles' signs, the position of the second
/// block's pole face relative to its centre, and the sheets.
#[inline(always)]
fn sheet_pairs(first: &Block, second: &Block) -> [(f64, Vector2<f64>, SheetPair); 4] {
    let across = first.across();
    let r = second.position - first.position;
    let cos = first.axis.dot(&second.axis);
    let sin = first.axis.perp(&second.axis);
    [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(sign1, sign2)| {
            let offset = second.axis * (sign2 * second.size[0] / 2.0);
            let from = first.axis * (sign1 * first.size[0] / 2.0);
            let centre = r + offset - from;
            let side = if (r - from).dot(&first.axis) < 0.0 {
                1.0
            } else {
                -1.0
            };
            let pair = SheetPair {
                widths: [first.size[1], second.size[1]],
                heights: [
                    (first.size[2] + second.size[2]) / 2.0,
                    (first.size[2] - second.size[2]).abs() / 2.0,
                ],
                x: centre.dot(&across),
                h: -centre.dot(&first.axis),
                cos,
                sin,
                side,
            };
            (sign1 * sign2, offset, pair)
        })
}

/// `mu0 / (4 pi)` times the two charge densities (J/m^3).
fn strength(first: &Block, second: &Block) -> f64 {
    let density = |block: &Block| block.moment / block.size.iter().product::<f64>();
    MU0 / (4.0 * std::f64::consts::PI) * density(first) * density(second)
}

/// The energy (J) of two blocks by their pole faces.
#[inline(always)]
pub fn energy<L: Lanes>(l: L, first: &Block, second: &Block) -> f64 {
    let mut sum = 0.0;
    for (sign, _, pair) in sheet_pairs(first, second) {
        sum += sign * pair.energy(l, ENERGY);
    }
    strength(first, second) * sum
}

/// The energy of two blocks and its derivatives, by their pole faces.
#[inline(always)]
pub fn energy_and_gradient<L: Lanes>(l: L, first: &Block, second: &Block) -> PairEnergy {
    let across = first.across();
    let mut total = PairEnergy::default();
    let strength = strength(first, second);
    for (sign, offset, pair) in sheet_pairs(first, second) {
        let sheet = pair.energy_and_gradient(l, ENERGY, GRADIENT);
        let gradient = (across * sheet.by_x - first.axis * sheet.by_h) * (sign * strength);
        total.energy += sign * strength * sheet.energy;
        total.gradient += gradient;
        total.slope += sign * strength * sheet.by_angle + offset.perp(&gradient);
    }
    total
}

/// Two blocks' energy and its derivatives by their pole faces, however far apart they are.
pub fn exact(first: &Block, second: &Block) -> PairEnergy {
    struct Exact<'a>(&'a Block, &'a Block);
    impl Task for Exact<'_> {
        type Output = PairEnergy;

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> PairEnergy {
            energy_and_gradient(l, self.0, self.1)
        }
    }
    Level::best().run(Exact(first, second))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::cuboid::cloud;

    fn block(x: f64, y: f64, angle: f64, size: [f64; 3], remanence: f64) -> Block {
        Block {
            position: Vector2::new(x, y),
            axis: Vector2::new(angle.cos(), angle.sin()),
            moment: remanence * size.iter().product::<f64>() / MU0,
            size,
        }
    }

    const SIZE: [f64; 3] = [0.010, 0.012, 0.003];
    const OTHER: [f64; 3] = [0.006, 0.008, 0.005];

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
                let (h, a) = (1e-6, 1e-4);
                let fd = [
                    (at(h, 0.0, 0.0) - at(-h, 0.0, 0.0)) / (2.0 * h),
                    (at(0.0, h, 0.0) - at(0.0, -h, 0.0)) / (2.0 * h),
                    (at(0.0, 0.0, a) - at(0.0, 0.0, -a)) / (2.0 * a),
                ];
                let scale = pair.gradient.norm();
                assert!((pair.gradient.x - fd[0]).abs() < 1e-6 * scale);
                assert!((pair.gradient.y - fd[1]).abs() < 1e-6 * scale);
                assert!((pair.slope - fd[2]).abs() < 1e-6 * scale * 0.01);
                assert!((at(0.0, 0.0, 0.0) - pair.energy).abs() < 1e-13 * pair.energy.abs());
            }
        }
    }

    #[test]
    fn the_pole_faces_agree_with_a_cloud_of_charges() {
        let first = block(0.0, 0.0, 0.3, SIZE, 1.2);
        for i in 0..60 {
            let (direction, distance) = (0.37 * i as f64, 0.022 + 0.0004 * i as f64);
            let (x, y) = (distance * direction.cos(), distance * direction.sin());
            let second = block(
                x,
                y,
                1.7 * i as f64,
                if i % 2 == 0 { SIZE } else { OTHER },
                0.9,
            );
            let got = exact(&first, &second);
            let cloud = cloud::energy_and_gradient::<16>(&first, &second);
            let scale = 1e-7 * first.moment * second.moment / distance.powi(3);
            assert!((got.energy - cloud.energy).abs() < 1e-8 * scale);
            assert!((got.gradient - cloud.gradient).norm() < 1e-7 * scale / distance);
            assert!((got.slope - cloud.slope).abs() < 1e-7 * scale);
        }
    }
}
