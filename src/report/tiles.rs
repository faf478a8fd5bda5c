//! Descriptions of tiles and of the forces that hold them, in words.

use crate::columns::{Table, rows};
use jobs::design::{Design, DesignError};
use jobs::inspection::{Hold, Inspection};
use physics::order::Order;
use physics::tile::{Magnet, Tile};
use physics::units::{plain, si};

/// Weight of a gram (N).
pub const GRAM: f64 = 9.806_65e-3;
/// Significant digits of energies and forces.
const DIGITS: usize = 4;

/// The mistakes in a design, after the reader's warnings; empty if there are none.
pub fn wrong(design: &Design, inspection: &Inspection) -> Vec<String> {
    let doubts = design.warnings.iter().map(DesignError::sentence);
    doubts.chain(inspection.faults(design)).collect()
}

/// A force in newtons and grams.
pub fn force(newtons: f64) -> String {
    let grams = newtons / GRAM;
    let decimals = match grams.abs() {
        100.0.. => 0,
        1.0.. => 1,
        _ => 3,
    };
    format!("{} N ({grams:.decimals$} g)", plain(newtons, 3))
}

/// The forces that hold the tiles, one row for each magnet model.
// One line a column.
#[rustfmt::skip]
pub fn models<'a>(design: &'a Design, models: &'a [Hold]) -> Table {
    rows(models)
        .column("model", "magnets as", "", |it| it.model.name()).viewed(|it| it.model.plural(&design.pair).to_owned())
        .column("energy_J", "energy", "with target faces in contact", |it| it.energy).digits(DIGITS)
        .column("contact_N", "pull at contact", "along the face's normal", |it| it.contact).viewed(|it| force(it.contact))
        .column("along_N", "", "", |it| it.along)
        .column("torque_Nm", "", "", |it| it.torque)
        .column("pull_off_N", "pull-off", "largest force on a straight path", |it| it.pull_off).viewed(|it| pull_off(it))
        .column("pull_off_gap_m", "", "", |it| it.pull_off_gap)
        .table("models")
        .in_file("models")
}

/// The largest pull on the way straight out, and its gap.
pub fn pull_off(hold: &Hold) -> String {
    match hold.pull_off_gap {
        0.0 => force(hold.pull_off),
        gap => format!("{} at {}", force(hold.pull_off), si(gap, "m", 2)),
    }
}

/// The pole of a magnet that points outwards, or up.
pub fn letter(tile: &Tile, magnet: &Magnet) -> char {
    magnet.pole(tile.faces[magnet.face].normal()).letter()
}

/// The magnets of a face with their positions along it (m), counter-clockwise.
pub fn magnets(tile: &Tile, number: usize) -> Vec<(f64, &Magnet)> {
    let face = &tile.faces[number];
    let own = tile.magnets.iter().filter(|magnet| magnet.face == number);
    let place = |magnet: &Magnet| (magnet.position - face.middle()).dot(&face.tangent());
    let mut placed: Vec<_> = own.map(|magnet| (place(magnet), magnet)).collect();
    placed.order_by(|a, b| a.0.total_cmp(&b.0));
    placed
}
