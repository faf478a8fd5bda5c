//! Tests against sums over both faces, of the series against the faces, and of slopes against differences.

use nalgebra::{Vector2, Vector3};

use super::face::{ChargedFace, Shape};
use super::near::{alone as integral, exact};
use super::{Body, BodyPotential};
use crate::configuration::Configuration;
use crate::potential::cuboid::quadrature::gauss_legendre;
use crate::potential::{MagnetModel, Potential};
use crate::tile::Magnet;
use crate::tile::magnet::{Form, Shape as Kind, Standing};
use crate::units::MU0_OVER_4PI;

const DISC: Shape = Shape::Disc(0.8);
const BOX: Shape = Shape::Rectangle([0.7, 0.4]);

fn points(face: &ChargedFace) -> Vec<(Vector3<f64>, f64)> {
    let [x, w] = gauss_legendre::<24>();
    let mut all = Vec::new();
    let mut add = |a: f64, b: f64, weight: f64| {
        all.push((face.centre + face.frame[0] * a + face.frame[1] * b, weight));
    };
    for i in 0..24 {
        match face.shape {
            Shape::Disc(radius) => {
                let r = radius * (x[i] + 1.0) / 2.0;
                for k in 0..64 {
                    let (sin, cos) = libm::sincos(f64::from(k) / 64.0 * std::f64::consts::TAU);
                    add(
                        r * cos,
                        r * sin,
                        w[i] / 2.0 * radius * r * std::f64::consts::TAU / 64.0,
                    );
                }
            }
            Shape::Rectangle([a, b]) => {
                for k in 0..24 {
                    add(a * x[i], b * x[k], a * b * w[i] * w[k]);
                }
            }
        }
    }
    all
}

fn summed(first: &ChargedFace, second: &ChargedFace) -> f64 {
    let second = points(second);
    points(first)
        .iter()
        .map(|(p, v)| {
            second
                .iter()
                .map(|(q, w)| v * w / (p - q).norm())
                .sum::<f64>()
        })
        .sum()
}

/// Faces of every two shapes, upright or flat, at a distance and in contact: the integral is that of
/// sums over both, the same from either side, and its derivatives are those of differences.
#[test]
fn integrals_agree_with_sums() {
    let other = |upright: bool, shape, [x, y, angle]: [f64; 3], height| {
        let centre = Vector2::new(x, y);
        let (sin, cos) = libm::sincos(angle);
        let along = Vector2::new(cos, sin);
        if upright {
            ChargedFace::upright(centre, along, shape)
        } else {
            ChargedFace::flat(centre, along, height, shape)
        }
    };
    let far = 1e-9;
    for (upright, a, b) in [
        (true, Shape::Disc(1.0), DISC),
        (true, Shape::Disc(1.0), BOX),
        (true, BOX, DISC),
        (false, Shape::Disc(1.0), DISC),
        (false, Shape::Disc(1.0), BOX),
        (false, BOX, DISC),
    ] {
        // With the error of the sums, which are coarse where faces are close.
        let poses: &[([f64; 3], f64)] = if upright {
            &[
                ([0.5, 0.2, 0.2], 1e-2),
                ([2.5, 0.9, 1.4], 1e-6),
                ([3.0, 0.2, 0.02], far),
                ([0.001, 0.1, 0.0], 1e-1),
                ([20.0, 2.0, 2.0], far),
                ([0.0, 4.8, 0.0], far),
                ([4e-5, 0.0, 0.0], 1e-1),
            ]
        } else {
            &[
                ([2.4, 0.2, 0.2], 1e-4),
                ([3.9, 1.1, 1.4], far),
                ([1.82, 0.0, 0.0], 1e-3),
                ([20.0, 2.0, 2.0], far),
                ([1.7, 1.0, 0.0], 1e-3),
            ]
        };
        for ((pose, coarse), height) in poses.iter().flat_map(|p| [0.0, 0.3].map(|h| (*p, h))) {
            if upright && height > 0.0 {
                continue;
            }
            let first = other(upright, a, [0.0; 3], 0.0);
            let of = |pose| integral(&first, &other(upright, b, pose, height));
            let found = of(pose);
            let back = integral(&other(upright, b, pose, height), &first).value;
            let place = format!("{upright} {a:?} {b:?} {pose:?} {height}: {found:?}");
            assert!((back / found.value - 1.0).abs() < 1e-9, "{place} {back}");
            let sum = summed(&first, &other(upright, b, pose, height));
            assert!((sum / found.value - 1.0).abs() < coarse, "{place} {sum}");
            let slopes = [found.gradient.x, found.gradient.y, found.slope];
            for (k, slope) in slopes.into_iter().enumerate() {
                let step = 1e-5;
                let moved = |by: f64| {
                    let mut there = pose;
                    there[k] += by;
                    of(there).value
                };
                let difference = (moved(step) - moved(-step)) / (2.0 * step);
                // On the axis of a touching disc the force jumps.
                let smooth = pose[0].abs() > 1e-3 || pose[1].abs() > 1e-3;
                let allowed = if smooth { 2e-6 } else { 20.0 };
                assert!(
                    (slope - difference).abs() < allowed,
                    "{place} {k} {difference}"
                );
            }
        }
    }
}

