//! The READMEs: every command they show runs, the output they show is the command's output, and
//! every link works.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

use crate::program::{stderr, stdout};
use crate::results::{KEPT, analysis};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const FILES: [&str; 3] = ["README.md", "shapes/README.md", "results/README.md"];

/// The program's name in the texts: in a checkout, and on the path.
const CARGO: &str = "cargo run --release -- ";
const NAME: &str = "tilebind ";

fn read(file: &str) -> String {
    fs::read_to_string(Path::new(ROOT).join(file)).unwrap()
}

/// The commands in a text: lines of its blocks for shells, joined where they go on, and spans of
/// code that name a file.
fn commands(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (number, part) in text.split("```").enumerate() {
        if let (1, Some(block)) = (number % 2, part.strip_prefix("sh\n")) {
            let block = block.replace("\\\n", " ");
            found.extend(block.lines().map(|line| line.trim().to_owned()));
        }
        if number % 2 == 0 {
            let spans = part.split('`').skip(1).step_by(2);
            let is_whole = |span: &str| span.contains(".toml") || span.contains(" > ");
            let whole = spans.filter(|span| span.starts_with(NAME) && is_whole(span));
            found.extend(whole.map(str::to_owned));
        }
    }
    found.retain(|line| line.starts_with(NAME) || line.starts_with(CARGO));
    found
}

/// A shortened command: fewer milestones, starts, runs and points, and only one of the swept
/// designs.
fn shortened(command: &str) -> String {
    let words = command.strip_prefix(CARGO).or(command.strip_prefix(NAME));
    let mut words: Vec<&str> = words.unwrap().split_whitespace().collect();
    // Pictures over kT have a separate test.
    if words[0] == "rates" {
        let out = words.iter().position(|word| *word == "--out");
        out.map(|place| words.drain(place..place + 2));
    }
    let mut short: Vec<String> = Vec::new();
    for word in &words {
        let is_design = |word: &str| word.ends_with(".toml");
        if words[0] == "sweep" && is_design(word) && short.iter().any(|w| is_design(w)) {
            continue;
        }
        let counts = ["--runs", "--simulations", "--points"];
        let fewer = word.parse::<usize>().is_ok()
            && short.last().is_some_and(|w| counts.contains(&w.as_str()));
        short.push(match word {
            _ if fewer => "8".to_owned(),
            _ if words[0] == "table" && short.last().is_some_and(|w| w == "--time") => {
                "1".to_owned()
            }
            list if short.last().is_some_and(|w| w == "--kt") => {
                let first = list.split(',').next().unwrap();
                // Strongly shaken tiles leave soon, over passes that coarse meshes resolve.
                if words[0] == "rates" { "8e-3" } else { first }.to_owned()
            }
            word if word.starts_with("--dynamics") => "--dynamics=2".to_owned(),
            word => match word.rsplit_once(':') {
                Some((range, count)) if range.contains('=') && count.parse::<usize>().is_ok() => {
                    format!("{range}:2")
                }
                _ => (*word).to_owned(),
            },
        });
    }
    let quick = match words[0] {
        "analyse" => {
            " --milestones 300 --far-starts 10 --certify-seconds 0.1 --complete-seconds 0 --quiet"
        }
        "compare" | "sweep" => {
            " --milestones 300 --far-starts 10 --certify-cells 300 --complete-cells 0 --quiet"
        }
        "assemble" => " --seconds 2",
        "yield" if words.contains(&"--runs") => " --quiet",
        "yield" => " --runs 8 --quiet",
        _ => "",
    };
    format!("tilebind {}{quick}", short.join(" "))
}

#[test]
fn every_command_of_the_readmes_runs() {
    let folder = with_shapes();
    let mut done = Vec::new();
    for command in FILES.iter().flat_map(|file| commands(&read(file))) {
        let short = shortened(&command);
        if done.contains(&short) {
            continue;
        }
        let output = run(&short, folder.path());
        assert!(
            output.status.success(),
            "{command}\n{short}\n{}",
            stderr(&output)
        );
        done.push(short);
    }
    assert!(done.len() >= 9, "{done:#?}");
}

