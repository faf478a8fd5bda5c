//! The energy profile of each main pathway with its barrier marked.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::marks::{Labels, Mark, Pixel, marker, polygon, polyline};
use super::picture::{Area, Picture, PictureError};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{
    Axis, BLUE, Chart, GREEN, INK, LABEL, SMALL, SOFT, Text, VERMILLION, chart, line, pixel,
    title, units,
};
use crate::landscape::{Barrier, Place, StateKind};
use crate::units::prefix_of;

const WIDTH: f64 = 1000.0;
const HEAD: f64 = 50.0;
const PANEL_HEIGHT: f64 = 290.0;
const MOST: usize = 6;
/// Space around a panel's plot (pixels): top, right, bottom, left.
const MARGIN: [f64; 4] = [42.0, 20.0, 52.0, 76.0];

/// One panel a pathway out of a state; `None` where no pathway is known.
pub fn draw(scene: &Scene, scale: &EnergyScale) -> Result<Option<Picture>, PictureError> {
    let mut barriers = scene.escapes();
    barriers.truncate(MOST);
    if barriers.is_empty() {
        return Ok(None);
    }
    let columns = if barriers.len() == 1 { 1 } else { 2 };
    let rows = barriers.len().div_ceil(columns);
    let height = HEAD + PANEL_HEIGHT * rows as f64;
    Picture::draw((WIDTH as u32, height as u32), |root, _| {
        title(root, &format!("{}: energy along the ways out", scene.name))?;
        let (_, body) = root.split_vertically(units(HEAD));
        for (area, barrier) in body.split_evenly((rows, columns)).iter().zip(&barriers) {
            panel(area, root, scene, scale, barrier)?;
        }
        Ok(())
    })
    .map(Some)
}

/// The energies (J) a panel shows: zero, the saddle with its bounds and the start for certain; of
/// an end that lies far below the start only the beginning of the fall.
fn shown_energies(barrier: &Barrier) -> (f64, f64) {
    let energies = || barrier.pathway.iter().map(|p| p.energy);
    let upper = barrier.upper.unwrap_or(f64::NEG_INFINITY);
    let high = energies().fold(upper.max(barrier.saddle_energy).max(0.0), f64::max);
    let start = barrier.pathway[0].energy;
    let lowest = energies().fold(barrier.lower.unwrap_or(0.0).min(0.0), f64::min);
    let climb = high - start.min(0.0);
    let fall = start - lowest;
    let low = if climb > 0.0 && fall > 1.5 * climb && start < 0.0 {
        start - 0.45 * climb
    } else {
        lowest
    };
    let span = (high - low).max(1e-12);
    (low - 0.06 * span, high + 0.16 * span)
}

fn panel(
    area: &Area,
    root: &Area,
    scene: &Scene,
    scale: &EnergyScale,
    barrier: &Barrier,
) -> Result<(), PictureError> {
    let path = &barrier.pathway;
    let (low, high) = shown_energies(barrier);
    let length = path[path.len() - 1].s - path[0].s;
    let (unit, prefix) = prefix_of(low.abs().max(high.abs()) * 0.999);
    let (metre, metre_prefix) = prefix_of(length * 0.999);
    let x_axis = Axis::linear(
        0.0..length / metre,
        6,
        format!("length of the way ({metre_prefix}m)"),
    );
    let y_axis = Axis::linear(low / unit..high / unit, 5, format!("U ({prefix}J)"));
    let chart = chart(area, MARGIN, &x_axis, &y_axis, true)?;
    let at = |s: f64, energy: f64| pixel(&chart, (s - path[0].s) / metre, energy / unit);
    let (left, right) = (at(path[0].s, 0.0).0, at(path[path.len() - 1].s, 0.0).0);

    let (from, to) = (scene.name_of(barrier.from), scene.name_of(barrier.to));
    Text::new(LABEL).bold().write(
        root,
        &format!("{from} \u{2192} {to}"),
        (left, at(0.0, high).1 - 12.0),
        (HPos::Left, VPos::Bottom),
    )?;
    zero_line(root, (left, right), at(0.0, 0.0).1)?;
    if let (Some(lower), Some(upper)) = (barrier.lower, barrier.upper) {
        let (top, bottom) = (at(0.0, upper).1, at(0.0, lower).1.max(at(0.0, upper).1 + 1.5));
        let band = [(left, top), (right, top), (right, bottom), (left, bottom)];
        polygon(root, &band, GREEN.mix(0.3), None)?;
    }
    let floor = at(0.0, low).1;
    let curve: Vec<Pixel> = path.iter().map(|p| at(p.s, p.energy)).collect();
    let ends_above = draw_above(root, &curve, floor)?;
    let _ = line(INK, 1.0);
    let _: Option<Chart> = None;

    let mut labels = Labels::new([left + 3.0, at(0.0, high).1 + 2.0, right - 3.0, floor - 3.0]);
    for p in curve.iter().filter(|p| p.1 < floor) {
        labels.keep_off(*p, 3.0);
    }
    barrier_mark(root, &mut labels, scale, barrier, &at)?;
    ends(root, &mut labels, scene, scale, barrier, &at, (floor, ends_above))
}

