//! Second and third derivatives of the energy of two magnets by their series.
//!
//! With `w = r e^(i phi)` from the first to the second magnet, in the frame whose x axis is the first one's
//! direction, a term of the series is `w^-mu conj(w)^-nu`, `mu = (n + l) / 2`, `nu = (n - l) / 2`, `n = 2 k +
//! 3`. By w it has the derivative `-mu / w` times itself, and so on: a times by w and b times by its conjugate
//!
//! ```text
//! (-1)^(a+b) (mu)_a (nu)_b w^-a conj(w)^-b,
//! ```
//!
//! with rising factorials; by the angle beta between the magnets, C_kl has derivatives of its own ([`AngleDerivatives`]).
//! For a sum S of terms T the derivatives of its real part hence are `(S_ab + conj(S_ba)) / 2`, which is the same
//! power of w times
//!
//! ```text
//! sum f+ Re T + i f- Im T,    f+- = ((mu)_a (nu)_b +- (mu)_b (nu)_a) / 2.
//! ```

use nalgebra::Complex;

use super::multipole::{MOST_TERMS, Multipole, ROOM, index};
use super::rows::Known;
use crate::potential::simd::lanes::{Lanes, Task, WIDTH};
use crate::units::MU0_OVER_4PI;

/// The second and third derivatives of C_kl by beta, of the terms that are known: real and imaginary parts.
#[derive(Clone, Debug)]
pub struct AngleDerivatives {
    parts: [[[f64; ROOM]; 2]; 2],
    terms: usize,
}

/// How often a term is derived by w and by its conjugate.
const ORDERS: [(usize, usize); 6] = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (3, 0)];

/// f+ and f- of each term, for each of [`ORDERS`].
static FACTORS: [[[f64; ROOM]; 2]; ORDERS.len()] = {
    const fn rising(from: f64, count: usize) -> f64 {
        let mut all = 1.0;
        let mut i = 0;
        while i < count {
            all *= from + i as f64;
            i += 1;
        }
        all
    }
    let mut factors = [[[0.0; ROOM]; 2]; ORDERS.len()];
    let mut k = 0;
    while k < MOST_TERMS {
        let mut half = 0;
        while half < k + 2 {
            let (mu, nu) = ((k + half) as f64 + 1.5, k as f64 + 1.5 - half as f64);
            let mut i = 0;
            while i < ORDERS.len() {
                let (a, b) = ORDERS[i];
                let one = rising(mu, a) * rising(nu, b);
                let other = rising(mu, b) * rising(nu, a);
                factors[i][0][index(k, half)] = 0.5 * (one + other);
                factors[i][1][index(k, half)] = 0.5 * (one - other);
                i += 1;
            }
            half += 1;
        }
        k += 1;
    }
    factors
};

/// Second and third derivatives of the energy (J), by the place `w = x + i y` of the second magnet (m), by its
/// conjugate (c) and by its own angle (t). Those that are equal to the conjugate of another one are left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Derivatives {
    pub ww: Complex<f64>,
    pub wc: f64,
    pub wt: Complex<f64>,
    pub tt: f64,
    pub www: Complex<f64>,
    pub wwc: Complex<f64>,
    pub wwt: Complex<f64>,
    pub wct: f64,
    pub wtt: Complex<f64>,
    pub ttt: f64,
}

impl AngleDerivatives {
    pub fn none() -> Self {
        Self {
            parts: [[[0.0; ROOM]; 2]; 2],
            terms: 0,
        }
    }

    /// Forgets all, as at another angle.
    pub fn forget(&mut self) {
        self.terms = 0;
    }

