//! `tilebind table`.

use std::path::Path;
use std::process::Output;

use serde_json::Value;

use super::{json, tilebind};
use crate::program::stderr;

const TILE: &str = "shapes/paper-tile.toml";

/// Bound, as the design means it, and two of a kind far from both.
const START: &str = "tile,kind,x,y,theta,vx,vy,omega\n\
    0,fixed,-0.6,-0.6,0,0,0,0\n1,moving,-0.169,-0.6,0,0,0,0\n2,fixed,0.6,0.6,0.3,0,0,0\n3,moving,-0.6,0.7,0.5,0,0,0\n";

fn report(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("report.json")).expect("a report");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn bound_pairs_count_as_the_target_and_are_on_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let start = folder.path().join("start.csv");
    std::fs::write(&start, START).unwrap();
    let out = folder.path().join("out");
    let [start, folder] = [&start, &out].map(|path| path.to_str().unwrap());
    let found = json(&[
        "table", TILE, "--start", start, "--time", "0.2", "--drag", "5", "--out", folder, "--json",
    ]);
    assert_eq!(found["bonds"]["mean"], 1.0);
    assert_eq!(found["traps"]["mean"], 0.0);
    // One of two pairs.
    assert_eq!(found["target"]["share"]["mean"], 0.5);
    assert!(found["target"]["defects"].is_null());
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        page.contains(r#""bonds":[[0,1]],"traps":[]"#),
        "the page plays the bond"
    );
    assert_eq!(report(&out)["designs"].as_array().unwrap().len(), 1);
    assert!(!out.join("trajectory.csv").exists(), "nobody asked");
}

#[test]
fn a_table_goes_on_from_a_frame() {
    let folder = tempfile::tempdir().unwrap();
    let [first, next, out] = ["first.csv", "next.csv", "out"].map(|it| folder.path().join(it));
    let [first_file, next_file, folder] =
        [&first, &next, &out].map(|path| path.to_str().expect("UTF-8"));
    // Tiles in contact may overlap by up to 0.3 um.
    std::fs::write(&first, START.replace("-0.169", "-0.17000005")).unwrap();
    let asked = ["--time", "0.2", "--drag", "5", "--frames", "0.1"];
    let table = |start, more: &[&str]| {
        let command = [&["table", TILE, "--start", start], &asked[..], more].concat();
        json(&command)
    };
    table(first_file, &["--out", folder, "--json"]);
    let frames = std::fs::read_to_string(out.join("trajectory.csv")).unwrap();
    let head = "run,time_s,";
    let last = format!("0,{},", "0.2");
    let rows = frames
        .lines()
        .filter_map(|line| line.strip_prefix(head).or_else(|| line.strip_prefix(&last)));
    let rows: Vec<&str> = rows.collect();
    assert_eq!(rows.len(), 5, "{frames}");
    std::fs::write(&next, rows.join("\n") + "\n").unwrap();
    let found = table(next_file, &["--json"]);
    assert_eq!(found["bonds"]["mean"], 1.0);
}

#[test]
fn several_designs_share_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let found = json(&[
        "table",
        "shapes/tab-10mm.toml",
        "shapes/arc-20mm.toml",
        "--count",
        "1,1",
        "--time",
        "0.1",
        "--frames",
        "0.05",
        "--out",
        out,
        "--json",
    ]);
    assert_eq!(found["tiles"], 4);
    assert_eq!(found["designs"].as_array().unwrap().len(), 2);
    let frames = std::fs::read_to_string(folder.path().join("trajectory.csv")).unwrap();
    for kind in [
        "tab-10mm fixed",
        "tab-10mm moving",
        "arc-20mm fixed",
        "arc-20mm moving",
    ] {
        assert!(frames.contains(&format!(",{kind},")), "{kind}: {frames}");
    }
}

/// Three runs of four tiles.
fn three_runs(out: &Path, more: &[&str]) -> Output {
    let text = "table --count 2,2 --time 0.3 --runs 3 --shaking 3e-3 --drag 0.5";
    let words = text
        .split(' ')
        .chain([TILE, "--out", out.to_str().unwrap()]);
    tilebind(&words.chain(more.iter().copied()).collect::<Vec<_>>())
}

