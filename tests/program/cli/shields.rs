//! Shielded designs in the program: dipoles behind shields are certified; the output names what is
//! not.

use std::path::Path;

use serde_json::Value;

use super::{json, numbers, tilebind};
use crate::program::{stderr, stdout};

const DESIGN: &str = "shapes/shielded-backs.toml";
const JUMPING: &str = "shapes/shielded-nearest-face.toml";
const BARE: &str = "tests/designs/good/flat.toml";

/// The summary and the report of a quick analysis into a folder.
fn analysed(design: &str, folder: &Path) -> (String, Value) {
    let out = folder.to_str().unwrap();
    let quick = [
        "--milestones",
        "200",
        "--far-starts",
        "20",
        "--complete-seconds",
        "0",
        "--tolerance",
        "2e-3",
    ];
    let output = tilebind(&[&["analyse", design, "--out", out], &quick[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = std::fs::read_to_string(folder.join("report.json")).unwrap();
    (stdout(&output), serde_json::from_str(&text).unwrap())
}

#[test]
fn dipoles_behind_shields_are_certified() {
    let folder = tempfile::tempdir().unwrap();
    let (_, report) = analysed(DESIGN, folder.path());
    assert_eq!(report["settings"]["shields"], "smooth");
    assert!(report["uncertified"].is_null());
    let barriers = report["barriers"].as_array().unwrap();
    assert!(!barriers.is_empty());
    for barrier in barriers {
        let [lower, saddle, upper] =
            ["lower_J", "saddle_energy_J", "upper_J"].map(|key| barrier[key].as_f64().unwrap());
        assert!(lower <= saddle && saddle <= upper, "{barrier}");
    }
    // The bound state has both energies, of dipoles and of blocks behind the same shields.
    let bound = &report["states"][0];
    let [dipole, block] = ["energy_J", "block_energy_J"].map(|key| bound[key].as_f64().unwrap());
    assert!(block < 1.5 * dipole && block > 2.5 * dipole, "{bound}");
}

#[test]
fn analyse_says_that_jumping_energies_are_not_certified() {
    let folder = tempfile::tempdir().unwrap();
    let (summary, report) = analysed(JUMPING, folder.path());
    assert!(summary.contains("not certified"), "{summary}");

    assert_eq!(report["settings"]["shields"], "nearest-face");
    let why = report["uncertified"].as_str().unwrap();
    assert!(why.contains("nearest-face"), "{why}");
    let barriers = report["barriers"].as_array().unwrap();
    assert!(!barriers.is_empty());
    for barrier in barriers {
        assert!(barrier["lower_J"].is_null() && barrier["upper_J"].is_null());
    }
    let table = std::fs::read_to_string(folder.path().join("barriers.csv")).unwrap();
    let mut lines = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let column = |name: &str| header.iter().position(|cell| *cell == name).unwrap();
    for line in lines {
        assert_eq!([line[column("lower_J")], line[column("upper_J")]], ["", ""]);
    }
}

#[test]
fn energies_are_those_of_the_shields_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let shielded = folder.path().join("shielded.toml");
    let bare = std::fs::read_to_string(BARE).unwrap();
    let energy = |section: &str, pose: &str| {
        std::fs::write(&shielded, format!("{bare}\n{section}")).unwrap();
        let entry = &json(&["energy", shielded.to_str().unwrap(), "--pose", pose])[0];
        let force = numbers(&entry["force_N"]);
        (entry["energy_J"].as_f64().unwrap(), force[0])
    };
    let shield = "[shield]\nattenuation = 0.8\nlength = 0.03\nwidth = 0.01\nfront_gain = 1.2\n";
    // Face to face everything that counts is in front of the iron: the square of the front gain.
    let (with, without) = (energy(shield, "0.43,0,0"), energy("", "0.43,0,0"));
    assert!((with.0 / without.0 / 1.44 - 1.0).abs() < 0.01);
    assert!((with.1 / without.1 / 1.44 - 1.0).abs() < 0.01);
    // By the other rule, only the two faces.
    let nearest = energy("[shield]\nrule = \"nearest-face\"\n", "0.43,0,0");
    assert!((nearest.0 / without.0 - 1.0).abs() < 1e-3 && nearest.0 != without.0);
}

#[test]
fn a_barrier_of_shielded_blocks_lies_between_its_bounds() {
    let quick = ["--milestones", "60", "--model", "cuboid"];
    let ends = ["--from", "0.08,0,0", "--to", "free"];
    let entry = json(&[&["barrier", DESIGN], &ends[..], &quick].concat());
    let [lower, upper, forward] =
        ["lower_J", "upper_J", "forward_J"].map(|key| entry[key].as_f64().unwrap());
    let saddle = entry["saddle_energy_J"].as_f64().unwrap();
    assert!(
        lower <= saddle && saddle <= upper && upper - lower < 0.05 * forward,
        "{entry}"
    );
}
