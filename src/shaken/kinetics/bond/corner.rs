//! Closed forms for wells at hard contact.
//!
//! If contacts hold a minimum, U rises linearly away from it and there is no Gaussian prefactor. To
//! lowest order the free configurations are a cone `a_k . u >= 0` (a_k are the gaps' gradients)
//! times the directions along which all contacts stay closed, and `U = U0 + c . u + K s^2 / 2`. In
//! coordinates u in which the mass matrix is the identity, over a cone spanned by as many rays r_i
//! as its dimension d,
//!
//! `integral of exp(-c . u / kT) = kT^d |det(r_1 .. r_d)| / prod (c . r_i)`,
//!
//! and every other cone is a sum of such cones; each closed direction contributes `sqrt(2 pi kT /
//! K)`. For an edge flush on an edge, pressed by the force F and the torque T with lever arms l+
//! and l-, this is `(kT)^2 / F [1 / (F l+ + T) + 1 / (F l- - T)] sqrt(2 pi kT / K)`.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use landscape::constrained::constraints;
use landscape::stationary;
use tiles::configuration::Configuration;
use tiles::order::Order;
use tiles::problem::Problem;

/// Contacts with a gap below this (m) are closed.
const CLOSED: f64 = 1e-7;
/// Tolerance of equal directions and of zero cosines.
const SAME: f64 = 1e-6;
/// Largest number of faces of a cone.
const MOST_FACES: usize = 60;

/// The integral (m^2 rad) of `exp(-(U - U0) / kT)` about the minimum at `q` to lowest order in kT;
/// `None` if contact and slope do not hold the tile there to first order, or `q` is no minimum.
pub fn volume(problem: &Problem, q: &Configuration, kt: f64) -> Option<f64> {
    let minimum = stationary::minimum(problem, q)?;
    let q = minimum.point.q;
    let lower = problem.mass_metric(q.theta).cholesky()?.l();
    let flat = |covector: Vector3<f64>| lower.solve_lower_triangular(&covector);
    let slope = flat(minimum.point.gradient)?;
    let mut walls: Vec<Vector3<f64>> = Vec::new();
    for constraint in constraints(problem, &q, problem.scaled(CLOSED)) {
        let wall = flat(constraint.gradient)?.normalize();
        if walls.iter().all(|known| (known - wall).norm() > SAME) {
            walls.push(wall);
        }
    }
    let span = span(&walls);
    let cone = match span[..] {
        [] => 1.0,
        [axis] => kt / slope.dot(&axis).abs(),
        [a, b] => plane_cone(&walls, &slope, [a, b])? * kt * kt,
        _ => solid_cone(&walls, &slope)? * kt.powi(3),
    };
    if minimum.modes.len() != 3 - span.len() {
        return None;
    }
    let closed = minimum
        .modes
        .iter()
        .map(|(curvature, _)| (TAU * kt / curvature).sqrt());
    let volume = cone * closed.product::<f64>() / lower.diagonal().product();
    (volume.is_finite() && volume > 0.0).then_some(volume)
}

/// An orthonormal basis of the span of some vectors.
fn span(vectors: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let mut basis: Vec<Vector3<f64>> = Vec::new();
    for v in vectors {
        let rest = basis.iter().fold(*v, |rest, b| rest - b * b.dot(v));
        if rest.norm() > 1e-4 {
            basis.push(rest.normalize());
        }
    }
    basis
}

/// Whether a ray lies in a cone.
fn is_inside(walls: &[Vector3<f64>], ray: &Vector3<f64>) -> bool {
    walls.iter().all(|wall| wall.dot(ray) >= -SAME)
}

/// Adds a ray and its opposite, if they lie in the cone and are new.
fn add_rays(rays: &mut Vec<Vector3<f64>>, walls: &[Vector3<f64>], ray: Vector3<f64>) {
    for ray in [ray, -ray] {
        let is_new = rays.iter().all(|known| (known - ray).norm() > SAME);
        if is_new && is_inside(walls, &ray) {
            rays.push(ray);
        }
    }
}

/// The integral over a cone of walls that span a plane, without kT.
fn plane_cone(
    walls: &[Vector3<f64>],
    slope: &Vector3<f64>,
    [a, b]: [Vector3<f64>; 2],
) -> Option<f64> {
    let mut rays = Vec::new();
    for wall in walls {
        add_rays(&mut rays, walls, a * wall.dot(&b) - b * wall.dot(&a));
    }
    let [r1, r2] = rays[..] else {
        return None;
    };
    let rises = [slope.dot(&r1), slope.dot(&r2)];
    let area = (r1.dot(&a) * r2.dot(&b) - r1.dot(&b) * r2.dot(&a)).abs();
    rises
        .iter()
        .all(|rise| *rise > 0.0)
        .then(|| area / (rises[0] * rises[1]))
}

/// The integral over a cone of walls that span space, without kT: a fan of cones of three rays.
fn solid_cone(walls: &[Vector3<f64>], slope: &Vector3<f64>) -> Option<f64> {
    if walls.len() > MOST_FACES {
        return None;
    }
    let mut rays = Vec::new();
    for (k, a) in walls.iter().enumerate() {
        for b in &walls[..k] {
            if let Some(ray) = a.cross(b).try_normalize(SAME) {
                add_rays(&mut rays, walls, ray);
            }
        }
    }
    if rays.len() < 3 || rays.iter().any(|ray| slope.dot(ray) <= 0.0) {
        return None;
    }
    let axis = rays.iter().sum::<Vector3<f64>>().normalize();
    let first = (rays[0] - axis * axis.dot(&rays[0])).try_normalize(0.0)?;
    let second = axis.cross(&first);
    rays.order_by(|a, b| {
        let angle = |ray: &Vector3<f64>| libm::atan2(second.dot(ray), first.dot(ray));
        angle(a).total_cmp(&angle(b))
    });
    let cone = |pair: &[Vector3<f64>]| {
        let three = [rays[0], pair[0], pair[1]];
        let rises: f64 = three.iter().map(|ray| slope.dot(ray)).product();
        Matrix3::from_columns(&three).determinant().abs() / rises
    };
    Some(rays[1..].windows(2).map(cone).sum())
}
