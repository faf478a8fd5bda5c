//! How tiles move on the table: the options shared by docking runs and many tiles.

use super::{MOST_FRICTION, options, share, up_to};
use crate::design::{energy, frequency, length, rate};
use physics::dynamics::{Fan, MotionSettings};

options! {
    /// What collisions take from the motion.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ContactOptions {
        /// Coefficient of friction, tile on tile and tile on rim
        pub friction: f64 = value("MU", up_to(MOST_FRICTION)).or(MotionSettings::default().friction),

        /// Coefficient of restitution
        pub restitution: f64 = value("E", share).or(MotionSettings::default().restitution),
    }
}

options! {
    /// Drag, contact and fans.
    #[derive(Clone, Debug, PartialEq)]
    pub struct MotionOptions {
        /// Drag rate (1/s), relative to the table or the fixed tile, not to the room
        pub drag: f64 = value("C", drag).or(MotionSettings::default().drag),

        /// Friction and restitution.
        pub contact: ContactOptions = group(),

        /// Fan at X,Y (m) that repels tile centres with energy E_J and width S (m); repeatable
        ///
        /// The energy can oscillate with relative amplitude A at frequency F (Hz).
        pub fan: Vec<Fan> = value("X,Y,E_J,S[,A,F]", fan).signed(),
    }
}

impl MotionOptions {
    /// These settings, with defaults for all others.
    pub fn settings(&self) -> MotionSettings {
        MotionSettings {
            drag: self.drag,
            friction: self.contact.friction,
            restitution: self.contact.restitution,
            fans: self.fan.clone(),
            ..MotionSettings::default()
        }
    }
}

/// Largest drag rate (1/s): steps are shorter than its inverse.
const MOST_DRAG: f64 = 1e4;

/// Least width (m) and largest energy (J) of a fan: steps are as short as its force is steep.
const NARROWEST: f64 = 1e-3;
const STRONGEST: f64 = 1e3;
/// Largest width and coordinate (m), and frequency (Hz), of a fan.
const WIDEST: f64 = 1e3;
const FASTEST: f64 = 1e3;

/// A drag rate (1/s) of 0 or more.
fn drag(text: &str) -> Result<f64, String> {
    let found = rate(text).filter(|x| (0.0..=MOST_DRAG).contains(x));
    found
        .ok_or_else(|| format!("a number from 0 to {MOST_DRAG} is needed, in 1/s or as \"0.5 /s\""))
}

/// A fan as `X,Y,E_J,S` or `X,Y,E_J,S,A,F`.
///
/// # Errors
/// If the text is not a fan.
pub fn fan(text: &str) -> Result<Fan, String> {
    const FORM: &str = "a fan is X,Y,E_J,S in m, m, J and m or with units, such as \
                        0.6,0.6,1e-3,0.2 or \"60 cm,60 cm,1 mJ,20 cm\"; optionally ,A,F: relative \
                        amplitude and frequency (Hz)";
    let read = |(k, part): (usize, &str)| match k {
        0 | 1 | 3 => length(part),
        2 => energy(part),
        4 => share(part).ok(),
        _ => frequency(part),
    };
    let parts: Option<Vec<f64>> = text
        .split(',')
        .map(str::trim)
        .enumerate()
        .map(read)
        .collect();
    let fan = match parts.ok_or(FORM)?[..] {
        [x, y, energy, width] => Fan::steady([x, y], energy, width),
        [x, y, energy, width, amplitude, frequency] => Fan {
            amplitude,
            frequency,
            ..Fan::steady([x, y], energy, width)
        },
        _ => return Err(FORM.to_owned()),
    };
    let is_near = fan.place.iter().all(|x| x.abs() <= WIDEST);
    let wrong = [
        (!is_near, format!("X and Y are at most {WIDEST} m")),
        (
            !(NARROWEST..=WIDEST).contains(&fan.width),
            format!("S is from {NARROWEST} to {WIDEST} m"),
        ),
        (
            !(0.0..=STRONGEST).contains(&fan.energy),
            format!("E_J is from 0 to {STRONGEST} J: a fan repels"),
        ),
        (
            fan.frequency.abs() > FASTEST,
            format!("F is at most {FASTEST} Hz"),
        ),
    ];
    match wrong.into_iter().find(|(is_wrong, _)| *is_wrong) {
        Some((_, limit)) => Err(format!("{limit}; {FORM}")),
        None => Ok(fan),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fans() {
        let steady = Fan::steady([0.6, -0.5], 1e-3, 0.2);
        assert_eq!(fan("0.6,-0.5, 1e-3,0.2"), Ok(steady));
        assert_eq!(fan("60 cm,-500 mm,1 mJ,0.2 m"), Ok(steady));
        let swinging = Fan {
            amplitude: 0.5,
            frequency: 2.0,
            ..steady
        };
        assert_eq!(fan("0.6,-0.5,1e-3,0.2,0.5,2"), Ok(swinging));
        for wrong in [
            "",
            "1,2,3",
            "0,0,1,0",
            "0,0,1,-1",
            "0,0,1,1,1",
            "0,0,NaN,1",
            "0,0,1e300,1",
            "0,0,1,1e-300",
            "0,0,-1e-3,0.2",
            "1e300,0,1,1",
            "0,0,1,1e300",
            "0,0,1,1,2,1",
            "0,0,1,1,0.5,1e300",
        ] {
            assert!(fan(wrong).is_err(), "{wrong}");
        }
    }
}
