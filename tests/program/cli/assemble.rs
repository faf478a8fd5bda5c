//! `tilebind assemble`.

use std::path::Path;

use serde_json::Value;

use super::{json, tilebind};
use crate::folder::contents;
use crate::program::{stderr, stdout};

const COUNTER: &str = "shapes/assemblies/binary-counter.yaml";

fn text(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).expect("it is written")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn built(arguments: &[&str], out: &Path) -> Value {
    let out = out.to_str().unwrap();
    let common = ["--kt", "5e-3", "--coverage", "0.1", "--json", "--out", out];
    json(&[&["assemble"][..], arguments, &common].concat())
}

/// The rows of a table by their first cells.
fn rows(csv: &str) -> Vec<Vec<&str>> {
    csv.lines().map(|line| line.split(',').collect()).collect()
}

#[test]
fn the_matrix_is_what_energy_says_of_two_faces() {
    let folder = tempfile::tempdir().unwrap();
    for model in ["dipole", "cuboid"] {
        let out = folder.path().join(model);
        built(&[COUNTER, "--length", "8", "--model", model], &out);
        let table = text(&out, "matrix.csv");
        let rows = rows(&table);
        for (first, second) in [(1, 1), (1, 7), (2, 9), (7, 12), (5, 11)] {
            let design = format!(
                "name = \"two\"\n[table]\nsize = [3.0, 3.0]\n[magnet]\nsize = [0.01, 0.01, 0.003]\n\
                 remanence = 1.2\npitch = 0.04\n[fixed]\nside = 0.32\nthickness = 0.013\nmass = \
                 0.1\n[fixed.faces]\nnorth = {{ code = \"{}\" }}\n[moving]\nside = 0.32\nthickness = \
                 0.013\nmass = 0.1\n[moving.faces]\nsouth = {{ code = \"{}\" }}\n[target]\nfixed = \
                 \"north\"\nmoving = \"south\"\n[potential]\nmodel = \"{model}\"\n",
                rows[first][1], rows[second][1]
            );
            let file = folder.path().join("two.toml");
            std::fs::write(&file, design).unwrap();
            let energy = json(&["energy", file.to_str().unwrap(), "--pose", "0,0.32,0"]);
            let (own, its): (f64, f64) = (
                rows[first][second + 1].parse().unwrap(),
                number(&energy[0]["energy_J"]),
            );
            assert!(
                (own - its).abs() <= 1e-9 * its.abs().max(1e-3),
                "{own} {its}"
            );
        }
    }
}

#[test]
fn both_engines_get_the_same_strengths() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let report = built(&[COUNTER, "--length", "8"], out);
    let (gse, kt) = (number(&report["Gse"]), number(&report["kt_J"]));
    assert!((gse - number(&report["bond_J"]) / kt).abs() < 1e-9 * gse);
    let [yaml, tiles] = ["assembly.yaml", "assembly.tiles"].map(|name| text(out, name));
    for line in [
        format!("Gse: {gse:?}"),
        format!("Gmc: {:?}", number(&report["Gmc"])),
    ] {
        assert!(yaml.contains(&line), "{line}");
        assert!(tiles.contains(&line.replace(": ", "=")), "{line}");
    }
    // Detached tiles leave, with everything attached to them.
    assert!(yaml.contains("\nfission: keep-seeded\n") && tiles.contains("\nfission\n"));
    let table = text(out, "matrix.csv");
    let rows = rows(&table);
    // Every two of twelve faces once, at their energy; for xgrow those that attract.
    let all = yaml.lines().filter(|line| line.starts_with("- [\""));
    assert_eq!(all.count(), 12 * 11 / 2);
    let links: Vec<&str> = tiles
        .lines()
        .filter(|line| line.starts_with("g("))
        .collect();
    let attract = |row: &Vec<&str>| row[2..].iter().filter(|it| it.starts_with('-')).count();
    // Each in two rows, or on the diagonal.
    let own = (1..13).filter(|k| rows[*k][k + 1].starts_with('-')).count();
    let count: usize = rows[1..].iter().map(attract).sum();
    assert_eq!(links.len(), (count - own) / 2);
    for link in links {
        let (at, strength) = link[2..].split_once(")=").unwrap();
        let (a, b) = at.split_once(',').unwrap();
        // Faces have numbers from 1.
        let number_of = |k: &str| k.parse::<usize>().unwrap() - 1;
        let energy = number(&report["matrix_J"][number_of(a)][number_of(b)]);
        let strength: f64 = strength.parse().unwrap();
        assert!((strength * gse + energy / kt).abs() < 1e-9, "{link}");
        let name = |k: &str| rows[k.parse::<usize>().unwrap()][0];
        assert!(
            yaml.contains(&format!(
                "- [\"{}\", \"{}\", {strength:?}]",
                name(a),
                name(b)
            )),
            "{link}"
        );
    }
}

