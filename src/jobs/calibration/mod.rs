//! Fits the constants of a shield to measured forces and energies; also the magnets' strength to
//! forces over the gap ([`strength`]) and kT to observed pairs.
//!
//! Rows of poses, with and without iron, are compared with a shielded pair of tiles (see
//! [`physics::potential::shielding`]). The constants A, l, delta and the front gain G of one
//! shield, the same on all shielded faces, are fitted by least squares (Levenberg 1944, Marquardt
//! 1963, doi:10.1137/0111030). The magnets' common strength, a factor on all energies, is fitted
//! only to the rows without iron, if there are any. Energies, forces and torques are scaled by the
//! root mean square of their measured values. Every fifth row with iron and every fifth without (or
//! as set) is held out of the fit; the residuals of these rows measure the quality of the fit.
//!
//! Constants that the rows do not depend on cannot be determined: A and l have an effect only
//! behind and beside the iron, G only in front of it. In that case the standard error is as large
//! as the constant itself.

pub mod bonds;
pub mod distances;
mod fit;
pub mod gaps;
mod lines;
mod rows;
pub mod strength;

use crate::design::{Design, DesignError};
use crate::pipeline;
use crate::request::{self, Unanswered, options};
use bonds::{PairTimes, TimesFit};
use distances::{DistanceFit, PairDistances};
use fit::{Fit, least_squares};
use physics::contact::Contact;
use physics::kinetics::Hold;
use physics::kinetics::bond::BondError;
use physics::observer::Observer;
use physics::potential::shielding::{Shield, ShieldRule, Shields};
use physics::potential::{MagnetModel, Potential, ShieldedPotential};
use physics::problem::{NoRoom, Room};
use physics::tile::Tile;
pub use rows::{COLUMNS, Measurement, read_rows};
use strength::StrengthFit;

options! {
    /// The options of a fit of kT to pairs.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct PairsRequest {
        /// Area per pair (m^2) [default: what the rim and the fixed tile leave of the design's table]
        pub area: Option<f64> = value("M2", request::area),

        /// Largest distance (m) of a pair that counts [default: where tiles are free]
        ///
        /// At larger distances the rim of the table biases the result.
        pub within: Option<f64> = value("R", request::length),
    }
}

options! {
    /// The options of a fit to forces and energies.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ForcesRequest {
        /// Hold out one in N rows from the fit of shields [default: 5]
        pub hold_out: Option<u16> = value("N", request::whole(2, u16::MAX)),
    }
}

/// The result of a calibration.
pub enum Fitted {
    /// The constants of shields.
    Shields(Box<Calibration>),
    /// The magnets' strength.
    Strength(Box<StrengthFit>),
    /// kT fitted to the distances of pairs.
    Distances(DistanceFit),
    /// kT fitted to the intervals for which pairs were bound and apart.
    Times(TimesFit),
}

impl Fitted {
    /// The strength of a design's magnets, from a table of forces over the gap.
    ///
    /// # Errors
    /// See [`FitError`].
    pub fn of_gaps(design: &Design, table: &str) -> Result<Self, FitError> {
        let found = strength::fit(design, &gaps::read(table)?)?;
        Ok(Self::Strength(Box::new(found)))
    }
}

