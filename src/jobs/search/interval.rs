//! The bounds between which a figure of a design lies.

use crate::comparison::quantity::NO_TRAPS;
use crate::comparison::{Assessment, Quantity};

/// A figure with its bounds (SI); infinite where nothing is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FigureBounds {
    /// The figure.
    pub value: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl FigureBounds {
    /// The bounds of a figure.
    ///
    /// - The depth of the bond is computed in double precision at its minimum: both bounds.
    /// - A trap that was found is there, so it bounds the depth of the deepest from below and
    ///   selectivity from above. Only the proof that no other state is deeper gives the other bounds.
    ///   Without a trap the depth is 0 and selectivity infinite.
    /// - Barriers have their certified bounds, shares their 95 % intervals.
    /// - Nothing bounds a capture range.
    ///
    /// # Errors
    /// The reason why there is no such figure.
    pub fn of(quantity: &Quantity, design: &Assessment) -> Result<Self, &'static str> {
        let bond = design.bond.as_ref().ok_or("the bond does not hold")?;
        let depth = -bond.energy;
        let trap = design
            .deepest_trap
            .as_ref()
            .map_or(0.0, |trap| -trap.energy);
        let deepest = design
            .unlisted_above
            .map_or(f64::INFINITY, |energy| trap.max(-energy));
        let interval = |value: f64, low: f64, high: f64| Ok(Self { value, low, high });
        match quantity.key {
            "bond_depth" => interval(depth, depth, depth),
            "trap_depth" => interval(trap, trap, deepest),
            // 0 if there are no bounds, infinite if there is no trap.
            "selectivity" => interval(depth / trap, depth / deepest, depth / trap),
            "trap_kinds" => {
                let kinds = design.trap_kinds as f64;
                interval(kinds, kinds, f64::INFINITY)
            }
            _ => match (quantity.read)(design) {
                Ok(reading) => {
                    let estimate = reading.estimate();
                    // Without an upper bound beside a lower one there is no limit: a cage.
                    let low = estimate.low.unwrap_or(f64::NEG_INFINITY);
                    let high = estimate.high.unwrap_or(f64::INFINITY);
                    interval(estimate.value, low, high)
                }
                // The escape from a trap that is not there.
                Err(NO_TRAPS) => interval(0.0, 0.0, f64::INFINITY),
                Err(reason) => Err(reason),
            },
        }
    }

    /// The same, negated: what is smallest becomes largest.
    #[must_use]
    pub fn negated(self) -> Self {
        Self {
            value: -self.value,
            low: -self.high,
            high: -self.low,
        }
    }
}
