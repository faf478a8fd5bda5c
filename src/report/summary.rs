//! The summary: some ten lines for the terminal.
//!
//! It leads with where tiles that start far apart end. That there is no barrier on the way into
//! the bond says little: without any barrier, many starts may run into traps first.

use ordered_float::OrderedFloat;
use std::fmt::Write;

use crate::dynamics;
use crate::figures::percent;
use crate::names::face_names;
use crate::terminal::write_rows;
use jobs::design::Design;
use jobs::inspection;
use jobs::pipeline::Analysis;
use physics::budget::{Allowance, Ended};
use physics::configuration::Configuration;
use physics::landscape::results::SAME_ENERGY;
use physics::landscape::{Barrier, Inventory, Kind, LeftOut, Place, Proportion};
use physics::order::Order;
use physics::units::{si, si_range};

/// Traps that are listed one by one.
const LISTED: usize = 4;
/// Significant digits of energies.
const DIGITS: usize = 4;

/// The summary of an analysis whose results are in `folder`, for a terminal of so many columns.
pub fn summary(
    design: &Design,
    analysis: &Analysis,
    folder: &str,
    columns: Option<usize>,
) -> String {
    let (bonds, mut traps): (Vec<Kind>, Vec<Kind>) =
        analysis.inventory.kinds().partition(Kind::is_bond);
    traps.order_by_key(|kind| std::cmp::Reverse(kind.captured().count));
    let bond = bonds.first();

    let mut text = String::new();
    if let Some(rivals) = inspection::rivals(analysis.problem.rivals().len()) {
        let _ = writeln!(text, "{rivals}");
    }
    // The deepest trap is always among those that are listed.
    let deepest = traps.iter().enumerate().skip(LISTED);
    let deepest = deepest.min_by_key(|(_, kind)| OrderedFloat(kind.first().energy));
    let listed_energies = traps.iter().take(LISTED).map(|kind| kind.first().energy);
    let lowest_listed = listed_energies.fold(f64::INFINITY, f64::min);
    if let Some((k, _)) = deepest.filter(|(_, kind)| kind.first().energy < lowest_listed) {
        let kind = traps.remove(k);
        traps.insert(LISTED - 1, kind);
    }
    write_captures(&mut text, design, analysis, bond, &traps);
    let listed = bond.into_iter().chain(traps.iter().take(LISTED));
    let mut rows = vec![HEADER.map(str::to_owned)];
    rows.extend(listed.map(|class| row(design, analysis, class)));
    write_rows(&mut text, &rows, columns);
    if traps.len() > LISTED {
        write_rest(&mut text, &traps[LISTED..]);
    }
    write_bond(&mut text, analysis, bond);
    write_deepest(&mut text, &analysis.inventory, bond, &traps);
    write_completeness(&mut text, analysis);
    write_dipole_error(&mut text, analysis);
    if let Some(why) = analysis.uncertified {
        let _ = writeln!(text, "barriers are not certified: {why}");
    }
    if let Some(ended) = analysis.certificate_ended {
        let _ = writeln!(
            text,
            "some barriers' bounds are wider than asked for: {}",
            ended_by(ended, "certify", analysis.settings.certify)
        );
    }
    text += &dynamics::summary(analysis);
    let _ = writeln!(
        text,
        "results in {folder}: report.html to look at; report.json, tables, pathways/, pictures/"
    );
    text
}

/// What is said of states that were found and are not listed, the lowest of which has this energy.
pub(super) fn left_out(left: LeftOut, lowest: &str) -> String {
    let more = match left.kinds {
        1 => "1 more kind of trap was".to_owned(),
        kinds => format!("{kinds} more kinds of trap were"),
    };
    format!("{more} found, {lowest} at the lowest, and not looked at (--kinds N: the N deepest)")
}

