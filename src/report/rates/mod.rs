//! Exits and rates of overdamped motion, as documents.

mod exit;
mod table;

pub use exit::document as exit_document;
pub use table::document;

use serde_json::{Value, json};

use physics::kinetics::Capacity;
use physics::units::{duration_to, plain};

/// The scope in which kT is meaningful.
const SCOPE: &str = "valid for overdamped motion (drag of at least 50 /s) and elastic collisions; \
    at less drag, or with lossy collisions, no kT exists";
/// The note on bounds.
const ON_THE_MESH: &str = "the bounds hold on the mesh (Dirichlet, Thomson) and exclude its \
    discretisation error";
/// Errors that the bounds on the mesh exclude.
const NOT_BOUNDED: [&str; 2] = [
    "the integrals of exp(-U/kT) and exp(U/kT) over cells, by Gauss' rule",
    "basins made of whole cells: mesh.of_basins estimates how much that changes capacities",
];
const NO_BOUNDS: &str = "no bounds: they need a start in a well";
/// The note for outlines with walls along rays, or crossed twice by rays.
const ONE_SIDED: &str = "the other bound needs a flux along the contact, which exists only if \
    every ray from the centre crosses the contact boundary once";
/// The note if a requested proof failed.
const NOT_PROVED: &str = "nothing is proved: a proof needs tiles that are convex about their \
    centres of mass and have few corners, an energy with bounds over cells, and sets that the \
    mesh separates";
/// The note on what is proved.
const PROVED: &str = "proved (integrals and sets enclosed, rounding included)";
/// Bounds farther apart than this factor are not shown.
const FAR: f64 = 10.0;

/// Proved bounds of the rate of leaving a set, as an object.
fn proved_entry(diffusion: f64, proved: Option<&Capacity>) -> Value {
    proved.map_or(Value::Null, |proved| {
        json!({
            "set_below_J": proved.below,
            "capacity_rad": proved.capacity,
            "held_m2_rad": proved.held,
            "leaving_set_per_s": leaving_set(diffusion, proved),
            "mean_exit_s": mean_exit(diffusion, proved).map(finite),
        })
    })
}

/// Proved bounds (1/s) of the rate at which a tile leaves a set for an end, per time spent in the
/// set.
fn leaving_set(diffusion: f64, proved: &Capacity) -> [f64; 2] {
    proved.leaving().map(|end| end * diffusion)
}

/// Proved bounds (s) of the mean time until a tile that leaves the set reaches an end.
fn mean_exit(diffusion: f64, proved: &Capacity) -> [f64; 2] {
    proved.mean_exit().map(|end| end / diffusion)
}

/// Proved bounds (s) of a mean exit time, rounded outwards, if they are close enough to be shown.
fn mean_exit_ends([least, most]: [f64; 2]) -> [Option<String>; 2] {
    let upper = || duration_to(most, 3, f64::ceil);
    [
        Some(duration_to(least, 3, f64::floor)),
        (most < FAR * least).then(upper),
    ]
}

/// The same in a sentence.
fn mean_exit_words(ends: [f64; 2]) -> String {
    let [least, most] = mean_exit_ends(ends);
    let least = least.unwrap_or_default();
    match most {
        Some(most) => format!("{least} to {most} ({} apart)", apart(ends)),
        None => format!("at least {least}"),
    }
}

/// Bounds rounded outwards to three digits.
fn outwards([lower, upper]: [f64; 2]) -> [f64; 2] {
    let unit = |end: f64| 10f64.powi(libm::log10(end).floor() as i32 - 2);
    let to = |end: f64, round: fn(f64) -> f64| match end > 0.0 && end.is_finite() {
        true => round(end / unit(end)) * unit(end),
        false => end,
    };
    [to(lower, f64::floor), to(upper, f64::ceil)]
}

/// The width of bounds in per cent of the lower one, or as a factor.
fn apart([lower, upper]: [f64; 2]) -> String {
    match upper / lower {
        times if lower <= 0.0 || !times.is_finite() => "any factor".to_owned(),
        times if times < 2.0 => format!("{:.1} %", 100.0 * (times - 1.0)),
        times => format!("{} times", plain(times, 2)),
    }
}

/// The number of digits of a figure with this relative error; more if needed to keep it between its
/// bounds.
fn digits(value: f64, error: f64, [lower, upper]: [Option<f64>; 2]) -> usize {
    /// Largest number of digits shown.
    const MOST: usize = 6;
    let known = match error {
        _ if error < 0.005 => 3,
        _ if error < 0.1 => 2,
        _ => 1,
    };
    let is_between = |digits: &usize| {
        let told: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
        lower.is_none_or(|lower| lower <= told) && upper.is_none_or(|upper| told <= upper)
    };
    (known..MOST).find(is_between).unwrap_or(MOST)
}

/// A number that JSON can represent.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
