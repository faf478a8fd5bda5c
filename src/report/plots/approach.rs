//! The approach slices: energy in front of the target face, gap against tilt, and slide against
//! tilt in contact.

use plotters::style::text_anchor::{HPos, VPos};

use super::energy_map::{Interpolated, blocked_key, colour_bar, frame, polyline_box};
use super::marks::{Mark, marker};
use super::picture::{Area, Picture, PictureError, Underlay};
use super::scale::{EnergyScale, Range};
use super::scene::Scene;
use super::style::{Axis, LABEL, SMALL, Text, chart, pixel, title, units};
use crate::landscape::map::{Approach, ApproachSlices, Grid, Sample};
use crate::units::prefix_of;

const SIZE: (u32, u32) = (1000, 520);
const PANEL: i32 = 425;
const IMAGE: usize = 300;

pub fn draw(
    scene: &Scene,
    approach: &Approach,
    slices: &ApproachSlices,
    scale: &EnergyScale,
) -> Result<Picture, PictureError> {
    let samples = [&slices.gap, &slices.slide];
    let energies = samples
        .iter()
        .flat_map(|grid| grid.values.iter().flatten())
        .map(|sample| sample.energy);
    let range = Range::of(scale, energies);
    let (fixed, moving) = (
        &scene.pair.fixed.faces[scene.target.0].name,
        &scene.pair.moving.faces[scene.target.1].name,
    );
    Picture::draw(SIZE, |root, underlays| {
        title(
            root,
            &format!("{}: {moving} face in front of {fixed} face", scene.name),
        )?;
        let (gap, rest) = root.split_horizontally(units(f64::from(PANEL)));
        let (slide, _) = rest.split_horizontally(units(f64::from(PANEL)));
        panel(&gap, root, underlays, &slices.gap, "gap", "slide 0", scale, &range, &[])?;
        let in_front = states_in_front(scene, approach);
        panel(
            &slide,
            root,
            underlays,
            &slices.slide,
            "slide",
            "in contact",
            scale,
            &range,
            &in_front,
        )?;
        let left = 2.0 * f64::from(PANEL) + 20.0;
        colour_bar(root, scale, &range, [left, 96.0, left + 22.0, 440.0])?;
        let _ = blocked_key;
        Ok(())
    })
}

/// Tilt (rad), slide (m) and mark of the states that touch the target face with the target face.
fn states_in_front(scene: &Scene, approach: &Approach) -> Vec<(f64, f64, Mark)> {
    scene
        .states
        .iter()
        .filter(|state| state.faces.contains(&scene.target))
        .map(|state| {
            let (tilt, slide) = approach.tilt_and_slide(&state.configuration);
            (tilt, slide, state.kind.into())
        })
        .collect()
}

#[allow(clippy::too_many_arguments)]
fn panel(
    area: &Area,
    root: &Area,
    underlays: &mut Vec<Underlay>,
    grid: &Grid<Sample>,
    quantity: &str,
    condition: &str,
    scale: &EnergyScale,
    range: &Range,
    states: &[(f64, f64, Mark)],
) -> Result<(), PictureError> {
    let degrees = |tilt: f64| tilt.to_degrees();
    let y = &grid.y;
    let (low, high) = (y[0], y[y.len() - 1]);
    let (unit, prefix) = prefix_of(high * 0.999);
    let shown = Grid::<Sample> {
        x: grid.x.iter().map(|t| degrees(*t)).collect(),
        y: y.iter().map(|v| v / unit).collect(),
        values: grid.values.clone(),
    };
    let columns = shown.x.len();
    let x_axis = Axis::linear(shown.x[0]..shown.x[columns - 1], 7, "tilt (°)");
    let y_axis = Axis::linear(low / unit..high / unit, 7, format!("{quantity} ({prefix}m)"));
    let chart = chart(area, [84.0, 20.0, 56.0, 78.0], &x_axis, &y_axis, false)?;
    let frame = frame(&chart, &shown);
    let interpolated = Interpolated::new(&shown, scale);
    underlays.push(Underlay {
        bitmap: range.bitmap((IMAGE, IMAGE), |u, v| {
            interpolated
                .position(u, v)
                .filter(|(_, weight)| *weight >= 0.5)
                .map(|(position, _)| position)
        }),
        rectangle: frame.map(units),
    });
    polyline_box(root, frame)?;
    Text::new(LABEL).bold().write(
        root,
        &format!("{quantity} against tilt, {condition}"),
        (frame[0], frame[1] - 12.0),
        (HPos::Left, VPos::Bottom),
    )?;
    for (tilt, slide, mark) in states {
        let (tilt, slide) = (degrees(*tilt), slide / unit);
        if tilt.abs() <= shown.x[columns - 1] && slide >= low / unit && slide <= high / unit {
            marker(root, *mark, pixel(&chart, tilt, slide), 6.5)?;
        }
    }
    let _ = SMALL;
    Ok(())
}
