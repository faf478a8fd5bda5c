//! The far form of one moving block with several fixed blocks at once, with SIMD vectors.

use nalgebra::{Complex, Vector2};

use super::SizedBlock;
use super::block::Block;
use super::multipole::{Coefficients, TERMS, index};
use crate::potential::simd::lanes::{Lanes, fill};

/// Sums over pairs of blocks, in units of `-mu0 / (4 pi)`.
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

/// Several fixed blocks and a moving one, in the frame whose x axis is the fixed blocks' axis.
#[derive(Clone, Copy)]
pub struct Pairs<F> {
    /// Products of the moments (A^2 m^4).
    pub moments: F,
    /// Vector (m) from each fixed block to the moving one, and its squared length.
    pub r: [F; 2],
    pub rr: F,
    /// Vector (m) from the moving tile's reference point to the block.
    pub arm: Complex<f64>,
}

impl<F: Copy> Pairs<F> {
    /// The members of a group from `from` on, and a block at `place`.
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
        Self {
            moments: l.mul(l.splat(moment), l.load(&fixed.moment[from..])),
            r,
            rr: l.mul_add(r[0], r[0], l.mul(r[1], r[1])),
            arm: Complex::new(0.0, 0.0),
        }
    }
}

/// The possible numbers of terms, ascending.
pub const STEPS: [usize; 6] = [2, 3, 4, 5, 6, TERMS];

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
        _ => add::<L, TERMS, SLOPE>(l, c, pairs, sums),
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
    let r = pairs.r;
    let inverse = l.reciprocal_sqrt(pairs.rr);
    let q = l.mul(inverse, inverse);
    // v = conj(r)^2 / r^2.
    let xy = l.mul(l.mul(q, r[0]), r[1]);
    let v = [
        l.mul(q, l.neg_mul_add(r[1], r[1], l.mul(r[0], r[0]))),
        l.mul(l.splat(-2.0), xy),
    ];
    // v^n and, if requested, n v^n.
    let zero = l.splat(0.0);
    let mut powers = [[zero; 2]; TERMS + 1];
    let mut slopes = [[zero; 2]; TERMS + 1];
    powers[1] = v;
    for n in 2..=N {
        powers[n] = product(l, powers[n / 2], powers[n - n / 2]);
    }
    if SLOPE {
        for n in 1..=N {
            let order = l.splat(n as f64);
            slopes[n] = [l.mul(order, powers[n][0]), l.mul(order, powers[n][1])];
        }
    }
    let (mut energy, mut radial, mut angular, mut turning) = (zero, zero, zero, zero);
    for k in (0..N).rev() {
        let first = index(k, 0);
        let mut value = l.splat(c.re[first]);
        let mut turn = l.splat(c.turn_re[first]);
        let mut slope = zero;
        for n in 1..k + 2 {
            let [re, im] = [l.splat(c.re[first + n]), l.splat(c.im[first + n])];
            value = real(l, powers[n], re, im, value);
            if SLOPE {
                // The imaginary part of C n v^n.
                slope = l.mul_add(re, slopes[n][1], l.mul_add(im, slopes[n][0], slope));
                let (re, im) = (c.turn_re[first + n], c.turn_im[first + n]);
                turn = real(l, powers[n], l.splat(re), l.splat(im), turn);
            }
        }
        energy = l.mul_add(energy, q, value);
        if SLOPE {
            radial = l.mul_add(value, l.splat(-((3 + 2 * k) as f64)), l.mul(radial, q));
            angular = l.mul_add(slope, l.splat(2.0), l.mul(angular, q));
            turning = l.mul_add(turning, q, turn);
        }
    }
    let scale = l.mul(pairs.moments, l.mul(q, inverse));
    sums.energy = l.mul_add(scale, energy, sums.energy);
    if SLOPE {
        let turn = l.mul(scale, turning);
        let scale = l.mul(scale, q);
        let (radial, angular) = (l.mul(scale, radial), l.mul(scale, angular));
        let gx = l.neg_mul_add(angular, r[1], l.mul(radial, r[0]));
        let gy = l.mul_add(angular, r[0], l.mul(radial, r[1]));
        let turn = l.mul_add(l.splat(pairs.arm.re), gy, turn);
        let turn = l.neg_mul_add(l.splat(pairs.arm.im), gx, turn);
        let [x, y, t] = sums.gradient;
        sums.gradient = [l.add(x, gx), l.add(y, gy), l.add(t, turn)];
    }
}

