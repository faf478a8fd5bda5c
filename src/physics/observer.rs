//! Progress reports of long computations.

/// Is told what the main job is doing.
pub trait Observer: Sync {
    /// A stage begins; `share` of the whole time (0 to 1) is behind.
    fn stage(&self, name: &'static str, share: f64);

    /// Of a stage that has `count` parts, `done` are done.
    fn part(&self, _name: &'static str, _done: usize, _count: usize) {}

    /// What is known by now, in a sentence, and stays known if the work is given up.
    fn known(&self, _what: &str) {}
}

/// An observer that looks away.
pub struct Silent;

impl Observer for Silent {
    fn stage(&self, _: &'static str, _: f64) {}
}
