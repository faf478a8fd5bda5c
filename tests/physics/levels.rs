//! Every instruction set that this machine has: the same bits, and all tests of energies and bounds.

use std::process::Command;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::design::Design;
use tilebind::potential::batch::Level;
use tilebind::potential::bounds::{CuboidBounds, DipoleBounds, ShieldedBounds};
use tilebind::potential::dipole::dipoles;
use tilebind::potential::{
    CellBounds, CuboidPotential, DipolePotential, MagnetModel, Potential, ShieldedPotential,
};

use crate::designs;

/// Tests of potentials for the level at hand; those of kernels and of bounds over cells go through
/// all levels themselves.
const OF_POTENTIALS: [&str; 7] = [
    "block_limits::",
    "blocks::",
    "dipoles::",
    "fixtures::",
    "shield_factor::",
    "shielding::",
    "strength::",
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

type Models = (Vec<Box<dyn Potential>>, Vec<Box<dyn CellBounds>>);

/// The potentials and the bounds of a design, for a level.
fn models(design: &Design, level: Level) -> Models {
    let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
    let shields = &design.interaction.shields;
    let shielded = |model| ShieldedPotential::with_level(model, fixed, moving, shields, level);
    (
        vec![
            Box::new(DipolePotential::with_level(
                &dipoles(&fixed.magnets),
                &dipoles(&moving.magnets),
                level,
            )),
            Box::new(CuboidPotential::with_level(
                &fixed.magnets,
                &moving.magnets,
                level,
            )),
            Box::new(shielded(MagnetModel::Dipole)),
            Box::new(shielded(MagnetModel::Cuboid)),
        ],
        vec![
            Box::new(DipoleBounds::with_level(fixed, moving, level)),
            Box::new(CuboidBounds::with_level(fixed, moving, level)),
            Box::new(ShieldedBounds::with_level(fixed, moving, shields, level)),
        ],
    )
}

/// All that the models say at some poses and of some cells around them, as bits.
fn bits(design: &Design, level: Level) -> Vec<u64> {
    let (potentials, bounds) = models(design, level);
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let poses: Vec<_> = (0..60)
        .map(|k| {
            // From contact to far away.
            let near = design.pair.bound;
            let off = libm::exp(f64::from(k) / 10.0 - 6.0);
            let mut random = || rng.random_range(-off..off);
            Configuration::new(near.x + random(), near.y + random(), near.theta + random())
        })
        .collect();
    let mut all = Vec::new();
    let mut put = |values: &[f64]| all.extend(values.iter().map(|value| value.to_bits()));
    for potential in &potentials {
        let mut both = vec![(0.0, Vector3::zeros()); poses.len()];
        potential.energies_and_gradients(&poses, &mut both);
        for (q, (energy, gradient)) in poses.iter().zip(both) {
            put(&[energy, potential.energy(q)]);
            put(gradient.as_slice());
            put(&potential.bend_bounds(q, 0.001));
            put(&[potential.fourth_derivative_bound(q, 0.001)]);
        }
    }
    for bounds in &bounds {
        for q in &poses {
            for half in [[1e-4; 3], [5e-3; 3]] {
                let cell = Cell { centre: *q, half };
                let found = bounds.enclose(&cell);
                put(&[found.low, found.high, found.slope, found.jump]);
                put(&[found.form.value]);
                put(&found.form.gradient);
                put(&found.form.hessian);
            }
        }
    }
    all
}

#[test]
fn every_level_gives_the_same_bits() {
    for design in [
        "shapes/paper-tile.toml",
        "shapes/hexagon.toml",
        "shapes/one-face.toml",
        "shapes/halbach.toml",
        "shapes/shielded-backs.toml",
    ] {
        let design = designs::load(design);
        let expected = bits(&design, Level::best());
        for level in others() {
            let found = bits(&design, level);
            let at = found.iter().zip(&expected).position(|(a, b)| a != b);
            assert!(at.is_none(), "{}: {level} at {at:?}", design.name);
        }
    }
}
