//! Exits and rates of overdamped motion, for people and for programs.

mod csv;
mod exit;
mod files;
mod over_kt;
mod place;
mod summary;
mod table;

pub use exit::{check_entry, check_summary, exit_entry, exit_summary};
pub use files::{files, report};
pub use over_kt::{AtKt, over_kt};
pub use place::Place;
pub use table::Table;

use serde_json::{Value, json};

use jobs::design::Design;
use physics::kinetics::Capacity;
use physics::units::{duration_to, plain};

/// Overdamped motion on an air table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Drag rate c / mass (1/s).
    pub drag: f64,
    /// D = kT / c (m^2/s).
    pub diffusion: f64,
}

impl Motion {
    /// Of a design's moving tile at kT (J) with this drag rate (1/s).
    pub fn new(design: &Design, kt: f64, drag: f64) -> Self {
        Self {
            drag,
            diffusion: kt / (drag * design.pair.moving.mass),
        }
    }
}

/// Where kT means something.
const SCOPE: &str = "  overdamped motion, knocks without loss: drag of 50 /s and more; at less \
                     drag, or where knocks\n  take energy that shaking does not give back, there \
                     is no such kT\n";

/// What is said of bounds.
const ON_THE_MESH: &str = "bounds hold on the mesh (Dirichlet, Thomson); what its integrals over \
                           cells are off by is not bounded";
/// What is not in bounds that hold on the mesh.
const NOT_BOUNDED: [&str; 2] = [
    "the integrals of exp(-U/kT) and exp(U/kT) over cells, by Gauss' rule",
    "basins made of whole cells: mesh.of_basins is what that shifts capacities by, an estimate",
];
const NO_BOUNDS: &str = "no bounds: they are of a start in a well";
/// Of outlines with walls along rays or across them twice.
const ONE_SIDED: &str = "the other bound needs fluxes along contact, which are laid where every ray \
                         from the centre leaves contact once";

/// Proved bounds of how often tiles leave a set, as an object.
fn proved_entry(motion: &Motion, proved: Option<&Capacity>) -> Value {
    proved.map_or(Value::Null, |proved| {
        json!({
            "set_below_J": proved.below,
            "capacity_rad": proved.capacity,
            "held_m2_rad": proved.held,
            "leaving_set_per_s": leaving_set(motion, proved),
            "mean_exit_s": mean_exit(motion, proved).map(finite),
        })
    })
}

/// Proved bounds (1/s) of how often a tile leaves a set for an end, by the time spent in the set.
fn leaving_set(motion: &Motion, proved: &Capacity) -> [f64; 2] {
    proved.leaving().map(|end| end * motion.diffusion)
}

/// Proved bounds (s) of the mean time until a tile that leaves the set for an end is there.
fn mean_exit(motion: &Motion, proved: &Capacity) -> [f64; 2] {
    proved.mean_exit().map(|end| end / motion.diffusion)
}

/// Bounds rounded outwards, to three digits of either.
pub(crate) fn outwards([lower, upper]: [f64; 2]) -> [f64; 2] {
    let unit = |end: f64| 10f64.powi(libm::log10(end).floor() as i32 - 2);
    let to = |end: f64, round: fn(f64) -> f64| match end > 0.0 && end.is_finite() {
        true => round(end / unit(end)) * unit(end),
        false => end,
    };
    [to(lower, f64::floor), to(upper, f64::ceil)]
}

/// As many digits of a value, from `digits` on, as keep it between its bounds.
fn digits_between(value: f64, digits: usize, [lower, upper]: [Option<f64>; 2]) -> usize {
    /// More are not told.
    const MOST: usize = 6;
    let is_between = |digits: &usize| {
        let told: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
        lower.is_none_or(|lower| lower <= told) && upper.is_none_or(|upper| told <= upper)
    };
    (digits..MOST).find(is_between).unwrap_or(MOST)
}

/// Proved bounds in words, rounded outwards: how often per second.
fn proved_words([lower, upper]: [f64; 2]) -> String {
    let [low, high] = outwards([lower, upper]).map(|end| plain(end, 3));
    format!(
        "{low} to {high} times per second ({} apart)",
        apart([lower, upper])
    )
}

/// Bounds that are farther apart than so many times say nothing worth telling.
pub(crate) const FAR: f64 = 10.0;

/// Proved bounds (s) of a mean exit time that are worth telling, with their words, rounded outwards.
pub(crate) fn mean_exit_ends(motion: &Motion, proved: &Capacity) -> [Option<(f64, String)>; 2] {
    let [least, most] = mean_exit(motion, proved);
    [
        Some((least, duration_to(least, 3, f64::floor))),
        (most < FAR * least).then(|| (most, duration_to(most, 3, f64::ceil))),
    ]
}

/// Proved bounds of a mean exit time in words.
fn mean_exit_words(motion: &Motion, proved: &Capacity) -> String {
    match mean_exit_ends(motion, proved) {
        [Some((lower, least)), Some((upper, most))] => {
            format!("{least} to {most} ({} apart)", apart([lower, upper]))
        }
        [least, _] => format!("{} at least", least.map_or(String::new(), |it| it.1)),
    }
}

/// What is said where a proof was asked for and there is none.
pub(crate) const NOT_PROVED: &str = "nothing is proved: that takes tiles that are convex about their centres \
                          of mass, of few corners,\n  an energy with bounds over cells, and sets \
                          that the mesh tells apart";
/// What is proved.
pub(crate) const PROVED: &str = "proved (integrals and sets enclosed, rounding included)";

/// How far apart bounds are, in percent of the lower one, or how many times it.
fn apart([lower, upper]: [f64; 2]) -> String {
    match upper / lower {
        times if lower <= 0.0 || !times.is_finite() => "any factor".to_owned(),
        times if times < 2.0 => format!("{:.1} %", 100.0 * (times - 1.0)),
        times => format!("{} times", plain(times, 2)),
    }
}

/// A rate, to so many digits.
pub(crate) fn per_second(rate: f64, digits: usize) -> String {
    format!("{} /s", plain(rate, digits))
}

/// A share of all, to three digits.
pub(crate) fn share(part: f64) -> String {
    // 1 - 1e-9 is all but nothing, and no more is known of it.
    format!("{} %", plain(100.0 * part, 3))
}

/// How many digits a figure has that is off by this share of it.
pub(crate) fn digits(error: f64) -> usize {
    match error {
        _ if error < 0.005 => 3,
        _ if error < 0.1 => 2,
        _ => 1,
    }
}

/// A number that JSON has.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// An area with four digits; small and large ones with a power of ten, for m² takes no prefix well.
fn area(value: f64) -> String {
    if (1e-4..1e4).contains(&value) {
        format!("{value:.4} m²")
    } else {
        format!("{value:.3e} m²")
    }
}
