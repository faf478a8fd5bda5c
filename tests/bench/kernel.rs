//! The speed of the dipole kernel, and how close it comes to the limit of the core.
//!
//! The ceiling is measured in the same run: a loop does as many simple and fused vector operations
//! and guesses of `1 / sqrt` as the pairs take, but none that waits for another. A kernel's share
//! of the ceiling is that loop's time over its own; everything besides the pairs (sines and
//! cosines, rotations, sums) counts as loss. Times are minima and shares are medians over many
//! rounds, in each of which everything is measured once.
//!
//! `cargo bench --bench kernel`

#![allow(clippy::disallowed_methods)]

mod operations;
#[allow(dead_code)]
#[path = "../shared/plain.rs"]
mod plain;
mod ratio;

use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;
use std::time::Instant;

use nalgebra::{Vector2, Vector3};
use operations::Operations;
use plain::Plain;
use ratio::ratio;
use tilebind::Configuration;
use tilebind::potential::dipole::Dipole;
use tilebind::potential::simd::Level;
use tilebind::potential::simd::lanes::{Lanes, Task, WIDTH};
use tilebind::potential::{DipolePotential, Potential};

const ROUNDS: usize = 40;
const CONFIGURATIONS: usize = 2048;

fn main() {
    let tile = paper_tile();
    let qs = configurations();
    println!("16 x 16 dipoles, {CONFIGURATIONS} configurations, one core");
    let scalar = Plain::new(&tile, &tile);
    report("scalar formula", &mut kernels(&scalar, &qs), None);
    let mut best = Vec::new();
    let mut best_level = None;
    for level in Level::available() {
        let potential = DipolePotential::with_level(&tile, &tile, level);
        let name = level.to_string();
        best = report(&name, &mut kernels(&potential, &qs), Some(level));
        best_level = Some(level);
    }
    if let Some(level) = best_level {
        println!("\ninstructions {level}");
    }
    for (name, shares) in ["energies-of-ceiling", "gradients-of-ceiling"]
        .into_iter()
        .zip(best)
    {
        ratio(name, shares.into_iter());
    }
}

/// The tile of the paper: four magnets a face, NNNS counter-clockwise, 43 cm square.
fn paper_tile() -> Vec<Dipole> {
    let face = |face: usize| {
        let (sin, cos) = (face as f64 * FRAC_PI_2).sin_cos();
        let (normal, along) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
        [1.0, 1.0, 1.0, -1.0]
            .into_iter()
            .enumerate()
            .map(move |(k, pole)| Dipole {
                position: normal * 0.21 + along * (0.04 * (k as f64 - 1.5)),
                moment: normal * (pole * 0.2865),
            })
    };
    (0..4).flat_map(face).collect()
}

/// Poses around contact.
fn configurations() -> Vec<Configuration> {
    (0..CONFIGURATIONS)
        .map(|i| {
            let t = i as f64;
            let (x, y) = (0.5 + 0.07 * (0.7 * t).sin(), 0.2 * (1.3 * t).cos());
            Configuration::new(x, y, 3.1 * (0.37 * t).sin())
        })
        .collect()
}

/// Something to be timed.
struct Work<'a> {
    name: &'static str,
    /// Number of repetitions per call.
    times: usize,
    /// Whether it computes gradients; `None` if it computes neither energies nor gradients.
    gradient: Option<bool>,
    call: Box<dyn FnMut() + 'a>,
}

/// Times (s) of one repetition, a row for each round.
fn measure(works: &mut [Work]) -> Vec<Vec<f64>> {
    let round = |_| {
        let mut row = Vec::new();
        for work in works.iter_mut() {
            let start = Instant::now();
            (work.call)();
            row.push(start.elapsed().as_secs_f64() / work.times as f64);
        }
        row
    };
    (0..ROUNDS).map(round).collect()
}

fn kernels<'a>(potential: &'a dyn Potential, qs: &'a [Configuration]) -> Vec<Work<'a>> {
    let work = |name, gradient, call| Work {
        name,
        times: qs.len(),
        gradient,
        call,
    };
    let mut energies = vec![0.0; qs.len()];
    let mut both = vec![(0.0, Vector3::zeros()); qs.len()];
    let each = move |f: &dyn Fn(&Configuration) -> f64| {
        for q in qs {
            black_box(f(q));
        }
    };
    vec![
        work(
            "energies",
            Some(false),
            Box::new(move || {
                potential.energies(qs, black_box(&mut energies));
            }),
        ),
        work(
            "energies_and_gradients",
            Some(true),
            Box::new(move || {
                potential.energies_and_gradients(qs, black_box(&mut both));
            }),
        ),
        work(
            "energy",
            Some(false),
            Box::new(move || each(&|q| potential.energy(q))),
        ),
        work(
            "energy_and_gradient",
            Some(true),
            Box::new(move || {
                each(&|q| potential.energy_and_gradient(q).1.z);
            }),
        ),
        work(
            "curvature_bound",
            None,
            Box::new(move || {
                each(&|q| potential.curvature_bound(q, 0.002));
            }),
        ),
    ]
}

