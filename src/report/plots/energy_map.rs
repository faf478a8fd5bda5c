//! The landscape map: the lowest energy over theta at each (x, y), with the fixed tile, the states
//! and the pathways on it.

use nalgebra::Vector2;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::marks::{Labels, Mark, Pixel, View, marker, polygon, seamed_line, tile};
use super::picture::{Area, Picture, PictureError, Underlay};
use super::scale::{EnergyScale, Range, colour};
use super::scene::Scene;
use super::style::{
    Axis, Chart, FIXED_FILL, INK, LABEL, SMALL, Text, VERMILLION, chart, pixel, title, units,
};
use crate::configuration::Configuration;
use crate::landscape::StateKind;
use crate::landscape::map::{EnergyMap, Grid, Sample};

const WIDTH: u32 = 1000;
/// Space around the plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [54.0, 220.0, 56.0, 78.0];
/// Pixels of the embedded image along the longer side.
const IMAGE: f64 = 480.0;

pub fn draw(
    scene: &Scene,
    map: &EnergyMap,
    scale: &EnergyScale,
) -> Result<Picture, PictureError> {
    let (x, y) = (&map.lowest.x, &map.lowest.y);
    let span = (x[x.len() - 1] - x[0], y[y.len() - 1] - y[0]);
    let plot_width = f64::from(WIDTH) - MARGIN[1] - MARGIN[3];
    let plot_height = (plot_width * span.1 / span.0).clamp(300.0, 1200.0);
    let height = (plot_height + MARGIN[0] + MARGIN[2]) as u32;
    let range = Range::of(scale, energies(&map.lowest));
    Picture::draw((WIDTH, height), |root, underlays| {
        title(
            root,
            &format!("{}: lowest energy over θ", scene.name),
        )?;
        let axis = |values: &[f64], name: &str| {
            Axis::linear(values[0]..values[values.len() - 1], 7, name)
        };
        let chart = chart(
            root,
            MARGIN,
            &axis(x, "x (m)"),
            &axis(y, "y (m)"),
            false,
        )?;
        let frame = frame(&chart, &map.lowest);
        underlays.push(Underlay {
            bitmap: image(map, scale, &range, span),
            rectangle: frame.map(units),
        });
        polyline_box(root, frame)?;
        let view = View {
            origin: pixel(&chart, 0.0, 0.0),
            scale: plot_width / span.0,
        };
        let origin = Configuration::new(0.0, 0.0, 0.0);
        tile(root, &view, scene.pair.fixed, &origin, FIXED_FILL)?;
        pathways(root, &view, scene, frame)?;
        states(root, &view, scene, scale, frame)?;
        let right = f64::from(WIDTH) - MARGIN[1] + 30.0;
        colour_bar(root, scale, &range, [right, MARGIN[0] + 28.0, right + 22.0, 430.0])?;
        legend(root, (right, 470.0))
    })
}

fn energies(grid: &Grid<Sample>) -> impl Iterator<Item = f64> + '_ {
    grid.values.iter().flatten().map(|sample| sample.energy)
}

/// Left, top, right, bottom of the plot (pixels).
pub fn frame(chart: &Chart, grid: &Grid<Sample>) -> [f64; 4] {
    let (x, y) = (&grid.x, &grid.y);
    let low = pixel(chart, x[0], y[0]);
    let high = pixel(chart, x[x.len() - 1], y[y.len() - 1]);
    [low.0, high.1, high.0, low.1]
}

pub fn polyline_box(root: &Area, [left, top, right, bottom]: [f64; 4]) -> Result<(), PictureError> {
    let corners = [
        (left, top),
        (right, top),
        (right, bottom),
        (left, bottom),
        (left, top),
    ];
    super::marks::polyline(root, &corners, INK, 1.0)
}

fn image(
    map: &EnergyMap,
    scale: &EnergyScale,
    range: &Range,
    span: (f64, f64),
) -> super::picture::Bitmap {
    let longer = span.0.max(span.1);
    let pixels = |side: f64| (IMAGE * side / longer).round().max(1.0) as usize;
    let interpolated = Interpolated::new(&map.lowest, scale);
    range.bitmap((pixels(span.0), pixels(span.1)), |u, v| {
        let room = interpolated.corners(u, v).map(|(i, w)| w * map.room[i]);
        if room.iter().sum::<f64>() < 0.0 {
            return None;
        }
        interpolated.position(u, v).map(|(position, _)| position)
    })
}

