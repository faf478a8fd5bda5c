//! Bounds over a cell of the energy of magnets behind smoothly acting shields: of point dipoles
//! ([`ShieldedBounds`]) and of any other magnets ([`ShieldedPairBounds`]).
//!
//! Most pairs' factors have a second-order form with a bound of its remainder (see
//! [`Factors`](crate::potential::shielding::kernel::Factors)). A factor that changes too fast for
//! one has an interval. A magnet's factor is `g = eta (1 - S) + G S`, in which eta increases with
//! the distance and S with the cosine. As it is linear in both, it lies between its values at the
//! corners of their ranges.

mod dipoles;
mod pairs;

pub use dipoles::ShieldedBounds;
pub use pairs::ShieldedPairBounds;

use nalgebra::{Rotation2, Vector2};

use super::{Interval, NearPair, depths};
use crate::cell::Cell;
use crate::potential::shielding::kernel::{Columns, Magnet, Pairs, magnets};
use crate::potential::shielding::{Shield, Shields};
use crate::tile::Tile;
use crate::units::MU0_OVER_4PI;

/// Widening of the intervals of near pairs for rounding: relative, and of the reach (m).
const MARGIN: f64 = 1e-11;

/// The magnets of two tiles with their shields.
#[derive(Clone, Debug)]
struct Fronts {
    fixed: Vec<Magnet>,
    moving: Vec<Magnet>,
    /// Distances (m) of the magnets to their own outlines.
    fixed_depths: Vec<f64>,
    moving_depths: Vec<f64>,
    columns: Columns,
    /// Largest distance of a fixed magnet from the origin (m).
    extent: f64,
}

impl Fronts {
    fn new(fixed: &Tile, moving: &Tile, shields: &Shields) -> Self {
        let first = magnets(fixed, &shields.fixed);
        Self {
            fixed_depths: depths(fixed),
            moving_depths: depths(moving),
            columns: Columns::new(&first),
            extent: first.iter().map(|m| m.position.norm()).fold(0.0, f64::max),
            fixed: first,
            moving: magnets(moving, &shields.moving),
        }
    }

    /// The pairs of magnets over a cell.
    fn pairs<'a>(&'a self, cell: &'a Cell) -> Pairs<'a> {
        Pairs {
            fixed: &self.columns,
            moving: &self.moving,
            cell,
            count: self.fixed.len(),
            extent: self.extent,
        }
    }

    /// Whether a shield acts on the pair of a fixed and a moving magnet.
    fn act(&self, i: usize, j: usize) -> bool {
        self.fixed[i].front.0.is_some() || self.moving[j].front.0.is_some()
    }

    /// A fixed and a moving magnet as dipoles over a cell, and the interval of their factor.
    fn interval(
        &self,
        (cell, rotation): (&Cell, &Rotation2<f64>),
        i: usize,
        j: usize,
    ) -> (NearPair, Interval) {
        let moved = self.moving[j].moved(&cell.centre, rotation);
        let fixed = &self.fixed[i];
        let angle = |v: Vector2<f64>| libm::atan2(v.y, v.x);
        let scale = MU0_OVER_4PI;
        let reach = cell.reach(self.moving[j].position.norm()) + MARGIN;
        let pair = NearPair::new(
            (moved.position - fixed.position).into(),
            scale * fixed.moment.norm() * moved.moment.norm(),
            [fixed.moment, moved.moment].map(angle),
            [reach, cell.half[2]],
            self.fixed_depths[i] + self.moving_depths[j],
        );
        let mut factor = Interval::holding([1.0]);
        for ((shield, normal), turn) in [
            (fixed.front, 0.0),
            ((moved.front.0, -moved.front.1), cell.half[2]),
        ] {
            if let Some(shield) = shield {
                let cosines = pair.cosines(angle(normal), turn);
                factor = factor.times(range(&shield, pair.distances, cosines));
            }
        }
        (pair, factor)
    }
}

/// The values of a factor over distances (m) and cosines.
fn range(shield: &Shield, distances: Interval, cosines: Interval) -> Interval {
    let value = |r: f64, cosine: f64| shield.factor(r.max(0.0), cosine);
    let Interval {
        low: near,
        high: far,
    } = distances;
    let Interval { low, high } = cosines;
    let corners = [
        value(near, low),
        value(near, high),
        value(far, low),
        value(far, high),
    ];
    Interval::holding(corners)
}
