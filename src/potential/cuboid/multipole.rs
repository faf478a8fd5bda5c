//! The far form of a pair of blocks: the multipole series of their interaction.
//!
//! Averaging point dipoles over a block of size L along its axis, W across it and c through the
//! thickness is the operator `S = sinhc(L d_a / 2) sinhc(W d_t / 2) sinhc(c d_z / 2)`, with
//! `sinhc(u) = sinh(u) / u = sum u^(2k) / (2k + 1)!` and `d_a`, `d_t`, `d_z` the derivatives along
//! the three edges. Two blocks with moments m1, m2 hence have the energy
//!
//! ```text
//! U = -mu0 m1 m2 / (4 pi)  S1 d_a1  S2 d_a2  (1 / r)         (J)
//! ```
//!
//! In the plane z = 0, with `w = x + i y`, `P = d/dw` and `Q = d/d(conj w)`, the derivative along
//! the direction alpha is `e^(i alpha) P + e^(-i alpha) Q`, the Laplace equation makes
//! `d_z^2 = -4 P Q`, and
//!
//! ```text
//! P^M Q^N (1 / r) = (-1)^(M+N) (1/2)_M (1/2)_N r^(-1-M-N) e^(-i (M-N) phi)
//! ```
//!
//! with rising factorials `(1/2)_M`. Collecting powers, with beta = alpha2 - alpha1 and phi
//! measured from the first block's axis:
//!
//! ```text
//! U = -mu0 m1 m2 / (4 pi)  sum_k r^(-3-2k) Re sum_l C_kl(beta) e^(-i l phi),   l = 0, 2 .. 2k+2
//! C_kl(beta) = sum_l' T_kll' e^(i l' beta),                           l' = -2k-1, -2k+1 .. 2k+1
//! ```
//!
//! Term k = 0 is the point dipole; term k falls like `r^(-3-2k)`. The numbers T depend on the two
//! sizes alone. Their absolute sum over l and l', `A_k`, bounds term k at every angle, so the
//! error of leaving terms out is bounded by the A_k left out.

use std::f64::consts::PI;

use super::block::{Block, PairEnergy};
use crate::units::MU0;
use nalgebra::{Complex, Vector2};

/// Terms of the series that are summed, the dipole included.
pub const TERMS: usize = 8;

/// Terms of the series that enter the bound of the error.
const BOUND_TERMS: usize = 16;

/// A homogeneous real polynomial in P and Q; entry m is the coefficient of P^m Q^(degree-m).
type Form = Vec<f64>;

fn product(a: &[f64], b: &[f64]) -> Form {
    let mut out = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] += x * y;
        }
    }
    out
}

/// The terms of degree 1, 3, 5 .. of `S d_a`, in the block's own directions.
fn block_forms(size: [f64; 3], count: usize) -> Vec<Form> {
    let squares: [Form; 3] = [
        vec![1.0, 2.0, 1.0],
        vec![-1.0, 2.0, -1.0],
        vec![0.0, -4.0, 0.0],
    ];
    let mut forms: Vec<Form> = vec![vec![1.0]];
    forms.resize_with(count, Vec::new);
    for k in 1..count {
        forms[k] = vec![0.0; 2 * k + 1];
    }
    for (square, length) in squares.iter().zip(size) {
        let mut powers: Vec<Form> = vec![vec![1.0]];
        for k in 1..count {
            let k = k as f64;
            let factor = length * length / (4.0 * (2.0 * k) * (2.0 * k + 1.0));
            let next = product(powers.last().expect("never empty"), square);
            powers.push(next.iter().map(|x| x * factor).collect());
        }
        for k in (0..count).rev() {
            let mut sum = vec![0.0; 2 * k + 1];
            for j in 0..=k {
                for (total, x) in sum.iter_mut().zip(product(&forms[j], &powers[k - j])) {
                    *total += x;
                }
            }
            forms[k] = sum;
        }
    }
    forms
        .iter()
        .map(|form| product(form, &[1.0, 1.0]))
        .collect()
}

/// The rising factorial (1/2)_n.
fn rising_half(n: usize) -> f64 {
    (0..n).map(|i| i as f64 + 0.5).product()
}

/// The series of two block sizes.
#[derive(Clone, Debug)]
pub struct Multipole {
    /// T_kll' of the terms summed: `coefficients[k][l / 2][(l' + 2k + 1) / 2]`.
    coefficients: Vec<Vec<Vec<f64>>>,
    /// A_k (m^(2k)), longer than the coefficients.
    magnitudes: Vec<f64>,
}

impl Multipole {
    pub fn new(first: [f64; 3], second: [f64; 3]) -> Self {
        let (a, b) = (
            block_forms(first, BOUND_TERMS),
            block_forms(second, BOUND_TERMS),
        );
        let all: Vec<_> = (0..BOUND_TERMS).map(|k| term(&a, &b, k)).collect();
        let magnitudes = all
            .iter()
            .map(|rows| rows.iter().flatten().map(|x| x.abs()).sum())
            .collect();
        Self {
            coefficients: all.into_iter().take(TERMS).collect(),
            magnitudes,
        }
    }

