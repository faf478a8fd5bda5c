//! Fitting a shield's constants to measured forces and energies.
//!
//! Rows of poses, with and without iron, are compared with a shielded pair of tiles (see
//! [`crate::potential::shielding`]). The constants A, l, delta and the front gain G of one shield,
//! the same on all faces, are fitted by least squares (Levenberg 1944, Marquardt 1963,
//! doi:10.1137/0111030); the magnets' common strength, which multiplies all energies, by the rows
//! without iron alone, if there are any. Energies, forces and torques are made comparable by the
//! root mean square of their measured values. Every fifth row (or as set) is held out of the fit,
//! and the residuals of the rows held out say what the fit is worth.

mod fit;
mod rows;

use crate::configuration::Configuration;
use crate::potential::shielding::{Shield, ShieldRule, Shields};
use crate::potential::{MagnetModel, Potential, ShieldedPotential};
use crate::tile::Tile;
use fit::least_squares;
pub use rows::{COLUMNS, CsvError, read_rows};

/// What can be measured at a pose, and its unit.
pub const QUANTITIES: [(&str, &str); 4] = [
    ("energy", "J"),
    ("force along x", "N"),
    ("force along y", "N"),
    ("torque", "N m"),
];

/// A measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub configuration: Configuration,
    /// Whether the shields were in place.
    pub iron: bool,
    /// Energy (J), force on the moving tile along x and y (N) and torque about its reference
    /// point (N m), as far as they were measured.
    pub measured: [Option<f64>; 4],
}

/// What to hold out, and where to start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationSettings {
    /// Every so many rows one is held out of the fit.
    pub hold_out_every: usize,
    pub start: Shield,
    /// Greatest number of steps of the fit.
    pub steps: usize,
}

impl Default for CalibrationSettings {
    fn default() -> Self {
        Self {
            hold_out_every: 5,
            start: Shield {
                attenuation: 0.5,
                length: 0.03,
                width: 0.3,
                front_gain: 1.0,
            },
            steps: 200,
        }
    }
}

/// Root mean squares of measured minus modelled values, for each of [`QUANTITIES`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    pub rows: usize,
    /// In the quantity's own unit; `None` where nothing was measured.
    pub rms: [Option<f64>; 4],
    /// The same, relative to the root mean square of the measured values.
    pub relative: [Option<f64>; 4],
}

/// The outcome of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    pub shield: Shield,
    /// Standard errors of A, l (m), delta and G, from the scatter of the residuals.
    pub standard_errors: [f64; 4],
    /// Factor by which the measured energies without iron exceed the model's.
    pub strength: f64,
    pub fitted: Residuals,
    pub held_out: Residuals,
    /// Steps of the fit that were taken, and whether it settled.
    pub steps: usize,
    pub settled: bool,
}

/// Why there is no calibration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CalibrationError {
    #[error(
        "{0} measured values with iron are too few to fit four constants; give at least five rows \
         that are not held out"
    )]
    TooFew(usize),
    #[error("the model gives no finite value at row {0}; do the tiles overlap there?")]
    NotFinite(usize),
}

/// Fits a shield to rows of measurements.
///
/// # Errors
/// Where there are too few rows, or the model has no finite value at one of them.
pub fn calibrate(
    model: MagnetModel,
    fixed: &Tile,
    moving: &Tile,
    rows: &[Row],
    settings: &CalibrationSettings,
) -> Result<Calibration, CalibrationError> {
    let bare = ShieldedPotential::new(model, fixed, moving, &Shields::default());
    for (i, row) in rows.iter().enumerate() {
        if predictions(&bare, row)
            .iter()
            .any(|value| !value.is_finite())
        {
            return Err(CalibrationError::NotFinite(i + 1));
        }
    }
    let every = settings.hold_out_every.max(2);
    let (mut used, mut held_out) = (Vec::new(), Vec::new());
    for (i, row) in rows.iter().enumerate() {
        let part = if (i + 1) % every == 0 {
            &mut held_out
        } else {
            &mut used
        };
        part.push(row);
    }
    let data = Data {
        bare: &bare,
        faces: [fixed.faces.len(), moving.faces.len()],
        scales: std::array::from_fn(|k| {
            root_mean_square(rows.iter().filter_map(|row| row.measured[k]))
        }),
    };
    let strength = data.strength(&used);
    let with_iron: Vec<&Row> = used.iter().copied().filter(|row| row.iron).collect();
    let residuals = |constants: &[f64; 4]| -> Vec<f64> {
        let shielded = data.shielded(&shield_of(constants));
        with_iron
            .iter()
            .flat_map(|row| data.residuals(&shielded, strength, row))
            .flatten()
            .collect()
    };
    let start = constants_of(&settings.start);
    let values = residuals(&start).len();
    if values <= start.len() {
        return Err(CalibrationError::TooFew(values));
    }
    let fit = least_squares(start, settings.steps, residuals);
    let shield = shield_of(&fit.best);
    Ok(Calibration {
        shield,
        standard_errors: standard_errors(&shield, &fit.standard_errors),
        strength,
        fitted: data.summary(&shield, strength, &used),
        held_out: data.summary(&shield, strength, &held_out),
        steps: fit.steps,
        settled: fit.settled,
    })
}

