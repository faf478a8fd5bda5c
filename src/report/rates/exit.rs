//! Exits from a pose: how soon a tile leaves it, and where it goes.

use serde_json::{Value, json};

use super::told::{SCOPE, digits};
use crate::document::{Document, Entries, Entry, Table, entries, rows};
use crate::plots::chart::{Chart, Dimension, Look};
use jobs::design::Design;
use jobs::rates::PoseExit;
use physics::dynamics::exits::ExitRuns;
use physics::kinetics::rates::exit::MeshExit;
use physics::kinetics::{OVERDAMPED, PathToFree};
use physics::units::{duration, share_to, share_with, si};

/// The document of an exit, with the check by moving tiles if requested.
pub fn document<'a>(design: &Design, exit: &PoseExit, check: Option<&ExitRuns>) -> Document<'a> {
    let finest = exit.found.finest();
    let [x, y, theta] = exit.asked.start.to_array();
    Document {
        title: format!("Exit of {}", design.name),
        answer: format!(
            "{}: a tile released at {x},{y},{theta} is bound or free after {} on average; bound \
             first with probability {}, free first with {}",
            design.name,
            duration(exit.mean(), known_digits(exit)),
            share_with(finest.bound, 1),
            share_with(1.0 - finest.bound, 1),
        ),
        remarks: vec![format!(
            "(kT = {}, drag {} /s: D = {}; mean exit time times D = {}; bound: U < {} in the \
             basin of the bond or a symmetric copy; free: centres {} apart)",
            si(exit.asked.kt, "J", 4),
            exit.drag,
            si(exit.diffusion, "m²/s", 4),
            area(exit.found.finest().time),
            si(exit.asked.basin_energy, "J", 4),
            si(exit.asked.free_at, "m", 4),
        )],
        entries: found_entries(design, exit, check),
        pictures: vec![by_mesh(exit).into()],
        notes: notes(exit, check),
        origin: format!("{} magnets; {SCOPE}", design.interaction.model.name()),
        ..Document::default()
    }
}

fn known_digits(exit: &PoseExit) -> usize {
    digits(exit.error())
}

// One line an entry.
#[rustfmt::skip]
fn found_entries(design: &Design, exit: &PoseExit, check: Option<&ExitRuns>) -> Entries {
    let (asked, found, finest) = (&exit.asked, &exit.found, exit.found.finest());
    let [time, bound] = found.spread();
    entries(design)
        .fact("diffusion_m2_s", "", exit.diffusion)
        .fact("mean_exit_s", "mean exit time", exit.mean()).digits(known_digits(exit)).noted(describe_error(exit))
        .fact("mean_exit_error", "", exit.error())
        // Nothing is proved about an exit: the key stays for those who read it.
        .data("mean_exit_bounds_s", Value::Null)
        .group("exits", Entries::default()
            .fact("bound", "bound first", finest.bound).viewed(share_with(finest.bound, 1)).noted("probability")
            .fact("free", "free first", 1.0 - finest.bound).viewed(share_with(1.0 - finest.bound, 1)).noted("probability"))
        .fact("kt_J", "kT", asked.kt).noted(format!("drag {} /s", exit.drag))
        .fact("drag_per_s", "", exit.drag)
        .fact("start", "start", asked.start).noted("x (mm), y (mm), theta")
        .fact("basin_energy_J", "bound below", asked.basin_energy).digits(4)
        .fact("free_at_m", "free", asked.free_at).digits(4).noted("centres so far apart")
        .fact("way_out", "", found.way.name())
        .group("mesh", Entries::default()
            .fact("unknowns", "", finest.unknowns)
            .fact("mean_exit_spread", "", time)
            .fact("exits_spread", "", bound)
            .fact("of_basins", "", finest.of_rims)
            .fact("error", "", finest.error))
        .table(meshes(exit))
        .more(check.map(|runs| Entry::Data("check", check_entry(exit, runs))))
}

#[rustfmt::skip]
fn meshes(exit: &PoseExit) -> Table {
    rows(&exit.found.meshes)
        .column("unknowns", "unknowns", "of the mesh, each finer than the one before", |mesh| mesh.unknowns)
        .column("mean_exit_s", "mean exit time", "", |mesh| mesh.time / exit.diffusion)
        .column("bound", "bound first", "probability", |mesh| mesh.bound).viewed(|mesh| share_with(mesh.bound, 1))
        .column("error", "error of flows", "estimated, relative", |mesh| mesh.error).viewed(|mesh| share_with(mesh.error, 1))
        .column("of_basins", "of basins", "effect of making the basin of whole cells", |mesh| mesh.of_rims)
            .viewed(|mesh| share_with(mesh.of_rims, 1))
        .table("meshes").titled("Meshes", "").in_file("meshes")
}

