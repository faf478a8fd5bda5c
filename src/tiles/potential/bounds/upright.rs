//! Bounds of the interaction energy of upright discs, or upright point dipoles, over a cell.
//!
//! Each pair's energy is a function `V(r)` of the distance alone. With p the second magnet's place, a its
//! arm from the point about which its tile turns and `t` the arm turned by a right angle, the motion of p
//! at the rates (dx, dy, dtheta) has
//!
//! ```text
//! p' = (dx, dy) + t dtheta,    p'' = -a dtheta^2,    |p'''| <= |a| |dtheta|^3
//! ```
//!
//! which gives the form of second order, from V, V' and V'' at the cell's centre. Along a motion to
//! anywhere in the cell the third derivative is at most `L3 |p'|^3 + 3 L2 |p'| |p''| + L1 |p'''|`, with
//! the bounds L1, L2 and L3 of V's derivatives from the least distance in the cell on. Where the
//! remainder is no less than the range of V itself, the pair counts as a constant within this range.

use std::sync::Arc;

use nalgebra::Vector2;

use super::near::{depths, least_distance};
use super::{CellBounds, Enclosure};
use crate::cell::{Cell, Quadratic};
use crate::potential::MagnetModel;
use crate::potential::bodies::radial::{Radial, RadialLimits, RadialValue};
use crate::potential::kinds::{Made, number_of};
use crate::tile::{Magnet, Tile};

/// The rounding of a sum over up to a few thousand pairs, relative to the sum of magnitudes.
const ROUNDING: f64 = 1e-12;

/// Units of work for a cell, and for a pair.
const A_CELL: u64 = 100;
const A_PAIR: u64 = 25;

/// The laws of two sizes of magnets.
pub(super) type RadialLaws = Made<[[f64; 3]; 2], Radial>;

/// Cell bounds of the interaction energy of two tiles' upright magnets.
#[derive(Clone, Debug)]
pub struct UprightBounds {
    fixed: Vec<Standing>,
    moving: Vec<Standing>,
    /// By the kinds of the fixed and the moving magnet.
    laws: Vec<Vec<Arc<Radial>>>,
}

#[derive(Clone, Copy, Debug)]
struct Standing {
    position: Vector2<f64>,
    /// Upwards (A m^2).
    moment: f64,
    /// How deep (m) it lies within its tile.
    depth: f64,
    /// The number of its size among those of its tile.
    kind: usize,
}

impl UprightBounds {
    /// Bounds for the upright magnets of two tiles: discs, unless they are point dipoles.
    pub(super) fn new(
        model: MagnetModel,
        fixed: &Tile,
        moving: &Tile,
        known: &mut RadialLaws,
    ) -> Self {
        let ((fixed, first), (moving, second)) = (standing(fixed), standing(moving));
        let mut laws = |one: &Magnet| {
            let of = |other: &Magnet| {
                known.of([one.size, other.size], || Radial::new(model, one, other))
            };
            second.iter().map(of).collect()
        };
        Self {
            fixed,
            moving,
            laws: first.iter().map(&mut laws).collect(),
        }
    }
}

/// The upright magnets of a tile, and one of each size.
fn standing(tile: &Tile) -> (Vec<Standing>, Vec<Magnet>) {
    let (mut all, mut sizes) = (Vec::new(), Vec::<Magnet>::new());
    for (magnet, depth) in tile.magnets.iter().zip(depths(tile)) {
        let Some(up) = magnet.form.stands else {
            continue;
        };
        let kind = number_of(&mut sizes, |it| it.size == magnet.size, |_| magnet.clone());
        all.push(Standing {
            position: magnet.position,
            moment: up.sign() * magnet.moment,
            depth,
            kind,
        });
    }
    (all, sizes)
}

