//! The multipole series of two magnets of any form.
//!
//! As [blocks](crate::potential::cuboid) have it, averaging point dipoles over a magnet is an operator S
//! made of even powers of derivatives along its three directions: for each length L of a block
//! `sinhc(L d / 2) = sum (L / 2)^(2k) d^(2k) / (2k + 1)!`, and for a disc of radius R
//!
//! ```text
//! 2 I1(R s) / (R s) = sum (R / 2)^(2k) s^(2k) / (k! (k + 1)!),    s^2 = -d^2 along its axis (Laplace).
//! ```
//!
//! With `P = d/dw`, `Q = d/d(conj w)`, `w = x + i y`, see there, two lying magnets have the energy
//! `-mu0 m1 m2 / (4 pi) S1 d_a1 S2 d_a2 (1 / r)`, and two standing ones, of whose vertical derivatives the
//! square is `-4 P Q`, `-mu0 m1 m2 / (4 pi) S1 S2 (-4 P Q) (1 / r)`: either is
//!
//! ```text
//! U = -mu0 m1 m2 / (4 pi)  sum_k r^(-3-2k) Re sum_n C_kn(beta) e^(-2 i n phi),   n = 0 .. k+1
//! ```
//!
//! with beta the angle between the magnets' directions, phi the angle from the first one's
//! direction to the line from the first to the second, and `C_kn = sum T e^(i turn beta)`.

use nalgebra::{Complex, Vector2};

use super::Body;
use crate::potential::cuboid::block::PairEnergy;
use crate::potential::cuboid::multipole::{
    Form, along, composed, powers, product, rising_half, squares,
};
use crate::tile::magnet::Shape;
use crate::units::MU0_OVER_4PI;

/// Terms that are summed, the dipole included.
pub const TERMS: usize = 8;
/// Terms that enter the bound of the error.
const BOUND_TERMS: usize = 16;

type C = Complex<f64>;

/// A part of C_kn.
#[derive(Clone, Copy, Debug)]
struct Part {
    n: usize,
    turn: i32,
    value: f64,
}

/// The part of the series that does not depend on places, angles and moments.
#[derive(Clone, Debug)]
pub struct Series {
    terms: Vec<Vec<Part>>,
    /// Bounds of the terms (m^(2k)).
    magnitudes: Vec<f64>,
}

/// The coefficients C_kn at one angle beta, computed on demand.
#[derive(Default)]
pub struct Coefficients {
    /// The coefficients of term k, and their derivatives by beta.
    terms: Vec<Vec<[C; 2]>>,
}

/// The terms of degree 0, 2, 4 .. of S, in the magnet's own directions.
fn average(body: &Body) -> Vec<Form> {
    let [first, across, up] = &squares();
    let [a, b, c] = body.size;
    let length = |square: &Form, length: f64| along(square, BOUND_TERMS, length);
    let parts = match (body.shape, body.stands) {
        (Shape::Block, _) => vec![length(first, a), length(across, b), length(up, c)],
        (Shape::Disc, stands) => {
            let (axis, height, diameter) = if stands { (up, c, a) } else { (first, a, b) };
            let disc = |k: f64| -diameter * diameter / 16.0 / (k * (k + 1.0));
            vec![length(axis, height), powers(axis, BOUND_TERMS, disc)]
        }
    };
    composed(&parts, BOUND_TERMS)
}

impl Series {
    /// The series of two magnets that both lie flat or both stand upright.
    pub fn new(first: &Body, second: &Body) -> Self {
        let times = |forms: Vec<Form>, by: &[f64]| -> Vec<Form> {
            forms.iter().map(|form| product(form, by)).collect()
        };
        let [a, b] = match first.stands {
            true => [average(first), times(average(second), &[0.0, -4.0, 0.0])],
            false => [first, second].map(|body| times(average(body), &[1.0, 1.0])),
        };
        let terms: Vec<_> = (0..BOUND_TERMS).map(|k| term(&a, &b, k)).collect();
        let magnitude = |parts: &Vec<Part>| parts.iter().map(|part| part.value.abs()).sum();
        Self {
            magnitudes: terms.iter().map(magnitude).collect(),
            terms: terms.into_iter().take(TERMS).collect(),
        }
    }

