//! The inspection of a design, as a document.

use nalgebra::Vector2;
use serde_json::{Value, json};

use crate::braille::Braille;
use crate::document::{Document, Drawing, Entries, Table, entries, rows};
use crate::files::{PAGE, REPORT};
use crate::plots::{field, glance};
use crate::sold;
use crate::tiles::{
    GRAM, fits, force, letter, magnets, models, pull, pull_off, weights, without_wall, wrong,
};
use crate::values::{pose, positive_zero};
use jobs::design::Design;
use jobs::inspection::{Inspection, NEGLIGIBLE};
use jobs::output::Command;
use physics::configuration::Configuration;
use physics::potential::MagnetModel;
use physics::tile::Tile;
use physics::tile::profile::SHALLOWEST;
use physics::units::{share_to, si};

/// The files of the command.
pub const FILES: Command = Command {
    name: "show",
    files: &[REPORT, PAGE, "models.csv", "fits.csv", "faces.csv"],
    pictures: &["tiles", "field"],
};

/// Significant digits of energies and forces.
const DIGITS: usize = 4;

/// The headline: whether the tiles bind, and how strongly.
fn answer(design: &Design, inspection: &Inspection) -> String {
    let bond = &inspection.models[0];
    let faces = names(design, design.pair.target).join(" and ");
    let bodies = design.pair.bodies();
    let magnets = match inspection.models[1] {
        real if bond.model == MagnetModel::Dipole => format!(
            "(magnets as point dipoles; as {bodies} {})",
            si(real.energy, "J", DIGITS)
        ),
        _ => format!("(magnets as {bodies})"),
    };
    match bond.energy < 0.0 {
        true if inspection.is_negligible() => format!(
            "{}: faces {faces} do not bind: their magnets cancel to less than {} of what they \
             reach while the tiles slide",
            design.name,
            share_to(NEGLIGIBLE, 1)
        ),
        true => format!(
            "{}: faces {faces} bind with {} {magnets}; pulling straight apart takes {}",
            design.name,
            si(bond.energy, "J", DIGITS),
            force(bond.pull_off)
        ),
        false => format!("{}: faces {faces} do not bind", design.name),
    }
}

/// The document of an inspection.
pub fn document<'a>(design: &'a Design, found: &'a Inspection) -> Document<'a> {
    let faults = wrong(design, found).into_iter();
    Document {
        title: format!("{} at a glance", design.name),
        answer: answer(design, found),
        remarks: faults.map(|fault| format!("! {fault}")).collect(),
        sketch: Some(sketch(design)),
        entries: found_entries(design, found),
        pictures: vec![
            Drawing::new("Both tiles in the bound pose", move |sheet| {
                glance::draw(design, found, sheet)
            }),
            Drawing::new("Magnetic field of the fixed tile", |sheet| {
                field::draw(design, sheet)
            }),
        ],
        origin: "the tiles with their target faces in contact; nothing is searched".to_owned(),
        notes: design
            .sold
            .iter()
            .map(sold::describe)
            .chain(without_wall(design))
            .chain(weights(design))
            .collect(),
        ..Document::default()
    }
}

// One line an entry.
#[rustfmt::skip]
fn found_entries(design: &Design, found: &Inspection) -> Entries {
    let (bond, pair) = (&found.models[0], &design.pair);
    let fixed = faces("fixed", &pair.fixed);
    let moving = faces("moving", &pair.moving);
    let told = [&fixed[..], &moving].concat().into_iter().filter(Face::is_worth_telling);
    let sold = design.sold.iter().map(sold::entry);
    let shown = entries(design)
        .data("bound", json!({ "pose": pose(&found.bound), "energy_J": positive_zero(bond.energy) }))
        .fact("pull_contact_N", "pull at contact", bond.contact).viewed(pull(found, bond.contact))
        .data("pull_contact_g", bond.contact / GRAM)
        .fact("pull_off_N", "straight apart", bond.pull_off).viewed(pull_off(found, bond)).noted("largest \
            force on a straight path")
        .data("pull_off_g", bond.pull_off / GRAM)
        .table(models(design, found))
        .table(fits(found))
        .fact("comes_straight_out", "not blocked on a straight path", found.comes_straight_out)
        .table(rivals(design, found))
        .table(table("fixed", fixed).in_data().in_file("faces"))
        .table(table("moving", moving).in_data().in_file("faces"))
        .table(table("", told.collect()).in_view())
        .data("wrong", wrong(design, found));
    match design.sold.is_empty() {
        true => shown,
        false => shown.data("magnets", sold.collect::<Value>()),
    }
}

