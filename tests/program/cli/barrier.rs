//! `tilebind barrier` on the paper's tile, against a dense grid fitted to contact.

use serde_json::Value;

use super::{json, numbers};

const DESIGN: &str = "shapes/paper-tile.toml";
/// Depth of the bond (J).
const DEPTH: f64 = 65.47e-3;

fn number(entry: &Value, key: &str) -> f64 {
    entry[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key} in {entry}"))
}

#[test]
fn the_slid_tile_peels_off_and_pivots_on_a_corner() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("way.csv");
    let entry = json(&[
        "barrier",
        DESIGN,
        "--from",
        "0.43,-0.04,0",
        "--to",
        "0.43,0,0",
        "--pathway",
        file.to_str().unwrap(),
    ]);
    let saddle = number(&entry, "saddle_energy_J");
    assert!((saddle + 0.8391e-3).abs() < 0.005 * 15.187e-3, "{saddle}");
    let forward = number(&entry, "forward_J");
    assert!((forward - 15.187e-3).abs() < 0.005 * 15.187e-3);
    let difference = number(&entry, "reverse_J") - forward;
    assert!((difference - (65.468e-3 - 16.026e-3)).abs() < 2e-6);
    let (lower, upper) = (number(&entry, "lower_J"), number(&entry, "upper_J"));
    assert!(lower <= saddle + 1e-12 && saddle <= upper + 1e-12);
    assert!(lower <= -0.8391e-3 && -0.8392e-3 <= upper);
    assert!(upper - lower <= 0.01 * DEPTH);
    assert_eq!(entry["caged"], false);

    let table = std::fs::read_to_string(file).unwrap();
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(&rows[0][1..4], &[0.43, -0.04, 0.0]);
    assert_eq!(&rows[rows.len() - 1][1..4], &[0.43, 0.0, 0.0]);
    let highest = rows.iter().map(|row| row[4]).fold(f64::MIN, f64::max);
    assert!((highest - saddle).abs() < 1e-9);
    assert!(rows.iter().all(|row| row[5] > -1e-9));
}

#[test]
fn the_bond_breaks_at_the_energy_of_tiles_far_apart() {
    let entry = json(&[
        "barrier",
        DESIGN,
        "--from",
        "0.43,0,0",
        "--to",
        "free",
        "--certify-seconds",
        "0",
    ]);
    assert_eq!(entry["to"], "free");
    assert!(number(&entry, "saddle_energy_J").abs() < 2e-4 * DEPTH);
    assert!((number(&entry, "forward_J") - 65.468e-3).abs() < 2e-3 * DEPTH);
    assert!(entry["lower_J"].is_null() && entry["upper_J"].is_null());
}

#[test]
fn between_poses_on_a_slope_the_higher_end_is_the_saddle() {
    let entry = json(&[
        "barrier",
        DESIGN,
        "--from",
        "0.45,0,0",
        "--to",
        "0.44,0,0",
        "--certify-seconds",
        "0",
    ]);
    assert!(number(&entry, "forward_J").abs() < 1e-9);
    assert_eq!(numbers(&entry["saddle_pose"]), [0.45, 0.0, 0.0]);
}

#[test]
fn tiles_that_are_far_apart_are_free_without_a_motion() {
    for effort in [&[][..], &["--certify-work", "0"]] {
        let from = ["barrier", DESIGN, "--from", "0.7,0,0", "--to", "free"];
        let entry = json(&[&from[..], effort].concat());
        let saddle = number(&entry, "saddle_energy_J");
        assert!(saddle < 0.0 && saddle > -1e-5 && number(&entry, "forward_J") == 0.0);
        assert_eq!(number(&entry, "length_m"), 0.0);
        assert_eq!(number(&entry, "work_J"), 0.0);
        if effort.is_empty() {
            assert!(number(&entry, "upper_J") - number(&entry, "lower_J") < 1e-12);
        }
    }
}
