//! A film strip of the docking motion.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::canvas::{Box4, Canvas};
use super::composition::{Composition, Panel};
use super::decimals::{Decimals, energy};
use super::key::{POLES, key};
use super::marks::{View, extent};
use super::scale::EnergyScale;
use super::scene::Scene;
use super::style::{Anchor, GRID, LABEL, SMALL, SOFT, minus};
use crate::csv::table;
use physics::landscape::{Pathway, PathwayPoint};
use physics::units::si;

/// Smallest width of a frame (pixels), and the largest number side by side.
const FRAME: f64 = 190.0;
const COLUMNS: usize = 4;
const FRAMES: usize = 8;
const WIDTH: f64 = 1000.0;
const GAP: f64 = 14.0;
/// Height of the text under a frame (pixels).
const CAPTION: f64 = 48.0;

/// The frames of the path into the bond.
pub struct Film {
    frames: Vec<PathwayPoint>,
    /// The visible rectangle (m): both tiles in every frame, with a margin.
    seen: [Vector2<f64>; 2],
}

impl Film {
    /// `None` if no path from far away to the bound state is known.
    pub fn new(scene: &Scene, scale: &EnergyScale) -> Option<Self> {
        let pathway = scene.docking()?;
        let frames = frames(near(&pathway, scene), scale);
        let [low, high] = extent(scene.pair, frames.iter().map(|point| &point.configuration));
        let margin = Vector2::repeat(0.06 * (high - low).max());
        let seen = [low - margin, high + margin];
        Some(Self { frames, seen })
    }

    /// Number of columns, and width and height of a frame, for a picture of this width (pixels).
    fn layout(&self, width: f64) -> (usize, [f64; 2]) {
        let columns = ((width / FRAME) as usize).clamp(2, COLUMNS);
        let size = self.seen[1] - self.seen[0];
        let wide = (width - GAP * (columns as f64 + 1.0)) / columns as f64;
        (
            columns,
            [wide, (wide * size.y / size.x).clamp(0.5 * wide, 1.8 * wide)],
        )
    }

    /// The numbers of the picture.
    pub fn data(&self, decimals: Decimals) -> String {
        let rows = self.frames.iter().enumerate().map(|(k, point)| {
            let mut row = vec![(k + 1).to_string()];
            row.extend(decimals.pose(point.configuration.to_array()));
            row.extend([energy(point.energy), decimals.length(point.clearance)]);
            row
        });
        let head = [
            "frame",
            "x_m",
            "y_m",
            "theta_rad",
            "energy_J",
            "clearance_m",
        ];
        table(head, rows)
    }
}

/// The film strip.
pub fn composed<'a>(scene: &'a Scene, film: &'a Film, scale: &'a EnergyScale) -> Composition<'a> {
    let height = |width: f64| {
        let (columns, [_, high]) = film.layout(width);
        film.frames.len().div_ceil(columns) as f64 * (high + CAPTION + GAP)
    };
    let draw = |canvas: &mut Canvas, [left, top, right, _]: Box4| {
        let (columns, [wide, high]) = film.layout(right - left);
        let touching = scene.problem.scaled(TOUCHING);
        for (k, point) in film.frames.iter().enumerate() {
            let left = left + GAP + (k % columns) as f64 * (wide + GAP);
            let top = top + (k / columns) as f64 * (high + CAPTION + GAP);
            let place = [left, top, left + wide, top + high];
            canvas.frame(place, GRID);
            let view = View::filling(place, film.seen);
            view.tiles(canvas, scene.pair, &point.configuration);
            caption(canvas, scale, place, (k + 1, touching), point);
        }
    };
    Composition {
        name: "docking".to_owned(),
        title: format!("{}: docking", scene.name),
        width: WIDTH,
        panels: vec![Panel::new("docking", 0.0, height, draw)],
        keys: vec![key(POLES)],
        ..Composition::default()
    }
}

/// Tiles not farther apart than this (m, for the paper's tile) are said to touch.
const TOUCHING: f64 = 1e-5;

/// Number, energy and gap below a frame; a gap below `touching` (m) counts as contact.
fn caption(
    canvas: &mut Canvas,
    scale: &EnergyScale,
    [left, _, right, bottom]: Box4,
    (number, touching): (usize, f64),
    point: &PathwayPoint,
) {
    let (middle, soft) = ((left + right) / 2.0, SMALL.colour(SOFT));
    let at = (left + 4.0, bottom + 9.0);
    canvas.write(soft.bold(), &number.to_string(), at, Anchor::TopLeft);
    let energy = format!("U = {}", scale.label(point.energy, 4));
    canvas.write(LABEL.bold(), &energy, (middle, bottom + 8.0), Anchor::Top);
    let gap = if point.clearance.abs() < touching {
        "touching".into()
    } else {
        format!("{} apart", minus(&si(point.clearance, "m", 3)))
    };
    canvas.write(soft, &gap, (middle, bottom + 28.0), Anchor::Top);
}

/// The part of a pathway from the point where the gap is at most the moving tile's size.
fn near<'a>(pathway: &'a Pathway, scene: &Scene) -> &'a [PathwayPoint] {
    let far = 0.8 * scene.pair.moving.outline.circumradius();
    let first = pathway.iter().rposition(|point| point.clearance > far);
    &pathway[first.unwrap_or(0).min(pathway.len() - 2)..]
}

/// Points of a pathway spaced evenly over the sum of its length and its energy (on the pictures'
/// scale), so that frames are dense where the energy changes.
fn frames(pathway: &[PathwayPoint], scale: &EnergyScale) -> Vec<PathwayPoint> {
    let length = (pathway[pathway.len() - 1].s - pathway[0].s).max(f64::MIN_POSITIVE);
    let mut progress = vec![0.0];
    for pair in pathway.windows(2) {
        let along = (pair[1].s - pair[0].s) / length;
        let change = (scale.position(pair[1].energy) - scale.position(pair[0].energy)).abs();
        progress.push(progress[progress.len() - 1] + along + change);
    }
    let total = progress[progress.len() - 1];
    (0..FRAMES)
        .map(|k| {
            let wanted = total * k as f64 / (FRAMES - 1) as f64;
            let nearest = progress
                .iter()
                .enumerate()
                .min_by_key(|(_, done)| OrderedFloat((*done - wanted).abs()))
                .map_or(0, |(index, _)| index);
            pathway[nearest]
        })
        .collect()
}
