//! `tilebind compare`.

use std::path::Path;
use std::process::Output;

use serde_json::Value;

use crate::program::{command, stderr, stdout};

const DESIGNS: [&str; 3] = [
    "shapes/wrong-partner.toml",
    "shapes/tab-10mm.toml",
    "shapes/tab-20mm.toml",
];

fn compare(designs: &[&str], out: &Path, more: &[&str]) -> Output {
    command(&["compare"])
        .args(designs)
        .arg("--out")
        .arg(out)
        .args([
            "--milestones",
            "1500",
            "--far-starts",
            "60",
            "--complete-cells",
            "0",
        ])
        .args(more)
        .output()
        .expect("the program starts")
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap_or_else(|_| panic!("{name}"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn designs_are_ranked_and_the_proved_order_follows_from_the_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let output = compare(&DESIGNS, folder.path(), &["--threads", "1"]);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(message.is_empty(), "silent where nobody watches: {message}");

    let json: Value = serde_json::from_str(&read(folder.path(), "report.json")).unwrap();
    let designs = json["designs"].as_array().unwrap();
    let names: Vec<&str> = designs
        .iter()
        .map(|d| d["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["tab-20mm", "tab-10mm", "wrong-partner"]);
    for design in designs {
        let figures = &design["quantities"];
        let selectivity = number(&figures["bond_depth_J"]) / number(&figures["trap_depth_J"]);
        assert!((number(&figures["selectivity"]) - selectivity).abs() < 1e-12);
        for key in ["unbinding_J", "binding_J", "trap_escape_J"] {
            let [lower, value, upper] =
                ["lower", "value", "upper"].map(|part| number(&figures[key][part]));
            // A pathway is found to 0.1 % of the bond's depth; its upper bound is proved.
            let slack = 2e-3 * number(&figures["bond_depth_J"]);
            assert!(
                0.0 <= lower && lower <= value + slack && lower <= upper,
                "{figures}"
            );
            // Certified to a hundredth of the bond: an estimate by the roadmap is often far off.
            let width = upper - lower;
            assert!(
                width <= 0.0101 * number(&figures["bond_depth_J"]),
                "{key}: {figures}"
            );
        }
        let range = &design["bond"]["capture_range"];
        assert!(number(&range["offset_m"][0]) < 0.0 && number(&range["offset_m"][1]) > 0.0);
    }
    // Both tabs hold with 65 mJ, twice as well as the wrong partner: this is proved, but not which
    // of them is better.
    let proved = json["certified_order"]["unbinding"].as_array().unwrap();
    let pairs: Vec<[&str; 2]> = proved
        .iter()
        .map(|pair| ["higher", "lower"].map(|key| pair[key].as_str().unwrap()))
        .collect();
    assert_eq!(
        pairs,
        [["tab-20mm", "wrong-partner"], ["tab-10mm", "wrong-partner"]]
    );

    let table = read(folder.path(), "compare.csv");
    let lines: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    assert!(lines.iter().all(|line| line.len() == lines[0].len()));
    assert_eq!(lines.len(), 4);
    let column = lines[0]
        .iter()
        .position(|c| *c == "unbinding_lower_J")
        .unwrap();
    let cell: f64 = lines[1][column].parse().unwrap();
    let same = number(&designs[0]["quantities"]["unbinding_J"]["lower"]);
    assert!((cell - same).abs() < 1e-9);
    let markdown = read(folder.path(), "compare.md");
    let summary = stdout(&output);
    for said in ["tab-20mm", "selectivity", "Certified order"] {
        assert!(markdown.contains(said) && summary.contains(said), "{said}");
    }
    assert!(
        summary.lines().all(|line| line.chars().count() <= 120),
        "{summary}"
    );
    assert!(read(folder.path(), "pictures/ranking.svg").contains("wrong-partner"));

    let again = tempfile::tempdir().unwrap();
    compare(&DESIGNS, again.path(), &["--threads", "2", "--quiet"]);
    for name in [
        "compare.csv",
        "report.json",
        "compare.md",
        "pictures/ranking.svg",
    ] {
        assert_eq!(
            read(folder.path(), name),
            read(again.path(), name),
            "{name}"
        );
    }
}

#[test]
fn mistakes_are_found_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new");
    let wrong: [(&[&str], &[&str]); 3] = [
        (
            &["shapes/tab-10mm.toml", "tests/designs/bad/no-size.toml"],
            &[],
        ),
        (&["shapes/none.toml"], &[]),
        (&DESIGNS[..2], &["--by", "beauty"]),
    ];
    for (designs, more) in wrong {
        let output = compare(designs, &out, more);
        assert_eq!(output.status.code(), Some(2), "{designs:?} {more:?}");
        assert!(!output.stderr.is_empty() && !out.exists());
    }
}

#[test]
fn names_are_no_html_in_markdown() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("named.toml");
    let text = std::fs::read_to_string(DESIGNS[0]).unwrap();
    let text = text.replace("name = \"wrong-partner\"", "name = '<img src=x> & co'");
    std::fs::write(&design, text).unwrap();
    let designs = [design.to_str().unwrap(), DESIGNS[1]];
    let output = compare(&designs, folder.path(), &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let markdown = read(folder.path(), "compare.md");
    assert!(!markdown.contains("<img"), "{markdown}");
    // In both tables and in the proved order.
    assert!(markdown.matches("&lt;img src=x> &amp; co").count() > 2);
    assert!(stdout(&output).contains("<img src=x> & co"));
}
