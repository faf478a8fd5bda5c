//! A state of the nominal tiles, followed to tiles with errors: the energy's expansion about it, and
//! the contacts that hold it.
//!
//! The state of a draw is found by a Newton step within the contacts: the second-order energy of the
//! draw is minimised where no contact near the state opens inwards. Curved contact enters by the
//! forces that hold the nominal state.

use nalgebra::{Matrix3, Vector3};

use super::expansion::{Expansion, Pairs, Placed};
use physics::configuration::Configuration;
use physics::contact::{Constraint, Touch, closest_admissible};
use physics::landscape::State;
use physics::landscape::constrained::{close, constraints};
use physics::problem::Problem;

/// Contacts within this distance (m, for the paper's tile) of the state can close.
const NEAR: f64 = 2e-3;
/// Longest step (m, metric of the space, for the paper's tile).
const LONGEST: f64 = 2e-3;
/// Least curvature along any direction, as a share of the largest.
const FLATTEST: f64 = 1e-3;
/// How much stiffer than the energy a contact is where it must hold.
const STIFF: f64 = 10.0;
/// Step of the differences of contacts' gradients (m; rad times the radius of gyration).
const STEP: f64 = 1e-5;
/// Number of Newton steps.
const STEPS: usize = 3;

/// A followed state.
pub struct Well<'a> {
    problem: &'a Problem,
    /// The expansion of the energy about it.
    pub expansion: Expansion,
    /// Contacts at or near it.
    contacts: Vec<Constraint>,
    /// The sum over its contacts of the force that holds it times the contact's second derivatives.
    curved: Matrix3<f64>,
    /// The gradients of the contacts that hold it.
    holding: Vec<Vector3<f64>>,
}

impl<'a> Well<'a> {
    /// A state of the nominal problem.
    pub fn new(problem: &'a Problem, pairs: &Pairs, state: &State) -> Self {
        Self::at(problem, pairs, &state.configuration)
    }

    /// The same at a minimum's configuration.
    pub fn at(problem: &'a Problem, pairs: &Pairs, q: &Configuration) -> Self {
        let contacts = constraints(problem, q, problem.scaled(NEAR));
        let (_, gradient) = problem.energy_and_gradient(q);
        let metric = problem.mass_metric(q.theta);
        let touching: Vec<Constraint> = contacts
            .iter()
            .filter(|it| it.gap < problem.scaled(1e-8))
            .map(|it| Constraint { gap: 0.0, ..*it })
            .collect();
        // The forces of contact that balance the gradient as well as they can.
        let free = metric.try_inverse().map(|inverse| -(inverse * gradient));
        let size = free.map_or(0.0, |free| free.dot(&(metric * free)).sqrt());
        let held = free
            .filter(|_| size > 0.0)
            .and_then(|free| closest_admissible((free / size, 1.0), &metric, &touching));
        let multipliers = held.map_or_else(Vec::new, |(_, multipliers)| multipliers);
        let (mut curved, mut holding) = (Matrix3::zeros(), Vec::new());
        for (contact, multiplier) in touching.iter().zip(multipliers) {
            if multiplier > 0.0 {
                curved += second_derivatives(problem, contact.touch, q) * (multiplier * size);
                holding.push(contact.gradient);
            }
        }
        Self {
            problem,
            expansion: pairs.at(q),
            contacts,
            curved,
            holding,
        }
    }

    /// The energy (J) of a draw at the nominal configuration.
    pub fn unmoved(&self, placed: &Placed) -> f64 {
        self.expansion.energy(placed, &self.expansion.q)
    }

    /// The energy (J) of a draw, with the moving tile at rest near the state, and where.
    pub fn energy(&self, placed: &Placed) -> (f64, Configuration) {
        let mut q = self.expansion.q;
        let mut best = self.unmoved(placed);
        for _ in 0..STEPS {
            let Some(next) = self.step(placed, &q) else {
                break;
            };
            let energy = self.expansion.energy(placed, &next);
            if energy >= best {
                break;
            }
            (best, q) = (energy, next);
        }
        (best, q)
    }

    /// A Newton step within the contacts.
    fn step(&self, placed: &Placed, q: &Configuration) -> Option<Configuration> {
        let (_, gradient, bend) = self.expansion.slopes(placed, q);
        let rho = self.problem.space.rho;
        let stiff = self.convex(bend - self.curved, rho);
        let wanted = -(stiff.try_inverse()? * gradient);
        let touches: Vec<Touch> = self.contacts.iter().map(|it| it.touch).collect();
        let now = match &self.problem.contact {
            Some(contact) => contact.constraints_of(&touches, q),
            None => Vec::new(),
        };
        let unit = self.problem.scaled(1e-3);
        let (step, multipliers) =
            closest_admissible((wanted, unit * stiff.norm().sqrt()), &stiff, &now)?;
        let longest = self.problem.scaled(LONGEST);
        let length = self.problem.space.length(step);
        let step = step * (longest / length).min(1.0);
        let pressed = touches.iter().zip(&multipliers);
        let pressed = pressed.filter(|(_, multiplier)| **multiplier > 0.0);
        let pressed: Vec<Touch> = pressed.map(|(touch, _)| *touch).collect();
        close(self.problem, &pressed, &q.moved(step))
    }

    /// Second derivatives that are positive in every direction: stiffened where contact holds, and
    /// with positive curvature elsewhere.
    fn convex(&self, bend: Matrix3<f64>, rho: f64) -> Matrix3<f64> {
        let scale = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 1.0 / rho));
        let mut even = scale * bend * scale;
        let size = even.norm().max(f64::MIN_POSITIVE);
        for gradient in &self.holding {
            let along = scale * gradient;
            even += along * along.transpose() * (STIFF * size / along.norm_squared());
        }
        let mut eigen = even.symmetric_eigen();
        for value in eigen.eigenvalues.iter_mut() {
            *value = value.abs().max(FLATTEST * size);
        }
        let back = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, rho));
        back * eigen.recompose() * back
    }
}

/// The second derivatives of a contact's gap, by differences of its gradient.
fn second_derivatives(problem: &Problem, touch: Touch, q: &Configuration) -> Matrix3<f64> {
    let Some(contact) = &problem.contact else {
        return Matrix3::zeros();
    };
    let along = |k: usize| {
        let mut step = Vector3::zeros();
        step[k] = if k == 2 {
            STEP / problem.space.rho
        } else {
            STEP
        };
        let gradient = |q: Configuration| contact.constraint(touch, &q).gradient;
        (gradient(q.moved(step)) - gradient(q.moved(-step))) / (2.0 * step[k])
    };
    let all = Matrix3::from_columns(&[along(0), along(1), along(2)]);
    (all + all.transpose()) * 0.5
}
