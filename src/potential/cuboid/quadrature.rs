//! Gauss-Legendre rules, and how many of their nodes an interval needs.

use std::sync::LazyLock;

/// Most nodes of one rule.
pub const MAX_NODES: usize = 20;

/// Nodes and weights of the rules with 1 to [`MAX_NODES`] nodes, over [-1, 1].
static RULES: LazyLock<Vec<Vec<(f64, f64)>>> =
    LazyLock::new(|| (1..=MAX_NODES).map(gauss_legendre).collect());

/// The Gauss-Legendre rule with `n` nodes (1 to [`MAX_NODES`]): nodes in [-1, 1] and weights.
/// It is exact for polynomials of degree `2 n - 1`.
pub fn rule(n: usize) -> &'static [(f64, f64)] {
    &RULES[n.clamp(1, MAX_NODES) - 1]
}

/// Newton's method on the Legendre polynomial, from the usual cosine guess; the weights are
/// `2 / ((1 - x^2) P_n'(x)^2)` (Abramowitz and Stegun, 25.4.29).
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (value, derivative) = legendre(n, x);
                slope = derivative;
                let step = value / derivative;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// The Legendre polynomial of degree `n` and its derivative, by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut value) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (previous, value) = (
            value,
            ((2.0 * k - 1.0) * x * value - (k - 1.0) * previous) / k,
        );
    }
    (value, n as f64 * (x * value - previous) / (x * x - 1.0))
}

/// Size `rho` of the largest ellipse (the sum of its half axes, in half lengths of the interval)
/// with the interval's ends as foci that stays clear of a point, `to_start` and `to_end` away
/// from the ends.
///
/// An n-point rule applied to a function that is analytic within the ellipse converges like
/// `rho^(-2n)` (Trefethen, *Is Gauss quadrature better than Clenshaw-Curtis?*, theorem 4.5,
/// doi:10.1137/060659831). The sum of the distances to the foci is the ellipse's long axis,
/// `(rho + 1 / rho) / 2` interval lengths.
pub fn ellipse(to_start: f64, to_end: f64, length: f64) -> f64 {
    let axis = ((to_start + to_end) / length).max(1.0);
    axis + (axis * axis - 1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_polynomials_exactly_up_to_their_degree() {
        for n in 1..=MAX_NODES {
            for degree in 0..2 * n {
                let sum: f64 = rule(n).iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
                let exact = if degree % 2 == 0 {
                    2.0 / (degree + 1) as f64
                } else {
                    0.0
                };
                assert!((sum - exact).abs() < 3e-15, "{n} {degree}: {sum} {exact}");
            }
        }
    }

    #[test]
    fn the_ellipse_through_a_real_point_has_the_textbook_size() {
        // A pole at x = 2: rho = 2 + sqrt(3).
        assert!((ellipse(3.0, 1.0, 2.0) - (2.0 + 3f64.sqrt())).abs() < 1e-15);
    }
}
