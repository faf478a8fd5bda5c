//! Both tiles in several poses, a panel each.

use nalgebra::Vector2;
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel};
use super::marks::{Box4, View, tile};
use super::picture::Area;
use super::style::{FIXED_FILL, LABEL, MOVING_FILL, Text};
use super::{Figure, PictureError, Sheet};
use physics::configuration::Configuration;
use physics::tile::Pair;

/// Where the fixed tile lies.
const ORIGIN: Configuration = Configuration::new(0.0, 0.0, 0.0);
const WIDTH: f64 = 1000.0;
/// Least width of a panel, its text's height, and the space around its tiles (pixels).
const LEAST: f64 = 240.0;
const HEAD: f64 = 28.0;
const SPACE: f64 = 14.0;

/// Draws poses of the moving tile with what is said of each; `numbers` are the same as CSV.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    (name, title): (&str, &str),
    pair: &Pair,
    poses: &[(Configuration, String)],
    numbers: String,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let tiles = [&pair.fixed, &pair.moving];
    let bounds = |q: &Configuration| {
        let placed = tiles.into_iter().zip([ORIGIN, *q]);
        let corners = placed.flat_map(|(tile, q)| {
            let corners = tile.outline.vertices().iter();
            corners.map(move |corner| q.transform(*corner))
        });
        let none = Vector2::repeat(f64::INFINITY);
        corners.fold((none, -none), |(low, high), p| (low.inf(&p), high.sup(&p)))
    };
    let sizes = poses.iter().map(|(q, _)| {
        let (low, high) = bounds(q);
        high - low
    });
    // All panels have one scale.
    let size = sizes.fold(Vector2::zeros(), |size: Vector2<f64>, one| size.sup(&one));
    let height = move |width: f64| HEAD + (width - 2.0 * SPACE) * size.y / size.x + 2.0 * SPACE;
    let panels = poses.iter().enumerate().map(|(number, (q, told))| {
        let draw = move |root: &Area, _: &mut Vec<_>, [left, top, right, bottom]: Box4| {
            let (low, high) = bounds(q);
            let view = View {
                centre: (low + high) / 2.0,
                origin: ((left + right) / 2.0, (top + HEAD + bottom) / 2.0),
                turn: 0.0,
                scale: (right - left - 2.0 * SPACE) / size.x,
            };
            tile(root, &view, tiles[0], &ORIGIN, FIXED_FILL)?;
            tile(root, &view, tiles[1], q, MOVING_FILL)?;
            let at = ((left + right) / 2.0, top + 6.0);
            Text::new(LABEL).write(root, told, at, (HPos::Center, VPos::Top))
        };
        Panel::new((number + 1).to_string(), LEAST, height, draw)
    });
    let composition = Composition {
        name: name.to_owned(),
        title: title.to_owned(),
        note: None,
        width: WIDTH,
        panels: panels.collect(),
        key: None,
    };
    Figure::new(&composition, sheet, numbers)
}