/// Letters and codes of a folder, from every file that has both.
fn lettering(out: &Path) -> Vec<(String, String, String)> {
    let mut found = Vec::new();
    let is_code = |text: &str| !text.is_empty() && text.chars().all(|c| "NS.".contains(c));
    let mut add = |file: &str, name: &str, code: &str| {
        assert!(is_code(code), "{file}: {name} {code}");
        found.push((file.to_owned(), name.to_owned(), code.to_owned()));
    };
    let table = text(out, "matrix.csv");
    let faces = rows(&table);
    for row in &faces[1..] {
        add("matrix.csv", row[0], row[1]);
    }
    let words = text(out, "words.toml");
    let (head, faces) = words.split_once("[faces]\n").unwrap();
    for line in faces.lines().filter(|line| !line.is_empty()) {
        let (name, entry) = line.split_once(" = ").unwrap();
        add(
            "words.toml",
            name.trim_matches('"'),
            entry.split('"').nth(1).unwrap(),
        );
    }
    let list = head
        .lines()
        .find(|line| line.starts_with("words = ["))
        .unwrap();
    for (k, code) in list.split('"').skip(1).step_by(2).enumerate() {
        add(
            "words.toml, words",
            &((b'A' + k as u8) as char).to_string(),
            code,
        );
    }
    let sheet = text(out, "sheet.md");
    for line in sheet.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        for cell in &cells {
            if let Some((name, code)) = cell.split_once(' ').filter(|it| is_code(it.1)) {
                add("sheet.md, tiles", name, code);
            }
        }
        if is_code(cells[1]) && is_code(cells[2]) {
            add("sheet.md, words", cells[0], cells[1]);
            add("sheet.md, words", &format!("{}*", cells[0]), cells[2]);
        }
    }
    // Tiles by their faces in the engine's file, and the same tiles in the designs.
    let engine = text(out, "assembly.yaml");
    let tiles = engine.lines().filter(|line| line.starts_with("- {name: "));
    let tiles: Vec<(&str, Vec<&str>)> = tiles
        .filter_map(|line| {
            let (name, rest) = line.split_once("edges: [")?;
            let edges = rest.split_once(']')?.0.split(", ");
            let name = name.split('"').nth(1)?;
            Some((name, edges.map(|edge| edge.trim_matches('"')).collect()))
        })
        .collect();
    assert!(!tiles.is_empty());
    for (name, design) in contents(&out.join("designs")) {
        let design = String::from_utf8(design).unwrap();
        let described = design
            .lines()
            .find(|line| line.starts_with("description"))
            .unwrap();
        let of = |k: usize| described.split(" face of ").nth(k).unwrap();
        let first = of(1).split(" meets ").next().unwrap();
        let second = of(2).trim_end_matches('"');
        for (role, tile) in [("[fixed.faces]", first), ("[moving.faces]", second)] {
            let tile = tiles
                .iter()
                .find(|it| it.0 == tile)
                .unwrap_or_else(|| panic!("{tile}"));
            let faces = design
                .split(role)
                .nth(1)
                .unwrap()
                .split("\n\n")
                .next()
                .unwrap();
            for line in faces.lines().filter(|line| line.contains(" = {")) {
                let (side, entry) = line.split_once(" = ").unwrap();
                let side = ["north", "east", "south", "west"]
                    .iter()
                    .position(|it| *it == side);
                let code = entry.split('"').nth(1).unwrap();
                add(&name, tile.1[side.unwrap()], code);
            }
        }
    }
    found
}

