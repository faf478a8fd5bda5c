//! Exits and rates of overdamped motion, for people and for programs.

mod exit;
mod files;
mod over_kt;
mod place;
mod table;

pub use exit::{check_entry, check_summary, exit_entry, exit_summary};
pub use files::{files, report};
pub use over_kt::{AtKt, over_kt};
pub use place::Place;
pub use table::Table;

use serde_json::{Value, json};

use crate::design::Design;
use crate::kinetics::Capacity;
use crate::units::si;

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
/// Of outlines that are not convex.
const ONE_SIDED: &str = "the other bound needs fluxes along contact, which are laid for convex \
                         outlines only";

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

/// Proved bounds in words, rounded outwards: how often per second.
fn proved_words([lower, upper]: [f64; 2]) -> String {
    let order = upper.log10().floor() as i32;
    let unit = 10f64.powi(order - 2);
    let [low, high] = [(lower / unit).floor() * unit, (upper / unit).ceil() * unit];
    let apart = apart([lower, upper]);
    match usize::try_from(2 - order) {
        Ok(places) if places <= 4 => {
            format!("{low:.places$} to {high:.places$} times per second ({apart} apart)")
        }
        _ => format!("{low:.2e} to {high:.2e} times per second ({apart} apart)"),
    }
}

/// Bounds that are farther apart than so many times say nothing worth telling.
pub(in crate::report) const FAR: f64 = 10.0;

/// Proved bounds (s) of a mean exit time that are worth telling, with their words, rounded outwards.
pub(in crate::report) fn mean_exit_ends(
    motion: &Motion,
    proved: &Capacity,
) -> [Option<(f64, String)>; 2] {
    let [least, most] = mean_exit(motion, proved);
    [
        Some((least, three_digits(least, f64::floor))),
        (most < FAR * least).then(|| (most, three_digits(most, f64::ceil))),
    ]
}

/// A time (s) in words, to three digits.
pub(in crate::report) fn three_digits(time: f64, whole: fn(f64) -> f64) -> String {
    let unit = 10f64.powi(time.log10().floor() as i32 - 2);
    si(whole(time / unit) * unit, "s", 3)
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
pub(in crate::report) const NOT_PROVED: &str = "nothing is proved: that takes tiles that are convex about their centres \
                          of mass, of few corners,\n  an energy with bounds over cells, and sets \
                          that the mesh tells apart";
/// What is proved.
pub(in crate::report) const PROVED: &str =
    "proved (integrals and sets enclosed, rounding included)";

/// How far apart bounds are, in percent of the lower one.
fn apart([lower, upper]: [f64; 2]) -> String {
    match lower > 0.0 {
        true => format!("{:.1} %", 100.0 * (upper / lower - 1.0)),
        false => "any factor".to_owned(),
    }
}

/// A rate with three digits.
pub(super) fn per_second(rate: f64) -> String {
    match rate {
        0.0 => "0 /s".to_owned(),
        _ => format!("{rate:.2e} /s"),
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
