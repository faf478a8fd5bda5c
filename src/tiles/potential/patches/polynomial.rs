//! The potential of dipoles as a polynomial in a square that has none of them nearby.
//!
//! phi is interpolated at the n by n products of Chebyshev's nodes, n = [`ORDER`](super::dipoles::ORDER), in a square of
//! half side h. With I and J the interpolations along x and y, `1 - I J = (1 - I) + (1 - J) - (1 -
//! I) (1 - J)`. The n-th derivative of `1 / r` in any n directions is at most `n! / r^(n + 1)`, so
//! those of the potential of a dipole of moment m are at most `(n + 1)! m / D^(n + 2)` where it is
//! at a distance of D or more; and the k-th derivative of an interpolation's error is at most that
//! of the product `w` of the distances to the nodes, times the bound of the function's n-th
//! derivative over `n!` (Shadrin, *Error bounds for Lagrange interpolation*, J. Approx. Theory 80
//! (1995)), where `w = 2 (h / 2)^n T_n(x / h)` and thus `|w'| <= 2 (h / 2)^n n^2 / h`. With `q = h
//! / D`, the error of the slope of phi along either side is, as a fraction of `m / D^3`, at most
//!
//! ```text
//! 2 (n + 1) n^2 / q (q/2)^n + 2 (n + 1) (n + 2) (q/2)^n + 4 n^2 / q (q/2)^(2n) (2n + 1)! / n!^2
//! ```
//!
//! which decreases with D: at [`FARTHEST`](super::dipoles::FARTHEST) it is 1.7e-12, and for the energy of a pair at a
//! distance r less than 1e-11 of `mu0 m1 m2 / (4 pi r^3)`.
//!
//! The polynomial is stored by powers of `x / h` and `y / h`. For dipoles at `D >= h / FARTHEST`
//! the coefficients of Chebyshev's polynomials decrease like `10^-k`, much faster than the
//! conversion to powers increases them, like `(1 + sqrt 2)^k`; so this form does not increase
//! rounding.

use std::f64::consts::PI;

use nalgebra::{SMatrix, Vector2};

use crate::matrix::product;
use crate::potential::dipole::Dipole;
use crate::potential::groups::interpolation::nodes;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// A polynomial of `N` terms along either side, in a square.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Polynomial<const N: usize> {
    /// The coefficient of `(x / h)^i (y / h)^j` at place i of row j.
    pub rows: [[f64; N]; N],
    /// The centre of the square (m).
    pub centre: [f64; 2],
    /// `1 / h` (1/m).
    pub scale: f64,
}

/// The way from values at Chebyshev's nodes to a polynomial.
#[derive(Clone, Debug)]
pub struct Interpolation<const N: usize> {
    nodes: [f64; N],
    /// From values at the nodes to coefficients of Chebyshev's polynomials:
    /// `(2 - [k = 0]) / n cos(k (2 i + 1) pi / (2 n))`.
    to_chebyshev: SMatrix<f64, N, N>,
    /// From these to coefficients of powers, by `T_(k+1) = 2 x T_k - T_(k-1)`; whole numbers.
    to_powers: SMatrix<f64, N, N>,
}

impl<const N: usize> Interpolation<N> {
    pub fn new() -> Self {
        let to_chebyshev = SMatrix::from_fn(|k, i| {
            let weight = if k == 0 { 1.0 } else { 2.0 } / N as f64;
            weight * libm::cos(PI * (k * (2 * i + 1)) as f64 / (2 * N) as f64)
        });
        let mut to_powers = SMatrix::<f64, N, N>::zeros();
        to_powers[(0, 0)] = 1.0;
        to_powers[(1, 1)] = 1.0;
        for k in 2..N {
            for i in 0..N {
                let raised = if i > 0 {
                    to_powers[(i - 1, k - 1)]
                } else {
                    0.0
                };
                to_powers[(i, k)] = 2.0 * raised - to_powers[(i, k - 2)];
            }
        }
        let nodes = nodes(N);
        Self {
            nodes: std::array::from_fn(|i| nodes[i]),
            to_chebyshev,
            to_powers,
        }
    }

    /// The places (m) at which values are needed for a square of the given centre and half side
    /// (m): their x and their y, row by row.
    pub fn places(&self, centre: Vector2<f64>, half: f64) -> [Vec<f64>; 2] {
        let [x, y] = [centre.x, centre.y].map(|middle| self.nodes.map(|node| middle + half * node));
        let all = |place: fn(&[f64; N], &[f64; N], usize) -> f64| {
            (0..N * N).map(|k| place(&x, &y, k)).collect()
        };
        [all(|x, _, k| x[k % N]), all(|_, y, k| y[k / N])]
    }

    /// The polynomial with the values at these places.
    pub fn polynomial(&self, centre: Vector2<f64>, half: f64, values: &[f64]) -> Polynomial<N> {
        let values = SMatrix::from_column_slice(values);
        let both_ways = |change: &SMatrix<f64, N, N>, table| {
            product(&product(change, table), &change.transpose())
        };
        let coefficients = both_ways(&self.to_powers, &both_ways(&self.to_chebyshev, &values));
        Polynomial {
            rows: std::array::from_fn(|j| std::array::from_fn(|i| coefficients[(i, j)])),
            centre: centre.into(),
            scale: 1.0 / half,
        }
    }
}

