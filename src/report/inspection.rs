//! A design at a glance, for the terminal and for scripts.

use std::fmt::Write;

use nalgebra::Vector2;
use serde_json::{Value, json};

use super::braille::Braille;
use super::terminal::write_table;
use super::values::{pose, positive_zero};
use jobs::design::Design;
use jobs::inspection::{Hold, Inspection};
use physics::configuration::Configuration;
use physics::order::Order;
use physics::potential::MagnetModel;
use physics::tile::barcode::Pole;
use physics::tile::{Magnet, Tile};
use physics::units::si;

/// Weight of a gram (N).
pub const GRAM: f64 = 9.806_65e-3;
/// Significant digits of energies and forces.
const DIGITS: usize = 4;

/// What is wrong with a design, its reader's doubts first; empty where nothing is.
pub fn wrong(design: &Design, inspection: &Inspection) -> Vec<String> {
    let doubts = design.warnings.iter();
    let doubts = doubts.map(|doubt| format!("{}; {}", doubt.message, doubt.help));
    doubts.chain(inspection.faults(design)).collect()
}

/// The sentence that answers: whether the tiles bind, and how strongly.
pub fn headline(design: &Design, inspection: &Inspection) -> String {
    let bond = &inspection.models[0];
    let faces = {
        let (fixed, moving) = design.pair.target;
        let name = |tile: &Tile, face: usize| tile.faces[face].name.clone();
        let (fixed, moving) = (
            name(&design.pair.fixed, fixed),
            name(&design.pair.moving, moving),
        );
        format!("{fixed} and {moving}")
    };
    match bond.energy < 0.0 {
        true => format!(
            "{}: faces {faces} bind with {}; straight apart takes {}",
            design.name,
            si(bond.energy, "J", DIGITS),
            force(bond.pull_off)
        ),
        false => format!("{}: faces {faces} do not bind", design.name),
    }
}

/// A force in newtons and grams.
pub fn force(newtons: f64) -> String {
    let grams = newtons / GRAM;
    let decimals = match grams.abs() {
        100.0.. => 0,
        1.0.. => 1,
        _ => 3,
    };
    format!("{} ({grams:.decimals$} g)", si(newtons, "N", 3))
}

/// What is shown on a terminal: the tiles drawn, the bond, the faces, what is wrong.
pub fn text(design: &Design, inspection: &Inspection, columns: usize) -> String {
    let mut text = format!("{}\n", headline(design, inspection));
    for fault in wrong(design, inspection) {
        let _ = writeln!(text, "! {fault}");
    }
    text.push_str(&drawing(design, columns));
    let mut rows = vec![["magnets as", "energy", "pull at contact", "pull-off"].map(str::to_owned)];
    rows.extend(inspection.models.iter().map(row));
    write_table(&mut text, &rows);
    text.push('\n');
    let mut rows = vec![["face", "length", "magnets", "shape"].map(str::to_owned)];
    for (name, tile) in tiles(design) {
        rows.extend((0..tile.faces.len()).filter_map(|face| {
            let entry = Face::new(tile, face);
            entry.row(&format!("{name} {}", tile.faces[face].name))
        }));
    }
    write_table(&mut text, &rows);
    text
}

fn row(hold: &Hold) -> [String; 4] {
    [
        model(hold.model).to_owned(),
        si(hold.energy, "J", DIGITS),
        force(hold.contact),
        match hold.pull_off_gap {
            0.0 => force(hold.pull_off),
            gap => format!("{} at {}", force(hold.pull_off), si(gap, "m", 2)),
        },
    ]
}

fn model(model: MagnetModel) -> &'static str {
    match model {
        MagnetModel::Dipole => "dipoles",
        MagnetModel::Cuboid => "blocks",
    }
}

