//! A picture of a design: both tiles where they bind, and the figures beside them.

use nalgebra::Vector2;

use super::canvas::{Box4, Canvas};
use super::marks::{ORIGIN, View, extent};
use super::picture::{Picture, PictureError};
use super::style::{
    Anchor, BLUE, FIXED_FILL, LABEL, MOVING_FILL, SMALL, SOFT, TITLE, VERMILLION, minus,
};
use super::{Figure, Sheet};
use crate::tiles::{energy, letter, magnets, models, pull, without_wall, wrong};
use jobs::design::Design;
use jobs::inspection::Inspection;
use jobs::workshop::{Kind, Subject};
use physics::configuration::Configuration;
use physics::tile::{Magnet, Tile, outline};

const SIZE: [f64; 2] = [1000.0, 640.0];
/// Space for the title above and the figures below the tiles (pixels).
const HEAD: f64 = 50.0;
const FOOT: f64 = 190.0;
const MARGIN: f64 = 40.0;
/// Space around the tiles where they stand alone (pixels).
const EDGE: f64 = 12.0;
/// Height of a line of text (pixels).
const LINE: f64 = 22.0;
/// The explanation of the letters at the magnets.
const KEY: &str = "letters: outward pole of each magnet; U, D: north pole up, down";
/// Largest number of faults shown on the picture.
const TOLD: usize = 3;

/// Draws a design; for print and for narrow screens only the tiles.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    design: &Design,
    inspection: &Inspection,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let width = sheet.width(SIZE[0]);
    let canvas = match sheet.is_titled() && width >= SIZE[0] {
        true => whole(design, inspection),
        false => {
            let [low, high] = extent(&design.pair, [&design.pair.bound]);
            let flatness = ((high.y - low.y) / (high.x - low.x)).min(1.0);
            let size = [width, (width - 2.0 * EDGE) * flatness + 2.0 * EDGE].map(f64::ceil);
            let mut canvas = Canvas::new(size);
            tiles(
                &mut canvas,
                design,
                [EDGE, EDGE, size[0] - EDGE, size[1] - EDGE],
            );
            canvas
        }
    };
    let picture = Picture::new(sheet, &design.name, &canvas)?;
    Ok(Figure {
        name: "tiles".to_owned(),
        pictures: vec![("tiles".to_owned(), picture)],
        data: models(design, inspection).csv(),
    })
}

/// Draws kinds of tiles beside each other, with their names.
///
/// # Errors
/// See [`PictureError`].
pub fn kinds(subject: &Subject, sheet: &Sheet) -> Result<Figure, PictureError> {
    let (title, kinds) = (&*subject.name, &subject.kinds);
    let columns = (kinds.len() as f64).sqrt().ceil().max(1.0);
    let rows = (kinds.len() as f64 / columns).ceil();
    let width = sheet.width(SIZE[0]);
    let side = width / columns;
    let head = if sheet.is_titled() { HEAD } else { 0.0 };
    let mut canvas = Canvas::new([width, head + side * rows]);
    if sheet.is_titled() {
        let at = (width / 2.0, HEAD / 2.0);
        canvas.write(TITLE.bold(), title, at, Anchor::Middle);
    }
    let widest = kinds.iter().map(|kind| spread(&kind.tile));
    let widest = widest.fold([0.0, 0.0], |a, [low, high]| {
        let size = high - low;
        [f64::max(a[0], size.x), f64::max(a[1], size.y)]
    });
    for (k, Kind { name, tile, .. }) in kinds.iter().enumerate() {
        let (column, row) = (k as f64 % columns, (k as f64 / columns).floor());
        let (left, top) = (column * side + EDGE, head + row * side + EDGE);
        let room = [left, top, left + side - 2.0 * EDGE, top + side - 2.0 * EDGE];
        // All to one scale.
        let [low, high] = spread(tile);
        let half = Vector2::from(widest) / 2.0;
        let middle = (low + high) / 2.0;
        let view = View::filling(room, [middle - half, middle + half]);
        view.tile(&mut canvas, tile, &ORIGIN, FIXED_FILL);
        let centre = view.pixel(tile.outline.centroid());
        canvas.write(LABEL.bold().colour(SOFT), name, centre, Anchor::Middle);
        faces(&mut canvas, &view, tile, &ORIGIN);
    }
    let rows = kinds
        .iter()
        .map(|kind| format!("{},{}\n", kind.name, kind.tile.magnets.len()));
    let data = ["tile,magnets\n".to_owned()]
        .into_iter()
        .chain(rows)
        .collect();
    Ok(Figure {
        name: "tiles".to_owned(),
        pictures: vec![("tiles".to_owned(), Picture::new(sheet, title, &canvas)?)],
        data,
    })
}

