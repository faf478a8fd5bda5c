//! The series of one moving magnet with several fixed ones at once, with SIMD vectors.

use nalgebra::Complex;

use super::group::Group;
use super::multipole::{Coefficients, MOST_TERMS, index};
use crate::potential::simd::lanes::Lanes;

/// Sums over pairs of magnets, in units of `-mu0 / (4 pi)`.
#[derive(Clone, Copy)]
pub struct Sums<F> {
    pub energy: F,
    /// dU/dx, dU/dy and dU/dtheta.
    pub gradient: [F; 3],
}

impl<F: Copy> Sums<F> {
    #[inline(always)]
    pub fn zero<L: Lanes<F = F>>(l: L) -> Self {
        let zero = l.splat(0.0);
        Self {
            energy: zero,
            gradient: [zero; 3],
        }
    }
}

impl<F: Copy> Sums<F> {
    /// Adds sums whose gradient is in a frame turned by `axis`.
    #[inline(always)]
    pub fn add<L: Lanes<F = F>, const SLOPE: bool>(
        &mut self,
        l: L,
        other: &Self,
        axis: Complex<f64>,
    ) {
        self.energy = l.add(self.energy, other.energy);
        if SLOPE {
            let (cos, sin) = (l.splat(axis.re), l.splat(axis.im));
            let [x, y, turn] = self.gradient;
            let [dx, dy, dturn] = other.gradient;
            self.gradient = [
                l.neg_mul_add(sin, dy, l.mul_add(cos, dx, x)),
                l.mul_add(sin, dx, l.mul_add(cos, dy, y)),
                l.add(turn, dturn),
            ];
        }
    }
}

/// Several fixed magnets and a moving one, in the frame whose x axis is the fixed ones' direction.
#[derive(Clone, Copy)]
pub struct Pairs<F> {
    /// Products of the moments (A^2 m^4).
    pub moments: F,
    /// Vector (m) from each fixed magnet to the moving one, its squared length, and the reciprocal
    /// of its length (1/m); a pair for which this is 0 adds nothing.
    pub r: [F; 2],
    pub rr: F,
    pub inverse: F,
    /// Vector (m) from the moving tile's reference point to the magnet.
    pub arm: Complex<f64>,
}

impl<F: Copy> Pairs<F> {
    /// The members of a group from `from` on, and a magnet at `place`.
    #[inline(always)]
    pub fn new<L: Lanes<F = F>>(
        l: L,
        fixed: &Group,
        from: usize,
        place: Complex<f64>,
        moment: f64,
    ) -> Self {
        let r = [
            l.sub(l.splat(place.re), l.load(&fixed.x[from..])),
            l.sub(l.splat(place.im), l.load(&fixed.y[from..])),
        ];
        let moments = l.mul(l.splat(moment), l.load(&fixed.moment[from..]));
        Self::between(l, r, moments)
    }

    /// Magnets with these vectors between them.
    #[inline(always)]
    pub fn between<L: Lanes<F = F>>(l: L, r: [F; 2], moments: F) -> Self {
        let rr = l.mul_add(r[0], r[0], l.mul(r[1], r[1]));
        Self {
            moments,
            r,
            rr,
            inverse: l.reciprocal_sqrt(rr),
            arm: Complex::new(0.0, 0.0),
        }
    }
}

/// The possible numbers of terms, ascending.
pub const STEPS: [usize; 8] = [2, 3, 4, 5, 6, 8, 10, MOST_TERMS];

/// Adds the first `terms` terms of the series, one of [`STEPS`], to the sums.
#[inline(always)]
pub fn add_terms<L: Lanes, const SLOPE: bool>(
    l: L,
    terms: usize,
    c: &Coefficients,
    pairs: &Pairs<L::F>,
    sums: &mut Sums<L::F>,
) {
    match terms {
        2 => add::<L, 2, SLOPE>(l, c, pairs, sums),
        3 => add::<L, 3, SLOPE>(l, c, pairs, sums),
        4 => add::<L, 4, SLOPE>(l, c, pairs, sums),
        5 => add::<L, 5, SLOPE>(l, c, pairs, sums),
        6 => add::<L, 6, SLOPE>(l, c, pairs, sums),
        8 => add::<L, 8, SLOPE>(l, c, pairs, sums),
        10 => add::<L, 10, SLOPE>(l, c, pairs, sums),
        _ => add::<L, MOST_TERMS, SLOPE>(l, c, pairs, sums),
    }
}

