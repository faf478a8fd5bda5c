//! The landscape map: the lowest energy over theta at each (x, y), with the fixed tile, the states
//! and the pathways, and an enlarged view of the region in front of the target face.

use super::axes::{Axis, Plot};
use super::canvas::{Box4, Canvas};
use super::composition::{Composition, Panel, left_out};
use super::decimals::{Decimals, energy};
use super::heat::{Interpolated, Range};
use super::key::{self, Sign, key};
use super::map_marks::{NAMED, name_around, name_in_front, ways_and_states};
use super::marks::{Mark, ORIGIN, View};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::sheet::Sheet;
use super::style::FIXED_FILL;
use crate::csv::table;
use physics::configuration::Configuration;
use physics::landscape::map::EnergyMap;
use physics::units::prefix_of;

const WIDTH: f64 = 1000.0;
/// Space around a plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [34.0, 16.0, 62.0, 84.0];
/// Shares of the width of the two plots, and the smallest widths (pixels) at which they are side by
/// side.
const WEIGHTS: [f64; 2] = [0.62, 0.38];
const LEAST: [f64; 2] = [420.0, 280.0];
/// Share of the enlarged view's width behind the bound position: this region is mostly blocked and
/// leaves room for labels.
const LABELS: f64 = 0.4;
/// Pixels of an embedded image per pixel of the picture.
const IMAGE: f64 = 0.8;

/// The two maps of the picture.
pub struct Maps {
    /// All around the fixed tile.
    pub whole: EnergyMap,
    /// In front of the target face.
    pub target: EnergyMap,
}

impl Maps {
    /// The maps for the plots of a sheet.
    pub fn new(scene: &Scene, sheet: &Sheet) -> Self {
        let [whole, target] = plot_sizes(sheet, scene);
        Self {
            whole: EnergyMap::around(scene.problem, scene.pair, whole),
            target: EnergyMap::in_front(scene.problem, scene.pair, target, LABELS),
        }
    }
}

/// Width and height of the two plots (pixels).
fn plot_sizes(sheet: &Sheet, scene: &Scene) -> [[f64; 2]; 2] {
    let width = sheet.width(WIDTH);
    let sides = MARGIN[1] + MARGIN[3];
    let beside = width >= LEAST[0] + LEAST[1] && !sheet.separate;
    let widths = WEIGHTS.map(|weight| width * if beside { weight } else { 1.0 } - sides);
    let [x, y] = scene.problem.space.map_half_size();
    let height = widths[0] * (y / x).clamp(0.6, 1.55);
    widths.map(|width| [width, height])
}

/// The picture of a scene's maps.
pub fn composed<'a>(
    scene: &'a Scene,
    maps: &'a Maps,
    sheet: &Sheet,
    scale: &'a EnergyScale,
) -> Composition<'a> {
    let energies = [&maps.whole, &maps.target]
        .into_iter()
        .flat_map(|map| map.lowest.values.iter().flatten())
        .map(|sample| sample.energy);
    let range = Range::of(scale, energies);
    let plot = |map, heading, axes| MapPlot {
        map,
        heading,
        axes,
        scale,
        range,
    };
    let whole = plot(&maps.whole, "all around the fixed tile", ["x", "y"]);
    let axes = ["away from bound", "along the face"];
    let target = plot(&maps.target, "in front of the target face", axes);
    let [_, height] = plot_sizes(sheet, scene)[0];
    let height = move |_| MARGIN[0] + height + MARGIN[2];
    let named = move |state: &Configuration| target.shows(state);
    let panels = vec![
        Panel::new("around", LEAST[0], height, move |canvas, place| {
            let view = whole.draw(canvas, place);
            view.0.tile(canvas, &scene.pair.fixed, &ORIGIN, FIXED_FILL);
            ways_and_states(canvas, view, scene);
            name_around(canvas, scene, scale, view, named);
        })
        .weighing(WEIGHTS[0]),
        Panel::new("target", LEAST[1], height, move |canvas, place| {
            let view = target.draw(canvas, place);
            ways_and_states(canvas, view, scene);
            name_in_front(canvas, scene, scale, view, named);
        })
        .weighing(WEIGHTS[1]),
    ];
    let more = [
        (Sign::Mark(Mark::Saddle), "saddle"),
        (Sign::Pathway, "pathway out"),
        (Sign::Blocked, "tiles would overlap"),
    ];
    let meanings = key::STATES.into_iter().chain(more).chain(key::POLES);
    Composition {
        name: "map".to_owned(),
        title: format!("{}: lowest energy over \u{3b8}", scene.name),
        note: left_out(scene.kinds().len(), NAMED, "not named"),
        width: WIDTH,
        panels,
        keys: vec![range.bar(scale), key(meanings)],
    }
}

