//! The second reader confirms what analyses state, and notices every number that is changed by hand.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};
use tempfile::tempdir;
use tilebind::design::Design;

use crate::program::{command, stderr};
use crate::readme::with_shapes;
use crate::small_design;

const EFFORT: &str = "--milestones 300 --far-starts 30 --certify-work 0.2 --complete-work 0.1";
const LITTLE: &str =
    "--milestones 150 --far-starts 20 --certify-work 0.05 --complete-work 0.02 --force";

fn analyse(folder: &Path, design: &str, out: &str, more: &str) {
    analyse_with(folder, design, out, &format!("{EFFORT} {more}"));
}

fn analyse_with(folder: &Path, design: &str, out: &str, options: &str) {
    let words = format!("analyse {design} --out {out} --no-pictures --quiet --threads 1 {options}");
    let words: Vec<&str> = words.split_whitespace().collect();
    let done = command(&words).current_dir(folder).output();
    let done = done.expect("the program");
    assert!(done.status.success(), "{}", stderr(&done));
}

/// The exit status, and the report of checks.
fn verify(folder: &Path, outs: &[&str]) -> (Option<i32>, Value) {
    let words = ["verify", "--json", "--threads", "1"];
    let done = command(&words).args(outs).current_dir(folder).output();
    let done = done.expect("the program");
    let report = serde_json::from_slice(&done.stdout);
    (
        done.status.code(),
        report.unwrap_or_else(|_| panic!("{}", stderr(&done))),
    )
}

#[test]
fn results_of_dipoles_are_confirmed() {
    let folder = with_shapes();
    let here = folder.path();
    analyse(here, "shapes/tab-20mm.toml", "dipoles", "");
    analyse(here, "shapes/tab-20mm.toml", "again", "--seed 2");
    analyse(
        here,
        "shapes/tab-20mm.toml",
        "blocks",
        "--model cuboid --kinds 3",
    );
    analyse(here, "shapes/shielded-backs.toml", "shields", "--kinds 4");
    let (status, report) = verify(here, &["dipoles", "again", "shields"]);
    assert_eq!(report["contradictions"], json!([]));
    assert_eq!((status, &report["verified"]), (Some(0), &json!(true)));
    let checks = report["checks"].as_array().expect("checks");
    for check in checks {
        assert!(check["confirmed"].as_u64() > Some(0), "{check}");
    }
}

/// Discs on edge, discs and blocks that stand, and a rule by which energies jump: states and pathways
/// by formulas of the reader's own.
#[test]
fn results_of_other_magnets_and_rules_are_confirmed_as_far_as_they_go() {
    let folder = with_shapes();
    let here = folder.path();
    fs::write(here.join("discs.toml"), tab_with(DISC, "0.002")).expect("a design");
    fs::write(here.join("upright.toml"), tab_with(UPRIGHT, "0.002")).expect("a design");
    let shielded = tab_with(UPRIGHT, "0.002") + SHIELD;
    fs::write(here.join("shielded.toml"), shielded).expect("a design");
    for (design, has_bounds) in [
        ("shapes/upright-discs.toml", true),
        ("shapes/shielded-nearest-face.toml", false),
        ("discs.toml", true),
        ("upright.toml", true),
        ("shielded.toml", true),
    ] {
        is_confirmed(here, design, has_bounds);
    }
}

/// Magnets that touch take longest.
#[test]
#[ignore = "slow"]
fn results_of_magnets_that_touch_are_confirmed() {
    let folder = with_shapes();
    let here = folder.path();
    for (design, magnet) in [("discs.toml", DISC), ("upright.toml", UPRIGHT)] {
        fs::write(here.join(design), tab_with(magnet, "0.0")).expect("a design");
        is_confirmed(here, design, true);
    }
}

const DISC: &str = "shape = \"disc\"\ndiameter = 0.01\nheight = 0.003";
const SHIELD: &str = "\n[shield]\nattenuation = 0.8\nlength = 0.02\nwidth = 0.3\n";
const UPRIGHT: &str = "axis = \"up\"\nsize = [0.004, 0.010, 0.003]";

/// The shipped tab with other magnets, at an inset (m).
fn tab_with(magnet: &str, inset: &str) -> String {
    let text = fs::read_to_string("shapes/tab-20mm.toml").expect("a design");
    let [size, flush] = ["size = [0.010, 0.010, 0.003]", "inset = 0.0"];
    assert!(text.contains(size) && text.contains(flush));
    let text = text.replace(size, magnet);
    let text = text.replace(flush, &format!("inset = {inset}"));
    match magnet {
        UPRIGHT => text.replace('N', "U").replace('S', "D"),
        _ => text,
    }
}