/// Pairs of faces that bind as strongly as the target.
// One line a column.
#[rustfmt::skip]
fn rivals(design: &Design, found: &Inspection) -> Table {
    rows(&found.rivals)
        .column("faces", "faces", "of the fixed tile, of the moving tile", |it| json!(names(design, it.faces))).without_csv()
            .viewed(|it| names(design, it.faces).join(" and "))
        .column("pose", "x, y (mm), angle", "of the moving tile", |it| it.configuration)
        .column("energy_J", "energy", "with target faces in contact", |it| it.energy).digits(DIGITS)
        .table("rivals")
        .titled("Other faces that bind as strongly", "")
        .on_page()
}

/// Names of a face of the fixed tile and of one of the moving tile.
fn names(design: &Design, (fixed, moving): (usize, usize)) -> [&str; 2] {
    let pair = &design.pair;
    [
        &pair.fixed.faces[fixed].name,
        &pair.moving.faces[moving].name,
    ]
}

/// Both tiles bound, as characters.
fn sketch(design: &Design) -> Braille {
    let poses = [Configuration::new(0.0, 0.0, 0.0), design.pair.bound];
    let mut sketch = Braille::default();
    for (tile, q) in [&design.pair.fixed, &design.pair.moving]
        .into_iter()
        .zip(poses)
    {
        let rim = tile.outline.vertices().iter().map(|v| q.transform(*v));
        sketch.polygon(&rim.collect::<Vec<_>>());
        for magnet in &tile.magnets {
            let inwards = tile.faces[magnet.face].normal() * -magnet.size[0];
            sketch.letter(q.transform(magnet.position + inwards), letter(tile, magnet));
        }
    }
    sketch
}

/// The contents of one face.
#[derive(Clone)]
struct Face {
    tile: &'static str,
    name: String,
    length: f64,
    /// Poles outwards, counter-clockwise.
    code: String,
    magnets: Vec<f64>,
    /// The extent of its line inwards and outwards from the base line (m).
    heights: [f64; 2],
}

impl Face {
    fn is_straight(&self) -> bool {
        self.heights[1] - self.heights[0] <= SHALLOWEST * self.length
    }

    fn is_worth_telling(&self) -> bool {
        !self.code.is_empty() || !self.is_straight()
    }

    fn describe_magnets(&self) -> String {
        // To a micrometre, and a hundred-thousandth of the face, finer than any drill.
        let places = in_mm(&self.magnets, 0, f64::min(0.5e-6, 1e-5 * self.length));
        match self.magnets.is_empty() {
            true => "none".to_owned(),
            false => format!("{} at {} mm", self.code, places.join(", ")),
        }
    }

    fn describe_shape(&self) -> String {
        let [low, high] = self.heights;
        let told = in_mm(&self.heights, 1, 1e-2 * (high - low));
        match self.is_straight() {
            true => "straight".to_owned(),
            false => format!("from {} to {} mm", told[0], told[1]),
        }
    }
}

