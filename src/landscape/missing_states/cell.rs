//! The proof for one cell: that it contains no trap.

use nalgebra::{Matrix3, Vector3};
use ordered_float::OrderedFloat;

use super::exits::Opened;
use crate::bounded::Bounded;
use tiles::assessment::Lagrangian;
use tiles::cell::{Cell, Quadratic};
use tiles::contact::cells::{Cuts, PossibleContact};
use tiles::contact::{Constraint, EdgeOf, Touch, closest_admissible};
use tiles::potential::bounds::Enclosure;

/// Cells with more possible contacts than this are subdivided first.
const MOST_CONTACTS: usize = 600;
/// Units of work of a possible contact.
const A_CONTACT: u64 = 400;
/// Longest component of a step downhill, in units of the cell's half size along it: for a step
/// judged by the energy's values, and for one judged by its slopes.
const FALL: f64 = 1.0;
const SHORT_FALL: f64 = 1.0 / 16.0;
/// The same for steps off contact, which have to clear the whole cell; a peg in a hole turns far.
const WAYS_OUT: [f64; 2] = [6.0, 60.0];
/// Sides this much shorter than the longest are not halved.
const NARROW: f64 = 8.0;
/// A projected force shorter than this fraction of the whole one counts as zero.
const ZERO_FORCE: f64 = 1e-6;
/// A step out of contact must clear everything by this distance (m).
const SPARE: f64 = 1e-9;
/// Number of attempts to make a step open all contacts throughout a cell.
const TRIES: usize = 4;

/// The proved property of a cell's free configurations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CellVerdict {
    /// There are no free configurations, or none below the level.
    Nothing,
    /// A step leads from each of them to a free one of lower energy.
    Falls,
    /// A step leads from each of them into a wholly free box, on which the energy exceeds the
    /// cell's lowest by at most the allowed rise.
    Opens(Opened),
    /// Nothing is proved. The loss due to each coordinate's size determines how to halve the cell.
    Open { lowest: f64, losses: [f64; 3] },
}

/// Proves cells.
pub(super) struct CellProof<'a> {
    pub bounded: &'a Bounded<'a>,
    /// Configurations above this energy (J) are ignored.
    pub level: f64,
    /// Highest rise (J) on the way out of a configuration that is not a trap.
    pub rise: f64,
}

