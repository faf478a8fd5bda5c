//! Fits the strength of a design's magnets to measured forces.
//!
//! With the design's own remanence J0 the model has the force f(d) when the tiles are d apart along
//! the target face's normal. Magnets of the remanence J whose poles lie z further apart than the
//! design says (a coating, glue, a pocket too deep, the zero of a gauge) have
//!
//! `F(d) = (J / J0)^2 f(d + z)`,
//!
//! since the energy of rigid magnets is bilinear in their moments. ln(J / J0) and z minimise the sum
//! of squares of (measured - F) / s (Levenberg 1944, Marquardt 1963, doi:10.1137/0111030), where s
//! is the reading itself or, where the scale's last digit is coarser than 2 % of it, that digit's
//! share: `s^2 = F^2 + (digit / (0.02 sqrt(12)))^2`. So a misfit is a share of the readings.
//!
//! The intervals are Student's, from the scatter about the fit and from the rounding of readings,
//! whichever is larger. Below four readings the offset cannot be separated and is taken as 0; one
//! reading has no interval.

use nalgebra::Vector2;
use physics::configuration::Configuration;
use physics::potential::interaction::Interaction;
use physics::potential::shielding::Shields;
use physics::problem::Problem;
use physics::tile::Tile;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::fit::{Fit, least_squares};
use super::gaps::Reading;
use super::{Measurement, QUANTITIES, root_mean_square};
use crate::design::Design;
use crate::inspection::out_of_bond;

/// Readings from which on the offset of the gap is fitted, too.
const FOR_OFFSET: usize = 4;
/// Below this share of a reading its rounding does not matter.
const FINE: f64 = 0.02;
/// The unit of the offset in the fit (m), for a step that suits gaps.
const OFFSET: f64 = 1e-3;
/// The largest misfit, as a share of the readings, of magnets as the design describes them: published
/// forces scatter by 2 to 4 % about such a fit.
const MISFIT: f64 = 0.1;
/// Larger offsets (m) are no error of a gauge or a pocket.
const LARGEST_OFFSET: f64 = 1e-3;
/// Largest number of steps of the fit.
const STEPS: usize = 200;
/// Points of the fitted curve.
const POINTS: usize = 101;
/// The range of remanences that are made (T).
const MADE: [f64; 2] = [0.05, 1.6];

/// The strength of magnets fitted to forces.
#[derive(Clone, Debug, PartialEq)]
pub struct StrengthFit {
    /// The remanence of the design's magnets (T), the strongest one's if they differ.
    pub nominal: f64,
    /// Whether all magnets of the design have that remanence.
    pub is_common: bool,
    /// The fitted remanence (T).
    pub remanence: f64,
    /// Its 95 % interval (T).
    pub interval: Option<[f64; 2]>,
    /// How much further apart (m) the poles are than the design says; 0 if not fitted.
    pub offset: f64,
    /// Its 95 % interval (m).
    pub offset_interval: Option<[f64; 2]>,
    /// The root mean square of the misfit, as a share of the readings.
    pub misfit: f64,
    /// Whether magnets as described by the design fit, with a remanence and an offset that occur.
    pub fits: bool,
    /// Whether the measured values have the opposite sign of the design's, and were taken so.
    pub is_reversed: bool,
    /// The readings with the model's values.
    pub readings: Vec<Compared>,
    /// The gap (m), the fitted force and that of the design's own magnets (N), from contact to a
    /// little beyond the readings.
    pub curve: Vec<[f64; 3]>,
}

/// A reading beside the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// The reading.
    pub reading: Reading,
    /// The fitted force (N).
    pub fitted: f64,
    /// The force (N) of the design's own remanence, without an offset.
    pub nominal: f64,
    /// The remanence (T) that gives the reading without an offset.
    pub remanence: f64,
}

/// A measured value beside the model's.
struct Sample<'a> {
    measured: f64,
    /// What a misfit is a share of.
    scale: f64,
    /// The error of rounding, as a share of the same.
    rounding: f64,
    /// The value of the design's own magnets with their poles further apart (m).
    model: Box<dyn Fn(f64) -> f64 + 'a>,
}

