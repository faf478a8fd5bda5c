//! The cost of the energy of uniformly magnetised blocks, relative to point dipoles.
//!
//! Both tiles are 43 cm squares with four magnets on each face (16 x 16 pairs). Times are the
//! least of many rounds on one core; each round measures everything once.
//!
//! `cargo bench --bench cuboid`

#![allow(clippy::disallowed_methods)]

mod ratio;

use std::f64::consts::{FRAC_PI_2, PI};
use std::hint::black_box;
use std::time::Instant;

use nalgebra::Vector2;
use ratio::ratio;
use tilebind::Configuration;
use tilebind::potential::dipole::dipoles;
use tilebind::potential::simd::Level;
use tilebind::potential::{CuboidPotential, DipolePotential, Potential};
use tilebind::tile::Magnet;
use tilebind::units::MU0;

const ROUNDS: usize = 40;
const CONFIGURATIONS: usize = 512;

fn main() {
    println!("ns a configuration, 16 x 16 magnets, one core; in brackets times the dipoles'\n");
    let mut last = Vec::new();
    for level in Level::available() {
        last.clear();
        let (fixed, moving) = (magnets("NNNS"), magnets("NSSS"));
        let dipole = DipolePotential::with_level(&dipoles(&fixed), &dipoles(&moving), level);
        let cuboid = CuboidPotential::with_level(&fixed, &moving, level);
        println!(
            "{level:24} {:>9} {:>16} {:>9} {:>16}",
            "dipoles", "blocks", "dipoles", "blocks"
        );
        println!("{:24} {:^26} {:^26}", "", "energy", "and gradient");
        for (name, qs) in poses() {
            let rounds = measure(&dipole, &cuboid, &qs);
            let least = |i: usize| rounds.iter().map(|r| r[i]).fold(f64::INFINITY, f64::min);
            let [a, b, c, d] = [0, 1, 2, 3].map(least);
            last.push((name, rounds));
            println!(
                "{name:24} {a:9.0} {b:9.0} ({:4.1}) {c:9.0} {d:9.0} ({:4.1})",
                b / a,
                d / c
            );
        }
        println!();
    }
    // With the widest instructions.
    for (name, rounds) in last {
        let short = match name {
            "touching, aligned" => "blocks-over-dipoles-touching",
            "0.6 to 1 m away" => "blocks-over-dipoles-far",
            _ => continue,
        };
        ratio(short, rounds.iter().map(|round| round[1] / round[0]));
    }
}

/// The magnets of a 43 cm square with this code on every face.
fn magnets(code: &str) -> Vec<Magnet> {
    let size = [0.010, 0.010, 0.003];
    let face = |face: usize| {
        let outwards = face as f64 * FRAC_PI_2;
        let normal = Vector2::new(outwards.cos(), outwards.sin());
        let along = Vector2::new(-normal.y, normal.x);
        code.chars().enumerate().map(move |(k, pole)| Magnet {
            position: normal * 0.21 + along * (0.04 * (k as f64 - 1.5)),
            angle: outwards + if pole == 'S' { PI } else { 0.0 },
            moment: 1.2 * size.iter().product::<f64>() / MU0,
            size,
            form: Default::default(),
            face,
        })
    };
    (0..4).flat_map(face).collect()
}

/// Families of configurations near and far from contact.
fn poses() -> Vec<(&'static str, Vec<Configuration>)> {
    let family = |pose: &dyn Fn(f64, f64) -> Configuration| {
        (0..CONFIGURATIONS)
            .map(|i| pose((0.7 * i as f64).sin(), (1.3 * i as f64).cos()))
            .collect::<Vec<_>>()
    };
    vec![
        (
            "touching, aligned",
            family(&|_, _| Configuration::new(0.43, 0.0, 0.0)),
        ),
        (
            "touching, sliding",
            family(&|a, _| Configuration::new(0.43, 0.1 * a, 0.0)),
        ),
        (
            "gap 1 mm, aligned",
            family(&|_, _| Configuration::new(0.431, 0.0, 0.0)),
        ),
        (
            "gap 1 to 3 mm, sliding",
            family(&|a, b| Configuration::new(0.432 + 0.001 * a, 0.1 * b, 0.0)),
        ),
        (
            "tilted to an edge",
            family(&|a, b| {
                let tilt: f64 = 0.05 * a;
                let reach = 0.215 * (1.0 + tilt.cos() + tilt.sin().abs());
                Configuration::new(reach, 0.1 * b, tilt)
            }),
        ),
        (
            "any angle, touching",
            family(&|a, b| {
                let turn = PI * a;
                let reach = 0.215 * (1.0 + turn.cos().abs() + turn.sin().abs());
                Configuration::new(reach, 0.2 * b, turn)
            }),
        ),
        (
            "gap 20 mm",
            family(&|a, b| Configuration::new(0.45, 0.1 * b, 0.05 * a)),
        ),
        (
            "0.6 to 1 m away",
            family(&|a, b| Configuration::new(0.8 + 0.2 * a, 0.3 * b, PI * b)),
        ),
    ]
}

/// The time (ns) a configuration takes in each round: energies of dipoles and blocks, and the same
/// with gradients.
fn measure(
    dipole: &DipolePotential,
    cuboid: &CuboidPotential,
    qs: &[Configuration],
) -> Vec<[f64; 4]> {
    let round = |_| {
        [0, 1, 2, 3].map(|i| {
            let potential: &dyn Potential = if i % 2 == 0 { dipole } else { cuboid };
            let start = Instant::now();
            for q in qs {
                if i < 2 {
                    black_box(potential.energy(black_box(q)));
                } else {
                    black_box(potential.energy_and_gradient(black_box(q)));
                }
            }
            start.elapsed().as_nanos() as f64 / qs.len() as f64
        })
    };
    (0..ROUNDS).map(round).collect()
}
