//! Output files: which files of the user stay, which are replaced, and that a set is all new or all
//! old.

mod inputs;
mod replaced;
mod single;
#[cfg(unix)]
mod together;
#[cfg(unix)]
mod whole;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::folder::{RECORD, contents};
use crate::program::{command, stderr};

const DESIGN: &str = "shapes/one-face.toml";

/// The program in another folder than the repository's.
fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut program = command(arguments);
    program.current_dir(folder);
    program
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    program(folder, arguments)
        .output()
        .expect("the program starts")
}

fn done(folder: &Path, arguments: &[&str]) {
    let output = run(folder, arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {message}");
    assert!(!leftovers(folder));
}

/// Runs a command that is refused with status 2 and a message that contains all of `said`, and that
/// changes nothing.
fn refused(folder: &Path, arguments: &[&str], said: &[&str]) {
    let before = contents(folder);
    let record = fs::read(folder.join(RECORD)).ok();
    let output = run(folder, arguments);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    for part in said.iter().chain(&["error: ", "help: "]) {
        assert!(
            message.contains(part),
            "{arguments:?}: {part:?} in {message:?}"
        );
    }
    assert!(output.stdout.is_empty());
    assert!(before == contents(folder), "{arguments:?}");
    assert_eq!(fs::read(folder.join(RECORD)).ok(), record, "{arguments:?}");
    assert!(!leftovers(folder));
}

/// Whether something unfinished lies in a folder.
fn leftovers(folder: &Path) -> bool {
    contents(folder)
        .keys()
        .any(|name| name.contains(".partial"))
}

/// Copies files of the repository into a folder.
fn copy(folder: &Path, files: &[(&str, &str)]) {
    for (from, to) in files {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join(from);
        fs::copy(from, folder.join(to)).unwrap();
    }
}

/// Writes files, by their names, into a folder.
fn place(folder: &Path, files: &[(&str, impl AsRef<[u8]>)]) {
    for (name, content) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
}

fn check(folder: &Path, files: &[(&str, &str)]) {
    for (name, content) in files {
        let found = fs::read_to_string(folder.join(name));
        assert_eq!(found.ok().as_deref(), Some(*content), "{name}");
    }
}

fn sha256(content: &[u8]) -> String {
    use sha2::{Digest, Sha256};
    let digest = Sha256::digest(content);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Words of a command line with little to do.
fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

const ANALYSE: &str = "analyse d.toml --milestones 200 --far-starts 5 --certify-seconds 0 \
                       --complete-seconds 0 --quiet --out R";
const DOCK: &str = "dock d.toml --runs 2 --duration 1 --quiet --out R";
const MAKE: &str = "make d.toml --out R";
const COMPARE: &str = "compare d.toml --milestones 200 --far-starts 10 --certify-cells 0 \
                       --complete-cells 0 --quiet --out R";
const SWEEP: &str = "sweep d.toml --vary fixed.mass=0.1,0.2 --milestones 200 --far-starts 10 \
                     --certify-cells 0 --complete-cells 0 --quiet --out R";
const YIELD: &str = "yield d.toml --tiles 4 --time 10 --kt 3e-3 --runs 8 --simulations 0 --quiet \
                     --out R";
const WORDS: &str = "words --length 4 --gap 0.3 --quiet --out R";
const CROSSTALK: &str = "crosstalk w.toml --quiet --out R";
const MATCH: &str = "match d.toml --quiet --out R";
const ASSEMBLE: &str = "assemble lattice --lattice 2x2 --kt 4e-3 --coverage 0.1 --quiet --out R";
/// Refused or begun, but not waited for.
const RATES: &str = "rates d.toml --kt 8e-3 --quiet --out R";

/// A folder with the input files of these commands.
fn desk() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    copy(folder.path(), &[(DESIGN, "d.toml")]);
    let set = "words = [\"NNSN\"]\n";
    place(folder.path(), &[("w.toml", set)]);
    folder
}
