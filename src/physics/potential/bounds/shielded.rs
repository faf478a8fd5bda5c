//! Bounds of the energy of shielded dipoles over a cell.
//!
//! Most pairs have a second-order form with a bound of what it leaves out (see
//! [`Forms`]). The others, near each other or where the factor changes too fast,
//! have an interval each, the product of those of the energy and of the two factors:
//!
//! * the energy over the distances and angles within reach, as for bare dipoles ([`NearPair`]);
//! * a factor `g = eta (1 - S) + G S`, in which eta grows with r and S with the cosine: linear in
//!   either, it lies between its values at the corners of their ranges.
//!
//! **Rounding.** Each pair's relative error, of some hundred operations right to 1e-13, is covered by
//! 2e-11 of the bound of its energy, and the rounding of places by 1e-14 of the largest coordinate
//! times the bound of its slope. Assumed, not proved: sine, cosine, arc and exponential functions
//! of the platform are right to 8 units in the last place.

use super::{CellBounds, Enclosure, Interval, NearPair, depths, ends};
use crate::cell::Cell;
use crate::potential::batch::Level;
use crate::potential::shielding::kernel::{Columns, Forms, Magnet, magnets};
use crate::potential::shielding::{Shield, Shields};
use crate::tile::Tile;
use crate::units::MU0_OVER_4PI;
use nalgebra::{Rotation2, Vector2};

/// Widening of the intervals of near pairs for rounding: relative, and of the reach (m).
const MARGIN: f64 = 1e-11;

/// Cell bounds of the interaction energy of two tiles' dipoles behind shields that act smoothly.
#[derive(Clone, Debug)]
pub struct ShieldedBounds {
    level: Level,
    fixed: Vec<Magnet>,
    moving: Vec<Magnet>,
    /// Distances (m) of the magnets to their own outlines.
    fixed_depths: Vec<f64>,
    moving_depths: Vec<f64>,
    columns: Columns,
    /// Largest distance of a fixed magnet from the origin (m).
    extent: f64,
    /// Least and greatest lever of the moving magnets (m).
    levers: Option<[f64; 2]>,
}

impl ShieldedBounds {
    /// For shields that act by the smooth rule; `shields.rule` is not looked at. Faces beyond the
    /// ends of the lists of shields have none.
    pub fn new(fixed: &Tile, moving: &Tile, shields: &Shields) -> Self {
        Self::with_level(fixed, moving, shields, Level::best())
    }

    /// The same for the given instruction set.
    pub fn with_level(fixed: &Tile, moving: &Tile, shields: &Shields, level: Level) -> Self {
        let first = magnets(fixed, &shields.fixed);
        let second = magnets(moving, &shields.moving);
        Self {
            level,
            fixed_depths: depths(fixed),
            moving_depths: depths(moving),
            columns: Columns::new(&first),
            extent: first.iter().map(|m| m.position.norm()).fold(0.0, f64::max),
            fixed: first,
            levers: ends(second.iter().map(Magnet::lever)),
            moving: second,
        }
    }

    /// The interval of the pair of a fixed and a moving magnet; `None` where they may coincide.
    fn interval(
        &self,
        (cell, rotation): (&Cell, &Rotation2<f64>),
        i: usize,
        j: usize,
    ) -> Option<Interval> {
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
        if pair.may_coincide() {
            return None;
        }
        let mut product = pair.energy();
        for ((shield, normal), turn) in [
            (fixed.front, 0.0),
            ((moved.front.0, -moved.front.1), cell.half[2]),
        ] {
            if let Some(shield) = shield {
                let cosines = pair.cosines(angle(normal), turn);
                product = product.times(factor_range(&shield, pair.distances, cosines));
            }
        }
        let margin = MARGIN * (product.size() + pair.greatest_scale());
        Some(product.widened(margin))
    }
}

/// The values of a factor over distances (m) and cosines.
fn factor_range(shield: &Shield, distances: Interval, cosines: Interval) -> Interval {
    let value = |r: f64, cosine: f64| shield.factor(r, cosine);
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

impl CellBounds for ShieldedBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let mut rest = Vec::new();
        let (form, left_out) = self.level.run(Forms {
            fixed: &self.columns,
            moving: &self.moving,
            cell,
            count: self.fixed.len(),
            extent: self.extent,
            rest: &mut rest,
        });
        let mut out = Enclosure::of_order(3.0, form, left_out);
        out.levers = self.levers;
        if !rest.is_empty() {
            out.slope = f64::INFINITY;
        }
        let rotation = cell.centre.rotation();
        for (i, j) in rest {
            let Some(interval) = self.interval((cell, &rotation), i, j) else {
                return Enclosure::unknown();
            };
            let middle = (interval.low + interval.high) / 2.0;
            out.form.value += middle;
            out.low += interval.low - middle;
            out.high += interval.high - middle;
        }
        out
    }

    fn work(&self) -> u64 {
        200 + 4 * self.fixed.len() as u64 * self.moving.len() as u64
    }
}
