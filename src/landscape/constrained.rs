//! Motion along contact: steps that never push the tiles into each other.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::roadmap::Point;
use crate::roadmap::knot::{Knot, inner_extremes};
use tiles::configuration::Configuration;
use tiles::contact::{Constraint, Touch, closest_admissible};
use tiles::problem::Problem;

/// Additional search distance (m) for contacts beyond what a step needs.
const MARGIN: f64 = 1e-6;

/// Target gap (m) of closed contacts if rounding permits, and largest gap in any case.
const CLOSED: [f64; 2] = [1e-13, 1e-10];

/// At rest where contact leaves less than this fraction of the force.
const EQUILIBRIUM: f64 = 1e-9;

/// A step must lower the energy by this fraction of the prediction from the slope at its start. A
/// step to the lowest point of a parabola achieves one half; longer steps, which would oscillate
/// across a valley, are rejected.
const FULFILLED: f64 = 0.5;

/// Tolerated rise of a step on its way down, as a fraction of its descent, attributed to the cubic
/// approximation.
const RISE: f64 = 0.01;

/// Tolerated overlap (m) along a step between two free configurations. A straight step along a
/// curved contact surface cuts about 0.03 mm into it; tiles have no walls thinner than this.
const GRAZE: f64 = 1e-4;

/// Length of a step in the mass metric (m).
pub fn length(step: &Vector3<f64>, metric: &Matrix3<f64>) -> f64 {
    step.dot(&(metric * step)).max(0.0).sqrt()
}

/// The constraints of contact within `margin` (m) of `q`.
pub fn constraints(problem: &Problem, q: &Configuration, margin: f64) -> Vec<Constraint> {
    problem
        .contact
        .as_ref()
        .map_or_else(Vec::new, |contact| contact.constraints(q, margin))
}

/// The force at a point, `-M^-1 grad U`, brought as close as contact allows (Gauss' principle of
/// least constraint), with the contacts and their multipliers. In units of the free force's length,
/// so that it is independent of its size.
pub(super) struct Projected {
    free: Vector3<f64>,
    held: Vector3<f64>,
    touching: Vec<Constraint>,
    multipliers: Vec<f64>,
    metric: Matrix3<f64>,
}

impl Projected {
    /// With the contacts `touching`, which are closed or nearly closed. `None` if there is no
    /// force.
    pub fn new(point: &Point, metric: Matrix3<f64>, mut touching: Vec<Constraint>) -> Option<Self> {
        let free = -(metric.try_inverse()? * point.gradient);
        let size = length(&free, &metric);
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        for constraint in &mut touching {
            constraint.gap = 0.0;
        }
        let free = free / size;
        let (held, multipliers) = closest_admissible((free, 1.0), &metric, &touching)?;
        Some(Self {
            free,
            held,
            touching,
            multipliers,
            metric,
        })
    }

    fn at(problem: &Problem, point: &Point) -> Option<Self> {
        let metric = problem.mass_metric(point.q.theta);
        Self::new(
            point,
            metric,
            constraints(problem, &point.q, problem.scaled(MARGIN)),
        )
    }

    /// The contacts pressed on.
    pub fn pressed(&self) -> impl Iterator<Item = Touch> + '_ {
        let all = self.touching.iter().zip(&self.multipliers);
        let pressed = all.filter(|(_, multiplier)| **multiplier > 0.0);
        pressed.map(|(constraint, _)| constraint.touch)
    }

    fn heading(&self, share: f64) -> Heading {
        let direction = self.held / share;
        let held = (self.free - self.held) / share;
        let size = length(&held, &self.metric);
        Heading {
            direction,
            held: held * (MOST_BALANCED / size).min(1.0),
            pressed: self.pressed().collect(),
        }
    }

    /// The part of the force that contact does not balance.
    fn share(&self) -> f64 {
        length(&self.held, &self.metric)
    }
}

/// The fraction of the force at a point that contact does not balance: 0 in equilibrium at contact,
/// 1 without contact.
pub fn unbalanced(problem: &Problem, point: &Point) -> f64 {
    // Without contact a vanishing force is an equilibrium, however small its scale.
    Projected::at(problem, point)
        .filter(|projected| projected.pressed().next().is_some())
        .map_or(0.0, |projected| projected.share())
}

/// Limit of the balanced force, in units of the remaining one: more would not change which contacts
/// a step presses on.
const MOST_BALANCED: f64 = 10.0;

/// The direction of motion at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Heading {
    /// The motion's direction, of length 1 in the mass metric.
    pub direction: Vector3<f64>,
    /// The part of the force balanced by contact, in units of the remaining one, at most ten times
    /// that.
    pub held: Vector3<f64>,
    /// The contacts pressed on.
    pub pressed: Vec<Touch>,
}

/// The direction of the overdamped motion at a point. `None` in equilibrium.
pub fn downhill(problem: &Problem, point: &Point) -> Option<Heading> {
    let projected = Projected::at(problem, point)?;
    let share = projected.share();
    (share > EQUILIBRIUM).then(|| projected.heading(share))
}

