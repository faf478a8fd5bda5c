//! What decides a run besides tiles and starts.

use crate::dynamics::Fan;

/// The table itself moves in a circle, as orbital shakers do; tiles and rim are seen from it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Orbital {
    /// Radius A of the circle (m).
    pub amplitude: f64,
    /// Rounds f per second (Hz).
    pub frequency: f64,
}

/// The table, the drives and the numerics.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TableSettings {
    /// How long a run lasts (s).
    pub duration: f64,
    /// Drag rate c (1/s) of every degree of freedom.
    pub drag: f64,
    /// Coulomb's coefficient of friction between tiles, and of a tile and the rim.
    pub friction: f64,
    /// Share of the approach velocity that a knock gives back.
    pub restitution: f64,
    /// Effective energy kT (J) of shaking.
    pub shaking: Option<f64>,
    /// Time (s) between two random kicks of shaking.
    pub kicks: f64,
    /// The table's own motion.
    pub orbital: Option<Orbital>,
    /// Fans that push tiles.
    pub fans: Vec<Fan>,
    /// Longest step (s). Steps in contact are shorter, by as much as forces and speeds ask for, and
    /// in proportion to this.
    pub step: f64,
    /// Time between two looks at the table (s).
    pub sampling: f64,
    /// Whether the table has a rim.
    pub walls: bool,
}

impl TableSettings {
    /// The default longest step (s), for which the limits of steps in contact are made.
    pub const USUAL_STEP: f64 = 2.5e-3;

    /// Steps between two kicks; drag alone acts at each.
    pub(super) fn steps_between_kicks(&self) -> usize {
        match self.shaking {
            Some(_) => (self.kicks / self.step).round().max(1.0) as usize,
            None => 1,
        }
    }

    /// By how much shorter all steps are than usual.
    pub(super) fn fineness(&self) -> f64 {
        self.step / Self::USUAL_STEP
    }
}
