//! Motion along contact: steps that never push the tiles into each other.

use nalgebra::{Matrix3, Vector3};

use crate::configuration::Configuration;
use crate::contact::{Constraint, closest_admissible};
use crate::problem::Problem;

/// Overlap (m) that is left in place when a configuration is pushed out of contact.
const RESIDUAL: f64 = 1e-12;

/// Contacts are looked for this far (m) beyond what a step needs.
const MARGIN: f64 = 1e-6;

/// A configuration with its energy (J) and the energy's gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub q: Configuration,
    pub energy: f64,
    pub gradient: Vector3<f64>,
}

impl Point {
    pub fn new(problem: &Problem, q: Configuration) -> Self {
        let (energy, gradient) = problem.energy_and_gradient(&q);
        Self {
            q,
            energy,
            gradient,
        }
    }
}

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

/// The overdamped motion's direction at a point, of length 1 in the mass metric:
/// `-M^-1 grad U`, brought as close as contact allows (Gauss' principle of least constraint).
/// Zero where the point is in equilibrium.
pub fn downhill(problem: &Problem, point: &Point) -> Vector3<f64> {
    let metric = problem.mass_metric(point.q.theta);
    let Some(free) = steepest(&metric, &point.gradient) else {
        return Vector3::zeros();
    };
    let mut touching = constraints(problem, &point.q, MARGIN);
    for constraint in &mut touching {
        constraint.gap = 0.0;
    }
    closest_admissible(free, &metric, &touching).map_or_else(Vector3::zeros, |(v, _)| v)
}

fn steepest(metric: &Matrix3<f64>, gradient: &Vector3<f64>) -> Option<Vector3<f64>> {
    let v = -(metric.try_inverse()? * gradient);
    let size = length(&v, metric);
    (size > 0.0 && size.is_finite()).then(|| v / size)
}

/// One step downhill of at most `size` (m, mass metric), sliding along contact. `None` where no
/// such step leads to a free configuration of lower energy.
pub fn step_downhill(problem: &Problem, point: &Point, size: f64) -> Option<Point> {
    let metric = problem.mass_metric(point.q.theta);
    let wanted = steepest(&metric, &point.gradient)? * size;
    let q = step(problem, &point.q, wanted, &metric)?;
    let next = Point::new(problem, q);
    (next.energy < point.energy).then_some(next)
}

/// The free configuration closest to `q` + `wanted` that a slide along contact reaches.
fn step(
    problem: &Problem,
    q: &Configuration,
    wanted: Vector3<f64>,
    metric: &Matrix3<f64>,
) -> Option<Configuration> {
    let near = constraints(problem, q, reach(problem, &wanted) + MARGIN);
    let (admissible, _) = closest_admissible(wanted, metric, &near)?;
    settle(problem, &q.moved(admissible), length(&wanted, metric))
}

/// How far (m) a step moves any point of the moving tile at most.
pub fn reach(problem: &Problem, step: &Vector3<f64>) -> f64 {
    let radius = problem
        .contact
        .as_ref()
        .map_or(0.0, |contact| contact.moving().circumradius());
    step.xy().norm() + radius * step.z.abs()
}

/// The nearest free configuration, where the tiles overlap by less than `size` (m); `None` where
/// none is found or the table ends.
pub fn settle(problem: &Problem, q: &Configuration, size: f64) -> Option<Configuration> {
    let mut q = *q;
    for _ in 0..12 {
        let near = constraints(problem, &q, size + MARGIN);
        let deepest = near.iter().map(|c| c.gap).fold(0.0, f64::min);
        if deepest >= -RESIDUAL {
            break;
        }
        let metric = problem.mass_metric(q.theta);
        let (push, _) = closest_admissible(Vector3::zeros(), &metric, &near)?;
        if length(&push, &metric) > 2.0 * size {
            return None;
        }
        q = q.moved(push);
    }
    problem.is_free(&q).then_some(q)
}
