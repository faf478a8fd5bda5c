//! The completions that a shell offers after `tilebind completions`.

use std::process::Command;

use super::tilebind;
use crate::program::{stderr, stdout};

#[test]
fn completions_name_the_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = tilebind(&["completions", shell]);
        assert_eq!(output.status.code(), Some(0));
        assert!(stdout(&output).contains("analyse"));
    }
}

/// Completes the last of the words given to this script and prints what is offered, one a line.
const COMPLETE: &str = r#"
source "$1"; shift
function=$(complete -p tilebind | sed 's/.*-F \([^ ]*\).*/\1/')
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=()
compopt() { :; }
"$function" tilebind "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\n' "${COMPREPLY[@]}"
"#;

#[test]
fn bash_offers_commands_options_words_and_files() {
    if Command::new("bash").arg("--version").output().is_err() {
        eprintln!("skipped: no bash");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("completions");
    std::fs::write(&file, tilebind(&["completions", "bash"]).stdout).unwrap();
    let offered = |words: &[&str]| -> Vec<String> {
        let output = Command::new("bash")
            .args(["--norc", "-c", COMPLETE, "bash"])
            .arg(&file)
            .arg("tilebind")
            .args(words)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        assert!(output.stderr.is_empty(), "{}", stderr(&output));
        stdout(&output).lines().map(str::to_owned).collect()
    };
    assert_eq!(offered(&["ba"]), ["barrier"]);
    assert_eq!(offered(&["dock", "--no-w"]), ["--no-walls"]);
    let words = ["dipole", "cuboid"];
    for command in ["analyse", "energy", "compare", "calibrate"] {
        assert_eq!(offered(&[command, "a.toml", "--model", ""]), words);
    }
    assert_eq!(
        offered(&["compare", "--by", "sel"]),
        ["selectivity"],
        "figures to rank by"
    );
    assert_eq!(offered(&["sweep", "--run", "Cargo.t"]), ["Cargo.toml"]);
    // No completions of its own: the shell's names of files or folders follow.
    assert_eq!(offered(&["energy", "shap"]), [""]);
    assert_eq!(offered(&["energy", ""]), [""]);
    assert_eq!(offered(&["energy", "a.toml", ""]), [""]);
    assert_eq!(offered(&["analyse", "a.toml", "--out", ""]), [""]);
    // No file is a number.
    assert_eq!(offered(&["analyse", "a.toml", "--seed", ""]), [""]);
}
