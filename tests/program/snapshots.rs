//! What commands print and write, down to the byte: every number, sentence and picture.
//!
//! `snapshots.sha256` has a digest of every output. Where a change of outputs is meant, look at the
//! files that the failing test names (before and after the change), then run it with
//! `TILEBIND_SNAPSHOTS=keep` to keep the new digests. The digests are the same on every machine, as
//! outputs are.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use tilebind::checksum::sha256;

use crate::folder::contents;
use crate::program::{stderr, stdout};
use crate::readme::{run, with_shapes};

/// Commands that between them use every kind of output, with the effort that this takes.
const COMMANDS: &str = include_str!("snapshots.sh");

const KEPT: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/program/snapshots.sha256"
);

/// The outputs of a command by name: its standard output, and its files, without the times that
/// some of them contain.
fn outputs(command: &str, folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let output = run(command, folder);
    assert!(output.status.success(), "{command}\n{}", stderr(&output));
    let mut all = BTreeMap::from([("standard output".to_owned(), stdout(&output).into_bytes())]);
    let mut words = command
        .split_whitespace()
        .skip_while(|word| *word != "--out");
    if let Some(out) = words.nth(1).map(|out| folder.join(out)) {
        match out.is_dir() {
            true => all.extend(contents(&out)),
            false => drop(all.insert("file".to_owned(), fs::read(&out).expect("a file"))),
        }
    }
    for (name, content) in &mut all {
        if let (true, Ok(text)) = (name.ends_with(".json"), std::str::from_utf8(content)) {
            *content = without_times(text).into_bytes();
        }
    }
    all
}

/// JSON without the lines of wall times and of threads.
fn without_times(text: &str) -> String {
    let varies = |line: &&str| {
        ["wall_s", "core_s_per", "\"threads\""]
            .iter()
            .any(|it| line.contains(it))
    };
    let lines = text.lines().filter(|line| !varies(line));
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn what_commands_print_and_write_is_as_before() {
    let folder = with_shapes();
    let mut found = String::new();
    let lines = COMMANDS.replace("\\\n", " ");
    let commands = lines.lines().filter(|line| line.starts_with("tilebind "));
    for command in commands {
        let command = command.split_whitespace().collect::<Vec<_>>().join(" ");
        writeln!(found, "{command}").expect("text");
        for (name, content) in outputs(&command, folder.path()) {
            writeln!(found, "    {} {name}", sha256(&content)).expect("text");
        }
    }
    if std::env::var("TILEBIND_SNAPSHOTS").is_ok_and(|word| word == "keep") {
        fs::write(KEPT, &found).expect("written");
    }
    let kept = fs::read_to_string(KEPT).expect("digests");
    if found == kept {
        return;
    }
    let kept: Vec<&str> = kept.lines().collect();
    let mut command = "";
    let mut differing = Vec::new();
    for line in found.lines() {
        if !line.starts_with(' ') {
            command = line;
        }
        if !kept.contains(&line) {
            differing.push(format!("{command}: {}", line.trim()));
        }
    }
    panic!(
        "outputs differ (they are in {}):\n{}",
        folder.keep().display(),
        differing.join("\n")
    );
}
