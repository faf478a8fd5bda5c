//! Moving tiles: the check of barriers and docking runs.

use std::io::{BufRead, BufReader};
use std::process::Stdio;

use serde_json::Value;

use super::{json, refused, tilebind};
use crate::program::{command, stderr, stdout};

const QUICK: [&str; 8] = [
    "--milestones",
    "2000",
    "--far-starts",
    "100",
    "--complete-seconds",
    "0",
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
    arguments.push("--dynamics=20");
    let output = tilebind(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("simulated tiles: 0 of "));
    let report = std::fs::read_to_string(format!("{out}/report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let dynamics = &report["dynamics"];
    assert_eq!(dynamics["runs"], 20);
    assert_eq!(dynamics["contradicted"], 0);
    let barriers = dynamics["barriers"].as_array().unwrap();
    assert_eq!(barriers.len(), report["barriers"].as_array().unwrap().len());
    for (check, barrier) in barriers.iter().zip(report["barriers"].as_array().unwrap()) {
        assert_eq!(check["from"], barrier["from"]);
        assert_eq!(check["to"], barrier["to"]);
        assert_eq!(check["ceiling_J"], barrier["lower_J"]);
        assert_eq!(check["below"]["runs"], 20);
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

/// Docking runs of a design; `report.json`.
fn dock(arguments: &[&str]) -> Value {
    json(&[&["dock"], arguments, &["--json"]].concat())
}

#[test]
fn docking_runs_are_the_same_on_any_number_of_threads_and_written_whole() {
    let out = folder("dock");
    let run = |threads: &str| {
        let arguments = [
            "shapes/paper-tile.toml",
            "--drag",
            "0.5",
            "--no-walls",
            "--runs",
            "40",
            "--out",
            &out,
            "--threads",
            threads,
        ];
        let counts = dock(&arguments);
        let runs = std::fs::read(format!("{out}/runs.csv")).unwrap();
        let page = std::fs::read(format!("{out}/report.html")).unwrap();
        (counts["bound"].clone(), runs, page)
    };
    let once = run("1");
    assert_eq!(once, run("3"));
    let map = std::fs::read_to_string(format!("{out}/map.csv")).unwrap();
    let column = |line: &str, k: usize| line.split(',').nth(k).unwrap().parse::<usize>().unwrap();
    let runs: usize = map.lines().skip(1).map(|line| column(line, 5)).sum();
    let matched: usize = map.lines().skip(1).map(|line| column(line, 4)).sum();
    assert_eq!(runs, 40);
    assert_eq!(once.0["count"], matched);
    for name in [
        "pictures/chances.svg",
        "pictures/trajectories.svg",
        "trajectory.csv",
    ] {
        let content = std::fs::read(format!("{out}/{name}")).unwrap();
        assert!(content.len() > 500, "{name}");
    }
}

#[test]
fn shielded_magnets_dock_too() {
    let out = dock(&["shapes/shielded-nearest-face.toml", "--runs", "8"]);
    let count = |what: &str| out[what]["count"].as_u64().unwrap();
    assert_eq!(count("bound") + count("misbound") + count("free"), 8);
    assert!(out["timing"]["contact_steps"].as_u64().unwrap() > 0);
}

#[test]
fn a_fan_behind_the_tile_blows_it_in_and_one_before_it_keeps_it_away() {
    let common = [
        "shapes/paper-tile.toml",
        "--runs",
        "24",
        "--speed",
        "0,0.05",
        "--direction",
        "0.1",
        "--orientation",
        "0.2",
        "--aim",
        "0",
        "--distance",
        "0.7,0.8",
    ];
    let bound = |fan: &str| {
        let out = dock(&[&common[..], &["--fan", fan]].concat());
        let fans = &out["settings"]["motion"]["fans"];
        assert_eq!(fans.as_array().unwrap().len(), 1);
        let met =
            out["bound"]["count"].as_u64().unwrap() + out["misbound"]["count"].as_u64().unwrap();
        (met, out["free"]["count"].as_u64().unwrap())
    };
    let (caught, _) = bound("0.95,0,5e-3,0.2");
    assert!(caught >= 8, "{caught}");
    let (_, free) = bound("0.35,0,5e-3,0.2,0.5,1");
    assert_eq!(free, 24);
}

#[test]
fn wrong_docking_options_are_refused_with_their_mend() {
    for (wrong, fix) in [
        (["--fan", "1,2,3"], "a fan is X,Y,E_J,S"),
        (["--speed", "1,0"], "a range is LOW,HIGH"),
        (["--trajectory", "9"], "ask for more --runs"),
        (["--restitution", "1.5"], "from 0 to 1"),
        (["--drag", "-1"], "from 0 to 10000"),
    ] {
        let arguments = [
            &["dock", "shapes/paper-tile.toml", "--runs", "2"],
            &wrong[..],
        ]
        .concat();
        let output = tilebind(&arguments);
        assert_eq!(output.status.code(), Some(2), "{wrong:?}");
        assert!(stderr(&output).contains(fix), "{}", stderr(&output));
    }
    let shaken = [
        "dock",
        "shapes/paper-tile.toml",
        "--shaking",
        "1e-5",
        "--drag",
        "0",
    ];
    let output = tilebind(&shaken);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("set a drag rate above 0"));
}

/// A thousand million steps are hours; nothing longer starts.
#[test]
fn trajectories_that_would_not_end_are_refused() {
    const TILE: &str = "shapes/paper-tile.toml";
    let slow = ["--duration", "1e6", "--drag", "1e4"];
    let dock = ["dock", TILE, "--runs", "3", "--shaking", "1e-3"];
    let fan = ["--duration", "1e6", "--fan", "0.6,0.6,1e-3,0.2,0.5,1e3"];
    let pairs = [
        "yield", TILE, "--tiles", "10", "--time", "600", "--kt", "3e-3",
    ];
    refused(
        &[&dock[..], &slow].concat(),
        &["steps of 2.5e-5 s", "less drag"],
    );
    refused(
        &[&dock[..], &["--from-bond"], &slow].concat(),
        &["steps of"],
    );
    refused(
        &[&dock[..], &fan].concat(),
        &["steps of 1.0e-4 s", "slower fans"],
    );
    refused(&[&pairs[..], &slow].concat(), &["steps of"]);
    for wrong in ["1e300", "nan", "", "-1", "0"] {
        let wrong = format!("--duration={wrong}");
        refused(&[&dock[..], &[&wrong]].concat(), &["--duration"]);
        refused(&[&pairs[..], &[&wrong]].concat(), &["--duration"]);
    }
}

#[test]
fn an_exit_that_takes_too_long_to_simulate_is_refused() {
    let exit = [
        "rates",
        "shapes/paper-tile.toml",
        "--kt",
        "6e-3",
        "--start",
        "0.43,-0.04,0",
    ];
    refused(
        &[&exit[..], &["--check", "10", "--drag", "1e9"]].concat(),
        &["steps of"],
    );
}

/// Before the work, by a trial of a few milliseconds.
#[test]
fn long_trajectories_are_told_before() {
    let long = [
        "dock",
        "shapes/paper-tile.toml",
        "--runs",
        "100000",
        "--duration",
        "1e5",
        "--threads",
        "1",
    ];
    let mut child = command(&[&long[..], &["--shaking", "1e-3", "--drag", "0.5"]].concat())
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .expect("the program");
    let mut line = String::new();
    let told = child.stderr.take().expect("piped");
    BufReader::new(told).read_line(&mut line).expect("a line");
    child.kill().expect("it works on");
    child.wait().expect("ended");
    assert!(line.starts_with("note: expect up to about "), "{line}");
}
