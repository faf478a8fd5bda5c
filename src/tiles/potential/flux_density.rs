//! The flux density of a tile's magnets.

use nalgebra::Vector2;

use super::MagnetModel;
use super::interaction::bare;
use crate::configuration::Configuration;
use crate::parallel;
use crate::tile::Magnet;
use crate::tile::magnet::Form;

/// The flux density (T) of magnets, without shields, at points of the plane (m): what turns a small
/// magnet there. Zero where it has no bounds.
pub fn flux_density(
    model: MagnetModel,
    magnets: &[Magnet],
    points: &[Vector2<f64>],
) -> Vec<Vector2<f64>> {
    let probe = Magnet {
        position: Vector2::zeros(),
        angle: 0.0,
        moment: 1.0,
        size: [1e-3; 3],
        form: Form::default(),
        face: 0,
    };
    let energy = bare(model, magnets, &[probe]);
    let along = |p: &Vector2<f64>, theta| -energy.energy(&Configuration::new(p.x, p.y, theta));
    parallel::map(points, |p| {
        let field = [0.0, std::f64::consts::FRAC_PI_2].map(|theta| along(p, theta));
        Vector2::from(field.map(|b| if b.is_finite() { b } else { 0.0 }))
    })
}
