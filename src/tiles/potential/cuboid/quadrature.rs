//! Gauss-Legendre rules, and the panels into which a pole face is divided for them.

use std::sync::LazyLock;

/// The largest number of nodes of a rule.
pub const MOST: usize = 16;

/// A rule over [-1, 1], padded to [`MOST`] nodes with nodes without weight.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    pub count: usize,
    pub nodes: [f64; MOST],
    pub weights: [f64; MOST],
}

impl Rule {
    fn new<const N: usize>([nodes, weights]: [[f64; N]; 2]) -> Self {
        let filled =
            |values: [f64; N]| std::array::from_fn(|i| if i < N { values[i] } else { 0.0 });
        Self {
            count: N,
            nodes: filled(nodes),
            weights: filled(weights),
        }
    }

    fn gauss<const N: usize>() -> Self {
        Self::new(gauss_legendre::<N>())
    }

    /// The rule after the substitution `x = (3 v - v^3) / 2`, whose derivative is 0 at both ends:
    /// it takes the singularities there from `s^2 ln s` to `v^5 ln v`.
    fn crowded<const N: usize>() -> Self {
        let [nodes, weights] = gauss_legendre::<N>();
        Self::new([
            nodes.map(|v| (3.0 * v - v * v * v) / 2.0),
            std::array::from_fn(|i| weights[i] * 1.5 * (1.0 - nodes[i] * nodes[i])),
        ])
    }
}

/// Number of rules for analytic integrands, in the order of their numbers of nodes.
const ANALYTIC: usize = 9;

/// The indices of the rules whose nodes crowd towards both ends.
const CROWDED_EIGHT: usize = ANALYTIC;
const CROWDED_SIXTEEN: usize = ANALYTIC + 1;

/// The rules in use, by the indices that [`panels`] returns.
pub static RULES: LazyLock<[Rule; ANALYTIC + 2]> = LazyLock::new(|| {
    [
        Rule::gauss::<4>(),
        Rule::gauss::<5>(),
        Rule::gauss::<6>(),
        Rule::gauss::<7>(),
        Rule::gauss::<8>(),
        Rule::gauss::<10>(),
        Rule::gauss::<12>(),
        Rule::gauss::<14>(),
        Rule::gauss::<16>(),
        Rule::crowded::<8>(),
        Rule::crowded::<16>(),
    ]
});

/// The indices of the Gauss-Legendre rules of 4 and of 6 nodes.
pub const FOUR: usize = 0;
pub const SIX: usize = 2;

/// The indices of the Gauss-Legendre rules of 4, 8 and 16 nodes.
pub const FOUR_EIGHT_SIXTEEN: [usize; 3] = [FOUR, 4, 8];

/// The Gauss-Legendre rule with `N` nodes over [-1, 1], exact for polynomials of degree `2 N - 1`.
///
/// Newton's method on the Legendre polynomial, from the usual cosine guess; the weights are
/// `2 / ((1 - x^2) P_n'(x)^2)` (Abramowitz and Stegun, 25.4.29).
// Several arrays are walked at once.
#[allow(clippy::needless_range_loop)]
pub fn gauss_legendre<const N: usize>() -> [[f64; N]; 2] {
    let node = |i: usize| {
        let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (N as f64 + 0.5));
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

/// The fineness of panels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fineness {
    /// Panels shorter than this fraction of the interval are not graded further.
    pub finest: f64,
    /// The long axes (see [`panels`]) beyond which each of the rules for analytic integrands
    /// suffices, descending.
    pub axes: [f64; ANALYTIC],
}

impl Fineness {
    /// The panels are cut at the corners' feet only. The worst integrand there behaves like `s^2 ln
    /// s`, for which sixteen crowded nodes have an error of about 1e-7.
    ///
    /// From eight nodes on the axes are cosh(6 / (n - 1.5)) for n nodes, so that rho^(-2n) is
    /// exp(-12) / rho^3, which the weakness of the singularities (like s^2 ln s) reduces to about
    /// 1e-8. Fewer nodes suffice for faces farther apart, whose four pairs cancel: there
    /// rho^(2n + 3) is exp(31) for four and five nodes, exp(29) for six, exp(25.9) for seven.
    pub const NORMAL: Self = Self {
        finest: 1.0,
        axes: [
            8.403, 5.473, 3.528, 2.403, 1.457_2, 1.259_7, 1.167_8, 1.117_4, 1.086_9,
        ],
    };

    /// The index of the sufficient rule with the fewest nodes, if there is one.
    #[inline(always)]
    pub fn rule(&self, axis: f64) -> Option<usize> {
        let number = self.axes.iter().filter(|least| axis < **least).count();
        (number < ANALYTIC).then_some(number)
    }
}

/// A part of an interval, and the index of its rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    pub start: f64,
    pub end: f64,
    pub rule: usize,
}