/// Adds the first `N` terms of the series to the sums.
///
/// With `v = e^(-2 i phi)` the terms are polynomials `P_k(v) = sum_l C_kl v^(l/2)` over powers of
/// r.
#[inline(always)]
fn add<L: Lanes, const N: usize, const SLOPE: bool>(
    l: L,
    c: &Coefficients,
    pairs: &Pairs<L::F>,
    sums: &mut Sums<L::F>,
) {
    let inverse = pairs.inverse;
    let q = l.mul(inverse, inverse);
    let [x, y] = pairs.r;
    // The conjugates of v^n: v = conj(r)^2 / r^2.
    let half = l.mul(l.mul(q, x), y);
    let v = [
        l.mul(q, l.neg_mul_add(y, y, l.mul(x, x))),
        l.add(half, half),
    ];
    let mut powers = [v; MOST_TERMS + 1];
    for n in 2..=N {
        powers[n] = l.complex_product(powers[n / 2], powers[n - n / 2]);
    }
    let last = polynomials::<L, SLOPE>(l, N - 1, c, &powers);
    let (mut energy, mut angular, mut turning) = (last.value, last.slope, last.turn);
    // The derivative of the energy's series by q.
    let mut bent = if N > 1 { energy } else { l.splat(0.0) };
    for k in (0..N - 1).rev() {
        let term = polynomials::<L, SLOPE>(l, k, c, &powers);
        if SLOPE {
            if k < N - 2 {
                bent = l.mul_add(bent, q, energy);
            }
            angular = l.mul_add(angular, q, term.slope);
            turning = l.mul_add(turning, q, term.turn);
        }
        energy = l.mul_add(energy, q, term.value);
    }
    let scale = l.mul(pairs.moments, l.mul(q, inverse));
    sums.energy = l.mul_add(scale, energy, sums.energy);
    if SLOPE {
        let turn = l.mul(scale, turning);
        let scale = l.mul(scale, q);
        // A power 3 + 2 k of 1 / r loses that much along r: 3 U + 2 q dU/dq.
        let change = l.mul(bent, q);
        let radial = l.mul_add(l.splat(3.0), energy, l.add(change, change));
        let (radial, angular) = (l.mul(scale, radial), l.mul(scale, angular));
        // Along r it decreases: minus the gradient.
        let fx = l.mul_add(radial, x, l.mul(angular, y));
        let fy = l.neg_mul_add(angular, x, l.mul(radial, y));
        let turn = l.neg_mul_add(l.splat(pairs.arm.re), fy, turn);
        let turn = l.mul_add(l.splat(pairs.arm.im), fx, turn);
        let [sum_x, sum_y, sum_turn] = sums.gradient;
        sums.gradient = [l.sub(sum_x, fx), l.sub(sum_y, fy), l.add(sum_turn, turn)];
    }
}

/// A term's polynomial, and its derivatives by the angles phi and beta.
struct Polynomials<F> {
    value: F,
    slope: F,
    turn: F,
}

/// Those of term `k`; derivatives are zero unless requested.
// Several arrays are walked at once.
#[allow(clippy::needless_range_loop)]
#[inline(always)]
fn polynomials<L: Lanes, const SLOPE: bool>(
    l: L,
    k: usize,
    c: &Coefficients,
    powers: &[[L::F; 2]; MOST_TERMS + 1],
) -> Polynomials<L::F> {
    let first = index(k, 0);
    let zero = l.splat(0.0);
    let mut value = l.splat(c.re[first]);
    let mut slope = zero;
    let mut turn = if SLOPE {
        l.splat(c.turn_re[first])
    } else {
        zero
    };
    for n in 1..k + 2 {
        let (at, power) = (first + n, powers[n]);
        value = real(l, power, c.re[at], c.im[at], value);
        if SLOPE {
            turn = real(l, power, c.turn_re[at], c.turn_im[at], turn);
            slope = real(l, power, c.slope_re[at], c.slope_im[at], slope);
        }
    }
    Polynomials { value, slope, turn }
}

