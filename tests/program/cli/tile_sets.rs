//! What `assemble` says of a tile set, recomputed from its other results.

use serde_json::Value;

use super::json;
use crate::program::{command, stderr};

/// The rows of a CSV file by the names of its columns.
fn rows(path: &std::path::Path) -> Vec<std::collections::HashMap<String, String>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
    let keys: Vec<String> = lines.next().unwrap().collect();
    lines
        .map(|cells| keys.iter().cloned().zip(cells).collect())
        .collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The window, tau and the summary of slid contacts follow from Gse, Gmc, kT and the table of slid
/// contacts; the bonds from the matrix.
#[test]
fn figures_of_an_assembly_follow_from_its_tables() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for (set, kt) in [
        ("lattice", "4e-3"),
        ("homogeneous", "1.5e-3"),
        ("homogeneous", "6e-3"),
    ] {
        let found = json(&[
            "assemble",
            set,
            "--lattice",
            "2x3",
            "--kt",
            kt,
            "--coverage",
            "0.1",
            "--json",
            "--force",
            "--out",
            out.to_str().unwrap(),
        ]);
        let [gse, gmc, bond] = ["Gse", "Gmc", "bond_J"].map(|key| number(&found[key]));
        let kt: f64 = kt.parse().unwrap();
        assert!((gse * kt / bond - 1.0).abs() < 1e-12);
        assert!((number(&found["tau_effective"]) - gmc / gse).abs() < 1e-12);
        // One bond holds up to where its depth is what docking costs, Z0 growing as kT^(5/2).
        let window = &found["window_kt_J"];
        assert_eq!(number(&window[0]), 0.0);
        let upper = number(&window[1]);
        let cost = gmc - 2.5 * libm::log(upper / kt);
        assert!((bond / upper - cost).abs() < 1e-9 * cost, "{upper}");
        let matrix = found["matrix_J"].as_array().unwrap();
        let words = found["words"].as_array().unwrap().len();
        let weakest = (0..words).map(|k| -number(&matrix[k][k + words]));
        let weakest = weakest.fold(f64::INFINITY, f64::min);
        assert!((weakest / bond - 1.0).abs() < 1e-12);
        let slid = rows(&out.join("slides.csv"));
        let of = |key: &'static str| slid.iter().map(move |row| row[key].parse::<f64>().unwrap());
        let summary = &found["slides"];
        let deepest = of("energy_J").fold(0.0, f64::min);
        assert!((number(&summary["deepest_J"]) / deepest - 1.0).abs() < 1e-8);
        let holding = of("energy_kT").filter(|energy| -energy > gmc).count();
        assert_eq!(summary["pairs_that_hold_alone"], holding);
        assert_eq!(
            slid.iter()
                .filter(|row| row["holds_alone"] == "true")
                .count(),
            holding
        );
        let own = slid
            .iter()
            .filter(|row| row["second"] == format!("{}*", row["first"]));
        let shares: Vec<f64> = own
            .map(|row| {
                let [right, wrong] = ["slides_to_aligned", "slides_to_slid"]
                    .map(|key| row[key].parse::<f64>().unwrap());
                wrong / (right + wrong)
            })
            .collect();
        // Pairs without any slid contact are not in the table.
        let share = shares.iter().sum::<f64>() / words as f64;
        assert!(
            (number(&summary["bonds_slid_share"]) - share).abs() < 1e-8,
            "{set} {kt}"
        );
    }
}

/// On a face of a given length (m) fit as many magnets as their pitch and width say, and no more.
#[test]
fn a_face_holds_as_many_positions_as_fit() {
    // The paper's tile: 43 cm, magnets 1 cm wide, 4 cm apart.
    let fitting = ((0.43 - 0.01) / 0.04 + 1e-9_f64).floor() as usize + 1;
    let asked = |length: usize| {
        let length = length.to_string();
        command(&[
            "assemble",
            "homogeneous",
            "shapes/paper-tile.toml",
            "--lattice",
            "2x2",
            "--kt",
            "4e-3",
            "--coverage",
            "0.1",
            "--quiet",
            "--length",
            &length,
        ])
        .output()
        .unwrap()
    };
    let fits = asked(fitting);
    assert!(fits.status.success(), "{}", stderr(&fits));
    let wide = asked(fitting + 1);
    assert_eq!(wide.status.code(), Some(2));
    assert!(
        stderr(&wide).contains(&format!("at most {fitting}")),
        "{}",
        stderr(&wide)
    );
}
