//! Failures of the machine: writes that fail at some byte, memory that runs out, a worker that is
//! killed, a clock that jumps. The exit status reports them, and every file is complete or absent.

#![cfg(unix)]

mod clock;
mod killed;
mod limits;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::OnceLock;

use crate::folder::contents;
use crate::program::command;

const DESIGN: &str = "shapes/tab-20mm.toml";

/// The commands that write folders, each with minimal work.
const COMMANDS: [(&str, &[&str]); 4] = [
    (
        "analyse",
        &["--certify-seconds", "0", "--complete-seconds", "0"],
    ),
    ("compare", &["shapes/one-face.toml", NO_BOUNDS, NO_SEARCH]),
    (
        "sweep",
        &[
            "--vary",
            "fixed.faces.east.profile.depth=0.01,0.02",
            NO_BOUNDS,
            NO_SEARCH,
        ],
    ),
    ("dock", &["--runs", "8", "--duration", "1"]),
];

const NO_BOUNDS: &str = "--certify-cells=0";
const NO_SEARCH: &str = "--complete-cells=0";

/// Options for a short survey; docking has none.
const SHORT: [&str; 4] = ["--milestones", "200", "--far-starts", "10"];

/// A command's arguments, with its results going to a folder.
fn arguments<'a>(name: &'a str, more: &[&'a str], out: &'a Path) -> Vec<&'a str> {
    let out = out.to_str().expect("a plain path");
    let survey = if name == "dock" { &[] } else { &SHORT[..] };
    let threads = ["--threads", "1", "--quiet", "--out", out];
    [&[name, DESIGN], more, survey, &threads[..]].concat()
}

/// The command under a shell that first runs a preparation.
fn after(preparation: &str, arguments: &[&str]) -> Output {
    let program = command(&[]);
    Command::new("sh")
        .args(["-c", &format!("{preparation}; exec \"$0\" \"$@\"")])
        .arg(program.get_program())
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("a shell")
}

/// The files of one of the commands without any fault.
fn undisturbed(name: &str, more: &[&str]) -> &'static BTreeMap<String, Vec<u8>> {
    static ONCE: [OnceLock<BTreeMap<String, Vec<u8>>>; COMMANDS.len()] =
        [const { OnceLock::new() }; COMMANDS.len()];
    let number = COMMANDS.iter().position(|one| one.0 == name);
    ONCE[number.expect("one of the commands")].get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let output = command(&arguments(name, more, folder.path()))
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{name}: {output:?}");
        contents(folder.path())
    })
}

/// Asserts that every file of a folder is one of the expected ones, and complete: times differ
/// between runs, endings do not. Returns the number of files.
fn assert_whole(folder: &Path, expected: &BTreeMap<String, Vec<u8>>) -> usize {
    let found = match folder.exists() {
        true => contents(folder),
        false => BTreeMap::new(),
    };
    let ending = |content: &[u8]| content[content.len().saturating_sub(6)..].to_vec();
    for (name, content) in &found {
        let whole = expected
            .get(name)
            .unwrap_or_else(|| panic!("{name} is not a result"));
        // The outcome of a sweep's point may differ if memory is short.
        let is_whole = match name.ends_with(".json") {
            true => serde_json::from_slice::<serde_json::Value>(content).is_ok(),
            false => ending(content) == ending(whole),
        };
        assert!(is_whole, "{name} is not whole");
    }
    found.len()
}
