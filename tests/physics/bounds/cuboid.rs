//! Enclosures of blocks' energy over cells.

use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::contact::Contact;
use tilebind::potential::batch::Level;
use tilebind::potential::bounds::CuboidBounds;
use tilebind::potential::{CellBounds, CuboidPotential, Potential};
use tilebind::tile::Tile;

use super::{assert_follows, paper_tiles};

/// The tile of the paper with blocks of other shapes at other angles, as deep in the tile as they
/// just fit.
fn mixed_tile(rng: &mut ChaCha8Rng) -> Tile {
    let (mut tile, _) = paper_tiles();
    for (k, magnet) in tile.magnets.iter_mut().enumerate() {
        let size = [
            [0.006, 0.016, 0.003],
            [0.012, 0.005, 0.006],
            [0.01, 0.01, 0.01],
        ][k % 3];
        let turn: f64 = rng.random_range(-3.1..3.1);
        let depth = (size[0] * turn.cos().abs() + size[1] * turn.sin().abs()) / 2.0;
        let outwards = magnet.face as f64 * std::f64::consts::FRAC_PI_2;
        let normal = Vector2::new(outwards.cos(), outwards.sin());
        magnet.position += normal * (0.215 - depth - magnet.position.dot(&normal));
        magnet.angle = outwards + turn;
        magnet.size = size;
    }
    tile
}

/// A cell about contact, from tiny to large.
fn random_cell(rng: &mut ChaCha8Rng) -> Cell {
    let size = 10f64.powf(rng.random_range(-6.0..-1.0));
    let tilt = [1e-4, 2e-3, 0.02, 0.4][rng.random_range(0..4)];
    let theta: f64 = tilt * rng.random_range(-1.0..1.0);
    let apart = [0.1, 2e-3, 2e-4, 1e-5][rng.random_range(0..4)];
    let contact = 0.215 * (1.0 + theta.cos() + theta.sin().abs());
    Cell {
        centre: Configuration::new(
            contact + apart * rng.random_range(-0.3..1.0),
            rng.random_range(-0.1..0.1),
            theta,
        ),
        half: [1.0, 1.0, 5.0].map(|shape| size * shape * rng.random_range(0.05..1.0)),
    }
}

/// Energies of free configurations of random cells, by the potential's own quadrature, against the
/// enclosures; returns how many.
fn check_random_cells(tiles: &[Tile; 2], level: Level, cells: usize) -> usize {
    let [a, b] = tiles;
    let bounds = CuboidBounds::with_level(a, b, level);
    let potential = CuboidPotential::new(&a.magnets, &b.magnets);
    let contact = Contact::new(&a.outline, &b.outline);
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let mut tested = 0;
    for _ in 0..cells {
        let cell = random_cell(&mut rng);
        let enclosure = bounds.enclose(&cell);
        assert!(enclosure.low <= 0.0 && enclosure.high >= 0.0);
        for k in 0..14 {
            // Half of them at a corner of the cell, where the remainder is largest.
            let d = cell.half.map(|half| match k % 2 {
                0 => half * rng.random_range(-1.0f64..1.0).signum(),
                _ => half * rng.random_range(-1.0..=1.0),
            });
            let q = cell.centre.moved(d.into());
            if !contact.is_free(&q) {
                continue;
            }
            tested += 1;
            // The potential's quadrature at contact is right to 3e-5 of a pair's energy.
            let slack = 3e-6 * 0.03;
            let rest = potential.energy(&q) - enclosure.form.at(d);
            assert!(
                rest >= enclosure.low - slack && rest <= enclosure.high + slack,
                "{level} {cell:?} {d:?}: {rest} not in [{}, {}]",
                enclosure.low,
                enclosure.high
            );
            assert_follows(&enclosure, &potential, &cell, d, 3e-6);
        }
    }
    tested
}

#[test]
fn no_free_configuration_of_a_cell_lies_outside_its_enclosure() {
    for level in Level::available() {
        let tested = check_random_cells(&paper_tiles().into(), level, 3000);
        assert!(tested > 15_000, "{tested}");
    }
}

#[test]
fn blocks_of_all_shapes_and_angles_stay_inside_their_enclosures() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for _ in 0..4 {
        let tiles = [mixed_tile(&mut rng), mixed_tile(&mut rng)];
        let tested = check_random_cells(&tiles, Level::best(), 1000);
        assert!(tested > 5000, "{tested}");
    }
}

fn width(bounds: &CuboidBounds, centre: [f64; 3], half: [f64; 3]) -> f64 {
    let enclosure = bounds.enclose(&Cell {
        centre: centre.into(),
        half,
    });
    enclosure.high - enclosure.low
}

#[test]
fn the_width_shrinks_with_the_cell() {
    let (a, b) = paper_tiles();
    let bounds = CuboidBounds::new(&a, &b);
    let depth = 0.1186;
    let at = |x: f64, h: f64| width(&bounds, [x, 0.013, 0.0], [h, h, 2.0 * h]);
    // Clear of each other: the second order of what far blocks have over dipoles, or better.
    assert!(at(0.46, 1e-4) < 1e-5 * depth, "{}", at(0.46, 1e-4));
    let (coarse, fine) = (at(0.46, 2e-3), at(0.46, 4e-4));
    assert!(coarse > 25.0 * fine, "{coarse} {fine}");
    // Face to face: second order but for logarithms.
    assert!(at(0.43, 1e-4) < 1e-2 * depth, "{}", at(0.43, 1e-4));
    assert!(at(0.43, 1e-4) > 30.0 * at(0.43, 1e-5), "{}", at(0.43, 1e-5));
}

