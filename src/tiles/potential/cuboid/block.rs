//! A pair of uniformly magnetised blocks: four pairs of charge sheets.

use nalgebra::Vector2;

use super::quadrature::{Corner, NO_CORNER};
use crate::tile::Magnet;
use crate::units::MU0_OVER_4PI;

/// A uniformly magnetised block that stands on the tiles' plane, in the frame in use.
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
            axis: Vector2::new(libm::cos(magnet.angle), libm::sin(magnet.angle)),
            moment: magnet.moment,
            size: magnet.size,
        }
    }
}

impl Block {
    /// A block at the origin with its axis along x, of a moment (A m^2) and a size (m).
    pub fn new(moment: f64, size: [f64; 3]) -> Self {
        Self {
            position: Vector2::zeros(),
            axis: Vector2::x(),
            moment,
            size,
        }
    }

    /// A block of 0.3 A m^2 at a place (m) with its axis in a direction (rad), for tests.
    #[cfg(test)]
    pub fn placed([x, y]: [f64; 2], angle: f64, size: [f64; 3]) -> Self {
        Self {
            position: Vector2::new(x, y),
            axis: Vector2::new(libm::cos(angle), libm::sin(angle)),
            ..Self::new(0.3, size)
        }
    }

    /// The block moved by a rotation (cos, sin) and a shift.
    pub fn moved(&self, cos: f64, sin: f64, shift: Vector2<f64>) -> Self {
        let turn = |v: Vector2<f64>| Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y);
        Self {
            position: turn(self.position) + shift,
            axis: turn(self.axis),
            ..*self
        }
    }

    /// Half the diagonal in the plane (m).
    pub fn radius(&self) -> f64 {
        libm::hypot(self.size[0], self.size[1]) / 2.0
    }

    /// The unit vector across the axis, a quarter turn counter-clockwise from it: the direction
    /// of the pole faces.
    fn across(&self) -> Vector2<f64> {
        Vector2::new(-self.axis.y, self.axis.x)
    }
}

/// Two blocks as four pairs of pole faces, all at the same angle. Coordinates are those of the
/// first block's pole faces: x along them, h against the axis (see [`super::sheet`]).
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockPair {
    /// Widths of the pole faces (m).
    pub widths: [f64; 2],
    /// Half the sum and half the difference of the thicknesses (m).
    pub heights: [f64; 2],
    /// `mu0 / (4 pi)` times the product of the charge densities (J/m^3).
    pub strength: f64,
    /// The first block's axis.
    pub axis: Vector2<f64>,
    /// The direction of the second block's pole faces, in the plane and in coordinates.
    pub direction: Vector2<f64>,
    pub cos: f64,
    pub sin: f64,
    /// 1 / sin, infinite where the faces are parallel.
    pub inverse_sin: f64,
    /// The second block's centre relative to the point about which it turns (m).
    pub arm: Vector2<f64>,
    /// Vector from the first block's centre to the second one's (m).
    way: Vector2<f64>,
    /// Half the blocks' lengths along their axes (m).
    half_lengths: [f64; 2],
    second_axis: Vector2<f64>,
}

/// A pole face of the first block and one of the second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faces {
    /// The product of the two poles' signs.
    pub sign: f64,
    /// The second face's centre relative to its block's centre (m).
    pub offset: Vector2<f64>,
    /// The second face's centre in the first one's coordinates (m).
    pub x: f64,
    pub h: f64,
    /// The sign of h inside the second block.
    pub side: f64,
}

impl Faces {
    /// Where the first face's edges project onto the second face's line, and their distances from
    /// that line; and where that line passes through the first face, if it does.
    #[inline(always)]
    pub fn corners(&self, pair: &BlockPair) -> [Corner; 3] {
        let half = pair.widths[0] / 2.0;
        let edge = |place: f64| {
            let (dx, dh) = (place - self.x, -self.h);
            (
                dx * pair.cos + dh * pair.sin,
                (dh * pair.cos - dx * pair.sin).abs(),
            )
        };
        [
            edge(-half),
            edge(half),
            self.passage(pair).map_or(NO_CORNER, |t| (t, 0.0)),
        ]
    }

    /// Where the second face's line passes through the first face, if it does.
    #[inline(always)]
    pub fn passage(&self, pair: &BlockPair) -> Option<f64> {
        let t = -self.h * pair.inverse_sin;
        ((self.x + t * pair.cos).abs() < pair.widths[0] / 2.0).then_some(t)
    }
}

impl BlockPair {
    /// The pair of two blocks, the second of which turns about the point `centre`.
    #[inline(always)]
    pub fn new(first: &Block, second: &Block, centre: Vector2<f64>) -> Self {
        let density =
            |block: &Block| block.moment / (block.size[0] * block.size[1] * block.size[2]);
        Self {
            widths: [first.size[1], second.size[1]],
            heights: [
                (first.size[2] + second.size[2]) / 2.0,
                (first.size[2] - second.size[2]).abs() / 2.0,
            ],
            strength: MU0_OVER_4PI * density(first) * density(second),
            axis: first.axis,
            direction: second.across(),
            cos: first.axis.dot(&second.axis),
            sin: first.axis.perp(&second.axis),
            inverse_sin: 1.0 / first.axis.perp(&second.axis),
            arm: second.position - centre,
            way: second.position - first.position,
            half_lengths: [first.size[0] / 2.0, second.size[0] / 2.0],
            second_axis: second.axis,
        }
    }

    /// The four pairs of pole faces.
    #[inline(always)]
    pub fn all_faces(&self) -> [Faces; 4] {
        [self.faces(0), self.faces(1), self.faces(2), self.faces(3)]
    }

    /// The pair of pole faces with this number, 0 to 3.
    #[inline(always)]
    fn faces(&self, number: usize) -> Faces {
        let sign1 = if number < 2 { 1.0 } else { -1.0 };
        let sign2 = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        let offset = self.second_axis * (sign2 * self.half_lengths[1]);
        let from = self.way - self.axis * (sign1 * self.half_lengths[0]);
        let middle = from + offset;
        Faces {
            sign: sign1 * sign2,
            offset,
            x: self.axis.perp(&middle),
            h: -self.axis.dot(&middle),
            side: if self.axis.dot(&from) < 0.0 {
                1.0
            } else {
                -1.0
            },
        }
    }

    /// Whether the faces are closer to perpendicular than to parallel.
    #[inline(always)]
    pub fn is_steep(&self) -> bool {
        self.sin.abs() > std::f64::consts::FRAC_1_SQRT_2
    }

    /// The energy's contribution to the derivative by the angle, for steep faces.
    #[inline(always)]
    pub fn by_energy(&self) -> f64 {
        if self.is_steep() {
            -self.cos * self.inverse_sin
        } else {
            0.0
        }
    }
}
