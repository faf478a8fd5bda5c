//! The first steps of a new user: designs to start from, mistakes, inspection of a design, files
//! for the workshop.

use std::fs;

use super::{json, numbers, tilebind};
use crate::program::{command, stderr, stdout};

/// Every possible design is valid, binds, and has no rival of its bond.
#[test]
fn designs_to_start_from_are_sound_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    for (sides, side) in [("3", "3 cm"), ("4", "0.05"), ("6", "0.12"), ("12", "0.2")] {
        for shape in ["flat", "tab", "arc", "sine", "triangle"] {
            for magnets in ["1", "3", "8"] {
                let name = format!("{sides}-{shape}-{magnets}.toml");
                let file = folder.path().join(&name);
                let file = file.to_str().unwrap();
                let asked = ["--sides", sides, "--side", side, "--shape", shape];
                let output =
                    tilebind(&[&["init", file, "--magnets", magnets], &asked[..]].concat());
                assert_eq!(output.status.code(), Some(0), "{name}: {}", stderr(&output));
                let shown = json(&["show", file, "--json"]);
                assert_eq!(shown["wrong"], serde_json::json!([]), "{name}");
                assert!(shown["pull_contact_N"].as_f64().unwrap() > 0.0, "{name}");
                let code = shown["fixed"][0]["code"].as_str().unwrap();
                assert_eq!(code.len().to_string(), magnets, "{name}");
            }
        }
    }
}

#[test]
fn a_design_to_start_from_docks() {
    let folder = tempfile::tempdir().unwrap();
    let [file, out] = ["hexagon.toml", "out"].map(|name| folder.path().join(name));
    let [file, out] = [&file, &out].map(|path| path.to_str().unwrap());
    let asked = [
        "--sides",
        "6",
        "--side",
        "0.12",
        "--magnets",
        "3",
        "--shape",
        "arc",
    ];
    assert!(
        tilebind(&[&["init", file], &asked[..]].concat())
            .status
            .success()
    );
    let quick = [
        "--milestones",
        "1500",
        "--far-starts",
        "100",
        "--complete-seconds",
        "0",
        "--certify-seconds",
        "0",
    ];
    let report = json(&[&["analyse", file, "--out", out, "--json"], &quick[..]].concat());
    let states = report["states"].as_array().unwrap();
    assert_eq!(states[0]["kind"], "bound");
    assert!(states[0]["capture"]["share"].as_f64().unwrap() > 0.25);
    let energy = |k: usize| states[k]["energy_J"].as_f64().unwrap();
    assert!((1..states.len()).all(|k| energy(k) > 0.5 * energy(0)));
}

