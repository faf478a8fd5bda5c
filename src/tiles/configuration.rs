//! The configuration (x, y, theta) of the moving tile in the fixed tile's frame, and the space
//! of configurations with its bounds and its metric.

use std::f64::consts::{PI, TAU};

use nalgebra::{Rotation2, Vector2, Vector3};

/// A configuration of the moving tile: its reference point (`x`, `y`, metres) in the fixed
/// tile's frame and its orientation `theta` (radians, counter-clockwise).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Configuration {
    /// Position of the reference point (m).
    pub x: f64,
    /// Position of the reference point (m).
    pub y: f64,
    /// The orientation (rad), not necessarily in (-pi, pi].
    pub theta: f64,
}

impl Configuration {
    /// From `x`, `y` (m) and `theta` (rad).
    #[inline]
    pub const fn new(x: f64, y: f64, theta: f64) -> Self {
        Self { x, y, theta }
    }

    /// The position of the reference point (m).
    #[inline]
    pub fn position(&self) -> Vector2<f64> {
        Vector2::new(self.x, self.y)
    }

    /// The rotation by `theta`.
    #[inline]
    pub fn rotation(&self) -> Rotation2<f64> {
        Rotation2::new(self.theta)
    }

    /// A point given in the moving tile's frame, in the fixed tile's frame (m).
    #[inline]
    pub fn transform(&self, local: Vector2<f64>) -> Vector2<f64> {
        self.position() + self.rotation() * local
    }

    /// A point given in the fixed tile's frame, in the moving tile's frame (m).
    #[inline]
    pub fn inverse_transform(&self, point: Vector2<f64>) -> Vector2<f64> {
        self.rotation().inverse() * (point - self.position())
    }

    /// The pose of the *fixed* tile in the moving tile's frame.
    #[inline]
    pub fn inverse(&self) -> Self {
        let p = self.inverse_transform(Vector2::zeros());
        Self::new(p.x, p.y, wrap_angle(-self.theta))
    }

    /// The pose of a third tile, given in the moving tile's frame, in the fixed tile's frame.
    #[inline]
    pub fn compose(&self, next: &Self) -> Self {
        let p = self.transform(next.position());
        Self::new(p.x, p.y, wrap_angle(self.theta + next.theta))
    }

    /// Moved by `step` = (dx, dy, dtheta); the angle is wrapped.
    #[inline]
    pub fn moved(&self, step: Vector3<f64>) -> Self {
        Self::new(
            self.x + step.x,
            self.y + step.y,
            wrap_angle(self.theta + step.z),
        )
    }

    /// The shortest step (dx, dy, dtheta) from here to `other`, dtheta in (-pi, pi].
    #[inline]
    pub fn step_to(&self, other: &Self) -> Vector3<f64> {
        Vector3::new(
            other.x - self.x,
            other.y - self.y,
            wrap_angle(other.theta - self.theta),
        )
    }

    /// The point a fraction `t` of the way to `other` (straight in x and y, the shorter way round
    /// in theta).
    #[inline]
    pub fn interpolate(&self, other: &Self, t: f64) -> Self {
        self.moved(self.step_to(other) * t)
    }

    /// (x, y, theta) in m, m and rad.
    #[inline]
    pub fn to_array(&self) -> [f64; 3] {
        [self.x, self.y, self.theta]
    }
}

impl From<[f64; 3]> for Configuration {
    fn from([x, y, theta]: [f64; 3]) -> Self {
        Self::new(x, y, wrap_angle(theta))
    }
}

/// An angle brought into (-pi, pi].
#[inline]
pub fn wrap_angle(angle: f64) -> f64 {
    if angle > -PI && angle <= PI {
        return angle;
    }
    let wrapped = angle.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

/// The space of configurations: the allowed positions of the reference point, and the distance of
/// two configurations.
///
/// The reference point stays on the table, `|x| <= size_x / 2` and `|y| <= size_y / 2`; theta is
/// periodic. The metric is `d^2 = dx^2 + dy^2 + rho^2 dtheta^2` with `rho` (m) the moving tile's
/// radius of gyration about its reference point, so that a rotation counts as the distance that it
/// moves the tile's mass on average.
#[derive(Clone, Debug, PartialEq)]
pub struct ConfigurationSpace {
    /// Half the table's size along x and along y (m).
    pub half_size: [f64; 2],
    /// Radius of gyration of the moving tile about its reference point (m).
    pub rho: f64,
    /// The tiles count as free of each other where the reference points are at least this far
    /// apart (m).
    pub free_distance: f64,
}

impl ConfigurationSpace {
    /// Whether the reference point lies on the table, its rim included.
    #[inline]
    pub fn contains(&self, q: &Configuration) -> bool {
        q.x.abs() <= self.half_size[0] && q.y.abs() <= self.half_size[1]
    }

    /// Whether the tiles count as free of each other.
    #[inline]
    pub fn is_far(&self, q: &Configuration) -> bool {
        q.position().norm() >= self.free_distance
    }

    /// Half the size (m) of a map along x and y: it extends a fifth of the tiles' size beyond the
    /// distance of contact, or to the table's edge.
    #[inline]
    pub fn map_half_size(&self) -> [f64; 2] {
        self.half_size
            .map(|half| half.min(1.2 * self.free_distance))
    }

    /// Length of a step (dx, dy, dtheta) in the metric (m).
    #[inline]
    pub fn length(&self, step: Vector3<f64>) -> f64 {
        (step.x * step.x + step.y * step.y + (self.rho * step.z).powi(2)).sqrt()
    }

    /// Distance of two configurations in the metric (m).
    #[inline]
    pub fn distance(&self, a: &Configuration, b: &Configuration) -> f64 {
        self.length(a.step_to(b))
    }
}
