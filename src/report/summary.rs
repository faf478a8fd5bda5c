//! The summary: some ten lines for the terminal.
//!
//! It leads with where tiles that start far apart end. That there is no barrier on the way into
//! the bond says little: without any barrier, many starts may run into traps first.

use std::fmt::Write;

use crate::analysis::Analysis;
use crate::configuration::Configuration;
use crate::design::Design;
use crate::landscape::{Barrier, Place, Proportion, State, StateKind};
use crate::report::json::face_names;
use crate::units::si;

/// Traps that are listed one by one.
const LISTED: usize = 4;
/// Significant digits of energies.
const DIGITS: usize = 4;

/// The states that symmetries map onto each other, taken together.
struct Class<'a> {
    /// The copy closest to the bound configuration.
    state: &'a State,
    escape: Option<&'a Barrier>,
    copies: usize,
    /// Share of the far starts that end in any of the copies.
    captured: Proportion,
}

/// The summary of an analysis whose results are in `folder`.
pub fn summary(design: &Design, analysis: &Analysis, folder: &str) -> String {
    let classes = classes(analysis);
    let mut traps: Vec<&Class> = classes
        .iter()
        .filter(|class| class.state.kind == StateKind::Misbound)
        .collect();
    traps.sort_by_key(|class| std::cmp::Reverse(class.captured.count));
    let bond = classes
        .iter()
        .find(|class| class.state.kind == StateKind::Bound);

    let mut text = String::new();
    write_captures(&mut text, design, analysis, bond, &traps);
    write_bond(&mut text, design, analysis, bond);
    write_traps(&mut text, design, &traps);
    write_deepest(&mut text, bond, &traps);
    let _ = writeln!(
        text,
        "results   {folder}: report.json, states.csv, barriers.csv, pathways/, pictures/"
    );
    text
}

fn classes(analysis: &Analysis) -> Vec<Class<'_>> {
    let firsts = analysis.states.iter().filter(|s| s.id == s.class);
    firsts
        .map(|state| {
            let copies: Vec<&State> = analysis
                .states
                .iter()
                .filter(|s| s.class == state.class)
                .collect();
            let count = copies.iter().filter_map(|s| s.capture).map(|c| c.count);
            Class {
                state,
                escape: analysis.escapes[state.id].as_ref(),
                copies: copies.len(),
                captured: Proportion::new(count.sum(), analysis.uncaptured.of),
            }
        })
        .collect()
}

/// Where far starts end.
fn write_captures(
    text: &mut String,
    design: &Design,
    analysis: &Analysis,
    bond: Option<&Class>,
    traps: &[&Class],
) {
    let of = analysis.uncaptured.of;
    let trapped: usize = traps.iter().map(|class| class.captured.count).sum();
    let bound = bond.map_or(0, |class| class.captured.count);
    let [inner, outer] = analysis.ring;
    let _ = writeln!(
        text,
        "{}: of {of} far starts {} end bound, {} in traps, {} nowhere",
        design.name,
        percent(&Proportion::new(bound, of)),
        percent(&Proportion::new(trapped, of)),
        percent(&analysis.uncaptured),
    );
    let _ = writeln!(
        text,
        "          (overdamped, from {inner:.2} to {outer:.2} m away at any angle; in brackets \
         the 95 % interval)"
    );
}

fn write_bond(text: &mut String, design: &Design, analysis: &Analysis, bond: Option<&Class>) {
    let Some(bond) = bond else {
        let energy = si(analysis.bound.1, "J", DIGITS);
        let _ = writeln!(
            text,
            "bond      does not hold: the target faces meet at {energy}, where nothing keeps them"
        );
        return;
    };
    let _ = writeln!(
        text,
        "bond      {} at {}, {}; escape {}{}",
        si(bond.state.energy, "J", DIGITS),
        pose(&bond.state.configuration),
        faces(design, bond),
        escape(bond),
        copies(bond),
    );
    if let Some(way) = bond.escape.filter(|way| way.to == Place::Free) {
        let docking = if way.saddle_energy <= 0.0 {
            "docking   no barrier on the best way from far apart into the bond".to_owned()
        } else {
            format!(
                "docking   over a barrier of {} on the best way from far apart",
                si(way.saddle_energy, "J", DIGITS)
            )
        };
        let _ = writeln!(text, "{docking}");
    }
}

fn write_traps(text: &mut String, design: &Design, traps: &[&Class]) {
    for (row, trap) in traps.iter().take(LISTED).enumerate() {
        let _ = writeln!(
            text,
            "{:<9} {:>4}  {:>10}  escape {:<22}  captures {:<14}  {}, {}{}",
            if row == 0 { "traps" } else { "" },
            trap.state.id,
            si(trap.state.energy, "J", DIGITS),
            escape(trap),
            percent(&trap.captured),
            pose(&trap.state.configuration),
            faces(design, trap),
            copies(trap),
        );
    }
    if traps.len() > LISTED {
        let rest = &traps[LISTED..];
        let deepest = rest.iter().map(|t| t.state.energy).fold(0.0, f64::min);
        let captured: usize = rest.iter().map(|t| t.captured.count).sum();
        let _ = writeln!(
            text,
            "          and {} more, at most {} deep, that capture {} together",
            rest.len(),
            si(deepest, "J", DIGITS),
            percent(&Proportion::new(captured, rest[0].captured.of)),
        );
    }
}

fn write_deepest(text: &mut String, bond: Option<&Class>, traps: &[&Class]) {
    let deepest = traps
        .iter()
        .min_by(|a, b| a.state.energy.total_cmp(&b.state.energy));
    let Some(deepest) = deepest else {
        let _ = writeln!(text, "traps     none");
        return;
    };
    let selectivity = match bond {
        Some(bond) => format!(
            "; selectivity {:.3} (bond over deepest trap)",
            bond.state.energy / deepest.state.energy
        ),
        None => String::new(),
    };
    let _ = writeln!(
        text,
        "deepest   trap {} with {}{selectivity}",
        deepest.state.id,
        si(deepest.state.energy, "J", DIGITS),
    );
}

/// `15.19 mJ to 0`.
fn escape(class: &Class) -> String {
    match class.escape {
        None => "none found".to_owned(),
        Some(way) => {
            let to = match way.to {
                Place::Free => "free".to_owned(),
                Place::State(id) => id.to_string(),
            };
            format!("{} to {to}", si(way.forward(), "J", DIGITS))
        }
    }
}

fn copies(class: &Class) -> String {
    if class.copies > 1 {
        format!(" (x{})", class.copies)
    } else {
        String::new()
    }
}

/// Names of the faces in contact: `east-west`.
fn faces(design: &Design, class: &Class) -> String {
    let pairs: Vec<String> = face_names(design, class.state)
        .iter()
        .map(|pair| pair.join("-"))
        .collect();
    if pairs.is_empty() {
        "not touching".to_owned()
    } else {
        pairs.join(" ")
    }
}

fn pose(q: &Configuration) -> String {
    let [x, y] = [q.x, q.y].map(|length| tenths(1e3 * length));
    format!("({x}, {y}) mm {}°", tenths(q.theta.to_degrees()))
}

/// One decimal, without a sign where it is 0.
fn tenths(value: f64) -> String {
    format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0)
}

/// `56 % (53-59)`, with the interval.
fn percent(proportion: &Proportion) -> String {
    if proportion.of == 0 {
        return "? %".to_owned();
    }
    let whole = |x: f64| (100.0 * x).round();
    format!(
        "{} % ({}-{})",
        whole(proportion.share()),
        whole(proportion.low),
        whole(proportion.high)
    )
}
