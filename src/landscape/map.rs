//! The lowest energy over theta at each (x, y).
//!
//! Every number is the energy of a free configuration, so that no map shows an energy that only
//! overlapping tiles could have. Grids are computed row by row in parallel and gathered in order:
//! the same numbers come out on any number of threads.

use std::f64::consts::TAU;

use nalgebra::{Rotation2, Vector2};
use rayon::prelude::*;

use crate::configuration::{Configuration, wrap_angle};
use crate::contact::{Contact, TOUCH};
use crate::potential::Potential;
use crate::tile::symmetry::rotations;
use crate::tile::{Face, Tile};

/// The pair of tiles that a section is taken of.
#[derive(Clone, Copy)]
pub struct Pair<'a> {
    pub fixed: &'a Tile,
    pub moving: &'a Tile,
    pub potential: &'a dyn Potential,
    pub contact: &'a Contact,
}

/// Values on a grid, row by row from the lowest y; `None` where no free configuration belongs to
/// the grid point.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<T> {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub values: Vec<Option<T>>,
}

impl<T> Grid<T> {
    pub fn value(&self, column: usize, row: usize) -> Option<&T> {
        self.values[row * self.x.len() + column].as_ref()
    }
}

/// A free configuration and its energy U (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    pub configuration: Configuration,
    pub energy: f64,
}

/// A rectangle of the plane with a grid on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Where the grid's origin lies in the fixed tile's frame (m).
    pub origin: Vector2<f64>,
    /// Direction of the grid's x axis in the fixed tile's frame (rad).
    pub angle: f64,
    /// Least x and y on the grid (m).
    pub low: [f64; 2],
    /// Greatest x and y on the grid (m).
    pub high: [f64; 2],
    /// Grid points along x and along y, at least two.
    pub samples: [usize; 2],
}

impl Window {
    /// A point of the grid in the fixed tile's frame (m).
    fn place(&self, x: f64, y: f64) -> Vector2<f64> {
        self.origin + Rotation2::new(self.angle) * Vector2::new(x, y)
    }

    /// A point of the fixed tile's frame on the grid (m).
    pub fn locate(&self, p: Vector2<f64>) -> Vector2<f64> {
        Rotation2::new(-self.angle) * (p - self.origin)
    }
}

/// The lowest energy over theta at each (x, y) of a window.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyMap {
    pub window: Window,
    /// The sample of lowest energy at each grid point.
    pub lowest: Grid<Sample>,
    /// Largest clearance over theta (m) at the grid points beside the border of the blocked
    /// region; elsewhere only its sign means something. It tells where between two grid points the
    /// border runs.
    pub room: Vec<f64>,
}

impl EnergyMap {
    /// The map of a window, from `orientations` evenly spread orientations, those that lay two
    /// faces flush, those in contact between a free and a blocked one, and a search about the
    /// lowest of them all.
    pub fn new(pair: &Pair, window: &Window, orientations: usize) -> Self {
        let [columns, rows] = window.samples;
        let x = evenly(window.low[0], window.high[0], columns);
        let y = evenly(window.low[1], window.high[1], rows);
        let search = Search::new(pair, orientations);
        let values: Vec<_> = y
            .par_iter()
            .flat_map_iter(|&y| {
                let places: Vec<_> = x.iter().map(|&x| window.place(x, y)).collect();
                search.lowest(&places)
            })
            .collect();
        let lowest = Grid { x, y, values };
        let room = room_beside_border(&search, window, &lowest);
        Self {
            window: *window,
            lowest,
            room,
        }
    }
}

/// `count` numbers from `low` to `high`, both included.
pub(super) fn evenly(low: f64, high: f64, count: usize) -> Vec<f64> {
    let last = (count - 1) as f64;
    (0..count)
        .map(|i| low + (high - low) * i as f64 / last)
        .collect()
}

/// Halvings of the step between orientations in search of the lowest energy.
const REFINEMENTS: i32 = 6;
/// Halvings of the step between a free and a blocked orientation in search of contact.
const BISECTIONS: usize = 7;

