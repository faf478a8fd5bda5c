//! Enclosures of blocks' energy over cells.

use nalgebra::{Vector2, Vector3};
use tilebind::Configuration;
use tilebind::cell::Cell;
use tilebind::potential::CellBounds;
use tilebind::potential::bounds::CuboidBounds;
use tilebind::potential::simd::Level;
use tilebind::tile::{Magnet, Tile};

use super::super::kinds::{paper_tile, square};

#[test]
fn slopes_are_followed_more_closely_than_values_over_short_ways() {
    let [a, b] = ["NNNS", "NSSS"].map(paper_tile);
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
        // As many halves of the bound of values as the order of the remainder.
        assert!(enclosure.slope < 2.0 * known, "{x} {y} {enclosure:?}");
        assert!(
            enclosure.change(&Vector3::new(1e-5, 1e-5, 2e-5), &[1e-4, 1e-4, 2e-4]) < 0.25 * known,
            "{x} {y} {enclosure:?}"
        );
    }
}

/// A tile with one block at its reference point.
fn one_block(size: [f64; 3]) -> Tile {
    let magnet = Magnet {
        position: Vector2::zeros(),
        angle: 0.0,
        moment: 0.3,
        size,
        form: Default::default(),
        face: 0,
    };
    square(0.215, vec![magnet])
}

/// Energies of two blocks of 0.3 A m^2, the first of 10 x 10 x 3 mm, to 14 digits: the integral of
/// the charges' Coulomb energy, heights closed, along both pole faces by mpmath's tanh-sinh
/// quadrature with 18 digits. Nothing of it is shared with this crate's formulas but the integrand
/// `g`.
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
