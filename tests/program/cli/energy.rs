//! `tilebind energy` against numbers from independent codes.

use std::time::{Duration, Instant};

use serde_json::Value;

use super::{json, numbers, tilebind};

const FIXTURES: &str = include_str!("../../fixtures/physics.json");

/// Forces and torques of the fixtures are differences of energies, accurate to about 3e-10 of the
/// force.
fn close(actual: f64, expected: f64, scale: f64) -> bool {
    (actual - expected).abs() <= 1e-9 * scale
}

#[test]
fn energy_force_and_torque_are_those_of_independent_codes() {
    let fixtures: Vec<Value> = serde_json::from_str(FIXTURES).unwrap();
    let mut arguments = vec!["energy".to_owned(), "tests/fixtures/flat.toml".to_owned()];
    for fixture in &fixtures {
        let pose: Vec<String> = numbers(&fixture["pose"])
            .iter()
            .map(f64::to_string)
            .collect();
        arguments.extend(["--pose".to_owned(), pose.join(",")]);
    }
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let entries = json(&arguments);
    assert_eq!(entries.as_array().unwrap().len(), fixtures.len());
    for (entry, fixture) in entries.as_array().unwrap().iter().zip(&fixtures) {
        let dipole = &fixture["dipole"];
        assert_eq!(entry["pose"], fixture["pose"]);
        let [energy, expected] = [entry, dipole].map(|e| e["energy_J"].as_f64().unwrap());
        assert!((energy / expected - 1.0).abs() < 1e-12, "{entry} {dipole}");
        let [force, expected] = [entry, dipole].map(|e| numbers(&e["force_N"]));
        let size = expected[0].hypot(expected[1]);
        assert!(close(force[0], expected[0], size) && close(force[1], expected[1], size));
        let [torque, expected] = [entry, dipole].map(|e| e["torque_Nm"].as_f64().unwrap());
        // A torque is a force on a lever of about half a metre.
        assert!(close(torque, expected, expected.abs().max(size)));
    }
}

#[test]
fn clearance_is_negative_exactly_where_the_tiles_overlap() {
    let entries = json(&[
        "energy",
        "tests/fixtures/flat.toml",
        "--pose",
        "0.43,0,0",
        "--pose",
        "-0.45,0.1,0",
        "--pose=0.42,0,0",
        "--pose",
        "0,-1,0.7853981633974483",
    ]);
    let clearance = |i: usize| entries[i]["clearance_m"].as_f64().unwrap();
    let free = |i: usize| entries[i]["free"].as_bool().unwrap();
    assert!(clearance(0).abs() < 1e-12 && free(0));
    assert!((clearance(1) - 0.02).abs() < 1e-12 && free(1));
    assert!((clearance(2) + 0.01).abs() < 1e-12 && !free(2));
    let expected = 1.0 - 0.215 * (1.0 + 2f64.sqrt());
    assert!((clearance(3) - expected).abs() < 1e-12 && free(3));
}

#[test]
fn it_starts_at_once() {
    let run = || {
        let start = Instant::now();
        tilebind(&["energy", "shapes/paper-tile.toml", "--pose", "0.43,0,0"]);
        start.elapsed()
    };
    let fastest = (0..10).map(|_| run()).min().unwrap();
    assert!(fastest < Duration::from_millis(20), "{fastest:?}");
}
