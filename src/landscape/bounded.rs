//! An energy over the free configurations of a space with its bounds over cells, and the work they
//! cost.

use std::sync::atomic::{AtomicU64, Ordering};

use tiles::assessment::{Assessment, assess};
use tiles::budget::Budget;
use tiles::cell::Cell;
use tiles::configuration::{Configuration, ConfigurationSpace};
use tiles::contact::Contact;
use tiles::contact::cells::{ContactCells, Cuts};
use tiles::potential::CellBounds;
use tiles::potential::bounds::Enclosure;
use tiles::scale::Scale;

/// Units of work per cell, per edge that it may touch, and per cut in a bound.
const A_CELL: u64 = 100;
const AN_EDGE: u64 = 15;
const A_CUT: u64 = 10;
/// Units of work to find the admissible step closest to a wanted one.
pub(super) const A_STEP: u64 = 1000;

pub(super) struct Bounded<'a> {
    bounds: &'a dyn CellBounds,
    pub contact: Option<&'a Contact>,
    /// The same over cells.
    pub cells: Option<ContactCells>,
    pub space: &'a ConfigurationSpace,
    /// Path (m) of the tile's farthest point per radian of rotation.
    pub lever: f64,
    /// Units of work not yet charged.
    unpaid: AtomicU64,
}

impl<'a> Bounded<'a> {
    pub fn new(
        bounds: &'a dyn CellBounds,
        contact: Option<&'a Contact>,
        space: &'a ConfigurationSpace,
    ) -> Self {
        Self {
            bounds,
            contact,
            cells: contact.map(ContactCells::new),
            space,
            lever: contact.map_or(space.rho, |contact| contact.moving().circumradius()),
            unpaid: AtomicU64::new(0),
        }
    }

    /// Assesses a cell; `None` if it is proved blocked.
    pub fn assess(&self, cell: &Cell) -> Option<Assessment> {
        let cuts = self.classify(cell)?;
        Some(assess(&self.enclose(cell), &cuts, self.lever, cell))
    }

    /// How large the tiles are.
    pub fn scale(&self) -> Scale {
        self.contact.map_or(Scale::NONE, Contact::scale)
    }

    /// Encloses the energy over the free configurations of a cell.
    pub fn enclose(&self, cell: &Cell) -> Enclosure {
        let known = self.bounds.enclose(cell);
        self.count(self.work_of(&known));
        known
    }

    /// The energy (J) of one configuration, to rounding.
    pub fn energy(&self, q: &Configuration) -> f64 {
        self.count(self.bounds.work());
        self.bounds.energy(q)
    }

    /// The contact conditions of a cell, `None` if it is blocked. Also counts the work for bounds
    /// over the rest.
    pub fn classify(&self, cell: &Cell) -> Option<Cuts> {
        let found = match &self.cells {
            Some(cells) => cells.classify(cell),
            None => Some(Cuts::default()),
        };
        let bounds = found.as_ref().map_or(0, |cuts| {
            let all = cuts.all.len() as u64;
            all + cuts.corners.len() as u64 * (2 * all + 2)
        });
        self.count(self.work_of_contact() + A_CUT * bounds);
        found
    }

    /// Approximate units of work to assess a usual cell.
    pub fn work(&self) -> u64 {
        self.work_of_bounds() + self.work_of_contact()
    }

    /// Approximate units of work to bound the energy over a usual cell, or to compute it.
    pub fn work_of_bounds(&self) -> u64 {
        self.bounds.work()
    }

    /// Approximate units of work that an enclosure took.
    pub fn work_of(&self, known: &Enclosure) -> u64 {
        self.bounds.work_of(known)
    }

    /// Approximate units of work to find the contacts of a configuration.
    pub fn work_of_contact(&self) -> u64 {
        let edges = self.cells.as_ref().map_or(0, ContactCells::edges) as u64;
        A_CELL + AN_EDGE * edges
    }

    /// Counts work.
    pub fn count(&self, units: u64) {
        self.unpaid.fetch_add(units, Ordering::Relaxed);
    }

    /// Charges the work since the last call to a budget. Called while no thread works on it, so
    /// that it is the same on any number of threads.
    pub fn pay(&self, budget: &mut Budget) {
        budget.spend(self.unpaid.swap(0, Ordering::Relaxed));
    }
}
