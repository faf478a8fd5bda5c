//! Gauss quadrature on panels that shrink towards the singularity of the integrand.

use std::sync::LazyLock;

use nalgebra::Complex;

use crate::potential::cuboid::quadrature::gauss_legendre;

/// Nodes of a panel.
const NODES: usize = 12;
/// Largest ratio of a panel's length to its distance from the nearest singular place; the error is
/// then below 1e-12 of the integrand.
const LONGEST: f64 = 1.5;

static RULE: LazyLock<[[f64; NODES]; 2]> = LazyLock::new(gauss_legendre::<NODES>);

/// Calls `each` with nodes and weights from `low` to `high`, of an integrand that is singular at
/// the given places of the complex plane (their imaginary parts not negative). Panels are not
/// halved below `shortest`: singularities are weak, and the remaining part is small.
pub fn panels(
    [low, high]: [f64; 2],
    singular: &[Complex<f64>],
    shortest: f64,
    each: &mut impl FnMut(f64, f64),
) {
    let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
    let distance =
        |place: &Complex<f64>| libm::hypot(((place.re - middle).abs() - half).max(0.0), place.im);
    let nearest = singular.iter().map(distance).fold(f64::INFINITY, f64::min);
    if half > shortest && 2.0 * half > LONGEST * nearest {
        // Split at the singular place if it is well inside, otherwise in the middle.
        let places = singular
            .iter()
            .filter(|place| place.im < half)
            .map(|place| place.re);
        let mut inside = places.filter(|place| (place - middle).abs() < 0.8 * half);
        let cut = inside.next().unwrap_or(middle);
        panels([low, cut], singular, shortest, each);
        panels([cut, high], singular, shortest, each);
        return;
    }
    let [nodes, weights] = &*RULE;
    for (node, weight) in nodes.iter().zip(weights) {
        each(middle + half * node, half * weight);
    }
}
