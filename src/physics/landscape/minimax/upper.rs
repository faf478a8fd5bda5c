//! The upper bound: a pathway that is proved free, with its energy bounded between its points as
//! well.

use nalgebra::{Matrix3, Vector3};
use ordered_float::OrderedFloat;

use crate::cell::Cell;
use crate::configuration::Configuration;
use crate::contact::{Constraint, Contact, closest_admissible};
use crate::landscape::bounded::Bounded;

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

/// A pathway proved free throughout, and the proved bound of its energy.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::landscape) struct ProvedPath {
    /// No configuration on the pathway has a higher energy (J).
    pub upper: f64,
    /// The highest point met.
    pub peak: Configuration,
    pub points: Vec<Configuration>,
    /// Lower bounds of the energies (J) of the points; they differ from them by rounding only.
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
        let (Some(first), Some(last)) = (path.first(), path.last()) else {
            return Err(0);
        };
        let mut points = vec![*first];
        let mut owners = vec![0];
        let mut values = vec![self.value(first)];
        for (k, q) in path.iter().enumerate().skip(1) {
            self.extend(&mut points, q, k + 1 == path.len()).ok_or(k)?;
            for q in &points[owners.len()..] {
                let value = self.value(q);
                if !self.space.contains(q) || value.0 > give_up {
                    return Err(k);
                }
                values.push(value);
            }
            owners.resize(points.len(), k);
        }
        debug_assert_eq!(points.last(), Some(last));
        let (upper, peak) = self
            .highest((&points, &values), tolerance, give_up)
            .map_err(|stretch| owners[stretch + 1])?;
        Ok(ProvedPath {
            upper,
            peak,
            points,
            energies: values.into_iter().map(|value| value.0).collect(),
        })
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
        let known = self.enclose(&Cell {
            centre: *q,
            half: [0.0; 3],
        });
        let rounding = known.form.rounding(&[0.0; 3]);
        (
            known.form.value + known.low - rounding,
            known.form.value + known.high + rounding,
        )
    }

    /// The proved highest energy on the straight stretches between the points, which have these
    /// [values](Self::value), and the highest point met; or the number of a stretch that rises above
    /// `give_up`.
    fn highest(
        &self,
        (points, values): (&[Configuration], &[(f64, f64)]),
        tolerance: f64,
        give_up: f64,
    ) -> Result<(f64, Configuration), usize> {
        let (mut level, mut peak) = (f64::NEG_INFINITY, points[0]);
        for (q, value) in points.iter().zip(values) {
            if value.1 > level {
                (level, peak) = (value.1, *q);
            }
        }
        let mut upper = level;
        let mut open: Vec<(Configuration, Configuration, usize, usize)> = points
            .windows(2)
            .enumerate()
            .map(|(k, w)| (w[0], w[1], k, 0))
            .collect();
        while let Some((a, b, stretch, depth)) = open.pop() {
            let known = self.enclose(&Cell::spanned_by(&a, &b));
            let highest = known.form.greatest_along(&a.step_to(&b).into()) + known.high;
            if highest <= level + tolerance || depth == FINEST {
                if highest > give_up {
                    return Err(stretch);
                }
                upper = upper.max(highest);
                continue;
            }
            let middle = a.interpolate(&b, 0.5);
            let value = self.value(&middle).1;
            if value > level {
                (level, peak) = (value, middle);
            }
            if level > give_up {
                return Err(stretch);
            }
            open.push((a, middle, stretch, depth + 1));
            open.push((middle, b, stretch, depth + 1));
        }
        Ok((upper, peak))
    }
}
