//! Every instruction set of this machine: the same bits, and all tests of energies and bounds.

use std::process::Command;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::potential::shielding::Shields;
use tilebind::potential::simd::Level;
use tilebind::tile::Tile;

use super::kinds::{Kind, all};
use crate::designs;

/// Tests of potentials for the level at hand; those of kernels and of bounds over cells go through
/// all levels themselves.
const OF_POTENTIALS: [&str; 8] = [
    "potentials::blocks",
    "potentials::dipoles",
    "potentials::factor",
    "potentials::fixtures",
    "potentials::laws",
    "potentials::limits",
    "potentials::shielding",
    "strength::",
];

/// The kinds whose code the designs are put to.
const KINDS: [&str; 4] = [
    "5 x 2 dipoles",
    "blocks",
    "Dipoles by the rule Smooth",
    "Cuboids by the rule Smooth",
];

const VARIABLE: &str = "TILEBIND_KERNEL";

/// The slower levels; this process tests the chosen one.
fn others() -> impl Iterator<Item = Level> {
    let levels = Level::available().into_iter();
    levels.filter(|level| *level != Level::best())
}

#[test]
fn all_tests_of_potentials_pass_with_every_level() {
    if std::env::var_os(VARIABLE).is_some() {
        // One level was asked for.
        return;
    }
    for level in others() {
        let tests = std::env::current_exe().expect("this program");
        let output = Command::new(tests)
            .args(OF_POTENTIALS)
            .env(VARIABLE, level.word())
            .output()
            .expect("it starts");
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{level}: {said}");
        assert!(said.contains("running ") && !said.contains("running 0"));
    }
}

/// All results of a kind at some poses and for some cells around them, as bits.
fn bits(
    kind: &Kind,
    tiles: &[Tile; 2],
    shields: &Shields,
    poses: &[Configuration],
    level: Level,
) -> Vec<u64> {
    let mut all = Vec::new();
    let mut put = |values: &[f64]| all.extend(values.iter().map(|value| value.to_bits()));
    let potential = kind.energy_of(tiles, shields, level);
    let mut both = vec![(0.0, Vector3::zeros()); poses.len()];
    potential.energies_and_gradients(poses, &mut both);
    for (q, (energy, gradient)) in poses.iter().zip(both) {
        put(&[energy, potential.energy(q)]);
        put(gradient.as_slice());
        put(&potential.bend_bounds(q, 0.001));
        put(&[potential.fourth_derivative_bound(q, 0.001)]);
    }
    let bounds = kind
        .bounds
        .map(|make| make(tiles.each_ref(), shields, level));
    for q in bounds.iter().flat_map(|_| poses) {
        for half in [[1e-4; 3], [5e-3; 3]] {
            let found = bounds.as_ref().unwrap().enclose(&Cell { centre: *q, half });
            put(&[found.low, found.high, found.slope, found.jump]);
            put(&[found.form.value]);
            put(&found.form.gradient);
            put(&found.form.hessian);
        }
    }
    all
}

#[test]
fn every_level_gives_the_same_bits() {
    let designs = [
        "paper-tile",
        "hexagon",
        "one-face",
        "halbach",
        "shielded-backs",
    ]
    .map(|name| designs::load(&format!("shapes/{name}.toml")));
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let mut cases: Vec<([Tile; 2], Shields, Vec<Configuration>)> = designs
        .iter()
        .map(|design| {
            let poses = (0..60)
                .map(|k| {
                    // From contact to far away.
                    let near = design.pair.bound;
                    let off = libm::exp(f64::from(k) / 10.0 - 6.0);
                    let mut random = || rng.random_range(-off..off);
                    Configuration::new(near.x + random(), near.y + random(), near.theta + random())
                })
                .collect();
            let tiles = [design.pair.fixed.clone(), design.pair.moving.clone()];
            (tiles, design.interaction.shields.clone(), poses)
        })
        .collect();
    for kind in all() {
        let poses = kind.poses.iter().chain(kind.anywhere.iter().take(100));
        cases.push((
            kind.tiles.clone(),
            kind.shields.clone(),
            poses.copied().collect(),
        ));
        // Those of designs are asked of the kinds that differ in their code.
        let own = cases.len() - 1..;
        let those = if KINDS.contains(&kind.name.as_str()) {
            &cases[..]
        } else {
            &cases[own]
        };
        for (tiles, shields, poses) in those {
            let expected: Vec<u64> = bits(&kind, tiles, shields, poses, Level::best());
            for level in others() {
                let found = bits(&kind, tiles, shields, poses, level);
                let at = found.iter().zip(&expected).position(|(a, b)| a != b);
                assert!(at.is_none(), "{}: {level} at {at:?}", kind.name);
            }
        }
        cases.pop();
    }
}
