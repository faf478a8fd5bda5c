//! Crosstalk: the attraction of every two words over all poses.

use std::fmt::Write;

use serde_json::{Value, json};

use super::csv::table;
use super::files::{Files, REPORT};
use super::json as layout;
use super::values::{pose, positive_zero};
use super::words::name;
use crate::checksum::sha256;
use crate::units::si;
use crate::words::crosstalk::Crosstalk;

/// What `--json` prints.
pub fn json(found: &Crosstalk) -> String {
    layout::text(&value(found))
}

fn value(found: &Crosstalk) -> Value {
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
        "strongest_J": numbers(&found.strongest),
        "lower_J": found.lower.as_ref().map(|lower| numbers(lower)),
        "poses": poses.collect::<Value>(),
        // Whether all lower bounds are as close as asked for.
        "settled": found.lower.as_ref().map(|_| found.settled),
        "cells": found.cells,
    })
}

/// The codes of all faces, in the order of rows and columns.
fn faces(found: &Crosstalk) -> Vec<String> {
    let words = found.words.iter().copied();
    words
        .clone()
        .chain(words.map(|word| word.mate()))
        .map(|word| word.to_string())
        .collect()
}

/// The name of a face: `A`, or `A*` of a mate.
fn face_name(found: &Crosstalk, face: usize) -> String {
    match face.checked_sub(found.words.len()) {
        Some(mate) => name(mate) + "*",
        None => name(face),
    }
}

/// Whether two faces are a word and its own mate.
fn is_bond(found: &Crosstalk, first: usize, second: usize) -> bool {
    first.abs_diff(second) == found.words.len()
}

/// Every two faces.
fn pairs(found: &Crosstalk) -> impl Iterator<Item = (usize, usize)> {
    let n = found.strongest.len();
    (0..n).flat_map(move |i| (i..n).map(move |j| (i, j)))
}

/// What the terminal is told.
pub fn summary(found: &Crosstalk) -> String {
    let strength = |&(i, j): &(usize, usize)| found.strongest[i][j];
    let lowest = |a: &(usize, usize), b: &(usize, usize)| strength(a).total_cmp(&strength(b));
    let bonds = pairs(found).filter(|(i, j)| is_bond(found, *i, *j));
    let wrong = pairs(found).filter(|(i, j)| !is_bond(found, *i, *j));
    let told = |(i, j): (usize, usize)| {
        let q = found.poses[i][j];
        let bound = found.lower.as_ref().map_or(String::new(), |lower| {
            format!(" (no stronger than {}, proved)", si(-lower[i][j], "J", 4))
        });
        format!(
            "{} on {} {}{bound} at {:.1}, {:.1} mm, {:.1} deg",
            face_name(found, i),
            face_name(found, j),
            si(-found.strongest[i][j], "J", 4),
            1e3 * q.x,
            1e3 * q.y,
            q.theta.to_degrees() + 0.0
        )
    };
    let mut text = String::new();
    let weakest = bonds.max_by(lowest);
    let strongest = wrong.min_by(lowest);
    if let (Some(bond), Some(wrong)) = (weakest, strongest) {
        let gap = 1.0 - (found.strongest[wrong.0][wrong.1] / found.strongest[bond.0][bond.1]);
        let proof = match &found.lower {
            Some(lower) => {
                let deepest = pairs(found)
                    .filter(|(i, j)| !is_bond(found, *i, *j))
                    .map(|(i, j)| lower[i][j])
                    .fold(0.0, f64::min);
                let proved = 1.0 - deepest / found.strongest[bond.0][bond.1];
                format!("gap {gap:.4} over all poses, at least {proved:.4} proved")
            }
            None => format!("gap {gap:.4} over sampled poses"),
        };
        let _ = writeln!(text, "{} words: {proof}.", found.words.len());
        let _ = writeln!(text, "Weakest bond:            {}", told(bond));
        let _ = writeln!(text, "Strongest wrong meeting: {}", told(wrong));
    }
    text +=
        "Between a word and its own mate the bond is told; what else holds them are its traps.\n";
    text
}

/// All files.
pub fn files(found: &Crosstalk) -> Files {
    let mut files = Files::new();
    files.insert("crosstalk.csv".to_owned(), csv(found).into_bytes());
    let mut report = value(found);
    let sums = files
        .iter()
        .map(|(name, bytes)| (name.clone(), sha256(bytes).into()));
    report["files"] = Value::Object(sums.collect());
    files.insert(REPORT.to_owned(), layout::text(&report).into_bytes());
    files
}

fn csv(found: &Crosstalk) -> String {
    let codes = faces(found);
    let rows = pairs(found).map(|(i, j)| {
        let [x, y, theta] = pose(&found.poses[i][j]);
        let lower = found
            .lower
            .as_ref()
            .map_or(String::new(), |lower| lower[i][j].to_string());
        vec![
            face_name(found, i),
            face_name(found, j),
            codes[i].clone(),
            codes[j].clone(),
            lower,
            positive_zero(found.strongest[i][j]).to_string(),
            x.to_string(),
            y.to_string(),
            theta.to_string(),
        ]
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
    ];
    table(header.map(str::to_owned), rows)
}
