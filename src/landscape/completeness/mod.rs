//! Proof that a list of states is complete: that besides them no configuration below an energy
//! `-E` is trapped by more than `e`.
//!
//! The space is covered by closed cells (boxes of x, y and theta), which are subdivided until each
//! of them is one of these:
//!
//! - **empty**: no configuration in it is free, or none lies below `-E` (bounds of the energy over
//!   the part of the cell that contact leaves, as for the barriers' certificates);
//! - **falling**: one step `w` leads from every free configuration of the cell to another free
//!   one that is lower by at least some `d > 0`. Free throughout: no gap that a vertex and an edge
//!   can close in the box that the step sweeps closes along it. Lower: the energy's second-order
//!   form changes along `w` by `g w + w H d + w H w / 2`, bounded over the cell, plus what the
//!   enclosure leaves open of the slope along a short step (of the values along a long one, where
//!   the slope has no bound), which is also about all that the energy may rise on the way;
//! - **explained**: one step leads from every free configuration of the cell into a box without
//!   contact, and from there a proved pathway to a known minimum, all of it no more than `e` above
//!   the cell's lowest energy;
//! - **open**: none of these was proved.
//!
//! From any free configuration below `-E` steps lead through falling cells. They come to an end,
//! as each lowers the energy by at least the least of finitely many `d`, and the energy is bounded
//! below. The end is not in an empty cell, so it is in an explained one, or in an open one. Where
//! no cell is open, every configuration below `-E` is therefore joined to a known minimum by a way
//! that rises by no more than `e`: no trap is missing. Each minimum found on the way that the
//! survey had missed is added to its states, and those that are left out of the list as too shallow
//! have a proved way to a listed one of their own.
//!
//! Stronger than a proof of basins by flows (outer approximations, Morse decompositions), no cell's
//! neighbours need be known, and cells of any size stand beside each other.
//!
//! What is proved holds for the model potential and the outlines as given, for configurations in
//! which the tiles' interiors are disjoint, with the reference point on the table; the pathways let
//! overlaps of [`TOUCH`](crate::contact::TOUCH) pass. Rounding is included as in the barriers'
//! certificates ([`super::certificate`]).

mod cell;
mod domain;
mod exits;
mod regions;

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};
use std::time::{Duration, Instant};

use nalgebra::{Matrix3, Vector3};
use ordered_float::OrderedFloat;
use rayon::prelude::*;

use self::cell::{CellProof, Verdict};
use self::domain::Domain;
use self::exits::{Ending, Exits, Opened};
use super::certificate::upper::PathProof;
use super::certification::Uncertified;
use super::inventory::Inventory;
use super::pathway;
use super::stationary::Stationary;
use super::survey::Survey;
use crate::cell::Cell;
use crate::contact::cells::ContactCells;
use crate::interruption;
use crate::observer::Observer;
use crate::problem::Problem;

pub use regions::OpenRegion;

/// Cells smaller than this (m, half a side) are not subdivided: below it rounding rules.
const SMALLEST: f64 = 1e-9;

/// What is to be proved, and how much time it is worth.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CompletenessSettings {
    /// Configurations deeper than this share of the depth are looked at.
    pub below: f64,
    /// Traps that need more than this share of the depth to leave must be listed.
    pub escape: f64,
    /// Cells assessed, about, after which those that are left stay open.
    pub cells: usize,
    /// Time (s) after which they do; 0 for no search.
    pub seconds: f64,
}

/// What is known of the states that a list may lack.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Completeness {
    /// Below this energy (J) ...
    pub below: f64,
    /// ... no configuration but those of the listed states' basins needs more than this (J) to
    /// leave, ...
    pub escape: f64,
    /// ... except in these regions, if anywhere: the one that can hide the lowest energy first.
    pub open: Vec<OpenRegion>,
    /// Their share of the space.
    pub share: f64,
    /// Cells assessed.
    pub cells: usize,
}

impl Completeness {
    /// Whether the list is proved to be complete.
    pub fn is_complete(&self) -> bool {
        self.open.is_empty()
    }

    /// What the list may lack lies above this (J), whether it is complete or not.
    pub fn lowest(&self) -> f64 {
        let open = self.open.iter().map(|region| region.lowest);
        open.fold(self.below, f64::min)
    }
}