/// A grid's energies as positions on a scale, linear between grid points.
pub struct Interpolated {
    columns: usize,
    rows: usize,
    positions: Vec<Option<f64>>,
}

impl Interpolated {
    pub fn new(grid: &Grid<Sample>, scale: &EnergyScale) -> Self {
        Self {
            columns: grid.x.len(),
            rows: grid.y.len(),
            positions: grid
                .values
                .iter()
                .map(|v| v.map(|sample| scale.position(sample.energy)))
                .collect(),
        }
    }

    /// The four grid points about a place (fractions of the width and the height) with their
    /// weights.
    fn corners(&self, u: f64, v: f64) -> [(usize, f64); 4] {
        let cell = |f: f64, count: usize| {
            let at = f.clamp(0.0, 1.0) * (count - 1) as f64;
            let low = (at.floor() as usize).min(count - 2);
            (low, at - low as f64)
        };
        let (i, s) = cell(u, self.columns);
        let (j, t) = cell(v, self.rows);
        let index = |i: usize, j: usize| j * self.columns + i;
        [
            (index(i, j), (1.0 - s) * (1.0 - t)),
            (index(i + 1, j), s * (1.0 - t)),
            (index(i, j + 1), (1.0 - s) * t),
            (index(i + 1, j + 1), s * t),
        ]
    }

    /// The mean over the free grid points about a place, and their share of the weight.
    pub fn position(&self, u: f64, v: f64) -> Option<(f64, f64)> {
        let (mut sum, mut weight) = (0.0, 0.0);
        for (index, w) in self.corners(u, v) {
            if let Some(position) = self.positions[index] {
                sum += w * position;
                weight += w;
            }
        }
        (weight > 0.0).then(|| (sum / weight, weight))
    }
}

fn pathways(
    root: &Area,
    view: &View,
    scene: &Scene,
    frame: [f64; 4],
) -> Result<(), PictureError> {
    for barrier in scene.escapes() {
        let points: Vec<_> = barrier
            .pathway
            .iter()
            .map(|p| view.pixel(p.configuration.position()))
            .collect();
        for piece in points.split(|p| !inside(frame, *p)) {
            seamed_line(root, piece, INK, 1.8)?;
        }
    }
    for barrier in scene.escapes() {
        let saddle = view.pixel(barrier.saddle.position());
        if inside(frame, saddle) {
            marker(root, Mark::Saddle, saddle, 6.0)?;
        }
    }
    Ok(())
}

fn inside([left, top, right, bottom]: [f64; 4], (x, y): Pixel) -> bool {
    x >= left && x <= right && y >= top && y <= bottom
}

/// All states as markers, one a place; each class named at its copy nearest to the target.
fn states(
    root: &Area,
    view: &View,
    scene: &Scene,
    scale: &EnergyScale,
    frame: [f64; 4],
) -> Result<(), PictureError> {
    let mut labels = Labels::new(frame);
    let mut drawn: Vec<Pixel> = Vec::new();
    // Bound states last, on top.
    let mut states: Vec<_> = scene.states.iter().collect();
    states.sort_by_key(|state| state.kind == StateKind::Bound);
    for state in states {
        let at = view.pixel(state.configuration.position());
        let repeated = drawn.iter().any(|p| (p.0 - at.0).hypot(p.1 - at.1) < 1.0);
        if inside(frame, at) && !repeated {
            marker(root, state.kind.into(), at, 7.0)?;
            labels.keep_off(at, 7.0);
            drawn.push(at);
        }
    }
    for class in scene.classes().iter().take(8) {
        let at = view.pixel(class.state.configuration.position());
        let name = match class.state.kind {
            StateKind::Bound => "bound ",
            StateKind::Misbound => "",
        };
        let text = format!(
            "{name}{}: {}",
            class.state.id,
            scale.label(class.state.energy, 3)
        );
        let out = class.state.configuration.position();
        let outwards = Vector2::new(out.x, -out.y).normalize();
        labels.place(root, &text, Text::new(SMALL), at, outwards)?;
    }
    Ok(())
}

