//! The approach slices: energy in front of the target face, gap against tilt, and slide against
//! tilt in contact.

use plotters::style::text_anchor::{HPos, VPos};

use super::heat::{Interpolated, Key, Range, STATE_KEYS, colour_bar, frame, keys};
use super::marks::{Mark, marker, outline};
use super::picture::{Area, Picture, PictureError, Underlay};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{Axis, INK, LABEL, Text, chart, pixel, title, units};
use crate::landscape::approach::{Approach, ApproachSlices, SliceSettings};
use crate::landscape::map::{Grid, Sample};
use crate::units::prefix_of;

const SIZE: (u32, u32) = (1000, 640);
/// Width and height of a panel (pixels).
const PANEL: (f64, f64) = (490.0, 520.0);
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [84.0, 14.0, 62.0, 84.0];
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

pub fn draw(
    scene: &Scene,
    approach: &Approach,
    slices: &ApproachSlices,
    scale: &EnergyScale,
) -> Result<Picture, PictureError> {
    let panels = [
        ApproachPanel {
            grid: &slices.gap,
            quantity: "gap",
            condition: "slide 0",
            states: Vec::new(),
        },
        ApproachPanel {
            grid: &slices.slide,
            quantity: "slide",
            condition: "in contact",
            states: states_in_front(scene, approach),
        },
    ];
    let energies = panels
        .iter()
        .flat_map(|panel| panel.grid.values.iter().flatten())
        .map(|sample| sample.energy);
    let range = Range::of(scale, energies);
    let fixed = &scene.pair.target_face().name;
    let moving = &scene.pair.moving.faces[scene.pair.target.1].name;
    Picture::draw(SIZE, |root, underlays| {
        let text = format!(
            "{}: {moving} face in front of the fixed {fixed} face",
            scene.name
        );
        title(root, &text)?;
        let (upper, _) = root.split_vertically(units(PANEL.1));
        let (first, rest) = upper.split_horizontally(units(PANEL.0));
        let (second, _) = rest.split_horizontally(units(PANEL.0));
        for (area, panel) in [first, second].iter().zip(&panels) {
            panel.draw(area, root, underlays, scale, &range)?;
        }
        let top = PANEL.1 + 32.0;
        let bar = [MARGIN[3], top, 720.0, top + 20.0];
        colour_bar(root, underlays, scale, &range, bar)?;
        let mut entries = STATE_KEYS.to_vec();
        if panels.iter().any(ApproachPanel::has_blocked) {
            entries.push((Key::Blocked, "no contact"));
        }
        keys(root, underlays, (770.0, top), &entries)
    })
}

/// Tilt (rad), slide (m) and mark of the states that touch the target face with the target face.
fn states_in_front(scene: &Scene, approach: &Approach) -> Vec<(f64, f64, Mark)> {
    scene
        .states()
        .iter()
        .filter(|state| state.faces.contains(&scene.pair.target))
        .map(|state| {
            let (tilt, slide) = approach.tilt_and_slide(&state.configuration);
            (tilt, slide, state.kind.into())
        })
        .collect()
}

impl ApproachPanel<'_> {
    fn has_blocked(&self) -> bool {
        self.grid.values.iter().any(Option::is_none)
    }

    fn draw(
        &self,
        area: &Area,
        root: &Area,
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
        let chart = chart(area, MARGIN, &x_axis, &y_axis, false)?;
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