    /// The distance (m) beyond which the sum of the terms from number `terms` on is below
    /// `tolerance` times `mu0 m1 m2 / (4 pi r^3)`.
    pub fn radius(&self, terms: usize, tolerance: f64) -> f64 {
        let error = |r: f64| -> f64 {
            let left = terms..BOUND_TERMS;
            left.map(|k| self.magnitudes[k] * r.powi(-2 * k as i32))
                .sum()
        };
        // For a single term it is where that term equals the tolerance; for all of them at most
        // this factor times as far.
        let of = |k: usize| libm::pow(self.magnitudes[k] / tolerance, 0.5 / k as f64);
        let mut low = (terms..BOUND_TERMS).map(of).fold(0.0, f64::max);
        let mut high = 4.0 * low;
        for _ in 0..50 {
            let middle = (low + high) / 2.0;
            match error(middle) > tolerance {
                true => low = middle,
                false => high = middle,
            }
        }
        high
    }

    /// Computes the missing coefficients of the first `terms` terms for `beta` = e^(i beta).
    pub fn complete<const SLOPE: bool>(&self, known: &mut Coefficients, beta: C, terms: usize) {
        for parts in &self.terms[known.terms.len().min(terms)..terms] {
            let k = known.terms.len();
            let mut of = vec![[C::default(); 2]; k + 2];
            for part in parts {
                let phase = beta.powi(part.turn) * part.value;
                of[part.n][0] += phase;
                if SLOPE {
                    of[part.n][1] += phase * C::new(0.0, f64::from(part.turn));
                }
            }
            known.terms.push(of);
        }
    }
}

/// Term k, combined with its complex conjugate.
fn term(first: &[Form], second: &[Form], k: usize) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for j in 0..=k {
        let (a, b) = (&first[j], &second[k - j]);
        for (m1, x) in a.iter().enumerate() {
            for (m2, y) in b.iter().enumerate() {
                let (p, q) = (m1 + m2, a.len() + b.len() - 2 - m1 - m2);
                if p < q || x * y == 0.0 {
                    continue;
                }
                let fold = if p == q { 1.0 } else { 2.0 };
                let value = fold * x * y * rising_half(p) * rising_half(q);
                let (n, turn) = ((p - q) / 2, 2 * m2 as i32 + 1 - b.len() as i32);
                let same = |part: &&mut Part| (part.n, part.turn) == (n, turn);
                match parts.iter_mut().find(same) {
                    Some(part) => part.value += value,
                    None => parts.push(Part { n, turn, value }),
                }
            }
        }
    }
    parts
}

impl Coefficients {
    /// The sum of the first `terms` terms for two magnets of moments 1 A m^2, the second one `way`
    /// (m) from the first one, whose direction is `axis`. Derivatives are zero unless requested.
    pub fn sum<const SLOPE: bool>(
        &self,
        terms: usize,
        way: Vector2<f64>,
        axis: Vector2<f64>,
    ) -> PairEnergy {
        let square = way.norm_squared();
        let d = C::new(axis.dot(&way), axis.perp(&way));
        let inverse = 1.0 / square;
        // e^(-2 i phi).
        let v = d.conj() * d.conj() * inverse;
        let (mut energy, mut radial, mut angular, mut turning) = (0.0, 0.0, 0.0, 0.0);
        let mut scale = -MU0_OVER_4PI * inverse * inverse.sqrt();
        for (k, of) in self.terms[..terms].iter().enumerate() {
            let (mut value, mut slope, mut turn) = (0.0, 0.0, 0.0);
            let mut power = C::new(1.0, 0.0);
            for (n, [c, by_turn]) in of.iter().enumerate() {
                let part = c * power;
                value += part.re;
                if SLOPE {
                    // The derivative of e^(-2 i n phi) by phi.
                    slope += 2.0 * n as f64 * part.im;
                    turn += (by_turn * power).re;
                }
                power *= v;
            }
            energy += scale * value;
            radial -= scale * (3 + 2 * k) as f64 * value;
            angular += scale * slope;
            turning += scale * turn;
            scale *= inverse;
        }
        let across = Vector2::new(-way.y, way.x);
        PairEnergy {
            energy,
            gradient: (way * radial + across * angular) * inverse,
            slope: turning,
        }
    }
}
