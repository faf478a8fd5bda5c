//! Random small designs: the certificate against a brute-force grid, against random paths, and
//! against itself with the tiles relabelled.

use nalgebra::{Rotation2, Vector2, Vector3};
use ordered_float::OrderedFloat;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use tilebind::configuration::Configuration;
use tilebind::landscape::minimax::{Bracket, End};
use tilebind::potential::MagnetModel;
use tilebind::tile::{Magnet, Outline, Tile};

use super::grid::Grid;
use super::scene::{Scene, effort};

/// A random design and two free configurations in it, the first of low energy.
struct Case {
    scene: Scene,
    from: Configuration,
    to: Configuration,
    tolerance: f64,
}

impl Case {
    fn new(seed: u64, model: MagnetModel) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let scene = Scene::random(&mut rng, model);
        Self::of(scene, &mut rng)
    }

    fn shielded(seed: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let scene = Scene::random_shielded(&mut rng);
        Self::of(scene, &mut rng)
    }

    fn of(scene: Scene, rng: &mut ChaCha8Rng) -> Self {
        let mut free: Vec<Configuration> = (0..400)
            .map(|_| scene.random_configuration(rng))
            .filter(|q| scene.contact.is_free(q))
            .collect();
        free.sort_by_cached_key(|q| OrderedFloat(scene.potential.energy(q)));
        let from = free[0];
        let tolerance = 0.02 * scene.potential.energy(&from).abs();
        let to = free[rng.random_range(1..free.len())];
        Self {
            scene,
            from,
            to,
            tolerance,
        }
    }

    fn bracket(&self) -> Bracket {
        self.scene.bracket(
            &self.from,
            &End::At(self.to),
            &effort(self.tolerance, 40_000),
        )
    }
}

fn of_dipoles(seed: u64) -> Case {
    Case::new(seed, MagnetModel::Dipole)
}

fn of_blocks(seed: u64) -> Case {
    Case::new(seed, MagnetModel::Cuboid)
}

/// Checks designs against the grid; returns for how many both had an answer.
fn against_the_grid(
    case: fn(u64) -> Case,
    seeds: std::ops::Range<u64>,
    counts: [usize; 3],
) -> usize {
    seeds
        .into_par_iter()
        .map(|seed| {
            let case = case(seed);
            let bracket = case.bracket();
            let grid = Grid::new(&case.scene, counts);
            let (lower, upper) = grid.bracket(&case.from, &case.to);
            assert!(
                bracket.bounds.least() <= upper,
                "{seed}: {bracket:?} {lower} {upper}"
            );
            let certified = bracket.bounds.upper.unwrap_or(f64::INFINITY);
            assert!(lower <= certified, "{seed}: {bracket:?} {lower} {upper}");
            assert!(!bracket.bounds.caged || upper == f64::INFINITY, "{seed}");
            assert!(bracket.bounds.least() <= certified, "{seed}: {bracket:?}");
            usize::from(upper.is_finite() && bracket.bounds.width() <= case.tolerance)
        })
        .sum()
}

#[test]
fn no_bracket_contradicts_a_dense_grid() {
    let informative = against_the_grid(of_dipoles, 0..24, [30, 30, 28]);
    assert!(informative >= 18, "{informative}");
}

#[test]
fn no_bracket_of_blocks_contradicts_a_dense_grid() {
    let informative = against_the_grid(of_blocks, 0..8, [24, 24, 22]);
    assert!(informative >= 5, "{informative}");
}

#[test]
fn no_bracket_of_shielded_dipoles_contradicts_a_dense_grid() {
    let informative = against_the_grid(Case::shielded, 0..24, [30, 30, 28]);
    assert!(informative >= 18, "{informative}");
}

/// The first of the hundreds below.
#[test]
fn no_bracket_contradicts_a_finer_grid() {
    let informative = against_the_grid(of_dipoles, 1000..1006, [40, 40, 36]);
    assert!(informative >= 4, "{informative}");
}

/// As above with many more designs and a finer grid; takes minutes.
#[test]
#[ignore = "slow"]
fn no_bracket_of_hundreds_contradicts_a_dense_grid() {
    let informative = against_the_grid(of_dipoles, 1000..1400, [40, 40, 36]);
    assert!(informative >= 300, "{informative}");
}

