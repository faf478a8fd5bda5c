//! Dry friction between a tile and the table it lies on.
//!
//! A tile presses on the table with its weight, evenly over its area. At each of some points
//! ([`supports`]) with equal shares of the weight, friction obeys Coulomb's law: it is opposite to the
//! sliding and at most mu times the share, and less where the point rests. Their sum is the force and
//! the torque of a pressed disc: a tile that also turns is slowed less (Farkas, Bartels, Unger and Wolf
//! 2003, Phys. Rev. Lett. 90, 248302).
//!
//! The points are solved together with those of contact ([`super::hold`]), each by the impulse that
//! would stop it, clamped to its limit: every such solution lowers the kinetic energy.

use nalgebra::{Vector2, Vector3};

use tiles::tile::Outline;

/// Standard gravity (m/s^2).
pub const GRAVITY: f64 = 9.806_65;
/// Least number of points.
const POINTS: usize = 12;
/// Squares along a side of the finer grid, for the mean distance from the centroid.
const FINE: usize = 100;

/// A velocity, or a point's row for one tile, as (x, y, turn, 0): a vector of the processor.
pub type Four = [f64; 4];

/// A point at which a tile lies on the table.
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    pub tile: usize,
    /// From the tile's centre of mass (m).
    pub arm: Vector2<f64>,
    /// The largest friction (N s) in the time that is solved for.
    pub limit: f64,
    /// The impulse (N s) on the tile.
    pub impulse: Vector2<f64>,
    /// Whether the impulse is known.
    pub is_given: bool,
}

impl Rest {
    /// The velocity (m/s) of the point, by that of its tile.
    pub fn velocity(&self, of: &[Vector3<f64>]) -> Vector2<f64> {
        let v = of[self.tile];
        v.xy() + Vector2::new(-self.arm.y, self.arm.x) * v.z
    }

    /// The work (J) of the impulse where the velocities change from `before` to `after`.
    pub fn work(&self, before: &[Vector3<f64>], after: &[Vector3<f64>]) -> f64 {
        let twice = self.velocity(before) + self.velocity(after);
        0.5 * self.impulse.dot(&twice)
    }

    /// Whether it slides: friction is at its limit.
    pub fn slides(&self) -> bool {
        self.impulse.norm() >= self.limit * (1.0 - 1e-9)
    }
}

/// Points at which a tile lies on the table (m), about its centroid: a grid over its area, whose mean is
/// the centroid and whose mean distance from it is that of the area, so that friction is exact where
/// the tile only slides or only spins.
pub fn supports(outline: &Outline) -> Vec<Vector2<f64>> {
    let centroid = outline.centroid();
    let mut points = Vec::new();
    for side in 3.. {
        points = grid(outline, side);
        if points.len() >= POINTS || side == FINE {
            break;
        }
    }
    let mean = points.iter().sum::<Vector2<f64>>() / points.len().max(1) as f64;
    let radius = |points: &[Vector2<f64>], about: Vector2<f64>| {
        points.iter().map(|it| (it - about).norm()).sum::<f64>() / points.len().max(1) as f64
    };
    let factor = radius(&grid(outline, FINE), centroid) / radius(&points, mean);
    let factor = if factor.is_finite() { factor } else { 1.0 };
    points.iter().map(|it| (it - mean) * factor).collect()
}

/// The middles of the squares of a grid that lie inside an outline; its centroid if none does.
fn grid(outline: &Outline, side: usize) -> Vec<Vector2<f64>> {
    let bounds = outline.hull().bounds();
    let at = |axis: usize, k: usize| {
        let share = (k as f64 + 0.5) / side as f64;
        bounds.low[axis] + share * (bounds.high[axis] - bounds.low[axis])
    };
    let cells = (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
    let middles = cells.map(|(column, row)| Vector2::new(at(0, column), at(1, row)));
    let mut inside: Vec<_> = middles.filter(|it| outline.contains(*it)).collect();
    if inside.is_empty() {
        inside.push(outline.centroid());
    }
    inside
}

/// A point with the data of the solver, for velocities multiplied by the root of the mass (or inertia).
pub struct RestPoint {
    tile: usize,
    /// The rows of x and y.
    rows: [Four; 2],
    /// The inverse of a bound of the response to an impulse.
    stiffness: f64,
    limit: f64,
    pub impulse: [f64; 2],
    /// The impulse after the last sweep.
    swept: [f64; 2],
    is_given: bool,
}

impl RestPoint {
    /// The point of a tile of a cluster; `root` are the inverse roots of its masses.
    pub fn new(rest: &Rest, tile: usize, root: &Vector3<f64>) -> Self {
        let arm = rest.arm;
        let turn = arm.norm() * root.z;
        Self {
            tile,
            rows: [
                [root.x, 0.0, -arm.y * root.z, 0.0],
                [0.0, root.y, arm.x * root.z, 0.0],
            ],
            stiffness: 1.0 / (root.x * root.x + turn * turn),
            limit: rest.limit,
            impulse: rest.impulse.into(),
            swept: rest.impulse.into(),
            is_given: rest.is_given,
        }
    }

    /// Changes the velocities by an impulse.
    #[inline(always)]
    pub fn push(&self, impulse: [f64; 2], velocities: &mut [Four]) {
        for (k, v) in velocities[self.tile].iter_mut().enumerate() {
            *v += self.rows[0][k] * impulse[0] + self.rows[1][k] * impulse[1];
        }
    }

    /// The nearest impulse within the limit.
    #[inline(always)]
    pub fn within(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let size = (x * x + y * y).sqrt();
        let share = if size > self.limit {
            self.limit / size
        } else {
            1.0
        };
        [x * share, y * share]
    }

    /// Solves for the impulse of this point.
    #[inline(always)]
    pub fn solve(&mut self, velocities: &mut [Four]) {
        if self.is_given {
            return;
        }
        let velocity = &velocities[self.tile];
        let slip = self
            .rows
            .map(|row| row[0] * velocity[0] + row[1] * velocity[1] + row[2] * velocity[2]);
        let before = self.impulse;
        let asked = [0, 1].map(|k| before[k] - slip[k] * self.stiffness);
        self.impulse = self.within(asked);
        self.push([0, 1].map(|k| self.impulse[k] - before[k]), velocities);
    }

    /// After a sweep: goes on by a share of its change, within the limit. The velocities have done so
    /// without it.
    #[inline(always)]
    pub fn go_on(&mut self, share: f64, velocities: &mut [Four]) {
        let now = self.impulse;
        let further = [0, 1].map(|k| now[k] + (now[k] - self.swept[k]) * share);
        self.swept = now;
        self.impulse = self.within(further);
        if self.impulse != further {
            self.push([0, 1].map(|k| self.impulse[k] - further[k]), velocities);
        }
    }
}
