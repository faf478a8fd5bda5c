//! Files for the workshop.

use std::collections::BTreeMap;
use std::fs;

use super::{json, refused, tilebind};
use crate::folder::contents;
use crate::program::stderr;

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
    let text = fs::read_to_string("shapes/tab-20mm.toml").unwrap();
    fs::write(&design, text.replace("inset = 0.0", "inset = 0.002")).unwrap();
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
        "check-1.svg",
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
fn made(text: &str, options: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("design.toml");
    fs::write(&design, text).unwrap();
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
        let files = made(&fs::read_to_string(design).unwrap(), &[]);
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
    fs::write(&design, &text).unwrap();
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
        fs::write(&design, squares(pitch)).unwrap();
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
        fs::read_to_string(out.join("sheet.md")).unwrap()
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

/// Magnets that crowd in a corner are farther apart where each is nearer to the middle of its face.
#[test]
fn pockets_too_close_in_a_corner_are_to_move_away_from_it() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = |pitch: &str| {
        let text = squares(pitch)
            .replace("side = 0.1", "side = 0.03")
            .replace("[0.005, 0.005, 0.003]", "[0.003, 0.006, 0.003]")
            .replace("east = { code = \"NNNS\" }", "all = { code = \"NNS\" }");
        let design = folder.path().join("design.toml");
        fs::write(&design, text).unwrap();
        let out = folder.path().join("out");
        let [design, out] = [&design, &out].map(|path| path.to_str().unwrap());
        let made = tilebind(&["make", design, "--force", "-o", out]);
        assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
        fs::read_to_string(folder.path().join("out/sheet.md")).unwrap()
    };
    let told = sheet("0.0080")
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let by = told.split("move the magnets beside a corner ").nth(1);
    let by = by.unwrap_or_else(|| panic!("{told}")).split(' ').next();
    assert!(!told.contains("space the magnets"), "{told}");
    let less = 0.008 - by.unwrap().parse::<f64>().unwrap() / 1e3;
    assert!(!sheet(&less.to_string()).contains("close)"), "{by:?}");
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

/// Tiles that are equal are drawn once, however the design says so.
#[test]
fn equal_tiles_are_one_kind() {
    let tile = "side = 0.04\nthickness = 0.006\nmass = 0.02\n";
    let head = "[table]\nsize = [0.4, 0.4]\n[magnet]\nsize = [0.002, 0.006, 0.004]\nremanence = \
                1.2\npitch = 0.01\ninset = 0.001\n";
    let faces = "east = { code = \"NS\" }\nwest = { code = \"NS\" }\n";
    let one = format!(
        "{head}[tile]\n{tile}[tile.faces]\n{faces}[target]\nfaces = [\"east\", \"west\"]\n"
    );
    let two = format!(
        "{head}[fixed]\n{tile}[fixed.faces]\n{faces}[moving]\n{tile}[moving.faces]\n{faces}\
         [target]\nfixed = \"east\"\nmoving = \"west\"\n"
    );
    let options = ["--copies", "8"];
    let files = made(&one, &options);
    assert!(files.contains_key("tile.dxf") && !files.contains_key("fixed.dxf"));
    let drawing = |files: &BTreeMap<String, Vec<u8>>, name: &str| {
        String::from_utf8(files[name].clone()).unwrap()
    };
    let other = made(&two, &options);
    for name in ["tile.dxf", "nested-1.svg", "order.csv", "check.svg"] {
        assert_eq!(drawing(&files, name), drawing(&other, name), "{name}");
    }
    let parts = polylines(&drawing(&files, "nested-1.dxf")).into_iter();
    assert_eq!(parts.filter(|it| it.0 == "CUT_OUTSIDE").count(), 8);
    // As many as --count says of both.
    let files = made(&one, &["--count", "2,3"]);
    assert_eq!(drawing(&files, "nested.csv").lines().count(), 1 + 5);
}

/// A face with one magnet repels as much as it attracted if that magnet is the wrong way round.
#[test]
fn a_wrong_magnet_has_its_share_of_the_bond() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("one.toml");
    let design = design.to_str().unwrap();
    let out = folder.path().join("out");
    for magnets in ["1", "4"] {
        let options = ["--side", "6 cm", "--force", "--magnets", magnets];
        let begun = tilebind(&[&["init", design], &options[..]].concat());
        assert_eq!(begun.status.code(), Some(0), "{}", stderr(&begun));
        let report = json(&[
            "make",
            design,
            "--force",
            "--json",
            "-o",
            out.to_str().unwrap(),
        ]);
        let steps = [&report["fixed"], &report["moving"]];
        let left: Vec<f64> = steps
            .iter()
            .flat_map(|steps| steps.as_array().unwrap())
            .map(|step| step["left_if_wrong"].as_f64().unwrap())
            .collect();
        match magnets {
            "1" => assert!(
                left.iter().all(|left| (left + 1.0).abs() < 1e-12),
                "{left:?}"
            ),
            // With a magnet turned, its share s of the bond is lost twice: 1 - 2 s is left. The
            // shares of a tile's magnets add up to 1.
            _ => {
                let shares: f64 = left.iter().map(|left| (1.0 - left) / 2.0).sum();
                assert!((shares - 2.0).abs() < 1e-9, "{left:?}");
            }
        }
    }
}

