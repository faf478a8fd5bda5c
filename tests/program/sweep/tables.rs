//! What a sweep writes.

use serde_json::Value;

use super::{DEPTH, DESIGN, QUICK, done, run, text};
use crate::folder::contents;
use crate::program::stderr;

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
    let json: Value = serde_json::from_slice(&contents(&out)["sweep.json"]).unwrap();
    let points = json["points"].as_array().unwrap();
    let expected = [(0.01, 0.6), (0.01, 1.2), (0.4, 0.6), (0.4, 1.2)];
    assert_eq!(points.len(), expected.len());
    for (point, (depth, remanence)) in points.iter().zip(expected) {
        assert_eq!(point["values"][DEPTH], depth);
        assert_eq!(point["values"]["magnet.remanence"], remanence);
    }
    // Energies go with the square of the remanence.
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
        "100",
        "--far-starts",
        "0",
        "--certify-cells",
        "0",
    ];
    let output = run(&[&designs[..], &vary, &few, &["--out", text(&out)]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let json: Value = serde_json::from_slice(&contents(&out)["sweep.json"]).unwrap();
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
