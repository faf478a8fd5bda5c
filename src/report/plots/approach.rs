//! The approach slices: energy in front of the target face, gap against tilt, and slide against
//! tilt in contact.

use super::axes::{Axis, Plot};
use super::canvas::{Box4, Canvas};
use super::composition::{Composition, Panel};
use super::decimals::{Decimals, angle, energy};
use super::heat::{Interpolated, Range};
use super::key::{self, Sign, key};
use super::marks::{Mark, marker};
use super::scale::EnergyScale;
use super::scene::Scene;
use crate::csv::table;
use crate::names::face;
use physics::landscape::approach::{Approach, ApproachSlices};
use physics::landscape::grid::{Grid, Sample};
use physics::order::Order;

const WIDTH: f64 = 1000.0;
/// Smallest width (pixels) of a panel beside the other.
const LEAST: f64 = 360.0;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [34.0, 20.0, 62.0, 84.0];
/// Pixels of an embedded image along either side.
const IMAGE: usize = 330;

struct ApproachPanel<'a> {
    grid: &'a Grid<Sample>,
    /// The quantity plotted against the tilt.
    quantity: &'a str,
    /// The condition that holds throughout the panel.
    condition: &'a str,
    /// Tilt (rad) and quantity (m) of the states in the panel.
    states: Vec<(f64, f64, Mark)>,
}

/// The picture of a scene's slices.
pub fn composed<'a>(
    scene: &'a Scene,
    approach: &Approach,
    slices: &'a ApproachSlices,
    scale: &'a EnergyScale,
) -> Composition<'a> {
    let gap = ApproachPanel {
        grid: &slices.gap,
        quantity: "gap",
        condition: "slide 0",
        states: Vec::new(),
    };
    let slide = ApproachPanel {
        grid: &slices.slide,
        quantity: "slide",
        condition: "in contact",
        states: states_in_front(scene, approach),
    };
    let panels = [gap, slide];
    let energies = panels
        .iter()
        .flat_map(|panel| panel.grid.values.iter().flatten())
        .map(|sample| sample.energy);
    let range = Range::of(scale, energies);
    let is_blocked = |panel: &ApproachPanel| panel.grid.values.iter().any(Option::is_none);
    let blocked = panels.iter().any(is_blocked);
    let blocked = blocked.then_some((Sign::Blocked, "no contact"));
    let meanings = key::STATES.into_iter().chain(blocked);
    let fixed = face(&scene.pair.target_face().name);
    let moving = face(&scene.pair.moving.faces[scene.pair.target.1].name);
    let height = |width: f64| MARGIN[0] + 0.95 * (width - MARGIN[1] - MARGIN[3]) + MARGIN[2];
    let panels = panels.map(|panel| {
        Panel::new(panel.quantity, LEAST, height, move |canvas, place| {
            panel.draw(canvas, place, scale, &range);
        })
    });
    Composition {
        name: "approach".to_owned(),
        title: format!("{}: {moving} in front of the fixed {fixed}", scene.name),
        width: WIDTH,
        panels: panels.into(),
        keys: vec![range.bar(scale), key(meanings)],
        ..Composition::default()
    }
}

/// The numbers of the picture.
pub fn data(slices: &ApproachSlices, decimals: Decimals) -> String {
    let head = ["panel", "tilt_rad", "gap_or_slide_m", "energy_J"];
    let panels = [("gap", &slices.gap), ("slide", &slices.slide)];
    let rows = panels.into_iter().flat_map(|(name, grid)| {
        let samples = grid.values.iter().enumerate();
        samples.filter_map(move |(k, sample)| {
            let sample = sample.as_ref()?;
            let tilt = angle(grid.x[k % grid.x.len()]);
            let height = decimals.length(grid.y[k / grid.x.len()]);
            Some(vec![name.to_owned(), tilt, height, energy(sample.energy)])
        })
    });
    table(head, rows)
}

/// Tilt (rad), slide (m) and mark of the states that touch the target face with the target face.
fn states_in_front(scene: &Scene, approach: &Approach) -> Vec<(f64, f64, Mark)> {
    let states = scene.states().iter();
    let touching = states.filter(|state| state.faces.contains(&scene.pair.target));
    let mut marks: Vec<(f64, f64, Mark)> = touching
        .map(|state| {
            let (tilt, slide) = approach.tilt_and_slide(&state.configuration);
            (tilt, slide, state.kind.into())
        })
        .collect();
    // The bond on top.
    marks.order_by_key(|(.., mark)| *mark == Mark::Bond);
    marks
}

impl ApproachPanel<'_> {
    fn draw(&self, canvas: &mut Canvas, place: Box4, scale: &EnergyScale, range: &Range) {
        let ends = |along: &[f64]| [along[0], along[along.len() - 1]];
        let (tilts, heights) = (ends(&self.grid.x), ends(&self.grid.y));
        let axes = [
            Axis::even(tilts, 1f64.to_radians(), 7, "tilt (\u{b0})"),
            Axis::quantity(heights, "m", 9, self.quantity),
        ];
        let plot = Plot::new(canvas, place, MARGIN, axes, false);
        let interpolated = Interpolated::new(self.grid, scale);
        range.fill(canvas, &plot, [IMAGE; 2], |u, v| {
            let known = interpolated.position(u, v);
            let (position, _) = known.filter(|(_, weight)| *weight >= 0.5)?;
            Some(position)
        });
        let heading = format!("{} against tilt, {}", self.quantity, self.condition);
        plot.heading(canvas, &heading);
        let within = |[low, high]: [f64; 2], value| low <= value && value < high;
        for (tilt, height, mark) in &self.states {
            if within(tilts, *tilt) && within(heights, *height) {
                marker(canvas, *mark, plot.at(*tilt, *height), 6.0);
            }
        }
    }
}
