//! The settings of a run, other than tiles and starts.

use std::f64::consts::TAU;

use nalgebra::Vector2;

use crate::rigid::{Fan, USUAL_STEP};

/// Circular motion of the table, as of an orbital shaker; tiles and rim are described in the
/// table's frame.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Orbital {
    /// Radius A of the circle (m).
    pub amplitude: f64,
    /// Revolutions f per second (Hz).
    pub frequency: f64,
}

impl Orbital {
    /// The acceleration (m/s^2) of tiles in the table's frame at a time (s), against the table's own:
    /// the table is at A (cos, sin).
    pub fn acceleration(&self, time: f64) -> Vector2<f64> {
        let rate = TAU * self.frequency;
        let (sin, cos) = libm::sincos(rate * time);
        Vector2::new(cos, sin) * (self.amplitude * rate * rate)
    }
}

/// Motion of the table to and fro along a line, as of a linear shaker; tiles and rim are described in the
/// table's frame.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Linear {
    /// Amplitude A (m).
    pub amplitude: f64,
    /// Periods f per second (Hz).
    pub frequency: f64,
    /// The angle (rad) of the line with the x axis.
    pub angle: f64,
}

impl Linear {
    /// The acceleration (m/s^2) of tiles in the table's frame at a time (s), against the table's own:
    /// the table is at A sin along the line.
    pub fn acceleration(&self, time: f64) -> Vector2<f64> {
        let rate = TAU * self.frequency;
        let (sin, cos) = libm::sincos(self.angle);
        Vector2::new(cos, sin) * (self.amplitude * rate * rate * libm::sin(rate * time))
    }
}

/// Settings of the table, the drives and the numerics; in reports their names end in units.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TableSettings {
    /// Duration of a run (s).
    #[serde(rename = "time_s")]
    pub duration: f64,
    /// Drag rate c (1/s) of every degree of freedom, relative to the table.
    #[serde(rename = "drag_per_s")]
    pub drag: f64,
    /// Coulomb's coefficient of friction between tiles, and between a tile and the rim.
    pub friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Effective energy kT (J) of shaking.
    #[serde(rename = "shaking_J")]
    pub shaking: Option<f64>,
    /// Time (s) between two random kicks of shaking.
    #[serde(rename = "correlation_s")]
    pub kicks: f64,
    /// The table's own motion in a circle.
    pub orbital: Option<Orbital>,
    /// The table's own motion along a line.
    pub linear: Option<Linear>,
    /// Coulomb's coefficient of friction between a tile and the table it lies on.
    pub table_friction: f64,
    /// Fans that push tiles.
    pub fans: Vec<Fan>,
    /// Longest step (s). Steps in contact are shorter, as forces and speeds require, and scale with
    /// this.
    #[serde(rename = "step_s")]
    pub step: f64,
    /// Time between two samples (s).
    #[serde(rename = "sampling_s")]
    pub sampling: f64,
    /// Whether the table has a rim.
    pub walls: bool,
}

impl TableSettings {
    /// The frequencies (Hz) of all drives.
    pub fn frequencies(&self) -> impl Iterator<Item = f64> + '_ {
        let fans = self.fans.iter().map(|it| it.frequency);
        let orbital = self.orbital.iter().map(|it| it.frequency);
        let linear = self.linear.iter().map(|it| it.frequency);
        fans.chain(orbital).chain(linear)
    }

    /// Whether anything but shaking drives the tiles.
    pub fn is_driven(&self) -> bool {
        !self.fans.is_empty() || self.orbital.is_some() || self.linear.is_some()
    }

    /// The default longest step (s), for which the limits of steps in contact are stated.
    pub const USUAL_STEP: f64 = USUAL_STEP;

    /// Number of steps between two kicks; 1 without shaking, as drag then acts at every step.
    pub(super) fn steps_between_kicks(&self) -> usize {
        match self.shaking {
            Some(_) => (self.kicks / self.step).round().max(1.0) as usize,
            None => 1,
        }
    }

    /// The number of steps of a run, and of steps between two samples.
    pub(super) fn steps(&self) -> [u64; 2] {
        [
            (self.duration / self.step).ceil().max(1.0) as u64,
            (self.sampling / self.step).round().max(1.0) as u64,
        ]
    }

    /// The number of samples of a run, including the first and the last.
    pub fn samples(&self) -> u64 {
        let [steps, between] = self.steps();
        1 + steps.div_ceil(between)
    }
}