/// Why a calibration failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// The measurements are invalid or too few: what is wrong, and where.
    #[error("{0}")]
    Table(String),
    /// There is no model of shields behind the design's magnets.
    #[error(transparent)]
    Magnets(#[from] DesignError),
    /// There is no bond.
    #[error(transparent)]
    Bond(#[from] BondError),
    /// The table has no room for the moving tile.
    #[error(transparent)]
    Room(#[from] NoRoom),
}

impl From<String> for FitError {
    fn from(wrong: String) -> Self {
        Self::Table(wrong)
    }
}

impl Unanswered for FitError {
    fn is_of_the_question(&self) -> bool {
        !matches!(self, Self::Bond(_))
    }
}

impl ForcesRequest {
    /// Fits the constants of shields to a table of forces and energies; if no row has iron, the
    /// strength of the magnets.
    ///
    /// # Errors
    /// See [`FitError`].
    pub fn of_forces(&self, design: &Design, table: &str) -> Result<Fitted, FitError> {
        let rows = read_rows(table)?;
        if !rows.iter().any(|row| row.iron) {
            if self.hold_out.is_some() {
                let told = "--hold-out: no row has iron, and no row is held out of the fit of the magnets' \
                    strength: leave it out";
                return Err(told.to_owned().into());
            }
            check_poses([&design.pair.fixed, &design.pair.moving], &rows)?;
            return Ok(Fitted::Strength(Box::new(strength::fit_rows(
                design, &rows,
            )?)));
        }
        let (specimen, settings) = Specimen::of(design, self.hold_out);
        let found = calibrate(&specimen, &rows, &settings)?;
        Ok(Fitted::Shields(Box::new(found)))
    }
}

impl PairsRequest {
    /// Fits kT to a table of pairs: their distances, or how long they were bound and apart.
    ///
    /// # Errors
    /// See [`FitError`].
    pub fn of_pairs(
        &self,
        design: &Design,
        table: &str,
        observer: &dyn Observer,
    ) -> Result<Fitted, FitError> {
        if PairDistances::is_named_in(table) {
            let within = self.within.unwrap_or(design.space().free_distance);
            let read = PairDistances::read(table)?;
            let found = read.fit(&design.problem(), &design.pair.bound, within)?;
            return Ok(Fitted::Distances(found));
        }
        let times = PairTimes::read(table)?;
        let settings = pipeline::Request::without_proofs(pipeline::Request::default().seed);
        let analysis = pipeline::analyse(design, &settings, observer);
        let bond = Hold::bond(&analysis.problem, &analysis.catalogue)?;
        let area = match self.area {
            Some(area) => area,
            None => Room::new(&analysis.problem)?.area,
        };
        let (odds, [low, high]) = times.log_odds();
        // The longer tiles are bound, the lower kT.
        let [kt, least, most] = [odds, high, low].map(|odds| bond.kt_of_odds(odds, area));
        Ok(Fitted::Times(TimesFit {
            times,
            area,
            kt,
            interval: [least, most],
        }))
    }
}

/// The quantities that can be measured at a pose, and their units.
pub const QUANTITIES: [(&str, &str); 4] = [
    ("energy", "J"),
    ("force along x", "N"),
    ("force along y", "N"),
    ("torque", "N m"),
];

/// The measured specimen: two tiles, and which of their faces had shields in the rows with iron
/// (those with a shield in `shields`, or all if there are none; the constants in it are ignored).
#[derive(Clone, Copy, Debug)]
pub struct Specimen<'a> {
    /// The magnet model.
    pub model: MagnetModel,
    /// The fixed tile, in whose frame poses are given.
    pub fixed: &'a Tile,
    /// The tile whose poses are in the rows.
    pub moving: &'a Tile,
    /// Which faces had shields in the rows with iron; the constants are ignored.
    pub shields: &'a Shields,
}

impl<'a> Specimen<'a> {
    /// The tiles of a design, and the settings of a fit that starts with the design's own shield.
    pub fn of(design: &'a Design, hold_out_every: Option<u16>) -> (Self, CalibrationSettings) {
        let shields = &design.interaction.shields;
        let known = shields.fixed.iter().chain(&shields.moving).flatten().next();
        let defaults = CalibrationSettings::default();
        let settings = CalibrationSettings {
            hold_out_every: hold_out_every.map_or(defaults.hold_out_every, usize::from),
            start: known.copied().unwrap_or(defaults.start),
            ..defaults
        };
        let specimen = Self {
            model: design.interaction.model,
            fixed: &design.pair.fixed,
            moving: &design.pair.moving,
            shields,
        };
        (specimen, settings)
    }

    /// The tiles with `shield` on all shielded faces.
    fn shields(&self, shield: &Shield) -> Shields {
        let all = self.shields.fixed.iter().chain(&self.shields.moving);
        let any = all.flatten().next().is_some();
        let of_faces = |tile: &Tile, known: &[Option<Shield>]| {
            let shielded = |face: usize| !any || known.get(face).is_some_and(Option::is_some);
            (0..tile.faces.len())
                .map(|face| shielded(face).then_some(*shield))
                .collect()
        };
        Shields {
            rule: ShieldRule::Smooth,
            fixed: of_faces(self.fixed, &self.shields.fixed),
            moving: of_faces(self.moving, &self.shields.moving),
        }
    }
}

/// The settings of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CalibrationSettings {
    /// One of this many rows is held out of the fit, separately for rows with and without iron.
    pub hold_out_every: usize,
    /// The shield that the fit starts with.
    pub start: Shield,
    /// Largest number of steps of the fit.
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
    /// Number of rows.
    pub rows: usize,
    /// Number of rows with shields in place.
    pub with_iron: usize,
    /// In the quantity's unit; `None` if it was not measured.
    pub rms: [Option<f64>; 4],
    /// The same, relative to the root mean square of the measured values.
    pub relative: [Option<f64>; 4],
}

/// The outcome of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The fitted constants.
    pub shield: Shield,
    /// Standard errors of A, l (m), delta and G, from the scatter of the residuals.
    pub standard_errors: [f64; 4],
    /// Factor by which the measured energies without iron exceed the model's.
    pub strength: f64,
    /// Residuals of the fitted rows.
    pub fitted: Residuals,
    /// Residuals of the rows held out.
    pub held_out: Residuals,
    /// Number of steps of the fit.
    pub steps: usize,
    /// Whether the fit converged within the allowed steps.
    pub settled: bool,
}

/// Largest overlap (m) of the tiles at a measured pose, to allow for its error.
const MEASURED_OVERLAP: f64 = 1e-3;