#[test]
fn a_letter_is_the_same_word_in_every_file() {
    let folder = tempfile::tempdir().unwrap();
    let [searched, given] = ["searched", "given"].map(|name| folder.path().join(name));
    built(
        &["--lattice", "3x3", "--length", "8", "--gap", "0.25"],
        &searched,
    );
    // The same words and two more, in another order, some as their mates.
    let found = text(&searched, "words.toml");
    let codes = found
        .lines()
        .find(|line| line.starts_with("words = ["))
        .unwrap();
    let mut codes: Vec<String> = codes
        .split('"')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect();
    codes.reverse();
    let other = |c: char| if c == 'N' { 'S' } else { 'N' };
    codes[3] = codes[3].chars().rev().map(other).collect();
    codes.insert(5, "NNNNNNNN".to_owned());
    let set = folder.path().join("set.toml");
    let list = codes.join("\", \"");
    std::fs::write(
        &set,
        format!("words = [\"{list}\"]\n[magnet]\npitch = 0.04\n"),
    )
    .unwrap();
    built(
        &["--lattice", "3x3", "--words", set.to_str().unwrap()],
        &given,
    );
    // Given letters stay.
    let kept = text(&given, "words.toml");
    for (k, code) in codes.iter().enumerate() {
        let entry = format!("\n{} = {{ code = \"{code}\" }}", (b'A' + k as u8) as char);
        assert!(kept.contains(&entry), "{entry}");
    }
    for out in [&searched, &given] {
        let all = lettering(out);
        let files: std::collections::BTreeSet<&str> = all.iter().map(|it| &it.0[..]).collect();
        assert!(files.len() > 12, "{files:?}");
        for (file, name, code) in &all {
            let other = all.iter().find(|it| it.1 == *name).unwrap();
            assert_eq!(code, &other.2, "{name} of {file} and of {}", other.0);
        }
        // And the set is one that is read.
        let words = out.join("words.toml");
        let read = json(&["crosstalk", words.to_str().unwrap(), "--json"]);
        let all = if *out == given { 13 } else { 12 };
        assert_eq!(read["words"].as_array().unwrap().len(), all);
    }
}

/// A puzzle of four tiles that is laid by hand: no growth, one of each tile, as many as it states;
/// the widest gap by energies; the design's side; designs that can be made.
#[test]
fn a_puzzle_is_laid_by_hand() {
    let folder = tempfile::tempdir().unwrap();
    let [set, design, out] = ["set.yaml", "small.toml", "out"].map(|name| folder.path().join(name));
    let tiles = "tiles:\n- {name: a, edges: [0, x, d, 0]}\n- {name: b, edges: [0, 0, d, x]}\n\
                 - {name: c, edges: [d, y, 0, 0]}\n- {name: d, edges: [d, 0, 0, y], stoic: 2}\n";
    std::fs::write(&set, tiles).unwrap();
    std::fs::write(&design, super::words::SMALL).unwrap();
    let [set, design, shown] = [&set, &design, &out].map(|path| path.to_str().unwrap());
    let asked = [
        "assemble", set, design, "--length", "4", "--json", "--out", shown,
    ];
    let found = json(&asked);
    assert_eq!(found["laid"]["tiles"], 5);
    assert_eq!(found["laid"]["of_each"][3], serde_json::json!(["d", 2]));
    assert!(found["grown"].is_null() && found["kt_J"].is_null());
    assert!(!out.join("assembly.yaml").exists() && out.join("sheet.md").exists());
    assert!(text(&out, "sheet.md").contains("5 tiles with"));
    let widest = json(&["words", design, "--length", "4", "--count", "3", "--json"]);
    let gap = number(&found["faces_tried"][0]["gap"]);
    assert!((gap - number(&widest["gap"])).abs() < 1e-9, "{gap}");
    let made = contents(&out.join("designs"));
    assert_eq!(made.len(), 6, "{:?}", made.keys());
    for name in made.keys() {
        let file = out.join("designs").join(name);
        assert!(text(&out.join("designs"), name).contains("side = 0.06\n"));
        let made = tilebind(&[
            "make",
            file.to_str().unwrap(),
            "--out",
            folder.path().join("made").join(name).to_str().unwrap(),
        ]);
        assert_eq!(made.status.code(), Some(0), "{}", stderr(&made));
    }
    // Without a side, tiles are as long as their corners need.
    let free = json(&[
        "assemble",
        set,
        "--length",
        "4",
        "--pitch",
        "0.013",
        "--seconds",
        "2",
        "--json",
    ]);
    assert_eq!(free["laid"]["tiles"], 5);
}

