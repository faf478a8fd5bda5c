//! The commands on one design, and properties of every command: help, mistakes, completions.

mod analyse;
mod assemble;
mod barrier;
mod bond;
mod calibrate;
mod completions;
mod consistency;
mod dynamics;
mod energy;
mod equal;
mod excess;
mod excuses;
mod first_hour;
mod make;
mod mistakes;
mod rates;
mod shields;
mod starting;
mod table;
#[cfg(unix)]
mod terminal;
mod tile_sets;
mod tolerance;
mod words;

use std::process::Output;

use serde_json::Value;

use crate::program::{command, stderr, stdout};

fn tilebind(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the program starts")
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

/// Runs a wrong command: it ends with status 2, its message contains all of `said`, and it prints
/// nothing else.
fn refused(arguments: &[&str], said: &[&str]) {
    let output = tilebind(arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty());
    for part in said {
        assert!(message.contains(part), "{part:?} in {message:?}");
    }
    assert!(!message.contains("panicked"));
}

#[test]
fn every_command_in_the_help_has_an_example() {
    let help = stdout(&tilebind(&["--help"]));
    let listed = help.split("Commands:\n").nth(1).expect("a list");
    // Lines that go on are indented farther.
    let listed = listed.lines().take_while(|line| !line.is_empty());
    let listed = listed.filter(|line| !line.starts_with("   "));
    let commands: Vec<&str> = listed
        .filter_map(|it| it.split_whitespace().next())
        .collect();
    assert!(commands.contains(&"analyse") && commands.contains(&"help"));
    for command in commands.into_iter().filter(|it| *it != "help") {
        let own = stdout(&tilebind(&[command, "--help"]));
        assert!(own.contains("Example"), "{command}: {own}");
    }
}
