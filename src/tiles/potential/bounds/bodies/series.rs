//! Bounds for two magnets that stay apart throughout a cell, by their multipole series.
//!
//! Term k of the series (see [`multipole`](crate::potential::far::multipole)) is a sum of `r^-n e^(-i l phi)
//! e^(i l' beta)`, `n = 2 k + 3`, whose coefficients have the absolute sum A_k and whose l' are at most `m =
//! 2 k + 1` (2 k + 2 for magnets that stand). As the magnets are distributions of pairs of dipoles whose
//! offsets from the centres together are at most s, half the sum of the diagonals, term k is also a mean of
//! directional derivatives of `1 / r` of the order n - 1, which are at most `(n - 1)! / r^n`. So A_k may be
//! replaced by `G_k = (2 k + 1) (2 k + 2) s^(2k)`, of which all are known; as a polynomial in the second
//! magnet's turn it has the order m as well (Bernstein's inequality).
//!
//! Directional derivatives of `P^M Q^N (1 / r)`, `M + N = n - 1`, are sums of the same kind: those of the
//! order j are at most `n (n + 1) .. (n + j - 1) / r^j` times the bound of the term itself, as `sum_i C(j, i)
//! (1/2 + M)_i (1/2 + N)_(j-i) = (n)_j`. While the second magnet's centre moves no faster than v, on an arc
//! at the turn w, and comes no closer than rho, the derivatives along the motion hence are at most those of
//! `sum A_k e^(m w t) / (rho - d(t))^n`, `d = v (t + w t^2 / 2 + w^2 t^3 / 6)`, in units of `mu0 m1 m2 /
//! (4 pi)`:
//!
//! ```text
//! |U|    <= sum A_k rho^-n
//! |U'|   <= sum A_k rho^-n (n v / rho + m w)
//! |U'''| <= sum A_k rho^-n [n (n+1) (n+2) (v / rho)^3 + 3 n (n+1) (m+1) (v / rho)^2 w
//!                           + n (3 m^2 + 3 m + 1) (v / rho) w^2 + m^3 w^3]
//! ```
//!
//! and so on: with `(n)_i` for the rising factorials, derivative j is at most `sum A_k rho^-n sum_i (n)_i B_ij(m)
//! (v / rho)^i w^(j-i)`, where B_ij(m) are the r-Stirling numbers, `B_ij = B_(i-1)(j-1) + (m + i) B_i(j-1)`, from
//! B_00 = 1 (Broder 1984, Discrete Mathematics 49, 241).
//!
//! **Forms** of second and of third order have these derivatives of the first terms only, as many as a cell needs.
//! What they leave is a remainder of the next order, and one of second order of the other terms.
//!
//! Term 0 is that of dipoles. The sums fall with rho: they are known at some distances, and hold from each
//! of these on.

use super::Left;
use crate::potential::bodies::{Body, magnitudes_of};
use crate::potential::classes::{class_of, shortest};
use crate::potential::far::multipole::MOST_TERMS;
use crate::tile::magnet::Shape;

/// Terms of which A_k is computed, and those that are summed: at the least distance each G_k is at most 0.7
/// times the one before, up to factors that grow like a power of k, so that the others are nothing.
const TERMS: usize = 64;
const ALL: usize = 400;
/// The least distance of the sums, and one from which on they are those at this one, in units of s.
const LEAST: f64 = 1.2;
const MOST: f64 = 1024.0;
/// Room for rounding.
const ROOM: f64 = 1.0 + 1e-9;

/// The sums of two magnets at distances.
#[derive(Clone, Debug)]
pub(in crate::potential::bounds) struct SeriesBounds {
    /// The [class](class_of) of the least distance.
    first: usize,
    /// At the shortest distance of each class.
    sums: Vec<Sums>,
}

/// The sums in the bounds of a derivative of the order N - 1, by ascending powers of v.
type Derivative<const N: usize> = [f64; N];

/// The sums in the bounds.
#[derive(Clone, Debug, Default)]
struct Sums {
    energy: f64,
    slope: Derivative<2>,
    second: Derivative<3>,
    third: Derivative<4>,
    fourth: Derivative<5>,
    /// The second derivative of the terms after the first, after the second and so on.
    omitted: [Derivative<3>; MOST_TERMS],
    /// The energy and the slope of the terms that are never summed.
    unknown: (f64, Derivative<2>),
}

/// Bounds of two magnets over a cell.
pub(super) struct OfSeries<'a> {
    sums: &'a Sums,
    /// The speed (m) of the second one's centre, and its turn.
    motion: [f64; 2],
    scale: f64,
}

