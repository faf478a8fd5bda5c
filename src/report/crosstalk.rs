//! Crosstalk: the attraction of every two words over all poses.

use std::fmt::Write;

use serde_json::{Value, json};

use super::csv::table;
use super::files::{Files, with_report};
use super::json as layout;
use super::page::Page;
use super::values::{pose, positive_zero};
use super::words::name;
use jobs::design::WordSet;
use physics::configuration::Configuration;
use physics::order::Order;
use physics::units::si;
use physics::words::crosstalk::Crosstalk;

/// What is written, for the terminal.
pub const FILES: &str = "report.html to look at; crosstalk.csv, report.json";

/// What `--json` prints.
pub fn json(set: &WordSet, found: &Crosstalk) -> String {
    layout::text(&value(set, found))
}

fn value(set: &WordSet, found: &Crosstalk) -> Value {
    let numbers = |matrix: &[Vec<f64>]| -> Value {
        let row =
            |row: &Vec<f64>| json!(row.iter().copied().map(positive_zero).collect::<Vec<_>>());
        matrix.iter().map(row).collect()
    };
    let poses = found
        .poses
        .iter()
        .map(|row| json!(row.iter().map(pose).collect::<Vec<_>>()));
    json!({
        "tilebind": env!("CARGO_PKG_VERSION"),
        "words": found.words.iter().map(ToString::to_string).collect::<Vec<_>>(),
        // Rows and columns: words, then their mates.
        "faces": faces(found),
        // Where the places of the words lie along the face, if not a pitch apart.
        "places_m": set.places,
        "strongest_J": numbers(&found.strongest),
        "lower_J": found.lower.as_ref().map(|lower| numbers(lower)),
        "poses": poses.collect::<Value>(),
        // Of each word and its own mate the deepest meeting found that holds beside the bond.
        "traps_J": found.traps.iter()
            .map(|trap| json!(trap.map(|trap| positive_zero(trap.0))))
            .collect::<Value>(),
        "trap_poses": found.traps.iter()
            .map(|trap| json!(trap.map(|trap| pose(&trap.1))))
            .collect::<Value>(),
        "bond_J": found.weakest_bond().map(|bond| -bond.1),
        "gap": found.gap(),
        "model": set.stage.interaction.model.name(),
        "pitch_m": set.stage.pitch,
        // Whether all lower bounds are as close as asked for.
        "settled": found.lower.as_ref().map(|_| found.settled),
        "cells": found.cells,
    })
}

/// The codes of all faces, in the order of rows and columns.
pub(super) fn faces(found: &Crosstalk) -> Vec<String> {
    let words = found.words.iter().copied();
    words
        .clone()
        .chain(words.map(|word| word.mate()))
        .map(|word| word.to_string())
        .collect()
}

/// The name of a face: `A`, or `A*` of a mate.
pub(super) fn face_name(set: &WordSet, found: &Crosstalk, face: usize) -> String {
    let word = |k: usize| set.names.get(k).cloned().unwrap_or_else(|| name(k));
    match face.checked_sub(found.words.len()) {
        Some(mate) => word(mate) + "*",
        None => word(face),
    }
}

/// Whether two faces are a word and its own mate.
pub(super) fn is_bond(found: &Crosstalk, first: usize, second: usize) -> bool {
    first.abs_diff(second) == found.words.len()
}

/// Every two faces.
fn pairs(found: &Crosstalk) -> impl Iterator<Item = (usize, usize)> {
    let n = found.strongest.len();
    (0..n).flat_map(move |i| (i..n).map(move |j| (i, j)))
}

/// The first sentence: the gap over all poses, how sure, the weakest bond and the strongest wrong
/// meeting.
pub fn headline(set: &WordSet, found: &Crosstalk) -> String {
    let many = match found.words.len() {
        1 => "1 word".to_owned(),
        m => format!("{m} words"),
    };
    let (Some((weakest, bond)), Some(gap)) = (found.weakest_bond(), found.gap()) else {
        return format!("{many}, of which one does not bind its mate");
    };
    let proof = match &found.lower {
        Some(lower) => {
            let others = pairs(found).filter(|(i, j)| !is_bond(found, *i, *j));
            let deepest = others.map(|(i, j)| lower[i][j]).fold(0.0, f64::min);
            let proved = 1.0 - deepest / bond;
            format!("; proved at least {proved:.4} but for words on their own mates")
        }
        None => String::new(),
    };
    let wrong = match found.strongest_wrong() {
        Some(([i, j], energy, q)) if energy < 0.0 => format!(
            "strongest wrong meeting {}: {} on {}{} at {}",
            si(-energy, "J", 4),
            face_name(set, found, i),
            face_name(set, found, j),
            if is_bond(found, i, j) {
                ", a trap,"
            } else {
                ""
            },
            told(&q)
        ),
        _ => "nothing wrong attracts".to_owned(),
    };
    format!(
        "{many}: gap {gap:.4} over sampled poses{proof}; weakest bond {} ({}); {wrong}",
        si(-bond, "J", 4),
        face_name(set, found, weakest),
    )
}

