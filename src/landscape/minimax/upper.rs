//! The upper bound: a pathway that is proved free, with its energy bounded between its points as
//! well.

use nalgebra::{Matrix3, Vector3};
use ordered_float::OrderedFloat;

use crate::bounded::{A_STEP, Bounded};
use tiles::cell::Cell;
use tiles::configuration::Configuration;
use tiles::contact::{Constraint, Contact, closest_admissible};
use tiles::parallel;

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

/// Until it is halved this often, a stretch's bound is assumed to be wider than that of a point.
const COARSE: usize = 6;

/// Units of work to prove a stretch free and to lift its end, in units of a test of contact and a
/// step.
const FREED: u64 = 4;

/// Points and stretches examined before a pathway can be given up. It does not depend on the number
/// of threads, so the results do not either.
const AT_ONCE: usize = 64;

/// How far the energy's bound of a pathway is sharpened.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sharpening {
    /// Until it exceeds the highest energy met by no more than this (J).
    pub tolerance: f64,
    /// A pathway above this energy (J) is not wanted.
    pub give_up: f64,
    /// Units of work left, after which it stays as it is, or is given up where it has no bound yet.
    pub work: u64,
}

impl Sharpening {
    fn spend(&mut self, work: u64) {
        self.work = self.work.saturating_sub(work);
    }
}

