//! Requests larger than the machine's memory or a tile's needs: reduced with a message, or refused,
//! before the work starts.

use std::io::{BufRead, BufReader};
use std::process::Stdio;

use super::{json, tilebind};
use crate::program::{command, stderr};

/// Two squares with such faces.
fn squares(magnets: &str, faces: &str) -> String {
    format!(
        "[table]\nsize = [2.0, 2.0]\n{magnets}\n\
         [fixed]\nside = 0.4\nthickness = 0.01\nmass = 0.1\n[fixed.faces]\n{faces}\n\
         [moving]\nside = 0.4\nthickness = 0.01\nmass = 0.1\n[moving.faces]\n{faces}\n\
         [target]\nfixed = \"east\"\nmoving = \"west\"\n[potential]\nmodel = \"dipole\"\n"
    )
}

#[test]
fn tiles_without_magnets_have_no_states_and_take_no_time_of_any_proof() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("bare.toml");
    std::fs::write(&design, squares("", "")).unwrap();
    let out = folder.path().join("out");
    let report = json(&[
        "analyse",
        design.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--milestones",
        "300",
        "--far-starts",
        "10",
        "--json",
    ]);
    assert_eq!(report["states"].as_array().map(Vec::len), Some(0));
    assert_eq!(report["barriers"].as_array().map(Vec::len), Some(0));
    let counts = &report["counts"];
    assert!(counts["cells"].as_u64() < Some(10_000), "{counts}");
    // Where every configuration is a minimum, there are hundreds of thousands.
    assert!(
        counts["energy_evaluations"].as_u64() < Some(100_000),
        "{counts}"
    );
}

#[test]
fn thousands_of_threads_are_more_than_are_used() {
    let poses = [
        "--from",
        "0.43,0,0",
        "--to",
        "0.9,0,0",
        "--milestones",
        "200",
    ];
    let design = ["barrier", "shapes/tab-20mm.toml"];
    let output = tilebind(&[&design, &poses[..], &["--threads", "60000"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("note: using"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn runs_that_no_machine_can_hold_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let design = "shapes/tab-20mm.toml";
    for arguments in [
        &["analyse", design, "--far-starts", "4294967295"][..],
        &["analyse", design, "--dynamics=4294967295"],
        &["compare", design, "--far-starts", "4294967295"],
        &["dock", design, "--runs", "4294967295"],
    ] {
        let output = tilebind(&[arguments, &["--out", out.to_str().unwrap()]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            stderr(&output).contains("at most 10000000"),
            "{arguments:?}"
        );
        assert!(!out.exists());
    }
}

#[test]
fn very_many_magnets_are_told_of_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("many.toml");
    let magnet = "[magnet]\nsize = [0.003, 0.002, 0.003]\nremanence = 1.2\npitch = 0.0039\n";
    let code = format!("all = {{ code = \"{}\" }}", "NS".repeat(50));
    std::fs::write(&design, squares(magnet, &code)).unwrap();
    let mut child = command(&["analyse", design.to_str().unwrap(), "--out"])
        .arg(folder.path().join("out"))
        .args(["--milestones", "1000000"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let told = lines
        .map_while(Result::ok)
        .find(|line| line.contains("pairs of magnets") || line.contains("error"));
    child.kill().unwrap();
    child.wait().unwrap();
    let told = told.expect("a note");
    assert!(
        told.contains("160000 pairs of magnets") && told.contains("1000000 milestones"),
        "{told}"
    );
}

#[cfg(unix)]
#[test]
fn tables_and_manifests_that_never_end_are_refused() {
    for arguments in [
        &["sweep", "--run", "/dev/zero"][..],
        &["energy", "shapes/paper-tile.toml", "--poses", "/dev/zero"],
        &["calibrate", "shapes/paper-tile.toml", "/dev/zero"],
    ] {
        let output = tilebind(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            stderr(&output).contains("not a regular file"),
            "{}",
            stderr(&output)
        );
    }
}

#[test]
fn tables_and_manifests_of_more_than_256_mb_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let large = folder.path().join("large.csv");
    // Without blocks on the disk.
    let file = std::fs::File::create(&large).expect("a file");
    file.set_len((256 << 20) + 1).expect("a length");
    let large = large.to_str().expect("a name");
    for arguments in [
        &["sweep", "--run", large][..],
        &["energy", "shapes/paper-tile.toml", "--poses", large],
        &["calibrate", "shapes/paper-tile.toml", large],
    ] {
        let output = tilebind(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let told = stderr(&output);
        assert!(told.contains("larger than 256 MB"), "{told}");
    }
}

#[test]
fn kinds_that_are_left_out_are_told_of() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut command = command(&["analyse", "shapes/paper-tile.toml", "--milestones", "300"]);
    command.args(["--far-starts", "0", "--certify-seconds", "0"]);
    command.args([
        "--complete-seconds",
        "0",
        "--kinds",
        "2",
        "--quiet",
        "--json",
    ]);
    let output = command.arg("--out").arg(&out).output().unwrap();
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["settings"]["kinds"], 2);
    let left = &report["inventory"]["left_out"];
    let kinds = left["kinds"].as_u64().unwrap();
    assert!(kinds > 0 && left["lowest_J"].as_f64().unwrap() < 0.0);
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains(&format!("{kinds} more kinds of trap were found")));
}
