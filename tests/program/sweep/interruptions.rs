//! An interrupted sweep resumes and ends with the same bytes.

#![cfg(unix)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use super::{DEPTH, DESIGN, QUICK, assert_same, done, sweep, text};
use crate::program::stderr;

const POINTS: usize = 6;

fn arguments(out: &Path) -> Vec<String> {
    let depth = format!("{DEPTH}=0.005:0.04:{POINTS}");
    let what = [
        DESIGN,
        "--vary",
        &depth,
        "--threads",
        "1",
        "--out",
        text(out),
    ];
    [&what[..], &QUICK]
        .concat()
        .iter()
        .map(|a| (*a).to_owned())
        .collect()
}

fn start(out: &Path) -> Child {
    let arguments = arguments(out);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let mut command = sweep(&arguments);
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// Finished points with the times at which their files were written.
fn points(out: &Path) -> BTreeMap<PathBuf, SystemTime> {
    let entries = std::fs::read_dir(out.join("points")).into_iter().flatten();
    entries
        .flatten()
        .filter(|entry| entry.path().extension().is_some_and(|end| end == "json"))
        .map(|entry| (entry.path(), entry.metadata().unwrap().modified().unwrap()))
        .collect()
}

/// Waits until some more points are finished, but not all.
fn wait_for_points(out: &Path, count: usize) {
    let since = Instant::now();
    while points(out).len() < count {
        assert!(
            since.elapsed() < Duration::from_secs(120),
            "no point is finished"
        );
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn killed_and_resumed_it_ends_in_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, broken] = ["whole", "broken"].map(|name| folder.path().join(name));
    let all = arguments(&whole);
    done(&all.iter().map(String::as_str).collect::<Vec<_>>());
    for count in [1, 4] {
        let mut child = start(&broken);
        wait_for_points(&broken, count);
        child.kill().unwrap();
        assert_eq!(child.wait().unwrap().code(), None, "killed by a signal");
        assert!((count..POINTS).contains(&points(&broken).len()));
    }
    // A damaged file, and one that was being written when the process was killed.
    let before = points(&broken);
    let damaged = before.keys().next().unwrap();
    let content = std::fs::read(damaged).unwrap();
    std::fs::write(damaged, &content[..content.len() / 2]).unwrap();
    std::fs::create_dir(broken.join(".tilebind-99-0.partial")).unwrap();
    std::fs::write(broken.join(".tilebind-99-0.partial/0"), "tile").unwrap();
    let all = arguments(&broken);
    done(&all.iter().map(String::as_str).collect::<Vec<_>>());
    assert_same(&whole, &broken);
    let after = points(&broken);
    for (path, time) in before.iter().filter(|(path, _)| *path != damaged) {
        assert_eq!(
            after[path], *time,
            "a finished point is not worked on again"
        );
    }
}

#[test]
fn sigterm_ends_it_with_status_75_and_keeps_what_is_finished() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let child = start(&out);
    wait_for_points(&out, 2);
    let kill = Command::new("kill").arg(child.id().to_string()).status();
    assert!(kill.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(75));
    assert!(stderr(&output).contains("to resume"), "{}", stderr(&output));
    assert!((2..POINTS).contains(&points(&out).len()));
    assert!(!out.join("report.json").exists());
    let partial = |path: &PathBuf| path.display().to_string().contains("partial");
    let entries = std::fs::read_dir(&out).unwrap().flatten();
    assert!(!entries.map(|entry| entry.path()).any(|path| partial(&path)));
}
