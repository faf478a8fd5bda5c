//! Closed outputs: commands end as they should when nobody reads their output, and interruptions
//! still work.

use std::io::{Write, pipe};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::program::command;

const DESIGN: &str = "shapes/paper-tile.toml";

/// A pipe without a reader.
fn closed() -> Stdio {
    let (_, writer) = pipe().unwrap();
    writer.into()
}

fn with_both_closed(arguments: &[&str]) -> Option<i32> {
    let mut command = command(arguments);
    command.stdout(closed()).stderr(closed());
    command.status().unwrap().code()
}

/// An analysis that takes minutes, with its standard error.
fn endless(folder: &tempfile::TempDir, stderr: Stdio) -> Child {
    command(&["analyse", DESIGN, "--milestones", "3000000", "--out"])
        .arg(folder.path().join("results"))
        .stdout(closed())
        .stderr(stderr)
        .spawn()
        .unwrap()
}

/// Exit status after a signal that is sent while the command works; it has two seconds to end.
fn interrupted(mut child: Child, signal: &str) -> Option<i32> {
    ended(&mut child, signal)
}

fn ended(child: &mut Child, signal: &str) -> Option<i32> {
    std::thread::sleep(Duration::from_secs(1));
    let mut kill = Command::new("kill");
    let kill = kill.args([signal, &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
    let since = Instant::now();
    while since.elapsed() < Duration::from_secs(2) {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code();
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    panic!("{signal} is ignored");
}

#[test]
fn interruptions_work_where_nobody_reads_messages() {
    let folder = tempfile::tempdir().unwrap();
    for signal in ["-TERM", "-INT"] {
        assert_eq!(interrupted(endless(&folder, closed()), signal), Some(75));
    }
    assert!(!folder.path().join("results").exists());
}

/// Fast commands wait for their input, too.
#[test]
fn every_command_can_be_interrupted() {
    for line in [
        "energy shapes/paper-tile.toml --poses /dev/stdin",
        "calibrate shapes/paper-tile.toml /dev/stdin",
        "calibrate shapes/paper-tile.toml --bonds /dev/stdin",
        "sweep --status /dev/stdin",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let mut command = command(&words);
        let command = command.stdin(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().unwrap();
        let _unwritten = child.stdin.take();
        assert_eq!(interrupted(child, "-TERM"), Some(75), "{line}");
    }
}

#[test]
fn what_a_watched_design_wrote_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let watched = ["show", DESIGN, "--watch", "--out", out.to_str().unwrap()];
    let mut child = command(&watched)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let since = Instant::now();
    while !out.join("report.json").exists() && since.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(ended(&mut child, "-INT"), Some(75));
    let told = std::io::read_to_string(child.stderr.take().unwrap()).unwrap();
    assert!(
        told.contains("interrupted: the last results are complete"),
        "{told}"
    );
}

/// As behind a pager that shows the first page.
#[test]
fn interruptions_work_where_the_pipe_is_full() {
    let folder = tempfile::tempdir().unwrap();
    let (reader, writer) = pipe().unwrap();
    let mut flood = writer.try_clone().unwrap();
    let flooding = std::thread::spawn(move || while flood.write_all(&[b'.'; 512]).is_ok() {});
    assert_eq!(
        interrupted(endless(&folder, writer.into()), "-TERM"),
        Some(75)
    );
    drop(reader);
    flooding.join().unwrap();
}

#[test]
fn mistakes_end_with_status_2_and_failures_with_1_where_nobody_reads_them() {
    let mistakes: [&[&str]; 5] = [
        &[],
        &["analyze"],
        &["analyse", DESIGN],
        &["energy", "nowhere.toml", "--pose", "0,0,0"],
        &["energy", DESIGN, "--pose", "1,2"],
    ];
    for arguments in mistakes {
        assert_eq!(with_both_closed(arguments), Some(2), "{arguments:?}");
    }
    assert_eq!(with_both_closed(&["init", "nowhere/mine.toml"]), Some(1));
}

#[test]
fn output_that_nobody_reads_is_no_failure() {
    let folder = tempfile::tempdir().unwrap();
    let starter = folder.path().join("mine.toml");
    let answers: [&[&str]; 5] = [
        &["--help"],
        &["--version"],
        &["schema"],
        &["energy", DESIGN, "--pose", "0.43,0,0"],
        &["init", starter.to_str().unwrap()],
    ];
    for arguments in answers {
        assert_eq!(with_both_closed(arguments), Some(0), "{arguments:?}");
    }
    assert!(starter.is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_a_failure() {
    let full = || std::fs::File::create("/dev/full").unwrap();
    for arguments in [["--help"], ["--version"], ["schema"]] {
        let mut command = command(&arguments);
        let output: Output = command.stdout(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        let silent = command.stdout(full()).stderr(full()).status();
        assert_eq!(silent.unwrap().code(), Some(1), "{arguments:?}");
    }
}

/// On a terminal, here one that `script` makes, the search for states shows how many of its parts are
/// done, and about how long the rest takes.
#[test]
fn progress_has_a_share_and_an_estimate() {
    let folder = tempfile::tempdir().unwrap();
    let program = command(&[]).get_program().to_owned();
    let out = folder.path().join("R");
    let line = format!(
        "{} analyse {DESIGN} --out {} --quick --no-pictures --threads 1",
        program.display(),
        out.display()
    );
    let mut script = Command::new("script");
    let script = script
        .args(["-qec", &line, "/dev/null"])
        .stdin(Stdio::null());
    let Ok(done) = script.env("COLUMNS", "120").output() else {
        return;
    };
    let shown = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{shown}");
    let parts = ["states, ", " of ", " done"];
    assert!(parts.iter().all(|part| shown.contains(part)), "{shown}");
}
