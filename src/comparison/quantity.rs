//! The figures that are compared, each with its name, unit and bounds.

use super::Assessment;
use crate::landscape::Proportion;

/// A figure, and between which bounds it lies where bounds are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Infinite for the climb out of a cage.
    pub value: f64,
    /// Lower bound, or lower end of the interval; `None` where there is none.
    pub low: Option<f64>,
    /// Upper bound, or upper end of the interval; `None` where there is none.
    pub high: Option<f64>,
}

impl Estimate {
    fn exact(value: f64) -> Self {
        Self {
            value,
            low: None,
            high: None,
        }
    }
}

/// What kind of bounds a figure has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounds {
    /// The figure has no bounds.
    None,
    /// Proved for the stated model.
    Certified,
    /// A 95 % interval.
    Interval,
}

/// A figure of an [`Assessment`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// -U of the bond (J).
    BondDepth,
    /// -U of the deepest trap (J).
    TrapDepth,
    /// The climb (J) from the deepest trap to its barrier's highest energy.
    TrapEscape,
    /// The bond's energy as a multiple of the deepest trap's.
    Selectivity,
    /// The climb (J) from the bond to its barrier's highest energy.
    Unbinding,
    /// The climb (J) from free tiles, at U = 0, to the highest energy on the way to the bond.
    Binding,
    /// The share of far starts that end in the bond.
    Captured,
    /// The capture range's lowest offset along the target face (m, at most 0).
    OffsetLow,
    /// The capture range's highest offset along the target face (m, at least 0).
    OffsetHigh,
    /// The capture range's widest gap (m).
    Gap,
    /// The capture range's lowest tilt (rad, at most 0).
    TiltLow,
    /// The capture range's highest tilt (rad, at least 0).
    TiltHigh,
    /// The number of traps, symmetric copies counted once.
    TrapKinds,
}

impl Quantity {
    /// All of them, in the order of tables.
    pub const ALL: [Self; 13] = [
        Self::BondDepth,
        Self::TrapDepth,
        Self::TrapEscape,
        Self::Selectivity,
        Self::Unbinding,
        Self::Binding,
        Self::Captured,
        Self::OffsetLow,
        Self::OffsetHigh,
        Self::Gap,
        Self::TiltLow,
        Self::TiltHigh,
        Self::TrapKinds,
    ];

    /// Name in files, without the unit.
    pub fn key(self) -> &'static str {
        match self {
            Self::BondDepth => "bond_depth",
            Self::TrapDepth => "trap_depth",
            Self::TrapEscape => "trap_escape",
            Self::Selectivity => "selectivity",
            Self::Unbinding => "unbinding",
            Self::Binding => "binding",
            Self::Captured => "captured",
            Self::OffsetLow => "capture_offset_low",
            Self::OffsetHigh => "capture_offset_high",
            Self::Gap => "capture_gap",
            Self::TiltLow => "capture_tilt_low",
            Self::TiltHigh => "capture_tilt_high",
            Self::TrapKinds => "trap_kinds",
        }
    }

    /// SI unit; empty for numbers without one.
    pub fn unit(self) -> &'static str {
        match self {
            Self::BondDepth
            | Self::TrapDepth
            | Self::TrapEscape
            | Self::Unbinding
            | Self::Binding => "J",
            Self::OffsetLow | Self::OffsetHigh | Self::Gap => "m",
            Self::TiltLow | Self::TiltHigh => "rad",
            Self::Selectivity | Self::Captured | Self::TrapKinds => "",
        }
    }

    /// Name in files with the unit: `unbinding_J`. `part` is between the two, such as `_lower`.
    pub fn column(self, part: &str) -> String {
        match self.unit() {
            "" => format!("{}{part}", self.key()),
            unit => format!("{}{part}_{unit}", self.key()),
        }
    }

    /// Name for people.
    pub fn label(self) -> &'static str {
        match self {
            Self::BondDepth => "bond",
            Self::TrapDepth => "deepest trap",
            Self::TrapEscape => "escape from it",
            Self::Selectivity => "selectivity",
            Self::Unbinding => "unbinding barrier",
            Self::Binding => "binding barrier",
            Self::Captured => "captured",
            Self::OffsetLow => "offset \u{2212}",
            Self::OffsetHigh => "offset +",
            Self::Gap => "gap",
            Self::TiltLow => "tilt \u{2212}",
            Self::TiltHigh => "tilt +",
            Self::TrapKinds => "kinds of trap",
        }
    }

    /// What kind of bounds the figure has.
    pub fn bounds(self) -> Bounds {
        match self {
            Self::TrapEscape | Self::Unbinding | Self::Binding => Bounds::Certified,
            Self::Captured => Bounds::Interval,
            _ => Bounds::None,
        }
    }

    /// The figure; `None` where there is none, such as the depth of a bond that does not hold.
    pub fn of(self, assessment: &Assessment) -> Option<Estimate> {
        let bond = assessment.bond.as_ref();
        let trap = assessment.deepest_trap.as_ref();
        let range = bond.and_then(|bond| bond.capture_range.as_ref());
        match self {
            Self::BondDepth => bond.map(|bond| Estimate::exact(-bond.energy)),
            Self::TrapDepth => trap.map(|trap| Estimate::exact(-trap.energy)),
            Self::TrapEscape => trap.and_then(|trap| trap.escape.climb(trap.energy)),
            Self::Selectivity => {
                let both = bond.zip(trap);
                both.map(|(bond, trap)| Estimate::exact(bond.energy / trap.energy))
            }
            Self::Unbinding => bond.and_then(|bond| bond.way_out.climb(bond.energy)),
            Self::Binding => bond.and_then(|bond| bond.way_out.climb(0.0)),
            Self::Captured => captured(assessment),
            Self::OffsetLow => range.map(|range| Estimate::exact(range.offset[0])),
            Self::OffsetHigh => range.map(|range| Estimate::exact(range.offset[1])),
            Self::Gap => range.map(|range| Estimate::exact(range.gap)),
            Self::TiltLow => range.map(|range| Estimate::exact(range.tilt[0])),
            Self::TiltHigh => range.map(|range| Estimate::exact(range.tilt[1])),
            Self::TrapKinds => Some(Estimate::exact(assessment.trap_kinds as f64)),
        }
    }
}

fn captured(assessment: &Assessment) -> Option<Estimate> {
    if assessment.far_starts == 0 {
        return None;
    }
    let share = Proportion::new(assessment.captured, assessment.far_starts);
    Some(Estimate {
        value: share.share(),
        low: Some(share.low),
        high: Some(share.high),
    })
}