/// Something whose potential is known.
pub trait Charge {
    /// Adds its potential at places (m) to a sum.
    fn add<L: Lanes>(&self, l: L, place: [L::F; 2], sum: L::F) -> L::F;
}

/// The potential of several at places (m), whose number is a multiple of [`WIDTH`].
pub struct Sampled<'a, C> {
    pub far: &'a [C],
    pub places: &'a [Vec<f64>; 2],
}

impl<C: Charge> Task for Sampled<'_, C> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Vec<f64> {
        let [x, y] = self.places;
        let mut values = vec![0.0; x.len()];
        for first in (0..values.len()).step_by(WIDTH) {
            let place = [l.load(&x[first..]), l.load(&y[first..])];
            let mut sum = l.splat(0.0);
            for charge in self.far {
                sum = charge.add(l, place, sum);
            }
            l.store(sum, &mut values[first..]);
        }
        values
    }
}

/// With moments in sqrt(J m^3), and f64 accuracy.
impl Charge for Dipole {
    #[inline(always)]
    fn add<L: Lanes>(&self, l: L, [x, y]: [L::F; 2], sum: L::F) -> L::F {
        let dx = l.sub(x, l.splat(self.position.x));
        let dy = l.sub(y, l.splat(self.position.y));
        let r2 = l.mul_add(dx, dx, l.mul(dy, dy));
        let along = l.mul(l.splat(self.moment.y), dy);
        let along = l.mul_add(l.splat(self.moment.x), dx, along);
        l.add(sum, l.div(along, l.mul(r2, l.sqrt(r2))))
    }
}

#[cfg(test)]
pub mod tests {
    use super::super::dipoles::{FARTHEST, ORDER};
    use super::*;
    use crate::potential::simd::Level;

    /// The slope of a polynomial along either side.
    fn slope<const N: usize>(polynomial: &Polynomial<N>, place: Vector2<f64>) -> Vector2<f64> {
        let at = (place - Vector2::from(polynomial.centre)) * polynomial.scale;
        let mut slope = Vector2::zeros();
        for (j, row) in polynomial.rows.iter().enumerate() {
            for (i, c) in row.iter().enumerate() {
                let power = |s: f64, k: usize| s.powi(k as i32);
                let lowered = |s: f64, k: usize| k as f64 * s.powi(k as i32 - 1);
                if i > 0 {
                    slope.x += c * lowered(at.x, i) * power(at.y, j);
                }
                if j > 0 {
                    slope.y += c * power(at.x, i) * lowered(at.y, j);
                }
            }
        }
        slope * polynomial.scale
    }

    /// The bound of this module's documentation.
    fn lost(q: f64) -> f64 {
        let n = ORDER as f64;
        let share = (q / 2.0).powi(ORDER as i32);
        // (2 n + 1)! / n!^2
        let choices: f64 = (1..=ORDER).map(|k| (ORDER + k) as f64 / k as f64).product();
        let both = 4.0 * n * n / q * share * share * choices * (2.0 * n + 1.0);
        2.0 * (n + 1.0) * (n * n / q + n + 2.0) * share + both
    }

    /// The largest error of a slope in a square of half the side q D, as a fraction of `m / D^3`, with
    /// dipoles at the distance D beside the square, before its corner and at its diagonal.
    pub fn largest_error<const N: usize>(q: f64) -> f64 {
        let (half, centre) = (0.3, Vector2::new(0.7, -0.2));
        let distance = half / q;
        let interpolation = Interpolation::<N>::new();
        let mut most = 0f64;
        for (k, level) in (0..24).flat_map(|k| Level::available().into_iter().map(move |l| (k, l)))
        {
            let (turn, corner) = (f64::from(k) * 0.26, f64::from(k % 3) / 2.0);
            let position = if corner < 1.0 {
                Vector2::new(distance + half, corner * 2.0 * half)
            } else {
                Vector2::new(1.0, 1.0) * (half + distance / 2f64.sqrt())
            };
            let moment = Vector2::new(libm::cos(turn), libm::sin(turn));
            let dipole = Dipole {
                position: position + centre,
                moment,
            };
            let (far, places) = (&[dipole], &interpolation.places(centre, half));
            let values = level.run(Sampled { far, places });
            let polynomial = interpolation.polynomial(centre, half, &values);
            for i in 0..=16 {
                for j in 0..=16 {
                    let at = [i, j].map(|k| half * (f64::from(k) / 8.0 - 1.0));
                    let place = centre + Vector2::from(at);
                    let d = place - dipole.position;
                    let r = d.norm();
                    let exact = (moment - d * (3.0 * moment.dot(&d) / (r * r))) / r.powi(3);
                    let off = (slope(&polynomial, place) - exact) * distance.powi(3);
                    most = most.max(off.amax());
                }
            }
        }
        most
    }

    /// At the smallest allowed distance and closer the error is within the bound, and somewhere close
    /// to it.
    #[test]
    fn no_more_is_lost_than_is_said() {
        for q in [FARTHEST, 0.3, 0.6] {
            let (most, rounded) = (largest_error::<ORDER>(q), 2e-13 / q);
            assert!(most <= lost(q) + rounded, "{q}: {most} {}", lost(q));
            assert!(
                q < 0.2 || most > 1e-3 * lost(q),
                "{q}: far too wide, {most} {}",
                lost(q)
            );
        }
    }
}