#[test]
fn impossible_designs_say_what_to_ask_for() {
    for (asked, said) in [
        (&["--sides", "2"][..], "give 3 to 24"),
        (&["--magnets", "40"], "give 1 to 16"),
        (&["--side", "500"], "give sides of 0.01 to"),
        (&["--shape", "dovetail"], "a shape is one of flat, tab"),
        (&["--side", "2 kg"], "such as 0.12 (m) or \"12 cm\""),
    ] {
        let output = tilebind(&[&["init", "-"], asked].concat());
        assert_eq!(output.status.code(), Some(2), "{asked:?}");
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn what_init_proposes_is_possible() {
    let inches = ["--side", "10 cm", "--magnet", "0.5 x 0.25 in N52"];
    let output = tilebind(&[&["init", "-"], &inches[..]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    for asked in [
        ["--side", "2 cm", "--magnets", "8"],
        ["--side", "5 cm", "--magnet", "0.5 x 0.25 in N52"],
    ] {
        let output = tilebind(&[&["init", "-"], &asked[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{asked:?}");
        let told = stderr(&output);
        let words: Vec<&str> = told.split_whitespace().collect();
        for option in ["--magnets", "--side"] {
            let at = words.iter().position(|word| *word == option).expect(option);
            let given = asked.chunks(2).filter(|pair| pair[0] != option);
            let given: Vec<&str> = given.flatten().copied().collect();
            let mended = [&["init", "-"], &given[..], &words[at..at + 2]].concat();
            let output = tilebind(&mended);
            assert!(
                output.status.success(),
                "{told}{mended:?}: {}",
                stderr(&output)
            );
        }
    }
}

#[test]
fn all_faults_of_a_file_are_told() {
    let output = tilebind(&["show", "tests/designs/bad/all-kinds-of-faults.toml"]);
    assert_eq!(output.status.code(), Some(2));
    let told = stderr(&output);
    assert_eq!(told.matches("= help:").count(), 8, "{told}");
    assert!(output.stdout.is_empty());
}

#[test]
fn what_is_doubtful_is_not_taken_without_a_word() {
    let design = "shapes/paper-tile.toml";
    let output = tilebind(&["energy", design, "--pose", "104,0,0"]);
    assert!(
        stderr(&output).contains("did you mean 0.104,0"),
        "{}",
        stderr(&output)
    );
    let output = tilebind(&["energy", design, "--pose", "0.43,0,90"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("90 deg"), "{}", stderr(&output));
    let here = json(&["energy", design, "--pose", "43 cm,-40 mm,0 deg"]);
    assert_eq!(here, json(&["energy", design, "--pose", "0.43,-0.04,0"]));
}

#[test]
fn energies_of_a_file_of_poses() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("poses.csv");
    let name = file.to_str().unwrap();
    let design = "shapes/paper-tile.toml";
    fs::write(&file, "# two\ns,x,y,theta\n0,0.43,0,0\n1,44 cm,0.01,0.1\n").unwrap();
    let entries = json(&["energy", design, "--poses", name]);
    let typed = ["--pose", "0.43,0,0", "--pose", "0.44,0.01,0.1"];
    assert_eq!(entries, json(&[&["energy", design], &typed[..]].concat()));
    for (text, said) in [
        ("x,y\n1,2\n", "line 1: there is no column `theta`"),
        ("0.43,0,0\n0.43,zero,0\n", "line 2: y is `zero`"),
        ("", "it has no poses"),
    ] {
        fs::write(&file, text).unwrap();
        let output = tilebind(&["energy", design, "--poses", name]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
}

#[test]
fn a_design_at_a_glance() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("tile.svg");
    let shown = tilebind(&[
        "show",
        "shapes/tab-20mm.toml",
        "-o",
        picture.to_str().unwrap(),
    ]);
    assert_eq!(shown.status.code(), Some(0), "{}", stderr(&shown));
    let text = stdout(&shown);
    for said in [
        "east and west bind with",
        "dipoles",
        "blocks",
        " g)",
        "NNNS at -60, -20, 20, 60 mm",
    ] {
        assert!(text.contains(said), "{said} in\n{text}");
    }
    assert!(
        text.lines().all(|line| line.chars().count() <= 110),
        "{text}"
    );
    assert!(fs::read_to_string(&picture).unwrap().starts_with("<svg"));
    let page = folder.path().join("tile.pdf");
    let name = page.to_str().unwrap();
    let shown = tilebind(&["show", "shapes/tab-20mm.toml", "-o", name]);
    assert_eq!(shown.status.code(), Some(0), "{}", stderr(&shown));
    assert!(fs::read(&page).unwrap().starts_with(b"%PDF-"));
    let shown = json(&["show", "shapes/tab-20mm.toml", "--json"]);
    // The force at contact is that of `energy`.
    let energy = json(&["energy", "shapes/tab-20mm.toml", "--pose", "0.43,0,0"]);
    let pull = -numbers(&energy[0]["force_N"])[0];
    assert!((shown["pull_contact_N"].as_f64().unwrap() / pull - 1.0).abs() < 1e-9);
    let grams = shown["pull_contact_g"].as_f64().unwrap();
    assert!((grams * 9.80665e-3 / pull - 1.0).abs() < 1e-9);
    assert!(shown["pull_off_N"].as_f64().unwrap() >= pull);
}

#[test]
fn what_is_wrong_with_a_design_is_shown() {
    let hooked = stdout(&tilebind(&["show", "shapes/dovetail.toml"]));
    assert!(hooked.contains("the shapes interlock"), "{hooked}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("all.toml");
    // The same code on every face, a shape on the target's alone.
    let text = fs::read_to_string("tests/designs/good/flat.toml").unwrap();
    let shaped = "east = { profile = { shape = \"tab\", width = 0.2, depth = 0.02, draft = 0.3 } }";
    let text = text.replace("[moving]\n", &format!("{shaped}\n\n[moving]\n"));
    fs::write(&file, &text).unwrap();
    let name = file.to_str().unwrap();
    let shown = stdout(&tilebind(&["show", name]));
    let told = "12 other pairs of faces bind as strongly: give them other codes";
    assert!(shown.contains(told), "{shown}");
    // A design without them has no such message.
    let shown = stdout(&tilebind(&["show", "shapes/paper-tile.toml"]));
    assert!(!shown.contains("as strongly"), "{shown}");
}

#[test]
fn messages_are_coloured_only_for_terminals() {
    let output = command(&["show", "tests/designs/bad/no-table.toml"])
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    assert!(
        stderr(&output).starts_with("error: "),
        "{}",
        stderr(&output)
    );
}

/// Tables fit a narrow terminal, and the deepest trap is always among their rows.
#[test]
fn the_summary_fits_its_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let quick = [
        "--milestones",
        "1000",
        "--far-starts",
        "50",
        "--complete-seconds",
        "0",
        "--certify-seconds",
        "0",
    ];
    let output = command(
        &[
            &["analyse", "shapes/paper-tile.toml", "--out", out],
            &quick[..],
        ]
        .concat(),
    )
    .env("COLUMNS", "80")
    .output()
    .unwrap();
    let told = stdout(&output);
    let rows: Vec<&str> = told
        .lines()
        .skip_while(|l| !l.starts_with("state"))
        .collect();
    let end = rows
        .iter()
        .position(|l| l.starts_with("and ") || l.starts_with("no ") || l.starts_with("a barrier"));
    assert!(
        rows[..end.unwrap()].iter().all(|l| l.chars().count() <= 80),
        "{told}"
    );
    assert!(
        rows[..end.unwrap()].iter().any(|l| l.starts_with("trap B")),
        "{told}"
    );
}
