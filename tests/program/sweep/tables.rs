//! The tables of a sweep.

use serde_json::Value;

use super::{DEPTH, DESIGN, QUICK, done, run, text};
use crate::folder::contents;
use crate::program::{command, stderr};

#[test]
fn every_point_is_a_row_and_an_impossible_one_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let depth = format!("{DEPTH}=0.01,0.4");
    let what = [
        DESIGN,
        "--vary",
        &depth,
        "--vary",
        "magnet.remanence=0.6,1.2",
    ];
    done(&[&what[..], &QUICK, &["--out", text(&out)]].concat());
    let json: Value = serde_json::from_slice(&contents(&out)["report.json"]).unwrap();
    let points = json["points"].as_array().unwrap();
    let expected = [(0.01, 0.6), (0.01, 1.2), (0.4, 0.6), (0.4, 1.2)];
    assert_eq!(points.len(), expected.len());
    for (point, (depth, remanence)) in points.iter().zip(expected) {
        assert_eq!(point["values"][DEPTH], depth);
        assert_eq!(point["values"]["magnet.remanence"], remanence);
    }
    // Energies are proportional to the square of the remanence.
    let bond = |k: usize| points[k]["quantities"]["bond_depth_J"].as_f64().unwrap();
    assert!((bond(1) / bond(0) - 4.0).abs() < 1e-6);
    for point in &points[2..] {
        assert_eq!(point["status"], "impossible");
        let reason = point["reason"].as_str().unwrap();
        assert!(reason.contains("sides"), "{reason}");
    }
    let table = String::from_utf8(contents(&out)["sweep.csv"].clone()).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 5);
    assert!(lines[0].starts_with(&format!(
        "index,design,{DEPTH},magnet.remanence,status,reason,"
    )));
    assert!(lines[1].starts_with("0,tab-20mm,0.01,0.6,done,,dipole,"));
    assert!(
        lines[4].starts_with("3,tab-20mm,0.4,1.2,impossible,\""),
        "{}",
        lines[4]
    );
    // Two varied numbers make a map.
    assert!(contents(&out).contains_key("pictures/map.svg"));
}

#[test]
fn keys_of_all_faces_several_designs_and_words_can_be_varied() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let designs = ["shapes/paper-tile.toml", "shapes/alternating.toml"];
    let vary = [
        "--vary",
        "fixed.faces.all.code=NNNS,N",
        "--vary",
        "magnet.size.1=0.01,0.012",
    ];
    let few = [
        "--milestones",
        "20",
        "--far-starts",
        "0",
        "--certify-cells",
        "0",
        "--complete-cells",
        "0",
    ];
    let output = run(&[&designs[..], &vary, &few, &["--out", text(&out)]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let json: Value = serde_json::from_slice(&contents(&out)["report.json"]).unwrap();
    let points = json["points"].as_array().unwrap();
    assert_eq!(points.len(), 8);
    assert_eq!(points[4]["design"], "alternating");
    let figure = |k: usize, key: &str| points[k]["quantities"][key].as_f64();
    // One magnet instead of four binds less; a wider one more.
    assert!(figure(0, "bond_depth_J") > figure(2, "bond_depth_J"));
    assert!(figure(1, "bond_depth_J") > figure(0, "bond_depth_J"));
    assert_eq!(points[0]["quantities"]["captured"]["value"], Value::Null);
    let pictures: Vec<String> = contents(&out).into_keys().collect();
    for name in ["curves-NNNS", "curves-N"] {
        assert!(
            pictures.contains(&format!("pictures/{name}.png")),
            "{pictures:?}"
        );
    }
}

/// All points are compared with a named one, and points are added where the curves bend; the same
/// sweep again has nothing to do and ends with the same bytes.
#[test]
fn points_are_set_against_one_and_added_where_figures_bend() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let depth = format!("{DEPTH}=0:0.04:3");
    let what = [
        DESIGN,
        "--vary",
        &depth,
        "--baseline",
        "depth=0 mm",
        "--refine",
        "2",
    ];
    let arguments = [&what[..], &QUICK, &["--out", text(&out)]].concat();
    let output = run(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = crate::program::stdout(&output);
    assert!(told.contains("x depth = 0 mm"), "{told}");
    let first = contents(&out);
    let json: Value = serde_json::from_slice(&first["report.json"]).unwrap();
    assert_eq!(json["baseline"], 0);
    let points = json["points"].as_array().unwrap();
    assert_eq!(points.len(), 5, "{told}");
    let depths: Vec<f64> = points
        .iter()
        .map(|point| point["values"][DEPTH].as_f64().unwrap())
        .collect();
    assert!(depths.is_sorted() && depths.contains(&0.02), "{depths:?}");
    assert_eq!(run(&arguments).status.code(), Some(0));
    assert!(first == contents(&out));
}

#[test]
fn analyse_compare_and_sweep_of_a_design_give_the_same_figures() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let report = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(out(name).join("report.json")).unwrap()).unwrap()
    };
    let same = ["--seed", "7"];
    let depth = format!("{DEPTH}=0.02,0.021");
    let to = out("sweep");
    done(
        &[
            &[DESIGN, "--vary", &depth, "--out", text(&to)],
            &QUICK[..],
            &same,
        ]
        .concat(),
    );
    let by = |words: &[&str], name: &str, effort: &[&str]| {
        let to = out(name);
        let all = [words, &[DESIGN, "--out", text(&to)], effort, &same].concat();
        let output = command(&all).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    };
    by(&["compare"], "compare", &QUICK);
    // Its own options count work instead of cells; neither proof changes what is found.
    let effort = [
        &QUICK[..4],
        &["--certify-work", "0", "--complete-work", "0"],
    ]
    .concat();
    by(&["analyse"], "analyse", &effort);
    let (swept, compared) = (report("sweep"), report("compare"));
    assert_eq!(swept["seed"], 7);
    let of_design = &compared["designs"][0]["quantities"];
    assert!(of_design["captured"]["value"].is_number());
    assert_eq!(&swept["points"][0]["quantities"], of_design);
    let analysed = report("analyse");
    let states = analysed["states"].as_array().unwrap().iter();
    let bonds = states.filter(|state| state["kind"] == "bound");
    let captured: f64 = bonds
        .map(|bond| bond["capture"]["count"].as_f64().unwrap())
        .sum();
    assert_eq!(
        captured / 20.0,
        of_design["captured"]["value"].as_f64().unwrap()
    );
}
