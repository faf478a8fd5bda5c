//! A committor as a colour map, with its reactive flux.

use plotters::style::WHITE;

use super::axes::{Axis, Plot};
use super::canvas::{Box4, Canvas, Pixel};
use super::composition::{Composition, Panel, remark};
use super::heat::{Marked, bar, cells};
use super::picture::PictureError;
use super::scale::colour;
use super::style::{FIXED_FILL, INK};
use super::{Figure, Sheet};
use jobs::design::Design;
use physics::kinetics::rates::map::Map;

const WIDTH: f64 = 640.0;
/// Space around the map (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];
/// Number of squares per arrow, along x and y.
const ARROW: usize = 5;
/// Arrows shorter than this share of the longest are omitted.
const FAINT: f64 = 0.05;

/// The committor as colours, the flux as arrows, the fixed tile as an outline; with its numbers.
///
/// # Errors
/// See [`PictureError`].
pub fn committor(
    design: &Design,
    map: &Map,
    numbers: String,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let square = |width| width - MARGIN[1] - MARGIN[3] + MARGIN[0] + MARGIN[2];
    let panel = Panel::alone(square, |canvas, place| draw(canvas, place, design, map));
    let said = "arrows: flux of tiles on their way from free to the bond; lengths by square root";
    let quarters = (0..=4).map(|quarter| Marked {
        at: f64::from(quarter) / 4.0,
        text: format!("{} %", 25 * quarter),
        is_crossed: false,
    });
    let composition = Composition {
        name: "committor".to_owned(),
        title: format!("{}: committor", design.name),
        width: WIDTH,
        panels: vec![panel],
        keys: vec![
            bar("probability of the bond before free", colour, quarters),
            remark(said.to_owned()),
        ],
        ..Composition::default()
    };
    Figure::new(&composition, sheet, numbers)
}

fn draw(canvas: &mut Canvas, place: Box4, design: &Design, map: &Map) {
    let axes = ["x of the moving tile (m)", "y of the moving tile (m)"]
        .map(|name| Axis::even([-map.radius, map.radius], 1.0, 7, name));
    let plot = Plot::new(canvas, place, MARGIN, axes, false);
    cells(canvas, &plot, [map.side; 2], colour, |i, j| {
        Some(map.committor[j * map.side + i]).filter(|share| share.is_finite())
    });
    let corners = design.pair.fixed.outline.vertices().iter();
    let corners: Vec<Pixel> = corners.map(|v| plot.at(v.x, v.y)).collect();
    canvas.outlined(&corners, FIXED_FILL);
    let at = |line: Vec<[f64; 2]>| -> Vec<Pixel> {
        line.into_iter().map(|[x, y]| plot.at(x, y)).collect()
    };
    let arrows: Vec<Vec<Pixel>> = arrows(map).into_iter().map(at).collect();
    // All seams first, so that none hides a part of an arrow.
    for (colour, width) in [(WHITE, 3.0), (INK, 1.3)] {
        for line in &arrows {
            canvas.line(line, colour, width);
        }
    }
}

/// Arrows of the mean flux of groups of squares, as lines (m): the shaft, then the head.
fn arrows(map: &Map) -> Vec<Vec<[f64; 2]>> {
    let count = map.side / ARROW;
    let flow = |number: usize| {
        let (i, j) = (number % count * ARROW, number / count * ARROW);
        let squares = (0..ARROW * ARROW).map(|k| (j + k / ARROW) * map.side + i + k % ARROW);
        let sum = squares.fold([0.0; 2], |sum, square| {
            [0, 1].map(|k| sum[k] + map.flux[square][k])
        });
        let middle = map.middle((j + ARROW / 2) * map.side + i + ARROW / 2);
        (middle, sum, libm::hypot(sum[0], sum[1]))
    };
    let flows: Vec<_> = (0..count * count).map(flow).collect();
    let most = flows
        .iter()
        .map(|flow| flow.2)
        .fold(f64::MIN_POSITIVE, f64::max);
    let longest = 2.0 * map.radius / count as f64;
    let strong = flows.iter().filter(|flow| flow.2 >= FAINT * most);
    let arrow = |(middle, flow, size): &([f64; 2], [f64; 2], f64)| {
        let long = (size / most).sqrt() * longest;
        // Positions along and across the arrow, as shares of its length.
        let at = |along: f64, across: f64| {
            let [u, v] = flow.map(|part| part / size * long);
            [
                middle[0] + along * u - across * v,
                middle[1] + along * v + across * u,
            ]
        };
        let tip = at(0.5, 0.0);
        [
            vec![at(-0.5, 0.0), tip],
            vec![at(0.2, 0.2), tip, at(0.2, -0.2)],
        ]
    };
    strong.flat_map(arrow).collect()
}
