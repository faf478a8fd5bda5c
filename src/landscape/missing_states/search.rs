//! The search over cells.

use std::sync::Arc;

use ordered_float::OrderedFloat;

use super::CompletenessSettings;
use super::cell::{CellProof, CellVerdict};
use super::domain::Domain;
use super::exits::{Exits, Opened};
use crate::bounded::Bounded;
use crate::exploration::Exploration;
use crate::results::Uncertified;
use crate::stationary::Stationary;
use tiles::budget::{Budget, Ended};
use tiles::cell::Cell;
use tiles::observer::Observer;
use tiles::problem::Problem;
use tiles::scale::Scale;
use tiles::subdivision::Waiting;

/// Sides smaller than this (half a side in rad, or in m for the paper's tile) are not halved,
/// because rounding dominates below it.
const SMALLEST: f64 = 1e-9;
/// Number of cells assessed between two checks of the remaining effort: at most the first, and
/// fewer, but not below the second, towards its end, when they may cost at most this fraction of it.
const BATCH: [u64; 2] = [4096, 64];
const LAST: u64 = 8;
/// The part of the effort kept for the conclusion.
const RESERVE: f64 = 0.1;

/// A search for states that may be missing.
pub struct StateSearch<'a> {
    pub(super) problem: &'a Problem,
    pub(super) settings: CompletenessSettings,
    pub(super) budget: Budget,
    pub(super) reserve: Budget,
    pub(super) exits: Exits<'a>,
    pub(super) below: f64,
    /// Cells about which nothing is proved, with the lowest energy (J) that each may hold.
    pub open: Vec<(Cell, f64)>,
    /// Cells explained by a path to a minimum, with the index of that ending.
    pub(super) explained: Vec<(Cell, f64, usize)>,
    /// Volume of the searched part of the space (m^2 rad).
    pub(super) volume: f64,
    pub(super) cells: usize,
    /// The reason for ending the search.
    pub(super) ended: Option<Ended>,
}

/// Cells to examine, each with the lowest energy (J) that it may hold: larger ones first, because
/// the number of small ones is unlimited where a tile has no play; for each size the lowest first.
pub(super) type Queue = Waiting<(i32, OrderedFloat<f64>), (Cell, f64)>;

pub(super) fn push(queue: &mut Queue, cell: Cell, lowest: f64) {
    let halvings = -libm::log2(cell.half[0].max(cell.half[1])).floor() as i32;
    queue.push((halvings, OrderedFloat(lowest)), (cell, lowest));
}

impl<'a> StateSearch<'a> {
    /// Searches the whole space for traps besides the minima of a survey.
    ///
    /// The result is the same on every machine, unless a time limit ends it.
    ///
    /// # Errors
    /// If the energy has no bounds over cells, or no effort is allowed.
    pub fn run(
        problem: &'a Problem,
        survey: &Exploration,
        settings: &CompletenessSettings,
        observer: &dyn Observer,
    ) -> Result<Self, Uncertified> {
        let contact = problem.contact.as_ref();
        let bounded = Arc::new(Bounded::new(problem.bounds()?, contact, &problem.space));
        if settings.allowed.is_none() || settings.cells == 0 {
            return Err(Uncertified::Unasked);
        }
        let depth = problem.depth();
        let mut budget = Budget::new(settings.allowed);
        let known = survey.states.iter().map(|state| state.minimum.clone());
        let mut search = Self {
            problem,
            settings: *settings,
            reserve: budget.share(RESERVE),
            budget,
            exits: Exits::new(problem, bounded, settings.escape * depth, known),
            below: -settings.below * depth,
            open: Vec::new(),
            explained: Vec::new(),
            volume: 0.0,
            cells: 0,
            ended: None,
        };
        let mut queue = Queue::none();
        for cell in Domain::new(problem).first_cells() {
            search.volume += cell.volume();
            push(&mut queue, cell, f64::NEG_INFINITY);
        }
        search.look_through(queue, observer);
        Ok(search)
    }

    /// Proves cells and their parts until none are left or the allowed effort is spent.
    pub(super) fn look_through(&mut self, mut queue: Queue, observer: &dyn Observer) {
        let bounded = self.exits.bounded.clone();
        let proof = CellProof {
            bounded: &bounded,
            level: self.below,
            rise: self.exits.rise,
        };
        let domain = Domain::new(self.problem);
        while !queue.is_empty() {
            let is_over = self.exits.is_over(&mut self.budget);
            if is_over || self.cells >= self.settings.cells {
                self.ended = self.ended.or(self.budget.ended());
                break;
            }
            let [most, least] = BATCH;
            let last = self.budget.part_of(1) / (LAST * bounded.work()).max(1);
            let batch = last.clamp(least, most) as usize;
            let looked_at = queue.look(batch, |(cell, _)| proof.verdict(cell));
            self.cells += looked_at.len();
            for (cell, lowest, losses) in self.unproved(&proof, looked_at) {
                match halves(&cell, &losses, self.problem.scale()) {
                    Some(halves) => halves
                        .into_iter()
                        .filter(|half| domain.meets(half))
                        .for_each(|half| push(&mut queue, half, lowest)),
                    None => self.open.push((cell, lowest)),
                }
            }
            observer.part("completeness", self.cells, self.cells + queue.len());
        }
        self.open.extend(queue.into_cells());
    }

    /// Cells about which nothing is proved, with the lowest energy (J) that each may hold and the
    /// loss due to each coordinate's size.
    fn unproved(
        &mut self,
        proof: &CellProof,
        looked_at: Vec<((Cell, f64), CellVerdict)>,
    ) -> Vec<(Cell, f64, [f64; 3])> {
        let (mut opened, mut left) = (Vec::new(), Vec::new());
        for ((cell, before), verdict) in looked_at {
            match verdict {
                CellVerdict::Nothing | CellVerdict::Falls => {}
                CellVerdict::Opens(place) => opened.push((cell, place)),
                CellVerdict::Open { lowest, losses } => {
                    left.push((cell, lowest.max(before), losses))
                }
            }
        }
        let places: Vec<Opened> = opened.iter().map(|(_, place)| *place).collect();
        for ((cell, place), ending) in opened
            .into_iter()
            .zip(self.exits.find(&places, &mut self.budget))
        {
            match ending {
                Some(ending) => self.explained.push((cell, place.lowest, ending)),
                None => left.push((cell, place.lowest, proof.sizes(&cell))),
            }
        }
        left
    }

    /// Minima that the survey had missed.
    pub fn missed(&self) -> Vec<Stationary> {
        let endings = self.exits.endings.iter().filter(|ending| ending.is_new);
        endings.map(|ending| ending.minimum.clone()).collect()
    }
}

/// The halves of a cell along the coordinate with the largest loss; `None` if it is too small.
fn halves(cell: &Cell, losses: &[f64; 3], scale: Scale) -> Option<[Cell; 2]> {
    let axis = (0..3).max_by_key(|&i| OrderedFloat(losses[i]))?;
    let size = cell.half[axis];
    let at = cell.centre.to_array()[axis].abs();
    let half = size / 2.0 + 4.0 * f64::EPSILON * (at + size);
    (size > SMALLEST * if axis < 2 { scale.factor() } else { 1.0 }).then(|| cell.parts(axis, half))
}