    /// Computes those of this many terms of a series, at `turn` = e^(i beta), at which all are that are known.
    #[inline(always)]
    fn up_to<L: Lanes>(&mut self, l: L, series: &Multipole, turn: Complex<f64>, terms: usize) {
        if self.terms >= terms {
            return;
        }
        let turns = series.turns(turn, terms);
        for (i, orders) in series.vectors(self.terms..terms) {
            let mut parts = [[l.splat(0.0); 2]; 2];
            for (j, phase) in turns[..orders].iter().enumerate() {
                let (sum, difference) = series.with_order(j);
                let (sum, difference) = (l.load(&sum[i..]), l.load(&difference[i..]));
                // Twice and three times i l' times the phase.
                let order = series.order(j);
                let second = phase * -(order * order);
                let third = Complex::new(-second.im * order, second.re * order);
                parts[0][0] = l.mul_add(sum, l.splat(second.re), parts[0][0]);
                parts[0][1] = l.mul_add(difference, l.splat(second.im), parts[0][1]);
                parts[1][0] = l.mul_add(sum, l.splat(third.re), parts[1][0]);
                parts[1][1] = l.mul_add(difference, l.splat(third.im), parts[1][1]);
            }
            for (part, found) in parts.into_iter().zip(&mut self.parts) {
                l.store(part[0], &mut found[0][i..]);
                l.store(part[1], &mut found[1][i..]);
            }
        }
        self.terms = terms;
    }
}

/// Computes [`Derivatives`] by the first `terms` terms, those of third order only if requested.
pub struct AtPlace<'a, const THIRD: bool> {
    pub series: &'a Multipole,
    /// What is known of the coefficients at the angle between the magnets, and of their derivatives.
    pub known: &'a mut Known,
    pub derivatives: &'a mut AngleDerivatives,
    pub terms: usize,
    /// The directions of both magnets.
    pub axes: [Complex<f64>; 2],
    /// From the first magnet to the second (m).
    pub way: Complex<f64>,
    /// The product of their moments (A^2 m^4).
    pub moments: f64,
}

/// The terms from number i on, by their coefficients, at places.
#[inline(always)]
fn term<L: Lanes>(l: L, [re, im]: [&[f64; ROOM]; 2], i: usize, place: [L::F; 2]) -> [L::F; 2] {
    l.complex_product([l.load(&re[i..]), l.load(&im[i..])], place)
}

/// `r^-n e^(-i l phi)` of each of this many terms, for `1 / r` and e^(i phi).
#[inline(always)]
fn places(terms: usize, inverse: f64, phase: Complex<f64>) -> [[f64; ROOM]; 2] {
    let mut phases = [Complex::new(1.0, 0.0); MOST_TERMS + 1];
    let step = (phase * phase).conj();
    for half in 1..=terms {
        phases[half] = phases[half - 1] * step;
    }
    let mut places = [[0.0; ROOM]; 2];
    let square = inverse * inverse;
    let mut scale = square * inverse;
    for k in 0..terms {
        for (half, phase) in phases[..k + 2].iter().enumerate() {
            places[0][index(k, half)] = scale * phase.re;
            places[1][index(k, half)] = scale * phase.im;
        }
        scale *= square;
    }
    places
}

impl<const THIRD: bool> Task for AtPlace<'_, THIRD> {
    type Output = Derivatives;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Derivatives {
        let Self { series, terms, .. } = self;
        let [axis, other] = self.axes;
        let turn = other * axis.conj();
        let known = self.known.up_to::<L, true>(l, series, turn, terms);
        self.derivatives.up_to(l, series, turn, terms);
        let [twice, thrice] = &self.derivatives.parts;
        let way = self.way * axis.conj();
        let inverse = 1.0 / way.norm_sqr().sqrt();
        let phase = way * inverse;
        let places = places(terms, inverse, phase);
        let zero = Sum([l.splat(0.0); 2]);
        let [mut ww, mut wc, mut www, mut wwc] = [zero; 4];
        let [mut wt, mut wct, mut wwt] = [zero; 3];
        let [mut tt, mut wtt, mut ttt] = [zero; 3];
        for i in (0..index(terms, 0)).step_by(WIDTH) {
            let place = [l.load(&places[0][i..]), l.load(&places[1][i..])];
            let still = term(l, [&known.re, &known.im], i, place);
            wc.add_real(l, 2, i, still[0]);
            ww.add(l, 3, i, still);
            let once = term(l, [&known.turn_re, &known.turn_im], i, place);
            wt.add(l, 1, i, once);
            let twice = term(l, [&twice[0], &twice[1]], i, place);
            tt.add_real(l, 0, i, twice[0]);
            if THIRD {
                wwc.add(l, 4, i, still);
                www.add(l, 5, i, still);
                wct.add_real(l, 2, i, once[0]);
                wwt.add(l, 3, i, once);
                wtt.add(l, 1, i, twice);
                let thrice = term(l, [&thrice[0], &thrice[1]], i, place);
                ttt.add_real(l, 0, i, thrice[0]);
            }
        }
        // From w in the first magnet's frame to that on the table.
        let scale = -MU0_OVER_4PI * self.moments;
        let by_w = -(phase.conj() * inverse * axis.conj());
        let by_both = inverse * inverse;
        let one = by_w * scale;
        let two = one * by_w;
        Derivatives {
            ww: ww.value(l) * two,
            wc: wc.value(l).re * by_both * scale,
            wt: wt.value(l) * one,
            tt: tt.value(l).re * scale,
            www: www.value(l) * two * by_w,
            wwc: wwc.value(l) * one * by_both,
            wwt: wwt.value(l) * two,
            wct: wct.value(l).re * by_both * scale,
            wtt: wtt.value(l) * one,
            ttt: ttt.value(l).re * scale,
        }
    }
}

