//! One design of a sweep, and shards of all of them.

use super::vary::Value;

/// One design of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Place in the sweep, from 0.
    pub index: usize,
    /// Hash of the design, the settings and the version.
    pub name: String,
    /// Of its random numbers, from its name.
    pub seed: u64,
    /// Which of the plan's designs.
    pub design: usize,
    /// A value for each of the plan's axes.
    pub values: Vec<Value>,
    /// The design's text with the values set; where they cannot be set, why.
    pub(super) text: Result<String, String>,
}

impl Point {
    /// The design's text with the values set, where they can be set.
    pub fn text(&self) -> Option<&str> {
        self.text.as_deref().ok()
    }
}
