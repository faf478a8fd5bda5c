//! Moving tiles: the check of barriers and docking runs.

use serde_json::Value;

use crate::{json, stderr, stdout, tilebind};

const QUICK: [&str; 6] = [
    "--milestones",
    "2000",
    "--far-starts",
    "100",
    "--certify-seconds",
    "20",
];

fn folder(name: &str) -> String {
    format!("{}/dynamics-{name}", env!("CARGO_TARGET_TMPDIR"))
}

#[test]
fn barriers_are_checked_by_moving_tiles_and_the_check_is_reported() {
    let out = folder("check");
    let mut arguments = vec!["analyse", "shapes/tab-20mm.toml", "--out", &out];
    arguments.extend(QUICK);
    arguments.push("--dynamics=40");
    let output = tilebind(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("moving tiles: 0 of "));
    let report = std::fs::read_to_string(format!("{out}/report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let dynamics = &report["dynamics"];
    assert_eq!(dynamics["runs"], 40);
    assert_eq!(dynamics["contradicted"], 0);
    let barriers = dynamics["barriers"].as_array().unwrap();
    assert_eq!(barriers.len(), report["barriers"].as_array().unwrap().len());
    for (check, barrier) in barriers.iter().zip(report["barriers"].as_array().unwrap()) {
        assert_eq!(check["from"], barrier["from"]);
        assert_eq!(check["to"], barrier["to"]);
        assert_eq!(check["ceiling_J"], barrier["lower_J"]);
        assert_eq!(check["below"]["runs"], 40);
        assert_eq!(check["below"]["crossed"], 0);
    }
    let table = std::fs::read_to_string(format!("{out}/dynamics.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + barriers.len());

    // Without the check nothing of it is left.
    let mut arguments = vec!["analyse", "shapes/tab-20mm.toml", "--out", &out, "--json"];
    arguments.extend(QUICK);
    assert!(json(&arguments)["dynamics"].is_null());
    assert!(!std::path::Path::new(&format!("{out}/dynamics.csv")).exists());
}
