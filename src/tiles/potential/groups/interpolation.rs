//! Interpolation at Chebyshev nodes: the nodes, their weights and the error.

use std::f64::consts::PI;

/// The `n` nodes of order `n` on [-1, 1]: `cos((2 k + 1) pi / (2 n))`.
pub fn nodes(n: usize) -> Vec<f64> {
    let step = PI / (2 * n) as f64;
    (0..n)
        .map(|k| libm::cos((2 * k + 1) as f64 * step))
        .collect()
}

/// The values at `x` of the polynomials that are 1 at one of the nodes and 0 at the others, by the
/// barycentric formula, in which the nodes' own weights are `(-1)^k sin((2 k + 1) pi / (2 n))`
/// (Berrut and Trefethen, *Barycentric Lagrange Interpolation*, SIAM Review 46 (2004), equations
/// 4.2 and 5.3).
pub fn shares(nodes: &[f64], x: f64) -> Vec<f64> {
    if let Some(at) = nodes.iter().position(|node| *node == x) {
        return (0..nodes.len())
            .map(|k| f64::from(u8::from(k == at)))
            .collect();
    }
    let weighed = nodes.iter().enumerate().map(|(k, node)| {
        // The sine of the angle whose cosine is the node.
        let sine = (1.0 - node * node).max(0.0).sqrt();
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        sign * sine / (x - node)
    });
    let weighed: Vec<f64> = weighed.collect();
    let sum: f64 = weighed.iter().sum();
    weighed.into_iter().map(|share| share / sum).collect()
}

/// A bound of the sum of the magnitudes of these values anywhere on [-1, 1] (Lebesgue's constant;
/// Trefethen, *Approximation Theory and Approximation Practice*, theorem 15.2).
pub fn lebesgue(n: usize) -> f64 {
    1.0 + 2.0 / PI * libm::log(n as f64)
}

/// A bound of the error of the energy of two dipoles if the place of one is interpolated at `n`
/// nodes on a segment of the half length `half` (m) at least `distance` (m) from the other, as a
/// fraction of `mu0 m1 m2 / (4 pi distance^3)`.
///
/// The error is the n-th derivative over `n!` times the product of the distances to the nodes,
/// which is at most `2 (half / 2)^n`; the energy is K times a second directional derivative of
/// `1 / r`, whose n-th directional derivative is at most `(n + 2)! K / r^(n + 3)`.
pub fn lost(n: usize, half: f64, distance: f64) -> f64 {
    let ratio = half / (2.0 * distance);
    2.0 * ((n + 1) * (n + 2)) as f64 * ratio.powi(n as i32)
}

/// The smallest distance (m), to a part in a million, at which the error [`lost`], which decreases
/// like the distance's n-th power, is at most `allowed`.
pub fn least_distance(n: usize, half: f64, allowed: f64) -> f64 {
    half * libm::pow(lost(n, 1.0, 1.0) / allowed, 1.0 / n as f64) * (1.0 + 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_reproduce_polynomials_and_stay_below_lebesgues_constant() {
        for n in [1, 2, 5, 16, 24] {
            let nodes = nodes(n);
            for k in 0..=40 {
                let x = f64::from(k) / 20.0 - 1.0;
                let shares = shares(&nodes, x);
                let magnitude: f64 = shares.iter().map(|share| share.abs()).sum();
                assert!(magnitude <= lebesgue(n) + 1e-12, "{n} {x}: {magnitude}");
                for power in 0..n as i32 {
                    let values = nodes.iter().zip(&shares);
                    let value: f64 = values.map(|(node, share)| share * node.powi(power)).sum();
                    assert!((value - x.powi(power)).abs() < 1e-13, "{n} {x} {power}");
                }
            }
        }
    }

    /// Along a line, across it and at an angle, at the stated distance, the error of a dipole's
    /// energy is within the bound, and somewhere close to it.
    #[test]
    fn no_more_is_lost_than_is_said() {
        for n in [4, 8, 16] {
            let nodes = nodes(n);
            let mut most = 0.0f64;
            for ratio in [0.3, 1.0, 3.0] {
                let bound = lost(n, 1.0, ratio);
                for (kind, slant) in (0..60).flat_map(|k| [(0, k), (1, k), (2, k)]) {
                    let angle = f64::from(slant) * 0.11;
                    let other = [[0.3, ratio], [1.0 + ratio, 0.0], [-1.0, -ratio]][kind];
                    let energy = |x: f64| {
                        let (dx, dy) = (other[0] - x, other[1]);
                        let r = libm::hypot(dx, dy);
                        let along = (dx * libm::cos(angle) + dy * libm::sin(angle)) / r;
                        (libm::cos(angle) - 3.0 * along * dx / r) / r.powi(3)
                    };
                    for k in 0..=50 {
                        let x = f64::from(k) / 25.0 - 1.0;
                        let shares = shares(&nodes, x);
                        let values = nodes.iter().zip(&shares);
                        let value: f64 = values.map(|(node, share)| share * energy(*node)).sum();
                        let error = (value - energy(x)).abs() * ratio.powi(3);
                        assert!(error <= bound + 1e-13 * n as f64, "{n} {ratio}: {error}");
                        most = most.max(error / bound);
                    }
                }
            }
            assert!(most > 0.01, "{n}: far too wide, {most}");
        }
    }
}
