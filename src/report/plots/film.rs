//! A film strip of the docking motion.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;
use plotters::style::text_anchor::{HPos, VPos};

use super::heat::{POLE_KEYS, keys};
use super::marks::{Box4, View, outline, tile};
use super::picture::{Area, Picture, PictureError};
use super::scale::{EnergyScale, minus};
use super::scene::Scene;
use super::style::{FIXED_FILL, GRID, LABEL, MOVING_FILL, SMALL, SOFT, Text, title};
use crate::configuration::Configuration;
use crate::landscape::{Pathway, PathwayPoint};
use crate::tile::Tile;
use crate::units::si;

const COLUMNS: usize = 4;
const FRAMES: usize = 8;
const WIDTH: f64 = 1000.0;
const HEAD: f64 = 50.0;
const GAP: f64 = 14.0;
/// Height of the text under a frame (pixels).
const CAPTION: f64 = 48.0;

/// Both tiles on their way together; `None` where no way from far away to the bound state is
/// known.
pub fn draw(scene: &Scene, scale: &EnergyScale) -> Result<Option<Picture>, PictureError> {
    let Some(pathway) = scene.docking() else {
        return Ok(None);
    };
    let frames = frames(near(&pathway, scene), scale);
    let [low, high] = extent(scene, &frames);
    let (span_x, span_y) = (high[0] - low[0], high[1] - low[1]);
    let width = (WIDTH - GAP * (COLUMNS as f64 + 1.0)) / COLUMNS as f64;
    let height = (width * span_y / span_x).clamp(0.5 * width, 1.8 * width);
    let rows = frames.len().div_ceil(COLUMNS);
    let total = HEAD + rows as f64 * (height + CAPTION + GAP);
    let pixels_a_metre = (width / span_x).min(height / span_y);
    Picture::draw((WIDTH as u32, total.ceil() as u32), |root, underlays| {
        title(root, &format!("{}: docking", scene.name))?;
        for (key, left) in POLE_KEYS.chunks(1).zip([740.0, 866.0]) {
            keys(root, underlays, (left, 28.0), key)?;
        }
        for (k, point) in frames.iter().enumerate() {
            let left = GAP + (k % COLUMNS) as f64 * (width + GAP);
            let top = HEAD + (k / COLUMNS) as f64 * (height + CAPTION + GAP);
            let view = View {
                centre: Vector2::new((low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0),
                origin: (left + width / 2.0, top + height / 2.0),
                turn: 0.0,
                scale: pixels_a_metre,
            };
            let frame = [left, top, left + width, top + height];
            draw_frame(root, scene, scale, &view, frame, k + 1, point)?;
        }
        Ok(())
    })
    .map(Some)
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
