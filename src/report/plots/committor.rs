//! A committor as a map of colours, with its reactive flux.

use plotters::prelude::WHITE;
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, part, remark, stacked};
use super::heat::frame;
use super::marks::{Box4, Pixel, outline, polygon, polyline};
use super::picture::{Area, Bitmap, PictureError, Underlay};
use super::scale::colour;
use super::style::{Axis, FIXED_FILL, INK, SMALL, Text, chart, pixel, units};
use super::{Figure, Sheet};
use jobs::design::Design;
use physics::kinetics::map::Map;

const WIDTH: f64 = 640.0;
/// Space around the map (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [10.0, 24.0, 62.0, 84.0];
const COLOURS: usize = 200;
/// Pixels of the embedded image across a square, so that squares keep their edges.
const SHARP: usize = 8;
/// Squares that an arrow stands for, along x and y.
const ARROW: usize = 5;
/// Arrows are left out that are this share of the longest.
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
    let panel = Panel::new("", 0.0, square, |root, underlays, place| {
        draw(root, underlays, place, design, map)
    });
    let said = "arrows: the flux of tiles on their way from free to the bond, lengths by its root";
    let composition = Composition {
        name: "committor".to_owned(),
        title: format!("{}: committor", design.name),
        note: None,
        width: WIDTH,
        panels: vec![panel],
        key: Some(stacked(
            Panel::new("", 0.0, |_| 78.0, bar),
            remark(said.to_owned()),
        )),
    };
    Figure::new(&composition, sheet, numbers)
}

/// Colours from none to all, and white for where nothing is free.
fn palette() -> Vec<[u8; 3]> {
    let shade = |k: usize| colour(k as f64 / (COLOURS - 1) as f64);
    (0..COLOURS).map(shade).chain([[255; 3]]).collect()
}

fn shaded(share: f64) -> u8 {
    match share.is_finite() {
        true => (share * (COLOURS - 1) as f64).round() as u8,
        false => COLOURS as u8,
    }
}

fn draw(
    root: &Area,
    underlays: &mut Vec<Underlay>,
    place: Box4,
    design: &Design,
    map: &Map,
) -> Result<(), PictureError> {
    let ends = [-map.radius, map.radius];
    let axis = |name| Axis::linear(ends[0]..ends[1], 7, name);
    let (x_axis, y_axis) = (
        axis("x of the moving tile (m)"),
        axis("y of the moving tile (m)"),
    );
    let area = part(root, place);
    let chart = chart(&area, MARGIN, &x_axis, &y_axis, false)?;
    let frame = frame(&chart, &ends, &ends);
    let side = map.side * SHARP;
    let shade = |k: usize| {
        let (i, j) = (k % side / SHARP, map.side - 1 - k / side / SHARP);
        shaded(map.committor[j * map.side + i])
    };
    underlays.push(Underlay {
        bitmap: Bitmap {
            width: side,
            palette: palette(),
            pixels: (0..side * side).map(shade).collect(),
        },
        rectangle: frame.map(units),
    });
    let at = |[x, y]: [f64; 2]| pixel(&chart, x, y);
    let corners = design.pair.fixed.outline.vertices().iter();
    let corners: Vec<Pixel> = corners.map(|v| at([v.x, v.y])).collect();
    polygon(root, &corners, FIXED_FILL, Some((INK, 1.2)))?;
    let arrows = arrows(map).into_iter();
    let arrows: Vec<Vec<Pixel>> = arrows
        .map(|line| line.into_iter().map(at).collect())
        .collect();
    // All seams first: none is to hide a part of an arrow.
    for (colour, width) in [(WHITE, 3.0), (INK, 1.3)] {
        for line in &arrows {
            polyline(root, line, colour, width)?;
        }
    }
    outline(root, frame, INK)
}

/// Arrows of the mean flux of some squares each, as lines (m): the shaft, then the head.
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
        // So far along the arrow and across it, as shares of its length.
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

/// What the colours say.
fn bar(
    root: &Area,
    underlays: &mut Vec<Underlay>,
    [left, top, right, _]: Box4,
) -> Result<(), PictureError> {
    let [left, top, right, bottom] = [left + MARGIN[3], top + 26.0, right - MARGIN[1], top + 44.0];
    underlays.push(Underlay {
        bitmap: Bitmap {
            width: COLOURS,
            palette: palette(),
            pixels: (0..COLOURS).map(|k| k as u8).collect(),
        },
        rectangle: [left, top, right, bottom].map(units),
    });
    outline(root, [left, top, right, bottom], INK)?;
    let small = Text::new(SMALL);
    let name = "how often the bond comes before free";
    small.write(root, name, (left, top - 6.0), (HPos::Left, VPos::Bottom))?;
    for quarter in 0..=4 {
        let x = left + (right - left) * f64::from(quarter) / 4.0;
        polyline(root, &[(x, top), (x, bottom + 6.0)], INK, 1.2)?;
        let text = format!("{} %", 25 * quarter);
        small.write(root, &text, (x, bottom + 10.0), (HPos::Center, VPos::Top))?;
    }
    Ok(())
}
