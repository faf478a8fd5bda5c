//! The search, cell by cell.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

use nalgebra::Vector3;
use ordered_float::OrderedFloat;

use super::CompletenessSettings;
use super::cell::{CellProof, Verdict};
use super::domain::Domain;
use super::exits::{Exits, Opened};
use crate::budget::{Budget, Ended};
use crate::cell::Cell;
use crate::contact::Contact;
use crate::contact::cells::ContactCells;
use crate::interruption;
use crate::landscape::barrier_bounds::Uncertified;
use crate::landscape::exploration::Exploration;
use crate::landscape::metered::Metered;
use crate::landscape::stationary::Stationary;
use crate::observer::Observer;
use crate::parallel;
use crate::problem::Problem;
use crate::tile::Outline;

/// Sides smaller than this (m or rad, half a side) are not halved: below it rounding rules.
const SMALLEST: f64 = 1e-9;
/// Cells assessed between two looks at what is left of the work.
const BATCH: usize = 4096;

/// A search for states that may be missing.
pub struct Search<'a> {
    pub(super) problem: &'a Problem,
    settings: CompletenessSettings,
    budget: Budget,
    pub(super) exits: Exits<'a>,
    pub(super) below: f64,
    /// Cells of which nothing is proved, with the least energy (J) that each may hold.
    pub(super) open: Vec<(Cell, f64)>,
    /// Cells explained by a way to a minimum: the number of that ending.
    pub(super) explained: Vec<(Cell, f64, usize)>,
    /// Of the part of the space that is searched (m^2 rad).
    pub(super) volume: f64,
    pub(super) cells: usize,
    /// What has ended the search.
    pub(super) ended: Option<Ended>,
}

/// Cells to be looked at: those halved least before the others, as there is no end of small ones
/// where a tile has no play; of each size the lowest first.
type Queue = BinaryHeap<Reverse<(i32, OrderedFloat<f64>, usize)>>;

/// The cells that wait, each with the least energy (J) that it may hold.
#[derive(Default)]
pub(super) struct Waiting {
    queue: Queue,
    cells: Vec<(Cell, f64)>,
}

impl Waiting {
    pub fn push(&mut self, cell: Cell, lowest: f64) {
        let halvings = -libm::log2(cell.half[0].max(cell.half[1])).floor() as i32;
        let number = self.cells.len();
        self.queue
            .push(Reverse((halvings, OrderedFloat(lowest), number)));
        self.cells.push((cell, lowest));
    }

    pub fn is_empty(&self) -> bool {
        self.queue.is_empty()
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
    /// It is the same on every machine, unless a clock ends it.
    ///
    /// # Errors
    /// Where the energy has no bounds over cells, or nothing may be spent.
    pub fn run(
        problem: &'a Problem,
        survey: &Exploration,
        settings: &CompletenessSettings,
        observer: &dyn Observer,
    ) -> Result<Self, Uncertified> {
        let bounds = Arc::new(Metered::new(problem.bounds()?));
        if settings.allowed.is_none() || settings.cells == 0 {
            return Err(Uncertified::Unasked);
        }
        let depth = problem.depth();
        let known = survey.states.iter().map(|state| state.minimum.clone());
        let mut search = Self {
            problem,
            settings: *settings,
            budget: Budget::new(settings.allowed),
            exits: Exits::new(problem, bounds, settings.escape * depth, known),
            below: -settings.below * depth,
            open: Vec::new(),
            explained: Vec::new(),
            volume: 0.0,
            cells: 0,
            ended: None,
        };
        let mut waiting = Waiting::default();
        for cell in Domain::new(problem).first_cells() {
            search.volume += cell.volume();
            waiting.push(cell, f64::NEG_INFINITY);
        }
        search.look_through(waiting, observer);
        Ok(search)
    }

    /// Proves cells and their parts, until there are none left or the work is done that was allowed.
    pub(super) fn look_through(&mut self, mut waiting: Waiting, observer: &dyn Observer) {
        let problem = self.problem;
        let bounds = self.exits.bounds.clone();
        let contact = problem.contact.as_ref().map(ContactCells::new);
        let moving = problem.contact.as_ref().map(Contact::moving);
        let lever = moving.map_or(problem.space.rho, Outline::circumradius);
        let proof = CellProof {
            bounds: &bounds,
            contact: contact.as_ref(),
            level: self.below,
            rise: self.exits.rise,
            lever,
        };
        let domain = Domain::new(problem);
        loop {
            let batch = waiting.next(BATCH);
            if batch.is_empty() {
                return;
            }
            bounds.pay(&mut self.budget);
            self.ended = self.budget.ended();
            if self.ended.is_some() || self.cells >= self.settings.cells {
                self.open.extend(batch);
                self.open.extend(waiting.next(usize::MAX));
                return;
            }
            self.look_at(&batch, &proof, |cell, lowest| {
                if domain.meets(&cell) {
                    waiting.push(cell, lowest);
                }
            });
            let left = waiting.queue.len();
            observer.part("completeness", self.cells, self.cells + left);
        }
    }

    /// Proves cells, or hands on their halves.
    fn look_at(
        &mut self,
        batch: &[(Cell, f64)],
        proof: &CellProof,
        mut hand_on: impl FnMut(Cell, f64),
    ) {
        let verdicts: Vec<Verdict> = parallel::map(batch, |(cell, _)| {
            interruption::check();
            proof.verdict(cell)
        });
        self.cells += batch.len();
        let mut opened = Vec::new();
        let mut left = Vec::new();
        for ((cell, before), verdict) in batch.iter().zip(verdicts) {
            match verdict {
                Verdict::Nothing | Verdict::Falls => {}
                Verdict::Opens { into, lowest } => {
                    opened.push((*cell, Opened { at: into, lowest }))
                }
                Verdict::Open { lowest, losses } => left.push((*cell, lowest.max(*before), losses)),
            }
        }
        let places: Vec<Opened> = opened.iter().map(|(_, place)| *place).collect();
        for ((cell, place), ending) in opened.into_iter().zip(self.exits.find(&places)) {
            match ending {
                Some(ending) => self.explained.push((cell, place.lowest, ending)),
                None => left.push((cell, place.lowest, proof.sizes(&cell))),
            }
        }
        for (cell, lowest, losses) in left {
            match halves(&cell, &losses) {
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
}

/// The halves of a cell along the coordinate whose size costs most; `None` where it is too small.
fn halves(cell: &Cell, losses: &[f64; 3]) -> Option<[Cell; 2]> {
    let axis = (0..3).max_by_key(|&i| OrderedFloat(losses[i]))?;
    (cell.half[axis] > SMALLEST).then(|| {
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
