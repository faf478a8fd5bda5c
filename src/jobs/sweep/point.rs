//! One design of a sweep, and shards of all of them.

use super::vary::Value;

/// One design of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// Index in the sweep, from 0.
    pub index: usize,
    /// Hash of the design, the settings, the seed and the version.
    pub name: String,
    /// The index of its design in the plan.
    pub design: usize,
    /// A value for each of the plan's axes.
    pub values: Vec<Value>,
    /// The design's text with the values set, or why they cannot be set.
    pub(super) text: Result<String, String>,
}

impl SweepPoint {
    /// The design's text with the values set, if they can be set.
    pub fn text(&self) -> Option<&str> {
        self.text.as_deref().ok()
    }
}
