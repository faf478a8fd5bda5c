//! A design at a glance: both tiles where they bind, and the figures beside them.

use nalgebra::Vector2;
use plotters::style::text_anchor::{HPos, VPos};

use super::marks::{Box4, View, tile};
use super::picture::{Area, Picture, PictureError};
use super::scale::minus;
use super::style::{
    BLUE, FIXED_FILL, INK, LABEL, MOVING_FILL, SMALL, SOFT, TITLE, Text, VERMILLION,
};
use super::{Figure, Sheet};
use crate::tiles::{force, letter, magnets, model, models, wrong};
use jobs::design::Design;
use jobs::inspection::Inspection;
use physics::configuration::Configuration;
use physics::tile::{Magnet, Tile};
use physics::units::si;

const SIZE: (u32, u32) = (1000, 640);
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

/// Draws a design; for print the tiles alone.
///
/// # Errors
/// See [`PictureError`].
pub fn draw(
    design: &Design,
    inspection: &Inspection,
    sheet: &Sheet,
) -> Result<Figure, PictureError> {
    let picture = match sheet.is_titled() {
        true => whole(design, inspection, sheet)?,
        false => {
            let (width, room) = (
                sheet.width(f64::from(SIZE.0)),
                f64::from(SIZE.1) - HEAD - FOOT,
            );
            let size = [width, room * width / f64::from(SIZE.0)];
            let pixels = size.map(|side| side.ceil() as u32);
            Picture::draw(sheet, &design.name, pixels.into(), |root, _| {
                tiles(root, design, [0.0, 0.0, size[0], size[1]])
            })?
        }
    };
    Ok(Figure {
        name: "tiles".to_owned(),
        pictures: vec![("tiles".to_owned(), picture)],
        data: models(&inspection.models).csv(),
    })
}

/// The tiles with the figures below them.
fn whole(design: &Design, inspection: &Inspection, sheet: &Sheet) -> Result<Picture, PictureError> {
    Picture::draw(sheet, &design.name, SIZE, |root, _| {
        let middle = (HPos::Center, VPos::Center);
        let place = (f64::from(SIZE.0) / 2.0, HEAD / 2.0);
        Text::new(TITLE)
            .bold()
            .write(root, &design.name, place, middle)?;
        let place = (place.0, HEAD + 4.0);
        Text::new(SMALL)
            .colour(SOFT)
            .write(root, KEY, place, middle)?;
        let (width, height) = (f64::from(SIZE.0), f64::from(SIZE.1));
        tiles(root, design, [0.0, HEAD, width, height - FOOT])?;
        figures(root, inspection)?;
        faults(root, design, inspection)
    })
}

/// Both tiles where they bind, in a rectangle.
fn tiles(root: &Area, design: &Design, place: Box4) -> Result<(), PictureError> {
    let middle = (HPos::Center, VPos::Center);
    let poses = [Configuration::new(0.0, 0.0, 0.0), design.pair.bound];
    let tiles = [&design.pair.fixed, &design.pair.moving];
    let view = view(tiles, poses, place);
    for ((one, q), fill) in tiles.into_iter().zip(poses).zip([FIXED_FILL, MOVING_FILL]) {
        tile(root, &view, one, &q, fill)?;
    }
    for ((one, q), name) in tiles.into_iter().zip(poses).zip(["fixed", "moving"]) {
        let centre = view.pixel(q.transform(one.outline.centroid()));
        Text::new(LABEL)
            .bold()
            .colour(SOFT)
            .write(root, name, centre, middle)?;
        faces(root, &view, one, &q)?;
    }
    Ok(())
}

