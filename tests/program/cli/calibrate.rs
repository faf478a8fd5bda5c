//! `tilebind calibrate` on measurements that the program makes itself.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{json, numbers, tilebind};
use crate::program::{command, stderr, stdout};

/// The shielded squares of `shapes`, without the shields.
fn bare() -> String {
    let text = std::fs::read_to_string("shapes/shielded-backs.toml").unwrap();
    let text = text.replace("west = { shield = false }", "");
    let (head, rest) = text.split_once("\n[shield]\n").unwrap();
    let (_, tail) = rest.split_once("\n[fixed]\n").unwrap();
    format!("{head}\n[fixed]\n{tail}\n")
}

const TRUTH: [(&str, f64); 4] = [
    ("attenuation", 0.7),
    ("length", 0.025),
    ("width", 0.4),
    ("front_gain", 1.15),
];

/// The tiles with shields; their magnets are 2 % stronger than the design file of the fit says.
fn shielded(folder: &Path, iron: bool) -> PathBuf {
    let file = folder.join(if iron { "iron.toml" } else { "bare.toml" });
    let mut text = bare().replace("remanence = 1.2", "remanence = 1.224");
    if iron {
        text.push_str("[shield]\n");
        for (name, value) in TRUTH {
            writeln!(text, "{name} = {value}").unwrap();
        }
    }
    std::fs::write(&file, text).unwrap();
    file
}

/// A table of energies and forces at poses all around the fixed tile, as the program computes
/// them.
fn table(folder: &Path) -> PathBuf {
    let mut table = "# made, not measured\nx_m,y_m,theta_rad,iron,energy_J,force_x_N\n".to_owned();
    for (iron, count) in [(true, 60), (false, 20)] {
        let design = shielded(folder, iron);
        let mut arguments = vec!["energy".to_owned(), design.display().to_string()];
        for i in 0..count {
            let t = f64::from(i);
            let (distance, direction) = (0.115 + 0.0005 * t, 1.3 * t);
            let theta = (2.1 * t) % std::f64::consts::TAU;
            let (x, y) = (distance * direction.cos(), distance * direction.sin());
            arguments.push(format!("--pose={x},{y},{theta}"));
        }
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        for entry in json(&arguments).as_array().unwrap() {
            let pose: Vec<String> = numbers(&entry["pose"]).iter().map(f64::to_string).collect();
            let (energy, force) = (&entry["energy_J"], numbers(&entry["force_N"])[0]);
            let iron = u8::from(iron);
            writeln!(table, "{},{iron},{energy},{force}", pose.join(",")).unwrap();
        }
    }
    let file = folder.join("table.csv");
    std::fs::write(&file, table).unwrap();
    file
}

#[test]
fn the_constants_behind_a_table_are_found_and_may_be_pasted_into_a_design() {
    let folder = tempfile::tempdir().unwrap();
    let table = table(folder.path());
    let design = folder.path().join("design.toml");
    std::fs::write(&design, bare()).unwrap();
    let arguments = [
        "calibrate",
        design.to_str().unwrap(),
        table.to_str().unwrap(),
    ];
    let found = json(&[&arguments[..], &["--json"]].concat());
    for (name, truth) in TRUTH {
        let key = if name == "length" { "length_m" } else { name };
        let value = found["shield"][key].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 1e-3, "{found}");
    }
    assert!((found["strength"].as_f64().unwrap() - 1.02f64.powi(2)).abs() < 1e-6);
    let held_out = &found["held_out"];
    assert_eq!(
        (&held_out["rows"], &held_out["rows_with_iron"]),
        (&16.into(), &12.into())
    );
    assert!(held_out["relative"]["energy_J"].as_f64().unwrap() < 1e-4);
    assert_eq!(held_out["rms"]["torque_Nm"], Value::Null);

    let output = command(&arguments).env("COLUMNS", "60").output().unwrap();
    let summary = stdout(&output);
    assert!(summary.contains("magnets as dipoles"), "{summary}");
    let widest = summary.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(60), "{summary}");
    let blocks = tilebind(&[&arguments[..], &["--model", "cuboid"]].concat());
    assert!(stdout(&blocks).contains("magnets as blocks"));
    assert!(
        summary
            .replace('\n', " ")
            .contains("remanence or moment by 1.0200"),
        "{summary}"
    );
    let pasted: Vec<&str> = summary
        .lines()
        .skip_while(|line| *line != "[shield]")
        .take(5)
        .collect();
    let design = folder.path().join("pasted.toml");
    std::fs::write(&design, format!("{}\n{}\n", bare(), pasted.join("\n"))).unwrap();
    let energy = |design: &Path| {
        let pose = "--pose=0.09,0.02,0.01";
        json(&["energy", design.to_str().unwrap(), pose])[0]["energy_J"]
            .as_f64()
            .unwrap()
    };
    let (pasted, truth) = (energy(&design), energy(&shielded(folder.path(), true)));
    assert!((pasted * 1.02f64.powi(2) / truth - 1.0).abs() < 1e-3);
}

