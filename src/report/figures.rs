//! Figures of designs for people: numbers with their bounds, or a word that says why there is none.

use jobs::comparison::quantity::{Measure, Reading};
use jobs::comparison::{Assessment, Estimate, Quantity};
use physics::landscape::Proportion;
use physics::units::{plain, prefix_of, share_with, si, si_range};

/// Significant digits of energies.
const DIGITS: usize = 4;

/// The full explanation of a bond that is [not head-on](jobs::comparison::quantity::NOT_HEAD_ON).
pub const WHY_NOT_HEAD_ON: &str = "moved straight to the target face, the tile comes to rest \
    outside the bond: the shape is in the way, or leaves no clearance, as with square teeth";

/// Whether a stable bond has no capture range at all.
pub fn misses_head_on(design: &Assessment) -> bool {
    let bond = design.bond.as_ref();
    bond.is_some_and(|bond| bond.capture_range.is_none())
}

/// Figures for people, with their bounds: `-18.2 to 18.1` for two; if one is missing, the reason.
pub fn cell(quantities: &[&Quantity], design: &Assessment) -> String {
    cell_in(quantities, design, None)
}

/// The same, energies as multiples of a unit that is told elsewhere, if there is one.
pub fn cell_in(quantities: &[&Quantity], design: &Assessment, unit: Option<f64>) -> String {
    let describe = |quantity: &&Quantity| {
        let reading = (quantity.read)(design)?;
        Ok(text(quantity.measure, &reading, unit))
    };
    let texts: Result<Vec<String>, &str> = quantities.iter().map(describe).collect();
    texts.map_or_else(str::to_owned, |texts| texts.join(" to "))
}

fn text(measure: Measure, reading: &Reading, unit: Option<f64>) -> String {
    let estimate = reading.estimate();
    let value = estimate.value;
    let text = match (measure, reading) {
        (_, Reading::Share(share)) => percent(share),
        (Measure::Energy, _) => energy(&estimate, unit),
        (Measure::Length, _) => format!("{:.1}", 1e3 * value),
        (Measure::Angle, _) => format!("{:.1}", value.to_degrees()),
        (Measure::Share, _) => share_with(value, 1),
        (Measure::Ratio, _) => format!("{value:.3}"),
        (Measure::Count, _) => format!("{value}"),
    };
    match reading {
        Reading::AtLimit(value) if *value < 0.0 => format!("\u{2264} {text}"),
        Reading::AtLimit(_) => format!("\u{2265} {text}"),
        _ => text,
    }
}

/// An energy with its bounds: `65.46 mJ [64.84 to 65.46 mJ]`.
fn energy(estimate: &Estimate, unit: Option<f64>) -> String {
    if estimate.value.is_infinite() {
        return "caged, proved".to_owned();
    }
    let value = match unit {
        Some(unit) => plain(estimate.value / unit, DIGITS),
        None => si(estimate.value, "J", DIGITS),
    };
    match (estimate.low, estimate.high, unit) {
        (Some(low), Some(high), Some(unit)) if high > 0.0 => {
            let [low, high] = [low, high].map(|end| plain(end / unit, DIGITS));
            format!("{value} [{low} to {high}]")
        }
        (Some(low), Some(high), None) if high > 0.0 => {
            format!("{value} [{}]", si_range(low, high, "J", DIGITS))
        }
        (Some(_), Some(_), _) => "none, proved".to_owned(),
        _ => value,
    }
}

/// The unit and name of a measure in pictures.
pub struct Shown {
    /// The unit (SI).
    pub unit: f64,
    /// The name of the unit; empty if there is none.
    name: String,
    /// The name of the quantity.
    what: &'static str,
}

impl Shown {
    /// For numbers up to `most`.
    pub fn new(measure: Measure, most: f64) -> Self {
        let prefixed = prefix_of(0.999 * most);
        let (unit, prefix, symbol, what) = match measure {
            Measure::Energy => (prefixed.0, prefixed.1, "J", "energy"),
            Measure::Length => (1e-3, "m", "m", "length"),
            Measure::Angle => (1f64.to_radians(), "", "°", "angle"),
            Measure::Share => (0.01, "", "%", "far starts"),
            Measure::Ratio => (1.0, "", "", "ratio"),
            Measure::Count => (1.0, "", "", "number"),
        };
        let name = format!("{prefix}{symbol}");
        Self { unit, name, what }
    }

    /// A text with the unit: `depth (mJ)`.
    pub fn named(&self, text: &str) -> String {
        match &self.name[..] {
            "" => text.to_owned(),
            name => format!("{text} ({name})"),
        }
    }

    /// The name of an axis: `energy (mJ)`.
    pub fn axis(&self) -> String {
        self.named(self.what)
    }
}

/// `5.2 (4.9 to 5.4)`: a number with its interval.
pub fn within(value: f64, ends: [f64; 2], describe: impl Fn(f64) -> String) -> String {
    let [low, high] = ends.map(&describe);
    format!("{} ({low} to {high})", describe(value))
}

/// `42 %`; two decimals below one percent.
pub fn share(value: f64) -> String {
    let percent = 100.0 * value;
    share_with(value, if percent > 0.0 && percent < 1.0 { 2 } else { 0 })
}

/// `56 % (53-59)`, with the interval.
pub fn percent(proportion: &Proportion) -> String {
    if proportion.of == 0 {
        return "not counted".to_owned();
    }
    let percents = [proportion.share(), proportion.low, proportion.high].map(|x| 100.0 * x);
    let [_, low, high] = percents;
    // Whole per cents, unless the interval is narrower than two; but 0 only for none and 100 only
    // for all, and these without decimals.
    let decimals = if high - low < 0.2 {
        2
    } else {
        usize::from(high - low < 2.0)
    };
    let [share, low, high] = percents.map(|percent| {
        let is_near_an_end = !(1.0..=99.0).contains(&percent);
        let decimals = match percent {
            0.0 | 100.0 => 0,
            _ => decimals.max(usize::from(is_near_an_end)),
        };
        format!("{percent:.decimals$}")
    });
    format!("{share} % ({low}-{high})")
}
