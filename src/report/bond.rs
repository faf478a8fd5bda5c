//! The strength of the bond and the traps, as a document.

use serde_json::Value;

use super::document::{Document, Drawing, Entries, Entry, Table, entries, rows};
use super::files::{PAGE, REPORT};
use super::plots::chart::{Chart, Dimension, Look};
use crate::figures::share;
use jobs::bond::{Held, HeldState};
use jobs::design::Design;
use jobs::output::Command;
use physics::kinetics::bond::Binding;
use physics::kinetics::bond::volume::NO_PLAY;
use physics::units::{change_with, si};

/// The files of the command.
pub const FILES: Command = Command {
    name: "bond",
    files: &[REPORT, PAGE, "states.csv", "over-kt.csv"],
    pictures: &["shaking"],
};

/// The document of the strength of bonds.
pub fn document<'a>(design: &Design, held: &Held) -> Document<'a> {
    Document {
        title: format!("Bond of {}", design.name),
        answer: answer(design, held),
        remarks: vec![window(held)],
        entries: found_entries(design, held),
        pictures: match held.over_kt.is_empty() {
            true => Vec::new(),
            false => vec![Drawing::from(over_kt(held))],
        },
        notes: notes(held),
        origin: format!(
            "{} magnets; kT is an effective energy of the shaking",
            design.interaction.model.name()
        ),
        ..Document::default()
    }
}

fn answer(design: &Design, held: &Held) -> String {
    let bond = &held.states[0].docking;
    let name = &design.name;
    let at = format!(
        "at kT = {} and {} coverage",
        si(held.shaking.kt, "J", 4),
        share(held.shaking.coverage)
    );
    if held.is_too_cold {
        return format!(
            "{name}: {at} tiles move by less than {} in the bond, which is below the contact \
             tolerance: choose a larger --kt",
            si(NO_PLAY, "m", 2)
        );
    }
    if bond.cost.is_infinite() {
        return format!(
            "{name}: {at} the bond has no clearance at all: shaken tiles never find it"
        );
    }
    let verdict = match bond.ln_k(1.0) >= 0.0 {
        true => "one bond holds",
        false if bond.ln_k(2.0) >= 0.0 => "one bond does not hold, two together do",
        false => "neither one bond nor two together hold",
    };
    format!(
        "{name} {at}: {verdict} (ln K = {:.2} for one)",
        bond.ln_k(1.0)
    )
}

/// The range of kT in which two bonds hold a tile and one does not.
fn window(held: &Held) -> String {
    let bond = held.states[0].energy;
    match held.window {
        [Some(low), Some(high)] => format!(
            "two bonds hold a tile and one does not between kT = {} and {} (bond of {:.1} to \
             {:.1} kT), if one docking closes both",
            si(low, "J", 3),
            si(high, "J", 3),
            -bond / low,
            -bond / high
        ),
        _ => "at no kT do two bonds hold and one does not".to_owned(),
    }
}

// One line an entry.
#[rustfmt::skip]
fn found_entries(design: &Design, held: &Held) -> Entries {
    let (shaking, bond) = (&held.shaking, &held.states[0]);
    let states = states(held);
    let mut found: Vec<Value> = states.json().as_array().cloned().unwrap_or_default();
    let traps = found.split_off(1);
    entries(design)
        .fact("kT_J", "kT", shaking.kt)
        .fact("coverage", "coverage", shaking.coverage).viewed(share(shaking.coverage)).noted("share of the table")
        .fact("tile_area_m2", "", held.tile_area)
        .fact("tiles_per_m2", "", shaking.coverage / held.tile_area)
        .fact("bond_kT", "depth of the bond", bond.docking.depth).viewed(in_kt(bond.docking.depth))
        .fact("docking_cost_kT", "cost of docking", bond.docking.cost).viewed(in_kt(bond.docking.cost))
        .fact("ln_K", "ln K", bond.docking.ln_k(1.0)).viewed(number(bond.docking.ln_k(1.0))).noted("of one bond")
        .fact("docking_cost_error_kT", "", bond.docking.volume.relative_error())
        // The range of kT in which two bonds closed by one docking hold a tile and one alone does
        // not; null for a missing end.
        .data("two_hold_one_does_not_J", held.window.to_vec())
        .data("two_hold_one_does_not_bond_kT", held.window.map(|kt| kt.map(|kt| -bond.energy / kt)).to_vec())
        .data("bond", found.swap_remove(0))
        .table(states)
        // Omitted kinds of traps: less than 2 kT deep, they hold nothing.
        .fact("shallow_traps", "", held.shallow)
        .data("traps", traps)
        .more((!held.over_kt.is_empty()).then(|| Entry::Table(by_kt(held))))
}

