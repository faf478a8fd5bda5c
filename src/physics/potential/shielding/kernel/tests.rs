//! The vectors against the plain formulas.

use super::super::{Shield, logistic as scalar_logistic, pair_factor as scalar_factor};
use super::curvature::{Around, factor_limits};
use super::factor::logistic;
use super::jet::factors;
use super::*;
use crate::cell::Cell;
use crate::potential::batch::Level;
use crate::potential::batch::lanes::WIDTH;
use crate::potential::dipole;
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
            let columns = Columns::new(&fixed);
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

/// Bounds of a factor and of its derivatives on a way near the place of the other magnet.
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

/// All along ways of several lengths, by differences.
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
            shield
                .factor(place.norm(), turned.dot(&place) / place.norm())
                .value
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
                // A hundredth for what differences are off by, and their rounding.
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
    // Of all, the closest are close: a bound that lost its sense would not be.
    assert!(
        count > 4000 && tightest.iter().all(|ratio| *ratio < 3.0),
        "{count} {tightest:?}"
    );
}

/// Derivatives of products of factors and energies, as the cells' forms have them, against
/// differences of the plain formulas.
#[test]
fn forms_have_the_energy_s_derivatives() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for level in Level::available() {
        for _ in 0..50 {
            let (mut fixed, mut moving) =
                (random_magnets(&mut rng, 5), random_magnets(&mut rng, 3));
            for magnet in fixed.iter_mut().chain(&mut moving) {
                if let Some(shield) = &mut magnet.front.0 {
                    shield.width = shield.width.max(0.2);
                }
            }
            let place = turned(rng.random_range(-3.1..3.1)) * rng.random_range(0.15..0.3);
            let q = Configuration::new(place.x, place.y, rng.random_range(-3.1..3.1));
            let columns = Columns::new(&fixed);
            let mut rest = Vec::new();
            let (form, left_out) = level.run(Forms {
                fixed: &columns,
                moving: &moving,
                cell: &Cell {
                    centre: q,
                    half: [0.0; 3],
                },
                count: fixed.len(),
                extent: 0.1,
                rest: &mut rest,
            });
            assert!(rest.is_empty() && left_out < 1e-8);
            let at = |q: &Configuration| {
                level.run(Sum::<true> {
                    fixed: &columns,
                    moving: &moving,
                    q,
                    pairs: None,
                    faces: None,
                })
            };
            let (energy, gradient) = at(&q);
            let close = |a: f64, b: f64, of: f64| (a - b).abs() < 1e-6 * (of + b.abs());
            assert!(close(form.value, energy, 0.0), "{level}");
            let [xx, yy, tt, xy, xt, yt] = form.hessian;
            let rows = [[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]];
            let size = rows
                .as_flattened()
                .iter()
                .fold(0.0, |a: f64, b| a.max(b.abs()));
            for i in 0..3 {
                assert!(
                    close(form.gradient[i], gradient[i], gradient.norm()),
                    "{level}"
                );
                let step = [1e-5, 1e-5, 1e-4][i];
                let moved = |by: f64| {
                    let mut d = Vector3::zeros();
                    d[i] = by;
                    at(&q.moved(d)).1
                };
                let slope = (moved(step) - moved(-step)) / (2.0 * step);
                for k in 0..3 {
                    assert!(
                        close(rows[i][k], slope[k], size),
                        "{level} {i} {k} {rows:?} {slope}"
                    );
                }
            }
        }
    }
}