/// Cells assessed between two looks at the clock.
const BATCH: usize = 4096;

/// A search for states that may be missing.
pub struct Search<'a> {
    exits: Exits<'a>,
    below: f64,
    open: Vec<(Cell, f64)>,
    /// Of the part of the space that is searched (m^2 rad).
    volume: f64,
    cells: usize,
}

/// Cells to be looked at: those halved least before the others, as there is no end of small ones
/// where a tile has no play; of each size the lowest first.
type Queue = BinaryHeap<Reverse<(i32, OrderedFloat<f64>, usize)>>;

/// The cells that wait, each with the least energy (J) that it may hold.
#[derive(Default)]
struct Waiting {
    queue: Queue,
    cells: Vec<(Cell, f64)>,
}

impl Waiting {
    fn push(&mut self, cell: Cell, lowest: f64) {
        let halvings = -cell.half[0].max(cell.half[1]).log2().floor() as i32;
        let number = self.cells.len();
        self.queue
            .push(Reverse((halvings, OrderedFloat(lowest), number)));
        self.cells.push((cell, lowest));
    }

    fn next(&mut self, most: usize) -> Vec<(Cell, f64)> {
        let next = std::iter::from_fn(|| self.queue.pop()).take(most);
        next.map(|Reverse((.., number))| self.cells[number])
            .collect()
    }
}

impl<'a> Search<'a> {
    /// Searches the whole space, besides the minima of a survey.
    ///
    /// Only a search within its time is the same on every machine.
    ///
    /// # Errors
    /// Where the energy has no bounds over cells, or no time is given.
    pub fn run(
        problem: &'a Problem,
        survey: &Survey,
        settings: &CompletenessSettings,
        observer: &dyn Observer,
    ) -> Result<Self, Uncertified> {
        let bounds = problem.bounds()?;
        let limit = Duration::from_secs_f64(settings.seconds.clamp(0.0, 1e9));
        if limit.is_zero() {
            return Err(Uncertified::NoTime);
        }
        let since = Instant::now();
        let depth = problem.depth();
        let (below, rise) = (-settings.below * depth, settings.escape * depth);
        let contact = problem.contact.as_ref().map(ContactCells::new);
        let rho = problem.space.rho;
        let proof = CellProof {
            bounds,
            contact: contact.as_ref(),
            metric: Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, rho * rho)),
            level: below,
            rise,
        };
        let paths = PathProof {
            bounds,
            contact: problem.contact.as_ref(),
            space: &problem.space,
        };
        let known = survey.states.iter().map(|state| state.minimum.clone());
        let mut search = Self {
            exits: Exits::new(problem, paths, rise, known),
            below,
            open: Vec::new(),
            volume: 0.0,
            cells: 0,
        };
        let domain = Domain::new(problem);
        let mut waiting = Waiting::default();
        for cell in domain.first_cells() {
            search.volume += cell.volume();
            waiting.push(cell, f64::NEG_INFINITY);
        }
        loop {
            let batch = waiting.next(BATCH);
            if batch.is_empty() {
                break;
            }
            if since.elapsed() >= limit || search.cells >= settings.cells {
                search.open.extend(batch);
                search.open.extend(waiting.next(usize::MAX));
                break;
            }
            search.look_at(&batch, &proof, rho, |cell, lowest| {
                if domain.meets(&cell) {
                    waiting.push(cell, lowest);
                }
            });
            let left = waiting.queue.len();
            observer.part("completeness", search.cells, search.cells + left);
        }
        Ok(search)
    }

    /// Proves cells, or hands on their halves.
    fn look_at(
        &mut self,
        batch: &[(Cell, f64)],
        proof: &CellProof,
        rho: f64,
        mut hand_on: impl FnMut(Cell, f64),
    ) {
        let verdicts: Vec<Verdict> = batch
            .par_iter()
            .map(|(cell, _)| {
                interruption::check();
                proof.verdict(cell)
            })
            .collect();
        self.cells += batch.len();
        let mut opened = Vec::new();
        let mut left = Vec::new();
        for ((cell, before), verdict) in batch.iter().zip(verdicts) {
            match verdict {
                Verdict::Nothing | Verdict::Falls => {}
                Verdict::Opens { into, lowest } => {
                    opened.push((*cell, Opened { at: into, lowest }))
                }
                Verdict::Open { lowest } => left.push((*cell, lowest.max(*before))),
            }
        }
        let places: Vec<Opened> = opened.iter().map(|(_, place)| *place).collect();
        let found = self.exits.find(&places);
        let stays = opened.iter().zip(found).filter(|(_, found)| !found);
        left.extend(stays.map(|((cell, place), _)| (*cell, place.lowest)));
        for (cell, lowest) in left {
            match halves(&cell, rho) {
                Some(halves) => halves.into_iter().for_each(|half| hand_on(half, lowest)),
                None => self.open.push((cell, lowest)),
            }
        }
    }

    /// Whether all that lies below the level is led to a minimum, listed or not.
    pub fn is_everything_explained(&self) -> bool {
        self.open.is_empty()
    }

    /// Minima that the survey had missed.
    pub fn missed(&self) -> Vec<Stationary> {
        let endings = self.exits.endings.iter().filter(|ending| ending.is_new);
        endings.map(|ending| ending.minimum.clone()).collect()
    }

    /// What is proved of the listed states: minima that are not listed must have a way to a listed
    /// one, or to `free`, that rises no more than is allowed.
    pub fn conclude(self, problem: &Problem, survey: &Survey, listed: &Inventory) -> Completeness {
        let mut open = regions::of_cells(&problem.space, &self.open);
        for ending in &self.exits.endings {
            let at = ending.minimum.point;
            let is_explained = ending.lowest == f64::INFINITY
                || listed.holds(problem, &at.q)
                || self.has_way_out(problem, survey, listed, ending);
            if !is_explained {
                open.push(OpenRegion {
                    pose: at.q,
                    volume: 0.0,
                    lowest: at.energy,
                });
            }
        }
        let volume: f64 = self.open.iter().map(|(cell, _)| cell.volume()).sum();
        Completeness {
            // A sum of nothing is minus zero.
            share: volume / self.volume + 0.0,
            below: self.below,
            escape: self.exits.rise,
            open,
            cells: self.cells,
        }
    }
}