/// What is judged of growth: tau follows from the energies, the seed is named, and a seed that
/// nothing binds is no right growth.
#[test]
fn growth_says_where_it_starts() {
    let folder = tempfile::tempdir().unwrap();
    let run = |tiles: &str| {
        let set = folder.path().join("set.yaml");
        std::fs::write(&set, tiles).unwrap();
        json(&[
            "assemble",
            set.to_str().unwrap(),
            "--length",
            "4",
            "--kt",
            "5e-3",
            "--json",
        ])
    };
    let ribbon = "tiles:\n  - {edges: [0, 1, 0, 1]}\n  - {edges: [0, 1, 0, 0]}\noptions:\n";
    let found = run(&format!(
        "{ribbon}  Gse: 10.1\n  Gmc: 10.0\n  seed: [4, 2, 2]\n  size: [8, 64]\n"
    ));
    assert_eq!(found["tile_set"]["tau"], 1.0);
    assert_eq!(found["tile_set"]["tau_from"], "Gmc / Gse");
    assert!(number(&found["grown"]["tiles"]) > 50.0);
    // At tau 2 no tile attaches.
    let stuck = run(&format!("{ribbon}  seed: [4, 2, 2]\n  tau: 2\n"));
    assert_eq!(stuck["verdict"], "nothing attaches to the seed");
    for growth in stuck["growths"].as_array().unwrap() {
        assert_eq!(growth["right"], 0);
    }
    // A chain that grows from both ends of nothing: the seed's glue has no partner.
    let set = folder.path().join("lone.yaml");
    std::fs::write(
        &set,
        "tau: 1\ntiles:\n- {name: a, edges: [0, lone, 0, 0]}\n- {name: b, edges: [0, y, 0, 0]}\n\
         - {name: c, edges: [0, 0, 0, y]}\n",
    )
    .unwrap();
    let told = stdout(&tilebind(&[
        "assemble",
        set.to_str().unwrap(),
        "--length",
        "3",
        "--kt",
        "5e-3",
    ]));
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        told.contains("glue `lone` on the east face of `a` has no partner"),
        "{told}"
    );
    assert!(told.contains("the file names no seed"), "{told}");
}

#[test]
fn a_lattice_is_written_as_designs_whose_bonds_the_matrix_knows() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let report = built(
        &[
            "lattice",
            "--lattice",
            "3x3",
            "--length",
            "6",
            "--gap",
            "0",
            "--shape",
            "shared",
        ],
        out,
    );
    assert_eq!(report["tile_set"]["words_needed"], 12);
    assert_eq!(report["grown"]["tiles"], 9);
    let designs = contents(&out.join("designs"));
    assert_eq!(designs.len(), 12);
    let deepest = number(&report["deeper_in_whole_tiles"][1]);
    assert!(deepest <= 0.0, "{deepest}");
    let pairs = report["pairs"].as_array().unwrap();
    assert_eq!(
        (pairs.len(), rows(&text(out, "pairs.csv")).len()),
        (12, 1 + 12)
    );
    for row in pairs {
        let design = out.join(row["design"].as_str().unwrap());
        let shown = json(&["show", design.to_str().unwrap(), "--json"]);
        let energy = number(&shown["bound"]["energy_J"]);
        let of = ["faces_J", "other_faces_J", "tiles_J"];
        let [faces, others, whole] = of.map(|key| number(&row[key]));
        assert!(
            (energy - whole).abs() < 1e-9 * whole.abs(),
            "{row:?} {energy}"
        );
        assert!(
            (whole - faces - others).abs() < 1e-9 * whole.abs(),
            "{row:?}"
        );
        // No bond is deeper than in the matrix, nor much shallower.
        assert!(energy >= faces && energy < 0.95 * faces, "{row:?} {energy}");
        let bonds = report["bonds"].as_array().unwrap();
        let bond = bonds
            .iter()
            .find(|it| it["word"] == row["word"])
            .expect("its word");
        assert!((number(&bond["energy_J"]) - faces).abs() < 1e-12, "{row:?}");
    }
    let sheet = text(out, "sheet.md");
    assert!(sheet.contains("9 tiles with 144 magnets"), "{sheet}");
}