/// Whether states may be missing from the list.
fn write_completeness(text: &mut String, analysis: &Analysis) {
    if let Some(left) = analysis.counts.left_out {
        let _ = writeln!(text, "{}", left_out(left, &si(left.lowest, "J", 4)));
    }
    let known = match &analysis.completeness {
        Ok(known) => known,
        Err(why) => {
            let _ = writeln!(
                text,
                "the list of states is sampled and may lack some: {why};\n\
                 of more far starts {} would end in kinds not seen yet (Good-Turing estimate)",
                percent(&analysis.inventory.unseen())
            );
            return;
        }
    };
    let [below, escape] = [known.below, known.escape].map(|energy| si(energy, "J", 3));
    let claim = format!("no other state below {below} takes more than {escape} to leave");
    let _ = match known.open.first() {
        None => writeln!(text, "complete, proved: {claim}"),
        Some(lowest) => writeln!(
            text,
            "{claim}, proved but for {} {} ({:.1e} of the space)\n\
             that may hide something down to {}, first at {}",
            known.open.len(),
            if known.open.len() == 1 {
                "region"
            } else {
                "regions"
            },
            known.share,
            si(lowest.lowest, "J", 3),
            pose(&lowest.pose),
        ),
    };
    if let Some(ended) = known.ended {
        let allowed = analysis.settings.completeness.allowed;
        let _ = writeln!(text, "{}", ended_by(ended, "complete", allowed));
    }
}

/// That a proof ended, and how it is led on: by which option.
pub(super) fn ended_by(ended: Ended, stage: &str, allowed: Allowance) -> String {
    let (limit, option, note) = match ended {
        Ended::Work => (allowed.work, "work", "more of it goes on"),
        Ended::Clock => (allowed.seconds, "seconds", "another run may differ"),
    };
    let limit = limit.unwrap_or(f64::INFINITY);
    format!("{} (--{stage}-{option} {limit}): {note}", ended.describe())
}

/// How far the dipoles' energy is off at the state where it is off most.
fn write_dipole_error(text: &mut String, analysis: &Analysis) {
    let worst = analysis
        .inventory
        .states
        .iter()
        .filter(|state| state.id == state.class)
        .filter_map(|state| Some((state, state.block_energy?, state.dipole_error()?)))
        .max_by_key(|(.., error)| OrderedFloat(error.abs()));
    if let Some((state, blocks, error)) = worst {
        let _ = writeln!(
            text,
            "dipoles are off by up to {}: at {}, where blocks have {} (--model cuboid)",
            si(error, "J", DIGITS),
            analysis.inventory.name_of(Place::State(state.id)),
            si(blocks, "J", DIGITS),
        );
    }
}

/// Where far starts end.
fn write_captures(
    text: &mut String,
    design: &Design,
    analysis: &Analysis,
    bond: Option<&Kind>,
    traps: &[Kind],
) {
    let of = analysis.uncaptured.gone.of;
    let trapped: usize = traps.iter().map(|class| class.captured().count).sum();
    let bound = bond.map_or(0, |class| class.captured().count);
    let [inner, outer] = analysis.ring;
    let _ = writeln!(
        text,
        "{}: of {of} far starts {} end in the bond, {} in traps,\n\
         {} at rest in something shallow, {} gone\n\
         (overdamped, from {inner:.2} to {outer:.2} m away, any angle; 95 % intervals in brackets)",
        design.name,
        percent(&Proportion::new(bound, of)),
        percent(&Proportion::new(trapped, of)),
        percent(&analysis.uncaptured.at_rest),
        percent(&analysis.uncaptured.gone),
    );
}

const HEADER: [&str; 6] = [
    "state",
    "captures",
    "energy",
    "escape barrier",
    "certified",
    "x, y (mm), theta, faces",
];

fn row(design: &Design, analysis: &Analysis, class: &Kind) -> [String; 6] {
    let name = analysis.inventory.name_of(Place::State(class.first().id));
    let energy = class.first().energy;
    let Analysis {
        problem, inventory, ..
    } = analysis;
    let escape = inventory.escape_of_kind(problem, class.first().class);
    let is_caged = escape.is_some_and(|way| way.bounds.caged);
    [
        if class.copies() > 1 {
            format!("{name} x{}", class.copies())
        } else {
            name
        },
        percent(&class.captured()),
        si(energy, "J", DIGITS),
        match escape {
            _ if is_caged => "caged, proved".to_owned(),
            Some(way) if way.has_way() => {
                let to = inventory.name_of(way.to);
                format!("{} to {to}", si(way.forward(), "J", DIGITS))
            }
            _ => "none found".to_owned(),
        },
        match escape.and_then(|way| way.bounds.above(energy).both()) {
            _ if is_caged => "no way out".to_owned(),
            None => String::new(),
            Some((lower, upper)) => si_range(lower, upper, "J", DIGITS),
        },
        format!(
            "{}, {}",
            pose(&class.first().configuration),
            faces(design, class)
        ),
    ]
}

