//! The search for the lowest energy over theta at a given position.

use ordered_float::OrderedFloat;
use std::f64::consts::TAU;

use nalgebra::{Rotation2, Vector2};

use super::grid::{Sample, with_energies};
use tiles::bisection::bisected;
use tiles::configuration::{Configuration, wrap_angle};
use tiles::contact::Contact;
use tiles::interruption;
use tiles::order::Order;
use tiles::problem::Problem;
use tiles::tile::symmetry::rotations;
use tiles::tile::{Face, Outline};

/// Halvings of the step between orientations in search of the lowest energy.
const REFINEMENTS: i32 = 6;
/// Halvings of the step between a free and a blocked orientation in search of contact.
const BISECTIONS: u32 = 4;

/// The search for the lowest energy over theta.
pub struct OrientationSearch<'a> {
    problem: &'a Problem,
    /// Orientations repeat after this angle (rad).
    period: f64,
    /// Ascending, in [0, period).
    thetas: Vec<f64>,
    /// The rotations by these angles.
    rotations: Vec<Rotation2<f64>>,
    /// Largest step between two orientations (rad).
    step: f64,
    /// All orientations are free if the reference points are at least this far apart (m).
    outer: f64,
    /// All orientations are blocked if they are closer than this (m).
    inner: f64,
}

/// The free orientations found at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The lowest sample.
    pub sample: Sample,
    /// Middle of the widest range of free orientations (rad).
    pub middle: f64,
}

/// A range of free orientations (rad), `first <= last`.
type FreeRange = (f64, f64);

impl<'a> OrientationSearch<'a> {
    pub fn new(problem: &'a Problem, orientations: usize) -> Self {
        let pair = problem.pair.as_deref();
        let period = pair.map_or(TAU, |pair| TAU / rotations(&pair.moving).len() as f64);
        let count = (orientations as f64 * period / TAU).ceil() as usize;
        // Discs inside the tiles, about their reference points, overlap. This says nothing if a
        // reference point lies outside its tile.
        let depth = |outline: &Outline| -outline.signed_distance(Vector2::zeros());
        let inner = pair.map_or(0.0, |pair| {
            let (a, b) = (depth(&pair.fixed.outline), depth(&pair.moving.outline));
            if a > 0.0 && b > 0.0 {
                a + b - 2.0 * problem.contact.as_ref().map_or(0.0, Contact::touch)
            } else {
                0.0
            }
        });
        let thetas = orientations_within(period, count, problem.faces());
        let rotation = |theta: &f64| at(Vector2::zeros(), *theta).rotation();
        Self {
            problem,
            period,
            rotations: thetas.iter().map(rotation).collect(),
            thetas,
            step: period / count as f64,
            outer: problem.space.free_distance,
            inner,
        }
    }

    /// Whether any of these orientations (rad) is free at a place.
    pub fn any_is_free(&self, place: Vector2<f64>, thetas: &[f64]) -> bool {
        thetas.iter().any(|&theta| self.is_free(&at(place, theta)))
    }

    /// The free orientations among the sampled ones at each place; fastest if each place is near
    /// the previous one.
    pub fn find(&self, places: &[Vector2<f64>]) -> Vec<Option<Found>> {
        let mut known = Known::default();
        let free = places
            .iter()
            .map(|p| self.free_orientations(*p, &mut known));
        let free: Vec<_> = free.collect();
        let candidates = free.iter().map(|(candidates, _)| candidates.clone());
        let lowest = self.lowest(candidates.collect());
        lowest
            .into_iter()
            .zip(free)
            .map(|(sample, (_, middle))| sample.map(|sample| Found { sample, middle }))
            .collect()
    }

    /// The free range around the first free one of `guesses` (rad) at a place.
    pub fn find_near(&self, place: Vector2<f64>, guesses: &[f64]) -> Option<Found> {
        let free = |theta: &f64| self.is_free(&at(place, *theta));
        let guess = *guesses.iter().find(|theta| free(theta))?;
        let end = |turned: f64| {
            if free(&turned) {
                turned
            } else {
                self.contact_between(place, guess, turned)
            }
        };
        let (first, last) = (end(guess - self.step), end(guess + self.step));
        let middle = (first + last) / 2.0;
        let mut candidates = vec![first, guess, last];
        candidates.extend(free(&middle).then_some(middle));
        let candidates = candidates.into_iter().map(|theta| at(place, theta));
        let sample = self.lowest(vec![candidates.collect()])[0]?;
        Some(Found { sample, middle })
    }

    fn is_free(&self, q: &Configuration) -> bool {
        let distance = q.position().norm();
        distance >= self.outer || (distance >= self.inner && self.problem.is_clear(q))
    }

    /// The lowest of the candidates at each place, improved by a local search.
    fn lowest(&self, candidates: Vec<Vec<Configuration>>) -> Vec<Option<Sample>> {
        let mut best = vec![None; candidates.len()];
        self.take_lower(&mut best, &candidates);
        for k in 1..=REFINEMENTS {
            let turn = self.step / f64::from(1 << k);
            let turned: Vec<_> = best.iter().map(|q| self.turned(q.as_ref(), turn)).collect();
            self.take_lower(&mut best, &turned);
        }
        best
    }