impl OfSeries<'_> {
    /// Of the energy (J).
    pub fn energy(&self) -> f64 {
        self.scale * self.sums.energy
    }

    /// Of its change (J) along a motion.
    pub fn slope(&self) -> f64 {
        self.scale * of_motion(&self.sums.slope, self.motion)
    }

    /// What a form of this order, from 1 to 3, leaves (J).
    pub fn remainder(&self, order: usize) -> f64 {
        let Sums {
            second,
            third,
            fourth,
            ..
        } = self.sums;
        self.scale
            * match order {
                1 => of_motion(second, self.motion) / 2.0,
                2 => of_motion(third, self.motion) / 6.0,
                _ => of_motion(fourth, self.motion) / 24.0,
            }
    }

    /// How many terms a form must have that leaves no more than this (J) of the others, if there are as many, and
    /// what it leaves of them.
    pub fn terms(&self, most: f64) -> (usize, f64) {
        let omitted = |sums: &Derivative<3>| self.scale * of_motion(sums, self.motion) / 2.0;
        let few = &self.sums.omitted[..MOST_TERMS - 1];
        let enough = few.iter().position(|sums| omitted(sums) <= most);
        let last = enough.unwrap_or(MOST_TERMS - 1);
        (last + 1, omitted(&self.sums.omitted[last]))
    }

    /// What the terms that are never summed add.
    pub fn unknown(&self) -> Left {
        Left {
            spread: self.scale * self.sums.unknown.0,
            slope: self.scale * of_motion(&self.sums.unknown.1, self.motion),
        }
    }
}

impl SeriesBounds {
    /// Of two magnets that both lie or both stand.
    pub fn new(first: &Body, second: &Body) -> Self {
        let s = half_diagonal(first) + half_diagonal(second);
        // In units of s^(2k), as numbers would be too small otherwise.
        let [one, other] = [first, second].map(|body| Body {
            size: body.size.map(|side| side / s),
            ..*body
        });
        let known = magnitudes_of(&one, &other, TERMS);
        let of_dipoles = |k: usize| ((2 * k + 1) * (2 * k + 2)) as f64;
        let magnitude = |k: usize| {
            let most = of_dipoles(k);
            known.get(k).map_or(most, |it| it.min(most))
        };
        let magnitudes: Vec<f64> = (0..ALL).map(magnitude).collect();
        let classes = class_of(LEAST * s) + 1..class_of(MOST * s);
        let least_turn = if first.stands { 2.0 } else { 1.0 };
        let sums = |class| Sums::new(&magnitudes, least_turn, [shortest(class), s]);
        Self {
            first: classes.start,
            sums: classes.map(sums).collect(),
        }
    }

    /// For magnets whose centres stay a distance (m) apart, where the second one's moves and turns by at most this
    /// `motion` (m, rad), in units of `strength` (J m^3); `None` if that is too close.
    pub(super) fn at(
        &self,
        distance: f64,
        motion: [f64; 2],
        strength: f64,
    ) -> Option<OfSeries<'_>> {
        let class = class_of(distance.max(0.0)).checked_sub(self.first)?;
        Some(OfSeries {
            sums: &self.sums[class.min(self.sums.len() - 1)],
            motion,
            scale: ROOM * strength,
        })
    }
}

/// Half the diagonal (m) of a magnet.
fn half_diagonal(body: &Body) -> f64 {
    let [a, b, c] = body.size;
    match (body.shape, body.stands) {
        (Shape::Block, _) => libm::hypot(libm::hypot(a, b), c) / 2.0,
        (Shape::Disc, false) => libm::hypot(a, b) / 2.0,
        (Shape::Disc, true) => libm::hypot(c, a) / 2.0,
    }
}

/// The derivative along a motion with the speed v (m) and the turn w.
fn of_motion<const N: usize>(sums: &Derivative<N>, [v, w]: [f64; 2]) -> f64 {
    let mut turns = 1.0;
    let mut all = 0.0;
    for (i, sum) in sums.iter().enumerate().rev() {
        all += sum * turns * v.powi(i as i32);
        turns *= w;
    }
    all
}

impl Sums {
    /// At a distance (m) of magnets with an s (m), with A_k in units of s^(2k), and m of term 0.
    fn new(magnitudes: &[f64], least_turn: f64, [rho, s]: [f64; 2]) -> Self {
        let mut sums = Self::default();
        let inverse = 1.0 / rho;
        let term = |k: usize| magnitudes[k] * inverse.powi(3) * (s * inverse).powi(2 * k as i32);
        for k in (0..magnitudes.len()).rev() {
            if k + 1 == MOST_TERMS {
                sums.unknown = (sums.energy, sums.slope);
            }
            if k < MOST_TERMS {
                sums.omitted[k] = sums.second;
            }
            let (n, m) = ((2 * k + 3) as f64, 2.0 * k as f64 + least_turn);
            let term = term(k);
            sums.energy += term;
            add(&mut sums.slope, term, [n, m, inverse]);
            add(&mut sums.second, term, [n, m, inverse]);
            add(&mut sums.third, term, [n, m, inverse]);
            add(&mut sums.fourth, term, [n, m, inverse]);
        }
        sums
    }
}

