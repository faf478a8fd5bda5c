//! Points of contact, and the energy of impulses.

use nalgebra::{Vector2, Vector3};

use tiles::contact::TurnsWith;
use tiles::tile::outline::cross;

/// Normals are much the same if the cosine of their angle is above this.
const ALIKE: f64 = 0.9;

/// A point of contact.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    /// The tile behind the normal, `None` for the rim, and the tile in front of it.
    pub tiles: [Option<usize>; 2],
    /// Its position (m).
    pub point: Vector2<f64>,
    /// Unit vector from the first to the second.
    pub axis: Vector2<f64>,
    /// Their distance there (m) beyond the skin.
    pub gap: f64,
    /// What the normal turns with.
    pub turns_with: TurnsWith,
    /// The radius (m) of a round rim, if it is one with this.
    pub rim: Option<f64>,
    /// Least velocity (m/s) along the normal.
    pub least: f64,
    /// Guesses of the forces (N) along normal and tangent.
    pub forces: [f64; 2],
    /// Impulses along normal and tangent (N s), for a tile's mass in kg.
    pub impulses: [f64; 2],
    /// The index of its pair of tiles; `None` for the rim.
    pub pair: Option<usize>,
    /// From the centres of both tiles to the point (m).
    arms: [Vector2<f64>; 2],
    /// Normal and tangent, for both tiles.
    pub(super) rows: [[Vector3<f64>; 2]; 2],
}

impl Hold {
    /// A point between two tiles, or between the rim and a tile; `centres` are the centres of mass
    /// of all tiles.
    pub fn new(
        tiles: [Option<usize>; 2],
        point: Vector2<f64>,
        (axis, turns_with): (Vector2<f64>, TurnsWith),
        gap: f64,
        centres: impl Fn(usize) -> Vector2<f64>,
    ) -> Self {
        let mut hold = Self {
            tiles,
            point,
            axis,
            gap,
            turns_with,
            rim: None,
            least: 0.0,
            forces: [0.0; 2],
            impulses: [0.0; 2],
            pair: None,
            arms: [Vector2::zeros(); 2],
            rows: [[Vector3::zeros(); 2]; 2],
        };
        let axes = [axis, Vector2::new(-axis.y, axis.x)];
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let Some(tile) = tiles[side] else {
                continue;
            };
            let arm = point - centres(tile);
            hold.arms[side] = arm;
            for (row, axis) in hold.rows.iter_mut().zip(axes) {
                row[side] = Vector3::new(axis.x, axis.y, cross(arm, axis)) * sign;
            }
        }
        hold
    }

    /// The gap (m) after the tiles have moved.
    pub fn gap_after(&self, moves: &[Move], skin: f64) -> f64 {
        let between = self.axis * (self.gap + skin);
        let [of_behind, of_front] = self.tiles.map(|tile| tile.map(|tile| &moves[tile]));
        let moved = |of: Option<&Move>, arm| of.map_or(Vector2::zeros(), |it| it.of_arm(arm));
        if let Some(radius) = self.rim {
            let now = self.point + moved(of_front, self.arms[1]);
            return radius - now.norm();
        }
        // The point behind lies on the outline of its tile.
        let behind = moved(of_behind, self.arms[0] - between);
        let front = moved(of_front, self.arms[1]);
        let now = between + front - behind;
        let by = |of: Option<&Move>| {
            let turned = of.map_or(Vector2::zeros(), |it| it.turned(self.axis));
            (self.axis + turned).dot(&now)
        };
        let distance = match self.turns_with {
            TurnsWith::Behind => by(of_behind),
            TurnsWith::InFront => by(of_front),
            TurnsWith::Line => now.norm().copysign(now.dot(&self.axis)),
        };
        distance - skin
    }

    /// Whether another point is of the same tiles and has much the same normal.
    pub fn is_like(&self, other: &Self) -> bool {
        self.tiles == other.tiles && self.axis.dot(&other.axis) > ALIKE
    }

    /// How far (m) two points of the same tiles are apart on both, by the table's directions.
    pub fn apart(&self, other: &Self) -> f64 {
        let sides = self.arms.iter().zip(&other.arms);
        sides.map(|(one, other)| (one - other).norm()).sum()
    }

    /// The work (J) of the impulses where the velocities change from `before` to `after`: each
    /// impulse times the mean of both rates.
    pub fn work(&self, before: &[Vector3<f64>], after: &[Vector3<f64>]) -> f64 {
        let row = |row: usize| {
            let rates = self
                .parts(row)
                .map(|(tile, part)| part.dot(&(before[tile] + after[tile])));
            0.5 * self.impulses[row] * rates.sum::<f64>()
        };
        row(0) + row(1)
    }

    /// Whether the tiles press on each other here.
    pub fn is_held(&self) -> bool {
        self.impulses[0] > 0.0
    }

    /// The tiles with their part of a row: 0 along the normal, 1 along the tangent.
    fn parts(&self, row: usize) -> impl Iterator<Item = (usize, &Vector3<f64>)> {
        let tiles = self.tiles.iter().zip(&self.rows[row]);
        tiles.filter_map(|(tile, part)| tile.map(|tile| (tile, part)))
    }

    /// The rate (of velocities: m/s) along the normal.
    pub fn rate(&self, of: &[Vector3<f64>]) -> f64 {
        self.parts(0).map(|(tile, part)| part.dot(&of[tile])).sum()
    }
}