impl Search<'_> {
    /// Whether a known way from a minimum that is not listed to a listed one, or to `free`, is
    /// proved to stay low enough for all that ends there.
    fn has_way_out(
        &self,
        problem: &Problem,
        survey: &Survey,
        listed: &Inventory,
        ending: &Ending,
    ) -> bool {
        let from = survey.state_at(problem, &ending.minimum.point.q, exits::SAME);
        let Some(from) = from.map(|state| survey.states[state].node) else {
            return false;
        };
        let is_listed = survey
            .states
            .iter()
            .filter(|state| listed.holds(problem, &state.minimum.point.q));
        let mut goals: HashSet<usize> = is_listed.map(|state| state.node).collect();
        goals.insert(survey.free);
        let depth = problem.depth();
        let scale = [depth, 2e-3 * depth];
        let way = pathway::lowest(problem, &survey.network, from, [&goals, &goals], scale);
        way.is_some_and(|way| {
            let points: Vec<_> = way
                .pathway
                .iter()
                .map(|point| point.configuration)
                .collect();
            let allowed = ending.lowest + self.exits.rise;
            self.exits.prove(&points, allowed).is_some()
        })
    }
}

/// The halves of a cell along its longest side (theta times `rho`, m); `None` where it is too small.
fn halves(cell: &Cell, rho: f64) -> Option<[Cell; 2]> {
    let sizes = [cell.half[0], cell.half[1], rho * cell.half[2]];
    let axis = (0..3).max_by_key(|&i| OrderedFloat(sizes[i]))?;
    (sizes[axis] > SMALLEST).then(|| {
        [-0.5, 0.5].map(|side| {
            let mut part = *cell;
            let mut step = Vector3::zeros();
            step[axis] = side * cell.half[axis];
            part.centre = cell.centre.moved(step);
            // Rounding of the centre must leave no gap between the halves.
            part.half[axis] = cell.half[axis] / 2.0 + 4.0 * f64::EPSILON * (1.0 + cell.half[axis]);
            part
        })
    })
}
