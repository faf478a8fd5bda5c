//! `tilebind tolerance`, and `compare --by robust`.

use super::{json, tilebind};
use crate::program::{stderr, stdout};

fn design() -> String {
    format!("{}/shapes/tab-20mm.toml", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_report_has_its_keys_and_the_folder_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("tolerance");
    let out = out.to_str().unwrap();
    let file = design();
    let asked = [
        "tolerance",
        &file,
        "--strength",
        "5%",
        "--place",
        "0.2 mm",
        "--turn",
        "2 deg",
    ];
    let more = [
        "--flip", "0.01", "--draws", "100", "--checks", "0", "--json", "--out", out,
    ];
    let found = json(&[&asked[..], &more[..]].concat());
    assert_eq!(found["draws"], 100);
    let bond = &found["bond_J"];
    let of = |key: &str| bond[key].as_f64().unwrap();
    assert!(
        of("nominal") < 0.0 && of("sd") > 0.0 && of("p05") < of("mean") && of("mean") < of("p95")
    );
    let share = found["works"]["share"].as_f64().unwrap();
    let ends = [0, 1].map(|k| found["works"]["interval"][k].as_f64().unwrap());
    assert!(ends[0] <= share && share <= ends[1] && ends[0] < ends[1]);
    let matters = found["matters"].as_array().unwrap();
    let shares = matters
        .iter()
        .map(|it| it["share_of_variance"].as_f64().unwrap());
    assert!((shares.sum::<f64>() - 1.0).abs() < 1e-9);
    let magnet = matters[0]["magnet"].as_str().unwrap();
    assert!(
        magnet.starts_with("fixed ") || magnet.starts_with("moving "),
        "{magnet}"
    );
    assert!(
        found["reasons"]
            .as_array()
            .unwrap()
            .iter()
            .all(|it| it["interval"].is_array())
    );
    for name in [
        "report.json",
        "report.html",
        "draws.csv",
        "matters.csv",
        "pictures/bond.svg",
    ] {
        assert!(
            folder.path().join("tolerance").join(name).is_file(),
            "{name}"
        );
    }
    let draws = std::fs::read_to_string(folder.path().join("tolerance/draws.csv")).unwrap();
    assert_eq!(
        draws.lines().filter(|line| !line.starts_with('#')).count(),
        101
    );
}

#[test]
fn nonsense_is_refused_with_the_way_out() {
    let file = design();
    for (given, told) in [
        (&[][..], "--strength 5%"),
        (&["--place", "0.3"], "\"0.3 mm\""),
        (&["--place", "-1 mm"], "0 or a length"),
        (&["--place", "nan"], "0 or a length"),
        (&["--turn", "3"], "\"3 deg\""),
        (&["--turn", "3 mm"], "rad"),
        (&["--flip", "2"], "from 0 to 1"),
        (&["--strength", "-5%"], "from 0 to 1"),
        (&["--strength", "5%", "--batch", "1.5"], "from 0 to 1"),
        (&["--strength", "5%", "--draws", "0"], "1 or more"),
        (&["--strength", "5%", "--selectivity", "0"], "from 1e-9"),
    ] {
        let run = tilebind(&[&["tolerance", &file], given].concat());
        assert_eq!(run.status.code(), Some(2), "{given:?}: {}", stderr(&run));
        assert!(stderr(&run).contains(told), "{given:?}: {}", stderr(&run));
    }
    let run = tilebind(&["compare", &file, "--by", "robust"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(stderr(&run).contains("--strength 5%"), "{}", stderr(&run));
}

#[test]
fn designs_are_ranked_by_the_share_that_works() {
    let file = design();
    let effort = [
        "--milestones",
        "200",
        "--far-starts",
        "2",
        "--certify-cells",
        "0",
        "--complete-cells",
        "0",
    ];
    let asked = [
        "compare",
        &file,
        "--by",
        "robust",
        "--strength",
        "5%",
        "--draws",
        "50",
    ];
    let run = tilebind(&[&asked[..], &effort[..]].concat());
    assert!(run.status.success(), "{}", stderr(&run));
    assert!(stdout(&run).contains("work as made"), "{}", stdout(&run));
}

/// A share that rests on states which cannot be followed so far is not told as if it were known.
#[test]
fn errors_too_large_to_follow_states_are_told() {
    let file = design();
    let told = |place: &str, turn: &str| {
        let errors = [
            "--place", place, "--turn", turn, "--draws", "50", "--checks", "0",
        ];
        let output = tilebind(&[&["tolerance", &file], &errors[..]].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output).contains("too large to follow states")
    };
    assert!(told("3 mm", "10 deg"));
    assert!(!told("0.2 mm", "2 deg"));
}
