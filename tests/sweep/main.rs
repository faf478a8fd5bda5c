//! `tilebind sweep` as its users see it: the same bytes however the work is divided or broken off.

mod interruptions;
mod mistakes;
mod parts;
mod tables;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

const DESIGN: &str = "shapes/tab-20mm.toml";
const DEPTH: &str = "fixed.faces.east.profile.depth";

/// The least work that still finds the states.
const QUICK: [&str; 6] = [
    "--milestones",
    "500",
    "--far-starts",
    "20",
    "--certify-cells",
    "1000",
];

/// `tilebind sweep` from the root of the repository.
fn sweep(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tilebind"));
    command
        .arg("sweep")
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

fn run(arguments: &[&str]) -> Output {
    sweep(arguments).output().expect("the program starts")
}

/// Standard output of a run that succeeds.
fn done(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(output.stderr.is_empty(), "silent where nobody watches");
    String::from_utf8(output.stdout).expect("output is UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a plain path")
}

/// All files below a folder with their contents, by their names.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(here) = open.pop() {
        for entry in std::fs::read_dir(here).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below").display();
                let content = std::fs::read(&path).expect("a file");
                all.insert(name.to_string(), content);
            }
        }
    }
    all
}

/// The same files with the same bytes.
fn assert_same(one: &Path, other: &Path) {
    let (one, other) = (files(one), files(other));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    for (name, content) in &one {
        assert!(&other[name] == content, "{name} differs");
    }
}
