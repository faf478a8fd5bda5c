//! What is known of an energy in a cell.

use nalgebra::Vector3;

use crate::cell::{Cell, Quadratic};
use crate::configuration::Configuration;

/// Bounds of the energy over a cell: for every *free* configuration of the cell at the offset d
/// from its centre, `U(d) - form(d)` lies in [`low`, `high`] (J), rounding included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Enclosure {
    /// An approximation of U (J), of second order in the offset.
    pub form: Quadratic,
    /// Lower bound of U minus the form (J).
    pub low: f64,
    /// Upper bound of U minus the form (J).
    pub high: f64,
    /// How closely the form follows U along motions: on a straight motion within the cell on which
    /// the tiles' interiors are disjoint, with components of at most the fraction s of the cell's
    /// half sizes, `U - form` changes by at most `s slope + jump` (J).
    pub slope: f64,
    /// The additional change of tiles that touch (J).
    pub jump: f64,
    /// The smallest and the largest distance (m) of a magnet from the moving tile's reference
    /// point, if the same also holds for motions that move no magnet, and turn, by more than the
    /// fraction s of the cell's own extent.
    pub levers: Option<[f64; 2]>,
    /// Approximate units of work, as [budgets](crate::budget) count it, that this took; 0 if it is
    /// that of [any cell](CellBounds::work).
    pub work: u64,
}

impl Enclosure {
    /// The enclosure that states nothing.
    pub fn unknown() -> Self {
        Self {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            slope: f64::INFINITY,
            ..Self::default()
        }
    }

    /// A form with a remainder (J) on either side that is of the given order in the cell's size: a
    /// bound of a derivative of that order along any motion from the centre, made of products of
    /// speeds. The same product with one speed replaced by a motion's bounds the remainder's slope.
    pub fn of_order(order: f64, form: Quadratic, remainder: f64) -> Self {
        Self {
            form,
            low: -remainder,
            high: remainder,
            slope: order * remainder,
            ..Self::default()
        }
    }

    /// The enclosure of the sum of two energies, without levers: these are of a whole energy. The work of
    /// the other one is given.
    pub fn add(&mut self, other: &Self, work: u64) {
        self.form = self.form.minus(-1.0, &other.form);
        self.low += other.low;
        self.high += other.high;
        self.slope += other.slope;
        self.jump += other.jump;
        self.work += work;
    }

    /// Bound of the change of `U - form` (J) on the straight motion `step` within the cell, whose
    /// half sizes are `half`.
    pub fn change(&self, step: &Vector3<f64>, half: &[f64; 3]) -> f64 {
        let known = self.high - self.low;
        if self.slope.is_finite() {
            known.min(self.share(step, half) * self.slope + self.jump)
        } else {
            known
        }
    }

    /// The motion as a fraction of the cell's half sizes.
    fn share(&self, step: &Vector3<f64>, half: &[f64; 3]) -> f64 {
        let shares = (0..3).map(|i| step[i].abs() / half[i]);
        let largest = shares.fold(0.0, f64::max);
        let Some(levers) = self.levers else {
            return largest;
        };
        let (moved, turned) = (step.xy().norm(), step.z.abs());
        // Monotonic in the lever, so the extremes bound all others.
        let of = |lever: f64| {
            (moved + lever * turned) / (libm::hypot(half[0], half[1]) + lever * half[2])
        };
        let shares = levers.map(of).into_iter().chain([turned / half[2]]);
        largest.min(shares.fold(0.0, f64::max))
    }
}

/// The smallest and the largest of some levers, if there are any.
pub fn ends(levers: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let both = levers.map(|lever| [lever; 2]);
    both.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
}

/// Bounds over cells of any energy.
pub type BoxedBounds = Box<dyn CellBounds + Send>;

/// An energy that can be bounded over cells.
pub trait CellBounds: Sync {
    /// Encloses U over the free configurations of a cell. If nothing is known, `low` is minus
    /// infinity and `high` plus infinity; no entry is ever NaN.
    fn enclose(&self, cell: &Cell) -> Enclosure;

    /// U (J) of one configuration, to rounding.
    fn energy(&self, q: &Configuration) -> f64 {
        self.enclose(&Cell::at(q)).form.value
    }

    /// Approximate units of work, as [budgets](crate::budget) count it, to enclose a usual cell.
    fn work(&self) -> u64 {
        FEW_UNITS
    }

    /// Approximate units of work that an enclosure of this energy took.
    fn work_of(&self, known: &Enclosure) -> u64 {
        match known.work {
            0 => self.work(),
            work => work,
        }
    }
}

/// Units of work to enclose an energy without magnets.
const FEW_UNITS: u64 = 100;