/// What a small analysis says is confirmed, bounds of barriers as well if it has them.
fn is_confirmed(here: &Path, design: &str, has_bounds: bool) {
    let out = design.replace("shapes/", "").replace(".toml", "");
    let model = if design.contains("shapes") {
        ""
    } else {
        "--model cuboid"
    };
    analyse_with(here, design, &out, &format!("{LITTLE} --kinds 2 {model}"));
    let (status, report) = verify(here, &[&out]);
    assert_eq!(report["contradictions"], json!([]), "{design}");
    assert_eq!(status, Some(0), "{design}");
    let unchecked = report["unchecked"].as_array().expect("a list");
    assert_eq!(unchecked.is_empty(), has_bounds, "{design}: {unchecked:?}");
    for why in unchecked {
        let why = why.to_string();
        assert!(why.contains("bounds of barriers: none are stated"), "{why}");
    }
    for check in report["checks"].as_array().expect("checks") {
        if ["energies of states", "energies on pathways", "saddles"]
            .contains(&check["check"].as_str().expect("a name"))
        {
            assert!(check["confirmed"].as_u64() > Some(0), "{design}: {check}");
            assert_eq!(check["undecided"], 0, "{design}: {check}");
        }
    }
}

#[test]
fn what_cannot_be_read_is_said() {
    let empty = tempdir().expect("a folder");
    let done = command(&["verify"])
        .arg(empty.path())
        .output()
        .expect("the program");
    assert_eq!(done.status.code(), Some(2));
    assert!(stderr(&done).contains("report.json"), "{}", stderr(&done));
}

/// A random small design.
fn random_design(seed: u64) -> String {
    let bytes: [u8; 96] = ChaCha8Rng::seed_from_u64(seed).random();
    small_design::of(&bytes)
}

/// Analyses of random small designs by two seeds each, this many that are designs from a seed on, and what
/// their checks confirm.
fn random_designs(first: u64, count: usize) -> BTreeMap<String, u64> {
    let folder = tempdir().expect("a folder");
    let here = folder.path();
    let mut confirmed = BTreeMap::new();
    let mut found = 0;
    for seed in first.. {
        if found == count {
            break;
        }
        let text = random_design(seed);
        if Design::parse(&text, "random.toml").is_err() {
            continue;
        }
        // Analyses of discs that can touch take minutes.
        if text.contains("disc") && text.contains("inset = 0\n") {
            continue;
        }
        fs::write(here.join("random.toml"), &text).expect("a design");
        found += 1;
        for (out, seed) in [("one", 1), ("two", 2)] {
            analyse_with(here, "random.toml", out, &format!("{LITTLE} --seed {seed}"));
        }
        let (status, report) = verify(here, &["one", "two"]);
        assert_eq!(report["contradictions"], json!([]), "seed {seed}:\n{text}");
        assert_eq!(status, Some(0), "seed {seed}");
        println!("{found}: seed {seed}");
        for check in report["checks"].as_array().expect("checks") {
            let name = check["check"].as_str().expect("a name").to_owned();
            *confirmed.entry(name).or_default() += check["confirmed"].as_u64().unwrap_or_default();
            *confirmed.entry("undecided".to_owned()).or_default() +=
                check["undecided"].as_u64().unwrap_or_default();
        }
    }
    confirmed
}

#[test]
fn results_of_random_designs_are_confirmed() {
    let confirmed = random_designs(0, 3);
    assert!(confirmed["bounds of several runs"] > 0, "{confirmed:?}");
}

/// A descent ends 0.3 um from the bond, which is flat to 2e-8 of its depth, and the most probable way into
/// the bond along it.
#[test]
fn ways_along_descents_that_end_beside_a_flat_minimum_reach_it() {
    let folder = tempdir().expect("a folder");
    let here = folder.path();
    fs::write(here.join("flat.toml"), random_design(67)).expect("a design");
    analyse_with(here, "flat.toml", "R", LITTLE);
    let (status, report) = verify(here, &["R"]);
    assert_eq!(report["contradictions"], json!([]));
    assert_eq!(status, Some(0));
}

/// `cargo test --release --test program -- --ignored --nocapture hundred` prints the figures;
/// `TILEBIND_FIRST` is the first seed.
#[test]
#[ignore = "slow"]
fn results_of_a_hundred_random_designs_are_confirmed() {
    let first = std::env::var("TILEBIND_FIRST");
    let first = first.map_or(0, |seed| seed.parse().expect("a seed"));
    println!("{:#?}", random_designs(first, 100));
}