/// As many vector operations as `CHAINS` vectors of pairs of dipoles take, over and over, in
/// chains that are independent of one another and few enough to stay in registers.
#[derive(Clone, Copy)]
struct Mix<const CHAINS: usize> {
    a_pair: Operations,
    /// Reciprocals instead of `1 / sqrt`.
    reciprocals: bool,
}

impl<const CHAINS: usize> Mix<CHAINS> {
    const LENGTH: usize = 32_000 / CHAINS;
}

impl<const CHAINS: usize> Task for Mix<CHAINS> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let mut chains = [l.splat(black_box(1.5)); CHAINS];
        let mut sums = [l.splat(black_box(1.5)); 2];
        let (a, b) = (l.splat(black_box(0.5)), l.splat(black_box(1.01)));
        for _ in 0..Self::LENGTH {
            for _ in 0..self.a_pair.simple {
                for x in &mut chains {
                    *x = l.mul(*x, b);
                }
            }
            // Each reciprocal below comes with a fused operation.
            for _ in self.a_pair.guesses..self.a_pair.fused {
                for x in &mut chains {
                    *x = l.mul_add(*x, a, b);
                }
            }
            for _ in 0..self.a_pair.guesses {
                for (i, x) in chains.iter().enumerate() {
                    let guess = if self.reciprocals {
                        l.reciprocal_single(*x)
                    } else {
                        l.reciprocal_sqrt_guess(*x)
                    };
                    sums[i % 2] = l.mul_add(guess, a, sums[i % 2]);
                }
            }
        }
        for x in chains.into_iter().chain(sums) {
            let mut values = [0.0; WIDTH];
            l.store(x, &mut values);
            black_box(values);
        }
    }
}

/// The ceilings of energies and of energies with gradients, then the core's rates at a few kinds
/// of operation.
fn ceilings(level: Level) -> Vec<Work<'static>> {
    // A vector takes one register, or two of sixteen.
    let wide = level.word() == "avx512";
    let work = |name, gradient, a_pair, reciprocals| Work {
        name,
        times: 32_000 * WIDTH,
        gradient,
        call: if !wide {
            Box::new(move || {
                level.run(Mix::<4> {
                    a_pair,
                    reciprocals,
                })
            }) as Box<dyn FnMut()>
        } else {
            Box::new(move || {
                level.run(Mix::<8> {
                    a_pair,
                    reciprocals,
                })
            })
        },
    };
    let of = |simple, fused, guesses| Operations {
        simple,
        fused,
        guesses,
    };
    vec![
        work("a pair", Some(false), Operations::per_pair(false), false),
        work(
            "a pair with gradient",
            Some(true),
            Operations::per_pair(true),
            false,
        ),
        work("16 fused operations", None, of(0, 16, 0), false),
        work("2 fused and a 1/sqrt", None, of(0, 2, 1), false),
        work("2 fused and a 1/x", None, of(0, 2, 1), true),
    ]
}

/// Returns the shares of the ceiling that `energies` and `energies_and_gradients` reach in each
/// round; none without a level.
fn report(name: &str, kernels: &mut Vec<Work>, level: Option<Level>) -> Vec<Vec<f64>> {
    let mut works = level.map_or(vec![], ceilings);
    let first = works.len();
    works.append(kernels);
    let rounds = measure(&mut works);
    let over_rounds = |f: &dyn Fn(&Vec<f64>) -> f64| {
        let mut values: Vec<f64> = rounds.iter().map(f).collect();
        values.sort_by(f64::total_cmp);
        (values[0], values[values.len() / 2])
    };

    println!("\n{name}");
    for (i, work) in works.iter().enumerate().take(first) {
        let time = over_rounds(&|round| round[i]).0;
        println!("  the core: {} {:.4} ns a lane", work.name, time * 1e9);
    }
    println!(
        "  {:24} {:>9} {:>12} {:>10} {:>8}",
        "", "ns", "per second", "pairs/s", "share"
    );
    for (i, work) in works.iter().enumerate().skip(first) {
        let time = over_rounds(&|round| round[i]).0;
        let share = match (level, work.gradient) {
            (Some(_), Some(gradient)) => {
                let pair = usize::from(gradient);
                let share = over_rounds(&|round| 256.0 * round[pair] / round[i]).1;
                format!("{:.0} %", 100.0 * share)
            }
            _ => String::new(),
        };
        println!(
            "  {:24} {:9.1} {:12.3e} {:10.2e} {share:>8}",
            work.name,
            time * 1e9,
            1.0 / time,
            256.0 / time
        );
    }
    let share = |pair: usize| {
        let rounds = rounds.iter();
        rounds
            .map(|round| 256.0 * round[pair] / round[first + pair])
            .collect()
    };
    level.map_or(vec![], |_| vec![share(0), share(1)])
}
