//! Fans beneath the table.

use std::f64::consts::TAU;

use nalgebra::Vector2;

/// A usual step as a share of the time in which forces change.
const SHARE: f64 = 0.05;
/// Fans reach this many widths: there, exp(-r^2 / 2) is 3e-18.
const REACH: f64 = 9.0;
/// Longest travel in a step within reach of a fan, as a share of its width.
const TRAVEL: f64 = 1.0 / 40.0;

/// A fan beneath the table. It pushes the tile's centre of mass away with the potential energy
/// `E(r, t) = E0 exp(-|r - r_f|^2 / (2 s^2)) (1 + a sin(2 pi f t))`, so with the force
/// `E (r - r_f) / s^2`; a negative `E0` draws it in.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Fan {
    /// r_f (m).
    #[serde(rename = "place_m")]
    pub place: [f64; 2],
    /// E0 (J).
    #[serde(rename = "energy_J")]
    pub energy: f64,
    /// s (m).
    #[serde(rename = "width_m")]
    pub width: f64,
    /// Relative amplitude a of its oscillation; 0 for a steady fan.
    pub amplitude: f64,
    /// Frequency f of its oscillation (Hz).
    #[serde(rename = "frequency_Hz")]
    pub frequency: f64,
}

impl Fan {
    /// A fan that does not oscillate.
    pub const fn steady(place: [f64; 2], energy: f64, width: f64) -> Self {
        Self {
            place,
            energy,
            width,
            amplitude: 0.0,
            frequency: 0.0,
        }
    }

    /// The fan without its oscillation.
    fn without_swing(&self) -> Self {
        Self {
            amplitude: 0.0,
            ..*self
        }
    }

    /// The energy (J) of its oscillation, on a centre of mass at `r` (m) and time `t` (s).
    pub fn swing(&self, r: Vector2<f64>, t: f64) -> f64 {
        let energy = |fan: &Self| fan.energy_and_force(r, t).0;
        energy(self) - energy(&self.without_swing())
    }

    /// Energy (J) and force (N) on a centre of mass at `r` (m) and time `t` (s).
    pub fn energy_and_force(&self, r: Vector2<f64>, t: f64) -> (f64, Vector2<f64>) {
        let away = r - Vector2::from(self.place);
        let variance = self.width * self.width;
        let now = 1.0 + self.amplitude * libm::sin(TAU * self.frequency * t);
        let energy = self.energy * now * libm::exp(-away.norm_squared() / (2.0 * variance));
        (energy, away * (energy / variance))
    }
}

/// The fans of a table.
#[derive(Clone, Copy, Debug)]
pub struct Winds<'a>(pub &'a [Fan]);

impl Winds<'_> {
    /// What fans do to a tile at a position (m) and a time (s).
    pub fn wind(&self, place: Vector2<f64>, time: f64) -> Wind {
        let mut wind = Wind::default();
        for fan in self.0 {
            let (energy, force) = fan.without_swing().energy_and_force(place, time);
            wind.energy += energy;
            wind.force += force;
            wind.swing += force * (fan.amplitude * libm::sin(TAU * fan.frequency * time));
        }
        wind
    }

    /// The longest step (s) in which the forces of fans on a tile change little, by its mass (kg), its
    /// position (m) and its speed (m/s): it travels by a small share of a fan's width, unless it stays
    /// out of reach.
    pub fn longest(&self, mass: f64, place: Vector2<f64>, speed: f64) -> f64 {
        let longest = |fan: &Fan| {
            let away = (place - Vector2::from(fan.place)).norm();
            let outside = away - REACH * fan.width;
            if outside > 0.0 && speed == 0.0 {
                return f64::INFINITY;
            }
            let travel = outside.max(TRAVEL * fan.width) / speed.max(f64::MIN_POSITIVE);
            let energy = fan.without_swing().energy_and_force(place, 0.0).0.abs()
                * (1.0 + fan.amplitude.abs());
            let slope = energy * away.max(fan.width) / (fan.width * fan.width);
            travel.min(longest_step(fan.width, slope / mass))
        };
        self.0.iter().map(longest).fold(f64::INFINITY, f64::min)
    }
}

/// The longest step (s) in which a force changes little over `feature` (m), by the acceleration
/// (m/s^2) of the pair by its own force.
pub fn longest_step(feature: f64, pull: f64) -> f64 {
    SHARE * (feature / pull.max(f64::MIN_POSITIVE)).sqrt()
}

/// What fans do to a tile.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wind {
    /// The potential energy (J) of all fans without their oscillation.
    pub energy: f64,
    /// The force (N) of this energy.
    pub force: Vector2<f64>,
    /// The force (N) of the oscillation, which does work.
    pub swing: Vector2<f64>,
}

impl Wind {
    /// The whole force (N).
    pub fn whole(&self) -> Vector2<f64> {
        self.force + self.swing
    }
}
