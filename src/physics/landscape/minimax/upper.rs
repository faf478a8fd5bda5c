//! The upper bound: a pathway that is proved free, with its energy bounded between its points as
//! well.

use nalgebra::{Matrix3, Vector3};
use ordered_float::OrderedFloat;

use crate::cell::Cell;
use crate::configuration::Configuration;
use crate::contact::{Constraint, Contact, closest_admissible};
use crate::landscape::bounded::Bounded;
use crate::parallel;

/// How far (m) inner points of a pathway are lifted off contact, so that a chord between two of
/// them does not cut into it.
const LIFT: f64 = 1e-6;

/// Contacts within this distance (m) are considered when a point is lifted off contact. Near
/// corners, not all contacts within a millimetre can be kept open at the same time, or only far
/// away.
const AROUND: [f64; 2] = [1e-3, 10.0 * LIFT];

/// A point lifted by at most this (m) need not be lifted in another way.
const SHORT: f64 = 10.0 * LIFT;

/// A stretch is halved at most this often to prove it free.
const DEPTH: usize = 12;

/// A stretch is halved at most this often to bound its energy.
const FINEST: usize = 24;

/// Points and stretches examined before a pathway can be given up. It does not depend on the number
/// of threads, so the results do not either.
const AT_ONCE: usize = 64;

/// A pathway proved free throughout, and the proved bound of its energy.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::landscape) struct ProvedPath {
    /// No configuration on the pathway has a higher energy (J).
    pub upper: f64,
    /// The highest point met.
    pub peak: Configuration,
    pub points: Vec<Configuration>,
    /// The energies (J) of the points, to rounding.
    pub energies: Vec<f64>,
}

