//! Magnets of other kinds than lying blocks: discs, and what stands on its pole.
//!
//! Uniformly magnetised along its axis a magnet is two charged faces, of charge density m / V (A/m, the
//! moment over the volume); a pair of magnets is four pairs of faces, each the integral of `1 / r` over
//! both. Faces are discs or rectangles, upright (the axis lies in the tiles' plane) or flat (it stands on
//! it):
//!
//! | faces | integral | by |
//! |---|---|---|
//! | a disc and any | the other's potential along the disc's axis, at imaginary heights | [`line`] |
//! | two flat rectangles | over both boundaries | [`edges`] |
//! | two upright rectangles | closed forms in lanes | [`super::cuboid`] |
//! | an upright and a flat one | none: flat faces come in pairs, north and south, at the same distance over and under the tiles' middle plane, which an upright one sees alike | |

pub mod complex;
pub mod disc;
pub mod edges;
pub mod elliptic;
pub mod line;
mod panels;
pub mod rectangle;

use nalgebra::{Vector2, Vector3};

use complex::{C, sqrt};

/// A uniformly charged face.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Its middle (m).
    pub centre: Vector3<f64>,
    /// Unit vectors along its sides, and normal to it.
    pub frame: [Vector3<f64>; 3],
    pub shape: Shape,
}

/// The shape of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// With its radius (m).
    Disc(f64),
    /// With half its sides (m).
    Rectangle([f64; 2]),
}

/// The integral of `1 / r` over two faces (m^3), its gradient by the second one's middle in the tiles' plane
/// (m^2), and its derivative by the second one's angle about its own middle (m^3).
#[derive(Clone, Copy, Debug, Default)]
pub struct Integral {
    pub value: f64,
    pub gradient: Vector2<f64>,
    pub slope: f64,
}

impl Face {
    /// An upright face with its normal at an angle (rad) in the tiles' plane.
    pub fn upright(centre: Vector2<f64>, angle: f64, shape: Shape) -> Self {
        let (sin, cos) = libm::sincos(angle);
        let (across, normal) = (Vector3::new(-sin, cos, 0.0), Vector3::new(cos, sin, 0.0));
        Self { centre: Vector3::new(centre.x, centre.y, 0.0), frame: [across, Vector3::z(), normal], shape }
    }

    /// A flat face at a height (m) over the tiles' middle plane, its first side at an angle (rad).
    pub fn flat(centre: Vector2<f64>, height: f64, angle: f64, shape: Shape) -> Self {
        let (sin, cos) = libm::sincos(angle);
        let (along, across) = (Vector3::new(cos, sin, 0.0), Vector3::new(-sin, cos, 0.0));
        Self { centre: Vector3::new(centre.x, centre.y, height), frame: [along, across, Vector3::z()], shape }
    }

    /// The integral of `1 / r` over the face (m) at a place from its middle (m), and its gradient.
    fn potential(&self, place: [C; 3]) -> (C, [C; 3]) {
        let local = self.frame.map(|side| place[0] * side.x + place[1] * side.y + place[2] * side.z);
        let (value, slopes) = match self.shape {
            Shape::Rectangle(halves) => rectangle::potential(halves, local),
            Shape::Disc(radius) => {
                let [x, y, h] = local;
                let s = sqrt(x * x + y * y);
                let (value, [outwards, upwards]) = disc::potential(radius, s, h);
                let share = if s == C::default() { s } else { outwards / s };
                (value, [x * share, y * share, upwards])
            }
        };
        let [a, b, c] = self.frame;
        (value, [0, 1, 2].map(|k| slopes[0] * a[k] + slopes[1] * b[k] + slopes[2] * c[k]))
    }

    /// Where its potential along an upright or flat line through `from`, at imaginary heights, is
    /// singular: points of its rim.
    fn corners(&self, from: Vector3<f64>) -> Vec<Vector3<f64>> {
        let [a, b, normal] = self.frame;
        let way = from - self.centre;
        match self.shape {
            Shape::Disc(radius) => {
                let aside = way - normal * way.dot(&normal);
                let length = aside.norm();
                // In the plane of its axis and the other one.
                let along = if length > 1e-9 * radius { aside / length } else { normal.cross(&Vector3::z()) };
                let along = if along.norm_squared() < 0.5 { a } else { along };
                
                [-1.0, 1.0].map(|side| self.centre + along * (side * radius)).to_vec()
            }
            Shape::Rectangle([half, width]) => {
                let mut points = Vec::new();
                for (sides, halves) in [([a, b], [half, width]), ([b, a], [width, half])] {
                    let foot = way.dot(&sides[0]).clamp(-halves[0], halves[0]);
                    for side in [-1.0, 1.0] {
                        let edge = self.centre + sides[1] * (side * halves[1]);
                        points.extend([-halves[0], foot, halves[0]].map(|place| edge + sides[0] * place));
                    }
                }
                points
            }
        }
    }
}

impl Integral {
    /// Of two faces that do not meet: both upright or both flat, not both upright rectangles.
    pub fn new(first: &Face, second: &Face) -> Self {
        match [first.shape, second.shape] {
            [Shape::Disc(radius), _] => line::integral(first, radius, second, false),
            [_, Shape::Disc(radius)] => line::integral(second, radius, first, true),
            [Shape::Rectangle(a), Shape::Rectangle(b)] => edges::integral([first, second], [a, b]),
        }
    }
}

#[cfg(test)]
mod tests;