#[test]
fn a_wrong_table_is_answered_with_file_line_and_mend() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("table.csv");
    let message = |text: &str| {
        std::fs::write(&file, text).unwrap();
        let output = tilebind(&[
            "calibrate",
            "tests/designs/good/flat.toml",
            file.to_str().unwrap(),
        ]);
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        assert!(output.stdout.is_empty());
        stderr(&output)
    };
    let head = "x_m,y_m,theta_rad,iron,energy_J\n";
    for (text, part) in [
        ("x,y\n", "unknown column `x`"),
        (
            &format!("{head}0.44,0,0,1,a\n"),
            "line 2: `a` is not a number for energy_J",
        ),
        (&format!("{head}440,0,0,yes,-1\n"), "line 2: `yes`"),
        (
            &format!("{head}0.3,0,0,1,-1\n"),
            "line 2: the tiles overlap by 130.00 mm",
        ),
        (&format!("{head}0.45,0,0,1,-1\n"), "too few"),
    ] {
        let told = message(text);
        assert!(
            told.contains("table.csv: ") && told.contains(part),
            "{told}"
        );
    }
    let output = tilebind(&["calibrate", "tests/designs/good/flat.toml", "nowhere.csv"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("nowhere.csv"));
}

/// Forces (N) straight apart of tiles with blocks of this remanence (T), whose poles are `further` (m)
/// apart than the design says.
fn forces(folder: &Path, remanence: f64, further: f64) -> Vec<(f64, f64)> {
    let text = std::fs::read_to_string("tests/designs/good/flat.toml").unwrap();
    let text = text.replace("remanence = 1.2", &format!("remanence = {remanence}"));
    let file = folder.join("made.toml");
    std::fs::write(&file, text).unwrap();
    let gaps = [0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0];
    let pose = |gap: &f64| format!("--pose={},0,0", 0.43 + 1e-3 * gap + further);
    let poses: Vec<String> = gaps.iter().map(pose).collect();
    let mut arguments = vec!["energy", file.to_str().unwrap(), "--model", "cuboid"];
    arguments.extend(poses.iter().map(String::as_str));
    let found = json(&arguments);
    let forces = found.as_array().unwrap().iter();
    let forces = forces.map(|entry| -numbers(&entry["force_N"])[0]);
    gaps.into_iter().zip(forces).collect()
}

fn fitted(folder: &Path, table: &str) -> Value {
    let file = folder.join("gaps.csv");
    std::fs::write(&file, table).unwrap();
    let design = "tests/designs/good/flat.toml";
    let file = file.to_str().unwrap();
    json(&[
        "calibrate",
        design,
        "--model",
        "cuboid",
        "--gaps",
        file,
        "--json",
    ])
}

#[test]
fn a_kitchen_scale_gives_the_remanence_and_the_zero_of_the_gap() {
    let folder = tempfile::tempdir().unwrap();
    let (remanence, further) = (1.07, 1.5e-4);
    let mut table = "gap_mm,force_g\n".to_owned();
    for (gap, force) in forces(folder.path(), remanence, further) {
        writeln!(table, "{gap},{:.0}", force / 9.806_65e-3).unwrap();
    }
    let found = fitted(folder.path(), &table);
    let [low, high] = [0, 1].map(|k| numbers(&found["interval_T"])[k]);
    assert!(low <= remanence && remanence <= high, "{found}");
    assert!(high / low < 1.02, "{found}");
    let ends = numbers(&found["gap_offset_interval_m"]);
    assert!(ends[0] <= further && further <= ends[1], "{found}");
    assert_eq!(found["fits"], true);

    // The same forces in pounds, with a sign, and as repulsion: the same remanence.
    let mut pounds = "force (lb);gap\n".to_owned();
    for (gap, force) in forces(folder.path(), remanence, further) {
        writeln!(pounds, "-{:.6};{} cm", force / 4.448_221_615, 0.1 * gap).unwrap();
    }
    let again = fitted(folder.path(), &pounds);
    let off = again["remanence_T"].as_f64().unwrap() / remanence - 1.0;
    assert!(off.abs() < 1e-4, "{again}");
}

#[test]
fn forces_that_no_remanence_explains_are_not_given_one() {
    let folder = tempfile::tempdir().unwrap();
    // A force that falls with the square of the gap plus 4 mm, unlike that of any of these magnets.
    let rows = (0..6).map(|k| format!("{},{:.0}\n", 2 * k, 9e4 / f64::from(2 * k + 4).powi(2)));
    let table = format!("gap_mm,force_g\n{}", rows.collect::<String>());
    let found = fitted(folder.path(), &table);
    assert_eq!(found["fits"], false, "{found}");
    let few = fitted(folder.path(), "gap_mm,force_g\n1,500\n");
    assert_eq!(few["interval_T"], Value::Null);
    assert_eq!(few["gap_offset_m"], 0.0);
}

#[test]
fn rows_without_iron_alone_give_the_strength() {
    let folder = tempfile::tempdir().unwrap();
    let mut table = "x_m,y_m,theta_rad,iron,force_x_N\n".to_owned();
    for (gap, force) in forces(folder.path(), 1.1, 0.0) {
        writeln!(table, "{},0,0,0,{}", 0.43 + 1e-3 * gap, -force).unwrap();
    }
    let file = folder.path().join("bare.csv");
    std::fs::write(&file, table).unwrap();
    let design = "tests/designs/good/flat.toml";
    let arguments = [
        "calibrate",
        design,
        file.to_str().unwrap(),
        "--model",
        "cuboid",
        "--json",
    ];
    let found = json(&arguments);
    assert!(
        (found["remanence_T"].as_f64().unwrap() / 1.1 - 1.0).abs() < 1e-6,
        "{found}"
    );
    super::refused(
        &[&arguments[..], &["--hold-out", "4"]].concat(),
        &["no row has iron", "leave it out"],
    );
}
