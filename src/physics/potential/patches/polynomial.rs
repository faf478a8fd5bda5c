//! The potential of dipoles as a polynomial in a square that has none of them nearby.
//!
//! phi is interpolated at the n by n products of Chebyshev's nodes, n = [`ORDER`], in a square of
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
//! which decreases with D: at [`FARTHEST`] it is 1.7e-12, and for the energy of a pair at a
//! distance r less than 1e-11 of `mu0 m1 m2 / (4 pi r^3)`.
//!
//! The polynomial is stored by powers of `x / h` and `y / h`. For dipoles at `D >= h / FARTHEST`
//! the coefficients of Chebyshev's polynomials decrease like `10^-k`, much faster than the
//! conversion to powers increases them, like `(1 + sqrt 2)^k`; so this form does not increase
//! rounding.

use std::f64::consts::PI;
use std::sync::LazyLock;

use nalgebra::{SMatrix, Vector2};

use crate::matrix::product;
use crate::potential::dipole::Dipole;
use crate::potential::groups::interpolation::nodes;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};

/// Number of terms of the polynomial along either side.
pub const ORDER: usize = 16;

/// The largest ratio of a square's half side to the distance of a dipole at which the dipole's
/// potential is part of the polynomial.
pub const FARTHEST: f64 = 3.0 / 16.0;

type Table = SMatrix<f64, ORDER, ORDER>;

/// A polynomial in a square.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Polynomial {
    /// The coefficient of `(x / h)^i (y / h)^j` at place i of row j.
    pub rows: [[f64; ORDER]; ORDER],
    /// The centre of the square (m).
    pub centre: [f64; 2],
    /// `1 / h` (1/m).
    pub scale: f64,
}

impl Polynomial {
    /// The polynomial of the potential of dipoles (moments in sqrt(J m^3)) in the square of the
    /// given centre and half side (m).
    pub fn of(far: &[Dipole], centre: Vector2<f64>, half: f64, level: Level) -> Self {
        let nodes = nodes(ORDER);
        let xs = std::array::from_fn(|i| centre.x + half * nodes[i]);
        let mut values = Table::zeros();
        for (j, node) in nodes.iter().enumerate() {
            let mut row = [0.0; ORDER];
            level.run(Sampled {
                far,
                xs: &xs,
                y: centre.y + half * node,
                out: &mut row,
            });
            for (i, value) in row.into_iter().enumerate() {
                values[(i, j)] = value;
            }
        }
        let both_ways =
            |change: &Table, table| product(&product(change, table), &change.transpose());
        let coefficients = both_ways(&TO_POWERS, &both_ways(&TO_CHEBYSHEV, &values));
        Self {
            rows: std::array::from_fn(|j| std::array::from_fn(|i| coefficients[(i, j)])),
            centre: centre.into(),
            scale: 1.0 / half,
        }
    }
}

/// From values at the nodes to coefficients of Chebyshev's polynomials:
/// `(2 - [k = 0]) / n cos(k (2 i + 1) pi / (2 n))`.
static TO_CHEBYSHEV: LazyLock<Table> = LazyLock::new(|| {
    Table::from_fn(|k, i| {
        let weight = if k == 0 { 1.0 } else { 2.0 } / ORDER as f64;
        weight * libm::cos(PI * (k * (2 * i + 1)) as f64 / (2 * ORDER) as f64)
    })
});

/// From these to coefficients of powers, by `T_(k+1) = 2 x T_k - T_(k-1)`; whole numbers.
static TO_POWERS: LazyLock<Table> = LazyLock::new(|| {
    let mut table = Table::zeros();
    table[(0, 0)] = 1.0;
    table[(1, 1)] = 1.0;
    for k in 2..ORDER {
        for i in 0..ORDER {
            let raised = if i > 0 { table[(i - 1, k - 1)] } else { 0.0 };
            table[(i, k)] = 2.0 * raised - table[(i, k - 2)];
        }
    }
    table
});

/// The potential of dipoles (moments in sqrt(J m^3)) at places of a row, with f64 accuracy.
struct Sampled<'a> {
    far: &'a [Dipole],
    /// The places' x, and the y of all (m).
    xs: &'a [f64; ORDER],
    y: f64,
    out: &'a mut [f64; ORDER],
}

impl Task for Sampled<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        for first in (0..ORDER).step_by(WIDTH) {
            let x = l.load(&self.xs[first..]);
            let mut sum = l.splat(0.0);
            for source in self.far {
                let dx = l.sub(x, l.splat(source.position.x));
                let dy = l.splat(self.y - source.position.y);
                let r2 = l.mul_add(dx, dx, l.mul(dy, dy));
                let along = l.mul(l.splat(source.moment.y), dy);
                let along = l.mul_add(l.splat(source.moment.x), dx, along);
                sum = l.add(sum, l.div(along, l.mul(r2, l.sqrt(r2))));
            }
            l.store(sum, &mut self.out[first..]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slope of a polynomial along either side.
    fn slope(polynomial: &Polynomial, place: Vector2<f64>) -> Vector2<f64> {
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

    /// Dipoles beside a square, before its corner and at its diagonal, at the smallest allowed
    /// distance and closer: inside the square the error is within the bound, and somewhere close to
    /// it.
    #[test]
    fn no_more_is_lost_than_is_said() {
        let half = 0.3;
        for q in [FARTHEST, 0.3, 0.6] {
            let distance = half / q;
            let mut most = 0f64;
            for (k, level) in
                (0..24).flat_map(|k| Level::available().into_iter().map(move |l| (k, l)))
            {
                let (turn, corner) = (f64::from(k) * 0.26, f64::from(k % 3) / 2.0);
                let way = Vector2::new(distance, 0.0);
                let diagonal = Vector2::new(1.0, 1.0) * (distance / 2f64.sqrt());
                let position = if corner < 1.0 {
                    way + Vector2::new(half, corner * 2.0 * half)
                } else {
                    diagonal + Vector2::new(half, half)
                };
                let moment = Vector2::new(libm::cos(turn), libm::sin(turn));
                let centre = Vector2::new(0.7, -0.2);
                let dipole = Dipole {
                    position: position + centre,
                    moment,
                };
                let polynomial = Polynomial::of(&[dipole], centre, half, level);
                for i in 0..=16 {
                    for j in 0..=16 {
                        let at = [i, j].map(|k| half * (f64::from(k) / 8.0 - 1.0));
                        let place = centre + Vector2::from(at);
                        let d = place - dipole.position;
                        let r = d.norm();
                        let exact = (moment - d * (3.0 * moment.dot(&d) / (r * r))) / r.powi(3);
                        let off = (slope(&polynomial, place) - exact) * distance.powi(3);
                        let rounded = 2e-13 / q;
                        assert!(
                            off.amax() <= lost(q) + rounded,
                            "{q}: {} {}",
                            off.amax(),
                            lost(q)
                        );
                        most = most.max(off.amax());
                    }
                }
            }
            assert!(
                q < 0.2 || most > 1e-3 * lost(q),
                "{q}: far too wide, {most} {}",
                lost(q)
            );
        }
    }
}