impl CellProof<'_> {
    pub fn verdict(&self, cell: &Cell) -> CellVerdict {
        let Some(cuts) = self.bounded.classify(cell) else {
            return CellVerdict::Nothing;
        };
        let enclosure = self.bounded.enclose(&widened(cell, SHORT_FALL));
        let lowest = Lagrangian::tightest(&enclosure, &cell.half, &cuts).lower;
        if lowest > self.level {
            return CellVerdict::Nothing;
        }
        let unknown = enclosure.high - enclosure.low;
        let losses = match self.falls(cell, &enclosure, &cuts) {
            Some(Ok(())) => return CellVerdict::Falls,
            Some(Err(losses)) => losses,
            None => self.sizes(cell),
        };
        let open = CellVerdict::Open { lowest, losses };
        let is_narrow = unknown < self.rise;
        let ways_out = WAYS_OUT.into_iter().filter(|_| is_narrow);
        let mut opens = ways_out.filter_map(|longest| self.opens(cell, lowest, longest));
        opens.next().unwrap_or(open)
    }

    /// The possible contacts in a cell, if they are not too many.
    fn possible(&self, cell: &Cell) -> Option<Vec<PossibleContact>> {
        let Some(contact) = &self.bounded.cells else {
            return Some(Vec::new());
        };
        let found = contact.possible(cell, MOST_CONTACTS);
        let count = found.as_ref().map_or(MOST_CONTACTS, Vec::len);
        self.bounded.count(A_CONTACT * count as u64);
        found
    }

    /// Weights of a step's squared components.
    fn metric(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal(&Vector3::new(
            1.0,
            1.0,
            self.bounded.lever * self.bounded.lever,
        ))
    }

    /// The unit of steps' lengths (m).
    fn unit(&self) -> f64 {
        self.bounded.scale().length(1.0)
    }

    /// A cell's half sizes (m).
    pub fn sizes(&self, cell: &Cell) -> [f64; 3] {
        let [x, y, theta] = cell.half;
        [x, y, self.bounded.lever * theta]
    }

    /// The loss (J) of the fall along a step due to each coordinate's size: its change along the
    /// coordinate, and the part that `room` leaves open; zero if the cell is much longer in another
    /// coordinate.
    fn losses(&self, cell: &Cell, room: &Enclosure, step: &Vector3<f64>) -> [f64; 3] {
        let sizes = self.sizes(cell);
        let total: f64 = sizes.iter().sum();
        let longest = sizes.iter().copied().fold(0.0, f64::max);
        let bent = product(&room.form, step);
        let unknown = room.change(step, &cell.half);
        std::array::from_fn(|i| {
            let is_narrow = sizes[i] * NARROW < longest;
            let loss = bent[i].abs() * cell.half[i] + unknown * sizes[i] / total;
            if is_narrow { 0.0 } else { loss }
        })
    }

    /// Whether one step leads downhill from every free configuration of the cell; if the tried step
    /// does not, the loss due to each coordinate's size. Short steps are most conclusive if the
    /// energy's slope is bounded; `room` is the enclosure of all that they sweep.
    fn falls(&self, cell: &Cell, room: &Enclosure, cuts: &Cuts) -> Option<Result<(), [f64; 3]>> {
        let is_smooth = room.slope.is_finite();
        let longest = if is_smooth { SHORT_FALL } else { FALL };
        let out = self.pushed_out(cell, cuts);
        let gradient = slope(&room.form, &out);
        // The loss of a step is at least a third of the sum over its components.
        let gains = |i: usize| {
            let mut step = Vector3::zeros();
            step[i] = longest * cell.half[i];
            3.0 * (gradient[i] * step[i]).abs() > room.change(&step, &cell.half)
        };
        if !(0..3).any(gains) {
            return None;
        }
        let contacts = self.possible(&widened(cell, longest))?;
        let metric = self.metric();
        let force = -(metric.try_inverse()? * gradient);
        let held: Vec<Constraint> = contacts.iter().map(|c| row(c, 0.0)).collect();
        let (direction, _) = closest_admissible((force, force.norm()), &metric, &held)?;
        let length = |v: &Vector3<f64>| v.dot(&(metric * v)).sqrt();
        if length(&direction) <= ZERO_FORCE * length(&force) {
            return None;
        }
        let wanted = fitted(&direction, &cell.half, longest);
        let step = self.opening_step(cell, &contacts, (wanted, longest), |_| 0.0)?;
        let losses = Err(self.losses(cell, room, &step));
        if gradient.dot(&step) + room.change(&step, &cell.half) >= 0.0 {
            return Some(losses);
        }
        let lowers = |known: &Enclosure, from: &Vector3<f64>, swept: &Cell| {
            self.is_lowered(cell, &step, (known, from, swept), cuts)
        };
        // The surroundings within a short step are already known, and that the step closes nothing.
        let falls = if is_smooth {
            lowers(room, &Vector3::zeros(), &widened(cell, longest))
        } else {
            let swept = swept(cell, &step);
            self.closes_nothing(&swept, &step)
                && lowers(&self.bounded.enclose(&swept), &(-step / 2.0), &swept)
        };
        Some(if falls { Ok(()) } else { losses })
    }

    /// The offset from the centre, within the cell, of approximately the nearest free
    /// configuration.
    fn pushed_out(&self, cell: &Cell, cuts: &Cuts) -> Vector3<f64> {
        let rows: Vec<Constraint> = cuts
            .easiest()
            .map(|cut| Constraint {
                touch: NO_TOUCH,
                gap: cut.form.value,
                gradient: cut.form.gradient.into(),
            })
            .collect();
        let push = closest_admissible((Vector3::zeros(), self.unit()), &self.metric(), &rows);
        let push = push.map_or_else(Vector3::zeros, |(push, _)| push);
        Vector3::from_fn(|i, _| push[i].clamp(-cell.half[i], cell.half[i]))
    }

    /// A step near `wanted` that opens every possible contact by at least `least`, from everywhere
    /// in the cell.
    fn opening_step(
        &self,
        cell: &Cell,
        contacts: &[PossibleContact],
        (wanted, longest): (Vector3<f64>, f64),
        least: impl Fn(&PossibleContact) -> f64,
    ) -> Option<Vector3<f64>> {
        let mut step = wanted;
        for _ in 0..TRIES {
            let swept: [f64; 3] = std::array::from_fn(|i| cell.half[i] + step[i].abs());
            let lost = |c: &PossibleContact| c.gradient.dot(&step) - c.opening(&swept, &step);
            if contacts
                .iter()
                .all(|c| c.opening(&swept, &step) >= least(c).max(0.0))
            {
                return Some(step);
            }
            let rows: Vec<Constraint> = contacts
                .iter()
                .map(|c| row(c, -(least(c).max(0.0) + 1.1 * lost(c))))
                .collect();
            step = closest_admissible((wanted, self.unit()), &self.metric(), &rows)?.0;
            if (0..3).any(|i| step[i].abs() > longest * cell.half[i]) {
                step = fitted(&step, &cell.half, longest);
            }
        }
        None
    }

    /// Whether a step closes no possible contact in the box that it sweeps.
    fn closes_nothing(&self, swept: &Cell, step: &Vector3<f64>) -> bool {
        let contacts = self.possible(swept);
        contacts.is_some_and(|all| all.iter().all(|c| c.opening(&swept.half, step) >= 0.0))
    }

    /// Whether the step lowers the energy from everywhere in the cell, with no more than the
    /// allowed rise on the way; given the enclosure of a box that contains all that it sweeps, in
    /// which the cell's centre lies at `from`.
    fn is_lowered(
        &self,
        cell: &Cell,
        step: &Vector3<f64>,
        (known, from, swept): (&Enclosure, &Vector3<f64>, &Cell),
        cuts: &Cuts,
    ) -> bool {
        let change = change(&known.form, from, step);
        // The greatest change is minus the minimum of its negative.
        let negative = Enclosure {
            form: Quadratic::default().minus(1.0, &change),
            ..Enclosure::default()
        };
        let greatest = -Lagrangian::tightest(&negative, &cell.half, cuts).lower;
        let slack = known.change(step, &swept.half) + 2.0 * known.form.rounding(&swept.half);
        let bend = quadratic(&known.form, step);
        // A part t of the step changes the form by t times its change, minus t (1 - t) / 2 times
        // the bend.
        let risen = greatest.max(0.0) + (-bend).max(0.0) / 8.0 + slack;
        greatest + slack < 0.0 && risen <= self.rise
    }

    /// Whether a step leads from every free configuration of the cell into a wholly free box.
    fn opens(&self, cell: &Cell, lowest: f64, longest: f64) -> Option<CellVerdict> {
        let contacts = self.possible(&widened(cell, longest))?;
        let spare = self.bounded.scale().length(SPARE);
        let least = |c: &PossibleContact| spare - c.least(&cell.half);
        let step = self.opening_step(cell, &contacts, (Vector3::zeros(), longest), least)?;
        let swept = swept(cell, &step);
        if !self.closes_nothing(&swept, &step) {
            return None;
        }
        let freed = Cell {
            centre: cell.centre.moved(step),
            half: cell.half,
        };
        if !self.possible(&freed)?.is_empty() {
            return None;
        }
        let known = self.bounded.enclose(&swept);
        let highest = known.form.greatest(&swept.half) + known.high;
        (highest - lowest <= self.rise).then_some(CellVerdict::Opens(Opened {
            at: freed.centre,
            lowest,
        }))
    }
}

