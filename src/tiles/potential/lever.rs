//! How far a motion moves the magnets of the moving tile.

use nalgebra::{Vector2, Vector3};

/// The smallest lever (m): magnets at the reference point are not moved by a turn, but their energy
/// changes, so a turn must count as some displacement. Any length is valid for tiles of any size;
/// an unsuitable one costs steps.
const LEAST: f64 = 1e-3;

/// The largest distance (m) of the moving tile's magnets, or of their corners, from its reference
/// point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lever(f64);

impl Lever {
    pub fn of(points: impl Iterator<Item = Vector2<f64>>) -> Self {
        Self(points.map(|point| point.norm()).fold(LEAST, f64::max))
    }

    /// How far (m) the motion (dx, dy, dtheta) moves any of the points, at most.
    pub fn displacement(self, step: Vector3<f64>) -> f64 {
        step.xy().norm() + self.0 * step.z.abs()
    }

    /// The largest turn per displacement (rad/m).
    pub fn turn(self) -> f64 {
        1.0 / self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_counts_even_for_a_magnet_at_the_reference_point() {
        let lever = Lever::of([Vector2::zeros()].into_iter());
        let step = Vector3::new(0.0, 0.0, 0.5);
        assert!(lever.turn() * lever.displacement(step) >= 0.5);
    }

    #[test]
    fn the_farthest_point_moves_farthest() {
        let points = [Vector2::new(0.03, 0.04), Vector2::new(0.0, -0.01)];
        let lever = Lever::of(points.into_iter());
        let moved = lever.displacement(Vector3::new(0.0, 0.002, 0.1));
        assert!((moved - 0.007).abs() < 1e-15, "{moved}");
    }
}
