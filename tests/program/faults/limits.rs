//! Limits of file size, full devices, and memory that runs out.

use std::fs::File;

use super::{COMMANDS, after, arguments, assert_whole, undisturbed};
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
    let mut ran_out = 0;
    for (name, more) in COMMANDS {
        let expected = undisturbed(name, more);
        for megabytes in [least, least + 3, least + 8] {
            let folder = tempfile::tempdir().unwrap();
            let out = folder.path().join("out");
            let output = after(&limit(megabytes), &arguments(name, more, &out));
            ran_out += u32::from(stderr(&output).contains("memory allocation"));
            let found = assert_whole(&out, expected);
            assert_eq!(
                output.status.success(),
                found == expected.len(),
                "{name} in {megabytes} MB: {output:?}"
            );
        }
    }
    assert!(ran_out > 1, "{ran_out}");
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
