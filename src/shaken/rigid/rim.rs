//! The rim of a table.

use std::f64::consts::PI;

use nalgebra::Vector2;

/// The rim, whose centre is the origin.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Rim {
    /// A rectangle with half its size along x and y (m).
    Rectangle([f64; 2]),
    /// A circle with this radius (m).
    Disc(f64),
}

impl Rim {
    /// Half the size (m) of the rectangle around it.
    pub fn half_size(self) -> [f64; 2] {
        match self {
            Self::Rectangle(half) => half,
            Self::Disc(radius) => [radius; 2],
        }
    }

    /// The radius (m) of a circle.
    pub fn radius(self) -> Option<f64> {
        match self {
            Self::Rectangle(_) => None,
            Self::Disc(radius) => Some(radius),
        }
    }

    /// The area within (m^2).
    pub fn area(self) -> f64 {
        match self {
            Self::Rectangle([x, y]) => 4.0 * x * y,
            Self::Disc(radius) => PI * radius * radius,
        }
    }

    /// The distance (m) of a point from the rim; negative beyond it.
    pub fn room(self, p: Vector2<f64>) -> f64 {
        match self {
            Self::Rectangle([x, y]) => (x - p.x.abs()).min(y - p.y.abs()),
            Self::Disc(radius) => radius - p.norm(),
        }
    }

    /// The sides of the rim that a point is near: the normal inwards and the distance (m).
    pub fn sides(self, p: Vector2<f64>) -> impl Iterator<Item = (Vector2<f64>, f64)> {
        let sides = match self {
            Self::Rectangle([x, y]) => [
                Some((Vector2::new(-p.x.signum(), 0.0), x - p.x.abs())),
                Some((Vector2::new(0.0, -p.y.signum()), y - p.y.abs())),
            ],
            Self::Disc(radius) => {
                let from = p.norm();
                [(from > 0.0).then(|| (-p / from, radius - from)), None]
            }
        };
        sides.into_iter().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_has_the_same_room_by_its_nearest_side() {
        for rim in [Rim::Rectangle([0.3, 0.2]), Rim::Disc(0.25)] {
            for p in [[0.1, 0.05], [-0.2, 0.19], [0.0, -0.24]].map(Vector2::from) {
                let nearest = rim.sides(p).map(|it| it.1).fold(f64::INFINITY, f64::min);
                assert!((nearest - rim.room(p)).abs() < 1e-15);
                for (inwards, gap) in rim.sides(p) {
                    assert!((rim.room(p - inwards * gap)).abs() < 1e-12 || rim.radius().is_none());
                }
            }
        }
        assert_eq!(Rim::Disc(1.0).area(), PI);
    }
}
