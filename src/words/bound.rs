//! Upper bounds of the number of words without enumerating them: bounds of binary codes.
//!
//! With a magnet in every place, two words whose aligned mates attract by at most t contacts differ
//! in at least d = (places - t) / 2 places: they are a binary code, and so are the words and the
//! mates together where every face can meet every face. The largest number of words A(n, d) of such
//! a code is bounded by Delsarte's linear program over the distances,
//!
//! ```text
//! most 1 + sum_i A_i   with   sum_i A_i K_k(i) >= -C(n, k) for k = 1 .. n,   A_i >= 0,
//! ```
//!
//! K_k(i) being the Krawtchouk polynomials, with two additional families of conditions: A_i is at
//! most A(n, d, i), the number of words of weight i, bounded by Johnson; and words of two weights
//! that are never d apart exclude each other. The dual is solved: its multipliers, once checked,
//! prove the bound independently of the solver.
//!
//! Source: MacWilliams and Sloane, *The Theory of Error-Correcting Codes* (1977), chapter 17, §4
//! (A(13, 6) <= 32) and §2 (Johnson).

use microlp::{ComparisonOp, OptimizationDirection, Problem};

/// An upper bound of A(n, d): the number of binary words of n places of which any two differ in at
/// least d. For n up to 63.
pub fn binary_code(n: usize, d: usize) -> usize {
    if d <= 1 {
        return 1usize.checked_shl(n as u32).unwrap_or(usize::MAX);
    }
    if d > n {
        return 1;
    }
    // A(n, d) = A(n + 1, d + 1) for odd d, by a parity bit; even distances alone are left.
    let (n, d) = (n + d % 2, d + d % 2);
    let shorter = 2usize.saturating_mul(match n > d {
        true => binary_code(n - 1, d),
        false => 1,
    });
    delsarte(n, d).map_or(shorter, |bound| bound.min(shorter))
}

/// Delsarte's bound for even d; `None` if the solver fails.
fn delsarte(n: usize, d: usize) -> Option<usize> {
    let distances: Vec<usize> = (d..=n).step_by(2).collect();
    let extra = conditions(n, d, &distances);
    let mut problem = Problem::new(OptimizationDirection::Minimize);
    let polynomials: Vec<usize> = (1..=n / 2).collect();
    let by_polynomial: Vec<_> = polynomials
        .iter()
        .map(|_| problem.add_var(1.0, (0.0, f64::INFINITY)))
        .collect();
    let by_condition: Vec<_> = extra
        .iter()
        .map(|(_, bound)| problem.add_var(*bound, (0.0, f64::INFINITY)))
        .collect();
    let coefficients = |i: usize| {
        let distance = distances[i];
        let first = polynomials.iter().map(move |k| -ratio(n, *k, distance));
        first.chain(extra.iter().map(move |(weights, _)| weights[i]))
    };
    for i in 0..distances.len() {
        let variables = by_polynomial.iter().chain(&by_condition).copied();
        let terms: Vec<_> = variables.zip(coefficients(i)).collect();
        problem.add_constraint(terms.as_slice(), ComparisonOp::Ge, 1.0);
    }
    let solution = problem.solve().ok()?.into_solution().ok()?;
    let multipliers: Vec<f64> = by_polynomial
        .iter()
        .chain(&by_condition)
        .map(|variable| solution.var_value(*variable).max(0.0))
        .collect();
    // Any multipliers prove a bound once they are scaled so that every condition holds.
    let held = (0..distances.len()).map(|i| {
        let terms = multipliers.iter().zip(coefficients(i));
        terms
            .map(|(multiplier, coefficient)| multiplier * coefficient)
            .sum::<f64>()
    });
    let held = held.fold(f64::INFINITY, f64::min);
    let costs = std::iter::repeat_n(1.0, polynomials.len());
    let costs = costs.chain(extra.iter().map(|(_, bound)| *bound));
    let cost: f64 = multipliers.iter().zip(costs).map(|(m, c)| m * c).sum();
    let bound = 1.0 + cost / held;
    // The rounding of sums of a few dozen terms is far below this.
    let margin = 1e-7 * bound;
    (held > 0.0 && bound < 1e15).then(|| (bound + margin).floor() as usize)
}

