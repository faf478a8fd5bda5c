//! Designs of one kind of tile, written in several ways, in every command.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use serde_json::Value;

use super::tilebind;
use crate::program::{stderr, stdout};

/// A design and the same one with `[fixed]` and `[moving]`, with `moving = "fixed"`, and with its target
/// faces exchanged.
fn written() -> [String; 4] {
    let new = std::fs::read_to_string("shapes/ring-of-eight.toml").unwrap();
    let (head, rest) = new.split_at(new.find("[tile]").unwrap());
    let (tile, target) = rest.split_at(rest.find("[target]").unwrap());
    let called = |name: &str| tile.replace("[tile", &format!("[{name}"));
    let two = format!("{head}{}{}", called("fixed"), called("moving"));
    let same = format!("moving = \"fixed\"\n{head}{}{target}", called("fixed"));
    [
        new.clone(),
        format!("{two}[target]\nfixed = \"0\"\nmoving = \"2\"\n"),
        same,
        format!("{two}[target]\nfixed = \"2\"\nmoving = \"0\"\n"),
    ]
}

/// What stays of a report: without the checksum of the design and times.
fn kept(mut value: Value) -> Value {
    for key in ["design", "designs", "wall_s", "timing"] {
        if let Some(entry) = value.get_mut(key) {
            *entry = Value::Null;
        }
    }
    value
}

/// A table without the columns of checksums of the design.
fn without_checksums(file: &str) -> String {
    let text = std::fs::read_to_string(file).unwrap();
    let head: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let kept = |row: &str| {
        let cells = row.split(',').zip(&head);
        let cells = cells.filter(|(_, name)| !["sha256", "point"].contains(name));
        cells.map(|(cell, _)| cell).collect::<Vec<_>>().join(",")
    };
    text.lines().map(kept).collect::<Vec<_>>().join("\n")
}

const ASKED: [&str; 15] = [
    "show --json",
    "energy --pose 0.05,0,0.3 --pose 0.1,0.02,-2",
    "match --json",
    "bond --kt 2e-4 --coverage 0.1 --json",
    "dock --runs 4 --duration 1 --json",
    "table --count 8 --time 0.3 --shaking 2e-4 --threads 1 --json",
    "yield --tiles 4 --time 60 --kt 2e-4 --runs 4 --duration 1 --simulations 20 --json",
    "make --json",
    "rates --kt 4e-4 --traps 0 --json",
    "tolerance --strength 0.05 --draws 20 --json",
    "compare --milestones 200 --far-starts 20 --json",
    "sweep --vary magnet.remanence=1.0,1.2 --milestones 200 --far-starts 20",
    "sweep --vary magnet.remanence=1.0:1.2 --maximise selectivity --points 2 --milestones 200 --far-starts 20",
    "assemble lattice FILE --lattice 1x2 --length 2 --json",
    "analyse --quick --milestones 200 --far-starts 20",
];