// One line per column: key, name, meaning, value.
#[rustfmt::skip]
fn states(held: &Held) -> Table {
    let closed = |it: &HeldState| match it.closed_error() {
        // It is valid only for kT far below the depth.
        Some(error) if error.abs() < 10.0 => change_with(error, 1),
        Some(_) => "useless".to_owned(),
        None => "-".to_owned(),
    };
    rows(held.states.clone())
        .column("state", "state", "kind of state", |it| it.name.clone())
        .data("pose", |it| it.configuration)
        .column("energy_J", "energy", "", |it| it.energy).digits(4)
        .column("copies", "copies", "copies by symmetry", |it| it.copies)
        .data("moving_copies", |it| it.moving_copies)
        .column("depth_kT", "depth", "energy in kT", |it| it.docking.depth).viewed(|it| in_kt(it.docking.depth))
        .column("docking_cost_kT", "docking", "what it costs to find the state, -ln(rho Z0 s / 2 \
            pi)", |it| it.docking.cost)
            .viewed(|it| in_kt(it.docking.cost))
        .column("ln_K", "ln K", "depth minus docking cost", |it| it.docking.ln_k(1.0)).viewed(|it| number(it.docking.ln_k(1.0)))
        .data("Z0_m2_rad", |it| it.docking.volume.value)
        .data("Z0_error_m2_rad", |it| it.docking.volume.error)
        // The basin contains the configurations that can be reached from the state below this
        // energy.
        .data("basin_below_J", |it| it.level)
        .data("basin_cut", |it| it.is_cut)
        // The same with only the part below half the state's depth: if it differs, K depends on
        // where "bound" ends.
        .data("docking_cost_half_depth_kT", |it| it.inner.cost)
        .data("closed_form_Z0_m2_rad", |it| it.closed.map(|it| it.volume.value))
        .column("closed_form_error", "closed form", "error of the analytic estimate", HeldState::closed_error).viewed(closed)
        .table("states").titled("States", "").in_view().in_file("states")
}

/// The strength of states over kT.
#[rustfmt::skip]
fn by_kt(held: &Held) -> Table {
    let states = held.states.iter();
    let at = held.over_kt.iter().flat_map(|(kt, dockings)| {
        states.clone().zip(dockings).map(move |(state, docking)| (*kt, &state.name[..], docking))
    });
    rows(at)
        .data("kT_J", |(kt, ..)| *kt)
        .data("state", |(_, state, _)| *state)
        .data("depth_kT", |(.., docking)| docking.depth)
        .data("docking_cost_kT", |(.., docking)| docking.cost)
        .data("ln_K", |(.., docking)| docking.ln_k(1.0))
        .table("over_kT").in_data().in_file("over-kt")
}

/// ln K over kT: for one bond, for two bonds closed by one docking, and for the traps.
fn over_kt(held: &Held) -> Chart {
    let line = |of: &dyn Fn(&[Binding]) -> f64| -> Vec<[f64; 2]> {
        let points = held.over_kt.iter();
        points.map(|(kt, dockings)| [*kt, of(dockings)]).collect()
    };
    let two = line(&|dockings| dockings[0].ln_k(2.0));
    let mut chart = Chart::new(
        "shaking",
        "How strongly states hold over kT",
        Dimension::new("kT_J", "kT").logarithmic(),
        Dimension::new("ln_K", "ln K"),
    )
    .remarked("above 0 a pair is bound more than half of the time");
    for (k, state) in held.states.iter().enumerate() {
        let one = line(&|dockings| dockings[k].ln_k(1.0));
        chart = chart.with(state.name.clone(), Look::Line, one).in_colour(k);
    }
    let name = format!("two {} closed by one docking", held.states[0].name);
    chart.with(name, Look::Dashed, two).in_colour(0)
}

fn notes(held: &Held) -> Vec<String> {
    let shallow = format!(
        "{} more kinds of trap are less than 2 kT deep",
        held.shallow
    );
    let blurred = held.states.iter();
    let blurred = blurred.filter(|state| state.inner.cost - state.docking.cost > 0.1);
    let blurred: Vec<&str> = blurred.map(|state| &state.name[..]).collect();
    let told = format!(
        "barely bound: {}; K depends on where \"bound\" ends, here at the lowest pass, or at a \
         hundredth of the depth if that is lower",
        blurred.join(", ")
    );
    let notes = [
        (held.shallow > 0).then_some(shallow),
        (!blurred.is_empty()).then_some(told),
    ];
    notes.into_iter().flatten().collect()
}

fn number(value: f64) -> String {
    match value.is_finite() {
        true => format!("{value:.2}"),
        false => "-".to_owned(),
    }
}

fn in_kt(value: f64) -> String {
    match value.is_finite() {
        true => format!("{value:.2} kT"),
        false => "-".to_owned(),
    }
}
