//! A design at a glance: both tiles where they bind, and the figures beside them.

use nalgebra::Vector2;

use super::canvas::Canvas;
use super::marks::{ORIGIN, View, extent};
use super::picture::{Picture, PictureError};
use super::sheet::Sheet;
use super::style::{
    Anchor, BLUE, FIXED_FILL, LABEL, MOVING_FILL, SMALL, SOFT, TITLE, VERMILLION, minus,
};
use crate::inspection::{force, pole, wrong};
use jobs::design::Design;
use jobs::inspection::Inspection;
use physics::configuration::Configuration;
use physics::order::Order;
use physics::potential::MagnetModel;
use physics::tile::barcode::Pole;
use physics::tile::{Face, Magnet, Tile};
use physics::units::si;

const SIZE: [f64; 2] = [1000.0, 640.0];
/// Space for the title above and the figures below the tiles (pixels).
const HEAD: f64 = 50.0;
const FOOT: f64 = 190.0;
const MARGIN: f64 = 40.0;
/// Height of a line of text (pixels).
const LINE: f64 = 22.0;
/// What the letters at the magnets are.
const KEY: &str = "letters: the pole that each magnet turns outwards";
/// Most faults that are told on the picture.
const TOLD: usize = 3;

/// Draws a design.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    design: &Design,
    inspection: &Inspection,
    sheet: &Sheet,
) -> Result<Picture, PictureError> {
    let (mut canvas, middle) = (Canvas::new(SIZE), SIZE[0] / 2.0);
    let canvas = &mut canvas;
    canvas.write(
        TITLE.bold(),
        &design.name,
        (middle, HEAD / 2.0),
        Anchor::Middle,
    );
    canvas.write(
        SMALL.colour(SOFT),
        KEY,
        (middle, HEAD + 4.0),
        Anchor::Middle,
    );
    let pair = &*design.pair;
    let place = [
        MARGIN,
        HEAD + MARGIN,
        SIZE[0] - MARGIN,
        SIZE[1] - FOOT - MARGIN,
    ];
    let view = View::filling(place, extent(pair, [&pair.bound]));
    let tiles = [
        (&pair.fixed, ORIGIN, FIXED_FILL, "fixed"),
        (&pair.moving, pair.bound, MOVING_FILL, "moving"),
    ];
    for (tile, q, fill, _) in tiles {
        view.tile(canvas, tile, &q, fill);
    }
    for (tile, q, _, name) in tiles {
        let centre = view.pixel(q.transform(tile.outline.centroid()));
        canvas.write(LABEL.bold().colour(SOFT), name, centre, Anchor::Middle);
        faces(canvas, &view, tile, &q);
    }
    figures(canvas, inspection);
    faults(canvas, design, inspection);
    Picture::new(sheet, &design.name, canvas)
}

/// Names of the faces, inside of their magnets with the letters of their codes.
fn faces(canvas: &mut Canvas, view: &View, tile: &Tile, q: &Configuration) {
    for (number, face) in tile.faces.iter().enumerate() {
        let magnets: Vec<&Magnet> = tile.magnets.iter().filter(|m| m.face == number).collect();
        let letters: Vec<(f64, &Magnet, &str)> = sorted(face, &magnets)
            .map(|(s, magnet)| match pole(tile, magnet) {
                Pole::North => (s, magnet, "N"),
                Pole::South => (s, magnet, "S"),
            })
            .collect();
        let depths = magnets
            .iter()
            .map(|m| (face.middle() - m.position).dot(&face.normal()) + m.size[0]);
        let depth = depths.fold(0.0, f64::max) * view.scale;
        let apart = letters
            .windows(2)
            .map(|two| (two[1].0 - two[0].0) * view.scale);
        let has_room = apart.fold(f64::INFINITY, f64::min) >= SMALL.size;
        let (name, depth) = match letters.is_empty() {
            true => (face.name.clone(), depth + 16.0),
            false if has_room => (face.name.clone(), depth + 30.0),
            false => {
                let code: String = letters.iter().map(|(_, _, letter)| *letter).collect();
                (format!("{}: {code}", face.name), depth + 22.0)
            }
        };
        let inwards = |p: Vector2<f64>, pixels: f64| {
            view.pixel(q.transform(p - face.normal() * (pixels / view.scale)))
        };
        for (_, magnet, letter) in letters.iter().filter(|_| has_room) {
            let colour = if *letter == "N" { VERMILLION } else { BLUE };
            let at = inwards(magnet.position, view.scale * magnet.size[0] / 2.0 + 10.0);
            canvas.write(SMALL.bold().colour(colour), letter, at, Anchor::Middle);
        }
        canvas.note(&name, inwards(face.middle(), depth), Anchor::Middle);
    }
}

/// Magnets of a face with their places along it (m), counter-clockwise.
fn sorted<'a>(face: &Face, magnets: &[&'a Magnet]) -> impl Iterator<Item = (f64, &'a Magnet)> {
    let place = |m: &&'a Magnet| ((m.position - face.middle()).dot(&face.tangent()), *m);
    let mut placed: Vec<_> = magnets.iter().map(place).collect();
    placed.order_by(|a, b| a.0.total_cmp(&b.0));
    placed.into_iter()
}

/// What holds the tiles, a line for each model.
fn figures(canvas: &mut Canvas, inspection: &Inspection) {
    let top = SIZE[1] - FOOT + 10.0;
    let columns = [MARGIN, 200.0, 380.0, 640.0];
    let head = [
        "magnets as",
        "bond",
        "pull at contact",
        "pull-off, straight",
    ];
    let mut rows = vec![(head.map(str::to_owned), SMALL.colour(SOFT))];
    for hold in &inspection.models {
        let name = match hold.model {
            MagnetModel::Dipole => "dipoles",
            MagnetModel::Cuboid => "blocks",
        };
        let row = [
            name.to_owned(),
            minus(&si(hold.energy, "J", 4)),
            minus(&force(hold.contact)),
            minus(&force(hold.pull_off)),
        ];
        rows.push((row, LABEL));
    }
    for (k, (row, text)) in rows.iter().enumerate() {
        for (cell, x) in row.iter().zip(columns) {
            let at = (x, top + LINE * k as f64);
            canvas.write(*text, cell, at, Anchor::TopLeft);
        }
    }
}

/// What is wrong, below the figures, in the order of importance.
fn faults(canvas: &mut Canvas, design: &Design, inspection: &Inspection) {
    const STEP: f64 = 19.0;
    let top = SIZE[1] - FOOT + 10.0 + 4.0 * LINE;
    let faults = wrong(design, inspection);
    if faults.is_empty() {
        let sound = "nothing wrong at a glance; whether the tiles find each other, analyse tells";
        return canvas.write(SMALL.colour(SOFT), sound, (MARGIN, top), Anchor::TopLeft);
    }
    let room = SIZE[0] - 2.0 * MARGIN;
    let lines = faults
        .iter()
        .take(TOLD)
        .flat_map(|fault| SMALL.lines(fault, room));
    let most = ((SIZE[1] - top) / STEP) as usize;
    for (k, line) in lines.take(most).enumerate() {
        let at = (MARGIN, top + STEP * k as f64);
        canvas.write(SMALL.colour(VERMILLION), &line, at, Anchor::TopLeft);
    }
}