    /// Replaces each sample by the lowest of its candidates if that is lower.
    fn take_lower(&self, best: &mut [Option<Sample>], candidates: &[Vec<Configuration>]) {
        let all = with_energies(self.problem, &candidates.concat());
        let mut rest = all.as_slice();
        for (best, candidates) in best.iter_mut().zip(candidates) {
            let (own, others) = rest.split_at(candidates.len());
            rest = others;
            for sample in own {
                if best.is_none_or(|lowest| sample.energy < lowest.energy) {
                    *best = Some(*sample);
                }
            }
        }
    }

    /// A sample's configuration turned to either side, if that is free.
    fn turned(&self, sample: Option<&Sample>, turn: f64) -> Vec<Configuration> {
        let Some(sample) = sample else {
            return Vec::new();
        };
        let q = sample.configuration;
        [-turn, turn]
            .map(|turn| at(q.position(), q.theta + turn))
            .into_iter()
            .filter(|q| self.is_free(q))
            .collect()
    }

    /// The free orientations at a place with those in contact at the ends of each free range, and
    /// the middle of the widest range (rad).
    fn free_orientations(
        &self,
        place: Vector2<f64>,
        known: &mut Known,
    ) -> (Vec<Configuration>, f64) {
        let distance = place.norm();
        if distance < self.inner {
            return (Vec::new(), 0.0);
        }
        interruption::check();
        let contact = self.problem.contact.as_ref();
        let contact = contact.filter(|_| distance < self.outer);
        let free = match contact {
            Some(contact) => known.free_at(place, contact, &self.rotations),
            None => vec![true; self.rotations.len()],
        };
        let sampled = self.thetas.iter().zip(&free).filter(|(_, free)| **free);
        let mut thetas: Vec<f64> = sampled.map(|(&theta, _)| theta).collect();
        let ranges = self.free_ranges(place, &free);
        thetas.extend(ranges.iter().flat_map(|range| [range.0, range.1]));
        let widest = ranges
            .into_iter()
            .max_by_key(|(first, last)| OrderedFloat(last - first));
        let middle = widest.map_or(0.0, |(first, last)| (first + last) / 2.0);
        let candidates = thetas.into_iter().map(|theta| at(place, theta));
        (candidates.collect(), middle)
    }

    /// The ranges of free orientations between blocked ones; `free` has one value per sampled
    /// orientation.
    fn free_ranges(&self, place: Vector2<f64>, free: &[bool]) -> Vec<FreeRange> {
        let count = self.thetas.len();
        let Some(start) = free.iter().position(|free| !free) else {
            return Vec::new();
        };
        let theta = |i: usize| self.thetas[i % count] + self.period * (i / count) as f64;
        let mut ranges = Vec::new();
        let mut first = 0.0;
        for i in start..start + count {
            match (free[i % count], free[(i + 1) % count]) {
                (false, true) => first = self.contact_between(place, theta(i + 1), theta(i)),
                (true, false) => {
                    let last = self.contact_between(place, theta(i), theta(i + 1));
                    ranges.push((first, last));
                }
                _ => {}
            }
        }
        ranges
    }

    /// The free orientation (rad) in contact between a free and a blocked one.
    fn contact_between(&self, place: Vector2<f64>, free: f64, blocked: f64) -> f64 {
        let is_free = |theta| self.is_free(&at(place, theta));
        bisected(free, blocked, BISECTIONS, is_free)[0]
    }
}

/// The state of the sampled orientations at the previous place.
#[derive(Default)]
struct Known {
    place: Vector2<f64>,
    /// Whether each is free, and how far (m) from that place it stays so.
    free: Vec<(bool, f64)>,
}

impl Known {
    /// Which orientations are free at a place; only those that may have changed are checked.
    fn free_at(
        &mut self,
        place: Vector2<f64>,
        contact: &Contact,
        rotations: &[Rotation2<f64>],
    ) -> Vec<bool> {
        let step = (place - self.place).norm();
        self.place = place;
        self.free.resize(rotations.len(), (false, 0.0));
        let all = self.free.iter_mut().zip(rotations);
        let look = |((free, around), rotation): (&mut (bool, f64), &Rotation2<f64>)| {
            *around -= step;
            if *around <= contact.touch() {
                (*free, *around) = contact.is_free_turned(*rotation, place);
            }
            *free
        };
        all.map(look).collect()
    }
}

fn at(place: Vector2<f64>, theta: f64) -> Configuration {
    Configuration::new(place.x, place.y, wrap_angle(theta))
}

/// Evenly spread orientations together with those that lay two faces flush, in [0, period).
fn orientations_within(period: f64, count: usize, [fixed, moving]: [&[Face]; 2]) -> Vec<f64> {
    let spread = (0..count).map(|k| k as f64 * period / count as f64);
    let direction = |face: &Face| libm::atan2(face.normal().y, face.normal().x);
    let flush = fixed.iter().flat_map(|to| {
        moving
            .iter()
            .map(move |from| (direction(to) - direction(from) + TAU / 2.0).rem_euclid(period))
    });
    let mut thetas: Vec<f64> = spread.chain(flush).collect();
    thetas.order_by(f64::total_cmp);
    thetas.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    thetas
}
