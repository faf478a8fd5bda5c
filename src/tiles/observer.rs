//! Progress reports of long computations.

/// Receives progress reports of a computation.
pub trait Observer: Sync {
    /// A stage begins; the fraction `share` of the total time (0 to 1) has passed.
    fn stage(&self, name: &'static str, share: f64);

    /// `done` of `count` parts of a stage are done.
    fn part(&self, _name: &'static str, _done: usize, _count: usize) {}

    /// An intermediate result, in a sentence, that remains valid if the work is interrupted.
    fn known(&self, _what: &str) {}

    /// How long the work will take, and what would shorten it, in a sentence; told once.
    fn expect(&self, _what: &str) {}

    /// A change of what was asked for, in a sentence.
    fn warn(&self, _what: &str) {}
}

/// An observer that ignores everything.
pub struct Silent;

impl Observer for Silent {
    fn stage(&self, _: &'static str, _: f64) {}
}
