//! Stationary points of the energy on the contact surface, to full accuracy: minima and transition
//! states, by Newton's method on the surface on which the pressing contacts stay closed.
//!
//! With contacts `g_k(q) = 0` held closed, U is stationary where `grad U = sum_k l_k grad g_k`. A
//! multiplier `l_k >= 0` presses the contact; a negative one would open it. The reduced Hessian is
//! computed from second differences of U along the surface, and so includes the surface's own
//! curvature.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use ordered_float::OrderedFloat;

use super::constrained::{self, Projected, length};
use crate::roadmap::Point;
use tiles::configuration::Configuration;
use tiles::contact::{Constraint, Touch};
use tiles::order::Order;
use tiles::problem::{Problem, Symmetry};

/// Step of the second differences (m, mass metric): the relative error of the Hessian is 1e-4 for
/// magnets a centimetre apart, with rounding far below that.
const DIFFERENCE: f64 = 1e-4;
/// Longest Newton step (m, mass metric).
const LONGEST: f64 = 4e-3;
/// Newton's method has converged when its step is shorter than this (m).
const CONVERGED: f64 = 1e-10;
/// Contacts with a gap below this (m) are closed.
const CLOSED: f64 = 1e-8;
/// Contacts are searched for this far (m) beyond the step; an overlap of more than `CLOSED` with
/// one of them ends the step.
const MARGIN: f64 = 1e-6;
const CLOSING: f64 = 1e-11;
/// Modes with less than this fraction of the greatest curvature are given that curvature.
const FLATTEST: f64 = 1e-12;
const MOST_STEPS: usize = 80;
/// A minimum farther from the start than this (m, metric of the space) is another one.
const NEAR: f64 = 0.02;
/// At rest, at most this fraction of the force is not held by contact.
const UNBALANCED: f64 = 1e-5;

/// A stationary point with its spectrum.
#[derive(Clone, Debug)]
pub struct Stationary {
    /// Where it is, with its energy and gradient.
    pub point: Point,
    /// Eigenvalues of the reduced Hessian (J/m^2), ascending, and their directions, of length 1
    /// in the mass metric.
    pub modes: Vec<(f64, Vector3<f64>)>,
}

impl Stationary {
    /// Number of directions along the surface in which the energy falls.
    pub fn index(&self) -> usize {
        self.modes.iter().filter(|mode| mode.0 < 0.0).count()
    }

    /// Its image under a symmetry of the problem.
    pub fn image(&self, symmetry: &Symmetry) -> Self {
        Self {
            point: self.point.image(symmetry),
            modes: self
                .modes
                .iter()
                .map(|(curvature, direction)| (*curvature, symmetry.turned(direction)))
                .collect(),
        }
    }
}

/// The minimum near `q`, if Newton's method finds one without leaving the neighbourhood.
pub fn minimum(problem: &Problem, q: &Configuration) -> Option<Stationary> {
    search(problem, q, None, problem.scaled(NEAR))
        .filter(|found| found.index() == 0 && is_at_rest(problem, &found.point))
}

/// The transition state near `q`: uphill along the mode closest to `along`, downhill in the others.
pub fn transition_state(
    problem: &Problem,
    q: &Configuration,
    along: &Vector3<f64>,
) -> Option<Stationary> {
    search(problem, q, Some(*along), f64::INFINITY)
        .filter(|found| found.index() == 1 && is_at_rest(problem, &found.point))
}

/// Whether the contacts actually closed at a point balance the force there. Newton's method may
/// have kept a contact closed from which the tile can slip off round a corner.
fn is_at_rest(problem: &Problem, point: &Point) -> bool {
    constrained::unbalanced(problem, point) <= UNBALANCED
}