fn faces(name: &'static str, tile: &Tile) -> Vec<Face> {
    let face = |number: usize| {
        let magnets = magnets(tile, number);
        Face {
            tile: name,
            name: tile.faces[number].name.clone(),
            length: tile.faces[number].length(),
            code: magnets
                .iter()
                .map(|(_, magnet)| letter(tile, magnet))
                .collect(),
            magnets: magnets.into_iter().map(|(s, _)| s).collect(),
            heights: heights(tile, number),
        }
    };
    (0..tile.faces.len()).map(face).collect()
}

// One line a column.
#[rustfmt::skip]
fn table(key: &'static str, faces: Vec<Face>) -> Table {
    rows(faces)
        .data("tile", |it| it.tile).in_csv()
        .column("name", "face", "of which tile", |it| it.name.clone()).viewed(|it| format!("{} {}", it.tile, it.name))
        .column("length_m", "length", "of its base line", |it| it.length)
        .data("code", |it| it.code.clone())
        .column("magnets_m", "magnets", "outward poles and their positions, counter-clockwise", |it| json!(it.magnets)).without_csv().viewed(Face::describe_magnets)
        .column("heights_m", "shape", "distance of the line from the base line", |it| json!(it.heights)).without_csv().viewed(Face::describe_shape)
        .data("height_bounds_m", |it| it.heights).in_csv()
        .table(key)
}

/// Lengths (m) in mm, all with the same number of decimals, at least `least`, enough to be within
/// `error` (m) of each.
fn in_mm(lengths: &[f64], least: usize, error: f64) -> Vec<String> {
    const MOST: usize = 6;
    let written = |decimals: usize| -> Vec<String> {
        let text = |length: &f64| format!("{:.decimals$}", 1e3 * length);
        let zero = format!("-{:.decimals$}", 0.0);
        let plain = |text: String| {
            if text == zero {
                text[1..].to_owned()
            } else {
                text
            }
        };
        lengths.iter().map(|length| plain(text(length))).collect()
    };
    let close = |texts: &Vec<String>| {
        let mut pairs = texts.iter().zip(lengths);
        pairs.all(|(text, length)| {
            let told: f64 = text.parse().unwrap_or(f64::NAN);
            (told / 1e3 - length).abs() <= error
        })
    };
    let found = (least..MOST).map(written).find(close);
    found.unwrap_or_else(|| written(MOST))
}

/// The smallest and the largest height (m) of a tile's outline over one of its faces. A corner
/// belongs to the face with the nearest base line.
fn heights(tile: &Tile, number: usize) -> [f64; 2] {
    let height = |v: &Vector2<f64>, face: usize| {
        let face = &tile.faces[face];
        (v - face.middle()).dot(&face.normal())
    };
    let nearest = |v: &Vector2<f64>| {
        let distance = |face: &usize| height(v, *face).abs();
        (0..tile.faces.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let rim = tile.outline.vertices().iter();
    let own = rim.filter(|v| nearest(v) == Some(number));
    own.fold([0.0; 2], |[low, high], v| {
        let h = height(v, number);
        [f64::min(low, h), f64::max(high, h)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_digits_that_they_need() {
        let describe = |lengths: &[f64], error: f64| in_mm(lengths, 0, error).join(", ");
        assert_eq!(
            describe(&[-0.06, -0.02, 0.02, 0.06], 4e-6),
            "-60, -20, 20, 60"
        );
        let small = [-0.003, -0.0018, -0.0006, 0.0006, 0.0018, 0.003];
        assert_eq!(describe(&small, 1e-7), "-3.0, -1.8, -0.6, 0.6, 1.8, 3.0");
        assert_eq!(describe(&[0.0127 / 3.0, -1e-12], 1e-6), "4.233, 0.000");
        assert_eq!(describe(&[], 1e-6), "");
        assert_eq!(in_mm(&[0.0, 0.0123], 1, 1e-4), ["0.0", "12.3"]);
        assert_eq!(in_mm(&[0.0, 0.000_05], 1, 5e-7), ["0.00", "0.05"]);
    }
}