#[test]
#[ignore = "slow"]
fn every_way_to_write_one_kind_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let [new, others @ ..] = written();
    let file = folder.path().join("ring.toml").display().to_string();
    let answers = |text: &str| -> Vec<String> {
        std::fs::write(&file, text).unwrap();
        let answer = |asked: &&str| {
            let mut all: Vec<String> = asked.split(' ').map(str::to_owned).collect();
            match all.iter().position(|word| word == "FILE") {
                Some(place) => all[place] = file.clone(),
                None => all.insert(1, file.clone()),
            }
            let out = folder.path().join("out").display().to_string();
            let table = match all[0].as_str() {
                "make" => Some(None),
                "sweep" => Some(Some("sweep.csv")),
                "analyse" => Some(Some("states.csv")),
                _ => None,
            };
            if table.is_some() {
                all.extend(["--out", &out, "--force"].map(str::to_owned));
            }
            let all: Vec<&str> = all.iter().map(String::as_str).collect();
            let output = tilebind(&all);
            assert!(output.status.success(), "{asked}: {}", stderr(&output));
            // The table of results, and what a second reader says of them.
            if let Some(Some(table)) = table {
                let mut text = without_checksums(&format!("{out}/{table}"));
                if all[0] == "analyse" {
                    text += &stdout(&tilebind(&["verify", &out, "--json"]));
                }
                return text;
            }
            let printed = stdout(&output);
            match serde_json::from_str(&printed) {
                Ok(value) => kept(value).to_string(),
                Err(_) => printed,
            }
        };
        ASKED.iter().map(answer).collect()
    };
    let first = answers(&new);
    for other in &others[..2] {
        for ((asked, one), two) in ASKED.iter().zip(&first).zip(answers(other)) {
            assert!(*one == two, "{asked}");
        }
    }
    // With the target faces exchanged the bond is the other of the two: figures stay, poses are turned.
    let exchanged = answers(&others[2]);
    let of = |text: &str, path: &str| {
        let value: Value = serde_json::from_str(text).unwrap();
        value.pointer(path).and_then(Value::as_f64).unwrap()
    };
    for (number, path) in [
        (0, "/bound/energy_J"),
        (0, "/pull_off_N"),
        (3, "/bond_kT"),
        (3, "/docking_cost_kT"),
        (5, "/bonds/mean"),
        (5, "/traps/mean"),
        (6, "/settings/0/yield_equilibrium"),
    ] {
        let [one, two] = [&first, &exchanged].map(|all| of(&all[number], path));
        assert!((one - two).abs() <= 2e-3 * one.abs(), "{path}: {one} {two}");
    }
    assert_eq!(first[1], exchanged[1]);
}

#[test]
fn keys_of_the_one_tile_are_varied() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").display().to_string();
    let sweep = |vary: &str| {
        tilebind(&[
            "sweep",
            "shapes/ring-of-eight.toml",
            "--vary",
            vary,
            "--milestones",
            "300",
            "--out",
            &out,
            "--force",
        ])
    };
    let output = sweep("tile.faces.0.magnet.remanence=1.0,1.2");
    assert!(output.status.success(), "{}", stderr(&output));
    let table = std::fs::read_to_string(format!("{out}/sweep.csv")).unwrap();
    let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let bond = head
        .iter()
        .position(|name| *name == "bond_depth_J")
        .unwrap();
    let values = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').nth(bond).unwrap().parse().unwrap());
    let values: Vec<f64> = values.collect();
    // Both tiles have the changed face: the bond is that of one changed and one unchanged magnet, but for
    // the far ones.
    assert!(
        (values[0] / values[1] * 1.2 - 1.0).abs() < 1e-3,
        "{values:?}"
    );
    for (vary, told) in [
        ("tile.nothing=1,2", "no key `nothing`"),
        ("fixed.mass=0.01,0.02", "[tile]"),
    ] {
        let output = sweep(vary);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(told), "{}", stderr(&output));
    }
}

/// A quarter of a ring that binds its own kind, drawn about a point away (m) from the ring's middle.
pub(super) fn sector(away: f64) -> String {
    let corner =
        |r: f64, turn: f64| format!("[{:.12}, {:.12}]", r * turn.cos() - away, r * turn.sin());
    let corners = [
        (0.03, -FRAC_PI_4),
        (0.07, -FRAC_PI_4),
        (0.07, FRAC_PI_4),
        (0.03, FRAC_PI_4),
    ];
    let corners = corners.map(|(r, turn)| corner(r, turn)).join(", ");
    format!(
        "[table]\nsize = [0.4, 0.4]\n[magnet]\nsize = [0.003, 0.005, 0.003]\nremanence = 1.2\npitch = 0.012\n\
         inset = 0.0005\n[potential]\nmodel = \"dipole\"\n[tile]\nvertices = [{corners}]\nthickness = 0.006\n\
         mass = 0.02\n[tile.faces]\n0 = {{ code = \"S\" }}\n2 = {{ code = \"N\" }}\n[target]\nfaces = [\"0\", \"2\"]\n"
    )
}

/// Rows and columns of a matrix in another order.
fn in_order(matrix: &Value, order: &[usize]) -> Vec<f64> {
    let at = |i: usize, j: usize| matrix[i][j].as_f64().unwrap();
    let pairs = order.iter().flat_map(|i| order.iter().map(|j| (*i, *j)));
    pairs.map(|(i, j)| at(i, j)).collect()
}

