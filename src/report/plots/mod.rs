//! The pictures of an analysis, each as SVG and PNG, as PDF for print, and its numbers as CSV.
//!
//! - `map`: lowest energy over theta at each (x, y), with states and pathways on it;
//! - `approach`: energy in front of the target face, gap and slide against tilt;
//! - `profiles`: energy along the main pathways with their barriers;
//! - `docking`: film strip of the way into the bound state;
//! - `models`: point dipoles against blocks over the gap;
//! - `roadmap`: milestones and the motions between them, by their costs;
//! - `disconnectivity`: which states merge at which energy; `disconnectivity-linear`: the same on a
//!   linear scale.
//!
//! A picture is a composition of panels, laid out for a [`Sheet`]. Panels are drawn with plotters
//! (its elements, charts and series) on a backend that records the shapes. These are then written
//! as SVG (by plotters), as pixels (by tiny-skia) and as PDF (by pdf-writer), with an embedded
//! font, so that no format depends on installed fonts.

mod approach;
pub(crate) mod axes;
pub(crate) mod canvas;
pub mod chart;
pub(crate) mod committor;
pub(crate) mod composition;
mod contour;
pub mod crowd;
mod decimals;
pub(crate) mod disconnectivity;
pub mod dock;
mod energy_map;
pub mod field;
pub mod figure;
mod film;
mod font;
pub mod glance;
pub(crate) mod heat;
pub(crate) mod key;
mod labels;
mod map_marks;
pub(crate) mod marks;
pub mod matrix;
mod merge_tree;
mod models;
pub mod paths;
mod pdf;
mod picture;
pub mod poses;
mod profiles;
pub mod ranking;
mod recorder;
pub mod roadmap;
pub(crate) mod scale;
pub(crate) mod scene;
pub mod sheet;
pub(crate) mod style;

pub use figure::{Drawing, Figure};
pub use picture::{Picture, PictureError};
pub use scene::Scene;
pub use sheet::Sheet;

use decimals::Decimals;
use film::Film;
use physics::landscape::StateKind;
use physics::landscape::approach::{Approach, ModelCurves};
use physics::parallel;
use scale::EnergyScale;

/// All pictures of an analysis; those without data are omitted.
///
/// # Errors
/// See [`PictureError`].
pub fn draw_all(scene: &Scene, sheet: &Sheet) -> Result<Vec<Figure>, PictureError> {
    draw(scene, sheet, |_| true)
}

/// The disconnectivity graph of all kinds of states as CSV: each line of the graph with its foot,
/// and the energy and line at which it joins another.
pub fn merge_lines(scene: &Scene) -> String {
    let energies = scene.states().iter().map(|state| state.energy);
    let scale = EnergyScale::holding(energies.chain([0.0])).linear_throughout();
    disconnectivity::lines(scene, &scene.kinds(), &scale)
}

/// The selected pictures of an analysis, by name.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    scene: &Scene,
    sheet: &Sheet,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<Figure>, PictureError> {
    let maps = energy_map::Maps::new(scene, sheet);
    let approach = Approach::new(scene.pair);
    let slices = approach.slices(scene.problem);
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
    let film = Film::new(scene, &scale);
    let bond = scene.catalogue.first(StateKind::Bond);
    let bond = bond.map(|bond| &bond.configuration);
    let curves = ModelCurves::new(scene.problem, scene.pair, scene.interaction, bond);
    let linear = scale.linear_throughout();
    let decimals = Decimals::of(scene.pair);
    let drawn = [
        Some((
            energy_map::composed(scene, &maps, sheet, &scale),
            energy_map::data(&maps, decimals),
        )),
        Some((
            approach::composed(scene, &approach, &slices, &scale),
            approach::data(&slices, decimals),
        )),
        profiles::composed(scene, &scale)
            .map(|profiles| (profiles, profiles::data(scene, decimals))),
        film.as_ref()
            .map(|film| (film::composed(scene, film, &scale), film.data(decimals))),
        curves.as_ref().map(|curves| {
            (
                models::composed(scene, curves),
                models::data(curves, decimals),
            )
        }),
        disconnectivity::composed(scene, sheet, scale, "disconnectivity"),
        disconnectivity::composed(scene, sheet, linear, "disconnectivity-linear"),
    ];
    let mut drawn: Vec<_> = drawn.into_iter().flatten().collect();
    drawn.retain(|(composition, _)| wanted(&composition.name));
    let figures = parallel::map(&drawn, |(composition, data)| {
        Figure::new(composition, sheet, data.clone())
    });
    figures.into_iter().collect()
}
