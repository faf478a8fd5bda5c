//! Energies and forces at given poses, as a document.

use serde_json::json;

use crate::document::{Document, Drawing, Table, entries, rows};
use crate::files::{PAGE, REPORT};
use crate::plots::poses;
use crate::values::positive_zero;
use jobs::design::Design;
use jobs::output::Command;
use jobs::query::poses::Felt;
use physics::order::Order;
use physics::units::si;

/// The files of the command.
pub const FILES: Command = Command {
    name: "energy",
    files: &[REPORT, PAGE, "poses.csv"],
    pictures: &["poses"],
};

/// Number of poses on a terminal, and in the picture.
const LISTED: usize = 40;
const DRAWN: usize = 12;

/// The document of energies at poses.
pub fn document<'a>(design: &'a Design, found: &'a [Felt]) -> Document<'a> {
    let mut lowest: Vec<&Felt> = found.iter().filter(|it| it.is_free).collect();
    lowest.order_by(|a, b| a.energy.total_cmp(&b.energy));
    let told = lowest.first().map_or("all overlap".to_owned(), |it| {
        format!(
            "lowest energy without overlap {} (magnets as {})",
            si(it.energy, "J", 4),
            design.interaction.model.plural(&design.pair)
        )
    });
    let drawn = found.iter().take(DRAWN);
    let drawn: Vec<_> = drawn.map(|it| (it.pose, si(it.energy, "J", 4))).collect();
    let title = match found.len() {
        ..=DRAWN => "Energies of the poses".to_owned(),
        _ => format!("Energies of the first {DRAWN} poses"),
    };
    Document {
        title: format!("{}: energies at {} poses", design.name, found.len()),
        answer: format!("{}: {} poses; {told}", design.name, found.len()),
        entries: entries(design).table(table(design, found).in_file("poses").listing(LISTED)),
        printed: Some("poses"),
        pictures: vec![Drawing::new(title.clone(), move |sheet| {
            let numbers = table(design, &found[..drawn.len()]).csv();
            poses::draw(("poses", &title), &design.pair, &drawn, numbers, sheet)
        })],
        origin: "energies are 0 far apart; forces act on the moving tile".to_owned(),
        ..Document::default()
    }
}

// One line a column.
#[rustfmt::skip]
fn table(design: &Design, found: &[Felt]) -> Table {
    let model = design.interaction.model.name();
    rows(found)
        .column("pose", "x, y (mm), angle", "of the moving tile in the fixed tile's frame", |it| it.pose)
        .column("energy_J", "energy", "0 far apart", |it| it.energy).digits(4)
        .data("force_N", |it| json!(it.force.map(positive_zero))).without_csv()
        .column("_N", "force", "on the moving tile", |it| libm::hypot(it.force[0], it.force[1])).in_view()
        .column("force_x_N", "along x", "", |it| it.force[0]).in_csv()
        .column("force_y_N", "along y", "", |it| it.force[1]).in_csv()
        .column("torque_Nm", "torque", "about the moving tile's reference point", |it| it.torque)
        .column("clearance_m", "clearance", "negative where the tiles overlap", |it| it.clearance)
        .column("free", "free", "whether the tiles do not overlap", |it| it.is_free)
        .data("model", |_| model) // magnet model
        .table("poses")
}
