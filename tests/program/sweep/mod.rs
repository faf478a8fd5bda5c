//! `tilebind sweep`: the same bytes however the work is divided or interrupted.

mod axes;
mod interruptions;
mod mistakes;
mod parts;
mod records;
mod search;
mod tables;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

use crate::folder::contents;
use crate::program::{command, stderr, stdout};

const DESIGN: &str = "shapes/tab-20mm.toml";
const DEPTH: &str = "fixed.faces.east.profile.depth";

/// The smallest effort that still finds the states.
const QUICK: [&str; 8] = [
    "--milestones",
    "500",
    "--far-starts",
    "20",
    "--certify-cells",
    "1000",
    "--complete-cells",
    "0",
];

fn sweep(arguments: &[&str]) -> Command {
    command(&[&["sweep"], arguments].concat())
}

fn run(arguments: &[&str]) -> Output {
    sweep(arguments).output().expect("the program starts")
}

/// Standard output of a run that succeeds.
fn done(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // If the output is not a terminal, only long sweeps report their progress now and then.
    let said = stderr(&output);
    assert!(said.lines().all(|line| line.contains(" points")), "{said}");
    stdout(&output)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a plain path")
}

/// The same files with the same bytes.
fn assert_same(one: &Path, other: &Path) {
    let (one, other) = (contents(one), contents(other));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    for (name, content) in &one {
        assert!(&other[name] == content, "{name} differs");
    }
}
