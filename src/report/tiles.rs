//! Descriptions of tiles and of the forces that hold them, in words.

use crate::columns::{Table, rows};
use jobs::design::{Design, DesignError, Weight};
use jobs::inspection::{Fit, Hold, Inspection, NEGLIGIBLE};
use jobs::workshop::{CLEARANCE, open_pockets};
use physics::order::Order;
use physics::tile::{Magnet, Tile};
use physics::units::{counted, plain, share_to, si};

/// Weight of a gram (N).
pub const GRAM: f64 = 9.806_65e-3;
/// Significant digits of energies and forces.
const DIGITS: usize = 4;

/// The mistakes in a design, after the reader's warnings; empty if there are none.
pub fn wrong(design: &Design, inspection: &Inspection) -> Vec<String> {
    let doubts = design.warnings.iter().map(DesignError::sentence);
    doubts.chain(inspection.faults(design)).collect()
}

/// A sentence on pockets that would have no wall to the rim, if there are any.
pub fn without_wall(design: &Design) -> Option<String> {
    let [fixed, moving] = [&design.pair.fixed, &design.pair.moving];
    let each = [fixed, moving].map(|tile| open_pockets(tile, CLEARANCE));
    let count = each[0].0 + each[1].0;
    let of = fixed.magnets.len() + moving.magnets.len();
    let more = each.iter().filter(|it| it.0 > 0).map(|it| it.1);
    let most: Option<Vec<f64>> = more.collect();
    let help = match most {
        Some(most) => {
            let most = most.into_iter().fold(0.0, f64::max);
            format!(
                "raise `inset` by {} mm for a wall",
                plain(1e3 * most, DIGITS)
            )
        }
        None => "no `inset` leaves a wall for all of them".to_owned(),
    };
    let pockets = counted(of, "pocket");
    (count > 0).then(|| {
        format!(
            "if the tiles are cut, {count} of {pockets} would have a wall below 0.5 mm to the \
             rim, and `tilebind make` cuts them as notches: {help}"
        )
    })
}

/// A force in newtons and grams.
pub fn force(newtons: f64) -> String {
    format!("{} N ({})", plain(newtons, 3), grams(newtons))
}

/// A force in grams.
pub fn grams(newtons: f64) -> String {
    let grams = newtons / GRAM;
    match grams.abs() {
        100.0.. => format!("{grams:.0} g"),
        1.0.. => format!("{grams:.1} g"),
        _ => format!("{} g", plain(grams, 2)),
    }
}

/// A force or a torque in words, none where it is negligible beside the strongest of its kind.
pub fn or_none(value: f64, strongest: f64, describe: fn(f64) -> String) -> String {
    match value.abs() <= NEGLIGIBLE * strongest {
        true => "none".to_owned(),
        false => describe(value),
    }
}

/// A torque in newton metres, and in grams on an arm of a centimetre; of a contact that opens by
/// itself, this fact.
fn torque(newton_metres: f64) -> String {
    if newton_metres < 0.0 {
        return "opens by itself".to_owned();
    }
    let grams = newton_metres / (GRAM * 0.01);
    let decimals = usize::from(grams.abs() < 100.0);
    format!("{} ({grams:.decimals$} g cm)", si(newton_metres, "N m", 3))
}

/// The fits of the target faces, and what ends each: the bond, then the deepest wrong ones.
// One line a column.
#[rustfmt::skip]
pub fn fits(found: &Inspection) -> Table {
    let most = |of: fn(&Fit) -> f64| found.fits.iter().map(of).fold(0.0, |most, it| f64::max(most, it.abs()));
    let slide = |it: &Fit| it.slide.unwrap_or(0.0);
    let [slides, tilt] = [most(slide), most(|it| it.tilt)];
    rows(found.fits.iter().enumerate())
        .column("fit", "fit", "", |(k, _)| if *k == 0 { "bond" } else { "trap" }).viewed(|(k, it)| name(*k, it))
        .data("slid_m", |(_, it)| it.slid)
        .column("pose", "x, y (mm), angle", "of the moving tile", |(_, it)| it.pose).in_data()
        .column("energy_J", "energy", "of the magnets, 0 far apart", |(_, it)| it.energy).digits(DIGITS)
            .viewed(|(_, it)| energy(found, it.energy))
        .column("pull_off_N", "straight off", "largest force on a straight path", |(_, it)| it.pull_off).viewed(|(_, it)| pull(found, it.pull_off))
        .column("slide_N", "along the face", "largest force against a slide in the easier direction, without friction", |(_, it)| it.slide)
            .viewed(move |(_, it)| it.slide.map_or("blocked by the shapes".to_owned(), |it| or_none(it, slides, force)))
        .column("tilt_Nm", "tilted off", "torque about the easier end of the contact", |(_, it)| it.tilt).viewed(move |(_, it)| or_none(it.tilt, tilt, torque))
        .table("fits")
        .in_file("fits")
        .titled("What ends each fit of the target faces", format!(
            "slid along each other in contact; forces of the magnets alone; none: below {} of the \
             strongest in the column",
            share_to(NEGLIGIBLE, 1)
        ))
}

/// The bond, or how far the tile has slid.
fn name(number: usize, fit: &Fit) -> String {
    match (number, fit.is_mirrored) {
        (0, _) => "bond".to_owned(),
        (_, true) => format!("slid by \u{b1}{}", si(fit.slid, "m", 3)),
        _ => format!("slid by {}", si(fit.slid, "m", 3)),
    }
}

/// An energy of the target faces, none where their magnets cancel.
pub fn energy(found: &Inspection, energy: f64) -> String {
    or_none(energy, found.strongest, |u| si(u, "J", DIGITS))
}

/// A pull on the target faces, none where their magnets cancel.
pub fn pull(found: &Inspection, newtons: f64) -> String {
    let strongest = found.fits.iter().map(|fit| fit.pull_off.abs());
    or_none(newtons, strongest.fold(0.0, f64::max), force)
}

/// The forces that hold the tiles, one row for each magnet model.
// One line a column.
#[rustfmt::skip]
pub fn models<'a>(design: &'a Design, found: &'a Inspection) -> Table {
    rows(&found.models)
        .column("model", "magnets as", "", |it| it.model.name()).viewed(|it| it.model.plural(&design.pair).to_owned())
        .column("energy_J", "energy", "with target faces in contact", |it| it.energy).viewed(|it| energy(found, it.energy))
        .column("contact_N", "pull at contact", "along the face's normal", |it| it.contact).viewed(|it| pull(found, it.contact))
        .data("along_N", |it| it.along)
        .data("torque_Nm", |it| it.torque)
        .column("pull_off_N", "pull-off", "largest force on a straight path", |it| it.pull_off).viewed(|it| pull_off(found, it))
        .data("pull_off_gap_m", |it| it.pull_off_gap)
        .table("models")
        .in_file("models")
}

/// The largest pull on the way straight out, and its gap.
pub fn pull_off(found: &Inspection, hold: &Hold) -> String {
    let told = pull(found, hold.pull_off);
    match hold.pull_off_gap {
        gap if gap > 0.0 && told != "none" => format!("{told} at {}", si(gap, "m", 2)),
        _ => told,
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

/// Notes on tiles whose mass is that of foam.
pub(crate) fn weights(design: &Design) -> Vec<String> {
    let tiles = [&design.pair.fixed, &design.pair.moving];
    let [fixed, moving] = tiles.map(Weight::of);
    let notes = match fixed == moving {
        true => vec![fixed.note("each tile")],
        false => vec![fixed.note("the fixed tile"), moving.note("the moving tile")],
    };
    notes.into_iter().flatten().collect()
}