/// A folder in which commands run as they do in a checkout.
pub fn with_shapes() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("target")).unwrap();
    copy(
        &Path::new(ROOT).join("shapes"),
        &folder.path().join("shapes"),
    );
    folder
}

/// Runs a command line with the program on the path.
pub fn run(command: &str, folder: &Path) -> Output {
    let programs = Path::new(env!("CARGO_BIN_EXE_tilebind")).parent().unwrap();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(
        std::iter::once(programs.to_owned()).chain(std::env::split_paths(&path)),
    );
    Command::new("sh")
        .args(["-c", command])
        .current_dir(folder)
        .env("PATH", path.unwrap())
        .output()
        .unwrap()
}

/// The blocks of output in a text, each with the command that prints it: the first of the block for
/// shells before it.
fn outputs(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut command = None;
    for block in text.split("```").skip(1).step_by(2) {
        if let Some(lines) = block.strip_prefix("sh\n") {
            let lines = lines.replace("\\\n", " ").replace(CARGO, NAME);
            command = lines.lines().next().map(str::to_owned);
        } else if let Some(lines) = block.strip_prefix("text\n") {
            found.push((command.clone().unwrap(), lines.to_owned()));
        }
    }
    found
}

#[test]
fn what_the_readmes_show_is_what_the_program_prints() {
    let shown: Vec<_> = FILES.iter().flat_map(|file| outputs(&read(file))).collect();
    assert!(!shown.is_empty());
    for (command, block) in shown {
        // A kept result, which is what the program gives: see `results.rs`.
        let name = command.rsplit("--out target/").next().unwrap_or_default();
        let kept = Path::new(ROOT)
            .join("results")
            .join(name)
            .join("summary.txt");
        let printed = match KEPT.contains(&name) && command == analysis(name) {
            true => fs::read_to_string(kept).unwrap(),
            false => {
                let output = run(&command, with_shapes().path());
                assert!(output.status.success(), "{command}\n{}", stderr(&output));
                stdout(&output)
            }
        };
        assert_eq!(printed, block, "{command}: made anew by results/make.py");
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let to = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &to);
        } else {
            fs::copy(entry.path(), to).unwrap();
        }
    }
}

#[test]
fn the_readme_is_of_one_sitting() {
    assert!(read("README.md").lines().count() <= 150);
}

/// The targets of links exist.
#[test]
fn links_lead_somewhere() {
    for file in FILES {
        let text = read(file);
        let folder = Path::new(ROOT).join(file);
        for link in text.split("](").skip(1) {
            let (target, _) = link.split_once(')').unwrap();
            let (target, heading) = target.split_once('#').unwrap_or((target, ""));
            let target = folder.parent().unwrap().join(target);
            assert!(target.exists(), "{file}: {}", target.display());
            if !heading.is_empty() {
                let of = |line: &str| {
                    line.trim_matches(['#', ' '])
                        .to_lowercase()
                        .replace(' ', "-")
                };
                let text = std::fs::read_to_string(&target).unwrap();
                let mut headings = text.lines().filter(|line| line.starts_with('#')).map(of);
                assert!(headings.any(|it| it == heading), "{file}: #{heading}");
            }
        }
    }
}

/// Every shipped design is in the list of them.
#[test]
fn no_design_is_forgotten() {
    let [shapes, results] = ["shapes/README.md", "results/README.md"].map(read);
    for entry in fs::read_dir(Path::new(ROOT).join("shapes")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if let Some(stem) = name.strip_suffix(".toml") {
            assert!(shapes.contains(&format!("({name})")), "{name}");
            assert!(results.contains(&format!("`{stem}`")), "{stem}");
        }
    }
}