#[test]
fn slopes_are_followed_more_closely_than_values_over_short_ways() {
    let (a, b) = paper_tiles();
    let bounds = CuboidBounds::new(&a, &b);
    // Clear of each other, faces flush, edges flush with edges, and tilted on a corner.
    for [x, y, theta] in [
        [0.46, 0.013, 0.0],
        [0.43, 0.013, 0.0],
        [0.43, 0.01, 0.0],
        [0.4301, 0.0, 2e-3],
    ] {
        let enclosure = bounds.enclose(&Cell {
            centre: [x, y, theta].into(),
            half: [1e-4, 1e-4, 2e-4],
        });
        let known = enclosure.high - enclosure.low;
        // As many halves of what is known of values as the order of what is left out.
        assert!(enclosure.slope < 2.0 * known, "{x} {y} {enclosure:?}");
        assert!(
            enclosure.change(&Vector3::new(1e-5, 1e-5, 2e-5), &[1e-4, 1e-4, 2e-4]) < 0.25 * known,
            "{x} {y} {enclosure:?}"
        );
    }
}

#[test]
fn a_cell_of_no_size_gives_the_energy_and_its_gradient() {
    let (a, b) = paper_tiles();
    let bounds = CuboidBounds::new(&a, &b);
    let potential = CuboidPotential::new(&a.magnets, &b.magnets);
    for centre in [[0.44, -0.07, 0.02], [0.47, 0.01, -0.1], [0.6, 0.2, 2.0]] {
        let enclosure = bounds.enclose(&Cell {
            centre: centre.into(),
            half: [0.0; 3],
        });
        let (energy, gradient) = potential.energy_and_gradient(&centre.into());
        assert!((enclosure.form.value - energy).abs() < 2e-7 * energy.abs());
        // Quadrature errors and rounding, as far as they are bounded.
        let floor = enclosure.high - enclosure.low;
        assert!(floor < 1e-7, "{floor}");
        for (got, expected) in enclosure.form.gradient.iter().zip(gradient.iter()) {
            assert!(
                (got - expected).abs() < 1e-6 * gradient.norm(),
                "{centre:?}"
            );
        }
    }
}

/// A tile with one block at its reference point.
fn one_block(size: [f64; 3]) -> Tile {
    let (mut tile, _) = paper_tiles();
    tile.magnets.truncate(1);
    tile.magnets[0].position = Vector2::zeros();
    tile.magnets[0].angle = 0.0;
    tile.magnets[0].moment = 0.3;
    tile.magnets[0].size = size;
    tile
}

/// Energies of two blocks of 0.3 A m^2, the first of 10 x 10 x 3 mm, to 14 digits: the integral of
/// the charges' Coulomb energy, heights closed, along both pole faces by mpmath's tanh-sinh
/// quadrature with 18 digits. Nothing of it is shared with this crate's formulas but the integrand
/// `g`. (The interval crate `inari` cannot check the bounds here: it demands compiler flags of
/// everything built with it.)
#[test]
fn bounds_hold_numbers_of_many_digits_with_no_room() {
    const SECOND: [[f64; 3]; 2] = [[0.010, 0.010, 0.003], [0.006, 0.016, 0.005]];
    #[rustfmt::skip]
    const ENERGIES: [(usize, [f64; 3], f64); 12] = [
        (0, [0.0105, 0.002, 0.0], -0.023193396842035),
        (0, [0.011, 0.004, 0.05], -0.01541458070972),
        (0, [0.016, -0.006, 0.7], -0.0014214530661701),
        (0, [0.002, 0.0185, 1.5], -0.00038136421416988),
        (0, [0.03, 0.01, -2.5], 0.00056622481578988),
        (1, [0.0105, 0.002, 0.0], -0.012543102937123),
        (1, [0.011, 0.004, 0.05], -0.0096959990323299),
        (1, [0.016, -0.006, 0.7], -0.0025193419686325),
        (1, [0.002, 0.0185, 1.5], -0.0002898655310415),
        (1, [0.03, 0.01, -2.5], 0.00053275774493842),
        (0, [0.010, 0.0, 0.0], -0.03257707991908),
        (0, [0.010, 0.003, 0.0], -0.025776826593209),
    ];
    let first = one_block(SECOND[0]);
    for level in Level::available() {
        for (second, place, exact) in ENERGIES {
            let bounds = CuboidBounds::with_level(&first, &one_block(SECOND[second]), level);
            // Cells with the place at a corner, so that remainders count too.
            for half in [0.0, 1e-5, 1e-4, 1e-3] {
                let [x, y, theta] = place;
                let enclosure = bounds.enclose(&Cell {
                    centre: Configuration::new(x + half, y - half, theta + half),
                    half: [half * (1.0 + 1e-12); 3],
                });
                let form = enclosure.form.at([-half, half, -half]);
                let (low, high) = (form + enclosure.low, form + enclosure.high);
                assert!(
                    low <= exact && exact <= high,
                    "{level} {place:?} {half}: {exact} not in [{low}, {high}]"
                );
                if half == 0.0 {
                    assert!(high - low < 1e-3 * exact.abs(), "{place:?} {}", high - low);
                }
            }
        }
    }
}
