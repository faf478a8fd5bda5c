//! Two tiles in the frame of one of them, and the interaction between them.

use nalgebra::{Vector2, Vector3};

use super::crowd::{Couple, Crowd};
use super::mover::Mover;
use crate::configuration::{Configuration, wrap_angle};
use crate::tile::outline::cross;

/// The indices of two tiles, in the order of the couple of their kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Two {
    pub first: usize,
    pub second: usize,
}

/// The configuration of a tile's reference point.
pub fn configuration(crowd: &Crowd, mover: &Mover) -> Configuration {
    crowd.kinds[mover.kind].body.configuration(&mover.place)
}

/// The pose of the second in the frame of the first.
pub fn relative(first: &Configuration, second: &Configuration) -> Configuration {
    let p = first.rotation().inverse() * (second.position() - first.position());
    Configuration::new(p.x, p.y, wrap_angle(second.theta - first.theta))
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

/// The energy (J) of two tiles of a couple, and the force and torque on each about its centre of
/// mass (N, N, N m).
pub fn pull(
    crowd: &Crowd,
    couple: &Couple,
    [first, second]: [&Mover; 2],
) -> (f64, [Vector3<f64>; 2]) {
    let [a, b] = [first, second].map(|it| configuration(crowd, it));
    let (energy, force, torque) = couple.pull(&relative(&a, &b));
    let force: Vector2<f64> = a.rotation() * force;
    let about = |mover: &Mover, q: &Configuration| q.position() - mover.place.xy();
    // The forces are equal and opposite, and so are their torques about any one point.
    let of_second = torque + cross(about(second, &b), force);
    let of_first = -torque - cross(b.position() - first.place.xy(), force);
    let pulls = [
        Vector3::new(-force.x, -force.y, of_first),
        Vector3::new(force.x, force.y, of_second),
    ];
    (energy, pulls)
}
