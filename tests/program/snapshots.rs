//! What commands print and write, down to the byte: every number, sentence and picture.
//!
//! `snapshots.sha256` has a digest of every output, which is the same on every machine, and the folder
//! `snapshots` the texts of what is printed and of `report.json`, of which a failing test shows the lines
//! that differ. Where a change of outputs is meant, look at what the test names (before and after the
//! change), then run it with `TILEBIND_SNAPSHOTS=keep` to keep the new outputs.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use tilebind::checksum::sha256;

use crate::folder::contents;
use crate::program::{stderr, stdout};
use crate::readme::{run, with_shapes};

const HERE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program");
/// Differing lines shown of a text.
const SHOWN: usize = 20;

/// One test a command; between them they use every kind of output. A command may need the files of
/// another one.
macro_rules! snapshots {
    ($($name:ident $(after $other:ident)?: $command:literal,)*) => {
        $(
            #[test]
            fn $name() {
                let command = |name: &str| COMMANDS.iter().find(|it| it.0 == name).expect("a command").1;
                let folder = with_shapes();
                $(outputs(command(stringify!($other)), folder.path());)?
                check(stringify!($name), command(stringify!($name)), folder.path());
            }
        )*

        const COMMANDS: &[(&str, &str)] = &[$((stringify!($name), concat!("tilebind ", $command)),)*];
    };
}

snapshots! {
    // Analyses: dipoles and blocks, docking, certificates, moving tiles, figures for print.
    dipoles: "analyse shapes/paper-tile.toml --milestones 120 --far-starts 5 --certify-cells 2000 \
        --complete-cells 2000 --dynamics=20 --out target/dipoles",
    blocks: "analyse shapes/tab-20mm.toml --model cuboid --milestones 80 --far-starts 4 \
        --certify-cells 500 --complete-cells 500 --figure-width 85mm --figure-font 8 \
        --figure-panels --out target/blocks",
    compared: "compare shapes/tab-20mm.toml shapes/tab-10mm.toml shapes/wrong-partner.toml --milestones \
        80 --far-starts 4 --certify-cells 300 --complete-cells 300 --out target/compare",
    swept: "sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0.01:0.03:3 --milestones \
        80 --far-starts 4 --certify-cells 200 --complete-cells 0 --baseline depth=0.01 --out \
        target/sweep",
    swept_twice: "sweep shapes/tab-20mm.toml --vary fixed.faces.east.profile.depth=0.01,0.03 --vary \
        magnet.inset=0,0.003 --milestones 60 --far-starts 3 --certify-cells 100 --complete-cells \
        0 --out target/sweep-2",
    barrier: "barrier shapes/tab-10mm.toml --from 0.43,0,0 --to 0.9,0,0 --tolerance 1e-4",
    energy: "energy shapes/halbach.toml --pose 0.43,0,0 --pose 0.5,0.1,0.3",
    fits: "match shapes/dogleg.toml --out target/match",
    fits_as_json: "match shapes/dogleg.toml --json",
    shown: "show shapes/hexagon.toml",
    drawn: "show shapes/hexagon.toml --out target/hexagon.svg",
    shown_as_json: "show shapes/shielded-backs.toml --json",
    made: "make shapes/dovetail.toml --kerf 0.2mm --out target/workshop",
    started: "init target/mine.toml --sides 6 --side 12cm --magnets 3 --shape arc",
    // Rates and what is built on them.
    bond: "bond shapes/tab-20mm.toml --kt 2e-3 --coverage 0.3 --out target/bond",
    exit: "rates shapes/paper-tile.toml --kt 8e-3 --start 0.43,-0.04,0 --out target/exit",
    rates: "rates shapes/paper-tile.toml --kt 1.2e-2 --traps 1 --out target/rates",
    yields: "yield shapes/paper-tile.toml --tiles 10 --time 600 --kt 3e-3,4e-3 --runs 8 --simulations \
        100 --out target/yield",
    docking: "dock shapes/paper-tile.toml --runs 400 --out target/dock",
    table: "table shapes/paper-tile.toml --count 3,3 --time 3 --runs 2 --shaking 3e-3 --drag 0.5 \
        --frames 0.5 --out target/table",
    // Words and tile sets.
    words: "words --length 6 --gap 0.4 --out target/words",
    frontier: "words --length 6",
    polar_words: "words --length 8 --gap 0.5 --shape polar --flip --json",
    slots: "words --slots 12 --magnets 4 --pitch 0.015 --count 3 --seconds 1 --out target/slots",
    anywhere: "words --continuous --magnets 4 --pitch 0.02 --count 3 --seconds 1 --out target/continuous",
    crosstalk after words: "crosstalk target/words/words.toml --out target/crosstalk",
    lattice: "assemble lattice --lattice 2x2 --kt 7e-3 --coverage 0.1 --seconds 1 --out target/lattice",
    crosstalk_certified after words: "crosstalk target/words/words.toml --certify --json",
    sierpinski: "assemble shapes/assemblies/sierpinski.yaml --length 8 --kt 5.4e-3 --coverage 0.1 --out \
        target/sierpinski",
}

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

