//! A film strip of the docking motion.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;
use plotters::style::text_anchor::{HPos, VPos};

use super::composition::{Composition, Panel};
use super::key::{POLE_KEYS, key_row};
use super::marks::{Box4, View, outline, tile};
use super::picture::{Area, PictureError};
use super::scale::{EnergyScale, minus};
use super::scene::Scene;
use super::style::{FIXED_FILL, GRID, LABEL, MOVING_FILL, SMALL, SOFT, Text};
use super::{energy, length};
use crate::csv::table;
use physics::configuration::Configuration;
use physics::landscape::{Pathway, PathwayPoint};
use physics::tile::Tile;
use physics::units::si;

/// Least width of a frame (pixels), and the most side by side.
const FRAME: f64 = 190.0;
const COLUMNS: usize = 4;
const FRAMES: usize = 8;
const WIDTH: f64 = 1000.0;
const GAP: f64 = 14.0;
/// Height of the text under a frame (pixels).
const CAPTION: f64 = 48.0;

/// The frames of the way into the bond.
pub struct Film {
    frames: Vec<PathwayPoint>,
    /// The rectangle (m) that is seen.
    low: [f64; 2],
    high: [f64; 2],
}

impl Film {
    /// `None` where no way from far away to the bound state is known.
    pub fn new(scene: &Scene, scale: &EnergyScale) -> Option<Self> {
        let pathway = scene.docking()?;
        let frames = frames(near(&pathway, scene), scale);
        let [low, high] = extent(scene, &frames);
        Some(Self { frames, low, high })
    }

    /// Columns, and width and height of a frame, on a picture of this width (pixels).
    fn layout(&self, width: f64) -> (usize, [f64; 2]) {
        let columns = ((width / FRAME) as usize).clamp(2, COLUMNS);
        let [x, y] = [0, 1].map(|k| self.high[k] - self.low[k]);
        let wide = (width - GAP * (columns as f64 + 1.0)) / columns as f64;
        (
            columns,
            [wide, (wide * y / x).clamp(0.5 * wide, 1.8 * wide)],
        )
    }

    /// The numbers of the picture.
    pub fn data(&self) -> String {
        let rows = self.frames.iter().enumerate().map(|(k, point)| {
            let mut row = vec![(k + 1).to_string()];
            row.extend(point.configuration.to_array().map(length));
            row.extend([energy(point.energy), length(point.clearance)]);
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

/// Both tiles on their way together.
pub fn composed<'a>(scene: &'a Scene, film: &'a Film, scale: &'a EnergyScale) -> Composition<'a> {
    let height = |width: f64| {
        let (columns, [_, high]) = film.layout(width);
        film.frames.len().div_ceil(columns) as f64 * (high + CAPTION + GAP)
    };
    let draw = |root: &Area, _: &mut Vec<_>, [left, top, right, _]: Box4| {
        let (columns, [wide, high]) = film.layout(right - left);
        let (low, far) = (film.low, film.high);
        let middle = [0, 1].map(|k| (low[k] + far[k]) / 2.0);
        for (k, point) in film.frames.iter().enumerate() {
            let left = left + GAP + (k % columns) as f64 * (wide + GAP);
            let top = top + (k / columns) as f64 * (high + CAPTION + GAP);
            let view = View {
                centre: Vector2::new(middle[0], middle[1]),
                origin: (left + wide / 2.0, top + high / 2.0),
                turn: 0.0,
                scale: (wide / (far[0] - low[0])).min(high / (far[1] - low[1])),
            };
            let frame = [left, top, left + wide, top + high];
            draw_frame(root, scene, scale, &view, frame, k + 1, point)?;
        }
        Ok(())
    };
    Composition {
        name: "docking".to_owned(),
        title: format!("{}: docking", scene.name),
        note: None,
        width: WIDTH,
        panels: vec![Panel::new("docking", 0.0, height, draw)],
        key: Some(key_row(POLE_KEYS.into())),
    }
}

fn draw_frame(
    root: &Area,
    scene: &Scene,
    scale: &EnergyScale,
    view: &View,
    frame: Box4,
    number: usize,
    point: &PathwayPoint,
) -> Result<(), PictureError> {
    let [left, _, right, bottom] = frame;
    outline(root, frame, GRID)?;
    let origin = Configuration::new(0.0, 0.0, 0.0);
    tile(root, view, &scene.pair.fixed, &origin, FIXED_FILL)?;
    tile(
        root,
        view,
        &scene.pair.moving,
        &point.configuration,
        MOVING_FILL,
    )?;
    Text::new(SMALL).bold().colour(SOFT).write(
        root,
        &number.to_string(),
        (left + 4.0, bottom + 9.0),
        (HPos::Left, VPos::Top),
    )?;
    let middle = (left + right) / 2.0;
    Text::new(LABEL).bold().write(
        root,
        &format!("U = {}", scale.label(point.energy, 4)),
        (middle, bottom + 8.0),
        (HPos::Center, VPos::Top),
    )?;
    let gap = if point.clearance.abs() < 1e-5 {
        "touching".into()
    } else {
        format!("{} apart", minus(&si(point.clearance, "m", 3)))
    };
    Text::new(SMALL).colour(SOFT).write(
        root,
        &gap,
        (middle, bottom + 28.0),
        (HPos::Center, VPos::Top),
    )
}

/// The part of a pathway from where the tiles are no farther apart than the moving one's size.
fn near<'a>(pathway: &'a Pathway, scene: &Scene) -> &'a [PathwayPoint] {
    let far = 0.8 * scene.pair.moving.outline.circumradius();
    let first = pathway.iter().rposition(|point| point.clearance > far);
    &pathway[first.unwrap_or(0).min(pathway.len() - 2)..]
}

/// Points of a pathway spread evenly over its length and its energy (on the pictures' scale)
/// together, so that frames crowd where something happens.
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

/// The rectangle (m) that holds the fixed tile and the moving one in every frame, with a margin.
fn extent(scene: &Scene, frames: &[PathwayPoint]) -> [[f64; 2]; 2] {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    let mut hold = |tile: &Tile, q: &Configuration| {
        for vertex in tile.outline.vertices() {
            let p = q.transform(*vertex);
            for (axis, value) in [p.x, p.y].into_iter().enumerate() {
                low[axis] = low[axis].min(value);
                high[axis] = high[axis].max(value);
            }
        }
    };
    hold(&scene.pair.fixed, &Configuration::new(0.0, 0.0, 0.0));
    for point in frames {
        hold(&scene.pair.moving, &point.configuration);
    }
    let margin = 0.06 * (high[0] - low[0]).max(high[1] - low[1]);
    [low.map(|v| v - margin), high.map(|v| v + margin)]
}
