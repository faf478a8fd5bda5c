//! The format of numbers, poses and shares in all outputs.

use serde_json::{Value, json};

use physics::configuration::Configuration;
use physics::landscape::Proportion;

/// The number itself, but 0 for -0.
pub fn positive_zero(value: f64) -> f64 {
    value + 0.0
}

/// A configuration for entries.
pub(super) fn pose(q: &Configuration) -> [f64; 3] {
    q.to_array().map(positive_zero)
}

/// A configuration for people: x and y in mm and theta in degrees, with as many digits as it takes to
/// use it again: lengths to a five-thousandth of the pose's distance, angles to a hundredth of a degree.
pub(super) fn read_pose(q: &Configuration) -> [String; 3] {
    let [x, y] = [1e3 * q.x, 1e3 * q.y];
    let size = x.abs().max(y.abs());
    let finest = if size > 0.0 {
        -libm::log10(size / 5000.0)
    } else {
        1.0
    };
    // Nothing below a nanometre is shown.
    let decimals = (finest - 1e-9).ceil().clamp(1.0, 6.0) as usize;
    let describe = |value: f64, decimals: usize| {
        let scale = 10f64.powi(decimals as i32);
        // Avoids -0.
        format!("{:.decimals$}", (scale * value).round() / scale + 0.0)
    };
    [
        describe(x, decimals),
        describe(y, decimals),
        describe(q.theta.to_degrees(), 2),
    ]
}

/// A sampled proportion with its 95 % Wilson interval.
pub(super) fn proportion(proportion: Proportion) -> Value {
    json!({
        "share": proportion.share(),
        "low": proportion.low,
        "high": proportion.high,
        "count": proportion.count,
        "of": proportion.of,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_of_small_tiles_are_told_with_more_digits() {
        let describe = |x: f64, y: f64| read_pose(&Configuration::new(x, y, -1e-9)).join(" ");
        assert_eq!(describe(0.43, -0.04), "430.00 -40.00 0.00");
        assert_eq!(describe(0.08, 1e-9), "80.00 0.00 0.00");
        assert_eq!(describe(0.010_66, 0.000_14), "10.660 0.140 0.00");
        assert_eq!(describe(0.0, 0.0), "0.0 0.0 0.00");
    }
}
