//! The table of compared quantities.
//!
//! A new quantity needs only one entry in [`QUANTITIES`]: files, the tables of `compare`, pages,
//! the curves and maps of sweeps, the picture of the ranking and `--by` all read it from there.
//! Columns in files have the order of the entries; tables and pictures are arranged by [`Slot`]s.

use std::collections::BTreeMap;

use super::{Assessment, Bond, CaptureRange, Trap};
use physics::landscape::Proportion;

use Measure::{Angle, Count, Energy, Length, Ratio, Share};
use Reading::Number;

/// The short reason why a bond has no capture range.
pub const NOT_HEAD_ON: &str = "not head-on";
/// The reason why there is no figure of the deepest trap.
pub const NO_TRAPS: &str = "no traps";

/// A figure with its bounds, if known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Infinite for the climb out of a cage.
    pub value: f64,
    /// `None` if no bounds are known; infinite for the climb out of a cage.
    pub low: Option<f64>,
    /// `None` if no bounds are known, and for the climb out of a cage.
    pub high: Option<f64>,
}

impl Estimate {
    /// The value and its bounds, `None` if not known or not finite.
    pub fn finite(&self) -> [Option<f64>; 3] {
        [Some(self.value), self.low, self.high].map(|number| number.filter(|v| v.is_finite()))
    }
}

/// The value of a quantity in an [`Assessment`], in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// Without bounds.
    Number(f64),
    /// A value at the limit of the search: the true value may be larger.
    AtLimit(f64),
    /// A value with known bounds.
    Bounded(Estimate),
    /// A counted share with its 95 % interval.
    Share(Proportion),
}

impl Reading {
    /// The value with its bounds (SI).
    pub fn estimate(&self) -> Estimate {
        let (value, low, high) = match self {
            Self::Number(value) | Self::AtLimit(value) => (*value, None, None),
            Self::Bounded(estimate) => return *estimate,
            Self::Share(share) => (share.share(), Some(share.low), Some(share.high)),
        };
        Estimate { value, low, high }
    }
}

/// The dimension of a quantity, which determines the unit and how numbers are written and drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// In J, shown with a prefix.
    Energy,
    /// In m, shown in mm.
    Length,
    /// In rad, shown in degrees.
    Angle,
    /// From 0 to 1, shown in percent.
    Share,
    /// Drawn on a logarithmic axis if it spans more than two powers of ten.
    Ratio,
    /// A whole number.
    Count,
}

impl Measure {
    /// SI unit; empty for numbers without one.
    pub fn unit(self) -> &'static str {
        match self {
            Energy => "J",
            Length => "m",
            Angle => "rad",
            Share | Ratio | Count => "",
        }
    }
}

/// The suffixes in files of the lower and upper bounds proved for the stated model.
pub const CERTIFIED: Option<[&str; 2]> = Some(["lower", "upper"]);
/// The suffixes of the ends of a 95 % interval.
const INTERVAL: Option<[&str; 2]> = Some(["low", "high"]);

/// The position of a quantity among others, from 0. The two sides of a range share a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Slot {
    /// The table, the row of panels, or the plot of the ranking.
    pub row: u8,
    /// The column in it; in the ranking's plots, the colour.
    pub column: u8,
    /// Its name there, without the unit.
    pub heading: &'static str,
}

const fn at(row: u8, column: u8, heading: &'static str) -> Option<Slot> {
    Some(Slot {
        row,
        column,
        heading,
    })
}

