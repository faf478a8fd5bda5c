//! Limits of file size, full devices, and memory that runs out.

use std::fs::File;

use super::{COMMANDS, DESIGN, NO_BOUNDS, NO_SEARCH, after, arguments, assert_whole, undisturbed};
use crate::program::{command, stderr};

/// Files of at most so many blocks of 512 bytes.
fn limited(blocks: u64) -> String {
    format!("ulimit -f {blocks}")
}

#[test]
fn writes_that_fail_at_some_byte_end_with_status_1_and_leave_whole_files() {
    for (number, (name, more)) in COMMANDS.iter().enumerate() {
        let expected = undisturbed(name, more);
        let largest = expected.values().map(Vec::len).max().unwrap() as u64;
        let enough = (number == 0).then_some(largest / 512 + 1);
        for blocks in [0, 8, largest / 512 - 1].into_iter().chain(enough) {
            let folder = tempfile::tempdir().unwrap();
            let out = folder.path().join("out");
            let output = after(&limited(blocks), &arguments(name, more, &out));
            let message = stderr(&output);
            let found = assert_whole(&out, expected);
            if blocks > largest / 512 {
                assert_eq!(output.status.code(), Some(0), "{name} {blocks}: {message}");
                assert_eq!(found, expected.len());
                continue;
            }
            assert_eq!(output.status.code(), Some(1), "{name} {blocks}: {message}");
            assert!(message.starts_with("error: "), "{name} {blocks}: {message}");
            assert!(found < expected.len());
            // Once there is room, the same command succeeds.
            if blocks == 8 {
                let output = command(&arguments(name, more, &out)).output().unwrap();
                assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
                assert_eq!(assert_whole(&out, expected), expected.len());
            }
        }
    }
}

#[test]
fn a_full_device_for_the_answer_is_a_failure() {
    let Ok(full) = File::options().write(true).open("/dev/full") else {
        return;
    };
    for (name, more) in COMMANDS {
        let folder = tempfile::tempdir().unwrap();
        let mut arguments = arguments(name, more, folder.path());
        arguments.retain(|argument| *argument != "--quiet");
        let mut command = command(&arguments);
        let output = command.stdout(full.try_clone().unwrap()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{name}");
        assert!(stderr(&output).contains("error: "), "{name}");
    }
}

/// From the smallest memory in which the program starts.
#[test]
fn memory_that_runs_out_leaves_whole_files() {
    let limit = |megabytes: u64| format!("ulimit -c 0; ulimit -v {}", 1024 * megabytes);
    let starts = |megabytes: &u64| after(&limit(*megabytes), &["--version"]).status.success();
    let least = (8..400).step_by(2).find(starts).expect("it starts");
    for (name, more) in COMMANDS {
        let expected = undisturbed(name, more);
        for megabytes in [least, least + 3, least + 8] {
            let folder = tempfile::tempdir().unwrap();
            let out = folder.path().join("out");
            let output = after(&limit(megabytes), &arguments(name, more, &out));
            let found = assert_whole(&out, expected);
            assert_eq!(
                output.status.success(),
                found == expected.len(),
                "{name} in {megabytes} MB: {output:?}"
            );
        }
    }
}

#[test]
fn runs_that_memory_cannot_hold_are_refused() {
    let dock = ["dock", DESIGN, "--runs", "10000000", "--quiet"];
    let output = after("ulimit -v 2000000", &dock);
    assert_eq!(output.status.code(), Some(2));
    let told = stderr(&output);
    assert!(
        told.contains("26.0 GB of memory") && told.contains("fewer --runs"),
        "{told}"
    );
}

/// Commands with little work, all of which start threads.
const LITTLE: [&[&str]; 9] = [
    &["rates", DESIGN, "--kt", "3e-3"],
    &["rates", PAPER, "--kt", "3e-3", "--start", "0.43,-0.04,0"],
    &["dock", DESIGN, "--runs", "8", "--duration", "1"],
    &[
        "dock",
        DESIGN,
        "--runs",
        "8",
        "--from-bond",
        "--overdamped",
        "--shaking",
        "3e-3",
    ],
    &["bond", DESIGN, "--kt", "3e-3", "--coverage", "0.3"],
    &[
        "yield", DESIGN, "--tiles", "10", "--time", "600", "--kt", "3e-3", "--runs", "8",
    ],
    &[
        "table",
        PAPER,
        "--count",
        "2,2",
        "--time",
        "1",
        "--shaking",
        "3e-3",
        "--drag",
        "0.5",
    ],
    &[
        "assemble",
        "lattice",
        "--lattice",
        "2x2",
        "--kt",
        "4e-3",
        "--coverage",
        "0.1",
    ],
    &[
        "analyse",
        DESIGN,
        NO_BOUNDS,
        NO_SEARCH,
        "--milestones",
        "200",
        "--far-starts",
        "10",
    ],
];
const PAPER: &str = "shapes/paper-tile.toml";

/// Whatever address space a process may have, a command answers or says beforehand what it needs.
#[test]
fn any_memory_gives_an_answer_or_says_what_is_needed() {
    let mut answers = 0;
    for asked in LITTLE {
        for megabytes in [60, 150, 400] {
            let folder = tempfile::tempdir().unwrap();
            let out = folder.path().join("out");
            let more = ["--threads", "2", "--quiet", "--out", out.to_str().unwrap()];
            let limit = format!("ulimit -c 0; ulimit -v {}", 1024 * megabytes);
            let output = after(&limit, &[asked, &more[..]].concat());
            let message = stderr(&output);
            match output.status.code() {
                Some(0) => answers += 1,
                code => {
                    assert_eq!(code, Some(2), "{asked:?} in {megabytes} MB: {message}");
                    assert!(message.starts_with("error: "), "{message}");
                    assert!(
                        message.contains("MB") && message.lines().count() == 1,
                        "{message}"
                    );
                    assert!(!out.exists(), "{asked:?} in {megabytes} MB");
                }
            }
        }
    }
    // Those without meshes fit into the largest of these.
    assert_eq!(answers, 6);
}

#[test]
fn what_the_process_may_not_have_is_refused_beforehand() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for (name, more) in &COMMANDS[..3] {
        let mut arguments = arguments(name, more, &out);
        let place = arguments.iter().position(|argument| *argument == "200");
        arguments[place.unwrap()] = "4000000";
        let output = after("ulimit -v 1000000", &arguments);
        assert_eq!(output.status.code(), Some(2), "{name}: {}", stderr(&output));
        assert!(
            stderr(&output).contains("1.0 GB are free"),
            "{}",
            stderr(&output)
        );
        assert!(!out.exists());
    }
}