/// The real part of `re + i im` times the conjugate of a number, and a sum.
#[inline(always)]
fn real<L: Lanes>(l: L, v: [L::F; 2], re: f64, im: f64, sum: L::F) -> L::F {
    l.mul_add(l.splat(im), v[1], l.mul_add(l.splat(re), v[0], sum))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::super::complex;
    use super::super::multipole::Multipole;
    use super::*;
    use crate::potential::cuboid::{Block, PairEnergy, cloud, series};
    use crate::potential::dipole;
    use crate::potential::simd::Level;
    use crate::potential::simd::lanes::Task;
    use crate::units::MU0_OVER_4PI;

    /// The first `N` terms of one pair.
    struct Terms<'a, const N: usize>(&'a Multipole, &'a Block, &'a Block);

    impl<const N: usize> Task for Terms<'_, N> {
        type Output = PairEnergy;

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> PairEnergy {
            let Self(series, first, second) = self;
            let axis = complex(first.axis);
            let mut group = Group::new(0, first.axis);
            group.push(0, first.position, first.moment);
            group.fill();
            let mut coefficients = Coefficients::NONE;
            let turn = complex(second.axis) * axis.conj();
            series.evaluate::<L, true>(l, turn, 0..N, &mut coefficients);
            let place = complex(second.position) * axis.conj();
            let pairs = Pairs::new(l, &group, 0, place, second.moment);
            let (mut own, mut total) = (Sums::zero(l), Sums::zero(l));
            add::<L, N, true>(l, &coefficients, &pairs, &mut own);
            total.add::<L, true>(l, &own, axis);
            let [x, y, slope] = total.gradient;
            let scale = -MU0_OVER_4PI;
            PairEnergy {
                energy: scale * l.sum(total.energy),
                gradient: Vector2::new(l.sum(x), l.sum(y)) * scale,
                slope: scale * l.sum(slope),
            }
        }
    }

    #[test]
    fn the_first_term_is_the_point_dipole() {
        let size = [0.01, 0.02, 0.03];
        let series = series(size, size);
        for level in Level::available() {
            let (first, second) = (
                Block::placed([0.1, 0.2], 0.4, size),
                Block::placed([0.3, -0.1], 2.0, size),
            );
            let got = level.run(Terms::<1>(&series, &first, &second));
            let (energy, force, slope) = dipole::pair(
                first.axis * first.moment,
                second.axis * second.moment,
                second.position - first.position,
            );
            assert!((got.energy - energy).abs() < 1e-12 * energy.abs());
            assert!((got.gradient + force).norm() < 1e-12 * force.norm());
            assert!((got.slope - slope).abs() < 1e-12 * slope.abs());
        }
    }

    fn check<const N: usize>(tolerance: f64) {
        let (one, two) = ([0.010, 0.012, 0.003], [0.006, 0.008, 0.005]);
        let series = series(one, two);
        let radius = series.radius(N, tolerance);
        for i in 0..10 {
            let first = Block::placed([0.0, 0.0], 0.5, one);
            let (sin, cos) = libm::sincos(0.37 * i as f64);
            let second = Block::placed([radius * cos, radius * sin], 1.1 * i as f64, two);
            let got = Level::best().run(Terms::<N>(&series, &first, &second));
            let exact = cloud::energy_and_gradient::<10>(&first, &second);
            let scale = MU0_OVER_4PI * 0.3 * 0.3 / radius.powi(3);
            // Room for the rounding errors of the differences of charges that cancel.
            let tolerance = tolerance + 1e-15 * (radius / 0.006).powi(2);
            assert!((got.energy - exact.energy).abs() < tolerance * scale);
            // The first omitted term decreases like the power 3 + 2 N and oscillates with that
            // order.
            let slope = (3 + 2 * N) as f64 * tolerance * scale;
            assert!((got.gradient - exact.gradient).norm() < slope / radius);
            assert!((got.slope - exact.slope).abs() < slope);
        }
    }

    #[test]
    fn the_series_agrees_with_a_cloud_of_charges_within_its_bound() {
        check::<10>(1e-5);
        check::<10>(1e-9);
        check::<5>(1e-9);
        check::<3>(1e-9);
        check::<2>(1e-6);
    }
}
