//! Bounds of energies over cells hold what they enclose, and are as narrow as they are meant to be.

mod cuboid;
mod dipole;
mod shielded;
mod widths;

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector2, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use tilebind::cell::Cell;
use tilebind::contact::Contact;
use tilebind::potential::Potential;
use tilebind::potential::bounds::Enclosure;
use tilebind::tile::{Magnet, Outline, Tile};
use tilebind::units::MU0;

/// A square of side 0.43 m with four magnets on each face, +1 for north pole out.
fn square_tile(code: [f64; 4]) -> Tile {
    let half = 0.215;
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let mut magnets = Vec::new();
    for face in 0..4 {
        let angle = face as f64 * PI / 2.0;
        let normal = Vector2::new(angle.cos(), angle.sin());
        let tangent = Vector2::new(-angle.sin(), angle.cos());
        for (k, sign) in code.iter().enumerate() {
            magnets.push(Magnet {
                position: normal * (half - 0.005) + tangent * ((k as f64 - 1.5) * 0.04),
                angle: if *sign > 0.0 { angle } else { angle + PI },
                moment: 1.2 * 3e-7 / MU0,
                size: [0.01, 0.01, 0.003],
                face,
            });
        }
    }
    Tile {
        outline: Outline::new(corners.map(|c| Vector2::new(c[0], c[1])).to_vec()).unwrap(),
        faces: Vec::new(),
        magnets,
        mass: 0.1,
        thickness: 0.013,
    }
}

pub fn paper_tiles() -> (Tile, Tile) {
    (
        square_tile([1.0, 1.0, 1.0, -1.0]),
        square_tile([1.0, -1.0, -1.0, -1.0]),
    )
}

/// The same square with many small magnets on each face, north and south as the bits of a number
/// that `seed` multiplies.
pub fn pixel_tile(each: usize, seed: u64) -> Tile {
    let pitch = 0.4 / each as f64;
    let mut tile = square_tile([1.0; 4]);
    let faces: Vec<Magnet> = tile.magnets.iter().step_by(4).cloned().collect();
    tile.magnets.clear();
    for face in faces {
        let (sin, cos) = face.angle.sin_cos();
        let (normal, tangent) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
        for k in 0..each {
            let s = (k as f64 - (each as f64 - 1.0) / 2.0) * pitch;
            let bits = seed
                .wrapping_mul(0x9E37_79B9_7F4A_7C15)
                .rotate_left(k as u32);
            tile.magnets.push(Magnet {
                position: normal * (0.215 - pitch / 2.0) + tangent * s,
                angle: face.angle + if bits & 1 == 0 { 0.0 } else { PI },
                moment: face.moment * (pitch / 0.04).powi(3),
                ..face.clone()
            });
        }
    }
    tile
}

/// Asserts that the energies of free ones among twenty random configurations of a cell lie in its
/// enclosure; returns how many these were.
pub fn assert_encloses(
    enclosure: &Enclosure,
    potential: &dyn Potential,
    contact: &Contact,
    cell: &Cell,
    rng: &mut ChaCha8Rng,
) -> usize {
    let mut tested = 0;
    for _ in 0..20 {
        let d = cell.half.map(|half| half * rng.random_range(-1.0..=1.0));
        let q = cell.centre.moved(d.into());
        if !contact.is_free(&q) {
            continue;
        }
        let rest = potential.energy(&q) - enclosure.form.at(d);
        tested += 1;
        assert!(
            rest >= enclosure.low && rest <= enclosure.high,
            "{cell:?} {d:?}: {rest} not in [{}, {}]",
            enclosure.low,
            enclosure.high
        );
        assert_follows(enclosure, potential, cell, d, 1e-9);
    }
    tested
}

/// Of a cell's sizes, so that what is known of values says nothing.
const SHORT: f64 = 1e-6;

/// Asserts that the form's slope at the offset d from a cell's centre, along some directions, is no
/// farther from the energy's than the enclosure says, and than the gradient's relative error.
pub fn assert_follows(
    enclosure: &Enclosure,
    potential: &dyn Potential,
    cell: &Cell,
    d: [f64; 3],
    error: f64,
) {
    let (energy, gradient) = potential.energy_and_gradient(&cell.centre.moved(d.into()));
    let [xx, yy, tt, xy, xt, yt] = enclosure.form.hessian;
    let bent = Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt) * Vector3::from(d);
    let rest = gradient - Vector3::from(enclosure.form.gradient) - bent;
    let size: f64 = (0..3).map(|i| gradient[i].abs() * cell.half[i]).sum();
    for shares in [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.1, 1.0, -0.1],
        [1.0, 1.0, 1.0],
        [1.0, 1.0, -1.0],
        [1.0, -1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ] {
        let step = Vector3::from_fn(|i, _| SHORT * shares[i] * cell.half[i]);
        let along = rest.dot(&step) / SHORT;
        let allowed = (enclosure.change(&step, &cell.half) - enclosure.jump) / SHORT;
        assert!(
            along.abs() <= allowed + error * (size + energy.abs()),
            "{cell:?} {d:?} {shares:?}: {along} > {allowed}"
        );
    }
}