fn search(
    problem: &Problem,
    start: &Configuration,
    mut along: Option<Vector3<f64>>,
    within: f64,
) -> Option<Stationary> {
    let mut surface = Surface::pressing(problem, &Point::new(problem, *start));
    let mut point = Point::new(problem, surface.retract(start)?);
    let mut longest = problem.scaled(LONGEST);
    let mut last_slope = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        if surface.release(&point) {
            continue;
        }
        let tangent = surface.tangent(&point.q);
        let modes = surface.modes(&point, &tangent)?;
        let followed = along.and_then(|along| most_alike(problem, &point, &modes, &along));
        let mut step = Vector3::zeros();
        let mut slope_size: f64 = 0.0;
        let steepest = modes.iter().map(|mode| mode.0.abs()).fold(0.0, f64::max);
        let flattest = (FLATTEST * steepest).max(f64::MIN_POSITIVE);
        for (k, (curvature, direction)) in modes.iter().enumerate() {
            let slope = point.gradient.dot(direction);
            slope_size += slope * slope;
            let uphill = if followed == Some(k) { 1.0 } else { -1.0 };
            step += direction * (uphill * slope / curvature.abs().max(flattest));
        }
        let metric = problem.mass_metric(point.q.theta);
        let size = length(&step, &metric);
        if size <= problem.scaled(CONVERGED) {
            return Some(Stationary { point, modes });
        }
        // Steps that overshoot increase the slope. They are shortened, and abandoned once they are
        // shorter than the differences they are computed from.
        longest = if slope_size > last_slope {
            longest / 2.0
        } else {
            (longest * 1.5).min(problem.scaled(LONGEST))
        };
        last_slope = slope_size;
        if longest < problem.scaled(DIFFERENCE) && longest < size {
            return None;
        }
        step *= (longest / size).min(1.0);
        if let Some(k) = followed {
            let sign = along.map_or(1.0, |a| (a.dot(&(metric * modes[k].1))).signum());
            along = Some(modes[k].1 * sign);
        }
        let (next, closing) = surface.advance(&point.q, &step)?;
        if let Some(touch) = closing {
            surface.closed.push(touch);
            last_slope = f64::INFINITY;
        }
        if problem.space.distance(start, &next) > within {
            return None;
        }
        point = Point::new(problem, next);
    }
    None
}

/// The mode closest to a direction, by the cosine in the mass metric.
fn most_alike(
    problem: &Problem,
    point: &Point,
    modes: &[(f64, Vector3<f64>)],
    along: &Vector3<f64>,
) -> Option<usize> {
    let metric = problem.mass_metric(point.q.theta);
    let cosine = |k: usize| along.dot(&(metric * modes[k].1)).abs();
    (0..modes.len()).max_by_key(|&k| OrderedFloat(cosine(k)))
}

/// The surface on which some contacts stay closed.
struct Surface<'a> {
    problem: &'a Problem,
    closed: Vec<Touch>,
    releases: usize,
}

impl<'a> Surface<'a> {
    /// The surface of the contacts that the energy presses on at a point.
    fn pressing(problem: &'a Problem, point: &Point) -> Self {
        let metric = problem.mass_metric(point.q.theta);
        let touching = constrained::constraints(problem, &point.q, problem.scaled(CLOSED));
        let mut surface = Self {
            problem,
            closed: Vec::new(),
            releases: 0,
        };
        let projected = Projected::new(point, metric, touching);
        for touch in projected.iter().flat_map(Projected::pressed) {
            if surface.is_independent(&point.q, touch) {
                surface.closed.push(touch);
            }
        }
        surface
    }

    fn constraints(&self, q: &Configuration) -> Vec<Constraint> {
        self.problem
            .contact
            .as_ref()
            .map_or_else(Vec::new, |contact| contact.constraints_of(&self.closed, q))
    }

    /// Opens the contact that is pulled on most, if any; whether one was opened. A contact that is
    /// opened repeatedly is left closed.
    fn release(&mut self, point: &Point) -> bool {
        if self.closed.is_empty() || self.releases > 8 {
            return false;
        }
        let Some(multipliers) = self.multipliers(point) else {
            return false;
        };
        let weakest = multipliers.imin();
        if multipliers[weakest] >= 0.0 {
            return false;
        }
        self.closed.remove(weakest);
        self.releases += 1;
        true
    }

    fn multipliers(&self, point: &Point) -> Option<DVector<f64>> {
        let inverse = self.problem.mass_metric(point.q.theta).try_inverse()?;
        let rows: Vec<_> = self
            .constraints(&point.q)
            .iter()
            .map(|c| c.gradient)
            .collect();
        let n = rows.len();
        let gram = DMatrix::from_fn(n, n, |a, b| rows[a].dot(&(inverse * rows[b])));
        let push = DVector::from_fn(n, |a, _| rows[a].dot(&(inverse * point.gradient)));
        gram.cholesky().map(|c| c.solve(&push))
    }

    /// Directions along the surface, orthonormal in the mass metric.
    fn tangent(&self, q: &Configuration) -> Vec<Vector3<f64>> {
        let metric = self.problem.mass_metric(q.theta);
        let Some(inverse) = metric.try_inverse() else {
            return Vec::new();
        };
        let mut basis: Vec<Vector3<f64>> = Vec::new();
        let normals = self
            .constraints(q)
            .into_iter()
            .map(|c| inverse * c.gradient);
        for normal in normals {
            basis.extend(orthonormal(normal, &basis, &metric, 1e-9));
        }
        let closed = basis.len();
        let rho = self.problem.space.rho;
        for axis in [Vector3::x(), Vector3::y(), Vector3::z() / rho] {
            basis.extend(orthonormal(axis, &basis, &metric, 1e-3));
        }
        basis.split_off(closed)
    }