#[test]
fn no_state_of_a_lattice_is_deeper_than_the_matrix_says() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let arguments = ["lattice", "--lattice", "2x2", "--length", "3"];
    let report = built(&arguments, out);
    let bonds = report["bonds"].as_array().unwrap();
    let gap = number(&report["faces_tried"].as_array().unwrap().last().unwrap()["gap"]);
    let weakest = number(&report["bond_J"]);
    let designs = contents(&out.join("designs"));
    assert_eq!((bonds.len(), designs.len()), (4, 4));
    for (name, text) in designs {
        let design = out.join("designs").join(&name);
        let word = |bond: &&Value| {
            // The target face of the fixed tile carries a word.
            let text = String::from_utf8_lossy(&text);
            let side = if name.contains("east") {
                "east"
            } else {
                "north"
            };
            let word = bond["word"].as_str().unwrap();
            let index = bonds.iter().position(|it| it["word"] == word).unwrap();
            let code = report["words"][index].as_str().unwrap();
            let fixed = text.split("[moving]").next().unwrap();
            fixed.contains(&format!("{side} = {{ code = \"{code}\" }}"))
        };
        let bond = number(&bonds.iter().find(word).expect("its word")["energy_J"]);
        let few = "--complete-seconds 0 --certify-seconds 0 --milestones 60 --far-starts 4";
        let few: Vec<&str> = few.split(' ').collect();
        let (file, folder) = (design.to_str().unwrap(), out.join("pair"));
        let common = ["analyse", file, "--json", "--compact", "--out"];
        let states = json(&[&common[..], &[folder.to_str().unwrap()], &few].concat());
        let states = states["states"].as_array().unwrap().clone();
        // Magnets of other faces, which are close on such a short face, change it by a few
        // hundredths.
        let own = number(&states[0]["energy_J"]);
        assert_eq!(states[0]["kind"], "bound", "{name}");
        assert!(own >= bond && own < 0.97 * bond, "{name}: {own} {bond}");
        for state in &states[1..] {
            let energy = number(&state["energy_J"]);
            assert!(energy > -(1.0 - gap) * weakest * 1.03, "{name}: {state}");
        }
    }
}

#[test]
fn the_first_line_answers() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let run_of = |set: &[&str], kt: &str| {
        let shaken = ["--kt", kt, "--coverage", "0.1", "--out", out];
        let output = tilebind(&[&["assemble"], set, &shaken].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        // The answer is broken into lines.
        stdout(&output)
            .split("\n\n")
            .next()
            .unwrap()
            .replace('\n', " ")
    };
    let run = |kt: &str| run_of(&[COUNTER, "--length", "8"], kt);
    assert!(run("0.1").contains("growth does not end right"));
    // Two bonds of this lattice hold a tile where one does not.
    let hard = run_of(
        &["homogeneous", "--lattice", "3x3", "--length", "6"],
        "5e-3",
    );
    assert!(hard.contains("but stronger ones do"), "{hard}");
    assert!(run("5e-3").contains("too soft"));
    assert!(run("1e-3").contains("anything grows"));
    // Bonds of tau are single ones: wrong ones hold as well when tiles hardly move, and long before
    // that wrong tiles that hold by two mismatches are locked in while the lattice grows.
    let set = ["--lattice", "3x3", "--length", "13", "--gap", "0.5"];
    let lattice = |kt: &str| run_of(&set, kt);
    let cold = lattice("3e-3");
    assert!(
        cold.contains("simulated growths end with errors that remain"),
        "{cold}"
    );
    let out_of = folder.path().join("proposed");
    let report = built(&set, &out_of);
    let proposed = number(&report["proposed_kt_J"]);
    assert!(lattice(&proposed.to_string()).contains("right, so one bond holds a tile"));
    let growths = report["growths"].as_array().unwrap();
    let errors: Vec<f64> = growths
        .iter()
        .map(|it| number(&it["errors_a_tile"]))
        .collect();
    // Errors increase at lower temperature, apart from chance in small numbers.
    assert!(errors[0] > 0.3 && errors[0] > 2.0 * errors[3], "{errors:?}");
    assert!(errors[growths.len() - 3] < 0.02, "{errors:?}");
    let frozen = lattice("1e-9");
    assert!(frozen.contains("so errors grow") && !frozen.contains("000.00"));
}

#[test]
fn nonsense_is_refused_with_the_mend() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let common = [
        "--kt",
        "5e-3",
        "--coverage",
        "0.1",
        "--out",
        out.to_str().unwrap(),
    ];
    for arguments in [
        &["lattice"][..],
        &["square"],
        &["square", "--side", "2"],
        &["lattice", "--lattice", "3"],
        &["lattice", "--lattice", "1x1"],
        &["lattice", "--lattice", "100000x100000"],
        &[COUNTER, "--lattice", "3x3"],
        &[COUNTER, "--side", "3"],
        &[COUNTER, "--proofread", "0"],
        &[COUNTER, "--length", "2"],
        &[COUNTER, "--length", "4", "--magnets", "5"],
        &[COUNTER, "--magnets", "60"],
        &[COUNTER, "--length", "99"],
        &[COUNTER, "--words", "missing.toml"],
        &[COUNTER, "shapes/tab-20mm.svg"],
        &["missing.yaml"],
        &["Cargo.toml"],
    ] {
        let output = tilebind(&[&["assemble"][..], arguments, &common].concat());
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            stderr(&output)
        );
        assert!(
            !stderr(&output).is_empty() && !out.exists(),
            "{arguments:?}"
        );
    }
}