/// How the two tiles fill a rectangle.
fn view(tiles: [&Tile; 2], poses: [Configuration; 2], [left, top, right, bottom]: Box4) -> View {
    let corners = tiles
        .into_iter()
        .zip(poses)
        .flat_map(|(tile, q)| tile.outline.vertices().iter().map(move |v| q.transform(*v)));
    let infinity = Vector2::repeat(f64::INFINITY);
    let (low, high) = corners.fold((infinity, -infinity), |(low, high), p| {
        (low.inf(&p), high.sup(&p))
    });
    let size = high - low;
    let room = [right - left - 2.0 * MARGIN, bottom - top - 2.0 * MARGIN];
    View {
        centre: (low + high) / 2.0,
        origin: ((left + right) / 2.0, (top + bottom) / 2.0),
        turn: 0.0,
        scale: (room[0] / size.x).min(room[1] / size.y),
    }
}

/// Names of the faces, inside of their magnets with the letters of their codes.
fn faces(root: &Area, view: &View, tile: &Tile, q: &Configuration) -> Result<(), PictureError> {
    let middle = (HPos::Center, VPos::Center);
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
        let has_room = apart.fold(f64::INFINITY, f64::min) >= SMALL;
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
            let colour = if *letter == 'N' { VERMILLION } else { BLUE };
            let at = inwards(magnet.position, view.scale * magnet.size[0] / 2.0 + 10.0);
            Text::new(SMALL)
                .bold()
                .colour(colour)
                .write(root, &letter.to_string(), at, middle)?;
        }
        let text = Text::new(SMALL).colour(INK);
        text.write(root, &name, inwards(face.middle(), depth), middle)?;
    }
    Ok(())
}

/// What holds the tiles, a line for each model.
fn figures(root: &Area, inspection: &Inspection) -> Result<(), PictureError> {
    let top = f64::from(SIZE.1) - FOOT + 10.0;
    let columns = [MARGIN, 200.0, 380.0, 640.0];
    let head = [
        "magnets as",
        "bond",
        "pull at contact",
        "pull-off, straight",
    ];
    let mut rows = vec![(head.map(str::to_owned), Text::new(SMALL).colour(SOFT))];
    for hold in &inspection.models {
        let row = [
            model(hold.model).to_owned(),
            minus(&si(hold.energy, "J", 4)),
            minus(&force(hold.contact)),
            minus(&force(hold.pull_off)),
        ];
        rows.push((row, Text::new(LABEL)));
    }
    for (k, (row, text)) in rows.iter().enumerate() {
        for (cell, x) in row.iter().zip(columns) {
            let at = (x, top + LINE * k as f64);
            text.write(root, cell, at, (HPos::Left, VPos::Top))?;
        }
    }
    Ok(())
}

/// What is wrong, below the figures, in the order of importance.
fn faults(root: &Area, design: &Design, inspection: &Inspection) -> Result<(), PictureError> {
    let top = f64::from(SIZE.1) - FOOT + 10.0 + 4.0 * LINE;
    let faults = wrong(design, inspection);
    if faults.is_empty() {
        let text = Text::new(SMALL).colour(SOFT);
        let sound = "nothing wrong at a glance; whether the tiles find each other, analyse tells";
        return text.write(root, sound, (MARGIN, top), (HPos::Left, VPos::Top));
    }
    let text = Text::new(SMALL).colour(VERMILLION);
    let room = f64::from(SIZE.0) - 2.0 * MARGIN;
    let lines = faults
        .iter()
        .take(TOLD)
        .flat_map(|fault| wrapped(&text, fault, room));
    let most = ((f64::from(SIZE.1) - top) / (TITLE - 1.0)) as usize;
    for (k, line) in lines.take(most).enumerate() {
        let at = (MARGIN, top + (TITLE - 1.0) * k as f64);
        text.write(root, &line, at, (HPos::Left, VPos::Top))?;
    }
    Ok(())
}

/// A sentence in lines that fit into so many pixels.
fn wrapped(text: &Text, sentence: &str, room: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in sentence.split_whitespace() {
        let longer = match lines.last().map_or("", String::as_str) {
            "" => word.to_owned(),
            line => format!("{line} {word}"),
        };
        if text.width(&longer) <= room || lines.last().is_some_and(String::is_empty) {
            lines.pop();
            lines.push(longer);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}
