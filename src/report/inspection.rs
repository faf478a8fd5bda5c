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
use physics::tile::strength::{PULL_SPREAD, Strength};
use physics::tile::{Magnet, Tile};
use physics::units::{MU0, si, to_digits};

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
    let magnets = match inspection.models[1] {
        blocks if bond.model == MagnetModel::Dipole => format!(
            "(magnets as point dipoles; as blocks {})",
            si(blocks.energy, "J", DIGITS)
        ),
        _ => "(magnets as blocks)".to_owned(),
    };
    match bond.energy < 0.0 {
        true => format!(
            "{}: faces {faces} bind with {} {magnets}; straight apart takes {}",
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
    for kind in &design.sold {
        text.push_str(&sold(kind));
    }
    text
}

/// What a shop's grade or pull says of magnets, and how sure that is.
fn sold((strength, size): &(Strength, [f64; 3])) -> String {
    let millimetres = size.map(|x| four(x * 1e3)).join(" x ");
    let block = format!(
        "magnets {millimetres} mm, magnetised through {} mm",
        four(size[0] * 1e3)
    );
    match strength {
        Strength::Grade(grade) => {
            let [least, usual, most] = grade.remanence;
            let [low, high] = grade.energy_range().map(|factor| 100.0 * (factor - 1.0));
            format!(
                "{block}, {}: remanence {usual:.2} T ({least:.2} to {most:.2} T as makers state it: energies \
                 {low:+.0} to {high:+.0} %)\n",
                grade.name
            )
        }
        Strength::Pull(force) => {
            let found = remanence(strength, *size);
            let [low, high] = pulled_range(found);
            format!(
                "{block}, that pull {} off thick steel: remanence {} T if block and plate are ideal; \
                 what sellers state is {} to {} of that, so it may be {} to {} T\n",
                self::force(*force),
                three(found),
                PULL_SPREAD[0],
                PULL_SPREAD[1],
                three(low),
                three(high),
            )
        }
        _ => String::new(),
    }
}

/// Of a block of this size (T).
fn remanence(strength: &Strength, size: [f64; 3]) -> f64 {
    MU0 * strength.moment(size) / size.iter().product::<f64>()
}

/// Where a remanence (T) that is taken from a pull may lie, as sellers state pulls: the pull goes with
/// its square.
fn pulled_range(remanence: f64) -> [f64; 2] {
    let [least, most] = PULL_SPREAD;
    [most, least].map(|share| remanence / share.sqrt())
}

/// Significant digits of a number, without zeros at its end.
fn four(value: f64) -> String {
    to_digits(value, 4).to_string()
}

fn three(value: f64) -> String {
    to_digits(value, 3).to_string()
}

fn row(hold: &Hold) -> [String; 4] {
    [
        hold.model.plural().to_owned(),
        si(hold.energy, "J", DIGITS),
        force(hold.contact),
        match hold.pull_off_gap {
            0.0 => force(hold.pull_off),
            gap => format!("{} at {}", force(hold.pull_off), si(gap, "m", 2)),
        },
    ]
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
        let places: Vec<String> = self
            .magnets
            .iter()
            // To a micrometre.
            .map(|s| format!("{}", (s * 1e6).round() / 1e3 + 0.0))
            .collect();
        Some([
            name.to_owned(),
            si(self.length, "m", 3),
            match places.is_empty() {
                true => "none".to_owned(),
                false => format!("{} at {} mm", self.code, places.join(", ")),
            },
            match straight {
                true => "straight".to_owned(),
                false => format!("from {:.1} to {:.1} mm", low * 1e3 + 0.0, high * 1e3 + 0.0),
            },
        ])
    }
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
    let mut value = json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "design": { "name": design.name, "sha256": design.sha256 },
        "bound": { "pose": pose(&inspection.bound), "energy_J": positive_zero(bond.energy) },
        "model": bond.model.name(),
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
    });
    if !design.sold.is_empty() {
        value["magnets"] = design.sold.iter().map(sold_entry).collect();
    }
    value
}

/// Magnets that are given by a grade or a pull.
fn sold_entry((strength, size): &(Strength, [f64; 3])) -> Value {
    let found = remanence(strength, *size);
    let mut entry = json!({ "size_m": size, "remanence_T": found });
    match strength {
        Strength::Grade(grade) => {
            let [least, _, most] = grade.remanence;
            entry["grade"] = json!(grade.name);
            entry["remanence_range_T"] = json!([least, most]);
        }
        Strength::Pull(force) => {
            entry["pull_N"] = json!(force);
            entry["remanence_range_T"] = json!(pulled_range(found));
        }
        _ => {}
    }
    entry
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
