//! Rates between states and `free`, as a document.

use serde_json::{Value, json};

use super::told::{SCOPE, digits, finite};
use crate::document::{Document, Drawing, Entries, Entry, Table, entries, rows};
use crate::plots::chart::{Chart, Dimension, Look};
use crate::plots::committor::committor;
use jobs::design::Design;
use jobs::rates::{AtKt, RatedState, StateRates};
use physics::dynamics::MotionSettings;
use physics::kinetics::PathToFree;
use physics::kinetics::bond::LEAST_DEPTH;
use physics::kinetics::rates::map::Map;
use physics::units::{duration, plain, share_to, share_with, si};

/// Relative difference of meshes above which a rate is unknown.
const UNSETTLED: f64 = 0.5;
/// The document of rates, computed with this random seed.
pub fn document<'a>(design: &'a Design, found: &'a StateRates, seed: u64) -> Document<'a> {
    Document {
        title: format!("Rates of {}", design.name),
        answer: format!("{}: {}", design.name, headline(design, found)),
        remarks: vec![format!(
            "(kT = {}, drag {} /s: D = {})",
            si(found.asked.kt, "J", 4),
            found.drag,
            si(found.diffusion, "m²/s", 4),
        )],
        entries: found_entries(design, found, seed),
        pictures: pictures(design, found),
        notes: notes(found),
        origin: format!(
            "{} magnets; overdamped motion at drag {} per s, reflected by contact",
            design.interaction.model.name(),
            found.drag,
        ),
        ..Document::default()
    }
}

fn headline(design: &Design, found: &StateRates) -> String {
    let free = found.states.len();
    let [width, height] = design.space().half_size.map(|half| 2.0 * half);
    match (found.known_rate(free, 0), found.known_rate_out(0)) {
        (Some(0.0), Some(0.0)) => {
            "tiles never bind or unbind: contact blocks every path".to_owned()
        }
        (Some(on), Some(off)) => format!(
            "free tiles bind at {} and bonds break at {}, on a table of {width} by {height} m",
            per_second(on, digits_of(found, free, 0)),
            per_second(off, digits_out(found, 0)),
        ),
        _ => {
            "no path into the bond was found, so binding and unbinding rates are unknown".to_owned()
        }
    }
}

fn per_second(rate: f64, digits: usize) -> String {
    format!("{} /s", plain(rate, digits))
}

/// The number of known digits of a rate, estimated from meshes.
fn digits_of(found: &StateRates, from: usize, to: usize) -> usize {
    digits(found.error(from, to))
}

/// The number of known digits of the rate out of a place.
fn digits_out(found: &StateRates, from: usize) -> usize {
    digits(error_out(found, from))
}

/// The relative error of the rate out of a place: that of the largest rate it consists of.
fn error_out(found: &StateRates, from: usize) -> f64 {
    let others = (0..found.count()).filter(|to| *to != from);
    let largest = others.max_by(|a, b| found.rate(from, *a).total_cmp(&found.rate(from, *b)));
    largest.map_or(f64::INFINITY, |to| found.error(from, to))
}

/// The relative error of a rate, if the rate is known and not 0.
fn error_of(rate: Option<f64>, error: f64) -> Option<f64> {
    rate.filter(|rate| *rate > 0.0).and(finite(error))
}

/// The error of the rate out of a place, or that there is no way out.
fn describe_error(found: &StateRates, place: usize) -> String {
    match found.known_rate_out(place) {
        Some(0.0) => "contact blocks every path".to_owned(),
        known => error_of(known, error_out(found, place)).map_or("-".to_owned(), either_way),
    }
}

/// A relative error.
fn either_way(error: f64) -> String {
    format!("± {}", share_to(error, 2))
}

/// The region of the landscape that a place stands for.
fn describe_set(found: &StateRates, place: usize) -> String {
    match found.states.get(place) {
        Some(state) => below(state.below),
        None => format!("{} apart", si(found.asked.free_at, "m", 4)),
    }
}

fn below(limit: f64) -> String {
    format!("U < {}", si(limit, "J", 4))
}

// One line an entry.
#[rustfmt::skip]
fn found_entries(design: &Design, found: &StateRates, seed: u64) -> Entries {
    let (finest, free, error) = (found.found.finest(), found.states.len(), found.found.error());
    let of_basins = finite(finest.of_rims).filter(|_| error.is_finite());
    entries(design)
        .data("seed", seed)
        .fact("leaving_per_s", "bonds break", found.known_rate_out(0)).digits(digits_out(found, 0)).noted(describe_error(found, 0)).in_view()
        .fact("binding_per_s", "free tiles bind", found.known_rate(free, 0)).digits(digits_of(found, free, 0)).noted("by \
            any path").in_view()
        .fact("diffusion_m2_s", "", found.diffusion)
        .fact("kt_J", "kT", found.asked.kt).noted(format!("drag {} /s", found.drag))
        .fact("drag_per_s", "", found.drag)
        .fact("free_at_m", "free", found.asked.free_at).noted("centres so far apart").in_view()
        .table(places(found))
        .table(pairs(found))
        .group("mesh", Entries::default()
            .fact("unknowns", "", finest.unknowns)
            .fact("of_basins", "", of_basins)
            .fact("error", "", error))
        .more((!found.over_kt.is_empty()).then(|| Entry::Data("over_kT", by_kt(found))))
        .more((!found.over_kt.is_empty()).then(|| Entry::Table(courses(found))))
        .more(found.map().map(|map| Entry::Table(squares(map))))
}