impl Bounded<'_> {
    /// Proves a pathway through the given points: straight stretches, lifted off contact and
    /// refined where they cannot be proved as they are. The energy's bound is sharpened until it
    /// exceeds the highest energy met by no more than `tolerance` (J).
    ///
    /// # Errors
    /// The index of a point before which the pathway cannot be proved free, or rises above
    /// `give_up` (J).
    pub fn prove(
        &self,
        path: &[Configuration],
        tolerance: f64,
        give_up: f64,
    ) -> Result<ProvedPath, usize> {
        let (points, owners) = self.freed(path)?;
        let mut energies: Vec<f64> = Vec::new();
        for part in points.chunks(AT_ONCE) {
            let known = energies.len();
            energies.extend(parallel::map(part, |q| self.energy(q)));
            let is_out = |k: &usize| !self.space.contains(&points[*k]) || energies[*k] > give_up;
            if let Some(k) = (known..energies.len()).find(is_out) {
                return Err(owners[k]);
            }
        }
        let (upper, peak) = self
            .highest((&points, &energies), tolerance, give_up)
            .map_err(|stretch| owners[stretch + 1])?;
        Ok(ProvedPath {
            upper,
            peak,
            points,
            energies,
        })
    }

    /// The points of a pathway through the given points, proved free, and for each of them the
    /// number of the given point before which it was inserted, or which it is.
    ///
    /// # Errors
    /// The number of a point before which the pathway cannot be proved free.
    fn freed(&self, path: &[Configuration]) -> Result<(Vec<Configuration>, Vec<usize>), usize> {
        let mut points = vec![*path.first().ok_or(0usize)?];
        let mut owners = vec![0];
        let stretches: Vec<&[Configuration]> = path.windows(2).collect();
        for (part, stretches) in stretches.chunks(AT_ONCE).enumerate() {
            let free = parallel::map(stretches, |ends| self.is_free(&ends[0], &ends[1]));
            for (i, (ends, is_free)) in stretches.iter().zip(free).enumerate() {
                let k = part * AT_ONCE + i + 1;
                if is_free && points.last() == Some(&ends[0]) {
                    points.push(ends[1]);
                } else {
                    self.extend(&mut points, &ends[1], k + 1 == path.len())
                        .ok_or(k)?;
                }
                owners.resize(points.len(), k);
            }
        }
        Ok((points, owners))
    }

    /// Appends a proved free path from the last point to `to` or, unless it is the `end`, to `to`
    /// lifted off contact.
    fn extend(&self, points: &mut Vec<Configuration>, to: &Configuration, end: bool) -> Option<()> {
        if self.is_free(points.last()?, to) {
            points.push(*to);
            return Some(());
        }
        let lifted = if end { None } else { self.lifted(to) };
        let length = points.len();
        for target in lifted.iter().chain([to]) {
            if self.join(points, target, DEPTH).is_some() {
                return Some(());
            }
            points.truncate(length);
        }
        None
    }

    /// Appends a proved free path from the last point to `to`, bent off contact where needed.
    fn join(
        &self,
        points: &mut Vec<Configuration>,
        to: &Configuration,
        depth: usize,
    ) -> Option<()> {
        let from = *points.last()?;
        if self.is_free(&from, to) {
            points.push(*to);
            return Some(());
        }
        if depth == 0 {
            return None;
        }
        let middle = from.interpolate(to, 0.5);
        let middle = self.lifted(&middle).unwrap_or(middle);
        self.join(points, &middle, depth - 1)?;
        self.join(points, to, depth - 1)
    }

    /// Whether the straight path is proved free throughout.
    fn is_free(&self, from: &Configuration, to: &Configuration) -> bool {
        self.contact
            .is_none_or(|contact| contact.stays_separated(from, to, contact.touch()))
    }

    /// The configuration moved off contact until the tiles are [`LIFT`] apart or, where there is no
    /// room for that, until they touch.
    pub fn lifted(&self, q: &Configuration) -> Option<Configuration> {
        let Some(contact) = self.contact else {
            return Some(*q);
        };
        let [wide, close] = AROUND.map(|around| contact.scaled(around));
        let lift = contact.scaled(LIFT);
        let moved = |at: &Configuration| self.space.distance(q, at);
        let first = self.lifted_by(contact, q, (lift, wide));
        let second = if first.is_some_and(|at| moved(&at) <= contact.scaled(SHORT)) {
            None
        } else {
            self.lifted_by(contact, q, (lift, close))
        };
        let lifted = first.into_iter().chain(second);
        lifted
            .min_by_key(|at| OrderedFloat(moved(at)))
            // A slot without play leaves no room to lift the tile.
            .or_else(|| self.lifted_by(contact, q, (0.0, close)))
    }

    fn lifted_by(
        &self,
        contact: &Contact,
        q: &Configuration,
        (lift, around): (f64, f64),
    ) -> Option<Configuration> {
        let metric = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, self.space.rho.powi(2)));
        let mut at = *q;
        for _ in 0..12 {
            if contact.clearance_bound(&at) >= lift {
                return Some(at);
            }
            let clearance = contact.clearance(&at);
            if clearance >= 0.5 * (lift - contact.touch()) {
                return Some(at);
            }
            let margin = 2.0 * clearance.abs() + around;
            let constraints: Vec<Constraint> = contact
                .constraints(&at, margin)
                .into_iter()
                .map(|c| Constraint {
                    gap: c.gap - lift,
                    ..c
                })
                .collect();
            let (step, _) = closest_admissible(
                (Vector3::zeros(), contact.scaled(1.0)),
                &metric,
                &constraints,
            )?;
            at = at.moved(step);
        }
        None
    }

    /// Lower and upper bound of the energy (J) of one configuration; they differ by rounding only.
    pub fn value(&self, q: &Configuration) -> (f64, f64) {
        let known = self.enclose(&Cell::at(q));
        let rounding = known.form.rounding(&[0.0; 3]);
        (
            known.form.value + known.low - rounding,
            known.form.value + known.high + rounding,
        )
    }

    /// The proved highest energy on the straight stretches between the points, which have these
    /// energies (J), and the highest point met; or the number of a stretch that rises above
    /// `give_up`. Each bound includes the ends of its stretch.
    fn highest(
        &self,
        (points, energies): (&[Configuration], &[f64]),
        tolerance: f64,
        give_up: f64,
    ) -> Result<(f64, Configuration), usize> {
        let met = points.iter().zip(energies);
        let highest = met.max_by_key(|(_, energy)| OrderedFloat(**energy));
        let (mut peak, mut level) = highest.map(|(q, energy)| (*q, *energy)).ok_or(0usize)?;
        let mut upper = self.value(&peak).1;
        let stretches = points.windows(2).enumerate();
        let mut open: Vec<Stretch> = stretches
            .map(|(number, ends)| Stretch {
                ends: [ends[0], ends[1]],
                number,
                halvings: 0,
            })
            .collect();
        while !open.is_empty() {
            let part = open.split_off(open.len().saturating_sub(AT_ONCE));
            let bounds = parallel::map(&part, |stretch| {
                let highest = self.highest_on(stretch);
                let middle = stretch.middle();
                let is_close = highest <= level + tolerance;
                (highest, middle, (!is_close).then(|| self.energy(&middle)))
            });
            for (_, middle, energy) in &bounds {
                if let Some(energy) = energy.filter(|energy| *energy > level) {
                    (level, peak) = (energy, *middle);
                }
            }
            for (stretch, (highest, middle, _)) in part.iter().zip(bounds) {
                let is_last = highest <= level + tolerance || stretch.halvings == FINEST;
                if level > give_up || is_last && highest > give_up {
                    return Err(stretch.number);
                }
                if is_last {
                    upper = upper.max(highest);
                } else {
                    open.extend(stretch.halved_at(middle));
                }
            }
        }
        Ok((upper, peak))
    }

    /// The proved highest energy (J) on a stretch, its ends included.
    fn highest_on(&self, Stretch { ends: [a, b], .. }: &Stretch) -> f64 {
        let known = self.enclose(&Cell::spanned_by(a, b));
        known.form.greatest_along(&a.step_to(b).into()) + known.high
    }
}

/// A straight part of a pathway, after so many halvings of the stretch of this number.
struct Stretch {
    ends: [Configuration; 2],
    number: usize,
    halvings: usize,
}

impl Stretch {
    fn middle(&self) -> Configuration {
        self.ends[0].interpolate(&self.ends[1], 0.5)
    }

    fn halved_at(&self, middle: Configuration) -> [Self; 2] {
        let [a, b] = self.ends;
        [[a, middle], [middle, b]].map(|ends| Self {
            ends,
            number: self.number,
            halvings: self.halvings + 1,
        })
    }
}
