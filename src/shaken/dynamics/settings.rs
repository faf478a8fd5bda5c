//! The settings of a trajectory, other than the tiles and the start.

use crate::rigid::{Fan, USUAL_STEP};
use tiles::scale::Scale;

/// Settings of the air table and the numerics. The lengths and times of the numerics are stated for
/// the paper's tile and scale with the tiles ([`MotionSettings::of_size`]); speeds do not depend on
/// the size.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MotionSettings {
    /// Drag rate c (1/s) of every degree of freedom: without forces, velocities and the angular
    /// velocity decay as e^(-c t). The default is the paper's coefficient 0.0005, read as kg/s, for
    /// its tile of 100 g.
    #[serde(rename = "drag_per_s")]
    pub drag: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Coulomb's coefficient of friction between the tiles, and between a tile and the rim.
    pub friction: f64,
    /// Whether the table's rim holds the tile back.
    pub walls: bool,
    /// Fans that push the tile; empty in still air.
    pub fans: Vec<Fan>,
    /// Effective energy kT (J) of a random shaking force: together with the drag it keeps the
    /// kinetic energy at kT / 2 for each degree of freedom.
    #[serde(rename = "shaking_J")]
    pub shaking: Option<f64>,
    /// Error of a step of free flight (m).
    #[serde(rename = "tolerance_m")]
    pub tolerance: f64,
    /// Longest step of free flight (s).
    #[serde(rename = "longest_step_s")]
    pub longest_step: f64,
    /// Contact begins at this clearance (m) and ends at twice as much.
    #[serde(rename = "contact_range_m")]
    pub contact_range: f64,
    /// Longest step in contact (s). Shorter ones shorten all steps in contact.
    #[serde(rename = "contact_step_s")]
    pub contact_step: f64,
    /// Largest path (m) of any point of the tile in one step in contact with the other tile; magnets may
    /// require a shorter one.
    #[serde(rename = "contact_travel_m")]
    pub contact_travel: f64,
}

impl Default for MotionSettings {
    fn default() -> Self {
        Self {
            drag: 0.005,
            restitution: 0.01,
            friction: 0.3,
            walls: true,
            fans: Vec::new(),
            shaking: None,
            tolerance: 1e-8,
            longest_step: 0.1,
            contact_range: 1e-3,
            contact_step: USUAL_STEP,
            contact_travel: 4e-4,
        }
    }
}

/// An invalid setting.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// A number is out of its range, or not a number.
    #[error("{name} must be {wanted}, not {value}")]
    OutOfRange {
        /// The name of the setting.
        name: &'static str,
        /// The requirement, in words.
        wanted: &'static str,
        /// The value.
        value: f64,
    },
    /// Shaking with nothing to damp it.
    #[error("shaking without drag heats the tile without limit: set a drag rate above 0")]
    ShakingWithoutDrag,
    /// A trajectory would not end in years.
    #[error(
        "{steps:.1e} steps of {step:.1e} s for each trajectory are more than {MOST_STEPS:e}: use a shorter \
         duration, less drag or slower fans"
    )]
    TooManySteps {
        /// Their number.
        steps: f64,
        /// The longest of them (s).
        step: f64,
    },
}

/// Largest time between two random kicks (s).
const KICK_INTERVAL: f64 = 5e-3;
/// Largest share of the velocity that drag takes between two kicks. Drag acts with the kicks, so
/// steady motion under a force, and therefore diffusion, is too fast by the factor `x coth x` with
/// x half of this share: by half a per cent.
const DRAG_A_KICK: f64 = 0.25;
/// Steps of a period of a fan, at least.
const OF_A_PERIOD: f64 = 10.0;
/// Largest number of steps of a trajectory: hours.
const MOST_STEPS: f64 = 1e9;

impl MotionSettings {
    /// The time (s) between two random kicks.
    pub fn kick_interval(&self, scale: Scale) -> f64 {
        scale.time(KICK_INTERVAL).min(DRAG_A_KICK / self.drag)
    }

    /// The longest time (s) that a step can take, of settings that are scaled.
    pub fn step(&self, scale: Scale) -> f64 {
        let kicks = self.shaking.map(|_| self.kick_interval(scale));
        let fans = self.fans.iter().filter(|fan| fan.amplitude != 0.0);
        let periods = fans.map(|fan| 1.0 / (OF_A_PERIOD * fan.frequency.abs()));
        kicks
            .into_iter()
            .chain(periods)
            .fold(self.longest_step, f64::min)
    }

    /// Checks that a trajectory ends.
    ///
    /// # Errors
    /// If a duration (s) takes too many steps.
    pub fn check_steps(&self, scale: Scale, duration: f64) -> Result<(), SettingsError> {
        let step = self.step(scale);
        let steps = duration / step;
        match steps <= MOST_STEPS {
            true => Ok(()),
            false => Err(SettingsError::TooManySteps { steps, step }),
        }
    }

    /// The settings with the numerics scaled to tiles of another size.
    pub fn of_size(&self, scale: Scale) -> Self {
        Self {
            tolerance: scale.length(self.tolerance),
            longest_step: scale.time(self.longest_step),
            contact_range: scale.length(self.contact_range),
            contact_step: scale.time(self.contact_step),
            contact_travel: scale.length(self.contact_travel),
            ..self.clone()
        }
    }

    /// # Errors
    /// If a number is out of its range, or the tile is shaken without drag.
    pub fn check(&self) -> Result<(), SettingsError> {
        let not_negative = |name, value| in_range(name, "0 or more", value, value >= 0.0);
        let positive = |name, value| in_range(name, "above 0", value, value > 0.0);
        not_negative("the drag rate", self.drag)?;
        not_negative("the friction", self.friction)?;
        let between = (0.0..=1.0).contains(&self.restitution);
        in_range("the restitution", "from 0 to 1", self.restitution, between)?;
        positive("the tolerance", self.tolerance)?;
        positive("the longest step", self.longest_step)?;
        positive("the contact range", self.contact_range)?;
        positive("the contact step", self.contact_step)?;
        positive("the path of a contact step", self.contact_travel)?;
        for fan in &self.fans {
            positive("a fan's width", fan.width)?;
        }
        if let Some(energy) = self.shaking {
            not_negative("the shaking's energy", energy)?;
            if self.drag == 0.0 {
                return Err(SettingsError::ShakingWithoutDrag);
            }
        }
        Ok(())
    }
}

fn in_range(
    name: &'static str,
    wanted: &'static str,
    value: f64,
    holds: bool,
) -> Result<(), SettingsError> {
    if holds && value.is_finite() {
        Ok(())
    } else {
        Err(SettingsError::OutOfRange {
            name,
            wanted,
            value,
        })
    }
}
