//! What holds tiles back where they touch each other or the rim.
//!
//! With the velocities v0 that tiles would have freely and for each point of contact the normal n and the
//! tangent t as rows over the velocities of both tiles, there are impulses p, f with
//!
//! `v = v0 + M^-1 sum (n p + t f)`, `n.v >= l` and `p >= 0`, one of them with equality,
//! `|f| <= mu p`, and `t.v = 0` unless `f = -+ mu p` holds against the sliding
//!
//! (Stewart and Trinkle 1996, Int. J. Numer. Meth. Eng. 39, 2673; Anitescu and Potra 1997, Nonlinear
//! Dynamics 14, 231). They are found by going over the points again and again, each solved by itself.
//! Impulses act on both tiles at one place, equal and opposite.

use nalgebra::{Vector2, Vector3};

use crate::tile::outline::cross;

/// Velocities (m/s) are found with this error.
pub const ERROR: f64 = 1e-11;
/// Sweeps over the points, at most.
const SWEEPS: usize = 2000;

/// A point of contact.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    /// The tile behind the normal, none for the rim, and the tile before it.
    pub tiles: [Option<usize>; 2],
    /// Where it is (m).
    pub point: Vector2<f64>,
    /// Unit vector from the first to the second.
    pub axis: Vector2<f64>,
    /// How far apart they are there (m).
    pub gap: f64,
    /// Least velocity (m/s) along the normal.
    pub least: f64,
    /// Impulses along normal and tangent (N s), for a tile's mass in kg.
    pub impulses: [f64; 2],
    rows: [[Vector3<f64>; 2]; 2],
}

impl Hold {
    /// Between two tiles, or the rim and one; `centres` are the centres of mass of all tiles.
    pub fn new(
        tiles: [Option<usize>; 2],
        point: Vector2<f64>,
        axis: Vector2<f64>,
        gap: f64,
        centres: impl Fn(usize) -> Vector2<f64>,
    ) -> Self {
        let mut hold = Self {
            tiles,
            point,
            axis,
            gap,
            least: 0.0,
            impulses: [0.0; 2],
            rows: [[Vector3::zeros(); 2]; 2],
        };
        hold.place(point, centres);
        hold
    }

    /// The same at another point.
    pub fn place(&mut self, point: Vector2<f64>, centres: impl Fn(usize) -> Vector2<f64>) {
        self.point = point;
        let n = self.axis;
        let axes = [n, Vector2::new(-n.y, n.x)];
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let Some(tile) = self.tiles[side] else {
                continue;
            };
            let arm = point - centres(tile);
            for (row, axis) in self.rows.iter_mut().zip(axes) {
                row[side] = Vector3::new(axis.x, axis.y, cross(arm, axis)) * sign;
            }
        }
    }

    /// The tiles with their part of a row: 0 along the normal, 1 along the tangent.
    fn parts(&self, row: usize) -> impl Iterator<Item = (usize, &Vector3<f64>)> {
        let tiles = self.tiles.iter().zip(&self.rows[row]);
        tiles.filter_map(|(tile, part)| tile.map(|tile| (tile, part)))
    }

    fn along(&self, row: usize, of: &[Vector3<f64>]) -> f64 {
        self.parts(row)
            .map(|(tile, part)| part.dot(&of[tile]))
            .sum()
    }

    /// The rate (of velocities: m/s) along the normal.
    pub fn rate(&self, of: &[Vector3<f64>]) -> f64 {
        self.along(0, of)
    }

    fn push(&self, impulses: [f64; 2], inverse: &[Vector3<f64>], velocities: &mut [Vector3<f64>]) {
        for (row, impulse) in impulses.into_iter().enumerate() {
            if impulse != 0.0 {
                for (tile, part) in self.parts(row) {
                    velocities[tile] += part.component_mul(&inverse[tile]) * impulse;
                }
            }
        }
    }

    /// `a M^-1 b` of two rows.
    fn response(&self, a: usize, b: usize, inverse: &[Vector3<f64>]) -> f64 {
        let pairs = self.parts(a).zip(self.parts(b));
        pairs
            .map(|((tile, a), (_, b))| a.component_mul(&inverse[tile]).dot(b))
            .sum()
    }
}