/// Angles (rad) below this are turned by with series: their errors are below rounding.
const SMALL: f64 = 0.01;

/// How a tile moves in a step.
#[derive(Clone, Copy)]
pub struct Move {
    /// By how much (m).
    shift: Vector2<f64>,
    /// The sine of the angle that it turns by, and 1 less its cosine.
    sin: f64,
    less: f64,
}

impl Move {
    /// By a velocity (m/s, m/s, rad/s) in a time (s).
    pub fn new(velocity: &Vector3<f64>, h: f64) -> Self {
        let step = velocity * h;
        let angle = step.z;
        let square = angle * angle;
        let (sin, less) = if angle.abs() < SMALL {
            let sin = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0));
            let less = 1.0 - square / 12.0 * (1.0 - square / 30.0);
            (angle * sin, 0.5 * square * less)
        } else {
            let half = libm::sin(0.5 * angle);
            (libm::sin(angle), 2.0 * half * half)
        };
        Self {
            shift: step.xy(),
            sin,
            less,
        }
    }

    /// What the turn adds to a vector.
    fn turned(&self, of: Vector2<f64>) -> Vector2<f64> {
        Vector2::new(-of.y, of.x) * self.sin - of * self.less
    }

    /// The way (m) of a point at an arm from the tile's centre.
    fn of_arm(&self, arm: Vector2<f64>) -> Vector2<f64> {
        self.shift + self.turned(arm)
    }
}

/// Kinetic energy (J) of velocities.
pub fn kinetic(masses: &[Vector3<f64>], velocities: &[Vector3<f64>]) -> f64 {
    let each = masses.iter().zip(velocities);
    0.5 * each
        .map(|(mass, v)| mass.component_mul(v).dot(v))
        .sum::<f64>()
}

/// The largest share of a change, at most 1, that keeps the kinetic energy of the velocities below
/// a limit (J), given that it is below the limit without the change.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_turns_are_exact() {
        for angle in [
            1e-9,
            1e-5,
            1e-3,
            -0.7 * SMALL,
            0.999 * SMALL,
            1.001 * SMALL,
            1.0,
        ] {
            let it = Move::new(&Vector3::new(0.0, 0.0, angle), 1.0);
            let less = 2.0 * libm::sin(0.5 * angle) * libm::sin(0.5 * angle);
            assert!((it.sin / libm::sin(angle) - 1.0).abs() < 5e-16, "{angle}");
            assert!((it.less / less - 1.0).abs() < 5e-16, "{angle}");
        }
    }

    #[test]
    fn a_share_of_a_change_ends_at_the_energy() {
        let masses = [Vector3::new(2.0, 2.0, 0.5)];
        let velocity = [Vector3::new(1.0, 0.0, 0.0)];
        for change in [[1.0, 0.0, 0.0], [-3.0, 0.0, 0.0], [0.0, 0.0, 4.0]] {
            let change = [Vector3::from(change)];
            for energy in [1.0, 2.0] {
                let share = share_within(&masses, &velocity, &change, energy);
                let reached = kinetic(&masses, &[velocity[0] + change[0] * share]);
                assert!((reached - energy).abs() < 1e-12, "{change:?} {energy}");
            }
            assert_eq!(share_within(&masses, &velocity, &change, 100.0), 1.0);
        }
        // There is no kinetic energy.
        let rest = [Vector3::zeros()];
        assert_eq!(share_within(&masses, &rest, &velocity, 0.0), 0.0);
    }
}
