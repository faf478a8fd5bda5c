//! The series of two magnets of any form.

use super::Body;
use crate::potential::MagnetModel;
use crate::potential::far::FarForm;
use crate::potential::far::multipole::{
    Homogeneous, Multipole, along, composed, magnitudes, powers, product, squares,
};
use crate::tile::magnet::Shape;

/// Terms that are summed, the dipole included, and that enter the bound of the error.
const TERMS: usize = 12;
const BOUND_TERMS: usize = 22;

/// The terms of degree 0, 2, 4 .. of S, in the magnet's own directions.
fn average(body: &Body, terms: usize) -> Vec<Homogeneous> {
    let [first, across, up] = &squares();
    let [a, b, c] = body.size;
    let length = |square: &Homogeneous, length: f64| along(square, terms, length);
    let parts = match (body.shape, body.stands) {
        (Shape::Block, _) => vec![length(first, a), length(across, b), length(up, c)],
        (Shape::Disc, stands) => {
            let (axis, height, diameter) = if stands { (up, c, a) } else { (first, a, b) };
            let disc = |k: f64| -diameter * diameter / 16.0 / (k * (k + 1.0));
            vec![length(axis, height), powers(axis, terms, disc)]
        }
    };
    composed(&parts, terms)
}

/// The series of two magnets that both lie flat or both stand, with errors of `tolerance` (see
/// [`FarForm::new`]).
pub fn series(model: MagnetModel, first: &Body, second: &Body, tolerance: f64) -> FarForm {
    // Point dipoles are magnets without a size, of whose series the terms after the first vanish.
    let of = |body: &Body| match model {
        MagnetModel::Dipole => Body {
            size: [0.0; 3],
            ..*body
        },
        MagnetModel::Cuboid => *body,
    };
    let [a, b] = operators(&of(first), &of(second), BOUND_TERMS);
    match model {
        MagnetModel::Dipole => FarForm::of_dipoles(Multipole::new([&a, &b], 2)),
        MagnetModel::Cuboid => FarForm::new(Multipole::new([&a, &b], TERMS), tolerance),
    }
}

/// The operators of two magnets, by their terms of ascending degrees.
fn operators(first: &Body, second: &Body, terms: usize) -> [Vec<Homogeneous>; 2] {
    let times = |forms: Vec<Homogeneous>, by: &[f64]| -> Vec<Homogeneous> {
        forms.iter().map(|form| product(form, by)).collect()
    };
    let [a, b] = [first, second].map(|body| average(body, terms));
    match first.stands {
        true => [a, times(b, &[0.0, -4.0, 0.0])],
        false => [a, b].map(|forms| times(forms, &[1.0, 1.0])),
    }
}

/// The A_k (m^(2k)) of the first terms of the series of two magnets that both lie flat or both stand (see
/// [`multipole`](crate::potential::far::multipole)).
pub fn magnitudes_of(first: &Body, second: &Body, terms: usize) -> Vec<f64> {
    let [a, b] = operators(first, second, terms);
    magnitudes([&a, &b])
}