fn magnet(stands: bool, shape: Kind, [x, y, angle]: [f64; 3], size: [f64; 3]) -> Magnet {
    Magnet {
        position: Vector2::new(x, y),
        angle,
        moment: 1.0,
        size,
        form: Form {
            shape,
            stands: stands.then_some(Standing::Up),
        },
        face: 0,
    }
}

/// A block's pole faces cut into `n` x `n` points each, and their charges for a moment of 1 A m^2.
fn charges(body: &Body, n: usize) -> Vec<(Vector3<f64>, f64)> {
    let [a, b, c] = body.size;
    let across = Vector2::new(-body.direction.y, body.direction.x);
    let at = |k: usize, length: f64| ((k as f64 + 0.5) / n as f64 - 0.5) * length;
    let mut all = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let place = body.position + body.direction * at(i, a) + across * at(j, b);
            for side in [1.0, -1.0] {
                let charge = side / (c * (n * n) as f64);
                all.push((place.push(side * c / 2.0), charge));
            }
        }
    }
    all
}

/// Upright blocks of unequal sizes at an angle: the energy is that of many point charges, and its
/// derivatives are those of differences, also where they touch.
#[test]
fn upright_blocks_agree_with_point_charges() {
    let body = |pose, size| Body::from(&magnet(true, Kind::Block, pose, size));
    let first = body([0.0; 3], [1.0, 1.4, 0.5]);
    for (pose, coarse) in [
        ([1.9, 0.3, 0.4], 2e-3),
        ([1.3, -0.4, 1.1], 1e-2),
        ([1.05, 0.3, 0.0], 2e-2),
        ([-0.3, 1.3, 0.0], 2e-2),
    ] {
        for size in [[0.8, 0.6, 0.5], [0.9, 1.0, 0.3]] {
            let of = |pose| exact(&first, &body(pose, size));
            let found = of(pose);
            let energy = |n| {
                let second = charges(&body(pose, size), n);
                let mut sum = 0.0;
                for (place, charge) in charges(&first, n) {
                    sum += second
                        .iter()
                        .map(|(other, its)| charge * its / (place - other).norm())
                        .sum::<f64>();
                }
                sum * MU0_OVER_4PI
            };
            // The error of midpoints falls like the square of their spacing.
            let sum = (4.0 * energy(32) - energy(16)) / 3.0;
            assert!(
                (sum / found.energy - 1.0).abs() < coarse,
                "{pose:?} {sum} {found:?}"
            );
            let slopes = [found.gradient.x, found.gradient.y, found.slope];
            for (k, slope) in slopes.into_iter().enumerate() {
                let step = 1e-4;
                let moved = |by: f64| {
                    let mut there = pose;
                    there[k] += by;
                    of(there).energy
                };
                let difference = (moved(step) - moved(-step)) / (2.0 * step);
                let off = (slope - difference).abs() / found.energy.abs();
                assert!(off < 1e-5, "{pose:?} {k} {slope} {difference}");
            }
        }
    }
}