fn write_rest(text: &mut String, rest: &[Kind]) {
    let deepest = rest.iter().map(|t| t.first().energy).fold(0.0, f64::min);
    let captured: usize = rest.iter().map(|t| t.captured().count).sum();
    let _ = writeln!(
        text,
        "and {} more kind{} of trap down to {} that capture {} together",
        rest.len(),
        if rest.len() == 1 { "" } else { "s" },
        si(deepest, "J", DIGITS),
        percent(&Proportion::new(captured, rest[0].captured().of)),
    );
}

/// How far starts may get into the bond at best.
fn write_bond(text: &mut String, analysis: &Analysis, bond: Option<&Kind>) {
    if bond.is_none() {
        let energy = si(analysis.bound.1, "J", DIGITS);
        let _ = writeln!(
            text,
            "no bond: where the target faces coincide ({energy}) nothing holds the tile"
        );
        return;
    };
    let _ = match analysis.inventory.way_out_of_the_bond() {
        Some(way) if way.bounds.caged => {
            writeln!(
                text,
                "proved: no way leads from far apart into the bond, nor out of it"
            )
        }
        Some(way) if way.saddle_energy <= 0.0 => {
            writeln!(
                text,
                "no barrier on the best way from far apart into the bond{}",
                work_and_length(way)
            )
        }
        Some(way) if way.has_way() => writeln!(
            text,
            "a barrier of {} on the best way from far apart into the bond{}",
            si(way.saddle_energy, "J", DIGITS),
            work_and_length(way)
        ),
        _ => writeln!(text, "no way from far apart into the bond was found"),
    };
}

/// What the best way out of the bond takes, gone backwards: climbs too small to matter are none.
fn work_and_length(way_out: &Barrier) -> String {
    let Some(([_, climbs], length)) = way_out.work().zip(way_out.length()) else {
        return String::new();
    };
    let work = if climbs < 1e-5 * way_out.forward() {
        0.0
    } else {
        climbs
    };
    let [work, length] = [si(work, "J", 3), si(length, "m", 3)];
    format!(": {work} of work over {length}")
}

fn write_deepest(text: &mut String, inventory: &Inventory, bond: Option<&Kind>, traps: &[Kind]) {
    let energy = |kind: &Kind| kind.first().energy;
    let lowest = traps.iter().map(energy).fold(f64::INFINITY, f64::min);
    // The first of twins, whatever rounding makes of their energies.
    let is_lowest = |kind: &&Kind| energy(kind) - lowest <= SAME_ENERGY * lowest.abs();
    let deepest = traps.iter().find(is_lowest);
    let name = |kind: &Kind| inventory.name_of(Place::State(kind.first().id));
    let _ = match (deepest, bond) {
        (None, _) => writeln!(text, "no traps"),
        (Some(deepest), None) => writeln!(text, "deepest: {}", name(deepest)),
        (Some(deepest), Some(bond)) => writeln!(
            text,
            "deepest: {}; selectivity {:.3} (energy of the bond over that of the deepest trap)",
            name(deepest),
            bond.first().energy / deepest.first().energy,
        ),
    };
}

/// Names of the faces in contact: `east-west`.
fn faces(design: &Design, class: &Kind) -> String {
    let pairs: Vec<String> = face_names(design, class.first())
        .iter()
        .map(|pair| pair.join("-"))
        .collect();
    if pairs.is_empty() {
        "no contact".to_owned()
    } else {
        pairs.join(" ")
    }
}

fn pose(q: &Configuration) -> String {
    let [x, y] = [q.x, q.y].map(|length| tenths(1e3 * length));
    format!("{x}, {y}, {}°", tenths(q.theta.to_degrees()))
}

/// One decimal, without a sign where it is 0.
fn tenths(value: f64) -> String {
    format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0)
}
