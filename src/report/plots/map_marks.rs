//! States, pathways and names on the energy map.

use nalgebra::Vector2;

use super::canvas::{Box4, Canvas, Pixel};
use super::labels::{Labels, label_column};
use super::marks::{Mark, View, marker};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{INK, SMALL};
use physics::configuration::Configuration;
use physics::landscape::{Kind, StateKind};
use physics::order::Order;

/// Number of pathways drawn.
const PATHWAYS: usize = 8;
/// Number of named classes of states.
pub const NAMED: usize = 12;

/// Draws the ways out, and markers of all states, one per position.
pub fn ways_and_states(canvas: &mut Canvas, (view, frame): (View, Box4), scene: &Scene) {
    let ways = || scene.main_escapes().into_iter().take(PATHWAYS);
    for barrier in ways() {
        let points = barrier.pathway.iter();
        let points: Vec<_> = points
            .map(|p| view.pixel(p.configuration.position()))
            .collect();
        for piece in points.split(|p| !inside(frame, *p)) {
            canvas.seamed(piece, INK, 1.8);
        }
    }
    for barrier in ways() {
        let saddle = view.pixel(barrier.saddle.position());
        let last = barrier.pathway.last().map(|p| p.configuration);
        if inside(frame, saddle) && last != Some(barrier.saddle) {
            marker(canvas, Mark::Saddle, saddle, 5.0);
        }
    }
    let mut drawn: Vec<Pixel> = Vec::new();
    // Bound states last, on top.
    let mut states: Vec<_> = scene.states().iter().collect();
    states.order_by_key(|state| state.kind == StateKind::Bond);
    for state in states {
        let at = view.pixel(state.configuration.position());
        let is_same = |p: &Pixel| libm::hypot(p.0 - at.0, p.1 - at.1) < 1.0;
        if inside(frame, at) && !drawn.iter().any(is_same) {
            marker(canvas, state.kind.into(), at, 6.5);
            drawn.push(at);
        }
    }
}

fn inside([left, top, right, bottom]: Box4, (x, y): Pixel) -> bool {
    x >= left && x <= right && y >= top && y <= bottom
}

/// The named kinds of states with their labels, each at its copy nearest to the target.
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

/// Names states beside them on the whole map, except those named in the enlarged view.
pub fn name_around(
    canvas: &mut Canvas,
    scene: &Scene,
    scale: &EnergyScale,
    (view, frame): (View, Box4),
    elsewhere: impl Fn(&Configuration) -> bool,
) {
    let mut labels = Labels::new(frame);
    for state in scene.states() {
        labels.keep_off(view.pixel(state.configuration.position()), 6.5);
    }
    for (q, text) in named_states(scene, scale) {
        let at = view.pixel(q.position());
        if !elsewhere(&q) && inside(frame, at) {
            let outwards = Vector2::new(q.x, -q.y).normalize();
            labels.place(canvas, &text, SMALL, at, outwards);
        }
    }
}

/// Names states in a column beside them.
pub fn name_in_front(
    canvas: &mut Canvas,
    scene: &Scene,
    scale: &EnergyScale,
    (view, frame): (View, Box4),
    here: impl Fn(&Configuration) -> bool,
) {
    let named = named_states(scene, scale).into_iter();
    let column = named.filter(|(q, _)| here(q));
    let column = column.map(|(q, text)| (view.pixel(q.position()), text));
    label_column(canvas, SMALL, frame, column.collect());
}