/// The description of a quantity.
#[derive(Debug)]
pub struct Quantity {
    /// Name in files and on the command line, without the unit.
    pub key: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Determines the unit and how numbers are shown.
    pub measure: Measure,
    /// The suffixes of its bounds in files, `None` if it has none.
    pub bounds: Option<[&'static str; 2]>,
    /// Its place in the tables of `compare`.
    pub column: Option<Slot>,
    /// Its place among a sweep's curves.
    pub panel: Option<Slot>,
    /// Whether a sweep's maps also show its panel.
    pub mapped: bool,
    /// Its place in the picture of the ranking, with its name there: a bar among the depths (row 0;
    /// a ratio is written beside the bars), or a point among the barriers (1) or captures (2).
    pub ranking: Option<Slot>,
    /// The page's name for the design with the largest value.
    pub most: Option<&'static str>,
    /// Whether the page shows it for the point under the pointer.
    pub in_readout: bool,
    /// Whether it is computed only on request: left out where no design has it.
    pub is_asked_for: bool,
    /// Reads its value, or the reason why there is none.
    pub read: fn(&Assessment) -> Result<Reading, &'static str>,
}

/// The base of an entry: a quantity that is only in files and in the pages' tables.
#[rustfmt::skip]
const PLAIN: Quantity = Quantity {
    key: "", label: "", measure: Count, bounds: None, column: None, panel: None, mapped: false,
    ranking: None, most: None, in_readout: false, is_asked_for: false, read: |_| Err("not known"),
};

/// All quantities, in the order of files.
#[rustfmt::skip]
pub static QUANTITIES: &[Quantity] = &[
    Quantity {
        key: "bond_depth", label: "bond", measure: Energy,
        column: at(0, 0, "bond"), panel: at(0, 0, "bond: depth"), mapped: true,
        ranking: at(0, 0, "bond"), most: Some("deepest bond"), in_readout: true,
        read: |a| Ok(Number(-bond(a).or(Err("does not hold"))?.energy)), ..PLAIN
    },
    Quantity {
        key: "trap_depth", label: "deepest trap", measure: Energy,
        column: at(0, 1, "deepest trap"), panel: at(0, 1, "deepest trap: depth"), mapped: true,
        ranking: at(0, 2, "deepest trap"), in_readout: true,
        read: |a| Ok(Number(-trap(a)?.energy)), ..PLAIN
    },
    Quantity {
        key: "trap_escape", label: "escape from it", measure: Energy, bounds: CERTIFIED,
        column: at(1, 2, "escape from the deepest trap"),
        panel: at(1, 1, "escape from the deepest trap"), mapped: true,
        ranking: at(1, 2, "escape from trap"),
        read: |a| climb(trap(a)?.escape.climb(trap(a)?.energy)), ..PLAIN
    },
    Quantity {
        key: "selectivity", label: "selectivity", measure: Ratio,
        column: at(0, 2, "selectivity"), panel: at(0, 2, "selectivity"), mapped: true,
        ranking: at(0, 3, "selectivity"),
        read: |a| Ok(Number(bond(a)?.energy / trap(a)?.energy)), ..PLAIN
    },
    Quantity {
        key: "unbinding", label: "unbinding barrier", measure: Energy, bounds: CERTIFIED,
        column: at(1, 0, "unbinding barrier"), panel: at(1, 0, "unbinding barrier"), mapped: true,
        ranking: at(1, 0, "unbinding"), most: Some("highest unbinding barrier"), in_readout: true,
        read: |a| climb(bond(a)?.way_out.climb(bond(a)?.energy)), ..PLAIN
    },
    Quantity {
        key: "binding", label: "binding barrier", measure: Energy, bounds: CERTIFIED,
        column: at(1, 1, "binding barrier"), panel: at(1, 2, "binding barrier"),
        ranking: at(1, 1, "binding"),
        read: |a| climb(bond(a)?.way_out.climb(0.0)), ..PLAIN
    },
    Quantity {
        key: "captured", label: "captured", measure: Share, bounds: INTERVAL,
        column: at(0, 3, "captured"), panel: at(2, 0, "captured far starts"), mapped: true,
        ranking: at(2, 0, "captured"), most: Some("most captured"), in_readout: true,
        read: |a| share(a.captured, a.far_starts), ..PLAIN
    },
    Quantity {
        key: "capture_offset_low", label: "offset \u{2212}", measure: Length,
        column: at(0, 4, "offset"), panel: at(2, 1, "capture range: offset to either side"),
        read: |a| range(a).map(|range| reach(range.offset[0], range.limits[0])), ..PLAIN
    },
    Quantity {
        key: "capture_offset_high", label: "offset +", measure: Length,
        column: at(0, 4, "offset"), panel: at(2, 1, "capture range: offset to either side"),
        read: |a| range(a).map(|range| reach(range.offset[1], range.limits[0])), ..PLAIN
    },
    Quantity {
        key: "capture_gap", label: "gap", measure: Length, column: at(0, 5, "gap"),
        read: |a| range(a).map(|range| reach(range.gap, range.limits[1])), ..PLAIN
    },
    Quantity {
        key: "capture_tilt_low", label: "tilt \u{2212}", measure: Angle,
        column: at(0, 6, "tilt"), panel: at(2, 2, "capture range: tilt to either side"),
        read: |a| range(a).map(|range| reach(range.tilt[0], range.limits[2])), ..PLAIN
    },
    Quantity {
        key: "capture_tilt_high", label: "tilt +", measure: Angle,
        column: at(0, 6, "tilt"), panel: at(2, 2, "capture range: tilt to either side"),
        read: |a| range(a).map(|range| reach(range.tilt[1], range.limits[2])), ..PLAIN
    },
    Quantity {
        key: "trap_kinds", label: "kinds of trap", measure: Count,
        column: at(1, 3, "kinds of trap"),
        read: |a| Ok(Number(a.trap_kinds as f64)), ..PLAIN
    },
    Quantity {
        key: "unlisted_depth", label: "unlisted at most", measure: Energy,
        column: at(1, 4, "unlisted"),
        read: unlisted, ..PLAIN
    },
    Quantity {
        key: "robust", label: "work as made", measure: Share, bounds: INTERVAL, is_asked_for: true,
        column: at(0, 7, "work as made"), most: Some("most robust"),
        read: |a| a.robust.map(Reading::Share).ok_or("no errors stated"), ..PLAIN
    },
];

/// The largest possible depth of an unlisted state; a limit deeper than the bond is meaningless.
fn unlisted(assessment: &Assessment) -> Result<Reading, &'static str> {
    let deepest = assessment
        .bond
        .as_ref()
        .map_or(assessment.target_energy, |bond| bond.energy);
    let known = assessment.unlisted_above.filter(|energy| *energy > deepest);
    known.map(|energy| Number(-energy)).ok_or("not proved")
}

