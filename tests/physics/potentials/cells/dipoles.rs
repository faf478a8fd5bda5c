//! Enclosures of point dipoles' energy over cells.

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::contact::Contact;
use tilebind::potential::CellBounds;
use tilebind::potential::bounds::{DipoleBounds, Enclosure};
use tilebind::potential::dipole::dipoles;
use tilebind::potential::simd::Level;
use tilebind::tile::Tile;
use tilebind::units::MU0_OVER_4PI;

use super::super::kinds::{paper_tile, pixel_tile};
use super::assert_encloses;
use crate::plain::Plain;

/// A number as the unevaluated sum of two, accurate to about 30 digits (Dekker 1971,
/// doi:10.1007/BF01397083; Shewchuk 1997, doi:10.1007/PL00009321).
#[derive(Clone, Copy)]
struct Double(f64, f64);

impl Double {
    fn add(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        let part = sum - self.0;
        let error = (self.0 - (sum - part)) + (other.0 - part);
        Self::normal(sum, error + self.1 + other.1)
    }

    fn normal(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self(sum, low - (sum - high))
    }

    fn times(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let error = self.0.mul_add(other.0, -product);
        Self::normal(product, error + self.0 * other.1 + self.1 * other.0)
    }

    fn minus(self, other: Self) -> Self {
        self.add(Self(-other.0, -other.1))
    }

    fn over(self, other: Self) -> Self {
        let first = self.0 / other.0;
        let rest = self.minus(other.times(Self(first, 0.0)));
        let second = rest.0 / other.0;
        let rest = rest.minus(other.times(Self(second, 0.0)));
        Self::normal(first, second).add(Self(rest.0 / other.0, 0.0))
    }

    fn root(self) -> Self {
        let guess = Self(self.0.sqrt(), 0.0);
        guess.add(self.over(guess)).times(Self(0.5, 0.0))
    }
}

/// Sine and cosine by their series.
fn sine_and_cosine(theta: f64) -> (Double, Double) {
    let theta = Double(theta, 0.0);
    let mut term = Double(1.0, 0.0);
    let (mut sine, mut cosine) = (Double(0.0, 0.0), term);
    for k in 1..60 {
        term = term.times(theta).over(Double(f64::from(k), 0.0));
        let signed = if k % 4 < 2 {
            term
        } else {
            Double(-term.0, -term.1)
        };
        if k % 2 == 0 {
            cosine = cosine.add(signed);
        } else {
            sine = sine.add(signed);
        }
    }
    (sine, cosine)
}

/// The interaction energy to about 30 digits.
fn exact_energy(fixed: &Tile, moving: &Tile, q: &Configuration) -> Double {
    let exact = |x: f64| Double(x, 0.0);
    let (sine, cosine) = sine_and_cosine(q.theta);
    let turned = |v: Vector2<f64>| {
        let (x, y) = (exact(v.x), exact(v.y));
        let along = cosine.times(x).minus(sine.times(y));
        (along, sine.times(x).add(cosine.times(y)))
    };
    let dot = |a: (Double, Double), b: (Double, Double)| a.0.times(b.0).add(a.1.times(b.1));
    let mut sum = exact(0.0);
    for second in &moving.magnets {
        let arm = turned(second.position);
        let at = (exact(q.x).add(arm.0), exact(q.y).add(arm.1));
        let m2 = turned(second.moment_vector());
        for first in &fixed.magnets {
            let d = (
                at.0.minus(exact(first.position.x)),
                at.1.minus(exact(first.position.y)),
            );
            let moment = first.moment_vector();
            let m1 = (exact(moment.x), exact(moment.y));
            let r2 = dot(d, d);
            let r3 = r2.times(r2.root());
            let along = dot(m1, d).times(dot(m2, d)).over(r2);
            let energy = dot(m1, m2).minus(along.times(exact(3.0))).over(r3);
            sum = sum.add(energy);
        }
    }
    sum.times(exact(MU0_OVER_4PI))
}

#[test]
fn rounding_is_covered() {
    let [a, b] = ["NNNS", "NSSS"].map(paper_tile);
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let contact = Contact::new(&a.outline, &b.outline);
    let (mut tested, mut largest): (i32, f64) = (0, 0.0);
    for level in Level::available() {
        let bounds = DipoleBounds::with_level(&a, &b, level);
        for _ in 0..400 {
            let q = Configuration::new(
                rng.random_range(0.42..0.7),
                rng.random_range(-0.5..0.5),
                rng.random_range(-3.1..3.1),
            );
            if !contact.is_free(&q) {
                continue;
            }
            let enclosure = bounds.enclose(&Cell {
                centre: q,
                half: [0.0; 3],
            });
            let exact = exact_energy(&a, &b, &q);
            let rest = (exact.0 - enclosure.form.value) + exact.1;
            assert!(
                rest > enclosure.low && rest < enclosure.high,
                "{q:?}: {rest}"
            );
            // Covered, but not so generously that it matters.
            assert!(enclosure.high < 1e-11);
            tested += 1;
            largest = largest.max(rest.abs() / enclosure.high);
        }
    }
    assert!(tested > 300);
    assert!((1e-8..0.1).contains(&largest), "{largest}");
}

/// With enough magnets for groups of them to be enclosed as wholes.
#[test]
fn groups_enclose_what_their_magnets_do() {
    let (a, b) = (pixel_tile(48, 1), pixel_tile(48, 3));
    let bounds = DipoleBounds::new(&a, &b);
    let each = DipoleBounds::with_level(&a, &b, Level::best());
    let potential = Plain::new(&dipoles(&a.magnets), &dipoles(&b.magnets));
    let contact = Contact::new(&a.outline, &b.outline);
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let (mut tested, mut wider) = (0, 0.0f64);
    for _ in 0..60 {
        let size = 10f64.powf(rng.random_range(-4.0..-1.0));
        let cell = Cell {
            centre: Configuration::new(
                rng.random_range(0.4..0.9),
                rng.random_range(-0.3..0.3),
                rng.random_range(-0.4..0.4),
            ),
            half: std::array::from_fn(|_| size * rng.random_range(0.05..1.0)),
        };
        let (enclosure, one_by_one) = (bounds.enclose(&cell), each.enclose(&cell));
        tested += assert_encloses(
            &enclosure,
            &potential,
            &contact,
            &cell,
            [0.0, 1e-9],
            &mut rng,
        );
        let width = |known: &Enclosure| known.high - known.low;
        // Less is required for larger cells, in which dipoles approach each other at any angle.
        if size < 2e-3 {
            wider = wider.max(width(&enclosure) / width(&one_by_one));
        }
    }
    assert!(tested > 200, "{tested}");
    assert!(wider < 1.2, "{wider}");
}