/// The search for the lowest energy over theta.
struct Search<'a> {
    pair: &'a Pair<'a>,
    /// Orientations repeat after this angle (rad).
    period: f64,
    /// Ascending, in [0, period).
    thetas: Vec<f64>,
    /// Largest step between two orientations (rad).
    step: f64,
    /// Free in any orientation where the reference points are at least this far apart (m).
    outer: f64,
    /// Blocked in every orientation where they are closer than this (m).
    inner: f64,
}

impl<'a> Search<'a> {
    fn new(pair: &'a Pair<'a>, orientations: usize) -> Self {
        let period = TAU / rotations(pair.moving).len() as f64;
        let count = (orientations as f64 * period / TAU).ceil() as usize;
        let (fixed, moving) = (&pair.fixed.outline, &pair.moving.outline);
        let origin = Vector2::zeros();
        let (a, b) = (
            fixed.signed_distance(origin),
            moving.signed_distance(origin),
        );
        Self {
            pair,
            period,
            thetas: orientations_within(period, count, pair.fixed, pair.moving),
            step: period / count as f64,
            outer: fixed.circumradius() + moving.circumradius(),
            // Discs inside the tiles, about their reference points, overlap. With a reference
            // point outside its tile nothing is known.
            inner: if a < 0.0 && b < 0.0 {
                -a - b - 2.0 * TOUCH
            } else {
                0.0
            },
        }
    }

    fn is_free(&self, q: &Configuration) -> bool {
        let distance = q.x.hypot(q.y);
        distance >= self.outer || (distance >= self.inner && self.pair.contact.is_free(q))
    }

    /// The lowest sample at each place.
    fn lowest(&self, places: &[Vector2<f64>]) -> Vec<Option<Sample>> {
        let candidates: Vec<_> = places.iter().map(|p| self.free_orientations(*p)).collect();
        let mut best = vec![None; places.len()];
        self.take_lower(&mut best, &candidates);
        for k in 1..=REFINEMENTS {
            let turn = self.step / f64::from(1 << k);
            let turned: Vec<_> = best.iter().map(|q| self.turned(q.as_ref(), turn)).collect();
            self.take_lower(&mut best, &turned);
        }
        best
    }

