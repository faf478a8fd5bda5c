//! What people write that is not exact, or not TOML: accepted with a warning, or refused with the fix.

use super::{json, refused, tilebind};
use crate::program::{stderr, stdout};

const PAPER: &str = "shapes/paper-tile.toml";

fn design(folder: &std::path::Path, changes: &[(&str, &str)]) -> String {
    let mut text = std::fs::read_to_string(PAPER).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let file = folder.join("it.toml");
    std::fs::write(&file, text).unwrap();
    file.to_str().unwrap().to_owned()
}

#[test]
fn poses_that_overlap_slightly_are_moved_out_to_contact() {
    // A pose that a summary printed, a quarter turn to four decimals, and a deep overlap.
    let asked = ["--to", "free", "--certify-work", "0", "--milestones", "500"];
    for pose in ["432.5 mm,-84.3 mm,-1.1 deg", "0.43,0,1.5708"] {
        let output = tilebind(&[&["barrier", PAPER, "--from", pose], &asked[..]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let told = stderr(&output);
        assert!(
            told.contains("warning: the tiles overlap by") && told.contains("out to contact"),
            "{told}"
        );
        let found: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        let from: Vec<String> = (0..3).map(|k| found["from"][k].to_string()).collect();
        let energy = json(&["energy", PAPER, "--pose", &from.join(",")]);
        assert_eq!(energy[0]["free"], true, "{energy}");
        // The energy of the pose itself stays that of the pose.
        assert_eq!(json(&["energy", PAPER, "--pose", pose])[0]["free"], false);
    }
    let deep = [&["barrier", PAPER, "--from", "0.4299,0,0"], &asked[..]].concat();
    refused(&deep, &["the tiles overlap by 0.1000 mm"]);
    let rates = tilebind(&[
        "rates",
        PAPER,
        "--kt",
        "3e-3",
        "--start",
        "432.5 mm,-84.3 mm,-1.1 deg",
        "--json",
    ]);
    assert!(
        stderr(&rates).contains("out to contact"),
        "{}",
        stderr(&rates)
    );
}

#[test]
fn starts_have_units_and_are_moved_out_to_contact() {
    let folder = tempfile::tempdir().unwrap();
    let start = folder.path().join("start.csv");
    let path = start.to_str().unwrap();
    let run = |text: &str| {
        std::fs::write(&start, text).unwrap();
        tilebind(&["table", PAPER, "--start", path, "--time", "10 ms", "--json"])
    };
    let plain =
        run("tile,kind,x,y,theta,vx,vy,omega\n0,fixed,0,0,0,0,0,0\n1,moving,0.5,0,0,0.1,0,0\n");
    let named = run(
        "tile,kind,x_mm,y,theta_deg,vx_cm_s,vy,omega\n0,fixed,0,0,0,0,0,0\n1,moving,500,0,0,10,0,0\n",
    );
    let own = run(
        "tile,kind,x,y,theta,vx,vy,omega\n0,fixed,0,0,0,0,0,0\n1,moving,50 cm,0 mm,0 deg,100 mm/s,0,0 rpm\n",
    );
    let figure = |output: &std::process::Output| {
        assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
        assert!(!stderr(output).contains("warning"), "{}", stderr(output));
        let all: serde_json::Value = serde_json::from_str(&stdout(output)).unwrap();
        all["energy_error"].clone()
    };
    assert_eq!(figure(&plain), figure(&named));
    assert_eq!(figure(&plain), figure(&own));
    let near =
        run("tile,kind,x,y,theta,vx,vy,omega\n0,fixed,0,0,0,0,0,0\n1,moving,0.42997,0,0,0,0,0\n");
    assert_eq!(near.status.code(), Some(0), "{}", stderr(&near));
    assert!(
        stderr(&near).contains("moved out to contact, by up to 30.0"),
        "{}",
        stderr(&near)
    );
    let deep =
        run("tile,kind,x,y,theta,vx,vy,omega\n0,fixed,0,0,0,0,0,0\n1,moving,0.42994,0,0,0,0,0\n");
    assert_eq!(deep.status.code(), Some(2));
}

#[test]
fn options_have_units() {
    let table = |orbital: &str, step: &str| {
        json(&[
            "table",
            PAPER,
            "--count",
            "1,1",
            "--time",
            "20 ms",
            "--orbital",
            orbital,
            "--step",
            step,
            "--drag",
            "0.5 /s",
            "--json",
        ])["energy_error"]
            .clone()
    };
    assert_eq!(table("10 mm,300 rpm", "1 ms"), table("0.01,5", "0.001"));
    refused(
        &[
            "table",
            PAPER,
            "--count",
            "1,1",
            "--time",
            "1",
            "--orbital",
            "10,5",
        ],
        &["did you mean \"10 mm,5\"?"],
    );
}

#[test]
fn paths_of_windows_and_curly_quotes_get_their_fix() {
    let folder = tempfile::tempdir().unwrap();
    let all = "all = { code = \"NNNS\" }";
    for path in [
        "drawings\\wave.svg",
        "C:\\Users\\me\\wave.svg",
        "a\\new.svg",
        "a\\tab.svg",
        "b\\f.svg",
        "c\\u0041.svg",
    ] {
        let profile = format!(
            "all = {{ code = \"NNNS\", profile = {{ shape = \"svg\", file = \"{path}\" }} }}"
        );
        let file = design(folder.path(), &[(all, &profile)]);
        let slashes = format!("\"{}\"", path.replace('\\', "/"));
        refused(
            &["show", &file],
            &["begins an escape", &slashes, &format!("'{path}'")],
        );
    }
    let file = design(
        folder.path(),
        &[("name = \"paper-tile\"", "name = \u{201c}paper-tile\u{201d}")],
    );
    refused(&["show", &file], &["straight quotes", ":6:"]);
}

#[test]
fn magnets_that_are_not_modelled_have_a_substitute() {
    let folder = tempfile::tempdir().unwrap();
    for (shape, told) in [
        ("cube", "write \"block\""),
        ("cylinder", "write \"disc\""),
        ("ring", "disc of the outer diameter"),
        ("ball", "point dipole"),
    ] {
        let to = format!("[magnet]\nshape = \"{shape}\"");
        let file = design(folder.path(), &[("[magnet]", &to)]);
        refused(&["show", &file], &[told]);
    }
    let file = design(folder.path(), &[("thickness = 0.013", "thickness = 0.002")]);
    let output = tilebind(&["show", &file]);
    let told = stderr(&output);
    assert_eq!(
        told.matches("magnets 3 mm thick stick out of a tile 2 mm thick")
            .count(),
        1,
        "{told}"
    );
}

#[test]
fn magnets_at_a_corner_are_to_move_inwards() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("corner.toml");
    let text = |pitch: &str| {
        let tile = |code: &str| {
            format!(
                "side = \"30 mm\"\nthickness = \"5 mm\"\nmass = 0.01\nfaces.all = {{ code = \"{code}\" }}\n"
            )
        };
        format!(
            "[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [\"3 mm\", \"6 mm\", \"3 mm\"]\ngrade = \"N42\"\n\
             pitch = \"{pitch}\"\n[fixed]\n{}[moving]\n{}[target]\nfixed = \"east\"\nmoving = \"west\"\n",
            tile("NNS"),
            tile("NSS")
        )
    };
    let path = file.to_str().unwrap();
    std::fs::write(&file, text("10 mm")).unwrap();
    refused(
        &["show", path],
        &["away from the corner", "`pitch` at least 10.0 % smaller"],
    );
    std::fs::write(&file, text("9 mm")).unwrap();
    assert_eq!(tilebind(&["show", path]).status.code(), Some(0));
}

#[test]
fn codes_that_are_not_mates_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let show = |fixed: &str, moving: &str| {
        let codes = [
            (
                "all = { code = \"NNNS\" }",
                format!("east = {{ code = \"{fixed}\" }}"),
            ),
            ("all = { code = \"NSSS\" }", String::new()),
            (
                "west = { mates = \"east\" }",
                format!("west = {{ code = \"{moving}\" }}"),
            ),
        ];
        let codes: Vec<(&str, &str)> = codes.iter().map(|(from, to)| (*from, &to[..])).collect();
        let output = tilebind(&["show", &design(folder.path(), &codes)]);
        let told = stdout(&output) + &stderr(&output);
        told.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for (fixed, moving) in [("NNSS", "NSSS"), ("NNNS", "NNNS"), ("NNNS", "NSSN")] {
        let told = show(fixed, moving);
        assert!(
            told.contains("the codes are not mates"),
            "{fixed} {moving}: {told}"
        );
    }
    for (fixed, moving) in [
        ("NNNS", "NSSS"),
        ("NS", "NS"),
        ("NNSS", "NNSS"),
        ("N.S", "N.S"),
    ] {
        let told = show(fixed, moving);
        assert!(!told.contains("not mates"), "{fixed} {moving}: {told}");
    }
}

#[test]
fn new_designs_weigh_what_their_material_weighs() {
    let folder = tempfile::tempdir().unwrap();
    let start = |more: &[&str]| {
        let file = folder.path().join("new.toml");
        let path = file.to_str().unwrap();
        let output = tilebind(&[&["init", path, "--force", "--side", "60 mm"], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let shown = tilebind(&["show", path]);
        assert_eq!(shown.status.code(), Some(0), "{}", stderr(&shown));
        let text = std::fs::read_to_string(file).unwrap();
        let of = |key: &str| -> f64 {
            let line = text.lines().find(|line| line.starts_with(key)).unwrap();
            let value = line.split('=').nth(1).unwrap().split('#').next().unwrap();
            value.trim().parse().unwrap()
        };
        (
            of("mass") / (0.06 * 0.06 * of("thickness")),
            of("thickness"),
            text,
        )
    };
    let (plywood, ..) = start(&[]);
    let (acrylic, thickness, text) = start(&[
        "--thickness",
        "6 mm",
        "--material",
        "acrylic",
        "--magnet",
        "6 x 3 mm disc N42 up",
    ]);
    assert!((600.0..800.0).contains(&plywood), "{plywood}");
    assert!((1190.0..1500.0).contains(&acrylic), "{acrylic}");
    assert!(
        thickness == 0.006 && text.contains("axis = \"up\"") && text.contains('U'),
        "{text}"
    );
    let light = design(folder.path(), &[("mass = 0.1", "mass = 0.0001")]);
    let output = tilebind(&["show", &light]);
    let told = (stdout(&output) + &stderr(&output))
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    assert!(
        told.contains("the fixed tile weighs 0.1 g, less than its magnets"),
        "{told}"
    );
}

/// What the magnets leave for the rest of the tile counts: foam has 0.02 g/cm3 and more.
#[test]
fn a_tile_lighter_than_foam_is_doubted_and_one_as_light_as_foam_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    let told = |mass: &str| {
        let design = design(folder.path(), &[("mass = 0.1", &format!("mass = {mass}"))]);
        let output = tilebind(&["show", &design]);
        let told = stdout(&output) + &stderr(&output);
        told.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    // Of 2.4 litres; 16 magnets of 0.3 cm3 weigh 35 g.
    let light = told("0.06");
    assert!(light.contains("lighter than foam"), "{light}");
    let foam = told("0.1");
    assert!(foam.contains("weighs 100 g, as one of foam or a hollow one; a full one of plywood would weigh 1.47 kg"), "{foam}");
    let heavy = told("30");
    assert!(heavy.contains("heavier than brass"), "{heavy}");
    let plywood = told("1.5");
    assert!(!plywood.contains("fixed tile weighs"), "{plywood}");
}

#[test]
fn names_that_cannot_be_files_are_shortened_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("set.yaml");
    let out = folder.path().join("out");
    let [file, out] = [&set, &out].map(|path| path.to_str().unwrap());
    let write = |name: &str| {
        let text = format!(
            "tiles:\n  - name: \"{name}\"\n    edges: [\"null\", a, \"null\", \"null\"]\n  - name: q\n    \
             edges: [\"null\", \"null\", \"null\", a]\nbonds:\n  - {{name: a, strength: 2}}\n\
             options:\n  size: 8\n  threshold: 2\n"
        );
        std::fs::write(&set, text).unwrap();
    };
    let command = ["assemble", file, "--kt", "3e-3", "--out", out];
    write(&"a".repeat(300));
    let output = tilebind(&command);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    write("q\u{202e}p");
    refused(&command, &["invisible character U+202E"]);
}

#[test]
fn help_fits_eighty_columns() {
    for command in [
        "analyse", "assemble", "table", "rates", "dock", "barrier", "words", "init",
    ] {
        for form in ["-h", "--help"] {
            let help = stdout(&tilebind(&[command, form]));
            let long: Vec<&str> = help
                .lines()
                .filter(|line| line.chars().count() > 80)
                .collect();
            assert!(long.is_empty(), "{command} {form}: {long:#?}");
        }
    }
}