// One line per column: key, name, meaning, value.
#[rustfmt::skip]
fn places(found: &StateRates) -> Table {
    let of = |get: fn(&RatedState) -> f64| move |k: &usize| found.states.get(*k).map(get);
    let shared = |part: fn(&StateRates, usize) -> f64| move |k: &usize| found.known_share(*k, part(found, *k));
    // 1 - 1e-9 is known no better than 1.
    let describe = |part: Option<f64>| part.map_or("-".to_owned(), |part| share_to(part, 3));
    let occupation = shared(|it, k| it.found.finest().occupation[k]);
    let inside = shared(|it, k| it.found.inside[k]);
    rows(0..found.count())
        .column("name", "place", "", |k| found.name(*k)).without_csv()
        .data("place", |k| found.name(*k)).in_csv()
        .column("copies", "copies", "copies by symmetry", |k| found.states.get(*k).map(|it| it.copies))
        .column("occupation", "fraction of all time", "time between states is divided by committors", occupation)
            .viewed(move |k| describe(occupation(k)))
        .column("energy_J", "energy", "of the state", of(|it| it.energy)).digits(4)
        .data("basin_energy_J", of(|it| it.below)).in_json()
        .data("basin_J", of(|it| it.below)).in_csv()
        .column("set", "its set", "configurations that make up the state", |k| describe_set(found, *k)).in_view()
        .data("free_at_m", |k| (*k == found.states.len()).then_some(found.asked.free_at))
        .column("inside", "fraction in its set", "fraction of all time spent in the set itself", inside)
            .viewed(move |k| describe(inside(k)))
        .data("pose", |k| found.states.get(*k).map(|it| it.at)).in_json()
        .data("way_out", |k| found.found.ways.get(*k).map(|way| way.name())).in_json()
        .data("mean_exit_s", |k| found.known_rate_out(*k).map(|rate| 1.0 / rate)).in_json()
        .column("leaving_per_s", "escape rate", "rate to any other state", |k| found.known_rate_out(*k))
            .viewed(|k| found.known_rate_out(*k).map_or("-".to_owned(), |rate| per_second(rate, digits_out(found, *k)))).without_csv()
        .column("leaving_error", "error", "of that rate, estimated from two meshes", |k| error_of(found.known_rate_out(*k), error_out(found, *k)))
            .viewed(|k| describe_error(found, *k)).without_csv()
        .table("places").titled("Places", "").in_file("occupation")
}

#[rustfmt::skip]
fn pairs(found: &StateRates) -> Table {
    let error = |(i, j): &(usize, usize)| error_of(found.known_rate(*i, *j), found.error(*i, *j));
    let passage = |(i, j): &(usize, usize)| finite(found.mean_first_passage(*i, *j));
    let limit = |k: usize| found.states.get(k).map(|it| it.below);
    rows(found.pairs())
        .column("from", "from", "", |(i, _)| found.name(*i))
        .column("to", "to", "", |(_, j)| found.name(*j))
        .column("value_per_s", "rate", "", |(i, j)| found.known_rate(*i, *j))
            .viewed(|(i, j)| found.known_rate(*i, *j).map_or("-".to_owned(), |rate| per_second(rate, digits_of(found, *i, *j))))
        .column("error", "error", "of the rate, estimated from two meshes", error).viewed(move |row| error(row).map_or("-".to_owned(), either_way))
        .data("spread", |(i, j)| found.found.spread(*i, *j)) // difference between the two finest meshes
        .column("first", "probability as next", "that it is the next state", |(i, j)| found.first(*i, *j)).share()
        .column("mean_first_passage_s", "mean first passage", "mean time from one to the other, \
            by any path", passage)
            .viewed(move |row| passage(row).map_or("-".to_owned(), |time| duration(time, digits_of(found, row.0, row.1))))
        .data("from_basin_J", move |(i, _)| limit(*i)).in_csv()
        .data("to_basin_J", move |(_, j)| limit(*j)).in_csv()
        .data("free_at_m", |_| found.asked.free_at).in_csv()
        .table("rates").titled("Rates", "").in_file("rates")
}

/// The rates out of states over kT, by the states' names.
fn by_kt(found: &StateRates) -> Value {
    let of = |rates: &[Option<f64>]| -> Value {
        let named = found.states.iter().zip(rates);
        let named = named.map(|(state, rate)| (state.name.clone(), json!(rate)));
        named.collect()
    };
    let at = |at: &AtKt| {
        let (leaving, corner) = (of(&at.leaving), of(&at.corner));
        json!({"kT_J": at.kt, "leaving_per_s": leaving, "corner_leaving_per_s": corner})
    };
    found.over_kt.iter().map(at).collect()
}