/// The product of two complex numbers.
#[inline(always)]
fn product<L: Lanes>(l: L, a: [L::F; 2], b: [L::F; 2]) -> [L::F; 2] {
    [
        l.neg_mul_add(a[1], b[1], l.mul(a[0], b[0])),
        l.mul_add(a[1], b[0], l.mul(a[0], b[1])),
    ]
}

/// The real part of `(re + i im) v`, and a sum.
#[inline(always)]
fn real<L: Lanes>(l: L, v: [L::F; 2], re: L::F, im: L::F, sum: L::F) -> L::F {
    l.neg_mul_add(im, v[1], l.mul_add(re, v[0], sum))
}

/// The weakness of padding blocks.
const NO_MOMENT: f64 = 1e60;

/// The squared distance (m^2) of padding blocks.
pub const AWAY: f64 = 1e12;

/// Fixed blocks of one size and one axis (up to its sign), as a structure of arrays padded to a
/// multiple of the number of lanes with blocks without moment.
#[derive(Clone, Debug)]
pub struct Group {
    /// The index of the size.
    pub size: usize,
    /// The axis of all of them.
    pub axis: Complex<f64>,
    /// Which of the tile's blocks they are; empty if they replace others.
    pub members: Vec<usize>,
    /// Their number, without the padding.
    pub count: usize,
    /// Places (m) in the frame whose x axis is the axis.
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// Moments (A m^2), negative where a block points against the axis.
    pub moment: Vec<f64>,
    /// Their magnitudes to the power -2/3; multiplied by the squared distance, this is smaller for
    /// stronger pairs.
    pub weakness: Vec<f64>,
    /// The largest magnitude.
    pub strongest: f64,
}

impl Group {
    /// A group without blocks.
    pub fn new(size: usize, axis: Vector2<f64>) -> Self {
        Self {
            size,
            axis: Complex::new(axis.x, axis.y),
            members: Vec::new(),
            count: 0,
            x: Vec::new(),
            y: Vec::new(),
            moment: Vec::new(),
            weakness: Vec::new(),
            strongest: 0.0,
        }
    }

    /// Adds a block, pointing along the axis (sign 1) or against it (-1).
    pub fn push(&mut self, member: usize, position: Vector2<f64>, moment: f64) {
        self.members.push(member);
        self.push_stand(position, moment);
    }

    /// Adds a block that replaces others.
    pub fn push_stand(&mut self, position: Vector2<f64>, moment: f64) {
        let place = Complex::new(position.x, position.y) * self.axis.conj();
        self.count += 1;
        self.x.push(place.re);
        self.y.push(place.im);
        self.moment.push(moment);
        // For a block without moment, large enough to be far from all others.
        let weakness = libm::pow(moment.abs(), -2.0 / 3.0);
        self.weakness.push(weakness.min(NO_MOMENT));
        self.strongest = self.strongest.max(moment.abs());
    }

    /// Block number `at` of the group, of the tile's blocks: with the group's axis and the moment
    /// along it.
    #[inline(always)]
    pub fn block(&self, blocks: &[SizedBlock], at: usize) -> Block {
        Block {
            axis: Vector2::new(self.axis.re, self.axis.im),
            moment: self.moment[at],
            ..blocks[self.members[at]].block
        }
    }

    /// Pads to whole vectors.
    pub fn fill(&mut self) {
        // Far from everything, so that padding never counts as near.
        fill(&mut self.x, AWAY.sqrt());
        fill(&mut self.y, 0.0);
        fill(&mut self.moment, 0.0);
        fill(&mut self.weakness, NO_MOMENT);
    }
}

#[cfg(test)]
mod tests {
    use super::super::block::PairEnergy;
    use super::super::multipole::Multipole;
    use super::*;
    use crate::potential::cuboid::cloud;
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
            let complex = |v: Vector2<f64>| Complex::new(v.x, v.y);
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
        let series = Multipole::new(size, size);
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
        let series = Multipole::new(one, two);
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
        check::<TERMS>(1e-5);
        check::<TERMS>(1e-9);
        check::<5>(1e-9);
        check::<3>(1e-9);
        check::<2>(1e-6);
    }
}