impl CellBounds for UprightBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let mut out = Enclosure::default();
        let rotation = cell.centre.rotation();
        let mut size = 0.0;
        for second in &self.moving {
            let motion = Motion::new(rotation * second.position, cell);
            for first in &self.fixed {
                let pair = Pair {
                    strength: first.moment * second.moment,
                    way: cell.centre.position() + motion.arm - first.position,
                    depths: first.depth + second.depth,
                };
                size += pair.add(&mut out, &self.laws[first.kind][second.kind], &motion);
            }
        }
        out.low -= ROUNDING * size;
        out.high += ROUNDING * size;
        out
    }

    fn work(&self) -> u64 {
        A_CELL + A_PAIR * (self.fixed.len() * self.moving.len()) as u64
    }
}

/// How a cell moves a magnet.
struct Motion {
    /// Vector (m) to it from the point about which it turns.
    arm: Vector2<f64>,
    /// Bounds (m) of its first three derivatives along a motion from the centre to anywhere in the
    /// cell.
    speeds: [f64; 3],
}

impl Motion {
    fn new(arm: Vector2<f64>, cell: &Cell) -> Self {
        let (lever, turn) = (arm.norm(), cell.half[2]);
        let speeds = [
            cell.reach(lever),
            lever * turn * turn,
            lever * turn * turn * turn,
        ];
        Self {
            arm,
            speeds: speeds.map(|speed| speed * (1.0 + ROUNDING)),
        }
    }
}

/// A fixed and a moving magnet.
struct Pair {
    /// The product of the moments (A^2 m^4).
    strength: f64,
    /// From the first to the second at the cell's centre (m).
    way: Vector2<f64>,
    /// The least distance (m) while the tiles do not overlap.
    depths: f64,
}

impl Pair {
    /// Adds the pair; returns the magnitude (J) of what was added.
    fn add(&self, out: &mut Enclosure, law: &Radial, motion: &Motion) -> f64 {
        let (r, magnitude) = (self.way.norm(), self.strength.abs());
        let [speed, bend, twist] = motion.speeds;
        let nearest = least_distance(r, speed, self.depths);
        let RadialLimits {
            value: most,
            derivatives: [first, second, third],
        } = law.from(nearest);
        if most == f64::INFINITY {
            // Nothing keeps these dipoles apart.
            *out = Enclosure::unknown();
            return 0.0;
        }
        let RadialValue {
            value,
            error: [e0, e1, e2],
        } = law.at(r);
        let remainder = (third * speed.powi(3) + 3.0 * second * speed * bend + first * twist) / 6.0;
        let turned = e1 * bend + e2.max(e1 / r) * speed * speed;
        let left = remainder + e0 + e1 * speed + turned / 2.0;
        let farthest = law.at(r.max(nearest) + speed);
        let half = (most - farthest.value[0] + farthest.error[0]) / 2.0;
        // Where tiles overlap at the centre, the form there says nothing.
        let spread = if remainder < half && left.is_finite() && r >= nearest {
            out.form = out.form.minus(-self.strength, &self.form(value, r, motion));
            out.slope += magnitude * (3.0 * remainder + e1 * speed + turned);
            left
        } else {
            out.form.value += self.strength * (most - half);
            out.slope += magnitude * first * speed;
            half
        };
        out.low -= magnitude * spread;
        out.high += magnitude * spread;
        magnitude * most
    }

    /// V as a form of the cell's coordinates.
    fn form(&self, [value, slope, bend]: [f64; 3], r: f64, motion: &Motion) -> Quadratic {
        let along = self.way / r;
        let arm = motion.arm;
        let across = Vector2::new(-arm.y, arm.x);
        let (force, aside) = (along * slope, slope / r);
        let curved = |v: Vector2<f64>| v * aside + along * ((bend - aside) * along.dot(&v));
        let [x, y, turned] = [Vector2::x(), Vector2::y(), across].map(curved);
        Quadratic {
            value,
            gradient: [force.x, force.y, force.dot(&across)],
            hessian: [
                x.x,
                y.y,
                turned.dot(&across) - force.dot(&arm),
                x.y,
                turned.x,
                turned.y,
            ],
        }
    }
}