fn tiles(design: &Design) -> [(&'static str, &Tile); 2] {
    [
        ("fixed", &design.pair.fixed),
        ("moving", &design.pair.moving),
    ]
}

/// Both tiles bound, as characters.
fn drawing(design: &Design, columns: usize) -> String {
    let poses = [Configuration::new(0.0, 0.0, 0.0), design.pair.bound];
    let mut drawing = Braille::new();
    for ((_, tile), q) in tiles(design).into_iter().zip(poses) {
        let rim: Vec<_> = tile
            .outline
            .vertices()
            .iter()
            .map(|v| q.transform(*v))
            .collect();
        drawing.polygon(&rim);
        for magnet in &tile.magnets {
            let letter = match pole(tile, magnet) {
                Pole::North => 'N',
                Pole::South => 'S',
            };
            let inwards = tile.faces[magnet.face].normal() * -magnet.size[0];
            drawing.letter(q.transform(magnet.position + inwards), letter);
        }
    }
    drawing.text(columns.clamp(20, 72))
}

/// Which pole a magnet turns outwards.
pub fn pole(tile: &Tile, magnet: &Magnet) -> Pole {
    match magnet
        .moment_vector()
        .dot(&tile.faces[magnet.face].normal())
        >= 0.0
    {
        true => Pole::North,
        false => Pole::South,
    }
}

/// What one face carries.
struct Face {
    length: f64,
    /// Poles outwards, counter-clockwise.
    code: String,
    magnets: Vec<f64>,
    /// How far its line reaches inwards and outwards of the base line (m).
    heights: [f64; 2],
}

impl Face {
    fn new(tile: &Tile, number: usize) -> Self {
        let face = &tile.faces[number];
        let mut magnets: Vec<(f64, char)> = tile
            .magnets
            .iter()
            .filter(|magnet| magnet.face == number)
            .map(|magnet| {
                let s = (magnet.position - face.middle()).dot(&face.tangent());
                let letter = match pole(tile, magnet) {
                    Pole::North => 'N',
                    Pole::South => 'S',
                };
                (s, letter)
            })
            .collect();
        magnets.order_by(|a, b| a.0.total_cmp(&b.0));
        Self {
            length: face.length(),
            code: magnets.iter().map(|(_, letter)| letter).collect(),
            magnets: magnets.into_iter().map(|(s, _)| s).collect(),
            heights: heights(tile, number),
        }
    }

    /// A row of the table; none for a bare, straight face.
    fn row(&self, name: &str) -> Option<[String; 4]> {
        let [low, high] = self.heights;
        let straight = high - low < 1e-6;
        if self.code.is_empty() && straight {
            return None;
        }
        // What a hundred-thousandth of the face is, a drill does not tell from the place.
        let places = in_mm(&self.magnets, 0, 1e-5 * self.length);
        Some([
            name.to_owned(),
            si(self.length, "m", 3),
            match places.is_empty() {
                true => "none".to_owned(),
                false => format!("{} at {} mm", self.code, places.join(", ")),
            },
            match straight {
                true => "straight".to_owned(),
                false => {
                    let heights = in_mm(&self.heights, 1, 1e-2 * (high - low));
                    format!("from {} to {} mm", heights[0], heights[1])
                }
            },
        ])
    }
}

/// Lengths (m) in mm, all with as many decimals, `least` or more, as it takes to come within `error`
/// (m) of each.
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

/// The least and the greatest height (m) of a tile's rim over one of its faces. A corner of the rim
/// belongs to the face whose base line it is nearest to.
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

/// The inspection as JSON.
pub fn json(design: &Design, inspection: &Inspection) -> Value {
    let bond = &inspection.models[0];
    let models: Vec<Value> = inspection.models.iter().map(hold).collect();
    let name = |tile: &Tile, face: usize| tile.faces[face].name.clone();
    let (fixed, moving) = (&design.pair.fixed, &design.pair.moving);
    json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "design": { "name": design.name, "sha256": design.sha256 },
        "bound": { "pose": pose(&inspection.bound), "energy_J": positive_zero(bond.energy) },
        "pull_contact_N": bond.contact,
        "pull_contact_g": bond.contact / GRAM,
        "pull_off_N": bond.pull_off,
        "pull_off_g": bond.pull_off / GRAM,
        "models": models,
        "comes_straight_out": inspection.comes_straight_out,
        "rivals": inspection.rivals.iter().map(|rival| json!({
            "faces": [name(fixed, rival.faces.0), name(moving, rival.faces.1)],
            "pose": pose(&rival.configuration),
            "energy_J": rival.energy,
        })).collect::<Vec<_>>(),
        "fixed": faces(fixed),
        "moving": faces(moving),
        "wrong": wrong(design, inspection),
    })
}

fn hold(hold: &Hold) -> Value {
    json!({
        "model": hold.model.name(),
        "energy_J": positive_zero(hold.energy),
        "contact_N": positive_zero(hold.contact),
        "along_N": positive_zero(hold.along),
        "torque_Nm": positive_zero(hold.torque),
        "pull_off_N": positive_zero(hold.pull_off),
        "pull_off_gap_m": hold.pull_off_gap,
    })
}

fn faces(tile: &Tile) -> Value {
    let face = |number: usize| {
        let entry = Face::new(tile, number);
        json!({
            "name": tile.faces[number].name,
            "length_m": entry.length,
            "code": entry.code,
            "magnets_m": entry.magnets,
            "heights_m": entry.heights,
        })
    };
    json!((0..tile.faces.len()).map(face).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_digits_that_they_need() {
        let told = |lengths: &[f64], error: f64| in_mm(lengths, 0, error).join(", ");
        assert_eq!(told(&[-0.06, -0.02, 0.02, 0.06], 4e-6), "-60, -20, 20, 60");
        let small = [-0.003, -0.0018, -0.0006, 0.0006, 0.0018, 0.003];
        assert_eq!(told(&small, 1e-7), "-3.0, -1.8, -0.6, 0.6, 1.8, 3.0");
        assert_eq!(told(&[0.0127 / 3.0, -1e-12], 1e-6), "4.233, 0.000");
        assert_eq!(told(&[], 1e-6), "");
        assert_eq!(in_mm(&[0.0, 0.0123], 1, 1e-4), ["0.0", "12.3"]);
        assert_eq!(in_mm(&[0.0, 0.000_05], 1, 5e-7), ["0.00", "0.05"]);
    }
}
