//! Laws that every kind of energy obeys.

use nalgebra::{Matrix3, Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::potential::Potential;
use tilebind::potential::dipole::dipoles;
use tilebind::potential::shielding::{Shield, Shields};
use tilebind::potential::simd::Level;

use super::kinds::{Kind, all, placed};
use crate::plain::Plain;

const NOWHERE: Configuration = Configuration::new(0.0, 0.0, 0.0);

/// The largest error, in units of the allowed one.
#[derive(Default)]
struct Worst(f64, String);

impl Worst {
    fn see(&mut self, off: f64, allowed: f64, at: &Configuration) {
        let share = off / allowed;
        if off != 0.0 && (share > self.0 || share.is_nan()) {
            *self = Self(share, format!("{at:?}: {off:e} of {allowed:e}"));
        }
    }

    fn check(&self, kind: &Kind) {
        println!("{}: {}", kind.name, self.0);
        assert!(self.0 <= 1.0, "{}: off by more at {}", kind.name, self.1);
    }
}

/// Energy and gradient, with what they are compared with: see `Exact::seen`.
fn measured(potential: &dyn Potential, q: &Configuration) -> (f64, Vector3<f64>, [f64; 3]) {
    let (energy, gradient) = potential.energy_and_gradient(q);
    let force = gradient.xy().norm();
    let sizes = [energy.abs().min(0.01 * force), force, 0.05 * force];
    (energy, gradient, sizes)
}

fn step(axis: usize, by: f64) -> Vector3<f64> {
    let mut step = Vector3::zeros();
    step[axis] = by;
    step
}

#[test]
fn forces_and_torques_are_derivatives_without_curl() {
    for kind in all() {
        let potential = kind.energy(Level::best());
        let [length, turn] = kind.exact.steps;
        let (mut slopes, mut curls) = (Worst::default(), Worst::default());
        for q in &kind.poses {
            let (_, gradient, [_, force, _]) = measured(&*potential, q);
            let mut hessian = Matrix3::zeros();
            for (axis, h) in [length, length, turn].into_iter().enumerate() {
                let at = |n: f64| potential.energy_and_gradient(&q.moved(step(axis, n * h)));
                let [(a, ga), (b, gb), (c, gc), (d, gd)] = [-2.0, -1.0, 1.0, 2.0].map(at);
                let slope = (8.0 * (c - b) - (d - a)) / (12.0 * h);
                let lever = if axis == 2 { kind.exact.lever } else { 1.0 };
                let off = (slope - gradient[axis]).abs();
                slopes.see(off, kind.exact.slope * force * lever, q);
                hessian.set_column(axis, &(((gc - gb) * 8.0 - (gd - ga)) / (12.0 * h)));
            }
            let curl = (hessian - hessian.transpose()).norm();
            curls.see(curl, 1e-7 * hessian.norm(), q);
        }
        slopes.check(&kind);
        curls.check(&kind);
    }
}

/// In the other tile's frame, in which the first one is at the inverse configuration, the energy is
/// the same, forces are opposite, and torques and the force's lever add up to zero.
#[test]
fn action_equals_reaction() {
    for kind in all() {
        let here = kind.energy(Level::best());
        let [a, b] = kind.tiles.clone();
        let exchanged = Shields {
            rule: kind.shields.rule,
            fixed: kind.shields.moving.clone(),
            moving: kind.shields.fixed.clone(),
        };
        let there = kind.energy_of(&[b, a], &exchanged, Level::best());
        let mut worst = Worst::default();
        for q in &kind.poses {
            let (energy, gradient, sizes) = measured(&*here, q);
            let (other, reaction) = there.energy_and_gradient(&q.inverse());
            let back = q.rotation() * reaction.xy();
            let total = gradient.z + reaction.z + q.position().perp(&gradient.xy());
            let off = [
                (energy - other).abs(),
                (back + gradient.xy()).norm(),
                total.abs(),
            ];
            for k in 0..3 {
                worst.see(off[k], kind.exact.seen[k] * sizes[k], q);
            }
        }
        worst.check(&kind);
    }
}

/// The configuration `then` in a frame at `first`.
fn both(first: &Configuration, then: &Configuration) -> Configuration {
    let place = first.transform(then.position());
    Configuration::new(place.x, place.y, first.theta + then.theta)
}

/// Energies, forces and torques do not depend on the frames chosen for the tiles.
#[test]
fn tiles_may_be_told_in_any_frame() {
    let elsewhere = Configuration::new(0.03, -0.05, 0.9);
    for kind in all() {
        let potential = kind.energy(Level::best());
        let [a, b] = &kind.tiles;
        let tiles = [placed(a, &elsewhere, 1.0), b.clone()];
        let both_moved = kind.energy_of(&tiles, &kind.shields, Level::best());
        let tiles = [a.clone(), placed(b, &elsewhere, 1.0)];
        let renamed = kind.energy_of(&tiles, &kind.shields, Level::best());
        let mut worst = Worst::default();
        for q in &kind.poses {
            let (energy, gradient, sizes) = measured(&*potential, q);
            let mut see = |(other, slope): (f64, Vector3<f64>), force: Vector2<f64>, turn: f64| {
                let off = [
                    (energy - other).abs(),
                    (force - slope.xy()).norm(),
                    (turn - slope.z).abs(),
                ];
                for k in 0..3 {
                    worst.see(off[k], kind.exact.seen[k] * sizes[k], q);
                }
            };
            let moved = both_moved.energy_and_gradient(&both(&elsewhere, q));
            see(moved, elsewhere.rotation() * gradient.xy(), gradient.z);
            let there = both(q, &elsewhere.inverse());
            let way = there.position() - q.position();
            // The torque about the new reference point.
            let turn = gradient.z - way.perp(&gradient.xy());
            see(renamed.energy_and_gradient(&there), gradient.xy(), turn);
        }
        worst.check(&kind);
    }
}

/// With the cube of the length at constant remanence, and with either tile's remanence.
#[test]
fn energies_scale_with_the_volume_and_the_square_of_the_remanence() {
    for kind in all() {
        let small = kind.energy(Level::best());
        let mut worst = Worst::default();
        for length in [1e-3, 7.0] {
            let mut tiles = kind
                .tiles
                .each_ref()
                .map(|tile| placed(tile, &NOWHERE, length));
            for magnet in &mut tiles[1].magnets {
                magnet.moment *= 0.5;
            }
            let scaled = |shield: &Option<Shield>| {
                shield.map(|shield| Shield {
                    length: shield.length * length,
                    ..shield
                })
            };
            let shields = Shields {
                rule: kind.shields.rule,
                fixed: kind.shields.fixed.iter().map(scaled).collect(),
                moving: kind.shields.moving.iter().map(scaled).collect(),
            };
            let large = kind.energy_of(&tiles, &shields, Level::best());
            for q in &kind.poses {
                let (energy, slope) = small.energy_and_gradient(q);
                let there = Configuration::new(q.x * length, q.y * length, q.theta);
                let (other, steep) = large.energy_and_gradient(&there);
                let times = length.powi(3) * 0.5;
                let off = (other / times - energy).abs();
                worst.see(off, kind.exact.scaled * energy.abs(), q);
                let steep = steep.component_mul(&Vector3::new(length, length, 1.0)) / times;
                let size = kind.exact.seen[1].max(1e-9) * slope.norm();
                worst.see((steep - slope).norm(), size, q);
            }
        }
        worst.check(&kind);
    }
}

/// At least as the cube of the distance, forces as the fourth power, in every direction, but for
/// what is lost of large terms that cancel.
#[test]
fn energies_fall_as_the_cube() {
    for kind in all() {
        let potential = kind.energy(Level::best());
        let plain = plain(&kind);
        for direction in 0..12 {
            let turn = 0.5 * f64::from(direction);
            let (sin, cos) = turn.sin_cos();
            let [near, far] =
                [1e4, 2e4].map(|r| Configuration::new(r * cos, r * sin, 2.0 * turn + 0.3));
            let [(u, slope), (v, flat)] = [near, far].map(|q| potential.energy_and_gradient(&q));
            let (lost, name) = (2e-11 * plain.magnitudes(&far).0, &kind.name);
            assert!(v.abs() <= 1.05 * u.abs() / 8.0 + lost, "{name}: {u} {v}");
            let [u, v] = [slope, flat].map(|slope| slope.xy().norm());
            let lost = 3.0 * lost / 2e4;
            assert!(v <= 1.05 * u / 16.0 + lost, "{name}: {u} {v}");
        }
    }
}

/// Whichever function computes them, whatever else is in a batch and at whichever position.
#[test]
fn one_or_many_give_the_same_bits() {
    for kind in all() {
        for level in Level::available() {
            let potential = kind.energy(level);
            let qs: Vec<_> = kind.poses.iter().chain(&kind.anywhere).collect();
            let qs: Vec<_> = qs.into_iter().take(37).copied().collect();
            for start in (0..10).step_by(if potential.is_expensive() { 5 } else { 1 }) {
                let qs = &qs[start..];
                let mut energies = vec![0.0; qs.len()];
                potential.energies(qs, &mut energies);
                let mut both = vec![(0.0, Vector3::zeros()); qs.len()];
                potential.energies_and_gradients(qs, &mut both);
                for (i, q) in qs.iter().enumerate() {
                    let at = format!("{}, {level}: {q:?}", kind.name);
                    assert_eq!(both[i], potential.energy_and_gradient(q), "{at}");
                    assert_eq!(both[i].0.to_bits(), energies[i].to_bits(), "{at}");
                    assert_eq!(both[i].0.to_bits(), potential.energy(q).to_bits(), "{at}");
                }
            }
        }
    }
}

/// At any place of the tiles, even on top of each other.
#[test]
fn energies_are_numbers_everywhere() {
    for kind in all() {
        let twice = [kind.tiles[0].clone(), kind.tiles[0].clone()];
        let on_itself = kind.energy_of(&twice, &kind.shields, Level::best());
        let (energy, gradient) = on_itself.energy_and_gradient(&NOWHERE);
        let number = energy > f64::NEG_INFINITY && gradient.iter().all(|g| g.is_finite());
        assert!(number, "{}", kind.name);
        let potential = kind.energy(Level::best());
        let inside = kind
            .poses
            .iter()
            .map(|q| Configuration { x: 0.3 * q.x, ..*q });
        for q in inside.chain(kind.anywhere.iter().copied()) {
            let (energy, gradient) = potential.energy_and_gradient(&q);
            let finite = energy.is_finite() && gradient.iter().all(|g| g.is_finite());
            assert!(finite, "{}: {q:?}", kind.name);
        }
    }
}

#[test]
fn without_magnets_there_is_no_energy() {
    let q = Configuration::new(0.5, 0.0, 0.0);
    for kind in all() {
        for (level, number) in Level::available()
            .into_iter()
            .flat_map(|l| [(l, 0), (l, 1)])
        {
            let mut tiles = kind.tiles.clone();
            tiles[number].magnets.clear();
            let potential = kind.energy_of(&tiles, &kind.shields, level);
            assert_eq!(potential.energy_and_gradient(&q), (0.0, Vector3::zeros()));
            let bound = potential.curvature_bound(&q, 0.1);
            assert!(bound == 0.0 || kind.bounds.is_none() && bound > 0.0);
        }
    }
}

/// By the formulas of Jackson and of the shields, one pair after the other.
#[test]
fn energies_of_dipoles_are_those_of_the_plain_formulas() {
    for kind in all() {
        let Some([energies, gradients]) = kind.exact.plain else {
            continue;
        };
        let plain = plain(&kind);
        let potentials = Level::available()
            .into_iter()
            .map(|level| kind.energy(level));
        let potentials: Vec<_> = potentials.collect();
        let mut worst = Worst::default();
        for q in kind.anywhere.iter().chain(&kind.poses) {
            let (expected, slope) = plain.energy_and_gradient(q);
            let (size, sizes) = plain.magnitudes(q);
            for potential in &potentials {
                let (energy, gradient) = potential.energy_and_gradient(q);
                worst.see((energy - expected).abs(), energies * size, q);
                for axis in 0..3 {
                    let off = (gradient[axis] - slope[axis]).abs();
                    worst.see(off, gradients * sizes[axis], q);
                }
            }
        }
        worst.check(&kind);
    }
}

fn plain(kind: &Kind) -> Plain {
    let [a, b] = &kind.tiles;
    if kind.shields == Shields::default() {
        Plain::new(&dipoles(&a.magnets), &dipoles(&b.magnets))
    } else {
        Plain::shielded([a, b], &kind.shields)
    }
}

/// Derivatives along motions, by differences, stay below their bounds; and the bounds are
/// approached, as they would otherwise be of little use.
#[test]
fn derivatives_along_motions_are_bounded() {
    for kind in all() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let potential = kind.energy(Level::best());
        let plain = plain(&kind);
        let mut reached = [0.0f64; 3];
        let h = 1e-3;
        // Of dipoles all along the way within reach; blocks that meet have bounds of averages.
        let ways: &[[f64; 2]] = if kind.exact.wider.is_some() {
            &[[2.0, 0.0], [10.0, -8.0], [10.0, 0.0], [10.0, 8.0]]
        } else {
            &[[2.0, 0.0]]
        };
        for q in &kind.poses {
            let size = kind.exact.lost * plain.magnitudes(q).0;
            for (i, [reach, middle]) in (0..8).flat_map(|i| ways.iter().map(move |way| (i, way))) {
                let mut direction = || rng.random_range(-1.0..1.0);
                let turns = [0.0, 5.0, 20.0][i % 3];
                let step = Vector3::new(direction(), direction(), turns * direction());
                let step = step / potential.displacement(step);
                let at = |k: f64| potential.energy(&q.moved(step * ((middle + k) * h)));
                let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(at);
                let found = [
                    (b - 2.0 * c + d) / (h * h),
                    (e - 2.0 * d + 2.0 * b - a) / (2.0 * h.powi(3)),
                    (a - 4.0 * b + 6.0 * c - 4.0 * d + e) / h.powi(4),
                ];
                let reach = reach * h;
                let bounds = [
                    potential.curvature_bound(q, reach),
                    potential.bend_bounds(q, reach)[1],
                    potential.fourth_derivative_bound(q, reach),
                ];
                for k in 0..3 {
                    let bound = bounds[k] + size / h.powi(k as i32 + 2);
                    let at = format!("{}, {}: {q:?}", kind.name, k + 2);
                    assert!(found[k].abs() <= bound, "{at}: {} {bound}", found[k]);
                    if bound.is_finite() {
                        reached[k] = reached[k].max(found[k].abs() / bound);
                    }
                }
            }
        }
        println!("{}: {reached:?}", kind.name);
        for (found, least) in reached.iter().zip(kind.exact.reached) {
            assert!(*found >= least, "{}: {reached:?}", kind.name);
        }
    }
}