/// A pathway proved free throughout, and the proved bound of its energy.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ProvedPath {
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
    /// refined where they cannot be proved as they are. The energy's bound is sharpened as far as
    /// `sharpening` says, from whose work is taken what this costs.
    ///
    /// # Errors
    /// The index of a point before which the pathway cannot be proved free, or rises above
    /// [`Sharpening::give_up`], or how far the work led.
    pub fn prove(
        &self,
        path: &[Configuration],
        sharpening: &mut Sharpening,
    ) -> Result<ProvedPath, usize> {
        let give_up = sharpening.give_up;
        let of_a_point = FREED * (self.work_of_contact() + A_STEP) + self.work_of_bounds();
        let mut points = vec![*path.first().ok_or(0usize)?];
        let mut energies: Vec<f64> = Vec::new();
        // For each point, the number of the given point before which it was inserted, or which it is.
        let mut owners = vec![0];
        let stretches: Vec<&[Configuration]> = path.windows(2).collect();
        for part in 0..stretches.len().div_ceil(AT_ONCE).max(1) {
            let first = part * AT_ONCE;
            let few = &stretches[first..stretches.len().min(first + AT_ONCE)];
            let is_end = first + few.len() == stretches.len();
            let most = sharpening.work / (AT_ONCE as u64 * of_a_point);
            if most == 0 {
                return Err(first);
            }
            let freed = self.freed(&points[points.len() - 1], few, is_end, most as usize);
            for (k, inserted) in (first + 1..).zip(freed) {
                points.extend(inserted.ok_or(k)?);
                owners.resize(points.len(), k);
            }
            let known = energies.len();
            sharpening.spend((points.len() - known) as u64 * of_a_point);
            energies.extend(parallel::map(&points[known..], |q| self.energy(q)));
            let is_out = |k: &usize| !self.space.contains(&points[*k]) || energies[*k] > give_up;
            if let Some(k) = (known..energies.len()).find(is_out) {
                return Err(owners[k]);
            }
        }
        let (upper, peak) = self
            .highest((&points, &energies), sharpening)
            .map_err(|stretch| owners[stretch + 1])?;
        Ok(ProvedPath {
            upper,
            peak,
            points,
            energies,
        })
    }

    /// For each of some consecutive stretches the points of a path proved free, without its first;
    /// `None` if it cannot be proved free, or needs more points than `most`. The first one begins at
    /// `from`. Where a stretch is not free itself, its path leads to its end lifted off contact,
    /// unless that `is_end` of the pathway.
    fn freed(
        &self,
        from: &Configuration,
        stretches: &[&[Configuration]],
        is_end: bool,
        most: usize,
    ) -> Vec<Option<Vec<Configuration>>> {
        let free = parallel::map(stretches, |ends| self.is_free(&ends[0], &ends[1]));
        let mut targets = parallel::map(0..stretches.len(), |i| {
            let to = stretches[i][1];
            let stays = free[i] || is_end && i + 1 == stretches.len();
            if stays { Some(to) } else { self.lifted(&to) }
        });
        // Beyond a place that cannot be lifted there is nothing to prove.
        let lost = targets.iter().position(Option::is_none);
        targets.truncate(lost.map_or(targets.len(), |lost| lost + 1));
        parallel::map(0..targets.len(), |i| {
            let to = targets[i]?;
            let mut points = vec![match i {
                0 => *from,
                _ => targets[i - 1]?,
            }];
            if free[i] && points[0] == stretches[i][0] {
                points.push(to);
            } else {
                self.join(&mut points, &to, DEPTH, most)?;
            }
            Some(points.split_off(1))
        })
    }

    /// Appends a proved free path from the last point to `to`, bent off contact where needed.
    fn join(
        &self,
        points: &mut Vec<Configuration>,
        to: &Configuration,
        depth: usize,
        most: usize,
    ) -> Option<()> {
        let from = *points.last()?;
        if self.is_free(&from, to) {
            points.push(*to);
            return Some(());
        }
        if depth == 0 || points.len() > most {
            return None;
        }
        let middle = from.interpolate(to, 0.5);
        let middle = self.lifted(&middle)?;
        self.join(points, &middle, depth - 1, most)?;
        self.join(points, to, depth - 1, most)
    }

    /// Whether the straight path is proved free throughout.
    fn is_free(&self, from: &Configuration, to: &Configuration) -> bool {
        self.count(self.work_of_contact());
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
            self.count(self.work_of_contact() + A_STEP);
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
        let (low, _, high) = self.bounded_energy(q);
        (low, high)
    }

    /// The same with the energy (J) between them.
    fn bounded_energy(&self, q: &Configuration) -> (f64, f64, f64) {
        let known = self.enclose(&Cell::at(q));
        let rounding = known.form.rounding(&[0.0; 3]);
        let energy = known.form.value;
        (
            energy + known.low - rounding,
            energy,
            energy + known.high + rounding,
        )
    }

    /// The proved highest energy on the straight stretches between the points, which have these
    /// energies (J), and the highest point met; or the number of a stretch that rises above
    /// [`Sharpening::give_up`]. Each bound includes the ends of its stretch, so it is one at any
    /// sharpness.
    ///
    /// A stretch is halved until its bound exceeds the highest energy met by no more than the
    /// tolerance. Bounds of blocks near each other stay apart by more than that even at a point; so a
    /// stretch is not halved either if its bound exceeds that at its middle by no more, which no
    /// halving can go below. After [`Sharpening::work`] no stretch is halved, and the pathway is given
    /// up if it has stretches without a bound.
    fn highest(
        &self,
        (points, energies): (&[Configuration], &[f64]),
        sharpening: &mut Sharpening,
    ) -> Result<(f64, Configuration), usize> {
        let Sharpening {
            tolerance, give_up, ..
        } = *sharpening;
        // The bound, and the energy at the middle.
        let of_a_stretch = 2 * self.work_of_bounds();
        let count = points.len() as u64 - 1;
        if count * of_a_stretch > sharpening.work {
            return Err((sharpening.work / of_a_stretch) as usize);
        }
        sharpening.spend(count * of_a_stretch);
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
            let halved = part.iter().filter(|stretch| stretch.halvings > 0);
            sharpening.spend(halved.count() as u64 * of_a_stretch);
            let bounds = parallel::map(&part, |stretch| {
                let (highest, work) = self.highest_on(stretch);
                let middle = stretch.middle();
                let is_close = highest <= level + tolerance;
                let value = || match stretch.halvings < COARSE {
                    true => (self.energy(&middle), f64::NEG_INFINITY),
                    false => {
                        let (_, energy, upper) = self.bounded_energy(&middle);
                        (energy, upper)
                    }
                };
                (highest, middle, (!is_close).then(value), work)
            });
            for (_, middle, value, work) in &bounds {
                sharpening.spend(work.saturating_sub(self.work_of_bounds()));
                if let Some((energy, _)) = value.filter(|(energy, _)| *energy > level) {
                    (level, peak) = (energy, *middle);
                }
            }
            for (stretch, (highest, middle, value, _)) in part.iter().zip(bounds) {
                let is_sharp = value.is_some_and(|(_, upper)| highest <= upper + tolerance);
                let is_last = highest <= level + tolerance
                    || is_sharp
                    || stretch.halvings == FINEST
                    || sharpening.work == 0;
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

    /// The proved highest energy (J) on a stretch, its ends included, and the units of work of
    /// this bound.
    fn highest_on(&self, Stretch { ends: [a, b], .. }: &Stretch) -> (f64, u64) {
        let known = self.enclose(&Cell::spanned_by(a, b));
        let highest = known.form.greatest_along(&a.step_to(b).into()) + known.high;
        (highest, self.work_of(&known))
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