/// Fits the strength of a design's magnets to the forces over the gap.
///
/// # Errors
/// If the design's magnets have no force at a reading's gap.
pub fn fit(design: &Design, readings: &[Reading]) -> Result<StrengthFit, String> {
    let problem = design.problem();
    let normal = design.pair.target_face().normal();
    let closest = -distance_of_poles(design);
    let force = |gap: f64| {
        let (_, gradient) = problem.energy_and_gradient(&out_of_bond(design, gap.max(closest)));
        gradient.xy().dot(&normal).abs()
    };
    let force = &force;
    let sample = |it: &Reading| {
        let digit = it.resolution / 12f64.sqrt();
        let scale = libm::hypot(it.force, digit / FINE);
        let gap = it.gap;
        Sample {
            measured: it.force,
            scale,
            rounding: digit / scale,
            model: Box::new(move |further| force(gap + further)),
        }
    };
    let samples: Vec<Sample> = readings.iter().map(sample).collect();
    let own: Vec<f64> = readings.iter().map(|it| force(it.gap)).collect();
    if let Some((reading, _)) = readings.iter().zip(&own).find(|(_, f)| **f == 0.0) {
        return Err(format!(
            "line {}: the design's magnets have no force straight apart at this gap; are its target \
             faces the ones that were measured?",
            reading.line
        ));
    }
    let found = fit_samples(design, &samples);
    let factor = (found.remanence / found.nominal).powi(2);
    let fitted = |gap: f64| factor * force(gap + found.offset);
    let compared = readings.iter().zip(own).map(|(reading, own)| Compared {
        reading: *reading,
        fitted: fitted(reading.gap),
        nominal: own,
        remanence: found.nominal * (reading.force / own).sqrt(),
    });
    Ok(StrengthFit {
        readings: compared.collect(),
        curve: curve(readings, |gap| [gap, fitted(gap), force(gap)]),
        ..found
    })
}

/// Fits the strength of a design's magnets to energies, forces and torques without iron, whatever
/// shields the design has.
///
/// # Errors
/// If there are no values.
pub fn fit_rows(design: &Design, rows: &[Measurement]) -> Result<StrengthFit, String> {
    let interaction = Interaction {
        shields: Shields::default(),
        ..design.interaction.clone()
    };
    let problem = &Problem::new(design.space(), design.pair.clone(), &interaction);
    let normal = design.pair.target_face().normal();
    let closest = -distance_of_poles(design);
    let samples: Vec<Sample> = (0..QUANTITIES.len())
        .flat_map(|k| {
            let of = move |row: &Measurement| {
                row.measured[k].map(|measured| (row.configuration, measured))
            };
            let measured: Vec<_> = rows.iter().filter_map(of).collect();
            let scale = root_mean_square(measured.iter().map(|it| it.1)).unwrap_or_default();
            measured.into_iter().map(move |(pose, measured)| Sample {
                measured,
                scale: if scale > 0.0 { scale } else { 1.0 },
                rounding: 0.0,
                model: Box::new(move |further| {
                    let out = pose.position() + normal * further.max(closest);
                    let pose = Configuration::new(out.x, out.y, pose.theta);
                    let (energy, gradient) = problem.energy_and_gradient(&pose);
                    [energy, -gradient.x, -gradient.y, -gradient.z][k]
                }),
            })
        })
        .collect();
    match samples.is_empty() {
        true => Err("there are no measured values".to_owned()),
        false => Ok(fit_samples(design, &samples)),
    }
}

