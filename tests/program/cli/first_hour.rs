//! The first steps of a new user: designs to start from, mistakes, inspection of a design, files
//! for the workshop.

use std::fs;

use super::{json, numbers, tilebind};
use crate::folder::contents;
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

/// The corners of the closed lines of a DXF file (mm), by layer.
fn polylines(text: &str) -> Vec<(String, Vec<[f64; 2]>)> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    assert_eq!(lines.len() % 2, 0, "codes and values come in pairs");
    let mut all: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
    let mut entity = "";
    for pair in lines.chunks(2) {
        let number = || pair[1].parse::<f64>().unwrap();
        match (pair[0], entity) {
            ("0", _) => entity = pair[1],
            ("8", "LWPOLYLINE") => all.push((pair[1].to_owned(), Vec::new())),
            ("10", "LWPOLYLINE") => all.last_mut().unwrap().1.push([number(), 0.0]),
            ("20", "LWPOLYLINE") => all.last_mut().unwrap().1.last_mut().unwrap()[1] = number(),
            _ => {}
        }
    }
    assert_eq!(lines[lines.len() - 1], "EOF");
    all
}

fn area(corners: &[[f64; 2]]) -> f64 {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    edges.map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0).sum()
}

#[test]
fn files_for_the_workshop_are_to_scale() {
    let folder = tempfile::tempdir().unwrap();
    let cut = ["--kerf", "0.2 mm", "--clearance", "0.15 mm"];
    let design = folder.path().join("design.toml");
    let text = std::fs::read_to_string("shapes/tab-20mm.toml").unwrap();
    std::fs::write(&design, text.replace("inset = 0.0", "inset = 0.002")).unwrap();
    let out_folder = folder.path().join("out");
    let out = out_folder.to_str().unwrap();
    let design = design.to_str().unwrap();
    let made = tilebind(&[&["make", design, "-o", out], &cut[..]].concat());
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    let files = contents(&out_folder);
    for name in [
        "fixed.dxf",
        "fixed.svg",
        "moving.dxf",
        "moving.svg",
        "sheet.md",
        "report.json",
        "report.html",
        "magnets.csv",
        "order.csv",
        "check.svg",
        "pictures/tiles.svg",
    ] {
        assert!(files.contains_key(name), "{name}");
    }
    let read = |name: &str| String::from_utf8(files[name].clone()).unwrap();
    let lines = polylines(&read("fixed.dxf"));
    // The outline is cut last.
    let [pockets @ .., (outline, corners)] = &lines[..] else {
        panic!("no lines");
    };
    assert_eq!(outline, "CUT_OUTSIDE");
    // A square of 430 mm with a tab of 200 (at its base) by 20 mm, half a kerf outside of it.
    let top = 200.0 - 2.0 * 20.0 * 0.3_f64.tan();
    let tile = 430.0 * 430.0 + (200.0 + top) / 2.0 * 20.0;
    let rim = 4.0 * 430.0 - 200.0 + top + 2.0 * 20.0 / 0.3_f64.cos();
    assert!(
        (area(corners) - tile - 0.1 * rim).abs() < 0.01 * rim,
        "{}",
        area(corners)
    );
    // Pockets: 10 by 10 mm, 0.15 larger on every side, half a kerf inside of that.
    assert!(!pockets.is_empty());
    for (layer, corners) in pockets {
        assert_eq!(layer, "CUT_INSIDE");
        assert!((area(corners) - 10.1 * 10.1).abs() < 0.01, "{corners:?}");
    }
    assert!(
        read("fixed.svg").contains("width=\"460.2mm\""),
        "{}",
        read("fixed.svg")
    );
    let sheet = read("sheet.md");
    for said in ["N35 (1.19 T", "| pole |", "east 1", "kerf of 0.2 mm"] {
        assert!(sheet.contains(said), "{said} in\n{sheet}");
    }
    let wrong = tilebind(&["make", "shapes/tab-20mm.toml", "-o", out, "--kerf", "0.2"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(stderr(&wrong).contains("in millimetres write"));
    let wrong = tilebind(&["make", "shapes/tab-20mm.toml", "-o", out, "--kerf", "11 mm"]);
    assert_eq!(wrong.status.code(), Some(2));
    let told = stderr(&wrong);
    assert!(
        told.contains("at most 10 mm") && !told.contains("in millimetres write"),
        "{told}"
    );
}

/// Hexagons of 6 cm with blocks of 2 x 10 x 5 mm.
fn hexagons(inset: &str, profile: &str) -> String {
    let tile = "side = 0.06\nsides = 6\nthickness = 0.008\nmass = 0.048";
    format!(
        "table.size = [0.39, 0.39]\n[magnet]\nsize = [0.002, 0.01, 0.005]\ngrade = \"N45\"\n\
         pitch = 0.016\ninset = {inset}\n[fixed]\n{tile}\n[fixed.faces]\n\
         0 = {{ code = \"NS\"{profile} }}\n[moving]\n{tile}\n[moving.faces]\n\
         3 = {{ mates = \"0\" }}\n[target]\nfixed = \"0\"\nmoving = \"3\"\n"
    )
}

/// Runs `make` on the text of a design; its files.
fn made(text: &str, options: &[&str]) -> std::collections::BTreeMap<String, Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("design.toml");
    std::fs::write(&design, text).unwrap();
    let out = folder.path().join("out");
    let files = [
        "make",
        design.to_str().unwrap(),
        "-o",
        out.to_str().unwrap(),
    ];
    let made = tilebind(&[&files[..], options].concat());
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    contents(&out).into_iter().collect()
}

#[test]
fn pockets_have_walls_or_are_notches() {
    let read = |inset: &str, name: &str| {
        let files = made(&hexagons(inset, ""), &["--kerf", "0.15 mm"]);
        String::from_utf8(files[name].clone()).unwrap()
    };
    let hexagon = 1.5 * 3f64.sqrt() * 60.0 * 60.0;
    // Walls of exactly 0.5 mm: the last bits of two symmetric pockets differ.
    for (inset, notched) in [("0.0006", 0.0), ("0.0005", 2.0), ("0.0", 2.0)] {
        let lines = polylines(&read(inset, "fixed.dxf"));
        let [pockets @ .., (layer, outline)] = &lines[..] else {
            panic!("no lines");
        };
        assert_eq!(layer, "CUT_OUTSIDE");
        assert_eq!(pockets.len(), 2 - notched as usize, "{inset}");
        // The cutter's line around the tile, less the notches from it to the pockets' inner sides.
        let (kerf, inset) = (0.15, 1e3 * inset.parse::<f64>().unwrap());
        let side = 60.0 + kerf / 3f64.sqrt();
        let grown = hexagon * (side / 60.0) * (side / 60.0);
        let notch = (10.2 - kerf) * (kerf / 2.0 + inset + 2.1 - kerf / 2.0);
        let expected = grown - notched * notch;
        assert!(
            (area(outline) - expected).abs() < 1e-3,
            "{inset}: {} {expected}",
            area(outline)
        );
    }
    let sheet = read("0.0", "sheet.md");
    assert!(
        sheet.contains("(notch)") && sheet.contains("raise `inset` by 0.6 mm"),
        "{sheet}"
    );
    let sheet = read("0.0006", "sheet.md");
    assert!(
        !sheet.contains("(notch") && !sheet.contains("(open"),
        "{sheet}"
    );
}

/// A new design can be cut as it is.
#[test]
fn new_designs_have_walls() {
    let folder = tempfile::tempdir().unwrap();
    for (sides, side, magnets, shape) in [
        ("6", "6 cm", "2", "flat"),
        ("6", "6 cm", "2", "tab"),
        ("4", "6 cm", "2", "arc"),
        ("3", "12 cm", "3", "sine"),
        ("24", "5 cm", "2", "triangle"),
        ("4", "43 cm", "4", "tab"),
    ] {
        let design = folder.path().join("new.toml");
        let design = design.to_str().unwrap();
        let options = [
            "--sides",
            sides,
            "--side",
            side,
            "--magnets",
            magnets,
            "--shape",
            shape,
        ];
        let started = tilebind(&[&["init", design, "--force"], &options[..]].concat());
        assert_eq!(started.status.code(), Some(0), "{}", stderr(&started));
        let files = made(&std::fs::read_to_string(design).unwrap(), &[]);
        let sheet = String::from_utf8(files["sheet.md"].clone()).unwrap();
        for mark in ["notch)", "(open", "close)"] {
            assert!(!sheet.contains(mark), "{options:?}\n{sheet}");
        }
    }
}

#[test]
fn copies_are_nested_on_sheets_and_layers_are_parts() {
    let text = hexagons("0.002", "");
    let files = made(
        &text,
        &[
            "--copies",
            "6",
            "--sheet",
            "600x400 mm",
            "--layers",
            "4 mm, 4mm",
        ],
    );
    let read = |name: &str| String::from_utf8(files[name].clone()).unwrap();
    for name in [
        "fixed-layer-1.dxf",
        "moving-layer-2.svg",
        "glue-up.svg",
        "nested-1.svg",
    ] {
        assert!(files.contains_key(name), "{name}");
    }
    // Two tiles of two layers, six of each; magnets of 5 mm need both layers.
    let sheets: Vec<String> = (1..)
        .map(|k| format!("nested-{k}.dxf"))
        .take_while(|name| files.contains_key(name))
        .collect();
    let outlines = |name: &String| -> Vec<Vec<[f64; 2]>> {
        let lines = polylines(&read(name)).into_iter();
        lines
            .filter(|line| line.0 == "CUT_OUTSIDE")
            .map(|line| line.1)
            .collect()
    };
    let all: usize = sheets.iter().map(|name| outlines(name).len()).sum();
    assert_eq!(all, 24);
    for name in &sheets {
        let boxes: Vec<[f64; 4]> = outlines(name)
            .iter()
            .map(|line| {
                let of = |k: usize, fold: fn(f64, f64) -> f64, start| {
                    line.iter().map(|p| p[k]).fold(start, fold)
                };
                [
                    of(0, f64::min, f64::MAX),
                    of(1, f64::min, f64::MAX),
                    of(0, f64::max, f64::MIN),
                    of(1, f64::max, f64::MIN),
                ]
            })
            .collect();
        for (i, a) in boxes.iter().enumerate() {
            assert!(
                a[0] > 1.999 && a[1] > 1.999 && a[2] < 598.001 && a[3] < 398.001,
                "{a:?}"
            );
            for b in &boxes[..i] {
                assert!(
                    (0..2).any(|k| a[k] - b[k + 2] > 1.999 || b[k] - a[k + 2] > 1.999),
                    "{a:?} {b:?}"
                );
            }
        }
    }
    let said = format!("{} of 600 x 400 x 4 mm", sheets.len());
    for said in ["24 magnets", "All cuts together are", &said] {
        assert!(read("sheet.md").contains(said), "{said}");
    }
    assert!(read("nested-1.svg").contains("width=\"600mm\""));
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("design.toml");
    std::fs::write(&design, &text).unwrap();
    for (options, said) in [
        (
            ["--layers", "4 mm,3 mm"],
            "7 mm thick together, but the tile is 8 mm",
        ),
        (["--sheet", "90x90 mm"], "use larger sheets"),
        (["--sheet", "600 mm"], "600x400 mm"),
        (["--count", "3"], "--count 6,6"),
    ] {
        let out = folder.path().join("out");
        let wrong = tilebind(
            &[
                &[
                    "make",
                    design.to_str().unwrap(),
                    "-o",
                    out.to_str().unwrap(),
                ],
                &options[..],
            ]
            .concat(),
        );
        assert_eq!(wrong.status.code(), Some(2), "{options:?}");
        assert!(stderr(&wrong).contains(said), "{}", stderr(&wrong));
        assert!(!out.exists());
    }
}

#[test]
fn pockets_that_overlap_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = |pitch: &str, cut: &[&str]| {
        let design = folder.path().join("design.toml");
        std::fs::write(&design, squares(pitch)).unwrap();
        let out = folder.path().join("out");
        let files = [
            "make",
            design.to_str().unwrap(),
            "--force",
            "-o",
            out.to_str().unwrap(),
        ];
        let made = tilebind(&[&files[..], cut].concat());
        assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
        std::fs::read_to_string(out.join("sheet.md")).unwrap()
    };
    // By 0.2 mm, and by 2 mm.
    for (pitch, cut, more) in [
        ("0.005", &[][..], "out by 0.7 mm"),
        ("0.015", &["--clearance", "6 mm"], "out by 2.5 mm"),
    ] {
        let told = sheet(pitch, cut);
        assert!(told.contains("close)") && told.contains(more), "{told}");
    }
    assert!(!sheet("0.015", &[]).contains("close)"));
}

/// Squares of 10 cm whose target faces carry magnets of 5 mm at a pitch (m).
fn squares(pitch: &str) -> String {
    let tile = "side = 0.1\nthickness = 0.005\nmass = 0.05";
    format!(
        "[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [0.005, 0.005, 0.003]\nremanence = 1.2\n\
         pitch = {pitch}\ninset = 0.001\n[fixed]\n{tile}\n[fixed.faces]\neast = {{ code = \"NNNS\" \
         }}\n[moving]\n{tile}\n[moving.faces]\nwest = {{ mates = \"east\" }}\n[target]\n\
         fixed = \"east\"\nmoving = \"west\"\n"
    )
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