/// Checks the outputs of a command against what is kept, or keeps them.
fn check(name: &str, command: &str, folder: &Path) {
    let found = outputs(command, folder);
    let mut digests = format!("{command}\n");
    for (name, content) in &found {
        writeln!(digests, "    {} {name}", sha256(content)).expect("text");
    }
    if std::env::var("TILEBIND_SNAPSHOTS").is_ok_and(|word| word == "keep") {
        keep(command, &digests);
        for (path, text) in texts(name, &found) {
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            fs::write(path, text).expect("written");
        }
        return;
    }
    let kept = section(
        &fs::read_to_string(digest_file()).expect("digests"),
        command,
    )
    .join("\n")
        + "\n";
    if digests == kept {
        return;
    }
    let mut told = differences(&kept, &digests, &digest_file(), usize::MAX);
    for (path, text) in texts(name, &found) {
        let before = fs::read_to_string(&path).unwrap_or_default();
        told += &differences(&before, text, &path, SHOWN);
    }
    let all = std::env::temp_dir().join(format!("tilebind-snapshot-{name}"));
    for (name, content) in &found {
        let path = all.join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, content).expect("written");
    }
    panic!(
        "{command}: outputs differ (they are in {})\n{told}",
        all.display()
    );
}

fn digest_file() -> PathBuf {
    Path::new(HERE).join("snapshots.sha256")
}

/// The lines of a command among all digests.
fn section<'a>(all: &'a str, command: &str) -> Vec<&'a str> {
    let mut lines = all.lines().skip_while(|line| *line != command);
    let first = lines.next();
    first
        .into_iter()
        .chain(lines.take_while(|line| line.starts_with(' ')))
        .collect()
}

/// Keeps the digests of a command among those of the others, in the order of the commands.
fn keep(command: &str, digests: &str) {
    static FILE: Mutex<()> = Mutex::new(());
    let _guard = FILE.lock();
    let kept = fs::read_to_string(digest_file()).unwrap_or_default();
    let all = COMMANDS.iter().map(|(_, other)| match *other == command {
        true => digests.to_owned(),
        false => section(&kept, other)
            .into_iter()
            .map(|line| format!("{line}\n"))
            .collect(),
    });
    fs::write(digest_file(), all.collect::<String>()).expect("written");
}

/// The outputs of a command whose text is kept, with their files.
fn texts<'a>(name: &str, found: &'a BTreeMap<String, Vec<u8>>) -> Vec<(PathBuf, &'a str)> {
    let kept = [("standard output", "txt"), ("report.json", "json")];
    let text = |(output, ending): (&str, &str)| {
        let text = std::str::from_utf8(found.get(output)?).ok()?;
        let path = Path::new(HERE).join(format!("snapshots/{name}.{ending}"));
        Some((path, text))
    };
    kept.into_iter().filter_map(text).collect()
}

/// The lines that two texts do not share, if there are any; at most so many of each.
fn differences(before: &str, now: &str, path: &Path, most: usize) -> String {
    let only = |sign: char, text: &str, other: &str| -> Vec<String> {
        let mut others: Vec<&str> = other.lines().collect();
        let lines = text
            .lines()
            .filter(|line| match others.iter().position(|it| it == line) {
                Some(place) => {
                    others.remove(place);
                    false
                }
                None => true,
            });
        lines.map(|line| format!("{sign} {line}\n")).collect()
    };
    let lines = [only('-', before, now), only('+', now, before)];
    if lines.concat().is_empty() {
        return String::new();
    }
    let more = |lines: &Vec<String>| lines.iter().take(most).cloned().collect::<String>();
    format!(
        "{}:\n{}{}",
        path.display(),
        more(&lines[0]),
        more(&lines[1])
    )
}

#[test]
fn differing_lines_are_shown() {
    let told = differences("a\nb\nb\n", "b\nc\n", Path::new("x"), SHOWN);
    assert_eq!(told, "x:\n- a\n- b\n+ c\n");
    assert_eq!(differences("a\n", "a\n", Path::new("x"), SHOWN), "");
}