#[test]
fn parts_of_the_runs_are_joined_to_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let done = |name: &str, more: &[&str]| {
        let output = three_runs(&at(name), more);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    };
    let parts = ["one", "two"].map(|name| at(name).to_str().unwrap().to_owned());
    let merge = ["--merge", &parts[1], &parts[0]];
    done("whole", &[]);
    done("one", &["--shard", "1/2"]);
    done("two", &["--shard", "2/2"]);
    assert_eq!(report(&at("one"))["runs"], 2);
    done("joined", &merge);
    let mut compared = 0;
    for entry in std::fs::read_dir(at("whole")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".csv") || name.ends_with(".gsd") {
            let [whole, joined] =
                ["whole", "joined"].map(|of| std::fs::read(at(of).join(&name)).unwrap());
            assert!(whole == joined, "{name}");
            compared += 1;
        }
    }
    assert_eq!(compared, 5);
    let [whole, joined] = ["whole", "joined"].map(|of| {
        let mut report = report(&at(of));
        for time in ["wall_s", "threads"] {
            report.as_object_mut().unwrap().remove(time);
        }
        report
    });
    assert_eq!(whole, joined);
}

#[test]
fn parts_of_other_runs_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let part = three_runs(&at("one"), &["--shard", "1/2"]);
    assert_eq!(part.status.code(), Some(0), "{}", stderr(&part));
    let one = at("one").to_str().unwrap().to_owned();
    let refused = |more: &[&str], why: &str| {
        let output = three_runs(&at("out"), more);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(why), "{why}: {told}");
        assert!(!at("out").exists(), "{why}");
    };
    refused(&["--merge", &one], "1 of 3 runs are in no part: numbers 1");
    refused(&["--merge", &one, &one], "run 0 is in another part, too");
    refused(&["--merge", &one, "--seed", "2"], "another seed");
    refused(&["--merge", &one, "--friction", "0.1"], "other settings");
    refused(&["--merge", &one, "--frames", "0.1"], "other settings");
    refused(&["--merge", &one, "--model", "cuboid"], "other tiles");
    refused(&["--merge", "nowhere"], "cannot read the part");
    let file = at("one").join("part.json");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("[[0,[", "[[7,[")).unwrap();
    refused(&["--merge", &one], "has been changed by hand");
    std::fs::write(&file, &text[..text.len() / 2]).unwrap();
    refused(&["--merge", &one], "no part of a table");
    // Not even with a checksum that fits.
    type Edit = fn(&mut Value);
    let edits: [(&str, Edit); 12] = [
        ("one", |run| run["step"] = (-1.0).into()),
        ("step", |run| run["step"] = 1e-9.into()),
        ("mean", |run| run["kinetic"] = 1e308.into()),
        ("error", |run| run["energy_error"] = 1e308.into()),
        ("time", |run| run["samples"][0]["time"] = (-1e300).into()),
        ("energy", |run| run["samples"][1]["kinetic"] = 1e308.into()),
        ("cluster", |run| {
            run["samples"][1]["clusters"] = vec![1_000_000].into()
        }),
        ("clusters", |run| {
            run["samples"][1]["clusters"] = Value::Array(Vec::new())
        }),
        ("sample", |run| {
            drop(run["samples"].as_array_mut().unwrap().pop())
        }),
        ("place", |run| run["movers"][0][1][0] = 1e300.into()),
        ("speed", |run| run["movers"][0][2][0] = 1e300.into()),
        ("life", |run| {
            let life = serde_json::json!({"tiles": [0, 0], "tie": "Bond", "from": 0.0, "to": 0.1});
            run["lives"] = vec![life].into();
        }),
    ];
    for (what, edit) in edits {
        let mut part: Value = serde_json::from_str(&text).unwrap();
        edit(&mut part[1][0]);
        std::fs::write(&file, part.to_string()).unwrap();
        refused(&["--merge", &one], "has been changed by hand");
        part[2] = sha256(&serde_json::json!([part[0], part[1]]).to_string()).into();
        std::fs::write(&file, part.to_string()).unwrap();
        let output = three_runs(&at("out"), &["--merge", &one]);
        let told = stderr(&output);
        assert!(told.contains("values that no run has"), "{what}: {told}");
    }
}

