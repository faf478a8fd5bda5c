//! The charged faces of magnets, and the integral of `1 / r` over two of them.

use nalgebra::{Vector2, Vector3};

use super::complex::{Complexes, Z};
use super::{disc, rectangle};
use crate::potential::simd::lanes::Lanes;
use arrayvec::ArrayVec;

/// A uniformly charged face.
#[derive(Clone, Copy, Debug)]
pub struct ChargedFace {
    /// Its centre (m).
    pub centre: Vector3<f64>,
    /// Unit vectors along its sides, and normal to it.
    pub frame: [Vector3<f64>; 3],
    /// Its shape.
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

/// The integral of `1 / r` over two faces (m^3), its gradient by the second one's centre in the
/// tiles' plane (m^2), and its derivative by the second one's angle about its own centre (m^3).
#[derive(Clone, Copy, Debug, Default)]
pub struct Integral {
    pub value: f64,
    pub gradient: Vector2<f64>,
    pub slope: f64,
}

/// A unit vector turned by a quarter turn, and the vector itself.
fn sides(along: Vector2<f64>) -> [Vector2<f64>; 2] {
    [Vector2::new(-along.y, along.x), along]
}

impl ChargedFace {
    /// An upright face with its normal along a unit vector in the tiles' plane.
    pub fn upright(centre: Vector2<f64>, normal: Vector2<f64>, shape: Shape) -> Self {
        let [across, normal] = sides(normal).map(|side| side.push(0.0));
        Self {
            centre: Vector3::new(centre.x, centre.y, 0.0),
            frame: [across, Vector3::z(), normal],
            shape,
        }
    }

    /// A flat face at a height (m) over the tiles' middle plane, its first side along a unit vector.
    pub fn flat(centre: Vector2<f64>, along: Vector2<f64>, height: f64, shape: Shape) -> Self {
        let [across, along] = sides(along).map(|side| side.push(0.0));
        Self {
            centre: Vector3::new(centre.x, centre.y, height),
            frame: [along, across, Vector3::z()],
            shape,
        }
    }

    /// The integral of `1 / r` over the face (m) at places relative to its centre (m), and its
    /// gradient.
    #[inline(always)]
    pub fn potential<L: Lanes>(&self, l: L, place: [Z<L::F>; 3]) -> (Z<L::F>, [Z<L::F>; 3]) {
        let [a, b, c] = self.frame;
        let local = [along(l, a, place), along(l, b, place), along(l, c, place)];
        let (value, slopes) = match self.shape {
            Shape::Rectangle(halves) => rectangle::potential(l, halves, local),
            Shape::Disc(radius) => {
                let [x, y, h] = local;
                let s = l.z_sqrt(l.z_mul_add(x, x, l.z_mul(y, y)));
                let (value, [outwards, upwards]) = disc::potential(l, radius, s, h);
                // On the axis, where x and y are 0, the share does not matter.
                let off = l.sub(l.z_norm(s), l.splat(f64::MIN_POSITIVE));
                let share = l.z_div(outwards, l.z_select(off, s, l.z_splat(1.0, 0.0)));
                (value, [l.z_mul(x, share), l.z_mul(y, share), upwards])
            }
        };
        // Its three columns.
        let [x, y, z] = [0, 1, 2].map(|k| Vector3::new(a[k], b[k], c[k]));
        (
            value,
            [
                along(l, x, slopes),
                along(l, y, slopes),
                along(l, z, slopes),
            ],
        )
    }

    /// The points of its rim where its potential along an upright or flat line through `from`, at
    /// imaginary heights, is singular.
    pub fn corners(&self, from: Vector3<f64>) -> ArrayVec<Vector3<f64>, 12> {
        let [a, b, normal] = self.frame;
        let way = from - self.centre;
        match self.shape {
            Shape::Disc(radius) => {
                let aside = way - normal * way.dot(&normal);
                let length = aside.norm();
                // In the plane of its axis and the other one.
                let along = if length > 1e-9 * radius {
                    aside / length
                } else {
                    normal.cross(&Vector3::z())
                };
                let along = if along.norm_squared() < 0.5 { a } else { along };

                let points = [-1.0, 1.0].map(|side| self.centre + along * (side * radius));
                points.into_iter().collect()
            }
            Shape::Rectangle([half, width]) => {
                let mut points = ArrayVec::new();
                for (sides, halves) in [([a, b], [half, width]), ([b, a], [width, half])] {
                    let foot = way.dot(&sides[0]).clamp(-halves[0], halves[0]);
                    for side in [-1.0, 1.0] {
                        let edge = self.centre + sides[1] * (side * halves[1]);
                        points.extend(
                            [-halves[0], foot, halves[0]].map(|place| edge + sides[0] * place),
                        );
                    }
                }
                points
            }
        }
    }
}

/// The product of a real and a complex vector.
#[inline(always)]
fn along<L: Lanes>(l: L, side: Vector3<f64>, place: [Z<L::F>; 3]) -> Z<L::F> {
    let [x, y, z] = place;
    let sum = l.z_add(l.z_times(x, l.splat(side.x)), l.z_times(y, l.splat(side.y)));
    l.z_add(sum, l.z_times(z, l.splat(side.z)))
}
