//! A sweep in parts gives the same as a whole sweep.

use super::{DEPTH, DESIGN, QUICK, assert_same, done, run, text};
use crate::folder::contents;
use crate::program::stderr;

#[test]
fn parts_merged_are_the_sweep_of_one_process_byte_for_byte() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    let depth = format!("{DEPTH}=0.01,0.02,0.4");
    let what = [
        DESIGN,
        "--vary",
        &depth,
        "--vary",
        "potential.model=dipole,cuboid",
    ];
    let planned = [&what[..], &QUICK].concat();
    let summary = done(&[&planned[..], &["--threads", "2", "--out", text(&whole)]].concat());
    assert!(
        summary.contains("6 points: 4 done, 2 impossible"),
        "{summary}"
    );

    let plan = parts.join("plan.json");
    let plan = text(&plan);
    done(&[&planned[..], &["--plan", plan]].concat());
    assert_eq!(done(&["--status", plan]), "6 points: 6 missing\n");
    let early = run(&["--merge", plan]);
    assert_eq!(early.status.code(), Some(1));
    assert!(stderr(&early).contains("6 missing"), "{}", stderr(&early));
    for part in ["3/3", "1/3", "2/3"] {
        done(&["--run", plan, "--shard", part, "--threads", "1"]);
    }
    // A finished part has nothing left to do.
    done(&["--run", plan, "--shard", "1/3", "--threads", "1"]);
    assert_eq!(
        done(&["--status", plan]),
        "6 points: 4 done, 2 impossible\n"
    );
    let status: serde_json::Value =
        serde_json::from_str(&done(&["--status", plan, "--json"])).unwrap();
    assert_eq!(status["impossible"], 2);
    done(&["--merge", plan]);
    assert_same(&whole, &parts);
    assert!(contents(&whole).contains_key("pictures/curves.svg"));
}

#[test]
fn a_manifest_names_its_points_and_needs_no_design_file_any_more() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("mine.toml");
    std::fs::copy(DESIGN, &design).unwrap();
    let depth = format!("{DEPTH}=0.01:0.02:2");
    let out = folder.path().join("out");
    let arguments = [
        text(&design),
        "--vary",
        &depth,
        "--plan",
        "--out",
        text(&out),
    ];
    let said = done(&[&arguments[..], &QUICK].concat());
    assert!(said.starts_with("2 points planned"), "{said}");
    std::fs::remove_file(&design).unwrap();
    let plan: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("plan.json")).unwrap()).unwrap();
    // The folder of a manifest stands for it.
    done(&["--run", text(&out), "--threads", "2", "--quiet"]);
    let names: Vec<String> = contents(&out).into_keys().collect();
    for point in plan["points"].as_array().unwrap() {
        let name = point["point"].as_str().unwrap();
        assert_eq!(point["seed"], 1);
        assert!(names.contains(&format!("points/{name}.json")), "{names:?}");
    }
}

#[test]
fn points_are_shared_by_sweeps_and_not_by_other_settings() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let depth = |values: &str| format!("{DEPTH}={values}");
    let points = |values: &str, more: &[&str]| {
        let vary = depth(values);
        let what = [DESIGN, "--vary", &vary, "--out", text(&out), "--plan"];
        done(&[&what[..], &QUICK, more].concat());
        let plan = std::fs::read(out.join("plan.json")).unwrap();
        let plan: serde_json::Value = serde_json::from_slice(&plan).unwrap();
        let points = plan["points"].as_array().unwrap().iter();
        points
            .map(|p| p["point"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    let few = points("0.01,0.02", &[]);
    let many = points("0:0.03:4", &[]);
    assert_eq!(few, many[1..3]);
    let other = points("0.01,0.02", &["--seed", "2"]);
    let finer = points("0.01,0.02", &["--settled", "0.001"]);
    assert!(
        few.iter()
            .all(|name| !other.contains(name) && !finer.contains(name))
    );
}

/// The manifest holds the drawings; a changed one makes other points, and one that is missing a row.
#[test]
fn a_drawing_is_part_of_the_point() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("mine.toml");
    let face = std::fs::read_to_string("shapes/drawn-wave.svg").unwrap();
    std::fs::copy("shapes/drawn-wave.toml", &design).unwrap();
    for name in ["drawn-wave.svg", "b.svg"] {
        std::fs::write(folder.path().join(name), &face).unwrap();
    }
    let plan = folder.path().join("plan.json");
    let files = "fixed.faces.east.profile.file=drawn-wave.svg,b.svg,c.svg";
    let arguments = [text(&design), "--vary", files, "--plan", text(&plan)];
    let names = || -> Vec<String> {
        done(&[&arguments[..], &QUICK].concat());
        let plan: serde_json::Value =
            serde_json::from_slice(&std::fs::read(&plan).unwrap()).unwrap();
        let points = plan["points"].as_array().unwrap().iter();
        points.map(|point| point["point"].to_string()).collect()
    };
    let before = names();
    std::fs::write(folder.path().join("b.svg"), face.replace("-20", "-19")).unwrap();
    let after = names();
    assert_eq!(before[0], after[0]);
    assert_ne!(before[1], after[1]);
    assert_eq!(before[2], after[2]);
    // The manifest is enough.
    for name in ["mine.toml", "drawn-wave.svg", "b.svg"] {
        std::fs::remove_file(folder.path().join(name)).unwrap();
    }
    done(&["--run", text(&plan)]);
    let summary = done(&["--merge", text(&plan)]);
    assert!(
        summary.contains("3 points: 2 done, 1 impossible"),
        "{summary}"
    );
    let table = std::fs::read_to_string(folder.path().join("sweep.csv")).unwrap();
    assert!(
        table.contains("cannot read the drawing \"\"c.svg\"\""),
        "{table}"
    );
}
