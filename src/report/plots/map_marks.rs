//! States, pathways and names on the energy map.

use nalgebra::Vector2;

use super::labels::{Labels, label_column};
use super::marks::{Box4, Mark, Pixel, View, marker, seamed_line};
use super::picture::{Area, PictureError};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{INK, SMALL, Text};
use physics::configuration::Configuration;
use physics::landscape::{Kind, StateKind};
use physics::order::Order;

/// Pathways drawn.
const PATHWAYS: usize = 8;
/// Classes of states that are named.
pub const NAMED: usize = 12;

/// Ways out and states.
pub fn ways_and_states(
    root: &Area,
    (view, frame): (View, Box4),
    scene: &Scene,
) -> Result<(), PictureError> {
    pathways(root, &view, scene, frame)?;
    states(root, &view, scene, frame)
}

fn pathways(root: &Area, view: &View, scene: &Scene, frame: Box4) -> Result<(), PictureError> {
    for barrier in scene.main_escapes().into_iter().take(PATHWAYS) {
        let points: Vec<_> = barrier
            .pathway
            .iter()
            .map(|p| view.pixel(p.configuration.position()))
            .collect();
        for piece in points.split(|p| !inside(frame, *p)) {
            seamed_line(root, piece, INK, 1.8)?;
        }
    }
    for barrier in scene.main_escapes().into_iter().take(PATHWAYS) {
        let saddle = view.pixel(barrier.saddle.position());
        let last = barrier.pathway.last().map(|p| p.configuration);
        if inside(frame, saddle) && last != Some(barrier.saddle) {
            marker(root, Mark::Saddle, saddle, 5.0)?;
        }
    }
    Ok(())
}

fn inside([left, top, right, bottom]: Box4, (x, y): Pixel) -> bool {
    x >= left && x <= right && y >= top && y <= bottom
}

/// All states as markers, one a place.
fn states(root: &Area, view: &View, scene: &Scene, frame: Box4) -> Result<(), PictureError> {
    let mut drawn: Vec<Pixel> = Vec::new();
    // Bound states last, on top.
    let mut states: Vec<_> = scene.states().iter().collect();
    states.order_by_key(|state| state.kind == StateKind::Bond);
    for state in states {
        let at = view.pixel(state.configuration.position());
        let repeated = drawn
            .iter()
            .any(|p| libm::hypot(p.0 - at.0, p.1 - at.1) < 1.0);
        if inside(frame, at) && !repeated {
            marker(root, state.kind.into(), at, 6.5)?;
            drawn.push(at);
        }
    }
    Ok(())
}

/// The kinds of states that are named, each at its copy nearest to the target, with their labels.
fn named_states(scene: &Scene, scale: &EnergyScale) -> Vec<(Configuration, String)> {
    let label = |kind: &Kind| {
        let state = kind.first();
        let energy = scale.label(state.energy, 3);
        (
            state.configuration,
            format!("{}: {energy}", scene.letters(kind)),
        )
    };
    scene.kinds().iter().take(NAMED).map(label).collect()
}

/// Names states beside them on the whole map, but for those that the enlargement names.
pub fn name_around(
    root: &Area,
    scene: &Scene,
    scale: &EnergyScale,
    (view, frame): (View, Box4),
    elsewhere: impl Fn(&Configuration) -> bool,
) -> Result<(), PictureError> {
    let mut labels = Labels::new(frame);
    for state in scene.states() {
        labels.keep_off(view.pixel(state.configuration.position()), 6.5);
    }
    for (q, text) in named_states(scene, scale) {
        let at = view.pixel(q.position());
        if !elsewhere(&q) && inside(frame, at) {
            let outwards = Vector2::new(q.x, -q.y).normalize();
            labels.place(root, &text, Text::new(SMALL), at, outwards)?;
        }
    }
    Ok(())
}

/// Names states in a column beside them.
pub fn name_in_front(
    root: &Area,
    scene: &Scene,
    scale: &EnergyScale,
    (view, frame): (View, Box4),
    here: impl Fn(&Configuration) -> bool,
) -> Result<(), PictureError> {
    let named = named_states(scene, scale).into_iter();
    let column = named.filter(|(q, _)| here(q));
    let column = column.map(|(q, text)| (view.pixel(q.position()), text));
    label_column(root, Text::new(SMALL), frame, column.collect())
}