const NO_TOUCH: Touch = Touch {
    edge_of: EdgeOf::Fixed,
    edge: 0,
    vertex: 0,
};

fn row(contact: &PossibleContact, gap: f64) -> Constraint {
    Constraint {
        touch: NO_TOUCH,
        gap,
        gradient: contact.gradient,
    }
}

/// A direction scaled so that its longest component is `most` half sizes.
fn fitted(direction: &Vector3<f64>, half: &[f64; 3], most: f64) -> Vector3<f64> {
    let longest = (0..3).map(|i| direction[i].abs() / half[i]);
    let longest = longest.max_by_key(|&x| OrderedFloat(x)).unwrap_or(1.0);
    direction * (most / longest)
}

/// The box around a cell and where a step takes it.
fn swept(cell: &Cell, step: &Vector3<f64>) -> Cell {
    Cell {
        centre: cell.centre.moved(step / 2.0),
        half: std::array::from_fn(|i| cell.half[i] + step[i].abs() / 2.0),
    }
}

/// Gradient of a form at an offset.
fn slope(form: &Quadratic, at: &Vector3<f64>) -> Vector3<f64> {
    Vector3::from(form.gradient) + product(form, at)
}

/// H d.
fn product(form: &Quadratic, d: &Vector3<f64>) -> Vector3<f64> {
    let [xx, yy, tt, xy, xt, yt] = form.hessian;
    Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt) * d
}

/// d^T H d.
fn quadratic(form: &Quadratic, d: &Vector3<f64>) -> f64 {
    d.dot(&product(form, d))
}

/// By how much a form changes along a step that starts `from` its centre, as a form of the offset
/// from there.
fn change(form: &Quadratic, from: &Vector3<f64>, step: &Vector3<f64>) -> Quadratic {
    let bent = product(form, step);
    Quadratic {
        value: slope(form, &(from + step / 2.0)).dot(step),
        gradient: bent.into(),
        hessian: [0.0; 6],
    }
}

/// A cell with the fraction `more` of its half sizes added on all sides.
fn widened(cell: &Cell, more: f64) -> Cell {
    Cell {
        centre: cell.centre,
        half: cell.half.map(|half| (1.0 + more) * half),
    }
}
