//! Tests of the SIMD vectors against the plain formulas.

use super::super::{Shield, logistic as scalar_logistic};
use super::curvature::{Around, factor_limits};
use super::factor::logistic;
use super::jet::factors;
use super::*;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::WIDTH;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn turned(angle: f64) -> Vector2<f64> {
    Vector2::new(libm::cos(angle), libm::sin(angle))
}

fn random_magnets(rng: &mut ChaCha8Rng, count: usize) -> Vec<Magnet> {
    let mut magnet = |k: usize| Magnet {
        position: turned(rng.random_range(-3.1..3.1)) * rng.random_range(0.01..0.06),
        moment: turned(rng.random_range(-3.1..3.1)) * 0.3,
        front: (
            (!k.is_multiple_of(3)).then(|| Shield {
                attenuation: rng.random_range(0.0..1.0),
                length: rng.random_range(0.01..0.1),
                width: libm::pow(10f64, rng.random_range(-3.0..0.0)),
                front_gain: rng.random_range(0.8..1.3),
            }),
            turned(rng.random_range(-3.1..3.1)),
        ),
        face: k,
    };
    (0..count).map(&mut magnet).collect()
}

/// S and its derivative at several arguments.
struct Logistics([f64; WIDTH]);

impl Task for Logistics {
    type Output = [[f64; WIDTH]; 2];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Self::Output {
        let mut out = [[0.0; WIDTH]; 2];
        let [value, slope] = logistic(l, l.load(&self.0));
        l.store(value, &mut out[0]);
        l.store(slope, &mut out[1]);
        out
    }
}

#[test]
fn the_logistic_function_is_that_of_the_standard_library() {
    for level in Level::available() {
        for k in 0..4000 {
            let t = std::array::from_fn(|i| 0.004 * f64::from(8 * k + i as i32) - 64.0);
            let [values, slopes] = level.run(Logistics(t));
            for i in 0..WIDTH {
                let exact = scalar_logistic(t[i]);
                assert!((values[i] - exact).abs() < 3e-14, "{level} {}", t[i]);
                assert!((slopes[i] - exact * (1.0 - exact)).abs() < 3e-14, "{level}");
            }
        }
    }
}

/// Bounds of a factor and of its derivatives on a motion near the place of the other magnet.
struct Bounds {
    magnet: Magnet,
    place: Vector2<f64>,
    reach: f64,
    turn: f64,
}

impl Task for Bounds {
    type Output = [f64; 4];

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f64; 4] {
        let first = Vectors::splat(l, &self.magnet);
        let bare = Magnet {
            position: self.place,
            front: (None, self.place),
            ..self.magnet
        };
        let second = Vectors::splat(l, &bare);
        let way = Way::new(l, &first, &second);
        let r = l.sub(way.distance, l.splat(self.reach));
        let around = Around {
            reach: l.splat(self.reach),
            turn: l.splat(self.turn),
            r,
            inverse: l.reciprocal(r),
        };
        let ([jet, _], [steep, _]) = factors(l, &first, &second, &way);
        let limits = factor_limits(l, first.shield, &around, steep, jet.0[0]);
        let mut out = [0.0; 4];
        for (bound, limit) in out.iter_mut().zip(limits) {
            *bound = l.first(limit);
        }
        out
    }
}

/// Along motions of several lengths, by differences.
#[test]
fn factors_stay_within_their_bounds() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let (mut count, mut tightest) = (0, [f64::INFINITY; 4]);
    for magnet in random_magnets(&mut rng, 4000) {
        let Some(shield) = magnet.front.0.filter(|shield| shield.width > 0.03) else {
            continue;
        };
        let magnet = Magnet {
            position: Vector2::zeros(),
            ..magnet
        };
        let start = turned(rng.random_range(-3.1..3.1)) * 0.05;
        let (turn, reach) = (5.0, libm::pow(10f64, rng.random_range(-3.0..-1.7)));
        // The other magnet moves one way and this one's face turns.
        let way = turned(rng.random_range(-3.1..3.1));
        let normal = magnet.front.1;
        let at = |s: f64| {
            let place = start + way * s;
            let (sin, cos) = libm::sincos(turn * s);
            let turned = Vector2::new(
                normal.x * cos - normal.y * sin,
                normal.x * sin + normal.y * cos,
            );
            shield.factor(place.norm(), turned.dot(&place) / place.norm())
        };
        let bounds = Level::best().run(Bounds {
            magnet,
            place: start,
            reach,
            turn,
        });
        for _ in 0..4 {
            let (s, h) = (reach * rng.random_range(-0.8..0.8), 1e-4);
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| at(s + k * h));
            let here = at(s);
            let found = [
                here.abs(),
                (c - b).abs() / (2.0 * h),
                (b - 2.0 * here + c).abs() / (h * h),
                (d - 2.0 * c + 2.0 * b - a).abs() / (2.0 * h * h * h),
            ];
            for k in 0..4 {
                // A hundredth for the error of differences and their rounding.
                let off = 1e-2 * bounds[k] + 1e-15 / h.powi(k as i32);
                assert!(
                    found[k] <= bounds[k] + off,
                    "{shield:?} {k}: {found:?} {bounds:?}"
                );
                tightest[k] = tightest[k].min(bounds[k] / found[k]);
            }
            count += 1;
        }
    }
    // The closest bounds are tight; a meaningless bound would not be.
    assert!(
        count > 4000 && tightest.iter().all(|ratio| *ratio < 3.0),
        "{count} {tightest:?}"
    );
}
