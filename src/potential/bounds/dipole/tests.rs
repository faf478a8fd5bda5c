use super::*;
use crate::configuration::Configuration;
use crate::contact::Contact;
use crate::potential::{DipolePotential, Potential};
use crate::tile::{Magnet, Outline};
use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// A square of side 0.43 m with four magnets on each face, +1 for north pole out.
pub fn square_tile(code: [f64; 4]) -> Tile {
    let half = 0.215;
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let mut magnets = Vec::new();
    for face in 0..4 {
        let angle = face as f64 * PI / 2.0;
        let normal = Vector2::new(angle.cos(), angle.sin());
        let tangent = Vector2::new(-angle.sin(), angle.cos());
        for (k, sign) in code.iter().enumerate() {
            magnets.push(Magnet {
                position: normal * (half - 0.005) + tangent * ((k as f64 - 1.5) * 0.04),
                angle: if *sign > 0.0 { angle } else { angle + PI },
                moment: 1.2 * 3e-7 / crate::units::MU0,
                size: [0.01, 0.01, 0.003],
                face,
            });
        }
    }
    Tile {
        outline: Outline::new(corners.map(|c| Vector2::new(c[0], c[1])).to_vec()).unwrap(),
        faces: Vec::new(),
        magnets,
        mass: 0.1,
        thickness: 0.013,
    }
}

pub fn paper_tiles() -> (Tile, Tile) {
    (
        square_tile([1.0, 1.0, 1.0, -1.0]),
        square_tile([1.0, -1.0, -1.0, -1.0]),
    )
}

#[test]
fn no_free_configuration_of_a_cell_lies_outside_its_enclosure() {
    for level in Level::available() {
        check_random_cells(level);
    }
}

/// Asserts that the energies of free ones among twenty random configurations of a cell lie in its
/// enclosure; returns how many these were.
pub fn assert_encloses(
    enclosure: &Enclosure,
    potential: &dyn Potential,
    contact: &Contact,
    cell: &Cell,
    rng: &mut ChaCha8Rng,
) -> usize {
    let mut tested = 0;
    for _ in 0..20 {
        let d = cell.half.map(|half| half * rng.random_range(-1.0..=1.0));
        let q = cell.centre.moved(d.into());
        if !contact.is_free(&q) {
            continue;
        }
        let rest = potential.energy(&q) - enclosure.form.at(d);
        tested += 1;
        assert!(
            rest >= enclosure.low && rest <= enclosure.high,
            "{cell:?} {d:?}: {rest} not in [{}, {}]",
            enclosure.low,
            enclosure.high
        );
    }
    tested
}

fn check_random_cells(level: Level) {
    let (a, b) = paper_tiles();
    let bounds = DipoleBounds::with_level(&a, &b, level);
    let potential = DipolePotential::new(&a.magnets, &b.magnets);
    let contact = Contact::new(&a.outline, &b.outline);
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let (mut tested, mut near) = (0, 0);
    for _ in 0..3000 {
        let size = 10f64.powf(rng.random_range(-4.0..-0.5));
        let cell = Cell {
            centre: Configuration::new(
                rng.random_range(0.35..0.6),
                rng.random_range(-0.3..0.3),
                rng.random_range(-0.4..0.4),
            ),
            half: std::array::from_fn(|_| size * rng.random_range(0.05..1.0)),
        };
        let enclosure = bounds.enclose(&cell);
        assert!(enclosure.low <= 0.0 && enclosure.high >= 0.0);
        let free = assert_encloses(&enclosure, &potential, &contact, &cell, &mut rng);
        tested += free;
        near += if size > 0.01 { free } else { 0 };
    }
    assert!(tested > 10_000 && near > 3_000, "{tested} {near}");
}

#[test]
fn the_remainder_is_of_third_order() {
    let (a, b) = paper_tiles();
    let bounds = DipoleBounds::new(&a, &b);
    let width = |h: f64| {
        let enclosure = bounds.enclose(&Cell {
            centre: Configuration::new(0.46, 0.03, 0.1),
            half: [h, h, 4.0 * h],
        });
        enclosure.high - enclosure.low
    };
    let ratio = width(1e-3) / width(1e-4);
    assert!((ratio - 1000.0).abs() < 400.0, "{ratio}");
}

#[test]
fn a_cell_of_no_size_gives_the_energy_and_its_gradient() {
    let (a, b) = paper_tiles();
    let bounds = DipoleBounds::new(&a, &b);
    let potential = DipolePotential::new(&a.magnets, &b.magnets);
    let q = Configuration::new(0.44, -0.07, 0.08);
    let enclosure = bounds.enclose(&Cell {
        centre: q,
        half: [0.0; 3],
    });
    let (energy, gradient) = potential.energy_and_gradient(&q);
    assert!((enclosure.form.value - energy).abs() < 1e-14);
    for i in 0..3 {
        assert!((enclosure.form.gradient[i] - gradient[i]).abs() < 1e-12);
        let h = 1e-5;
        let mut step = nalgebra::Vector3::zeros();
        step[i] = h;
        let there = potential.energy_and_gradient(&q.moved(step)).1;
        let back = potential.energy_and_gradient(&q.moved(-step)).1;
        let slope = (there - back) / (2.0 * h);
        let [xx, yy, tt, xy, xt, yt] = enclosure.form.hessian;
        let row = [[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]][i];
        for j in 0..3 {
            assert!(
                (slope[j] - row[j]).abs() < 1e-5 * (1.0 + row[j].abs()),
                "{i} {j}"
            );
        }
    }
    assert!(enclosure.high < 1e-11, "{}", enclosure.high);
}

/// A number as the unevaluated sum of two, good to some 30 digits (Dekker 1971,
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

/// The interaction energy to some 30 digits.
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
    let (a, b) = paper_tiles();
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
            // Covered, but not so generously that it would matter.
            assert!(enclosure.high < 1e-11);
            tested += 1;
            largest = largest.max(rest.abs() / enclosure.high);
        }
    }
    assert!(tested > 300);
    assert!((1e-8..0.1).contains(&largest), "{largest}");
}