/// A tab whose pockets are notches leaves slivers beside them, a straight face does not.
#[test]
fn slivers_beside_notches_are_told() {
    let tab = ", profile = { shape = \"tab\", width = 0.0285, depth = 0.003, draft = 0.3 }";
    for (profile, is_fragile) in [(tab, true), ("", false)] {
        let files = made(&hexagons("0.0", profile), &[]);
        let sheet = String::from_utf8(files["sheet.md"].clone()).unwrap();
        assert!(sheet.contains("(notch"), "{sheet}");
        assert_eq!(sheet.contains("fragile"), is_fragile, "{sheet}");
    }
}

/// Equal tiles of several designs are one kind; the others have their own names.
#[test]
fn tiles_of_several_designs_are_nested_together() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, format!("name = \"{name}\"\n{text}")).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let first = file("a", &hexagons("0.002", ""));
    let other = hexagons("0.002", "").replace("pitch = 0.016", "pitch = 0.02");
    let [second, third] = [file("b", &other), file("a.toml", &hexagons("0.002", ""))];
    let out = folder.path().join("out");
    let out_name = out.to_str().unwrap();
    let start = ["make", &first, &second, &third, "-o", out_name];
    let made = tilebind(&[&start[..], &["--count", "1,2,3,4"]].concat());
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    let files = contents(&out);
    for name in ["a-fixed", "a-moving", "b-fixed", "b-moving"] {
        assert!(files.contains_key(&format!("tiles/{name}.dxf")), "{name}");
    }
    let nested: Vec<_> = (1..=files.len())
        .filter_map(|k| files.get(&format!("nested-{k}.dxf")))
        .flat_map(|text| polylines(&String::from_utf8(text.clone()).unwrap()))
        .filter(|line| line.0 == "CUT_OUTSIDE")
        .collect();
    assert_eq!(nested.len(), 10);
    refused(
        &[&start[..], &["--force", "--count", "1,2"]].concat(),
        &["4 kinds", "b-moving", "--count 6,6,6,6"],
    );
    refused(
        &["make", &first, "--words", "w.toml", "-o", "never"],
        &["--words is for a tile set"],
    );
}

/// The tiles of a set, each with its own marks, as often as the file says.
#[test]
fn a_tile_set_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("set.yaml");
    let text = "size: [4, 4]\ntiles:\n- {name: left, edges: [0, a, 0, 0], stoic: 2}\n\
                - {name: right, edges: [0, 0, 0, a], stoic: 1}\n\
                - {name: bare, edges: [0, 0, 0, 0], stoic: 1}\n";
    fs::write(&set, text).unwrap();
    let words = folder.path().join("words.toml");
    let set_of_words = "words = [\"NNNS\"]\n[magnet]\npitch = 0.013\nsize = [0.002, 0.01, 0.005]\n\
                        remanence = 1.2\ninset = 0.0006\n[tile]\nside = 0.06\n";
    fs::write(&words, set_of_words).unwrap();
    let out = folder.path().join("out");
    let [set, words, out_name] = [&set, &words, &out].map(|path| path.to_str().unwrap());
    let made = tilebind(&[
        "make",
        set,
        "--words",
        words,
        "-o",
        out_name,
        "--sheet",
        "600x400 mm",
    ]);
    assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    let files = contents(&out);
    let pockets = |name: &str| {
        let text = String::from_utf8(files[&format!("tiles/{name}.dxf")].clone()).unwrap();
        let lines = polylines(&text).into_iter();
        lines.filter(|line| line.0 == "CUT_INSIDE").count()
    };
    assert_eq!(["left", "right", "bare"].map(pockets), [4, 4, 0]);
    let nested = String::from_utf8(files["nested.csv"].clone()).unwrap();
    assert_eq!(nested.lines().count(), 1 + 4, "{nested}");
    let order = String::from_utf8(files["order.csv"].clone()).unwrap();
    assert!(
        order.contains("right west") || order.contains("west"),
        "{order}"
    );
}

/// Tiles larger than a page are printed on several, with everything somewhere on them.
#[test]
fn a_tile_that_is_larger_than_a_page_has_several() {
    let text = fs::read_to_string("shapes/tab-20mm.toml").unwrap();
    let files = made(&text, &[]);
    // 450 mm of a width of 186 mm with 10 mm of overlap: 3; 430 of 261: 2; two tiles.
    let pages = (1..).take_while(|k| files.contains_key(&format!("check-{k}.svg")));
    assert_eq!(pages.count(), 12);
    assert!(!files.contains_key("check.svg"));
}

/// On a small tile all letters become as low as it takes for every pocket to have its mark.
#[test]
fn every_pocket_has_its_mark() {
    let out = tempfile::tempdir().unwrap();
    let design = "shapes/ring-of-eight.toml";
    let report = json(&[
        "make",
        design,
        "--json",
        "-o",
        out.path().join("o").to_str().unwrap(),
    ]);
    assert!(report["tile"].as_array().unwrap().len() >= 2);
    let sheet = fs::read_to_string(out.path().join("o/sheet.md")).unwrap();
    assert!(!sheet.contains("no room"), "{sheet}");
    let drawing = fs::read_to_string(out.path().join("o/tile.svg")).unwrap();
    // A mark for each pocket, and the tile's own.
    assert_eq!(
        drawing.matches("<text").count(),
        report["tile"].as_array().unwrap().len() + 1
    );
}