/// The real and the imaginary part of a derivative, in lanes of terms.
#[derive(Clone, Copy)]
struct Sum<F>([F; 2]);

impl<F: Copy> Sum<F> {
    /// Adds the terms from number i on, for one of [`ORDERS`].
    #[inline(always)]
    fn add<L: Lanes<F = F>>(&mut self, l: L, order: usize, i: usize, term: [F; 2]) {
        let [even, odd] = &FACTORS[order];
        self.0[0] = l.mul_add(l.load(&even[i..]), term[0], self.0[0]);
        self.0[1] = l.mul_add(l.load(&odd[i..]), term[1], self.0[1]);
    }

    /// The same for a derivative that is real.
    #[inline(always)]
    fn add_real<L: Lanes<F = F>>(&mut self, l: L, order: usize, i: usize, term: F) {
        self.0[0] = l.mul_add(l.load(&FACTORS[order][0][i..]), term, self.0[0]);
    }

    #[inline(always)]
    fn value<L: Lanes<F = F>>(self, l: L) -> Complex<f64> {
        Complex::new(l.sum(self.0[0]), l.sum(self.0[1]))
    }
}

#[cfg(test)]
pub(in crate::potential) mod tests {
    use nalgebra::Vector2;

    use super::super::complex;
    use super::*;
    use crate::potential::MagnetModel;
    use crate::potential::bodies::{Body, exact, series_of};
    use crate::potential::simd::Level;
    use crate::tile::magnet::Shape;

    fn body(shape: Shape, stands: bool, position: Vector2<f64>, turn: f64) -> Body {
        Body {
            position,
            direction: Vector2::new(libm::cos(turn), libm::sin(turn)),
            moment: 1.3,
            size: match stands {
                true => [0.006, 0.006, 0.003],
                false => [0.003, 0.006, 0.006],
            },
            shape,
            stands,
        }
    }