    /// The distance (m) from which on the terms left out are together below `tolerance` times
    /// `mu0 m1 m2 / (4 pi r^3)`.
    pub fn radius(&self, tolerance: f64) -> f64 {
        let error = |r: f64| -> f64 {
            (TERMS..BOUND_TERMS)
                .map(|k| self.magnitudes[k] * r.powi(-2 * k as i32))
                .sum()
        };
        let (mut low, mut high) = (1e-9, 1e-9);
        while error(high) > tolerance {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..40 {
            let middle = (low + high) / 2.0;
            if error(middle) > tolerance {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Energy, gradient and slope of two blocks of these sizes.
    pub fn energy_and_gradient(&self, first: &Block, second: &Block) -> PairEnergy {
        let axis = Complex::new(first.axis.x, first.axis.y);
        let turn = Complex::new(second.axis.x, second.axis.y) * axis.conj();
        let r = second.position - first.position;
        let q = 1.0 / r.norm_squared();
        let w = Complex::new(r.x, r.y) * axis.conj();
        let v = w.conj() * w.conj() * q;
        let scale = -MU0 / (4.0 * PI) * first.moment * second.moment * q * q.sqrt();
        let (mut value, mut radial, mut angular, mut turning) = (0.0, 0.0, 0.0, 0.0);
        let mut power = scale;
        for (k, rows) in self.coefficients.iter().enumerate() {
            let mut phase = Complex::new(1.0, 0.0);
            for (l, row) in rows.iter().enumerate() {
                let (c, c_turn) = evaluate(row, turn, k);
                let term = c * phase;
                value += power * term.re;
                radial -= power * (3 + 2 * k) as f64 * term.re;
                angular += power * (2 * l) as f64 * term.im;
                turning += power * (c_turn * phase).re;
                phase *= v;
            }
            power *= q;
        }
        PairEnergy {
            energy: value,
            gradient: (r * radial + Vector2::new(-r.y, r.x) * angular) * q,
            slope: turning,
        }
    }
}

/// C_kl and its derivative by beta.
fn evaluate(row: &[f64], turn: Complex<f64>, k: usize) -> (Complex<f64>, Complex<f64>) {
    let mut phase = turn.conj().powu(2 * k as u32 + 1);
    let step = turn * turn;
    let (mut value, mut slope) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
    for (j, t) in row.iter().enumerate() {
        let order = 2.0 * j as f64 - (2 * k + 1) as f64;
        value += phase * *t;
        slope += Complex::new(0.0, order * t) * phase;
        phase *= step;
    }
    (value, slope)
}

/// The coefficients T_kll' of term `k`, folded onto l >= 0.
fn term(first: &[Form], second: &[Form], k: usize) -> Vec<Vec<f64>> {
    let mut rows = vec![vec![0.0; 2 * k + 2]; k + 2];
    for j in 0..=k {
        let (a, b) = (&first[j], &second[k - j]);
        for (m1, x) in a.iter().enumerate() {
            for (m2, y) in b.iter().enumerate() {
                let (p, q) = (m1 + m2, a.len() + b.len() - 2 - m1 - m2);
                if p < q {
                    continue;
                }
                // m2 - n2 + 2k + 1, halved, with m2 + n2 = b.len() - 1.
                let turns = (2 * m2 + 2 * k + 2 - b.len()) / 2;
                let fold = if p == q { 1.0 } else { 2.0 };
                rows[(p - q) / 2][turns] += fold * x * y * rising_half(p) * rising_half(q);
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::potential::{cuboid::cloud, dipole};

    fn block(x: f64, y: f64, angle: f64, size: [f64; 3]) -> Block {
        Block {
            position: Vector2::new(x, y),
            axis: Vector2::new(angle.cos(), angle.sin()),
            moment: 0.3,
            size,
        }
    }

    #[test]
    fn blocks_of_no_size_are_point_dipoles() {
        let small = [1e-7, 2e-7, 3e-7];
        let (first, second) = (block(0.1, 0.2, 0.4, small), block(0.3, -0.1, 2.0, small));
        let got = Multipole::new(small, small).energy_and_gradient(&first, &second);
        let (energy, force, slope) = dipole::pair(
            first.axis * first.moment,
            second.axis * second.moment,
            second.position - first.position,
        );
        assert!((got.energy - energy).abs() < 1e-12 * energy.abs());
        assert!((got.gradient + force).norm() < 1e-12 * force.norm());
        assert!((got.slope - slope).abs() < 1e-12 * slope.abs());
    }

    #[test]
    fn the_series_agrees_with_a_cloud_of_charges_within_its_bound() {
        let (one, two) = ([0.010, 0.012, 0.003], [0.006, 0.008, 0.005]);
        let series = Multipole::new(one, two);
        for tolerance in [1e-4, 1e-6, 1e-9] {
            let radius = series.radius(tolerance);
            for i in 0..10 {
                let direction = 0.37 * i as f64;
                let first = block(0.0, 0.0, 0.5, one);
                let second = block(
                    radius * direction.cos(),
                    radius * direction.sin(),
                    1.1 * i as f64,
                    two,
                );
                let got = series.energy_and_gradient(&first, &second);
                let exact = cloud::energy_and_gradient(&first, &second, 10);
                let scale = 1e-7 * 0.3 * 0.3 / radius.powi(3);
                assert!((got.energy - exact.energy).abs() < tolerance * scale);
                // The first term left out falls like r^-19.
                let gradient = 19.0 * tolerance * scale / radius;
                assert!((got.gradient - exact.gradient).norm() < gradient);
                assert!((got.slope - exact.slope).abs() < 19.0 * tolerance * scale);
            }
        }
    }
}
