//! Two tiles in the frame of one of them, and the interaction between them.

use nalgebra::{Rotation2, Vector2, Vector3};

use super::World;
use super::mover::Mover;
use tiles::configuration::{Configuration, wrap_angle};
use tiles::tile::outline::cross;

/// The indices of two tiles, in the order of the couple of their kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Two {
    pub first: usize,
    pub second: usize,
}

/// The configuration of a tile's reference point, with its rotation.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// The configuration.
    pub at: Configuration,
    /// The rotation by its angle.
    pub rotation: Rotation2<f64>,
}

impl Pose {
    /// That of a configuration.
    pub fn new(at: Configuration) -> Self {
        Self {
            at,
            rotation: at.rotation(),
        }
    }

    /// That of a tile.
    pub fn of(world: &impl World, mover: &Mover) -> Self {
        let (at, rotation) = world.body(mover.kind).pose(&mover.place);
        Self { at, rotation }
    }

    /// A point of the tile's frame on the table (m).
    pub fn transform(&self, local: Vector2<f64>) -> Vector2<f64> {
        self.at.position() + self.rotation * local
    }

    /// A point on the table in the tile's frame (m).
    pub fn inverse_transform(&self, point: Vector2<f64>) -> Vector2<f64> {
        self.rotation.inverse() * (point - self.at.position())
    }

    /// The configuration of another tile in the frame of this one.
    pub fn to(&self, other: &Configuration) -> Configuration {
        let p = self.inverse_transform(other.position());
        Configuration::new(p.x, p.y, wrap_angle(other.theta - self.at.theta))
    }
}

impl Two {
    /// Creates it from two tiles and their kinds.
    pub fn of(kinds: [usize; 2], [i, j]: [usize; 2]) -> Self {
        match kinds[0] <= kinds[1] {
            true => Self {
                first: i,
                second: j,
            },
            false => Self {
                first: j,
                second: i,
            },
        }
    }
}

/// The energy (J) of two tiles, the force (N) on the second in the frame of the first and the torque (N m)
/// about its reference point.
pub type Within = (f64, Vector2<f64>, f64);

/// The energy (J) of two tiles, and the force and torque on each about its centre of mass (N, N,
/// N m).
pub type Pull = (f64, [Vector3<f64>; 2]);

/// The pull on the table, in the order of a [`Two`], from that in the frame of the first.
pub fn on_the_table(
    (energy, force, torque): Within,
    [first, second]: [&Mover; 2],
    [a, b]: [&Pose; 2],
) -> Pull {
    let force: Vector2<f64> = a.rotation * force;
    let arm = |mover: &Mover| b.at.position() - mover.place.xy();
    // The forces are equal and opposite, and so are their torques about any one point.
    let of_second = torque + cross(arm(second), force);
    let of_first = -torque - cross(arm(first), force);
    let pulls = [
        Vector3::new(-force.x, -force.y, of_first),
        Vector3::new(force.x, force.y, of_second),
    ];
    (energy, pulls)
}