fn sha256(text: &str) -> String {
    use sha2::{Digest, Sha256};
    let digest = Sha256::digest(text);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Neither more tiles than a table can have, nor a time that grows as their square.
#[test]
fn starts_have_at_most_a_hundred_thousand_tiles() {
    let folder = tempfile::tempdir().unwrap();
    let start = folder.path().join("start.csv");
    let mut text = "tile,kind,x,y,theta,vx,vy,omega\n".to_owned();
    for tile in 0..100_002 {
        text += &format!("{tile},fixed,0,0,0,0,0,0\n");
    }
    std::fs::write(&start, text).unwrap();
    let output = tilebind(&[
        "table",
        TILE,
        "--start",
        start.to_str().unwrap(),
        "--time",
        "0.1",
    ]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(
        told.contains("line 100002: a table can have at most"),
        "{told}"
    );
}

#[test]
fn tiles_of_a_set_are_compared_with_its_pattern() {
    let folder = tempfile::tempdir().unwrap();
    let set = folder.path().join("two.yaml");
    let text = "size: 2\ntau: 1\ntiles:\n- {name: a, edges: [0, g, 0, 0]}\n\
                - {name: b, edges: [0, 0, 0, g]}\nseed: [1, 1, a]\n";
    std::fs::write(&set, text).unwrap();
    let set = set.to_str().unwrap();
    let found = json(&["table", set, "--count", "1,1", "--time", "0.1", "--json"]);
    let target = &found["target"];
    // Each alone, a tile has one of the pattern's places.
    let share = target["share"]["mean"].as_f64().unwrap();
    assert!(share > 0.0 && share <= 0.5, "{target}");
    assert_eq!(target["defects"]["mean"], 0.0);
}

#[test]
fn a_lattice_is_compared_with_its_growth_from_a_seed() {
    let text = "table lattice --lattice 2x2 --count 1,1,1,1 --time 0.1 --shaking 5e-3 --drag 1 --compare --json";
    let words: Vec<&str> = text.split(' ').collect();
    let found = json(&words);
    assert_eq!(found["tiles"], 4);
    let text = "assemble lattice --lattice 2x2 --kt 5e-3 --coverage 0.3 --json";
    let words: Vec<&str> = text.split(' ').collect();
    let grown = json(&words);
    let growths = grown["growths"].as_array().unwrap();
    let same = growths.iter().find(|it| it["kT_J"] == 5e-3).unwrap();
    for key in ["runs", "right", "wrong"] {
        assert_eq!(found["assemble"][key], same[key], "{key}");
    }
}

#[test]
fn yield_is_compared() {
    let found = json(&[
        "table",
        TILE,
        "--count",
        "1,1",
        "--time",
        "1",
        "--shaking",
        "3e-3",
        "--drag",
        "0.5",
        "--compare",
        "--json",
    ]);
    let said = json(&[
        "yield",
        TILE,
        "--tiles",
        "2",
        "--time",
        "1",
        "--kt",
        "3e-3",
        "--drag",
        "0.5",
        "--coverage",
        "0.0924500",
        "--attachments",
        "100",
        "--simulations",
        "0",
        "--json",
    ]);
    let [here, there] = [&found["yield"]["bound"], &said["yield"]].map(|it| it.as_f64().unwrap());
    assert!((here / there - 1.0).abs() < 1e-3, "{here} {there}");
}

/// Two tiles at rest have no kinetic energy yet, and half a second is too short to say more.
#[test]
fn too_few_samples_are_no_proof_of_a_temperature() {
    let short = [
        "table",
        TILE,
        "--count",
        "1,1",
        "--shaking",
        "3e-3",
        "--drag",
        "0.5",
        "--time",
    ];
    let output = tilebind(&[&short[..], &["0.5"]].concat());
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("(possibly thermal; "), "{said}");
    assert!(said.contains("simulate for longer"), "{said}");
    let found = json(&[&short[..], &["0.5", "--json"]].concat());
    assert_eq!(found["verdict"], "thermal");
    // Six degrees of freedom, each with one independent sample: 2 sqrt(2 / 6).
    let error = found["kinetic_error"].as_f64().unwrap();
    assert!((error - 2.0 / 3.0_f64.sqrt()).abs() < 1e-12, "{error}");
}

#[test]
fn wrong_tables_are_refused_with_their_fix() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let blocks = folder.path().join("blocks.toml");
    let text = std::fs::read_to_string(TILE).unwrap();
    std::fs::write(
        &blocks,
        text.replace("paper-tile", "blocks")
            .replace("\"dipole\"", "\"cuboid\""),
    )
    .unwrap();
    let blocks = blocks.to_str().unwrap();
    let counted = ["--count", "1,1", "--time", "1"];
    for (wrong, fix) in [
        (&[TILE, "--shard", "3/2"][..], "parts of n are 1/n"),
        (&[TILE, "--shard", "2/2"], "this part has none"),
        (&[TILE, "--compare"], "--shaking"),
        (
            &[
                TILE,
                "shapes/tab-20mm.toml",
                "--compare",
                "--shaking",
                "3e-3",
                "--drag",
                "1",
            ],
            "exactly one design",
        ),
        (&[TILE, "--lattice", "2x2"], "instead of a design"),
        (&[TILE, TILE], "give one of them another `name`"),
        (&[TILE, blocks], "give --model"),
        (
            &[TILE, "--count", "1,1,1"],
            "needs 2, one for each kind of tile: fixed, moving",
        ),
        (&[TILE, "--count", "40,40"], "do not fit"),
        (&[TILE, "--step", "1e-300"], "at least 1e-12"),
        (&[TILE, "--step", "1e-9"], "longer --step"),
        (&[TILE, "--orbital", "1,1e9"], "at most 1000 Hz"),
        (
            &[TILE, "--orbital", "1e300,1e300"],
            "at most 1 m, not 1e300 m",
        ),
        (&[TILE, "--linear", "0.01,5"], "linear shaking is A,F,ANGLE"),
        (&[TILE, "--linear", "5,5,0"], "did you mean \"5 mm,5,0\"?"),
        (&[TILE, "--table-friction", "-1"], "--table-friction"),
        (&[TILE, "--frames", "1e-9"], "--frames"),
        (&[TILE, "--fan", "0,0,1,1,1,1e300"], "F is at most 1000 Hz"),
        (&[TILE, "--fan", "0,0,-1,1"], "a fan repels"),
        (
            &[TILE, "--count", "3,3", "--runs", "1e7", "--frames", "0.01"],
            "use longer --frames",
        ),
    ] {
        let counted = if wrong.contains(&"--count") {
            &counted[2..]
        } else {
            &counted[..]
        };
        let output = tilebind(
            &[
                &["table"],
                wrong,
                counted,
                &["--out", out.to_str().unwrap()],
            ]
            .concat(),
        );
        assert_eq!(
            output.status.code(),
            Some(2),
            "{wrong:?} {}",
            stderr(&output)
        );
        assert!(stderr(&output).contains(fix), "{}", stderr(&output));
        assert!(!out.exists(), "{wrong:?}: nothing is written");
    }
}