#[test]
fn no_random_free_path_stays_below_the_lower_bound() {
    let tried: usize = (100..130)
        .into_par_iter()
        .map(|seed| {
            let case = of_dipoles(seed);
            let bracket = case.bracket();
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut tried = 0;
            for _ in 0..60 {
                // The certified pathway, shaken.
                let size = 10f64.powf(rng.random_range(-4.0..-1.0));
                let mut random = || rng.random_range(-size..size);
                let last = bracket.pathway.len().saturating_sub(1);
                let path: Vec<Configuration> = bracket
                    .pathway
                    .iter()
                    .enumerate()
                    .map(|(k, q)| {
                        let step = Vector3::new(random(), random(), 5.0 * random());
                        if k == 0 || k == last {
                            *q
                        } else {
                            q.moved(step)
                        }
                    })
                    .collect();
                let contact = &case.scene.contact;
                if path.is_empty()
                    || !path
                        .windows(2)
                        .all(|w| contact.motion_is_free(&w[0], &w[1]))
                {
                    continue;
                }
                let highest = path
                    .windows(2)
                    .flat_map(|w| (0..=20).map(|k| w[0].interpolate(&w[1], f64::from(k) / 20.0)))
                    .map(|q| case.scene.potential.energy(&q))
                    .fold(f64::NEG_INFINITY, f64::max);
                // Sampling may slightly miss the maximum.
                assert!(
                    highest >= bracket.bounds.least() - 1e-3 * case.tolerance,
                    "{seed}"
                );
                tried += 1;
            }
            tried
        })
        .sum();
    assert!(tried > 300, "{tried}");
}

/// The vector a point or a moment becomes.
type Map = fn(Vector2<f64>) -> Vector2<f64>;

fn mapped(tile: &Tile, map: Map, reversed: bool) -> Tile {
    let mut vertices: Vec<_> = tile.outline.vertices().iter().map(|v| map(*v)).collect();
    if reversed {
        vertices.reverse();
    }
    let magnet = |magnet: &Magnet| {
        let moment = map(magnet.moment_vector());
        Magnet {
            position: map(magnet.position),
            angle: moment.y.atan2(moment.x),
            ..magnet.clone()
        }
    };
    Tile {
        outline: Outline::new(vertices).unwrap(),
        magnets: tile.magnets.iter().map(magnet).collect(),
        ..tile.clone()
    }
}

#[test]
fn relabelled_tiles_have_consistent_brackets() {
    let narrow: usize =
        (200..220)
            .into_par_iter()
            .map(|seed| {
                let case = of_dipoles(seed);
                // A round table would turn with the tiles; on a large square one the rim is far from
                // every saddle.
                let [fixed, moving] = &case.scene.tiles;
                let scene = |a: Tile, b: Tile| Scene::new(a, b, [1.0, 1.0], MagnetModel::Dipole);
                let effort = effort(case.tolerance, 60_000);
                let here =
                    scene(fixed.clone(), moving.clone()).bracket(&case.from, &End::Free, &effort);
                let exchanged = scene(moving.clone(), fixed.clone()).bracket(
                    &case.from.inverse(),
                    &End::Free,
                    &effort,
                );
                let mirror: Map = |v| Vector2::new(v.x, -v.y);
                let q = case.from;
                let mirrored = scene(mapped(fixed, mirror, true), mapped(moving, mirror, true))
                    .bracket(
                        &Configuration::new(q.x, -q.y, -q.theta),
                        &End::Free,
                        &effort,
                    );
                let turn: Map = |v| Rotation2::new(1.1) * v;
                let p = turn(q.position());
                let turned = scene(mapped(fixed, turn, false), mapped(moving, turn, false))
                    .bracket(&Configuration::new(p.x, p.y, q.theta), &End::Free, &effort);
                for other in [&exchanged, &mirrored, &turned] {
                    assert_eq!(here.bounds.caged, other.bounds.caged, "{seed}");
                    let upper = |bracket: &Bracket| bracket.bounds.upper.unwrap_or(f64::INFINITY);
                    let rounding = 1e-15;
                    assert!(
                        here.bounds.least() <= upper(other) + rounding,
                        "{seed}: {here:?} {other:?}"
                    );
                    assert!(
                        other.bounds.least() <= upper(&here) + rounding,
                        "{seed}: {here:?} {other:?}"
                    );
                }
                usize::from(here.bounds.width() <= case.tolerance)
            })
            .sum();
    assert!(narrow >= 15, "{narrow}");
}