/// The unbounded numbers that are fitted: A is the logistic of the first, l, delta and G are the
/// exponentials of the others, so that every set of numbers is a shield.
fn shield_of(constants: &[f64; 4]) -> Shield {
    Shield {
        attenuation: 1.0 / (1.0 + (-constants[0]).exp()),
        length: constants[1].exp(),
        width: constants[2].exp(),
        front_gain: constants[3].exp(),
    }
}

fn constants_of(shield: &Shield) -> [f64; 4] {
    let a = shield.attenuation.clamp(1e-6, 1.0 - 1e-6);
    [
        (a / (1.0 - a)).ln(),
        shield.length.ln(),
        shield.width.ln(),
        shield.front_gain.ln(),
    ]
}

/// Standard errors of the shield's constants from those of the numbers fitted.
fn standard_errors(shield: &Shield, errors: &[f64; 4]) -> [f64; 4] {
    [
        errors[0] * shield.attenuation * (1.0 - shield.attenuation),
        errors[1] * shield.length,
        errors[2] * shield.width,
        errors[3] * shield.front_gain,
    ]
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0usize);
    for value in values {
        sum += value * value;
        count += 1;
    }
    (count > 0).then(|| (sum / count as f64).sqrt())
}

/// Energy, force and torque of a model at a row's pose.
fn predictions(potential: &ShieldedPotential, row: &Row) -> [f64; 4] {
    let (energy, gradient) = potential.energy_and_gradient(&row.configuration);
    [energy, -gradient.x, -gradient.y, -gradient.z]
}

/// What residuals are worked out from.
struct Data<'a> {
    bare: &'a ShieldedPotential,
    faces: [usize; 2],
    /// Root mean square of each quantity's measured values.
    scales: [Option<f64>; 4],
}

impl Data<'_> {
    fn shielded(&self, shield: &Shield) -> ShieldedPotential {
        self.bare.with_shields(&Shields {
            rule: ShieldRule::Smooth,
            fixed: vec![Some(*shield); self.faces[0]],
            moving: vec![Some(*shield); self.faces[1]],
        })
    }

    /// A row's residuals relative to the quantities' scales.
    fn residuals(
        &self,
        shielded: &ShieldedPotential,
        strength: f64,
        row: &Row,
    ) -> [Option<f64>; 4] {
        let potential = if row.iron { shielded } else { self.bare };
        let predicted = predictions(potential, row);
        std::array::from_fn(|k| {
            let scale = self.scales[k].filter(|scale| *scale > 0.0).unwrap_or(1.0);
            row.measured[k].map(|measured| (measured - strength * predicted[k]) / scale)
        })
    }

    /// The factor between measured and modelled values that fits the rows without iron best.
    fn strength(&self, rows: &[&Row]) -> f64 {
        let (mut product, mut square) = (0.0, 0.0);
        for row in rows.iter().filter(|row| !row.iron) {
            let predicted = predictions(self.bare, row);
            for ((measured, scale), predicted) in
                row.measured.iter().zip(&self.scales).zip(predicted)
            {
                if let (Some(measured), Some(scale)) = (measured, scale) {
                    product += measured * predicted / (scale * scale);
                    square += predicted * predicted / (scale * scale);
                }
            }
        }
        if square > 0.0 && product > 0.0 {
            product / square
        } else {
            1.0
        }
    }

    fn summary(&self, shield: &Shield, strength: f64, rows: &[&Row]) -> Residuals {
        let shielded = self.shielded(shield);
        let all: Vec<[Option<f64>; 4]> = rows
            .iter()
            .map(|row| self.residuals(&shielded, strength, row))
            .collect();
        let relative: [Option<f64>; 4] =
            std::array::from_fn(|k| root_mean_square(all.iter().filter_map(|row| row[k])));
        Residuals {
            rows: rows.len(),
            rms: std::array::from_fn(|k| Some(relative[k]? * self.scales[k]?)),
            relative,
        }
    }
}

#[cfg(test)]
mod tests;
