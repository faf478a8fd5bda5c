//! What exits and rates share: their scope, and how numbers are written.

/// The scope in which kT is meaningful.
pub const SCOPE: &str = "valid for overdamped motion (drag of at least 50 /s) and elastic collisions; \
    at less drag these rates do not apply, and with lossy collisions no kT exists";

/// The number of digits of a figure with this relative error.
pub fn digits(error: f64) -> usize {
    match error {
        _ if error < 0.005 => 3,
        _ if error < 0.1 => 2,
        _ => 1,
    }
}

/// A number that JSON can represent.
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
