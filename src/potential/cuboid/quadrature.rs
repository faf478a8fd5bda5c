//! Gauss-Legendre rules, and the panels a pole face is cut into for them.

use std::sync::LazyLock;

/// Nodes in [-1, 1] and weights of the rules in use.
#[derive(Debug)]
pub struct Rules {
    pub eight: [[f64; 8]; 2],
    pub sixteen: [[f64; 16]; 2],
}

impl Rules {
    /// The only instance.
    pub fn get() -> &'static Self {
        static RULES: LazyLock<Rules> = LazyLock::new(|| Rules {
            eight: gauss_legendre(),
            sixteen: gauss_legendre(),
        });
        &RULES
    }
}

/// The Gauss-Legendre rule with `N` nodes over [-1, 1], exact for polynomials of degree `2 N - 1`.
///
/// Newton's method on the Legendre polynomial, from the usual cosine guess; the weights are
/// `2 / ((1 - x^2) P_n'(x)^2)` (Abramowitz and Stegun, 25.4.29).
pub fn gauss_legendre<const N: usize>() -> [[f64; N]; 2] {
    let mut rule = [[0.0; N]; 2];
    for i in 0..N {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (N as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (value, derivative) = legendre(N, x);
            slope = derivative;
            let step = value / derivative;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        rule[0][i] = x;
        rule[1][i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    rule
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

/// How small panels may get, as a share of the interval, before they are taken as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fineness {
    pub finest: f64,
    /// Long axes (see [`axis`]) from which on eight and sixteen nodes are enough.
    pub eight: f64,
    pub sixteen: f64,
}

/// A point off the interval at which the integrand is not analytic: its foot on the interval's
/// line, and its distance from that line.
pub type Corner = (f64, f64);

/// The panels of an interval, in no particular order: start, end, and whether eight nodes will do
/// (else it takes sixteen).
///
/// An n-point rule applied to a function that is analytic within the ellipse with the interval's
/// ends as foci converges like `rho^(-2n)`, where the ellipse's long axis is
/// `(rho + 1 / rho) / 2` interval lengths (Trefethen, *Is Gauss quadrature better than
/// Clenshaw-Curtis?*, theorem 4.5, doi:10.1137/060659831). Each panel's ellipse is the largest
/// that stays clear of the two corners; where it is too small the panel is cut at the corner's
/// foot or, where that is at or beyond an end, near that end.
#[derive(Clone, Debug)]
pub struct Panels {
    corners: [Corner; 2],
    fineness: Fineness,
    shortest: f64,
    stack: [(f64, f64); DEPTH],
    waiting: usize,
}

const DEPTH: usize = 32;

/// The share of a panel that is cut off at the end next to a corner.
const GRADING: f64 = 0.2;

/// Cuts nearer to an end than this share of the panel are not made at the foot.
const MARGIN: f64 = 0.01;

impl Panels {
    #[inline(always)]
    pub fn new(half: f64, corners: [Corner; 2], fineness: Fineness) -> Self {
        let mut stack = [(0.0, 0.0); DEPTH];
        stack[0] = (-half, half);
        Self {
            corners,
            fineness,
            shortest: 2.0 * half * fineness.finest,
            stack,
            waiting: 1,
        }
    }

    #[inline(always)]
    fn cut(&mut self, start: f64, at: f64, end: f64) {
        self.stack[self.waiting] = (start, at);
        self.stack[self.waiting + 1] = (at, end);
        self.waiting += 2;
    }
}

/// The long axis, in lengths of the interval, of the ellipse around it that goes through a corner.
#[inline(always)]
fn axis((foot, height): Corner, start: f64, end: f64) -> f64 {
    let squared = height * height;
    let distance = |from: f64| ((foot - from) * (foot - from) + squared).sqrt();
    (distance(start) + distance(end)) / (end - start)
}

impl Iterator for Panels {
    type Item = (f64, f64, bool);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            self.waiting = self.waiting.checked_sub(1)?;
            let (start, end) = self.stack[self.waiting];
            let axes = self.corners.map(|corner| axis(corner, start, end));
            let (nearest, foot) = if axes[0] < axes[1] {
                (axes[0], self.corners[0].0)
            } else {
                (axes[1], self.corners[1].0)
            };
            if nearest >= self.fineness.sixteen {
                return Some((start, end, nearest >= self.fineness.eight));
            }
            let length = end - start;
            if length < self.shortest || self.waiting + 2 > DEPTH {
                return Some((start, end, true));
            }
            if foot < start + MARGIN * length {
                self.cut(start, start + GRADING * length, end);
            } else if foot > end - MARGIN * length {
                self.cut(start, end - GRADING * length, end);
            } else {
                self.cut(start, foot, end);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<const N: usize>() {
        let [nodes, weights] = gauss_legendre::<N>();
        for degree in 0..2 * N {
            let sum: f64 = (0..N)
                .map(|i| weights[i] * nodes[i].powi(degree as i32))
                .sum();
            let exact = if degree % 2 == 0 {
                2.0 / (degree + 1) as f64
            } else {
                0.0
            };
            assert!((sum - exact).abs() < 3e-15, "{N} {degree}: {sum} {exact}");
        }
    }

    #[test]
    fn rules_integrate_polynomials_exactly_up_to_their_degree() {
        check::<3>();
        check::<8>();
        check::<16>();
    }

    #[test]
    fn the_panels_cover_the_interval_once() {
        for corner in [(0.3, 0.0), (-1.0, 1e-4), (1.5, 0.0), (0.999, 1e-9)] {
            let fineness = Fineness {
                finest: 0.01,
                eight: 1.4,
                sixteen: 1.1,
            };
            let mut panels: Vec<_> = Panels::new(1.0, [corner, (-0.2, 0.3)], fineness).collect();
            panels.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert_eq!(panels[0].0, -1.0);
            assert_eq!(panels[panels.len() - 1].1, 1.0);
            assert!(panels.windows(2).all(|pair| pair[0].1 == pair[1].0));
        }
    }
}
