//! The magnetic field about the fixed tile: where it points, and how strong it is.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::axes::{Axis, Plot};
use super::canvas::Canvas;
use super::composition::{Composition, Panel, remark};
use super::heat::{Marked, bar, cells};
use super::key::{POLES, key};
use super::marks::{ORIGIN, View, extent};
use super::picture::PictureError;
use super::scale::colour;
use super::style::{FIXED_FILL, INK};
use super::{Figure, Sheet};
use crate::csv::{rounded, table};
use jobs::design::Design;
use physics::order::Order;
use physics::potential::flux_density;
use physics::units::si;

const WIDTH: f64 = 700.0;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];
/// Squares along the longer side, fewer for many magnets: so many magnets' fields are added up.
const SIDE: [f64; 2] = [40.0, 120.0];
const WORK: f64 = 4e5;
/// Squares that an arrow stands for, along x and y.
const ARROW: usize = 5;
/// Powers of ten of the strengths that have a colour.
const DECADES: f64 = 3.0;

/// A square of the plane: its centre (m), and the field (T).
type Square = (Vector2<f64>, Vector2<f64>);

/// Draws the field of a design's fixed tile, without shields.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(design: &Design, sheet: &Sheet) -> Result<Figure, PictureError> {
    let tile = &design.pair.fixed;
    let [low, high] = extent(&design.pair, []);
    let room = 0.35 * (high - low).amax();
    let (low, high) = (low.add_scalar(-room), high.add_scalar(room));
    let size = high - low;
    let count = (WORK / tile.magnets.len().max(1) as f64).sqrt();
    let step = size.amax() / count.clamp(SIDE[0], SIDE[1]).floor();
    let [columns, rows] = [size.x, size.y].map(|side| (side / step).round().max(1.0) as usize);
    let centre = |k: usize| {
        let (column, row) = ((k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5);
        let share = Vector2::new(column / columns as f64, row / rows as f64);
        low + size.component_mul(&share)
    };
    let centres: Vec<Vector2<f64>> = (0..columns * rows).map(centre).collect();
    let field = flux_density(design.interaction.model, &tile.magnets, &centres).into_iter();
    let field: Vec<Square> = centres.into_iter().zip(field).collect();
    // Within magnets, and at point dipoles, it has hardly any bounds.
    let mut strengths: Vec<f64> = field.iter().map(|(_, b)| b.norm()).collect();
    strengths.order_by_key(|it| OrderedFloat(*it));
    let most = strengths[strengths.len() * 98 / 100].max(f64::MIN_POSITIVE);
    let share = |b: f64| ((libm::log10(b / most) + DECADES) / DECADES).clamp(0.0, 1.0);
    let height =
        move |width: f64| MARGIN[0] + (width - MARGIN[1] - MARGIN[3]) * size.y / size.x + MARGIN[2];
    let panel = Panel::alone(height, |canvas: &mut Canvas, place| {
        let axes = [0, 1].map(|k| Axis::even([low[k], high[k]], 1.0, 6, ["x (m)", "y (m)"][k]));
        let plot = Plot::new(canvas, place, MARGIN, axes, false);
        cells(canvas, &plot, [columns, rows], colour, |i, j| {
            Some(share(field[j * columns + i].1.norm()))
        });
        let view = View::plotted(&plot, size.x);
        for (at, b) in arrows(&field, columns) {
            let long = 0.35 * step * ARROW as f64 * b.normalize();
            let across = Vector2::new(-long.y, long.x);
            let tip = at + long;
            let head = [
                tip - 0.6 * long + 0.35 * across,
                tip,
                tip - 0.6 * long - 0.35 * across,
            ];
            canvas.line(&[at - long, tip].map(|p| view.pixel(p)), INK, 1.1);
            canvas.line(&head.map(|p| view.pixel(p)), INK, 1.1);
        }
        view.tile(canvas, tile, &ORIGIN, FIXED_FILL);
    });
    let top = libm::log10(most).floor() as i32;
    let powers = (0..DECADES as i32).map(|k| 10f64.powi(top - k));
    let marks = powers.map(|power| Marked {
        at: share(power),
        text: si(power, "T", 1),
        is_crossed: false,
    });
    let said =
        "arrows: direction of the field; fields beyond the scale have the colours of its ends";
    let composition = Composition {
        name: "field".to_owned(),
        title: format!("{}: magnetic field of the fixed tile", design.name),
        width: WIDTH,
        panels: vec![panel],
        keys: vec![
            bar("magnetic flux density", colour, marks),
            key(POLES),
            remark(said.to_owned()),
        ],
        ..Composition::default()
    };
    let numbers =
        arrows(&field, columns).map(|(p, b)| [p.x, p.y, b.x, b.y].map(|it| rounded(it, 5)));
    let numbers = table(["x_m", "y_m", "field_x_T", "field_y_T"], numbers);
    Figure::new(&composition, sheet, numbers)
}

/// Every so many squares one, where the field points anywhere.
fn arrows(field: &[Square], columns: usize) -> impl Iterator<Item = Square> {
    let middle = ARROW / 2;
    let rows = field.chunks(columns).skip(middle).step_by(ARROW);
    let squares = rows.flat_map(move |row| row.iter().skip(middle).step_by(ARROW));
    squares.copied().filter(|(_, b)| b.norm() > 0.0)
}
