//! The approach slices: energy in front of the target face, gap against tilt, and slide against
//! tilt in contact.

use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel, part};
use super::heat::{Interpolated, Range, frame, legend};
use super::key::{Key, STATE_KEYS};
use super::marks::{Box4, Mark, marker, outline};
use super::picture::{Area, PictureError, Underlay};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{Axis, INK, LABEL, Text, chart, pixel, units};
use super::{energy, length};
use crate::csv::table;
use crate::names::face;
use physics::landscape::approach::{Approach, ApproachSlices, SliceSettings};
use physics::landscape::grid::{Grid, Sample};
use physics::order::Order;
use physics::units::prefix_of;

const WIDTH: f64 = 1000.0;
/// The least width (pixels) of a panel beside the other.
const LEAST: f64 = 360.0;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [34.0, 20.0, 62.0, 84.0];
/// Pixels of an embedded image along either side.
const IMAGE: usize = 330;
/// Grid points along either side.
const SAMPLES: usize = 161;

/// The motion in front of the target face, and the slices to draw.
pub fn slices<'a>(scene: &Scene<'a>) -> (Approach<'a>, ApproachSlices) {
    let approach = Approach::new(scene.pair);
    let length = scene.pair.target_face().length();
    let settings = SliceSettings {
        tilt: std::f64::consts::FRAC_PI_4,
        gap: 0.2 * length,
        slide: 0.5 * length,
        samples: SAMPLES,
    };
    let slices = ApproachSlices::new(scene.problem, &approach, &settings);
    (approach, slices)
}

struct ApproachPanel<'a> {
    grid: &'a Grid<Sample>,
    /// What is plotted against the tilt.
    quantity: &'a str,
    /// What holds throughout the panel.
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
    let mut entries = STATE_KEYS.to_vec();
    if panels.iter().any(ApproachPanel::has_blocked) {
        entries.push((Key::Blocked, "no contact"));
    }
    let fixed = face(&scene.pair.target_face().name);
    let moving = face(&scene.pair.moving.faces[scene.pair.target.1].name);
    let height = |width: f64| MARGIN[0] + 0.95 * (width - MARGIN[1] - MARGIN[3]) + MARGIN[2];
    let panels = panels.map(|panel| {
        Panel::new(
            panel.quantity,
            LEAST,
            height,
            move |root, underlays, place| panel.draw(root, place, underlays, scale, &range),
        )
    });
    Composition {
        name: "approach".to_owned(),
        title: format!("{}: {moving} in front of the fixed {fixed}", scene.name),
        note: None,
        width: WIDTH,
        panels: panels.into(),
        key: Some(legend(scale, range, entries)),
    }
}

/// The numbers of the picture.
pub fn data(slices: &ApproachSlices) -> String {
    let head = ["panel", "tilt_rad", "gap_or_slide_m", "energy_J"];
    let panels = [("gap", &slices.gap), ("slide", &slices.slide)];
    let rows = panels.into_iter().flat_map(|(name, grid)| {
        let samples = grid.values.iter().enumerate();
        samples.filter_map(move |(k, sample)| {
            let sample = sample.as_ref()?;
            let at = [grid.x[k % grid.x.len()], grid.y[k / grid.x.len()]];
            let [tilt, height] = at.map(length);
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
    fn has_blocked(&self) -> bool {
        self.grid.values.iter().any(Option::is_none)
    }

    fn draw(
        &self,
        root: &Area,
        place: Box4,
        underlays: &mut Vec<Underlay>,
        scale: &EnergyScale,
        range: &Range,
    ) -> Result<(), PictureError> {
        let (x, y) = (&self.grid.x, &self.grid.y);
        let (tilts, heights) = (x[0]..x[x.len() - 1], y[0]..y[y.len() - 1]);
        // Just below a power of a thousand still counts as the smaller unit: 1000 mm, not 1 m.
        let (unit, prefix) = prefix_of(0.999 * heights.end);
        let tilt_range = tilts.start.to_degrees()..tilts.end.to_degrees();
        let x_axis = Axis::linear(tilt_range, 7, "tilt (°)");
        let name = format!("{} ({prefix}m)", self.quantity);
        let y_axis = Axis::linear(heights.start / unit..heights.end / unit, 9, name);
        let area = part(root, place);
        let chart = chart(&area, MARGIN, &x_axis, &y_axis, false)?;
        let ends = [x_axis.range.start, x_axis.range.end];
        let frame = frame(&chart, &ends, &[y_axis.range.start, y_axis.range.end]);
        let interpolated = Interpolated::new(self.grid, scale);
        underlays.push(Underlay {
            bitmap: range.bitmap((IMAGE, IMAGE), |u, v| {
                interpolated
                    .position(u, v)
                    .filter(|(_, weight)| *weight >= 0.5)
                    .map(|(position, _)| position)
            }),
            rectangle: frame.map(units),
        });
        outline(root, frame, INK)?;
        Text::new(LABEL).bold().write(
            root,
            &format!("{} against tilt, {}", self.quantity, self.condition),
            (frame[0], frame[1] - 10.0),
            (HPos::Left, VPos::Bottom),
        )?;
        for (tilt, height, mark) in &self.states {
            if tilts.contains(tilt) && heights.contains(height) {
                let at = pixel(&chart, tilt.to_degrees(), height / unit);
                marker(root, *mark, at, 6.0)?;
            }
        }
        Ok(())
    }
}