/// The mean exit time over the meshes' unknowns.
fn by_mesh(exit: &PoseExit) -> Chart {
    let unknowns = |mesh: &MeshExit| mesh.unknowns as f64;
    let line = |of: &dyn Fn(&MeshExit) -> f64| -> Vec<[f64; 2]> {
        let meshes = exit.found.meshes.iter();
        meshes.map(|mesh| [unknowns(mesh), of(mesh)]).collect()
    };
    let meshes = exit.found.meshes.iter();
    let times = meshes.map(|mesh| mesh.time / exit.diffusion);
    let times = times.filter(|time| time.is_finite());
    let range = times.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], time| {
        [low.min(0.9 * time), high.max(1.1 * time)]
    });
    Chart::new(
        "meshes",
        "Mean exit time on successively finer meshes",
        Dimension::new("unknowns", "unknowns of the mesh")
            .logarithmic()
            .marked(
                [exit.found.meshes.first(), exit.found.meshes.last()]
                    .into_iter()
                    .flatten()
                    .map(unknowns),
            ),
        Dimension::new("mean_exit_s", "mean exit time").within(range),
    )
    .with(
        "on the mesh",
        Look::Line,
        line(&|mesh| mesh.time / exit.diffusion),
    )
}

/// The estimated error of the mean exit time.
fn describe_error(exit: &PoseExit) -> String {
    match exit.error() {
        error if error.is_finite() => format!("± {}, estimated", share_to(error, 2)),
        _ => "error unknown".to_owned(),
    }
}

fn notes(exit: &PoseExit, check: Option<&ExitRuns>) -> Vec<String> {
    let finest = exit.found.finest();
    let [time, bound] = exit.found.spread();
    let mut notes = vec![format!(
        "the two finest meshes ({} unknowns) differ by {} in the time and by {:.2} \
         percentage points in the probabilities; building the basin from whole cells changes its capacity by an \
         estimated {}; estimated error of flows {}",
        finest.unknowns,
        share_with(time, 1),
        100.0 * bound,
        share_with(finest.of_rims, 1),
        share_with(finest.error, 1),
    )];
    if exit.found.way != PathToFree::Open {
        notes.push(exit.found.way.describe().to_owned());
    }
    notes.push(SCOPE.to_owned());
    notes.extend(check.into_iter().flat_map(|runs| check_notes(exit, runs)));
    notes
}

/// The check of an exit by moving tiles; ratios are their times over those of overdamped motion.
fn check_entry(exit: &PoseExit, runs: &ExitRuns) -> Value {
    let ([bound, free], [time, error], [warmth, of_warmth]) = (runs.ends, runs.time, runs.warmth);
    json!({
        "runs": {"bound": bound, "free": free, "given_up": runs.given_up},
        // If some were abandoned, the true mean is longer.
        "mean_exit_s": time,
        "standard_error_s": error,
        "ratio": time / exit.mean(),
        "ratio_error": error / exit.mean(),
        "bound": bound as f64 / (bound + free) as f64,
        "kinetic_over_kt": warmth,
        "kinetic_over_kt_error": of_warmth,
        "has_temperature": runs.has_temperature(),
    })
}

fn check_notes(exit: &PoseExit, runs: &ExitRuns) -> Vec<String> {
    let ([bound, free], [time, error], [warmth, of_warmth]) = (runs.ends, runs.time, runs.warmth);
    let ended = bound + free;
    let least = match runs.given_up {
        0 => "",
        _ => "more than ",
    };
    let first = match ended {
        0 => String::new(),
        _ => format!(
            "; bound first in {} ({bound} of {ended})",
            share_with(bound as f64 / ended as f64, 0)
        ),
    };
    let mut notes = vec![format!(
        "check: {} rigid bodies with inertia take {least}{} +- {} on average, {least}{:.2} +- \
         {:.2} times the overdamped time{first}",
        ended + runs.given_up,
        duration(time, 3),
        duration(error, 2),
        time / exit.mean(),
        error / exit.mean(),
    )];
    if runs.given_up > 0 {
        notes.push(format!(
            "{} were stopped before the end, and count with the time until then",
            runs.given_up
        ));
    }
    let lost = match runs.has_temperature() {
        true => "",
        false => ": collisions lose energy, so no temperature exists",
    };
    notes.push(format!(
        "their kinetic energy is {warmth:.2} +- {of_warmth:.2} times that at kT{lost}"
    ));
    if exit.drag < OVERDAMPED {
        notes.push(format!(
            "at a drag of {} /s tiles glide: overdamped rates do not apply, and the ratio gives \
             the error",
            exit.drag
        ));
    }
    notes
}

/// An area with four digits; small and large ones with a power of ten, since prefixes of m² are
/// ambiguous.
fn area(value: f64) -> String {
    if (1e-4..1e4).contains(&value) {
        format!("{value:.4} m²")
    } else {
        format!("{value:.3e} m²")
    }
}