/// Fits a shield to rows of measurements.
///
/// # Errors
/// If there are too few rows, or the tiles overlap at one of them.
pub fn calibrate(
    specimen: &Specimen,
    rows: &[Measurement],
    settings: &CalibrationSettings,
) -> Result<Calibration, String> {
    let (fixed, moving) = (specimen.fixed, specimen.moving);
    check_poses([fixed, moving], rows)?;
    let bare = ShieldedPotential::new(specimen.model, fixed, moving, &Shields::default());
    let (used, held_out) = hold_out(rows, settings.hold_out_every.max(2));
    let data = Data {
        specimen,
        bare: &bare,
        scales: std::array::from_fn(|k| {
            root_mean_square(rows.iter().filter_map(|row| row.measured[k]))
        }),
    };
    let strength = data.strength(&used);
    let with_iron: Vec<&Measurement> = used.iter().copied().filter(|row| row.iron).collect();
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
        return Err(format!(
            "{values} measured values with iron are too few to fit four constants; give at least \
             five rows that are not held out"
        ));
    }
    let fits = STARTING_LENGTHS.map(|factor| {
        let mut start = start;
        start[1] += libm::log(factor);
        least_squares(start, settings.steps, residuals)
    });
    let [first, others @ ..] = fits;
    let better = |a: Fit<4>, b: Fit<4>| if b.square < a.square { b } else { a };
    let fit = others.into_iter().fold(first, better);
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

/// Checks that tiles do not overlap at the poses of measurements.
fn check_poses([fixed, moving]: [&Tile; 2], rows: &[Measurement]) -> Result<(), String> {
    let contact = Contact::new(&fixed.outline, &moving.outline);
    for row in rows {
        let depth = -contact.clearance(&row.configuration);
        if depth > MEASURED_OVERLAP {
            return Err(format!(
                "line {}: the tiles overlap by {:.2} mm at this pose; x and y are in m, theta in \
                 rad, in the fixed tile's frame",
                row.line,
                1e3 * depth
            ));
        }
    }
    Ok(())
}

/// The fit starts with these multiples of the given length l, because from a poor start it can end
/// in a local minimum at one end of the attenuation.
const STARTING_LENGTHS: [f64; 3] = [1.0, 0.3, 3.0];

/// The rows to fit and those held out: one in every `every` of those with iron and of those
/// without.
fn hold_out(rows: &[Measurement], every: usize) -> (Vec<&Measurement>, Vec<&Measurement>) {
    let mut counts = [0; 2];
    rows.iter().partition(|row| {
        let count = &mut counts[usize::from(row.iron)];
        *count += 1;
        *count % every != 0
    })
}

/// The shield for a set of unbounded fit parameters: A is the logistic function of the first, l,
/// delta and G are the exponentials of the others, so that every set of parameters is a valid
/// shield.
fn shield_of(constants: &[f64; 4]) -> Shield {
    Shield {
        attenuation: 1.0 / (1.0 + libm::exp(-constants[0])),
        length: libm::exp(constants[1]),
        width: libm::exp(constants[2]),
        front_gain: libm::exp(constants[3]),
    }
}

fn constants_of(shield: &Shield) -> [f64; 4] {
    let a = shield.attenuation.clamp(1e-6, 1.0 - 1e-6);
    [
        libm::log(a / (1.0 - a)),
        libm::log(shield.length),
        libm::log(shield.width),
        libm::log(shield.front_gain),
    ]
}

/// Standard errors of the shield's constants from those of the fit parameters.
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
fn predictions(potential: &ShieldedPotential, row: &Measurement) -> [f64; 4] {
    let (energy, gradient) = potential.energy_and_gradient(&row.configuration);
    [energy, -gradient.x, -gradient.y, -gradient.z]
}

/// The data for computing residuals.
struct Data<'a> {
    specimen: &'a Specimen<'a>,
    bare: &'a ShieldedPotential,
    /// Root mean square of each quantity's measured values.
    scales: [Option<f64>; 4],
}

impl Data<'_> {
    fn shielded(&self, shield: &Shield) -> ShieldedPotential {
        self.bare.with_shields(&self.specimen.shields(shield))
    }

    /// A row's residuals relative to the quantities' scales.
    fn residuals(
        &self,
        shielded: &ShieldedPotential,
        strength: f64,
        row: &Measurement,
    ) -> [Option<f64>; 4] {
        let potential = if row.iron { shielded } else { self.bare };
        let predicted = predictions(potential, row);
        std::array::from_fn(|k| {
            let scale = self.scales[k].filter(|scale| *scale > 0.0).unwrap_or(1.0);
            row.measured[k].map(|measured| (measured - strength * predicted[k]) / scale)
        })
    }

    /// The factor between measured and modelled values that fits the rows without iron best.
    fn strength(&self, rows: &[&Measurement]) -> f64 {
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

    fn summary(&self, shield: &Shield, strength: f64, rows: &[&Measurement]) -> Residuals {
        let shielded = self.shielded(shield);
        let all: Vec<[Option<f64>; 4]> = rows
            .iter()
            .map(|row| self.residuals(&shielded, strength, row))
            .collect();
        let relative: [Option<f64>; 4] =
            std::array::from_fn(|k| root_mean_square(all.iter().filter_map(|row| row[k])));
        Residuals {
            rows: rows.len(),
            with_iron: rows.iter().filter(|row| row.iron).count(),
            rms: std::array::from_fn(|k| Some(relative[k]? * self.scales[k]?)),
            relative,
        }
    }
}