/// Neither their order nor which of two mates is called the word changes how strongly words attract.
#[test]
fn labels_of_words_change_no_crosstalk() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("words.toml").display().to_string();
    let strongest = |words: &str| {
        let text = format!(
            "words = {words}\n[magnet]\nsize = [0.01, 0.01, 0.003]\nremanence = 1.2\npitch = 0.04\n\
             [tile]\nside = 0.36\n[potential]\nmodel = \"dipole\"\n"
        );
        std::fs::write(&file, text).unwrap();
        let output = tilebind(&["crosstalk", &file, "--json"]);
        let found: Value = serde_json::from_str(&stdout(&output)).unwrap();
        found["strongest_J"].clone()
    };
    let first = strongest("[\"NNSN\", \"NSSN\", \"NNNN\"]");
    let all = in_order(&first, &[0, 1, 2, 3, 4, 5]);
    for (words, order) in [
        ("[\"NNNN\", \"NNSN\", \"NSSN\"]", [1, 2, 0, 4, 5, 3]),
        ("[\"SNSS\", \"SNNS\", \"SSSS\"]", [3, 4, 5, 0, 1, 2]),
        ("[\"NNSN\", \"SNNS\", \"NNNN\"]", [0, 4, 2, 3, 1, 5]),
    ] {
        let other = in_order(&strongest(words), &order);
        for (one, two) in all.iter().zip(&other) {
            assert!(
                (one - two).abs() <= 1e-12 * one.abs(),
                "{words}: {one} {two}"
            );
        }
    }
}

/// Other names of tiles and glues change only names; another order changes which word a glue gets,
/// and no figure of the set.
#[test]
fn labels_of_a_set_change_no_figure() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("set.yaml").display().to_string();
    let built = |tiles: &str| -> Value {
        std::fs::write(&file, format!("size: 3\ntau: 1\ntiles:\n{tiles}")).unwrap();
        let asked = format!("assemble {file} --kt 3e-3 --coverage 0.1 --length 6 --json");
        let output = tilebind(&asked.split(' ').collect::<Vec<_>>());
        assert!(output.status.success(), "{}", stderr(&output));
        serde_json::from_str(&stdout(&output)).unwrap()
    };
    let first = built(
        "- {name: a, edges: [0, g, h, 0]}\n- {name: b, edges: [0, 0, 0, g]}\n\
         - {name: c, edges: [h, k, 0, 0]}\n- {name: d, edges: [0, 0, 0, k]}\nseed: [1, 1, a]\n",
    );
    let renamed = built(
        "- {name: q, edges: [0, z, y, 0]}\n- {name: r, edges: [0, 0, 0, z]}\n\
         - {name: s, edges: [y, x, 0, 0]}\n- {name: t, edges: [0, 0, 0, x]}\nseed: [1, 1, q]\n",
    );
    let reordered = built(
        "- {name: c, edges: [h, k, 0, 0]}\n- {name: d, edges: [0, 0, 0, k]}\n\
         - {name: b, edges: [0, 0, 0, g]}\n- {name: a, edges: [0, g, h, 0]}\nseed: [1, 1, a]\n",
    );
    for key in [
        "bond_J",
        "Gse",
        "Gmc",
        "docking_cost_kT",
        "tau_effective",
        "window_kt_J",
        "proposed_kt_J",
        "verdict",
        "strongest_mismatch",
        "slides",
        "faces_tried",
    ] {
        assert!(!first[key].is_null(), "{key}");
        assert_eq!(first[key], renamed[key], "{key}");
        assert_eq!(first[key], reordered[key], "{key}");
    }
    for key in [
        "words",
        "mates",
        "matrix_J",
        "deeper_in_whole_tiles",
        "growths",
        "errors_at_standstill",
    ] {
        assert_eq!(first[key], renamed[key], "{key}");
    }
}

