//! The series of two magnets of any form.

use super::Body;
use crate::potential::MagnetModel;
use crate::potential::far::FarForm;
use crate::potential::far::multipole::{
    Form, Multipole, along, composed, powers, product, squares,
};
use crate::tile::magnet::Shape;

/// Terms that are summed, the dipole included, and that enter the bound of the error.
const TERMS: usize = 12;
const BOUND_TERMS: usize = 22;

/// The terms of degree 0, 2, 4 .. of S, in the magnet's own directions.
fn average(body: &Body) -> Vec<Form> {
    let [first, across, up] = &squares();
    let [a, b, c] = body.size;
    let length = |square: &Form, length: f64| along(square, BOUND_TERMS, length);
    let parts = match (body.shape, body.stands) {
        (Shape::Block, _) => vec![length(first, a), length(across, b), length(up, c)],
        (Shape::Disc, stands) => {
            let (axis, height, diameter) = if stands { (up, c, a) } else { (first, a, b) };
            let disc = |k: f64| -diameter * diameter / 16.0 / (k * (k + 1.0));
            vec![length(axis, height), powers(axis, BOUND_TERMS, disc)]
        }
    };
    composed(&parts, BOUND_TERMS)
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
    let (first, second) = (&of(first), &of(second));
    let times = |forms: Vec<Form>, by: &[f64]| -> Vec<Form> {
        forms.iter().map(|form| product(form, by)).collect()
    };
    let [a, b] = match first.stands {
        true => [average(first), times(average(second), &[0.0, -4.0, 0.0])],
        false => [first, second].map(|body| times(average(body), &[1.0, 1.0])),
    };
    match model {
        MagnetModel::Dipole => FarForm::of_dipoles(Multipole::new([&a, &b], 2)),
        MagnetModel::Cuboid => FarForm::new(Multipole::new([&a, &b], TERMS), tolerance),
    }
}