/// A point off the interval at which the integrand is not analytic: its foot on the interval's
/// line, and its distance from that line.
pub type Corner = (f64, f64);

/// Stands for a missing corner.
pub const NO_CORNER: Corner = (f64::INFINITY, 0.0);

/// The fraction of a panel that is cut off at the end next to a corner.
const GRADING: f64 = 0.2;

/// Panels accepted although they are too long get eight nodes if they are shorter than this
/// fraction of half the interval.
const SHORT: f64 = 0.5;

/// No cut is made at a foot closer to an end than this fraction of the panel.
const MARGIN: f64 = 0.001;

/// Cuts the interval from `-half` to `half` into panels, which it appends to the list.
///
/// An n-point rule applied to a function that is analytic within the ellipse with the interval's
/// ends as foci converges like `rho^(-2n)`, where the ellipse's long axis is `(rho + 1 / rho) / 2`
/// interval lengths (Trefethen, *Is Gauss quadrature better than Clenshaw-Curtis?*, theorem 4.5,
/// doi:10.1137/060659831). Each panel's ellipse is the largest that stays clear of the corners; if
/// it is too small, the panel is cut at such a corner's foot or, if all feet are at or beyond an
/// end, near the end next to the nearest corner.
pub fn panels(half: f64, corners: &[Corner; 3], fineness: &Fineness, list: &mut Vec<Panel>) {
    const DEPTH: usize = 32;
    let longest = 2.0 * half * fineness.finest;
    let mut stack = [(-half, half); DEPTH];
    let mut waiting = 1;
    while waiting > 0 {
        waiting -= 1;
        let (start, end) = stack[waiting];
        let (axis, foot) = axes(corners, start, end);
        if let Some(rule) = fineness.rule(axis) {
            list.push(Panel { start, end, rule });
            continue;
        }
        let length = end - start;
        let margin = MARGIN * length;
        // The nearest of the corners that project into the panel, if it is too near.
        let inside = corners.map(|(foot, height)| {
            let inside = foot > start + margin && foot < end - margin;
            if inside { (foot, height) } else { NO_CORNER }
        });
        let (axis, inner) = axes(&inside, start, end);
        let is_foot = fineness.rule(axis).is_none();
        let at = if is_foot {
            inner
        } else if foot < (start + end) / 2.0 {
            start + GRADING * length
        } else {
            end - GRADING * length
        };
        if (!is_foot && length <= longest) || waiting + 2 > DEPTH {
            let rule = if length < SHORT * half {
                CROWDED_EIGHT
            } else {
                CROWDED_SIXTEEN
            };
            list.push(Panel { start, end, rule });
        } else {
            stack[waiting] = (start, at);
            stack[waiting + 1] = (at, end);
            waiting += 2;
        }
    }
}

/// The long axis, in lengths of the interval, of the largest ellipse around it that does not
/// contain a corner, and the foot of the corner it touches.
#[inline(always)]
fn axes(corners: &[Corner; 3], start: f64, end: f64) -> (f64, f64) {
    let (mut least, mut nearest) = (f64::INFINITY, 0.0);
    for &(foot, height) in corners {
        let squared = height * height;
        let (a, b) = (foot - start, foot - end);
        let sum = (a * a + squared).sqrt() + (b * b + squared).sqrt();
        if sum < least {
            (least, nearest) = (sum, foot);
        }
    }
    (least / (end - start), nearest)
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

    /// At a corner on the interval, unless a thousandth of a panel or less remains there.
    #[test]
    fn panels_end_at_the_feet_of_near_corners() {
        for (foot, is_cut) in [(-0.5, true), (-0.02, true), (0.7, true), (-0.9995, false)] {
            let mut list = Vec::new();
            let corners = [(foot, 0.0), NO_CORNER, NO_CORNER];
            panels(1.0, &corners, &Fineness::NORMAL, &mut list);
            let ends = list.iter().any(|panel| panel.end == foot);
            assert_eq!(ends, is_cut, "{foot}: {list:?}");
        }
    }

    #[test]
    fn the_panels_cover_the_interval_once() {
        for corner in [(0.3, 0.0), (-1.0, 1e-4), (1.5, 0.0), (0.999, 1e-9)] {
            let fineness = Fineness {
                finest: 0.01,
                ..Fineness::NORMAL
            };
            let mut list = Vec::new();
            panels(1.0, &[corner, (-0.2, 0.3), NO_CORNER], &fineness, &mut list);
            let mut list: Vec<_> = list.iter().map(|panel| (panel.start, panel.end)).collect();
            list.sort_by_key(|(start, _)| ordered_float::OrderedFloat(*start));
            assert_eq!(list[0].0, -1.0);
            assert_eq!(list[list.len() - 1].1, 1.0);
            assert!(list.windows(2).all(|pair| pair[0].1 == pair[1].0));
        }
    }
}