/// A pathway that is no file of the folder, and outlines that have no distance, are contradictions.
#[test]
fn pathways_outside_the_folder_and_empty_outlines_are_noticed() {
    let folder = with_shapes();
    let here = folder.path();
    analyse(here, "shapes/tab-20mm.toml", "R", "--kinds 1");
    let file = here.join("R/report.json");
    let text = fs::read_to_string(&file).expect("a report");
    let whole: Value = serde_json::from_str(&text).expect("JSON");
    let barriers = whole["barriers"].as_array().expect("barriers");
    let number = barriers.iter().position(|it| it["pathway"].is_string());
    let number = number.expect("a pathway");
    let name = barriers[number]["pathway"].as_str().expect("a name");
    let outside = here.join("outside.csv");
    fs::copy(here.join("R").join(name), &outside).expect("copied");
    let contradicted = |report: &Value, word: &str| {
        fs::write(&file, report.to_string()).expect("written");
        let (status, found) = verify(here, &["R"]);
        assert_eq!(status, Some(1), "{word}");
        let told = found["contradictions"].to_string();
        assert!(told.contains(word), "{told}");
    };
    let absolute = outside.display().to_string();
    for name in ["../outside.csv", &absolute, "pathways/none.csv"] {
        let mut report = whole.clone();
        report["barriers"][number]["pathway"] = json!(name);
        contradicted(&report, "no pathway");
    }
    for tile in ["fixed", "moving"] {
        let mut report = whole.clone();
        report["tiles"][tile]["outline_m"] = json!([]);
        contradicted(&report, "overlap");
        let mut report = whole.clone();
        report["tiles"][tile]["faces"] = json!([]);
        contradicted(&report, "a face that it does not have");
    }
}

/// Every number of report.json that is checked, by its path; a star stands for any place of a list.
const CHECKED: [&str; 22] = [
    "/bound/energy_J",
    "/bound/pose/1",
    "/states/*/energy_J",
    "/states/*/pose/0",
    "/states/*/pose/2",
    "/states/*/id",
    "/states/*/class",
    "/states/*/copies",
    "/states/*/capture/count",
    "/states/*/capture/share",
    "/states/*/capture/of",
    "/states/*/block_energy_J",
    "/free/capture/count",
    "/free/at_rest/count",
    "/inventory/escape_J",
    "/barriers/*/saddle_energy_J",
    "/barriers/*/saddle_pose/0",
    "/barriers/*/forward_J",
    "/barriers/*/reverse_J",
    "/barriers/*/length_m",
    "/barriers/*/work_J",
    "/tiles/moving/magnets/*/moment_Am2",
];

#[test]
fn every_changed_number_is_noticed() {
    let folder = with_shapes();
    let here = folder.path();
    analyse(here, "shapes/tab-20mm.toml", "R", "");
    let file = here.join("R/report.json");
    let text = fs::read_to_string(&file).expect("a report");
    let whole: Value = serde_json::from_str(&text).expect("JSON");
    let noticed = |report: &Value, what: &str| {
        fs::write(&file, report.to_string()).expect("written");
        let (status, found) = verify(here, &["R"]);
        assert_eq!(status, Some(1), "{what}: {}", found["checks"]);
    };
    for path in CHECKED {
        let path = path.replace('*', "1");
        let mut report = whole.clone();
        let number = report.pointer_mut(&path).filter(|it| it.is_number());
        let number = number.unwrap_or_else(|| panic!("no number: {path}"));
        // Work is known to a share of the pathway's range, as files leave points out.
        let more = if path.contains("work") { 1e-4 } else { 1e-5 };
        *number = match number.as_u64() {
            Some(count) => json!(count + 1),
            None => json!(number.as_f64().map_or(0.0, |x| x * 1.001 + more)),
        };
        noticed(&report, &path);
    }
    // Bounds beyond each other, and one that the pathway exceeds.
    let bond = whole["barriers"].as_array().expect("barriers");
    let bond = bond
        .iter()
        .position(|it| it["from"] == 0 && it["to"] == "free")
        .expect("the bond's");
    let barrier = &whole["barriers"][bond];
    for (key, value) in [
        (
            "lower_J",
            barrier["upper_J"].as_f64().expect("bounds") + 1e-6,
        ),
        (
            "upper_J",
            barrier["saddle_energy_J"].as_f64().expect("a saddle") - 1e-6,
        ),
    ] {
        let mut report = whole.clone();
        report["barriers"][bond][key] = json!(value);
        noticed(&report, key);
    }
    fs::write(&file, &text).expect("written");

    let name = barrier["pathway"].as_str().expect("a pathway");
    let file = here.join("R").join(name);
    let text = fs::read_to_string(&file).expect("a pathway");
    let lines: Vec<&str> = text.lines().collect();
    for column in 0..6 {
        let mut cells: Vec<String> = lines[lines.len() / 2]
            .split(',')
            .map(str::to_owned)
            .collect();
        let number: f64 = cells[column].parse().expect("a number");
        cells[column] = (number * 1.001 + 1e-5).to_string();
        let mut changed: Vec<String> = lines.iter().map(|it| (*it).to_owned()).collect();
        changed[lines.len() / 2] = cells.join(",");
        fs::write(&file, changed.join("\n")).expect("written");
        let (status, _) = verify(here, &["R"]);
        assert_eq!(status, Some(1), "column {column}");
    }
}
