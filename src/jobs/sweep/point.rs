//! One design of a sweep, and parts of all of them.

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

/// Part `number`, from 1, of `of` parts of a sweep: every `of`th point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part, from 1.
    pub number: usize,
    /// How many parts there are.
    pub of: usize,
}

impl Shard {
    /// The only part of a sweep that is not divided.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether the part holds a point.
    pub fn contains(&self, point: &Point) -> bool {
        point.index % self.of + 1 == self.number
    }
}