/// The corners of the smallest rectangle that contains a tile (m).
fn spread(tile: &Tile) -> [Vector2<f64>; 2] {
    outline::extent(tile.outline.vertices().iter().copied())
}

/// The tiles with the figures below them.
fn whole(design: &Design, inspection: &Inspection) -> Canvas {
    let (mut canvas, middle) = (Canvas::new(SIZE), SIZE[0] / 2.0);
    for (text, line, height) in [
        (TITLE.bold(), &*design.name, HEAD / 2.0),
        (SMALL.colour(SOFT), KEY, HEAD + 4.0),
    ] {
        canvas.write(text, line, (middle, height), Anchor::Middle);
    }
    let (right, bottom) = (SIZE[0] - MARGIN, SIZE[1] - FOOT - MARGIN);
    tiles(&mut canvas, design, [MARGIN, HEAD + MARGIN, right, bottom]);
    figures(&mut canvas, design, inspection);
    faults(&mut canvas, design, inspection);
    canvas
}

/// Both tiles where they bind, in a rectangle.
fn tiles(canvas: &mut Canvas, design: &Design, room: Box4) {
    let pair = &*design.pair;
    let view = View::filling(room, extent(pair, [&pair.bound]));
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
}

/// The names of the faces, inside their magnets with the letters of their codes.
fn faces(canvas: &mut Canvas, view: &View, tile: &Tile, q: &Configuration) {
    for (number, face) in tile.faces.iter().enumerate() {
        let letters: Vec<(f64, &Magnet, char)> = magnets(tile, number)
            .into_iter()
            .map(|(s, magnet)| (s, magnet, letter(tile, magnet)))
            .collect();
        let depths = letters
            .iter()
            .map(|(_, m, _)| (face.middle() - m.position).dot(&face.normal()) + m.size[0]);
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
            let colour = if "NU".contains(*letter) {
                VERMILLION
            } else {
                BLUE
            };
            let at = inwards(magnet.position, view.scale * magnet.size[0] / 2.0 + 10.0);
            let text = SMALL.bold().colour(colour);
            canvas.write(text, &letter.to_string(), at, Anchor::Middle);
        }
        canvas.note(&name, inwards(face.middle(), depth), Anchor::Middle);
    }
}

/// The forces that hold the tiles, one line for each model.
fn figures(canvas: &mut Canvas, design: &Design, inspection: &Inspection) {
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
        let row = [
            hold.model.plural(&design.pair).to_owned(),
            minus(&energy(inspection, hold.energy)),
            minus(&pull(inspection, hold.contact)),
            minus(&pull(inspection, hold.pull_off)),
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

/// Faults, below the figures, in the order of importance.
fn faults(canvas: &mut Canvas, design: &Design, inspection: &Inspection) {
    const STEP: f64 = 19.0;
    let top = SIZE[1] - FOOT + 10.0 + 4.0 * LINE;
    let faults = wrong(design, inspection);
    let sound = "no mistakes found; run analyse to see whether the tiles dock";
    let (told, colour) = match faults.is_empty() {
        true => (
            [sound.to_owned()]
                .into_iter()
                .chain(without_wall(design))
                .collect(),
            SOFT,
        ),
        false => (faults, VERMILLION),
    };
    let room = SIZE[0] - 2.0 * MARGIN;
    let lines = told
        .iter()
        .take(TOLD)
        .flat_map(|line| SMALL.lines(&line.replace('`', ""), room));
    let most = ((SIZE[1] - top) / STEP) as usize;
    for (k, line) in lines.take(most).enumerate() {
        let at = (MARGIN, top + STEP * k as f64);
        canvas.write(SMALL.colour(colour), &line, at, Anchor::TopLeft);
    }
}
