//! Several processes that write into one folder at the same time.

use std::process::Stdio;

use super::*;

/// Sweeps at the same time.
const TOGETHER: usize = 5;

/// Starts all command lines at once, and waits for them.
fn at_once(folder: &Path, lines: &[String]) -> Vec<Output> {
    let start = |line: &String| {
        let mut program = program(folder, &words(line));
        program.stdout(Stdio::piped()).stderr(Stdio::piped());
        program.spawn().unwrap()
    };
    let started: Vec<_> = lines.iter().map(start).collect();
    let waits = started
        .into_iter()
        .map(|child| child.wait_with_output().unwrap());
    waits.collect()
}

#[test]
fn sweeps_in_one_folder_do_not_disturb_each_other() {
    let desk = desk();
    let here = desk.path();
    let quick = "--milestones 20 --far-starts 0 --kinds 1 --certify-cells 0 --complete-cells 0 --threads 1 \
                 --quiet --out";
    let line = |k: usize, out: &str| {
        let low = k + 1;
        format!("sweep d.toml --vary fixed.mass=0.{low},0.9 {quick} {out}")
    };
    let alone: Vec<_> = (0..TOGETHER)
        .map(|k| {
            done(here, &words(&line(k, "alone")));
            let alone = contents(&here.join("alone"));
            fs::remove_dir_all(here.join("alone")).unwrap();
            alone
        })
        .collect();
    for round in 0..3 {
        let lines: Vec<String> = (0..TOGETHER).map(|k| line(k, "R")).collect();
        for output in at_once(here, &lines) {
            let message = stderr(&output);
            assert_eq!(output.status.code(), Some(0), "round {round}: {message}");
        }
        // The files are those that one of them alone would have written, and the points of all.
        let found = contents(&here.join("R"));
        let is_there = |(name, content)| found.get(name) == Some(content);
        assert!(
            alone.iter().any(|one| one.iter().all(is_there)),
            "round {round}"
        );
        assert!(!leftovers(here));
        fs::remove_dir_all(here.join("R")).unwrap();
    }
}

#[test]
fn of_sets_that_come_at_once_one_is_there_as_a_whole() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    let lines: Vec<String> = (0..8).map(|k| format!("{MAKE} --kerf 0.000{k}")).collect();
    let sets: Vec<_> = lines
        .iter()
        .map(|line| {
            done(here, &words(line));
            contents(&out)
        })
        .collect();
    for _ in 0..10 {
        fs::remove_dir_all(&out).unwrap();
        for output in at_once(here, &lines) {
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        }
        let found = contents(&out);
        assert!(sets.contains(&found));
    }
}

/// If different commands write to one folder, the second one to use a name is refused.
#[test]
fn commands_that_clash_are_refused_and_others_stand_beside() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    let lines = [MAKE, DOCK, WORDS, CROSSTALK, ASSEMBLE, ANALYSE].map(str::to_owned);
    for _ in 0..3 {
        let outputs = at_once(here, &lines);
        let done = |output: &&Output| output.status.code() == Some(0);
        for output in outputs.iter().filter(|output| !done(output)) {
            assert_eq!(output.status.code(), Some(2), "{}", stderr(output));
            assert!(
                stderr(output).contains("is a result of"),
                "{}",
                stderr(output)
            );
        }
        assert!(outputs.iter().filter(done).count() >= 1);
        assert!(!leftovers(here));
        fs::remove_dir_all(&out).unwrap();
    }
}

/// Leftovers of a killed process are removed; files that only look like them are kept, as are those
/// of others beside leftovers.
#[test]
fn leftovers_of_killed_processes_go() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    let mine = [
        (".tilebind-notes.partial", "mine"),
        (".tilebind-1.partial", "mine"),
        (".tilebind-1-2-3.partial/a", "mine"),
        (".mine.partial/a", "mine"),
        (".tilebind-5000000-0.partial/7", "mine"),
        (".tilebind-5000000-0.partial/new/sheet.md", "mine"),
        (".tilebind-5000000-1.partial/0", "tilebinds"),
        (".tilebind-4000000-1.partial/old/mine", "mine"),
        (".tilebind-4000000-1.partial/gone/sheet.md", "mine"),
    ];
    let left = [
        (".tilebind-4000000-0.partial/0", "tilebind"),
        (".tilebind-4000000-0.partial/new/pictures/a", "lef"),
        (".tilebind-4000000-0.partial/during", "{"),
        (".tilebind-4000000-1.partial/0", "tile"),
        (".tilebind-4000000-2.partial/0", ""),
    ];
    place(&out, &mine);
    place(&out, &left);
    assert_eq!(run(here, &words(MAKE)).status.code(), Some(0));
    check(&out, &mine);
    assert!(left.iter().all(|(name, _)| !out.join(name).exists()));
    assert!(!out.join(".tilebind-4000000-0.partial").exists());
    assert!(!out.join(".tilebind-4000000-2.partial").exists());
}
