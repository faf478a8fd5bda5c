//! A clock that jumps. Skipped without `faketime`.

use std::process::Command;

use super::{COMMANDS, arguments, assert_whole, undisturbed};
use crate::program::{command, stderr};

#[test]
fn a_clock_that_jumps_changes_neither_status_nor_files() {
    if Command::new("faketime").arg("--version").output().is_err() {
        return;
    }
    // Three seconds on, or back, with every look at the clock.
    let clocks = ["+0 i3.0", "@1990-01-01 00:00:00 i-3.0"];
    for ((name, more), clock) in COMMANDS.into_iter().zip(clocks.into_iter().cycle()) {
        let expected = undisturbed(name, more);
        let folder = tempfile::tempdir().unwrap();
        let program = command(&[]);
        let output = Command::new("faketime")
            .args(["-f", clock])
            .arg(program.get_program())
            .args(arguments(name, more, folder.path()))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
        assert_eq!(assert_whole(folder.path(), expected), expected.len());
    }
}