/// Fits strength and offset to samples; readings and curve are left empty.
fn fit_samples(design: &Design, samples: &[Sample]) -> StrengthFit {
    let with_offset = samples.len() >= FOR_OFFSET;
    let start = samples.iter().fold([0.0; 2], |[product, square], it| {
        let [measured, model] = [it.measured, (it.model)(0.0)].map(|value| value / it.scale);
        [product + measured * model, square + model * model]
    });
    let [product, square] = start;
    let sign = if product < 0.0 { -1.0 } else { 1.0 };
    let start = match product != 0.0 && square > 0.0 {
        true => 0.5 * libm::log(product.abs() / square),
        false => 0.0,
    };
    let residuals = |[log, shift]: [f64; 2]| -> Vec<f64> {
        let factor = sign * libm::exp(2.0 * log);
        let residual = |it: &Sample| (it.measured - factor * (it.model)(shift * OFFSET)) / it.scale;
        samples.iter().map(residual).collect()
    };
    let found = match with_offset {
        true => Ends::from(least_squares([start, 0.0], STEPS, |at| residuals(*at))),
        false => Ends::from(least_squares([start], STEPS, |at| residuals([at[0], 0.0]))),
    };
    let freedom = samples
        .len()
        .saturating_sub(if with_offset { 2 } else { 1 });
    let misfit = (found.square / freedom.max(1) as f64).sqrt();
    let rounding = samples
        .iter()
        .map(|it| it.rounding * it.rounding)
        .sum::<f64>();
    let rounding = (rounding / samples.len() as f64).sqrt();
    let half = (freedom > 0).then(|| {
        // At least as wide as the rounding of the readings makes it.
        let wider = (rounding / misfit.max(f64::MIN_POSITIVE)).max(1.0);
        let quantile = StudentsT::new(0.0, 1.0, freedom as f64)
            .map_or(f64::INFINITY, |t| t.inverse_cdf(0.975));
        found.errors.map(|error| quantile * wider * error)
    });
    let nominal = Nominal::of(design);
    let [log, shift] = found.best;
    let of = |log: f64| nominal.remanence * libm::exp(log);
    let shifts = |half: [f64; 2]| [shift - half[1], shift + half[1]].map(|end| end * OFFSET);
    StrengthFit {
        nominal: nominal.remanence,
        is_common: nominal.is_common,
        remanence: of(log),
        interval: half.map(|half| [of(log - half[0]), of(log + half[0])]),
        offset: shift * OFFSET,
        offset_interval: half.filter(|_| with_offset).map(shifts),
        misfit,
        fits: misfit <= MISFIT
            && (MADE[0]..=MADE[1]).contains(&of(log))
            && (shift * OFFSET).abs() <= nominal.largest_offset,
        is_reversed: product < 0.0,
        readings: Vec::new(),
        curve: Vec::new(),
    }
}

/// The remanence of a design's magnets.
struct Nominal {
    remanence: f64,
    is_common: bool,
    /// Half a magnet's height, at most [`LARGEST_OFFSET`] (m).
    largest_offset: f64,
}

impl Nominal {
    fn of(design: &Design) -> Self {
        let pair = &design.pair;
        let magnets = pair.fixed.magnets.iter().chain(&pair.moving.magnets);
        let heights = magnets.clone().map(|magnet| 0.5 * magnet.axis_first()[0]);
        let all: Vec<f64> = magnets.map(|magnet| magnet.remanence()).collect();
        let remanence = all.iter().copied().fold(0.0, f64::max);
        Self {
            remanence,
            is_common: all.iter().all(|it| remanence - it <= 1e-9 * remanence),
            largest_offset: heights.fold(LARGEST_OFFSET, f64::min),
        }
    }
}

/// The logarithm of the strength and the offset, with their standard errors.
struct Ends {
    best: [f64; 2],
    errors: [f64; 2],
    square: f64,
}

impl From<Fit<2>> for Ends {
    fn from(fit: Fit<2>) -> Self {
        Self {
            best: fit.best,
            errors: fit.standard_errors,
            square: fit.square,
        }
    }
}

impl From<Fit<1>> for Ends {
    fn from(fit: Fit<1>) -> Self {
        Self {
            best: [fit.best[0], 0.0],
            errors: [fit.standard_errors[0], 0.0],
            square: fit.square,
        }
    }
}

/// The distance (m) of the foremost poles of the two tiles in contact, along the target face's
/// normal: how far the tiles could be pushed together before their magnets meet.
fn distance_of_poles(design: &Design) -> f64 {
    let pair = &design.pair;
    let normal = pair.target_face().normal();
    let along = |tile: &Tile, place: &dyn Fn(Vector2<f64>) -> Vector2<f64>| -> Vec<f64> {
        let corners = tile.magnets.iter().flat_map(|magnet| magnet.corners());
        corners.map(|corner| place(corner).dot(&normal)).collect()
    };
    let front = along(&pair.fixed, &|corner| corner);
    let back = along(&pair.moving, &|corner| pair.bound.transform(corner));
    let front = front.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let back = back.into_iter().fold(f64::INFINITY, f64::min);
    (back - front).max(0.0)
}

/// Points over the gap, from contact to a tenth beyond the last reading.
fn curve(readings: &[Reading], point: impl Fn(f64) -> [f64; 3]) -> Vec<[f64; 3]> {
    let last = readings.iter().map(|it| it.gap).fold(0.0, f64::max);
    let gap = |k: usize| 1.1 * last * k as f64 / (POINTS - 1) as f64;
    (0..POINTS).map(|k| point(gap(k))).collect()
}