/// Adds the derivative of a term with this n and m, at the inverse of rho (1/m).
fn add<const N: usize>(sums: &mut Derivative<N>, term: f64, [n, m, inverse]: [f64; 3]) {
    let mut stirling = [0.0; N];
    stirling[0] = 1.0;
    for _ in 1..N {
        for i in (0..N).rev() {
            let below = if i > 0 { stirling[i - 1] } else { 0.0 };
            stirling[i] = below + (m + i as f64) * stirling[i];
        }
    }
    let mut rising = term;
    for (i, (sum, stirling)) in sums.iter_mut().zip(stirling).enumerate() {
        *sum += rising * stirling;
        rising *= (n + i as f64) * inverse;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::super::super::apart::{Apart, tests::check};
    use super::*;
    use crate::potential::bodies::exact;
    use crate::units::MU0_OVER_4PI;

    /// The energy and its derivatives up to the fourth by time, by differences, along motions that turn the second
    /// magnet about a point and shift it, are within the bounds, and these are not much wider.
    #[test]
    fn energies_and_derivatives_stay_within_their_bounds() {
        let (mut closest, mut count) = ([f64::INFINITY; 5], 0);
        for k in 0..240u32 {
            let stands = k % 3 == 2;
            let size = match stands {
                true => [0.006, 0.006, 0.003],
                false => [0.003, 0.006, 0.006],
            };
            let body = |shape: Shape, position: Vector2<f64>, turn: f64| Body {
                position,
                direction: Vector2::new(libm::cos(turn), libm::sin(turn)),
                moment: 1.0,
                size,
                shape,
                stands,
            };
            let r = 0.0085 + 0.0005 * f64::from(k % 40);
            let aside = 1.3 * f64::from(k);
            let way = Vector2::new(libm::cos(aside), libm::sin(aside));
            let shape = [Shape::Disc, Shape::Block][k as usize / 3 % 2];
            let first = body(Shape::Disc, Vector2::zeros(), 0.2);
            let second = body(shape, way * r, 0.37 * f64::from(k));
            let bounds = SeriesBounds::new(&first, &second);
            let centre = second.position - Vector2::new(0.02, 0.01);
            let (turn, half) = (0.02, 0.0004);
            let reach = half + (second.position - centre).norm() * turn;
            let Some(of) = bounds.at(r - reach, [reach, turn], MU0_OVER_4PI) else {
                continue;
            };
            let apart = Apart {
                energy: of.energy(),
                slope: of.slope(),
                remainder: of.remainder(2),
                is_coarse: false,
            };
            let shift = way * half * if k % 2 == 0 { 1.0 } else { -1.0 };
            let at = |t: f64| {
                let (sin, cos) = libm::sincos(turn * t);
                let back = Body {
                    position: second.position - centre,
                    ..second
                };
                exact(&first, &back.moved([cos, sin], centre + shift * t)).energy
            };
            let h = 0.15;
            for t in [-0.7, 0.0, 0.6] {
                let [energy, first, third] = check(&apart, &at, (t, h, 1e-10), &k.to_string());
                let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|step| at(t + step * h));
                let differences = [
                    (b - 2.0 * c + d, 2, 1),
                    (a - 4.0 * b + 6.0 * c - 4.0 * d + e, 4, 3),
                ];
                let [second, fourth] = differences.map(|(difference, power, order)| {
                    let found = difference.abs() / h.powi(power);
                    let bound = [2.0, 24.0][order / 2] * of.remainder(order);
                    let lost = 1e-11 * apart.energy / h.powi(power);
                    assert!(found <= bound + lost, "{k} {t}: {found} {bound}");
                    bound / found
                });
                let ratios = [energy, first, second, third, fourth];
                closest = [0, 1, 2, 3, 4].map(|i| f64::min(closest[i], ratios[i]));
                count += 1;
            }
        }
        assert!(count > 500, "{count}");
        let most = [1.6, 2.5, 3.0, 5.0, 9.0];
        let tight = closest.iter().zip(most).all(|(ratio, most)| *ratio < most);
        assert!(tight, "{closest:?}");
    }
}
