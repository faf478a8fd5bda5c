//! Processes that are killed during their work.

use std::time::Duration;

use super::{COMMANDS, arguments, assert_whole, undisturbed};
use crate::program::{command, stderr};

#[test]
fn what_is_killed_leaves_whole_files_and_can_be_done_again() {
    for (name, more) in COMMANDS {
        let expected = undisturbed(name, more);
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        for milliseconds in [1, 20, 60, 120, 240, 480] {
            let mut child = command(&arguments(name, more, &out)).spawn().unwrap();
            std::thread::sleep(Duration::from_millis(milliseconds));
            child.kill().unwrap();
            child.wait().unwrap();
            take_away_unfinished(&out);
            assert_whole(&out, expected);
        }
        let output = command(&arguments(name, more, &out)).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
        assert_eq!(assert_whole(&out, expected), expected.len(), "{name}");
    }
}

/// Removes unfinished files, which are kept apart from results.
fn take_away_unfinished(folder: &std::path::Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let entry = entry.unwrap();
        if entry.file_name().to_string_lossy().ends_with(".partial") {
            std::fs::remove_dir_all(entry.path()).unwrap();
        }
    }
}

#[test]
fn a_killed_worker_is_missed_and_its_part_is_made_up_for() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let (name, more) = COMMANDS[2];
    let expected = undisturbed(name, more);
    let plan = out.join("plan.json");
    let plan = plan.to_str().unwrap();
    let mut planned = arguments(name, more, &out);
    planned.splice(1..1, ["--plan", plan]);
    let output = command(&planned).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let part = |part| command(&["sweep", "--run", plan, "--shard", part, "--threads", "1"]);
    assert_eq!(part("1/2").output().unwrap().status.code(), Some(0));
    let mut worker = part("2/2").spawn().unwrap();
    worker.kill().unwrap();
    worker.wait().unwrap();
    take_away_unfinished(&out);
    let merge = || command(&["sweep", "--merge", plan]).output().unwrap();
    let output = merge();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("not finished"),
        "{}",
        stderr(&output)
    );
    assert_eq!(part("2/2").output().unwrap().status.code(), Some(0));
    assert_eq!(merge().status.code(), Some(0));
    assert_eq!(assert_whole(&out, expected), expected.len());
}