/// `K_k(i) / C(n, k)`, between -1 and 1: the mean of (-1)^m over the chosen places, m the number of
/// them among i.
fn ratio(n: usize, k: usize, i: usize) -> f64 {
    let hit = |j: usize| {
        choose(i, j) * choose(n - i, k - j) * if j.is_multiple_of(2) { 1.0 } else { -1.0 }
    };
    (0..=k.min(i))
        .filter(|j| k - j <= n - i)
        .map(hit)
        .sum::<f64>()
        / choose(n, k)
}

fn choose(n: usize, k: usize) -> f64 {
    (0..k).map(|j| (n - j) as f64 / (k - j) as f64).product()
}

/// Conditions `sum_i weights_i A_i <= bound` beside Delsarte's.
fn conditions(n: usize, d: usize, distances: &[usize]) -> Vec<(Vec<f64>, f64)> {
    let mosts: Vec<f64> = distances
        .iter()
        .map(|w| constant_weight(n, d, *w))
        .collect();
    let unit = |i: usize, value: f64| {
        let mut weights = vec![0.0; distances.len()];
        weights[i] = value;
        weights
    };
    let mut all: Vec<_> = (0..distances.len())
        .map(|i| (unit(i, 1.0 / mosts[i]), 1.0))
        .collect();
    for (j, w) in distances.iter().enumerate() {
        for i in 0..j {
            let v = distances[i];
            // The largest distance of words of the two weights.
            if (v + w).min(2 * n - v - w) < d {
                let mut weights = unit(i, 1.0 / mosts[i]);
                weights[j] = 1.0 / mosts[j];
                all.push((weights, 1.0));
            }
        }
    }
    all
}

/// An upper bound of A(n, d, w), for even d: words of weight w.
fn constant_weight(n: usize, d: usize, w: usize) -> f64 {
    let w = w.min(n - w);
    if 2 * w < d {
        return 1.0;
    }
    let by_ones = (n as f64 / w as f64 * constant_weight(n - 1, d, w - 1)).floor();
    // Plotkin's argument: places in common are d/2 too few.
    let (half, excess) = (d as f64 / 2.0, (w * w) as f64 - (w * n) as f64);
    let room = excess + half * n as f64;
    match room > 0.0 {
        true => by_ones.min((half * n as f64 / room + 1e-9).floor()),
        false => by_ones,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn krawtchouk_polynomials() {
        // K_1(i) = n - 2 i; K_2(i) = ((n - 2 i)^2 - n) / 2.
        for i in 0..=7 {
            let line = 7.0 - 2.0 * i as f64;
            assert!((ratio(7, 1, i) * 7.0 - line).abs() < 1e-12);
            assert!((ratio(7, 2, i) * 21.0 - (line * line - 7.0) / 2.0).abs() < 1e-12);
        }
    }

    /// Brouwer's table of A(n, d, w), <https://www.win.tue.nl/~aeb/codes/Andw.html>.
    #[test]
    fn bounds_of_codes_of_one_weight() {
        for (n, d, w, size) in [
            (6, 4, 3, 4.0),
            (7, 4, 3, 7.0),
            (8, 4, 4, 14.0),
            (9, 4, 3, 12.0),
            (11, 6, 5, 11.0),
            (12, 6, 6, 22.0),
            (10, 8, 4, 2.0),
        ] {
            assert_eq!(constant_weight(n, d, w), size, "A({n}, {d}, {w})");
        }
    }

    /// Brouwer's table of A(n, d), <https://www.win.tue.nl/~aeb/codes/binary-1.html>: no bound may
    /// lie below it, and these are equal to it.
    #[test]
    fn bounds_of_codes() {
        for (n, d, size) in [
            (5, 3, 4),
            (6, 3, 8),
            (7, 3, 16),
            (8, 4, 16),
            (9, 5, 6),
            (10, 5, 12),
            (11, 5, 24),
            (12, 5, 32),
            (12, 6, 24),
            (15, 7, 32),
            (8, 5, 4),
            (7, 7, 2),
            (6, 2, 32),
        ] {
            assert_eq!(binary_code(n, d), size, "A({n}, {d})");
        }
        for (n, d, size) in [
            (8, 3, 20),
            (9, 3, 40),
            (10, 3, 72),
            (11, 3, 144),
            (12, 4, 144),
            (13, 5, 64),
            (14, 5, 128),
            (16, 6, 256),
            (16, 3, 2720),
        ] {
            assert!(binary_code(n, d) >= size, "A({n}, {d})");
        }
    }
}
