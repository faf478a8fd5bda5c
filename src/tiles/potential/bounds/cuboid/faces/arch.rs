//! Constant bounds of second derivatives, in place of ones that grow logarithmically near a face.

use super::lengths::{LN_ERROR, ln};

/// The fraction of the distance at which the second derivative is taken: near it the bounds from
/// both sides are about equal.
const SHARE: f64 = 0.85;

/// A constant second derivative along h, in place of one, L, that is positive and falls with h, at
/// most as fast as `-4 ln h`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arch {
    /// The constant.
    pub bend: f64,
    /// Bound of the difference between the integral of L along a motion and the constant's.
    pub off: f64,
}

/// A bound (m) of `int_0^u ln((low + u) / (low + h)) dh = u - low ln(1 + u / low)`, which it exceeds by
/// little, for a `low` of at least 0: where that would cancel, by `ln(1 + x) >= x - x^2 / 2`.
fn integral(low: f64, u: f64) -> f64 {
    if u < 0.05 * low {
        u * u / (2.0 * low)
    } else if low > 0.0 {
        u - low * (ln(1.0 + u / low) - LN_ERROR)
    } else {
        u
    }
}

/// The error of the given L: at most 4 times the error of a logarithm, plus rounding.
const LEVEL_ERROR: f64 = 5.0 * LN_ERROR;

impl Arch {
    /// For motions of at most `up` between the heights `low`, at least 0, and `high`: `range` gives
    /// the largest and the smallest value of L at a height, to [`LEVEL_ERROR`].
    ///
    /// With c = L(low + u), `int (L - c) dh` over a motion is at most its value from low to low +
    /// u, where `L - c <= 4 ln((low + u) / h)` (`u - low ln(1 + u / low)` is the integral of that
    /// logarithm), and at least the length of the motion times the minimum of `L - c`.
    pub fn of(low: f64, up: f64, high: f64, range: impl Fn(f64) -> [f64; 2]) -> Self {
        let u = SHARE * up;
        let [most, least] = range(low + u);
        let bend = 0.5 * (most + least);
        let above = 4.0 * integral(low, u) + (most - bend + LEVEL_ERROR) * up;
        let below = (bend - range(high)[1] + LEVEL_ERROR) * up;
        Self {
            bend,
            off: above.max(below) * (1.0 + 1e-9),
        }
    }

    /// Additions to the bounds of the remainder and of its slope for motions of at most `up`, at
    /// speeds of at most `fast`, that deviate from their straight part by up to `arc`, which the
    /// form does not include.
    pub fn bent_off(&self, arc: f64, [up, fast]: [f64; 2], turn: f64) -> [f64; 2] {
        let bend = self.bend.abs() * arc;
        [
            bend * (up + arc + up * turn),
            bend * (2.0 * up + fast + 2.0 * arc + 3.0 * up * turn),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_of_a_logarithm_stay_within_the_bound_and_close_to_it() {
        let l = |h: f64| 4.0 * libm::log(1.0f64 + 1.0 / h);
        // Closed form: 4 [(h + 1) ln(h + 1) - h ln h].
        let xlnx = |x: f64| if x > 0.0 { x * libm::log(x) } else { 0.0 };
        let integral = |h: f64| 4.0 * (xlnx(h + 1.0) - xlnx(h));
        for low in [0.0, 1e-3, 0.05] {
            for up in [1e-4, 0.01, 0.1] {
                let high = low + 2.0 * up;
                let arch = Arch::of(low, up, high, |h| [l(h); 2]);
                let mut farthest: f64 = 0.0;
                for (i, j) in (0..=40).flat_map(|i| (0..=40).map(move |j| (i, j))) {
                    let from = low + 2.0 * up * f64::from(i) / 40.0;
                    let to = from + (high - from).min(up) * f64::from(j) / 40.0;
                    let off = integral(to) - integral(from) - arch.bend * (to - from);
                    assert!(off.abs() <= arch.off, "{low} {up} {from} {to}");
                    farthest = farthest.max(off.abs());
                }
                // If L is nearly linear, the longest motion has 0.65 / 1.15 of the bound.
                assert!(farthest > 0.55 * arch.off, "{low} {up} {farthest} {arch:?}");
            }
        }
    }
}