#[test]
fn wrong_starts_are_refused_with_their_line_and_fix() {
    let folder = tempfile::tempdir().unwrap();
    let start = folder.path().join("start.csv");
    let file = start.to_str().unwrap();
    for (from, to, said) in [
        (
            "0,fixed,-0.6,-0.6,",
            "0,fixed,-0,6,-0,6,",
            "line 2: it has 10 entries instead of 8",
        ),
        (
            "-0.169,-0.6,",
            "-0.18,-0.6,",
            "line 3: tiles 0 and 1 overlap",
        ),
        (
            "-0.169,-0.6,",
            "-0.18,-0.6,",
            "move it away from tile 0 (line 2)",
        ),
        (
            "2,fixed,0.6,0.6",
            "2,fixed,0.9,0.6",
            "line 4: tile 2 reaches",
        ),
        ("2,fixed,0.6,0.6", "2,fixed,0.9,0.6", "move it inwards"),
    ] {
        std::fs::write(&start, START.replace(from, to)).unwrap();
        let output = tilebind(&["table", TILE, "--start", file, "--time", "0.1"]);
        assert_eq!(output.status.code(), Some(2), "{to}");
        let told = stderr(&output);
        assert!(
            told.contains("start.csv: line") && told.contains(said),
            "{told}"
        );
    }
}