/// Right where the series replaces the faces both agree, for magnets of every kind, to the stated
/// share of the dipoles' energy.
#[test]
fn series_and_faces_agree_where_they_meet() {
    let size = [0.009, 0.010, 0.004];
    for (stands, shape) in [(true, Kind::Block), (false, Kind::Disc), (true, Kind::Disc)] {
        let size = match (stands, shape) {
            (_, Kind::Block) => size,
            (true, Kind::Disc) => [0.010, 0.010, 0.004],
            (false, Kind::Disc) => [0.004, 0.010, 0.010],
        };
        let first = magnet(stands, shape, [0.0, 0.0, 0.3], size);
        let second = magnet(stands, shape, [0.0; 3], size);
        let potential = BodyPotential::new(
            MagnetModel::Cuboid,
            std::slice::from_ref(&first),
            std::slice::from_ref(&second),
        );
        let reach = potential.reach();
        for k in 0..60 {
            let (phi, theta) = (0.7 * f64::from(k), 1.3 * f64::from(k));
            let r = reach * (1.0 + 1e-3 * f64::from(k % 3));
            let q = Configuration::new(r * libm::cos(phi), r * libm::sin(phi), theta);
            let moved = magnet(stands, shape, [q.x, q.y, q.theta], size);
            let faces = exact(&Body::from(&first), &Body::from(&moved));
            let dipoles = MU0_OVER_4PI / r.powi(3);
            let (energy, gradient) = potential.energy_and_gradient(&q);
            let off = (energy - faces.energy).abs() / dipoles;
            assert!(off < 2e-9, "{stands} {shape:?} {q:?}: {off}");
            let slopes = [faces.gradient.x * r, faces.gradient.y * r, faces.slope];
            let series = [gradient.x * r, gradient.y * r, gradient.z];
            for (slope, by_series) in slopes.into_iter().zip(series) {
                let off = (slope - by_series).abs() / dipoles;
                assert!(off < 1e-7, "{stands} {shape:?} {q:?}: {off}");
            }
        }
    }
}

/// Exactly above the rim of a disc, where the third kind is infinite, its potential is that beside it, and
/// so is the energy of two discs that are aside by their radius.
#[test]
fn a_place_above_the_rim_is_no_other() {
    let body = |x: f64, y: f64, radius: f64| Body {
        position: Vector2::new(x, y),
        direction: Vector2::new(1.0, 0.0),
        moment: 1.0,
        size: [3e-3, 2.0 * radius, 2.0 * radius],
        shape: Kind::Disc,
        stands: false,
    };
    for (first, second) in [(1.5e-3, 1.5e-3), (2e-3, 1.5e-3), (1.5e-3, 4e-3)] {
        let of = |aside: f64| {
            let pair = [body(0.0, 0.0, first), body(4.2e-3, aside, second)];
            exact(&pair[0], &pair[1]).energy
        };
        for aside in [first, second, -first, -second] {
            let [here, beside] = [of(aside), of(aside * (1.0 + 1e-9))];
            assert!(
                (here - beside).abs() < 1e-7 * beside.abs(),
                "{here} {beside}"
            );
        }
    }
}

/// Discs of one size, one of which nearly touches the other's face with its rim: the integrals along either
/// axis agree. Elliptic integrals that are continued to the wrong side lose digits, or all.
#[test]
fn a_rim_that_grazes_a_face_loses_no_digits() {
    let disc = |x: f64, y: f64, angle: f64| {
        let size = [0.005, 0.016, 0.016];
        Body::from(&magnet(false, Kind::Disc, [x, y, angle], size))
    };
    let first = disc(0.0, 0.0, 0.0);
    for k in 0..400 {
        let share = |by: f64| (f64::from(k) * by).fract();
        let tilt = 0.6 * share(0.618) - 0.3;
        let (sin, cos) = libm::sincos(tilt);
        let reach = (0.005 * cos + 0.016 * sin.abs()) / 2.0;
        let gap = 1e-6 + 2e-4 * share(0.414).powi(4);
        let second = disc(0.0025 + gap + reach, 0.02 * share(0.732) - 0.01, tilt);
        let [here, there] = [exact(&first, &second), exact(&second, &first)];
        let off = (here.energy - there.energy).abs() / 4e-8;
        let slope = (here.gradient + there.gradient).norm() / 4e-5;
        assert!(off.max(slope) < 1e-4, "{k}: {off} {slope} {here:?}");
    }
}
