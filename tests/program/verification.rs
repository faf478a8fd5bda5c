//! The second reader confirms what analyses state, and notices every number that is changed by hand.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use tempfile::tempdir;

use crate::program::{command, stderr};
use crate::readme::with_shapes;

const EFFORT: &str = "--milestones 300 --far-starts 30 --certify-work 0.2 --complete-work 0.1 \
                      --no-pictures --quiet --threads 1";

fn analyse(folder: &Path, design: &str, out: &str, more: &str) {
    let words = format!("analyse {design} --out {out} {EFFORT} {more}");
    let words: Vec<&str> = words.split_whitespace().collect();
    let done = command(&words).current_dir(folder).output();
    let done = done.expect("the program");
    assert!(done.status.success(), "{}", stderr(&done));
}

/// The exit status, and the report of checks.
fn verify(folder: &Path, outs: &[&str]) -> (Option<i32>, Value) {
    let words = ["verify", "--json", "--threads", "1"];
    let done = command(&words).args(outs).current_dir(folder).output();
    let done = done.expect("the program");
    let report = serde_json::from_slice(&done.stdout);
    (
        done.status.code(),
        report.unwrap_or_else(|_| panic!("{}", stderr(&done))),
    )
}

#[test]
fn results_of_dipoles_are_confirmed() {
    let folder = with_shapes();
    let here = folder.path();
    analyse(here, "shapes/tab-20mm.toml", "dipoles", "");
    analyse(here, "shapes/tab-20mm.toml", "again", "--seed 2");
    analyse(
        here,
        "shapes/tab-20mm.toml",
        "blocks",
        "--model cuboid --kinds 3",
    );
    analyse(here, "shapes/shielded-backs.toml", "shields", "--kinds 4");
    let (status, report) = verify(here, &["dipoles", "again", "shields"]);
    assert_eq!(report["contradictions"], json!([]));
    assert_eq!((status, &report["verified"]), (Some(0), &json!(true)));
    let checks = report["checks"].as_array().expect("checks");
    for check in checks {
        assert!(check["confirmed"].as_u64() > Some(0), "{check}");
    }
}

#[test]
fn what_cannot_be_checked_is_said() {
    let folder = with_shapes();
    let here = folder.path();
    analyse(
        here,
        "shapes/shielded-nearest-face.toml",
        "rule",
        "--kinds 2",
    );
    let (status, report) = verify(here, &["rule"]);
    assert_eq!(status, Some(0));
    let unchecked = report["unchecked"].to_string();
    assert!(unchecked.contains("nearest-face rule"), "{unchecked}");
    let empty = tempdir().expect("a folder");
    let done = command(&["verify"])
        .arg(empty.path())
        .output()
        .expect("the program");
    assert_eq!(done.status.code(), Some(2));
    assert!(stderr(&done).contains("report.json"), "{}", stderr(&done));
}

/// Every number of report.json that is checked, by its path; a star stands for any place of a list.
const CHECKED: [&str; 22] = [
    "/bound/energy_J",
    "/bound/pose/1",
    "/states/*/energy_J",
    "/states/*/pose/0",
    "/states/*/pose/2",
    "/states/*/id",
    "/states/*/class",
    "/states/*/copies",
    "/states/*/capture/count",
    "/states/*/capture/share",
    "/states/*/capture/of",
    "/states/*/block_energy_J",
    "/free/capture/count",
    "/free/at_rest/count",
    "/inventory/escape_J",
    "/barriers/*/saddle_energy_J",
    "/barriers/*/saddle_pose/0",
    "/barriers/*/forward_J",
    "/barriers/*/reverse_J",
    "/barriers/*/length_m",
    "/barriers/*/work_J",
    "/tiles/moving/magnets/*/moment_Am2",
];

#[test]
fn every_changed_number_is_noticed() {
    let folder = with_shapes();
    let here = folder.path();
    analyse(here, "shapes/tab-20mm.toml", "R", "");
    let file = here.join("R/report.json");
    let text = fs::read_to_string(&file).expect("a report");
    let whole: Value = serde_json::from_str(&text).expect("JSON");
    let noticed = |report: &Value, what: &str| {
        fs::write(&file, report.to_string()).expect("written");
        let (status, found) = verify(here, &["R"]);
        assert_eq!(status, Some(1), "{what}: {}", found["checks"]);
    };
    for path in CHECKED {
        let path = path.replace('*', "1");
        let mut report = whole.clone();
        let number = report.pointer_mut(&path).filter(|it| it.is_number());
        let number = number.unwrap_or_else(|| panic!("no number: {path}"));
        // Work is known to a share of the pathway's range, as files leave points out.
        let more = if path.contains("work") { 1e-4 } else { 1e-5 };
        *number = match number.as_u64() {
            Some(count) => json!(count + 1),
            None => json!(number.as_f64().map_or(0.0, |x| x * 1.001 + more)),
        };
        noticed(&report, &path);
    }
    // Bounds beyond each other, and one that the pathway exceeds.
    let bond = whole["barriers"].as_array().expect("barriers");
    let bond = bond
        .iter()
        .position(|it| it["from"] == 0 && it["to"] == "free")
        .expect("the bond's");
    let barrier = &whole["barriers"][bond];
    for (key, value) in [
        (
            "lower_J",
            barrier["upper_J"].as_f64().expect("bounds") + 1e-6,
        ),
        (
            "upper_J",
            barrier["saddle_energy_J"].as_f64().expect("a saddle") - 1e-6,
        ),
    ] {
        let mut report = whole.clone();
        report["barriers"][bond][key] = json!(value);
        noticed(&report, key);
    }
    fs::write(&file, &text).expect("written");

    let name = barrier["pathway"].as_str().expect("a pathway");
    let file = here.join("R").join(name);
    let text = fs::read_to_string(&file).expect("a pathway");
    let lines: Vec<&str> = text.lines().collect();
    for column in 0..6 {
        let mut cells: Vec<String> = lines[lines.len() / 2]
            .split(',')
            .map(str::to_owned)
            .collect();
        let number: f64 = cells[column].parse().expect("a number");
        cells[column] = (number * 1.001 + 1e-5).to_string();
        let mut changed: Vec<String> = lines.iter().map(|it| (*it).to_owned()).collect();
        changed[lines.len() / 2] = cells.join(",");
        fs::write(&file, changed.join("\n")).expect("written");
        let (status, _) = verify(here, &["R"]);
        assert_eq!(status, Some(1), "column {column}");
    }
}