/// One step of `size` (m, mass metric) from a point in this direction, sliding along contact.
/// `None` if no such step leads to a free configuration of lower energy.
///
/// Pressed contacts stay closed, although the surface may curve away from the straight step;
/// contacts in the way shorten or deflect the step.
pub fn step_along(problem: &Problem, point: &Point, heading: &Heading, size: f64) -> Option<Point> {
    let wanted = heading.direction * size;
    let margin = reach(problem, &wanted) + problem.scaled(MARGIN);
    let (straight, settled) = if problem.has_room(&point.q, margin) {
        (wanted, point.q.moved(wanted))
    } else {
        slid(problem, point, heading, (size, margin))?
    };
    let promised = point.gradient.dot(&straight);
    let next = Point::new(problem, settled);
    let is_lower = promised < 0.0 && next.energy <= point.energy + FULFILLED * promised;
    (is_lower && !leads_over_a_ridge(point, &next)).then_some(next)
}

/// A straight step of `size` (m, mass metric) among contacts within a margin (m), and its end with
/// pressed contacts kept closed; `None` if it does not lead to a free configuration by a free
/// motion.
fn slid(
    problem: &Problem,
    point: &Point,
    heading: &Heading,
    (size, margin): (f64, f64),
) -> Option<(Vector3<f64>, Configuration)> {
    let metric = problem.mass_metric(point.q.theta);
    let near = constraints(problem, &point.q, margin);
    // All of the force: contacts that the step meets may take from those it starts with.
    let force = heading.direction + heading.held;
    let pushed = |by: f64| closest_admissible((force * by, problem.scaled(1.0)), &metric, &near);
    let (mut straight, mut multipliers) = pushed(size)?;
    let longer = length(&straight, &metric) / size;
    if longer > 1.0 {
        (straight, multipliers) = pushed(size / longer)?;
    }
    let moved = point.q.moved(straight);
    // A vertex that has slid past the end of its edge no longer presses.
    let contact = problem.contact.as_ref()?;
    let pressed = near.iter().zip(&multipliers).filter(|(_, m)| **m > 0.0);
    let mut still: Vec<Touch> = pressed.map(|(constraint, _)| constraint.touch).collect();
    if !still.is_empty() {
        contact.keep_faced(&mut still, &moved, margin);
    }
    let closed = close(problem, &still, &moved).unwrap_or(moved);
    let settled = settle(problem, &closed, size)?;
    let is_free = problem.motion_overlaps_at_most(&point.q, &settled, problem.scaled(GRAZE));
    is_free.then_some((straight, settled))
}

/// Whether the energy along a step, by the cubic through energies and slopes at its ends, rises on
/// the way to a lower end: motion that never climbs does not get there.
fn leads_over_a_ridge(from: &Point, to: &Point) -> bool {
    let step = from.q.step_to(&to.q);
    let fall = from.energy - to.energy;
    // Energies from the start on, which differ by less than they amount to.
    let ends = [(0.0, from, 0.0), (1.0, to, -fall)];
    let [start, end] = ends.map(|(t, point, energy)| Knot {
        t,
        energy,
        slope: point.gradient.dot(&step),
    });
    if end.slope >= 0.0 {
        return false;
    }
    let mut lowest = start.energy;
    inner_extremes(&start, &end).any(|extreme| {
        let rise = extreme.energy - lowest;
        lowest = lowest.min(extreme.energy);
        rise > RISE * fall
    })
}

/// The configuration near `q` at which the given contacts are closed; `None` if there is none or
/// the contacts depend on each other.
pub fn close(problem: &Problem, touches: &[Touch], q: &Configuration) -> Option<Configuration> {
    let Some(contact) = &problem.contact else {
        return Some(*q);
    };
    let mut q = *q;
    for _ in 0..12 {
        let rows = contact.constraints_of(touches, &q);
        let widest = rows.iter().map(|c| c.gap.abs()).fold(0.0, f64::max);
        if widest <= problem.scaled(CLOSED[0]) {
            return Some(q);
        }
        let inverse = problem.mass_metric(q.theta).try_inverse()?;
        let push = match rows[..] {
            [a] => push_that_closes(&[a], &inverse)?,
            [a, b] => push_that_closes(&[a, b], &inverse)?,
            [a, b, c] => push_that_closes(&[a, b, c], &inverse)?,
            // With three coordinates, at most three contacts are independent.
            _ => return None,
        };
        q = q.moved(inverse * push);
    }
    let rows = contact.constraints_of(touches, &q);
    rows.iter()
        .all(|row| row.gap.abs() <= problem.scaled(CLOSED[1]))
        .then_some(q)
}

/// The sum of multiples of the gradients that closes these gaps, to first order.
fn push_that_closes<const M: usize>(
    rows: &[Constraint; M],
    inverse: &Matrix3<f64>,
) -> Option<Vector3<f64>> {
    let gram =
        SMatrix::<f64, M, M>::from_fn(|a, b| rows[a].gradient.dot(&(inverse * rows[b].gradient)));
    let missing = SVector::<f64, M>::from_fn(|a, _| -rows[a].gap);
    let amounts = gram.cholesky()?.solve(&missing);
    Some((0..M).map(|a| rows[a].gradient * amounts[a]).sum())
}

/// Largest path (m) of any point of the moving tile in a step.
pub fn reach(problem: &Problem, step: &Vector3<f64>) -> f64 {
    let radius = problem
        .contact
        .as_ref()
        .map_or(0.0, |contact| contact.moving().circumradius());
    step.xy().norm() + radius * step.z.abs()
}

/// The nearest free configuration, where the tiles overlap by less than `size` (m); `None` if none
/// is found or the table ends.
pub fn settle(problem: &Problem, q: &Configuration, size: f64) -> Option<Configuration> {
    match &problem.contact {
        Some(contact) => contact.nearest_free(q, size, |theta| problem.mass_metric(theta)),
        None => Some(*q),
    }
}
