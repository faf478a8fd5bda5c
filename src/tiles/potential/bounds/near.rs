//! Bounds for two point dipoles near each other, over a cell.
//!
//! With K = mu0 m1 m2 / (4 pi), a and b the directions of the moments and phi that of the
//! separation, `U = K / r^3 [-1/2 cos(a - b) - 3/2 cos(a + b - 2 phi)]`, over the distances and
//! angles within reach. As the tiles do not overlap, r is at least the sum of the two magnets'
//! distances to their own outlines.

use std::f64::consts::PI;

use crate::scale::Scale;
use crate::tile::{Magnet, Tile};

/// How much closer (m) than the sum of their depths two magnets may come: the overlap that counts
/// as touching ([`TOUCH`](crate::contact::TOUCH)), with a margin.
pub const SLACK: f64 = 1e-8;

/// How deep (m) a tile's magnets lie inside its outline, minus half the slack for tiles of its
/// size.
pub fn depths(tile: &Tile) -> Vec<f64> {
    let radius = tile.outline.circumradius();
    let spare = Scale::of([radius; 2]).length(SLACK) / 2.0;
    let depth = |magnet: &Magnet| (-tile.outline.signed_distance(magnet.position)).max(0.0) - spare;
    tile.magnets.iter().map(depth).collect()
}

/// The numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    /// The smallest interval that contains some numbers.
    pub fn holding<const N: usize>(numbers: [f64; N]) -> Self {
        Self {
            low: numbers.into_iter().fold(f64::INFINITY, f64::min),
            high: numbers.into_iter().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// All products of a number of one and a number of the other.
    pub fn times(self, other: Self) -> Self {
        Self::holding([
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ])
    }

    /// The largest magnitude.
    pub fn size(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// With `margin` more at either end.
    pub fn widened(self, margin: f64) -> Self {
        Self {
            low: self.low - margin,
            high: self.high + margin,
        }
    }
}

/// The smallest distance (m) of two dipoles that are `r` (m) apart at a cell's centre, of which one
/// moves by up to `reach` (m), and whose distances to their own outlines sum to `depths` (m).
pub fn least_distance(r: f64, reach: f64, depths: f64) -> f64 {
    (r - reach).max(depths)
}

/// Two dipoles over a cell.
#[derive(Clone, Copy, Debug)]
pub struct NearPair {
    /// K (J m^3).
    strength: f64,
    /// a - b and a + b - 2 phi at the cell's centre (rad), and how far they may vary.
    angles: [f64; 2],
    spreads: [f64; 2],
    /// Direction of the separation (rad), and how far it may vary.
    direction: f64,
    swing: f64,
    /// r at the cell's centre, and its range (m).
    distance: f64,
    pub distances: Interval,
}

impl NearPair {
    /// From the vector (m) from the first dipole to the second at the cell's centre, K (J m^3), the
    /// directions of both moments there (rad), the second one's reach (m) in the cell and the turn
    /// (rad) that it may make there, and the sum of the dipoles' distances to their own outlines
    /// (m).
    pub fn new(
        [dx, dy]: [f64; 2],
        strength: f64,
        [a, b]: [f64; 2],
        [reach, turn]: [f64; 2],
        depths: f64,
    ) -> Self {
        let r = libm::hypot(dx, dy);
        let phi = libm::atan2(dy, dx);
        let swing = if reach < r { libm::asin(reach / r) } else { PI };
        Self {
            strength,
            angles: [a - b, a + b - 2.0 * phi],
            spreads: [turn, turn + 2.0 * swing],
            direction: phi,
            swing,
            distance: r,
            distances: Interval {
                low: least_distance(r, reach, depths),
                high: r + reach,
            },
        }
    }

    /// Whether the dipoles may coincide.
    pub fn may_coincide(&self) -> bool {
        self.distances.low <= 0.0
    }

    /// U over the cell (J), without rounding. They must not coincide.
    pub fn energy(&self) -> Interval {
        let along = cosine_range(self.angles[0], self.spreads[0]);
        let beside = cosine_range(self.angles[1], self.spreads[1]);
        let factor = [
            -0.5 * along.high - 1.5 * beside.high,
            -0.5 * along.low - 1.5 * beside.low,
        ];
        let Interval {
            low: near,
            high: far,
        } = self.distances;
        Interval {
            low: factor[0] * self.scale(if factor[0] < 0.0 { near } else { far }),
            high: factor[1] * self.scale(if factor[1] > 0.0 { near } else { far }),
        }
    }

    /// U at the cell's centre (J).
    pub fn energy_at_centre(&self) -> f64 {
        let [turn, across] = self.angles;
        (-0.5 * libm::cos(turn) - 1.5 * libm::cos(across)) * self.scale(self.distance)
    }

    /// `K / r^3` at the smallest distance (J).
    pub fn greatest_scale(&self) -> f64 {
        self.scale(self.distances.low)
    }

    fn scale(&self, r: f64) -> f64 {
        self.strength / (r * r * r)
    }

    /// The cosines of the angle between the separation and a direction (rad) that may turn by
    /// `turn`.
    pub fn cosines(&self, direction: f64, turn: f64) -> Interval {
        cosine_range(direction - self.direction, self.swing + turn)
    }
}

/// Cosines of the angles within `half` of `middle` (rad).
fn cosine_range(middle: f64, half: f64) -> Interval {
    const MARGIN: f64 = 1e-14;
    if half >= PI {
        return Interval {
            low: -1.0,
            high: 1.0,
        };
    }
    let middle = crate::configuration::wrap_angle(middle).abs();
    // cos falls from 0 to pi; the angles run from middle - half to middle + half.
    let high = if middle <= half {
        1.0
    } else {
        libm::cos(middle - half) + MARGIN
    };
    let low = if middle + half >= PI {
        -1.0
    } else {
        libm::cos(middle + half) - MARGIN
    };
    Interval {
        low: low.max(-1.0),
        high: high.min(1.0),
    }
}