    /// The configuration near `q` at which all closed contacts are closed.
    fn retract(&self, q: &Configuration) -> Option<Configuration> {
        constrained::close(self.problem, &self.closed, q)
    }

    /// Takes a step on the surface, up to the first contact that closes on the way.
    fn advance(
        &self,
        q: &Configuration,
        step: &Vector3<f64>,
    ) -> Option<(Configuration, Option<Touch>)> {
        let mut fraction = 1.0;
        let mut closing = None;
        for _ in 0..20 {
            let next = self.retract(&q.moved(step * fraction))?;
            let margin = constrained::reach(self.problem, step) + self.problem.scaled(MARGIN);
            let worst = constrained::constraints(self.problem, &next, margin)
                .into_iter()
                .filter(|c| !self.closed.contains(&c.touch))
                .min_by_key(|c| OrderedFloat(c.gap))
                .filter(|c| c.gap < -self.problem.scaled(CLOSING));
            let Some(worst) = worst else {
                let closing = closing.filter(|touch| self.is_independent(&next, *touch));
                return Some((next, closing));
            };
            let contact = self.problem.contact.as_ref()?;
            let before = contact.constraint(worst.touch, q).gap.max(0.0);
            fraction *= before / (before - worst.gap);
            closing = Some(worst.touch);
            if fraction < 1e-9 {
                let closing = closing.filter(|touch| self.is_independent(q, *touch));
                return closing.map(|touch| (*q, Some(touch)));
            }
        }
        None
    }

    fn is_independent(&self, q: &Configuration, touch: Touch) -> bool {
        let Some(contact) = &self.problem.contact else {
            return false;
        };
        if self.closed.contains(&touch) || self.closed.len() >= 3 {
            return false;
        }
        let gradient = contact.constraint(touch, q).gradient;
        let metric = self.problem.mass_metric(q.theta);
        let tangent = self.tangent(q);
        let inverse = metric.try_inverse().unwrap_or_else(Matrix3::identity);
        let whole = gradient.dot(&(inverse * gradient)).sqrt();
        let along = tangent
            .iter()
            .map(|t| gradient.dot(t).powi(2))
            .sum::<f64>()
            .sqrt();
        along > 1e-6 * whole
    }

    /// Eigenvalues and eigenvectors of the reduced Hessian.
    fn modes(&self, point: &Point, tangent: &[Vector3<f64>]) -> Option<Vec<(f64, Vector3<f64>)>> {
        let n = tangent.len();
        if n == 0 {
            return Some(Vec::new());
        }
        let h = self.problem.scaled(DIFFERENCE);
        let mut steps = Vec::new();
        for i in 0..n {
            steps.extend([tangent[i] * h, tangent[i] * -h]);
            for j in 0..i {
                let (sum, difference) = (tangent[i] + tangent[j], tangent[i] - tangent[j]);
                steps.extend([sum * h, sum * -h, difference * h, difference * -h]);
            }
        }
        let places: Option<Vec<Configuration>> = steps
            .into_iter()
            .map(|step| self.retract(&point.q.moved(step)))
            .collect();
        // Evaluated together, to share the vectors of the potential's batches.
        let mut energies = self.problem.energies(&places?).into_iter();
        let mut next = || energies.next().unwrap_or(f64::NAN);
        let mut hessian = DMatrix::zeros(n, n);
        for i in 0..n {
            let both = next() + next();
            hessian[(i, i)] = (both - 2.0 * point.energy) / (h * h);
            for j in 0..i {
                let mixed = next() + next() - next() - next();
                hessian[(i, j)] = mixed / (4.0 * h * h);
                hessian[(j, i)] = hessian[(i, j)];
            }
        }
        let eigen = hessian.symmetric_eigen();
        let mut modes: Vec<(f64, Vector3<f64>)> = (0..n)
            .map(|k| {
                let direction: Vector3<f64> = (0..n)
                    .map(|i| tangent[i] * eigen.eigenvectors[(i, k)])
                    .sum();
                (eigen.eigenvalues[k], direction)
            })
            .collect();
        modes.order_by_key(|(eigenvalue, _)| OrderedFloat(*eigenvalue));
        Some(modes)
    }
}

/// The component of `v` orthogonal to `basis`, normalised in the metric; `None` if less than the
/// fraction `least` remains.
fn orthonormal(
    v: Vector3<f64>,
    basis: &[Vector3<f64>],
    metric: &Matrix3<f64>,
    least: f64,
) -> Option<Vector3<f64>> {
    let whole = length(&v, metric);
    let mut rest = v;
    for _ in 0..2 {
        for b in basis {
            rest -= b * b.dot(&(metric * rest));
        }
    }
    let size = length(&rest, metric);
    (basis.len() < 3 && size > least * whole).then(|| rest / size)
}
