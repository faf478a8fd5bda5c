//! Both tiles in several poses, one panel each.

use nalgebra::Vector2;

use super::canvas::{Box4, Canvas};
use super::composition::{Composition, Panel};
use super::marks::{View, extent};
use super::style::{Anchor, LABEL};
use super::{Figure, PictureError, Sheet};
use physics::configuration::Configuration;
use physics::tile::Pair;

const WIDTH: f64 = 1000.0;
/// Smallest width of a panel on wide and narrow sheets, its text's height, and the space around its
/// tiles (pixels).
const LEAST: [f64; 2] = [240.0, 170.0];
const HEAD: f64 = 28.0;
const SPACE: f64 = 14.0;

/// Draws poses of the moving tile with a caption for each; `numbers` are the same as CSV.
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
    // All panels have the same scale.
    let sizes = poses.iter().map(|(q, _)| {
        let [low, high] = extent(pair, [q]);
        high - low
    });
    let size = sizes.fold(Vector2::zeros(), |size: Vector2<f64>, one| size.sup(&one));
    let height = move |width: f64| HEAD + (width - 2.0 * SPACE) * size.y / size.x + 2.0 * SPACE;
    let least = LEAST[usize::from(sheet.width(WIDTH) < 2.0 * LEAST[0])];
    let panels = poses.iter().enumerate().map(|(number, (q, told))| {
        let draw = move |canvas: &mut Canvas, [left, top, right, bottom]: Box4| {
            let view = View {
                scale: (right - left - 2.0 * SPACE) / size.x,
                ..View::filling([left, top + HEAD, right, bottom], extent(pair, [q]))
            };
            view.tiles(canvas, pair, q);
            let at = ((left + right) / 2.0, top + 6.0);
            canvas.write(LABEL.within(right - left, told), told, at, Anchor::Top);
        };
        Panel::new((number + 1).to_string(), least, height, draw)
    });
    let composition = Composition {
        name: name.to_owned(),
        title: title.to_owned(),
        width: WIDTH,
        panels: panels.collect(),
        ..Composition::default()
    };
    Figure::new(&composition, sheet, numbers)
}