/// What the terminal is told.
pub fn summary(set: &WordSet, found: &Crosstalk) -> String {
    let mut text = headline(set, found) + ".\n";
    let proved = found.lower.as_ref().map_or("", |_| "   proved below");
    let _ = writeln!(text, "\nstrongest wrong meetings{proved:>42}");
    let mut wrong: Vec<(usize, usize)> = pairs(found)
        .filter(|(i, j)| !is_bond(found, *i, *j))
        .collect();
    wrong.order_by(|a, b| found.strongest[a.0][a.1].total_cmp(&found.strongest[b.0][b.1]));
    for (i, j) in wrong.into_iter().take(LISTED) {
        let q = found.poses[i][j];
        let names = format!(
            "{} on {}",
            face_name(set, found, i),
            face_name(set, found, j)
        );
        let energy = si(found.strongest[i][j], "J", 4);
        let place = told(&q);
        let lower = found
            .lower
            .as_ref()
            .map_or(String::new(), |lower| si(lower[i][j], "J", 4));
        let _ = writeln!(text, "  {names:<10}{energy:>12}   {place:<30}{lower:>12}");
    }
    text + "A word and its own mate also hold where a trap is; traps are found, not proved.\n"
}

/// A pose for the terminal.
fn told(q: &Configuration) -> String {
    // No minus of what rounds to nothing.
    let tenth = |x: f64| (10.0 * x).round() / 10.0 + 0.0;
    let [x, y, theta] = [1e3 * q.x, 1e3 * q.y, q.theta.to_degrees()].map(tenth);
    format!("{x:.1}, {y:.1} mm, {theta:.1} deg")
}

/// Meetings that the terminal lists.
const LISTED: usize = 5;

/// All files, made by `command`.
pub fn files(set: &WordSet, found: &Crosstalk, command: &str) -> Files {
    let page = Page::of_crosstalk(set, found);
    with_report(tables(set, found), Some(page), &value(set, found), command)
}

/// The tables.
pub(super) fn tables(set: &WordSet, found: &Crosstalk) -> Files {
    let table = csv(set, found).into_bytes();
    Files::from([("crosstalk.csv".to_owned(), table)])
}

fn csv(set: &WordSet, found: &Crosstalk) -> String {
    let codes = faces(found);
    let rows = pairs(found).map(|(i, j)| {
        let [x, y, theta] = pose(&found.poses[i][j]);
        let lower = found
            .lower
            .as_ref()
            .map_or(String::new(), |lower| lower[i][j].to_string());
        vec![
            face_name(set, found, i),
            face_name(set, found, j),
            codes[i].clone(),
            codes[j].clone(),
            lower,
            positive_zero(found.strongest[i][j]).to_string(),
            x.to_string(),
            y.to_string(),
            theta.to_string(),
            if is_bond(found, i, j) {
                "bond"
            } else {
                "wrong"
            }
            .to_owned(),
        ]
    });
    let traps = found.traps.iter().enumerate().filter_map(|(i, trap)| {
        let (energy, q) = (*trap)?;
        let j = i + found.words.len();
        let [x, y, theta] = pose(&q).map(|x| x.to_string());
        Some(vec![
            face_name(set, found, i),
            face_name(set, found, j),
            codes[i].clone(),
            codes[j].clone(),
            String::new(),
            positive_zero(energy).to_string(),
            x,
            y,
            theta,
            "trap".to_owned(),
        ])
    });
    let header = [
        "first",
        "second",
        "first_code",
        "second_code",
        "lower_J",
        "upper_J",
        "x_m",
        "y_m",
        "theta_rad",
        "meeting",
    ];
    table(header.map(str::to_owned), rows.chain(traps))
}
