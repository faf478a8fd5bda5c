//! The program as its users see it: what it prints, writes and answers.

mod analyse;
mod barrier;
mod calibrate;
mod dynamics;
mod energy;
mod mistakes;
mod shields;
mod starting;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// Runs the program from the root of the repository.
fn tilebind(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tilebind"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("output is UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("messages are UTF-8")
}

/// Standard output of a run that succeeds, as JSON.
fn json(arguments: &[&str]) -> Value {
    let output = tilebind(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("output is JSON")
}

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// All files below a folder, by their names relative to it, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(here) = open.pop() {
        for entry in std::fs::read_dir(here).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                all.push(path.strip_prefix(folder).expect("below").to_owned());
            }
        }
    }
    all.sort();
    all
}

#[test]
fn help_lists_the_commands_and_every_command_has_an_example() {
    let help = stdout(&tilebind(&["--help"]));
    for command in [
        "analyse",
        "energy",
        "barrier",
        "init",
        "schema",
        "completions",
    ] {
        assert!(help.contains(command), "{command} in\n{help}");
        let own = stdout(&tilebind(&[command, "--help"]));
        assert!(own.contains("Example"), "{own}");
    }
}

#[test]
fn completions_name_the_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = tilebind(&["completions", shell]);
        assert_eq!(output.status.code(), Some(0));
        assert!(stdout(&output).contains("analyse"));
    }
}