/// What is to be built, in every way to say it.
#[test]
fn targets_are_found_and_impossible_ones_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name).display().to_string();
        std::fs::write(&path, text).unwrap();
        path
    };
    let places = |all: &[[f64; 3]]| {
        let row = |(k, [x, y, theta]): (usize, &[f64; 3])| {
            format!("{k},{x:.9},{y:.9},{theta:.9},0,0,0\n")
        };
        let rows: String = all.iter().enumerate().map(row).collect();
        format!("tile,x,y,theta,vx,vy,omega\n{rows}")
    };
    let ring = file("ring.toml", &sector(0.0));
    let quarter = |k: usize| [0.0, 0.0, FRAC_PI_2 * k as f64];
    let closed = file("closed.csv", &places(&[0, 1, 2, 3].map(quarter)));
    let open = file("open.csv", &places(&[0, 1, 2].map(quarter)));
    let apart = file("apart.csv", &places(&[[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]]));
    let square = file(
        "square.toml",
        "[table]\nsize = [0.4, 0.4]\n[magnet]\nsize = [0.003, 0.005, 0.003]\nremanence = 1.2\npitch = 0.012\n\
         inset = 0.0005\n[tile]\nside = 0.05\nthickness = 0.006\nmass = 0.02\n[tile.faces]\n\
         all = { code = \"NS\" }\n[target]\nfaces = [\"0\"]\n",
    );
    let hexagon = "shapes/self-binding-hexagon.toml".to_owned();
    let cell = |k: usize| {
        [
            0.05 * (k % 3) as f64,
            0.05 * (k / 3) as f64,
            FRAC_PI_2 * k as f64,
        ]
    };
    let sheet: Vec<[f64; 3]> = (0..6).map(cell).collect();
    let sheet = file("sheet.csv", &places(&sheet));
    let asked = |design: &str, start: &str, target: &str| {
        tilebind(&[
            "table", design, "--start", start, "--time", "0.02", "--target", target, "--json",
        ])
    };
    for (design, start, target, share) in [
        (&ring, &closed, "ring:4", 1.0),
        (&ring, &closed, "chain:3", 0.0),
        (&ring, &closed, &closed[..], 1.0),
        (&ring, &open, "chain:3", 1.0),
        (&ring, &open, "ring:3", 0.0),
        (&ring, &open, &open, 1.0),
        (&square, &sheet, "sheet:3x2", 1.0),
        (&square, &sheet, "sheet:2X3", 1.0),
        (&square, &sheet, "sheet:2x2", 0.0),
        (&square, &sheet, &sheet, 1.0),
    ] {
        let output = asked(design, start, target);
        assert!(output.status.success(), "{}", stderr(&output));
        let found: Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(found["target"]["share"]["mean"], share, "{target}");
        let built = found["structures"].as_array().unwrap();
        let is_target = |it: &Value| it["kind"] == "target" && it["mean"] == 1.0;
        assert_eq!(built.iter().any(is_target), share > 0.0, "{target}");
    }
    for (design, start, target, told) in [
        (&hexagon, &apart, "sheet:1x2", "four faces"),
        (&ring, &open, "ring:8", "only 3 on the table"),
        (&ring, &closed, &apart[..], "not all joined by bonds"),
        (&ring, &closed, "ring:2", "from 3 to"),
        (&square, &sheet, "sheet:1x1", "from 2 to"),
        (&square, &sheet, "sheet:3", "lacks rows or columns"),
        (&square, &sheet, "heap:3", "is no target"),
    ] {
        let output = asked(design, start, target);
        assert_eq!(output.status.code(), Some(2), "{target}");
        assert!(
            stderr(&output).contains(told),
            "{target}: {}",
            stderr(&output)
        );
    }
}

/// Equal tiles that are drawn in different frames need no kinds in a start file either.
#[test]
fn starts_of_equal_tiles_need_no_kinds() {
    let folder = tempfile::tempdir().unwrap();
    let [design, start] =
        ["turned.toml", "start.csv"].map(|name| folder.path().join(name).display().to_string());
    let tile = "side = 0.05\nthickness = 0.005\nmass = 0.01\n";
    let of = |west: &str| {
        let text = format!(
            "[table]\nsize = [0.3, 0.3]\n[magnet]\nsize = [0.004, 0.004, 0.003]\nremanence = 0.6\npitch = 0.016\n\
             inset = 0.002\n[fixed]\n{tile}[fixed.faces]\neast = {{ code = \"NS\" }}\n[moving]\n{tile}\
             [moving.faces]\nwest = {{ {west} }}\n[target]\nfixed = \"east\"\nmoving = \"west\"\n"
        );
        std::fs::write(&design, text).unwrap();
        std::fs::write(
            &start,
            "tile,x,y,theta,vx,vy,omega\n0,0,0,0,0,0,0\n1,0.05,0,3.14159265,0,0,0\n",
        )
        .unwrap();
        tilebind(&[
            "table", &design, "--start", &start, "--time", "0.01", "--json",
        ])
    };
    let found: Value = serde_json::from_str(&stdout(&of("mates = \"east\""))).unwrap();
    assert_eq!(found["bonds"]["mean"], 1.0);
    // Tiles of two kinds need them.
    let output = of("code = \"N.S\"");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("no column `kind`"),
        "{}",
        stderr(&output)
    );
}

