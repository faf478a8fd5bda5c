//! What exits and rates share: remarks, and how bounds and their numbers are told.

use physics::units::plain;

/// The scope in which kT is meaningful.
pub const SCOPE: &str = "valid for overdamped motion (drag of at least 50 /s) and elastic collisions; \
    at less drag these rates do not apply, and with lossy collisions no kT exists";

/// The note on bounds.
pub const ON_THE_MESH: &str = "the bounds hold on the mesh (Dirichlet, Thomson) and exclude its \
    discretisation error";

/// Errors that the bounds on the mesh exclude.
pub const NOT_BOUNDED: [&str; 2] = [
    "the integrals of exp(-U/kT) and exp(U/kT) over cells, by Gauss' rule",
    "basins made of whole cells: mesh.of_basins estimates how much that changes capacities",
];

pub const NO_BOUNDS: &str = "no bounds: they need a start in a well";

/// The note for outlines with walls along rays, or crossed twice by rays.
pub const ONE_SIDED: &str = "the other bound needs a flux along the contact, which exists only if \
    every ray from the centre crosses the contact boundary once";

/// Bounds rounded outwards to three digits.
pub fn outwards([lower, upper]: [f64; 2]) -> [f64; 2] {
    let unit = |end: f64| 10f64.powi(libm::log10(end).floor() as i32 - 2);
    let to = |end: f64, round: fn(f64) -> f64| match end > 0.0 && end.is_finite() {
        true => round(end / unit(end)) * unit(end),
        false => end,
    };
    [to(lower, f64::floor), to(upper, f64::ceil)]
}

/// The width of bounds in per cent of the lower one, or as a factor.
pub fn apart([lower, upper]: [f64; 2]) -> String {
    match upper / lower {
        times if lower <= 0.0 || !times.is_finite() => "any factor".to_owned(),
        times if times < 2.0 => format!("{:.1} %", 100.0 * (times - 1.0)),
        times => format!("{} times", plain(times, 2)),
    }
}

/// The number of digits of a figure with this relative error; more if needed to keep it between its
/// bounds.
pub fn digits(value: f64, error: f64, [lower, upper]: [Option<f64>; 2]) -> usize {
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
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
