//! Numbers, poses and shares as all outputs have them.

use serde_json::{Value, json};

use physics::configuration::Configuration;
use physics::landscape::Proportion;

/// The number itself, but 0 for -0.
pub fn positive_zero(value: f64) -> f64 {
    value + 0.0
}

/// A configuration as entries have it.
pub(super) fn pose(q: &Configuration) -> [f64; 3] {
    q.to_array().map(positive_zero)
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