    /// Replaces each sample by the lowest of its candidates where that is lower.
    fn take_lower(&self, best: &mut [Option<Sample>], candidates: &[Vec<Configuration>]) {
        let all = with_energies(self.pair.potential, &candidates.concat());
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

    /// The free orientations at a place, those in contact between them and blocked ones, and those
    /// in gaps narrower than a step.
    fn free_orientations(&self, place: Vector2<f64>) -> Vec<Configuration> {
        let distance = place.norm();
        if distance < self.inner {
            return Vec::new();
        }
        let at = |theta: f64| Configuration::new(place.x, place.y, wrap_angle(theta));
        if distance >= self.outer {
            return self.thetas.iter().map(|&theta| at(theta)).collect();
        }
        let count = self.thetas.len();
        let rooms: Vec<_> = self
            .thetas
            .iter()
            .map(|&t| self.room_or_free(&at(t)))
            .collect();
        let mut found = Vec::new();
        for i in 0..count {
            let (theta, room) = (self.thetas[i], rooms[i]);
            let next = (i + 1) % count;
            let theta_next = self.thetas[next] + if next == 0 { self.period } else { 0.0 };
            match (room >= 0.0, rooms[next] >= 0.0) {
                (true, false) => found.push(at(self.contact_between(place, theta, theta_next))),
                (false, true) => found.push(at(self.contact_between(place, theta_next, theta))),
                _ => {}
            }
            if room >= 0.0 {
                found.push(at(theta));
            } else if room >= rooms[next].max(rooms[(i + count - 1) % count])
                && -room < self.pair.moving.outline.circumradius() * self.step
            {
                let (room, theta) = self.widest(place, room, theta);
                if room >= -TOUCH {
                    found.push(at(theta));
                }
            }
        }
        found
    }

    /// Plus infinity for a free configuration, minus the depth of the overlap (m) for a blocked
    /// one.
    fn room_or_free(&self, q: &Configuration) -> f64 {
        if self.is_free(q) {
            f64::INFINITY
        } else {
            self.pair.contact.clearance(q)
        }
    }

    /// The free orientation (rad) in contact between a free and a blocked one.
    fn contact_between(&self, place: Vector2<f64>, mut free: f64, mut blocked: f64) -> f64 {
        for _ in 0..BISECTIONS {
            let middle = (free + blocked) / 2.0;
            if self.is_free(&Configuration::new(place.x, place.y, wrap_angle(middle))) {
                free = middle;
            } else {
                blocked = middle;
            }
        }
        free
    }

    /// The largest clearance (m) over theta at a place.
    fn room(&self, place: Vector2<f64>) -> f64 {
        let sampled = self.thetas.iter().map(|&theta| {
            let q = Configuration::new(place.x, place.y, wrap_angle(theta));
            (self.pair.contact.clearance(&q), theta)
        });
        let most = sampled.max_by(|a, b| a.0.total_cmp(&b.0));
        most.map_or(f64::NEG_INFINITY, |(room, theta)| {
            self.widest(place, room, theta).0
        })
    }

    /// The largest clearance (m) near an orientation and the orientation (rad) that has it, by
    /// steps that halve.
    fn widest(&self, place: Vector2<f64>, mut room: f64, mut theta: f64) -> (f64, f64) {
        for k in 1..=REFINEMENTS {
            let turn = self.step / f64::from(1 << k);
            for turned in [theta - turn, theta + turn] {
                let q = Configuration::new(place.x, place.y, wrap_angle(turned));
                let found = self.pair.contact.clearance(&q);
                if found > room {
                    (room, theta) = (found, turned);
                }
            }
        }
        (room, theta)
    }

    /// A sample's configuration turned to either side, where that is free.
    fn turned(&self, sample: Option<&Sample>, turn: f64) -> Vec<Configuration> {
        let Some(sample) = sample else {
            return Vec::new();
        };
        let q = sample.configuration;
        [-turn, turn]
            .map(|turn| Configuration::new(q.x, q.y, wrap_angle(q.theta + turn)))
            .into_iter()
            .filter(|q| self.is_free(q))
            .collect()
    }
}

/// Evenly spread orientations together with those that lay two faces flush, in [0, period).
fn orientations_within(period: f64, count: usize, fixed: &Tile, moving: &Tile) -> Vec<f64> {
    let spread = (0..count).map(|k| k as f64 * period / count as f64);
    let direction = |face: &Face| face.normal().y.atan2(face.normal().x);
    let flush = fixed.faces.iter().flat_map(|to| {
        moving
            .faces
            .iter()
            .map(move |from| (direction(to) - direction(from) + TAU / 2.0).rem_euclid(period))
    });
    let mut thetas: Vec<f64> = spread.chain(flush).collect();
    thetas.sort_by(f64::total_cmp);
    thetas.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    thetas
}

pub(super) fn with_energies(potential: &dyn Potential, free: &[Configuration]) -> Vec<Sample> {
    let mut energies = vec![0.0; free.len()];
    potential.energies(free, &mut energies);
    free.iter()
        .zip(energies)
        .map(|(&configuration, energy)| Sample {
            configuration,
            energy,
        })
        .collect()
}

/// The largest clearance over theta at each grid point that has a neighbour on the other side of
/// the blocked region's border; elsewhere plus or minus the grid's spacing.
fn room_beside_border(search: &Search, window: &Window, grid: &Grid<Sample>) -> Vec<f64> {
    let (columns, rows) = (grid.x.len(), grid.y.len());
    let spacing = grid.x[1] - grid.x[0];
    (0..columns * rows)
        .into_par_iter()
        .map(|index| {
            let (column, row) = (index % columns, index / columns);
            let free = grid.values[index].is_some();
            let near = |i: usize, count: usize| i.saturating_sub(1)..(i + 2).min(count);
            let at_border = near(row, rows)
                .any(|r| near(column, columns).any(|c| grid.value(c, r).is_some() != free));
            if !at_border {
                return if free { spacing } else { -spacing };
            }
            let room = search.room(window.place(grid.x[column], grid.y[row]));
            // Where only an orientation between the sampled ones is free, that one touches.
            let room = if free { room.max(0.0) } else { room };
            room.clamp(-2.0 * spacing, 2.0 * spacing)
        })
        .collect()
}
