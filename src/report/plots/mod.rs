//! The pictures of an analysis, each as SVG and as PNG.
//!
//! - `map`: lowest energy over theta at each (x, y), with states and pathways on it;
//! - `approach`: energy in front of the target face, gap and slide against tilt;
//! - `profiles`: energy along the main pathways with their barriers;
//! - `docking`: film strip of the way into the bound state;
//! - `models`: point dipoles against blocks over the gap;
//! - `disconnectivity`: which states merge at which energy.
//!
//! Charts are laid out by plotters. Its SVG backend writes the vector form; pixels are drawn from
//! the same calls by tiny-skia, with a font that is part of the program, so that neither form
//! depends on what is installed.

mod approach;
mod canvas;
pub mod curve_data;
mod curve_map;
pub(in crate::report) mod curves;
pub(in crate::report) mod disconnectivity;
pub mod dock;
mod energy_map;
mod film;
pub mod glance;
mod heat;
mod labels;
mod marks;
pub(in crate::report) mod merge_tree;
mod models;
mod picture;
mod profiles;
pub mod ranking;
mod raster;
pub(in crate::report) mod scale;
pub(in crate::report) mod scene;
mod style;

use rayon::prelude::*;

pub use picture::{Picture, PictureError};
pub use scene::Scene;

use scale::EnergyScale;

/// A picture and the stem of the files that hold it.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPicture {
    /// The stem of the files.
    pub name: &'static str,
    /// The picture.
    pub picture: Picture,
}

/// All pictures of an analysis; those that nothing is known for are left out.
///
/// # Errors
/// See [`PictureError`].
pub fn draw_all(scene: &Scene) -> Result<Vec<NamedPicture>, PictureError> {
    let maps = energy_map::Maps::new(scene);
    let (approach, slices) = approach::slices(scene);
    let grids = [
        &maps.whole.lowest,
        &maps.target.lowest,
        &slices.gap,
        &slices.slide,
    ];
    let sampled = grids
        .iter()
        .flat_map(|grid| grid.values.iter().flatten())
        .map(|sample| sample.energy);
    let scale = EnergyScale::holding(
        scene
            .states()
            .iter()
            .map(|state| state.energy)
            .chain(sampled),
    );

    type Drawing<'a> = &'a (dyn Fn() -> Result<Option<Picture>, PictureError> + Sync);
    let drawings: [(&str, Drawing); 6] = [
        ("map", &|| energy_map::draw(scene, &maps, &scale).map(Some)),
        ("approach", &|| {
            approach::draw(scene, &approach, &slices, &scale).map(Some)
        }),
        ("profiles", &|| profiles::draw(scene, &scale)),
        ("docking", &|| film::draw(scene, &scale)),
        ("models", &|| models::draw(scene)),
        ("disconnectivity", &|| disconnectivity::draw(scene, &scale)),
    ];
    let pictures: Vec<_> = drawings
        .par_iter()
        .map(|(name, drawing)| Ok((*name, drawing()?)))
        .collect::<Result<_, PictureError>>()?;
    Ok(pictures
        .into_iter()
        .filter_map(|(name, picture)| picture.map(|picture| NamedPicture { name, picture }))
        .collect())
}