/// How a point answers to impulses.
struct Response {
    nn: f64,
    nt: f64,
    tt: f64,
}

impl Response {
    /// The impulses along normal and tangent that velocities without them ask for.
    fn impulses(&self, lack: f64, slip: f64, friction: f64) -> [f64; 2] {
        if lack <= 0.0 {
            return [0.0; 2];
        }
        let Self { nn, nt, tt } = *self;
        if friction == 0.0 {
            return [lack / nn, 0.0];
        }
        let whole = nn * tt - nt * nt;
        let push = (tt * lack + nt * slip) / whole;
        let rub = -(nt * lack + nn * slip) / whole;
        if push >= 0.0 && rub.abs() <= friction * push {
            return [push, rub];
        }
        // It slides against the side of the cone of friction where it would be held.
        let share = friction.copysign(rub);
        let answer = nn + share * nt;
        if answer <= 1e-3 * nn {
            // Friction would press without end there (Painleve's paradox): the normal alone holds.
            return [lack / nn, 0.0];
        }
        let push = lack / answer;
        [push, share * push]
    }
}

/// Changes velocities by the impulses that all points ask for, which are kept in the holds.
pub fn hold_back(
    inverse: &[Vector3<f64>],
    velocities: &mut [Vector3<f64>],
    holds: &mut [Hold],
    friction: f64,
) {
    for hold in holds.iter_mut() {
        hold.impulses = [0.0; 2];
    }
    if holds
        .iter()
        .all(|hold| hold.rate(velocities) >= hold.least - ERROR)
    {
        return;
    }
    let responses: Vec<Response> = holds
        .iter()
        .map(|hold| Response {
            nn: hold.response(0, 0, inverse),
            nt: hold.response(0, 1, inverse),
            tt: hold.response(1, 1, inverse),
        })
        .collect();
    for _ in 0..SWEEPS {
        let mut changed: f64 = 0.0;
        for (hold, response) in holds.iter_mut().zip(&responses) {
            let [push, rub] = hold.impulses;
            let now = [0, 1].map(|row| hold.along(row, velocities));
            let without = [
                now[0] - response.nn * push - response.nt * rub,
                now[1] - response.nt * push - response.tt * rub,
            ];
            let asked = response.impulses(hold.least - without[0], without[1], friction);
            let change = [asked[0] - push, asked[1] - rub];
            if change == [0.0; 2] {
                continue;
            }
            hold.push(change, inverse, velocities);
            hold.impulses = asked;
            changed = changed
                .max((response.nn * change[0]).abs())
                .max((response.tt * change[1]).abs());
        }
        if changed < ERROR {
            break;
        }
    }
}

/// Kinetic energy (J) of velocities.
pub fn kinetic(masses: &[Vector3<f64>], velocities: &[Vector3<f64>]) -> f64 {
    let each = masses.iter().zip(velocities);
    0.5 * each
        .map(|(mass, v)| mass.component_mul(v).dot(v))
        .sum::<f64>()
}

/// The largest share of a change, at most all of it, with which velocities have no more than a
/// kinetic energy (J), if they have no more without.
pub fn share_within(
    masses: &[Vector3<f64>],
    velocities: &[Vector3<f64>],
    change: &[Vector3<f64>],
    energy: f64,
) -> f64 {
    let left = (energy - kinetic(masses, velocities)).max(0.0);
    let square = kinetic(masses, change);
    let each = masses.iter().zip(velocities).zip(change);
    let linear: f64 = each
        .map(|((mass, v), change)| mass.component_mul(v).dot(change))
        .sum();
    if square + linear <= left {
        return 1.0;
    }
    let root = (linear * linear + 4.0 * square * left).sqrt();
    match linear > 0.0 {
        true => 2.0 * left / (linear + root),
        false => (root - linear) / (2.0 * square),
    }
}