/// The colours with their energies.
pub fn colour_bar(
    root: &Area,
    scale: &EnergyScale,
    range: &Range,
    [left, top, right, bottom]: [f64; 4],
) -> Result<(), PictureError> {
    let steps = 120;
    let at = |position: f64| bottom - (bottom - top) * (position - range.low) / (range.high - range.low);
    for k in 0..steps {
        let (a, b) = (k as f64 / steps as f64, (k + 1) as f64 / steps as f64);
        let [p, q] = [a, b].map(|t| range.low + (range.high - range.low) * t);
        let [r, g, bl] = colour((p + q) / 2.0);
        // Half a pixel over the next step, so that no seam shows between the two.
        let upper = (at(q) - 0.5).max(top);
        let step = [(left, upper), (right, upper), (right, at(p)), (left, at(p))];
        polygon(root, &step, RGBColor(r, g, bl), None)?;
    }
    polyline_box(root, [left, top, right, bottom])?;
    Text::new(LABEL).write(
        root,
        "energy U",
        (left, top - 10.0),
        (HPos::Left, VPos::Bottom),
    )?;
    for energy in scale.ticks(range.low, range.high) {
        let y = at(scale.position(energy));
        let zero = energy == 0.0;
        let reach = if zero { right + 9.0 } else { right + 5.0 };
        let start = if zero { left } else { right };
        super::marks::polyline(root, &[(start, y), (reach, y)], INK, if zero { 1.6 } else { 1.0 })?;
        let font = if zero {
            Text::new(SMALL).bold()
        } else {
            Text::new(SMALL)
        };
        let text = if zero {
            "0".into()
        } else {
            scale.label(energy, 1)
        };
        font.write(root, &text, (right + 12.0, y), (HPos::Left, VPos::Center))?;
    }
    Ok(())
}

fn legend(root: &Area, (left, top): Pixel) -> Result<(), PictureError> {
    let font = Text::new(SMALL);
    let entries = [
        (Some(Mark::Bound), "bound state"),
        (Some(Mark::Misbound), "misbound state"),
        (Some(Mark::Saddle), "saddle"),
        (None, "way out of a state"),
    ];
    let mut y = top;
    for (mark, text) in entries {
        match mark {
            Some(mark) => marker(root, mark, (left + 11.0, y), 7.0)?,
            None => seamed_line(root, &[(left, y), (left + 22.0, y)], INK, 1.8)?,
        }
        font.write(root, text, (left + 32.0, y), (HPos::Left, VPos::Center))?;
        y += 26.0;
    }
    blocked_key(root, (left, y))?;
    y += 26.0;
    for (colour, text) in [(VERMILLION, "north pole"), (super::style::BLUE, "south pole")] {
        let block = [
            (left + 4.0, y - 6.0),
            (left + 18.0, y - 6.0),
            (left + 18.0, y + 6.0),
            (left + 4.0, y + 6.0),
        ];
        polygon(root, &block, colour, None)?;
        font.write(root, text, (left + 32.0, y), (HPos::Left, VPos::Center))?;
        y += 26.0;
    }
    Ok(())
}

/// The key of the hatching.
pub fn blocked_key(root: &Area, (left, y): Pixel) -> Result<(), PictureError> {
    let (right, top, bottom) = (left + 22.0, y - 8.0, y + 8.0);
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
    polygon(root, &corners, RGBColor(224, 224, 224), None)?;
    for shift in [-8.0, 3.0, 14.0] {
        let x0: f64 = left + shift;
        let (from, to) = (x0.max(left), (x0 + 16.0).min(right));
        let stripe = [(from, bottom - (from - x0)), (to, bottom - (to - x0))];
        super::marks::polyline(root, &stripe, RGBColor(198, 198, 198), 2.2)?;
    }
    polyline_box(root, [left, top, right, bottom])?;
    Text::new(SMALL).write(
        root,
        "tiles would overlap",
        (left + 32.0, y),
        (HPos::Left, VPos::Center),
    )
}
