//! Gauss-Legendre rules, and the panels a pole face is cut into for them.

use std::sync::LazyLock;

/// Nodes in [-1, 1] and weights of the rules in use.
#[derive(Debug)]
pub struct Rules {
    pub four: [[f64; 4]; 2],
    pub eight: [[f64; 8]; 2],
    pub sixteen: [[f64; 16]; 2],
    /// Nodes that crowd towards both ends.
    pub crowded_eight: [[f64; 8]; 2],
    pub crowded_sixteen: [[f64; 16]; 2],
}

/// The rule after the substitution `x = (3 v - v^3) / 2`, whose derivative is 0 at both ends: it
/// takes the singularities there from `s^2 ln s` to `v^5 ln v`.
fn crowded<const N: usize>(rule: [[f64; N]; 2]) -> [[f64; N]; 2] {
    [
        rule[0].map(|v| (3.0 * v - v * v * v) / 2.0),
        std::array::from_fn(|i| rule[1][i] * 1.5 * (1.0 - rule[0][i] * rule[0][i])),
    ]
}

impl Rules {
    /// The only instance.
    pub fn get() -> &'static Self {
        static RULES: LazyLock<Rules> = LazyLock::new(|| Rules {
            four: gauss_legendre(),
            eight: gauss_legendre(),
            sixteen: gauss_legendre(),
            crowded_eight: crowded(gauss_legendre()),
            crowded_sixteen: crowded(gauss_legendre()),
        });
        &RULES
    }
}

/// The Gauss-Legendre rule with `N` nodes over [-1, 1], exact for polynomials of degree `2 N - 1`.
///
/// Newton's method on the Legendre polynomial, from the usual cosine guess; the weights are
/// `2 / ((1 - x^2) P_n'(x)^2)` (Abramowitz and Stegun, 25.4.29).
// Several arrays are walked at once.
#[allow(clippy::needless_range_loop)]
pub fn gauss_legendre<const N: usize>() -> [[f64; N]; 2] {
    let node = |i: usize| {
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
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    let nodes: [(f64, f64); N] = std::array::from_fn(node);
    [nodes.map(|(x, _)| x), nodes.map(|(_, weight)| weight)]
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

/// How fine panels get.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fineness {
    /// Panels shorter than this share of the interval are not graded further.
    pub finest: f64,
    /// The long axes (see [`panels`]) from which on eight and sixteen nodes are enough.
    pub eight: f64,
    pub sixteen: f64,
}

/// Which rule a panel takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    Eight,
    Sixteen,
    CrowdedEight,
    CrowdedSixteen,
}

impl Fineness {
    #[inline(always)]
    fn rule(&self, axis: f64) -> Rule {
        if axis >= self.eight {
            Rule::Eight
        } else {
            Rule::Sixteen
        }
    }

    /// By the length of panels alone: the axes are cosh(6 / (n - 1.5)) for n nodes, so that
    /// rho^(-2n) is exp(-12) / rho^3, which the weakness of the singularities (of the kind
    /// s^2 ln s) brings to some 1e-8.
    pub const fn new(finest: f64) -> Self {
        Self {
            finest,
            eight: 1.457_0,
            sixteen: 1.086_9,
        }
    }
}

/// A point off the interval at which the integrand is not analytic: its foot on the interval's
/// line, and its distance from that line.
pub type Corner = (f64, f64);

/// The share of a panel that is cut off at the end next to a corner.
const GRADING: f64 = 0.2;

/// Panels that are taken although they are too long get eight nodes below this share of half the
/// interval.
const SHORT: f64 = 0.5;

/// Cuts nearer to an end than this share of the panel are not made at the foot.
const MARGIN: f64 = 0.001;

/// Cuts the interval from `-half` to `half` into panels and calls `visit(start, end, eight)` for
/// each, `eight` saying whether eight nodes are enough (else it takes sixteen). Returns whether
/// some panels had to be taken although they are too long for the corners next to them.
///
/// An n-point rule applied to a function that is analytic within the ellipse with the interval's
/// ends as foci converges like `rho^(-2n)`, where the ellipse's long axis is
/// `(rho + 1 / rho) / 2` interval lengths (Trefethen, *Is Gauss quadrature better than
/// Clenshaw-Curtis?*, theorem 4.5, doi:10.1137/060659831). Each panel's ellipse is the largest
/// that stays clear of the two corners; where it is too small the panel is cut at the corner's
/// foot or, where that is at or beyond an end, near that end.
#[inline(always)]
pub fn panels(
    half: f64,
    corners: [Corner; 2],
    fineness: Fineness,
    visit: &mut impl FnMut(f64, f64, Rule),
) -> bool {
    let axis = axes(&corners, -half, half);
    if axis.0 >= fineness.sixteen {
        visit(-half, half, fineness.rule(axis.0));
        return false;
    }
    cut(half, corners, fineness, visit)
}

fn cut(
    half: f64,
    corners: [Corner; 2],
    fineness: Fineness,
    visit: &mut impl FnMut(f64, f64, Rule),
) -> bool {
    const DEPTH: usize = 32;
    let longest = 2.0 * half * fineness.finest;
    let mut stack = [(-half, half); DEPTH];
    let mut waiting = 1;
    let mut coarse = false;
    while waiting > 0 {
        waiting -= 1;
        let (start, end) = stack[waiting];
        let (axis, foot) = axes(&corners, start, end);
        let length = end - start;
        let margin = MARGIN * length;
        let at = if foot > start + margin && foot < end - margin {
            foot
        } else if foot < (start + end) / 2.0 {
            start + GRADING * length
        } else {
            end - GRADING * length
        };
        if axis >= fineness.sixteen {
            visit(start, end, fineness.rule(axis));
        } else if (at != foot && length <= longest) || waiting + 2 > DEPTH {
            coarse = true;
            visit(
                start,
                end,
                if length < SHORT * half {
                    Rule::CrowdedEight
                } else {
                    Rule::CrowdedSixteen
                },
            );
        } else {
            stack[waiting] = (start, at);
            stack[waiting + 1] = (at, end);
            waiting += 2;
        }
    }
    coarse
}

/// The long axis, in lengths of the interval, of the largest ellipse around it that is clear of
/// the corners, and the foot of the corner it touches.
#[inline(always)]
fn axes(corners: &[Corner; 2], start: f64, end: f64) -> (f64, f64) {
    let sums = corners.map(|(foot, height)| {
        let squared = height * height;
        let (a, b) = (foot - start, foot - end);
        (a * a + squared).sqrt() + (b * b + squared).sqrt()
    });
    let (sum, foot) = if sums[0] < sums[1] {
        (sums[0], corners[0].0)
    } else {
        (sums[1], corners[1].0)
    };
    (sum / (end - start), foot)
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
            let fineness = Fineness::new(0.01);
            let mut list = Vec::new();
            panels(
                1.0,
                [corner, (-0.2, 0.3)],
                fineness,
                &mut |start, end, _| {
                    list.push((start, end));
                },
            );
            list.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert_eq!(list[0].0, -1.0);
            assert_eq!(list[list.len() - 1].1, 1.0);
            assert!(list.windows(2).all(|pair| pair[0].1 == pair[1].0));
        }
    }
}