#[test]
fn a_table_is_handed_to_hoomd() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = three_runs(&out, &["--hoomd"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let script = std::fs::read_to_string(out.join("hoomd_table.py")).unwrap();
    assert!(script.contains("trajectory.gsd"));
    let told: Value =
        serde_json::from_slice(&std::fs::read(out.join("hoomd_table.json")).unwrap()).unwrap();
    assert_eq!(told["shaking_J"], 3e-3);
    let kinds = told["kinds"].as_array().unwrap();
    assert_eq!(kinds.len(), 2);
    for kind in kinds {
        assert_eq!(kind["outline"].as_array().unwrap().len(), 4);
        let magnets = kind["magnets"].as_array().unwrap();
        assert_eq!(magnets.len(), 16);
        let moment = |it: &Value| it["moment"].as_f64().unwrap();
        assert!(magnets.iter().all(|it| moment(it) > 0.0 && it["up"] == 0));
    }
}

/// A round table with dry friction on a linear shaker, as a user would ask for it.
#[test]
fn a_round_table_is_shaken() {
    let folder = tempfile::tempdir().unwrap();
    let (design, out) = (folder.path().join("round.toml"), folder.path().join("out"));
    let text = std::fs::read_to_string("shapes/ring-of-eight.toml").unwrap();
    let round = "[table]\nshape = \"disc\"\ndiameter = \"40 cm\"";
    std::fs::write(&design, text.replace("[table]\nsize = [1.0, 1.0]", round)).unwrap();
    let [design, path] = [&design, &out].map(|it| it.to_str().unwrap());
    let asked = [
        "--count", "5", "--time", "0.3", "--runs", "3", "--drag", "0",
    ];
    let drives = [
        "--table-friction",
        "0.2",
        "--linear",
        "8 mm,6,30 deg",
        "--frames",
        "0.1",
    ];
    let command = [&["table", design], &asked[..], &drives, &["--out", path]].concat();
    let output = tilebind(&command);
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        said.contains("the linear motion drives the tiles; kT does not apply"),
        "{said}"
    );
    let report = report(&out);
    assert_eq!(report["settings"]["table_friction"], 0.2);
    assert_eq!(report["settings"]["linear"]["frequency"], 6.0);
    assert!(report["target"]["share"]["sd"].is_number());
    // The end of every run is a picture, and the first run an animated one.
    assert!(out.join("pictures/ends.png").exists() || out.join("ends.png").exists());
    let film = std::fs::read(out.join("trajectory.png")).unwrap();
    assert!(film.windows(4).any(|it| it == b"acTL"));
    let energy = std::fs::read_to_string(out.join("energy.csv")).unwrap();
    assert!(
        energy
            .lines()
            .next()
            .unwrap()
            .ends_with("drag_loss_J,table_loss_J")
    );
    // Corners stay within the rim.
    let poses = std::fs::read_to_string(out.join("ends.csv"))
        .or_else(|_| std::fs::read_to_string(out.join("pictures/ends.csv")));
    for line in poses.unwrap().lines().skip(1) {
        let cells: Vec<f64> = line.split(',').filter_map(|it| it.parse().ok()).collect();
        let [x, y, theta] = cells[cells.len() - 3..] else {
            panic!("{line}");
        };
        let corner = [x + 0.06 * libm::cos(theta), y + 0.06 * libm::sin(theta)];
        assert!(libm::hypot(corner[0], corner[1]) < 0.2 + 1e-6, "{line}");
    }
}

/// The positions (m) in the first frame of a GSD file.
fn gsd_positions(file: &[u8]) -> Vec<f32> {
    let word = |at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
    let [index, entries, names] = [8, 16, 24].map(word);
    let name = |number: usize| file[names..].split(|it| *it == 0).nth(number).unwrap();
    let entry = (0..entries).map(|k| index + 32 * k).find(|at| {
        let number = u16::from_le_bytes([file[at + 28], file[at + 29]]);
        word(*at) == 0 && name(number.into()) == b"particles/position"
    });
    let entry = entry.expect("positions");
    let (rows, from) = (word(entry + 8), word(entry + 16));
    let bytes = file[from..from + 12 * rows].chunks(4);
    bytes
        .map(|it| f32::from_le_bytes(it.try_into().unwrap()))
        .collect()
}

/// Start files are of the reference point, `trajectory.gsd` of the centre of mass, as HOOMD has it.
#[test]
fn a_trajectory_is_of_centres_of_mass() {
    let folder = tempfile::tempdir().unwrap();
    let (start, out) = (folder.path().join("start.csv"), folder.path().join("out"));
    std::fs::write(&start, "tile,x,y,theta,vx,vy,omega\n0,0.1,0.2,0,0,0,0\n").unwrap();
    let [start, path] = [&start, &out].map(|it| it.to_str().unwrap());
    let design = "shapes/ring-of-eight.toml";
    let output = tilebind(&[
        "table", design, "--start", start, "--time", "0.01", "--out", path,
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let place = gsd_positions(&std::fs::read(out.join("trajectory.gsd")).unwrap());
    // The centroid of the sector, which is symmetric about 22.5 degrees.
    let turn = f64::from(place[1] - 0.2).atan2(f64::from(place[0] - 0.1));
    assert!(
        (turn - std::f64::consts::FRAC_PI_8).abs() < 1e-3,
        "{place:?}"
    );
    assert!((place[0] - 0.1).hypot(place[1] - 0.2) > 0.03, "{place:?}");
}