fn zero_line(root: &Area, (left, right): (f64, f64), y: f64) -> Result<(), PictureError> {
    polyline(root, &[(left, y), (right, y)], INK, 1.4)?;
    Text::new(SMALL)
        .bold()
        .write(root, "0", (left - 8.0, y), (HPos::Right, VPos::Center))
}

/// Draws a curve down to the height `floor` and no farther; tells whether its end is above it.
fn draw_above(root: &Area, curve: &[Pixel], floor: f64) -> Result<bool, PictureError> {
    let mut piece: Vec<Pixel> = Vec::new();
    for pair in curve.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let cross = || {
            let t = (floor - a.1) / (b.1 - a.1);
            (a.0 + (b.0 - a.0) * t, floor)
        };
        match (a.1 <= floor, b.1 <= floor) {
            (true, true) => piece.extend(if piece.is_empty() { vec![a, b] } else { vec![b] }),
            (true, false) => {
                piece.extend(if piece.is_empty() {
                    vec![a, cross()]
                } else {
                    vec![cross()]
                });
                polyline(root, &piece, BLUE, 2.4)?;
                piece.clear();
            }
            (false, true) => piece = vec![cross(), b],
            (false, false) => {}
        }
    }
    polyline(root, &piece, BLUE, 2.4)?;
    Ok(curve.last().is_some_and(|p| p.1 <= floor))
}

/// The saddle, and an arrow from the start's energy up to it.
fn barrier_mark(
    root: &Area,
    labels: &mut Labels,
    scale: &EnergyScale,
    barrier: &Barrier,
    at: &dyn Fn(f64, f64) -> Pixel,
) -> Result<(), PictureError> {
    let highest = barrier
        .pathway
        .iter()
        .max_by(|a, b| a.energy.total_cmp(&b.energy));
    let Some(top) = highest else { return Ok(()) };
    let saddle = at(top.s, barrier.saddle_energy);
    let foot = at(top.s, barrier.from_energy);
    if foot.1 - saddle.1 > 12.0 {
        polyline(root, &[saddle, foot], VERMILLION, 1.4)?;
        polyline(root, &[(foot.0 - 7.0, foot.1), (foot.0 + 7.0, foot.1)], VERMILLION, 1.4)?;
        polyline(root, &[at(barrier.pathway[0].s, barrier.from_energy), foot], SOFT, 0.6)?;
    }
    marker(root, Mark::Saddle, saddle, 5.5)?;
    labels.keep_off(saddle, 7.0);
    let text = format!("barrier {}", scale.label(barrier.forward(), 4));
    let below = nalgebra::Vector2::new(0.7, 0.7);
    let middle = (foot.0, (foot.1 + saddle.1) / 2.0);
    labels.place(root, &text, Text::new(SMALL).bold().colour(VERMILLION), middle, below)?;
    let text = format!("saddle {}", scale.label(barrier.saddle_energy, 4));
    let above = nalgebra::Vector2::new(0.2, -1.0);
    labels.place(root, &text, Text::new(SMALL), saddle, above)
}

fn ends(
    root: &Area,
    labels: &mut Labels,
    scene: &Scene,
    scale: &EnergyScale,
    barrier: &Barrier,
    at: &dyn Fn(f64, f64) -> Pixel,
    (floor, end_shown): (f64, bool),
) -> Result<(), PictureError> {
    let mark_of = |place: Place| match place {
        Place::Free => Mark::Free,
        Place::State(id) => scene
            .state(id)
            .map_or(Mark::Misbound, |state: &crate::landscape::State| match state.kind {
                StateKind::Bound => Mark::Bound,
                StateKind::Misbound => Mark::Misbound,
            }),
    };
    let path = &barrier.pathway;
    let (first, last) = (&path[0], &path[path.len() - 1]);
    let start = at(first.s, first.energy);
    let mut end = at(last.s, last.energy);
    marker(root, mark_of(barrier.from), start, 6.5)?;
    labels.keep_off(start, 8.0);
    let name = |place: Place, energy: f64| {
        format!("{} {}", scene.name_of(place), scale.label(energy, 4))
    };
    let right = nalgebra::Vector2::new(0.8, 0.6);
    labels.place(
        root,
        &name(barrier.from, barrier.from_energy),
        Text::new(SMALL),
        start,
        right,
    )?;
    let mut text = name(barrier.to, barrier.to_energy);
    if end_shown {
        marker(root, mark_of(barrier.to), end, 6.5)?;
        labels.keep_off(end, 8.0);
    } else {
        end.1 = floor - 4.0;
        text = format!("\u{2193} {text}");
    }
    let left = nalgebra::Vector2::new(-0.8, -0.3);
    labels.place(root, &text, Text::new(SMALL), end, left)
}