/// Of bare dipoles they are those of the plain formula, of groups not much wider, but for tiles
/// beyond the table, which are bounded as wholes.
#[test]
fn bounds_of_derivatives_are_as_narrow_as_the_plain_formula_s() {
    for kind in all() {
        let Some(wider) = kind.exact.wider else {
            continue;
        };
        let plain = plain(&kind);
        let levels = Level::available().into_iter();
        let potentials: Vec<_> = levels.map(|level| (level, kind.energy(level))).collect();
        let grouped = wider > 1.5;
        let near = |q: &&Configuration| !grouped || q.x <= 1.5;
        let reaches: &[f64] = if grouped {
            &[0.002]
        } else {
            &[0.0, 0.002, 0.02]
        };
        for q in kind.anywhere.iter().filter(near) {
            for &reach in reaches {
                let expected = [
                    plain.curvature_bound(q, reach),
                    plain.fourth_derivative_bound(q, reach),
                ];
                for (level, potential) in &potentials {
                    let bounds = [
                        potential.curvature_bound(q, reach),
                        potential.fourth_derivative_bound(q, reach),
                    ];
                    for (bound, expected) in bounds.into_iter().zip(expected) {
                        let ratio = bound / expected;
                        let at = format!("{}, {level}, {reach}: {q:?}", kind.name);
                        let alike = ratio <= wider && (grouped || ratio >= 2.0 - wider);
                        assert!(bound == expected || alike, "{at}: {bound} {expected}");
                    }
                }
            }
        }
    }
}

/// No magnet moves farther than is said.
#[test]
fn displacements_are_those_of_the_farthest_magnet() {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    for kind in all() {
        let potential = kind.energy(Level::best());
        for q in &kind.poses {
            let mut random = || rng.random_range(-0.01..0.01);
            let step = Vector3::new(random(), random(), random());
            let there = q.moved(step);
            let moved = kind.tiles[1].magnets.iter().map(|magnet| {
                let way = there.transform(magnet.position) - q.transform(magnet.position);
                way.norm()
            });
            let farthest = moved.fold(0.0, f64::max);
            assert!(farthest <= potential.displacement(step), "{}", kind.name);
        }
    }
}