/// The numbers of the picture.
pub fn data(maps: &Maps, decimals: Decimals) -> String {
    let head = ["panel", "x_m", "y_m", "theta_rad", "energy_J"];
    let panels = [("around", &maps.whole), ("target", &maps.target)];
    let rows = panels.into_iter().flat_map(|(name, map)| {
        let samples = map.lowest.values.iter().flatten();
        samples.map(move |sample| {
            let mut row = vec![name.to_owned()];
            row.extend(decimals.pose(sample.configuration.to_array()));
            row.push(energy(sample.energy));
            row
        })
    });
    table(head, rows)
}

/// The plot of a map.
#[derive(Clone, Copy)]
struct MapPlot<'a> {
    map: &'a EnergyMap,
    heading: &'a str,
    axes: [&'a str; 2],
    scale: &'a EnergyScale,
    range: Range,
}

impl MapPlot<'_> {
    /// Whether a configuration lies within the plot.
    fn shows(&self, q: &Configuration) -> bool {
        let window = &self.map.window;
        let at = window.locate(q.position());
        (0..2).all(|k| (window.low[k]..=window.high[k]).contains(&at[k]))
    }

    /// Draws the map with its axes; returns the transform from the plane to pixels, and the plot's
    /// frame.
    fn draw(&self, canvas: &mut Canvas, place: Box4) -> (View, Box4) {
        let window = &self.map.window;
        let longer = (0..2)
            .flat_map(|k| [window.low[k].abs(), window.high[k].abs()])
            .fold(0.0, f64::max);
        // Just below a power of a thousand still counts as the smaller unit: 1000 mm, not 1 m.
        let (unit, prefix) = prefix_of(0.999 * longer);
        let width = place[2] - place[0] - MARGIN[1] - MARGIN[3];
        let axes = [0, 1].map(|k| {
            let range = [window.low[k], window.high[k]];
            let count = if k == 0 && width < 400.0 { 5 } else { 9 };
            Axis::even(range, unit, count, format!("{} ({prefix}m)", self.axes[k]))
        });
        let plot = Plot::new(canvas, place, MARGIN, axes, false);
        let [left, top, right, bottom] = plot.frame;
        let size = [right - left, bottom - top].map(|side| (IMAGE * side).round() as usize);
        let interpolated = Interpolated::new(&self.map.lowest, self.scale);
        self.range.fill(canvas, &plot, size, |u, v| {
            let corners = interpolated.corners(u, v).into_iter();
            let border = corners.map(|(i, weight)| weight * self.map.border_distance[i]);
            let is_free = border.sum::<f64>() >= 0.0;
            let (position, _) = interpolated.position(u, v).filter(|_| is_free)?;
            Some(position)
        });
        plot.heading(canvas, self.heading);
        let scale = (right - left) / (window.high[0] - window.low[0]);
        let view = View {
            origin: (left - window.low[0] * scale, bottom + window.low[1] * scale),
            scale,
            centre: window.origin,
            turn: -window.angle,
        };
        (view, plot.frame)
    }
}