/// What to do about faces that cannot bind their own kind names faces of the one tile.
#[test]
fn advice_for_one_kind_can_be_followed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("one.toml").display().to_string();
    let told = |east: &str| {
        let text = format!(
            "[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [0.005, 0.005, 0.003]\nremanence = 1.2\n\
             pitch = 0.012\ninset = 0.006\n[tile]\nside = 0.06\nthickness = 0.006\nmass = 0.02\n\
             [tile.faces]\neast = {{ {east} }}\n[target]\nfaces = [\"east\"]\n"
        );
        std::fs::write(&file, text).unwrap();
        let output = tilebind(&["show", &file]);
        let all = stdout(&output) + &stderr(&output);
        all.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for (east, advice) in [
        ("code = \"NN\"", "binds its own kind if its code"),
        ("code = \"NNSN\"", "binds its own kind if its code"),
        ("mates = \"east\"", "mates itself"),
        (
            "profile = { shape = \"tab\", width = 0.02, depth = 0.004 }",
            "make east its own complement",
        ),
        (
            "profile = { shape = \"arc\", width = 0.02, depth = 0.004 }",
            "make east its own complement",
        ),
    ] {
        let told = told(east);
        assert!(told.contains(advice), "{east}: {told}");
        assert!(!told.contains("[moving"), "{east}: {told}");
    }
    // Whole teeth fit themselves, in every form, as a tab beside its slot does.
    for east in [
        "code = \"NS\", profile = { shape = \"teeth\", depth = 0.004, count = 3, form = \"sine\" }",
        "code = \"NNSS\", profile = { shape = \"teeth\", depth = 0.004, count = 3, form = \"triangle\" }",
        "code = \"NS\", profile = { shape = \"teeth\", depth = 0.004, count = 3, form = \"square\" }",
        "code = \"NS\", profile = { shape = \"points\", points = [[-0.03, 0], [-0.02, 0.004], [-0.01, 0], [0.01, 0], \
         [0.02, -0.004], [0.03, 0]] }",
    ] {
        let told = told(east);
        assert!(
            !told.contains("own complement") && !told.contains("own kind"),
            "{east}: {told}"
        );
    }
}

/// A table that starts with its ring closed has four bonds that no prediction for single tiles has.
#[test]
#[ignore = "slow"]
fn a_comparison_can_disagree() {
    let folder = tempfile::tempdir().unwrap();
    let [design, start] =
        ["sector.toml", "start.csv"].map(|name| folder.path().join(name).display().to_string());
    std::fs::write(&design, sector(0.0)).unwrap();
    let places: String = (0..4)
        .map(|k| format!("{k},0,0,{:.12},0,0,0\n", FRAC_PI_2 * f64::from(k)))
        .collect();
    let asked = |more: &str| {
        let text = format!(
            "table {design} --time 0.2 --runs 6 --shaking 3e-4 --drag 2 --restitution 1 --friction 0 --compare {more}"
        );
        let output = tilebind(&text.split_whitespace().collect::<Vec<_>>());
        assert!(output.status.success(), "{}", stderr(&output));
        stdout(&output)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    std::fs::write(&start, format!("tile,x,y,theta,vx,vy,omega\n{places}")).unwrap();
    let closed = asked(&format!("--start {start}"));
    assert!(closed.contains("and here are 4.00"), "{closed}");
    assert!(
        closed.contains("differ by more than both intervals"),
        "{closed}"
    );
    let single = asked("--count 4");
    assert!(single.contains("their intervals overlap"), "{single}");
}
