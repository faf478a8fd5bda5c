//! The vectors against the plain formulas.

use super::super::{Shield, logistic as scalar_logistic, pair_factor as scalar_factor};
use super::curvature::factor_limits;
use super::factor::logistic;
use super::*;
use crate::potential::batch::Level;
use crate::potential::batch::lanes::MAX_WIDTH;
use crate::potential::dipole;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn turned(angle: f64) -> Vector2<f64> {
    Vector2::new(angle.cos(), angle.sin())
}

fn random_magnets(rng: &mut ChaCha8Rng, count: usize) -> Vec<Magnet> {
    let mut magnet = |k: usize| Magnet {
        position: turned(rng.random_range(-3.1..3.1)) * rng.random_range(0.01..0.06),
        moment: turned(rng.random_range(-3.1..3.1)) * 0.3,
        front: (
            (!k.is_multiple_of(3)).then(|| Shield {
                attenuation: rng.random_range(0.0..1.0),
                length: rng.random_range(0.01..0.1),
                width: 10f64.powf(rng.random_range(-3.0..0.0)),
                front_gain: rng.random_range(0.8..1.3),
            }),
            turned(rng.random_range(-3.1..3.1)),
        ),
        face: k,
    };
    (0..count).map(&mut magnet).collect()
}

#[test]
fn the_sum_is_that_of_the_plain_formulas() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for level in Level::available() {
        for _ in 0..50 {
            let (fixed, moving) = (random_magnets(&mut rng, 5), random_magnets(&mut rng, 3));
            let place = turned(rng.random_range(-3.1..3.1)) * rng.random_range(0.15..0.3);
            let q = Configuration::new(place.x, place.y, rng.random_range(-3.1..3.1));
            let (mut energy, mut gradient) = (0.0, Vector3::zeros());
            let mut size = 0.0;
            for second in moving.iter().map(|magnet| magnet.moved(&q, &q.rotation())) {
                for first in &fixed {
                    let r = second.position - first.position;
                    let (u, force, slope) = dipole::pair(first.moment, second.moment, r);
                    let w = scalar_factor(first.front, second.front, r);
                    let place = w.gradient * u - force * w.value;
                    let arm = second.position - q.position();
                    let turn = w.slope * u + slope * w.value + arm.perp(&place);
                    energy += w.value * u;
                    gradient += Vector3::new(place.x, place.y, turn);
                    size += u.abs() + place.norm() + turn.abs();
                }
            }
            let columns = Columns::new(&fixed, level.width());
            let (got, slope) = level.run(Sum::<true> {
                fixed: &columns,
                moving: &moving,
                q: &q,
                pairs: None,
                faces: None,
            });
            assert!(
                (got - energy).abs() < 1e-12 * size,
                "{level}: {got} {energy}"
            );
            assert!((slope - gradient).norm() < 1e-11 * size, "{level}");
            let only = level.run(Sum::<false> {
                fixed: &columns,
                moving: &moving,
                q: &q,
                pairs: None,
                faces: None,
            });
            assert!((only.0 - got).abs() < 1e-13 * size, "{level}");
        }
    }
}

/// S and its derivative at several arguments.
struct Logistics([f64; MAX_WIDTH]);

impl Task for Logistics {
    type Output = [[f64; MAX_WIDTH]; 2];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let mut out = [[0.0; MAX_WIDTH]; 2];
        for from in (0..MAX_WIDTH).step_by(L::WIDTH) {
            let [value, slope] = logistic(l, l.load(&self.0[from..]));
            l.store(value, &mut out[0][from..]);
            l.store(slope, &mut out[1][from..]);
        }
        out
    }
}

#[test]
fn the_logistic_function_is_that_of_the_standard_library() {
    for level in Level::available() {
        for k in 0..4000 {
            let t = std::array::from_fn(|i| 0.004 * f64::from(8 * k + i as i32) - 64.0);
            let [values, slopes] = level.run(Logistics(t));
            for i in 0..MAX_WIDTH {
                let exact = scalar_logistic(t[i]);
                assert!((values[i] - exact).abs() < 3e-14, "{level} {}", t[i]);
                assert!((slopes[i] - exact * (1.0 - exact)).abs() < 3e-14, "{level}");
            }
        }
    }
}

/// Bounds of a factor and of its derivatives.
struct Bounds(Magnet, f64, f64);

impl Task for Bounds {
    type Output = [f64; 3];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f64; 3] {
        let Self(magnet, turn, r) = self;
        let shield = Vectors::splat(l, &magnet).shield;
        let (turn, r, inverse) = (l.splat(turn), l.splat(r), l.splat(1.0 / r));
        let [value, slope, bend] = factor_limits(l, shield, turn, r, inverse);
        [l.first(value), l.first(slope), l.first(bend)]
    }
}

#[test]
fn factors_stay_within_their_bounds() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for magnet in random_magnets(&mut rng, 400) {
        let Some(shield) = magnet.front.0.filter(|shield| shield.width > 0.03) else {
            continue;
        };
        let (r, turn, step) = (turned(rng.random_range(-3.1..3.1)) * 0.05, 5.0, 1e-4);
        // The other magnet moves one way and this one's face turns.
        let way = turned(rng.random_range(-3.1..3.1));
        let angle = rng.random_range(-3.1..3.1);
        let at = |s: f64| {
            let place = r + way * s;
            let cosine = turned(angle + turn * s).dot(&place) / place.norm();
            shield.factor(place.norm(), cosine).value
        };
        let first = (at(step) - at(-step)) / (2.0 * step);
        let second = (at(step) - 2.0 * at(0.0) + at(-step)) / (step * step);
        let [g0, g1, g2] = Level::best().run(Bounds(magnet, turn, 0.05 - 2.0 * step));
        assert!(at(0.0) <= g0 && first.abs() <= g1, "{shield:?}");
        assert!(
            second.abs() <= g2 * (1.0 + 1e-3),
            "{shield:?} {second} {g2}"
        );
    }
}