#[rustfmt::skip]
fn courses(found: &StateRates) -> Table {
    let states = 0..found.states.len();
    rows(found.over_kt.iter().flat_map(|at| states.clone().map(move |k| (at, k))))
        .data("kT_J", |(at, _)| at.kt)
        .data("from", |(_, k)| found.name(*k))
        .data("leaving_per_s", |(at, k)| at.leaving[*k])
        .data("corner_leaving_per_s", |(at, k)| at.corner[*k])
        .table("over-kt").in_csv("over-kt")
}

/// The squares of a map that contain free configurations.
#[rustfmt::skip]
fn squares(map: &Map) -> Table {
    rows((0..map.committor.len()).filter(|square| map.committor[*square].is_finite()))
        .data("x_m", |square| map.middle(*square)[0])
        .data("y_m", |square| map.middle(*square)[1])
        .data("committor", |square| map.committor[*square])
        .data("flux_x_per_m", |square| map.flux[*square][0])
        .data("flux_y_per_m", |square| map.flux[*square][1])
        .table("committor").in_csv("committor")
}

fn pictures<'a>(design: &'a Design, found: &'a StateRates) -> Vec<Drawing<'a>> {
    let title = "Probability of the bond before free, and the flux into the bond";
    let map = found.map().map(|map| {
        Drawing::new(title, move |sheet| {
            committor(design, map, squares(map).csv(), sheet)
        })
    });
    let mut rates_known = found.over_kt.iter().flat_map(|at| &at.leaving).flatten();
    let is_left = rates_known.any(|rate| *rate > 0.0);
    map.into_iter()
        .chain(is_left.then(|| over_kt(found).into()))
        .collect()
}

/// Rates out of each state over kT, on logarithmic axes; the closed form dashed.
fn over_kt(found: &StateRates) -> Chart {
    let mut chart = Chart::new(
        "rates",
        "Rates out of states over kT",
        Dimension::new("kT_J", "kT")
            .logarithmic()
            .marked(found.over_kt.iter().map(|at| at.kt)),
        Dimension::new("leaving_per_s", "rate out").logarithmic(),
    )
    .remarked("closed form: wells as corners");
    for (k, state) in found.states.iter().enumerate() {
        let line = |of: &dyn Fn(&AtKt) -> Option<f64>| -> Vec<[f64; 2]> {
            let known = |at: &AtKt| Some([at.kt, of(at).filter(|rate| *rate > 0.0)?]);
            found.over_kt.iter().filter_map(known).collect()
        };
        let (solved, closed) = (line(&|at| at.leaving[k]), line(&|at| at.corner[k]));
        chart = chart
            .with(format!("{} left", state.name), Look::Line, solved)
            .in_colour(k)
            .with(format!("{}, closed form", state.name), Look::Dashed, closed)
            .in_colour(k);
    }
    chart.series.retain(|series| !series.points.is_empty());
    chart
}

fn notes(found: &StateRates) -> Vec<String> {
    let mut notes = vec![of_meshes(found)];
    let kt = found.asked.kt;
    let shallow = found.states.iter();
    let shallow = shallow.filter(|state| -state.energy < LEAST_DEPTH * kt);
    notes.extend(shallow.map(|state| {
        format!(
            "{} is less than {LEAST_DEPTH} kT deep and does not hold tiles: these rates count how \
             often its set is crossed",
            state.name
        )
    }));
    let ways = found.states.iter().zip(&found.found.ways);
    let ways = ways.filter(|(_, way)| **way != PathToFree::Open);
    notes.extend(ways.map(|(state, way)| format!("{}: {}", state.name, way.describe())));
    notes.push(format!(
        "lifetimes depend on the drag: these are for overdamped motion at {} /s; rates are \
         inversely proportional to the drag. `tilebind yield` counts docking runs with inertia, \
         by default at {} /s, and gives shorter lifetimes; its option --rates overdamped --drag \
         {} has the same motion for both tiles, which more than doubles all rates",
        found.drag,
        MotionSettings::default().drag,
        found.drag
    ));
    notes.push(SCOPE.to_owned());
    notes
}

fn of_meshes(found: &StateRates) -> String {
    let spreads = found.pairs().map(|(i, j)| found.found.spread(i, j));
    let worst = spreads.filter(|spread| spread.is_finite());
    let worst = worst.fold(0.0, f64::max);
    let unknowns = found.found.finest().unknowns;
    let unsettled = match worst > UNSETTLED {
        true => "; rates that differ that much are unknown: see their spread in rates.csv",
        false => "",
    };
    match found.found.error() {
        error if error.is_finite() => format!(
            "the two finest meshes ({unknowns} unknowns) differ by at most {}; estimated error \
             of flows {}{unsettled}",
            share_to(worst, 2),
            share_with(error, 1),
        ),
        _ => format!("no flux on the mesh ({unknowns} unknowns){unsettled}"),
    }
}