fn bond(assessment: &Assessment) -> Result<&Bond, &'static str> {
    assessment.bond.as_ref().ok_or("no bond")
}

fn trap(assessment: &Assessment) -> Result<&Trap, &'static str> {
    assessment.deepest_trap.as_ref().ok_or(NO_TRAPS)
}

fn climb(climb: Option<Estimate>) -> Result<Reading, &'static str> {
    climb.map(Reading::Bounded).ok_or("no path found")
}

fn share(count: usize, of: usize) -> Result<Reading, &'static str> {
    let counted = (of > 0).then(|| Reading::Share(Proportion::new(count, of)));
    counted.ok_or("not counted")
}

fn range(assessment: &Assessment) -> Result<&CaptureRange, &'static str> {
    bond(assessment)?.capture_range.as_ref().ok_or(NOT_HEAD_ON)
}

/// The capture range to one side, with the limit of the search.
fn reach(amount: f64, limit: f64) -> Reading {
    if amount.abs() >= limit {
        Reading::AtLimit(amount)
    } else {
        Number(amount)
    }
}

impl Quantity {
    /// Whether it is left out of the tables of designs.
    pub fn is_left_out<'a>(&self, mut of: impl Iterator<Item = &'a Assessment>) -> bool {
        self.is_asked_for && !of.any(|one| self.of(one).is_some())
    }

    /// The figure; `None` if there is none, such as the depth of a bond that does not hold.
    pub fn of(&self, assessment: &Assessment) -> Option<Estimate> {
        Some((self.read)(assessment).ok()?.estimate())
    }

    /// Name in files with the unit: `unbinding_J`. `part`, such as `_lower`, is inserted between
    /// the two.
    pub fn name(&self, part: &str) -> String {
        match self.measure.unit() {
            "" => format!("{}{part}", self.key),
            unit => format!("{}{part}_{unit}", self.key),
        }
    }
}

/// The quantities that have a place, in the order of places; those of one place are grouped.
pub fn placed(place: impl Fn(&Quantity) -> Option<Slot>) -> BTreeMap<Slot, Vec<&'static Quantity>> {
    let mut places = BTreeMap::<_, Vec<_>>::new();
    for quantity in QUANTITIES {
        if let Some(place) = place(quantity) {
            places.entry(place).or_default().push(quantity);
        }
    }
    places
}
