//! Figures of designs for people: numbers with their bounds, or the word for why there is none.

use super::summary::percent;
use crate::comparison::{Assessment, Estimate, Quantity};
use crate::landscape::Proportion;
use crate::units::{si, si_range};

/// Significant digits of energies.
const DIGITS: usize = 4;

/// Why a bond has no capture range, in short.
pub const NOT_HEAD_ON: &str = "not head-on";

/// And at length.
pub const WHY_NOT_HEAD_ON: &str = "brought straight up to the target face, the tile comes to rest \
    outside the bond: there is no way past the shape, or no play along it, as between square teeth";

/// Whether a bond that holds has no capture range at all.
pub fn misses_head_on(design: &Assessment) -> bool {
    let bond = design.bond.as_ref();
    bond.is_some_and(|bond| bond.capture_range.is_none())
}

/// Why a figure is not known.
fn missing(quantity: Quantity, design: &Assessment) -> &'static str {
    match quantity {
        Quantity::BondDepth => "does not hold",
        Quantity::TrapDepth => "no traps",
        Quantity::TrapEscape if design.trap_kinds == 0 => "no traps",
        Quantity::TrapEscape => "no way found",
        Quantity::Captured => "not counted",
        _ if design.bond.is_none() => "no bond",
        Quantity::Selectivity => "no traps",
        Quantity::Unbinding | Quantity::Binding => "no way found",
        _ => NOT_HEAD_ON,
    }
}

/// A figure for people, with its bounds; where there is none, why.
pub fn cell(quantity: Quantity, design: &Assessment) -> String {
    let Some(estimate) = quantity.of(design) else {
        return missing(quantity, design).to_owned();
    };
    let value = estimate.value;
    match (quantity, quantity.unit()) {
        (Quantity::Captured, _) => percent(&Proportion::new(design.captured, design.far_starts)),
        (Quantity::TrapKinds, _) => format!("{value}"),
        (_, "J") => energy(&estimate),
        (_, "m") => at_least(quantity, design, &format!("{:.1}", 1e3 * value)),
        (_, "rad") => at_least(quantity, design, &format!("{:.1}", value.to_degrees())),
        _ => format!("{value:.3}"),
    }
}

/// A capture range, marked where it reaches the limit of what was looked at.
fn at_least(quantity: Quantity, design: &Assessment, text: &str) -> String {
    let range = design.bond.as_ref().and_then(|bond| bond.capture_range);
    let at_limit = range.is_some_and(|range| match quantity {
        Quantity::OffsetLow => range.offset[0] <= -range.limits[0],
        Quantity::OffsetHigh => range.offset[1] >= range.limits[0],
        Quantity::Gap => range.gap >= range.limits[1],
        Quantity::TiltLow => range.tilt[0] <= -range.limits[2],
        _ => range.tilt[1] >= range.limits[2],
    });
    match (at_limit, quantity) {
        (false, _) => text.to_owned(),
        (true, Quantity::OffsetLow | Quantity::TiltLow) => format!("\u{2264} {text}"),
        (true, _) => format!("\u{2265} {text}"),
    }
}

/// An energy with its bounds: `65.46 mJ [64.84 to 65.46 mJ]`.
fn energy(estimate: &Estimate) -> String {
    if estimate.value.is_infinite() {
        return "no way, proved".to_owned();
    }
    let value = si(estimate.value, "J", DIGITS);
    match (estimate.low, estimate.high) {
        (Some(low), Some(high)) if high > 0.0 => {
            format!("{value} [{}]", si_range(low, high, "J", DIGITS))
        }
        (Some(_), Some(_)) => "none, proved".to_owned(),
        _ => value,
    }
}

/// `-18.2 to 18.1`.
pub fn to_either_side(design: &Assessment, quantities: [Quantity; 2]) -> String {
    let sides = quantities.map(|quantity| cell(quantity, design));
    match quantities.map(|quantity| quantity.of(design)) {
        [Some(_), Some(_)] => sides.join(" to "),
        _ => sides[0].clone(),
    }
}
