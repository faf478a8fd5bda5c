//! What each step of the table fills anew.

use nalgebra::{Vector2, Vector3};

use super::crowd::Crowd;
use crate::rigid::{Mover, NearPair, Pose, Two, Within};
use tiles::configuration::Configuration;

/// Vectors that each step fills anew, kept to save allocating them.
#[derive(Default)]
pub struct Scratch {
    /// The tiles before the step.
    pub movers: Vec<Mover>,
    pub poses: Vec<Pose>,
    pub positions: Vec<Vector2<f64>>,
    /// The tiles in the middle of the step, if nothing acted on them.
    pub halfway: Vec<(Mover, Pose)>,
    /// Their acceleration by the table's motion.
    pub carried: Vector2<f64>,
    /// The same, and by pairs apart.
    pub steady: Vec<Vector3<f64>>,
    pub apart: Vec<Apart>,
    /// The near pairs of the step before.
    pub known: Vec<NearPair>,
    /// The pulls of pairs apart, in their order, and those of the step before.
    pub lasting: Vec<Lasting>,
    pub lasted: Vec<Lasting>,
}

/// A pair of tiles that do not touch within the step.
pub struct Apart {
    pub two: Two,
    /// The pair's index if it is near.
    pub near: Option<usize>,
    /// By this distance (m) the pull changes little if the tiles move relative to each other.
    pub room: f64,
}

/// The pull of two tiles apart for some steps, of the middle of their way in this time.
#[derive(Clone, Copy)]
pub struct Lasting {
    pub two: Two,
    /// In the frame of the first tile, in which it also turns with the two.
    pub within: Within,
    /// The pose of the second in this frame at the first of the steps.
    pub at: Configuration,
    /// The number of steps that it is for, with this one.
    pub steps: usize,
}

/// A tile after a time (s), if nothing acts on it.
pub fn ahead(crowd: &Crowd, mover: &Mover, time: f64) -> (Mover, Pose) {
    let place = mover.place + mover.velocity * time;
    let mover = Mover { place, ..*mover };
    (mover, Pose::of(crowd, &mover))
}

/// Replaces the elements of a vector.
pub fn refill<T>(vector: &mut Vec<T>, with: impl IntoIterator<Item = T>) {
    vector.clear();
    vector.extend(with);
}