    /// How far they are from differences of the exact energies' slopes over a step (m) and a turn (rad), as a share
    /// of what an energy (J) gives that changes over a length (m).
    pub fn off_differences(
        found: &Derivatives,
        [first, second]: [&Body; 2],
        [h, turn]: [f64; 2],
        [scale, length]: [f64; 2],
    ) -> [f64; 10] {
        // Slopes by w and by the angle with the second magnet moved and turned.
        let at = |step: Complex<f64>, turn: f64| -> (Complex<f64>, f64) {
            let (sin, cos) = libm::sincos(turn);
            let turned = second.moved([cos, sin], Vector2::zeros());
            let position = second.position + Vector2::new(step.re, step.im);
            let there = exact(first, &Body { position, ..turned });
            (
                Complex::new(there.gradient.x, -there.gradient.y) / 2.0,
                there.slope,
            )
        };
        let (one, i, none) = (
            Complex::new(h, 0.0),
            Complex::new(0.0, h),
            Complex::default(),
        );
        let [x, y, t] = [(one, 0.0), (i, 0.0), (none, turn)]
            .map(|(step, turn)| [-2.0, -1.0, 1.0, 2.0].map(|by| at(step * by, turn * by)));
        let here = at(none, 0.0);
        let first_of =
            |[a, b, c, d]: [Complex<f64>; 4], h: f64| ((c - b) * 8.0 - (d - a)) / (12.0 * h);
        let second_of = |[a, b, c, d]: [Complex<f64>; 4], here: Complex<f64>, h: f64| {
            ((b + c) * 16.0 - (a + d) - here * 30.0) / (12.0 * h * h)
        };
        let real = |v: f64| Complex::new(v, 0.0);
        let slopes = |of: &[(Complex<f64>, f64); 4]| of.map(|it| it.0);
        let turns = |of: &[(Complex<f64>, f64); 4]| of.map(|it| real(it.1));
        let i = Complex::<f64>::i();
        let [by_x, by_y] = [&x, &y].map(|of| first_of(slopes(of), h));
        let [xx, yy] = [&x, &y].map(|of| second_of(slopes(of), here.0, h));
        let [xxt, yyt] = [&x, &y].map(|of| second_of(turns(of), real(here.1), h).re);
        let tt = |of, here| second_of(of, here, turn);
        [
            ((found.ww, (by_x - i * by_y) / 2.0), 2),
            ((real(found.wc), (by_x + i * by_y) / 2.0), 2),
            ((found.wt, first_of(slopes(&t), turn)), 1),
            ((real(found.tt), first_of(turns(&t), turn)), 0),
            // d/dx^2 + d/dy^2 = 4 d/dw dw*.
            ((found.wwc, (xx + yy) / 4.0), 3),
            // d/dx^2 - d/dy^2 = 2 (d/dw^2 + d/dw*^2); of d/dw the latter is d/dw dw*^2.
            ((found.www + found.wwc.conj(), (xx - yy) / 2.0), 3),
            ((found.wtt, tt(slopes(&t), here.0)), 1),
            ((real(found.ttt), tt(turns(&t), real(here.1))), 0),
            ((real(found.wct), real((xxt + yyt) / 4.0)), 2),
            ((real(2.0 * found.wwt.re), real((xxt - yyt) / 2.0)), 2),
        ]
        .map(|((one, other), power)| (one - other).norm() / scale * length.powi(power))
    }

    fn of_all_terms<const THIRD: bool>(
        series: &Multipole,
        [first, second]: [&Body; 2],
    ) -> Derivatives {
        Level::best().run(AtPlace::<THIRD> {
            series,
            known: &mut Known::none(),
            derivatives: &mut AngleDerivatives::none(),
            terms: MOST_TERMS,
            axes: [first.direction, second.direction].map(complex),
            way: complex(second.position - first.position),
            moments: first.moment * second.moment,
        })
    }

    /// They are those of the exact energies' slopes, by differences, and those of second order alone the same.
    #[test]
    fn derivatives_are_those_of_exact_energies() {
        for k in 0..24u32 {
            let (stands, angle) = (k % 3 == 2, 0.71 * f64::from(k));
            let shape = [Shape::Disc, Shape::Block][k as usize % 2];
            let way = Vector2::new(libm::cos(angle), libm::sin(angle)) * 0.024;
            let first = body(Shape::Disc, stands, Vector2::new(0.003, -0.001), 0.4);
            let second = body(shape, stands, first.position + way, 2.2 * angle);
            let series = series_of(MagnetModel::Cuboid, &first, &second, 1e-9).series;
            let found = of_all_terms::<true>(&series, [&first, &second]);
            let second_ones = Derivatives {
                ww: found.ww,
                wc: found.wc,
                wt: found.wt,
                tt: found.tt,
                ..Derivatives::default()
            };
            let alone = of_all_terms::<false>(&series, [&first, &second]);
            assert_eq!(alone, second_ones);
            let length = 0.024f64;
            let scale = MU0_OVER_4PI * first.moment * second.moment / length.powi(3);
            let off = off_differences(&found, [&first, &second], [2e-4, 0.02], [scale, length]);
            assert!(off.iter().all(|off| *off < 3e-5), "{k} {off:?}");
        }
    }
}
