//! `tilebind words`, `crosstalk` and `match`.

use std::path::Path;

use serde_json::Value;

use super::{json, numbers, tilebind};
use crate::folder::contents;
use crate::program::{stderr, stdout};

/// A small square tile of shop magnets.
pub(super) const SMALL: &str = "\
name = \"small\"
[table]
size = [0.4, 0.4]
[magnet]
size = [0.002, 0.01, 0.005]
grade = \"N45\"
pitch = \"13 mm\"
inset = \"0.6 mm\"
[fixed]
side = 0.06
thickness = \"8 mm\"
mass = \"19 g\"
[fixed.faces]
east = { code = \"NS\" }
[moving]
side = 0.06
thickness = \"8 mm\"
mass = \"19 g\"
[moving.faces]
west = { mates = \"east\" }
[target]
fixed = \"east\"
moving = \"west\"
";

fn words(found: &Value) -> Vec<&str> {
    let list = found["words"].as_array().expect("a list");
    list.iter()
        .map(|word| word.as_str().expect("a text"))
        .collect()
}

#[test]
fn eight_magnets_carry_seven_words() {
    let found = json(&["words", "--length", "8", "--gap", "0.45", "--json"]);
    assert_eq!(words(&found).len(), 7);
    assert_eq!(
        (&found["count"], &found["upper_bound"]),
        (&7.into(), &7.into())
    );
    assert_eq!(found["proved"], true);
    assert!(found["gap"].as_f64().unwrap() >= 0.45);
    assert!(found["bond_J"].as_f64().unwrap() > 0.0);
    for key in ["first", "second", "slide", "energy_J"] {
        assert!(!found["worst"][key].is_null(), "{key}");
    }
}

/// Tiles of one kind: NNSS, NSNS and SSNN each bind themselves, and the file has no mates.
#[test]
fn words_that_bind_their_own_kind_have_no_mates() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let asked = ["words", "--self", "--length", "4", "--gap", "0.4"];
    let found = json(&[&asked[..], &["--json", "--out", out]].concat());
    assert_eq!(words(&found), ["NNSS", "NSNS", "SSNN"]);
    assert_eq!(
        (&found["proved"], &found["upper_bound"]),
        (&true.into(), &3.into())
    );
    let text = std::fs::read_to_string(folder.path().join("words.toml")).unwrap();
    assert!(!text.contains('*') || !text.contains("\"A*\""), "{text}");
    // Every bond is that of two faces of one kind, as `energy` computes it.
    let bond = found["bond_J"].as_f64().unwrap();
    for word in words(&found) {
        let design = format!(
            "name = \"own\"\n[table]\nsize = [2.0, 2.0]\n[magnet]\nsize = [0.01, 0.01, 0.003]\n\
             remanence = 1.2\npitch = 0.04\n[fixed]\nside = 0.3\nthickness = 0.013\nmass = 0.1\n\
             [fixed.faces]\neast = {{ code = \"{word}\" }}\n[moving]\nside = 0.3\nthickness = \
             0.013\nmass = 0.1\n[moving.faces]\nwest = {{ code = \"{word}\" }}\n[target]\nfixed = \
             \"east\"\nmoving = \"west\"\n[potential]\nmodel = \"dipole\"\n"
        );
        let file = folder.path().join("own.toml");
        std::fs::write(&file, design).unwrap();
        let energy = json(&["energy", file.to_str().unwrap(), "--pose", "0.3,0,0"]);
        let energy = -energy[0]["energy_J"].as_f64().unwrap();
        assert!(energy >= bond * (1.0 - 1e-9), "{word}: {energy} {bond}");
    }
    assert!(
        (best_set_by_trial(0.4, &folder.path().join("pair.toml")) - found["gap"].as_f64().unwrap())
            .abs()
            < 1e-6
    );
    let refused = tilebind(&[&asked[..], &["--shape", "polar"]].concat());
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
}

/// The gap of the best of all largest sets of codes of four magnets that bind their own kind with at least
/// this gap, from the energies of every two codes at every slide.
fn best_set_by_trial(least: f64, file: &std::path::Path) -> f64 {
    let codes: Vec<String> = (0..16)
        .map(|bits| {
            (0..4)
                .map(|k| if bits >> k & 1 == 0 { 'N' } else { 'S' })
                .collect()
        })
        .collect();
    let turned = |code: &str| -> String {
        code.chars()
            .rev()
            .map(|c| if c == 'N' { 'S' } else { 'N' })
            .collect()
    };
    let own: Vec<&String> = codes.iter().filter(|code| turned(code) == **code).collect();
    let energies = |one: &str, other: &str| -> Vec<f64> {
        let tile = |name: &str, face: &str, code: &str| {
            format!(
                "[{name}]\nside = 0.3\nthickness = 0.013\nmass = 0.1\n[{name}.faces]\n{face} = {{ code = \"{code}\" }}\n"
            )
        };
        let design = format!(
            "[table]\nsize = [2.0, 2.0]\n[magnet]\nsize = [0.01, 0.01, 0.003]\nremanence = 1.2\npitch = 0.04\n{}{}\
             [target]\nfixed = \"east\"\nmoving = \"west\"\n[potential]\nmodel = \"dipole\"\n",
            tile("fixed", "east", one),
            tile("moving", "west", other)
        );
        std::fs::write(file, design).unwrap();
        let mut asked = vec!["energy".to_owned(), file.display().to_string()];
        for slide in -3..=3 {
            asked.extend([
                "--pose".to_owned(),
                format!("0.3,{},0", 0.04 * f64::from(slide)),
            ]);
        }
        let asked: Vec<&str> = asked.iter().map(String::as_str).collect();
        let found = json(&asked);
        found
            .as_array()
            .unwrap()
            .iter()
            .map(|it| it["energy_J"].as_f64().unwrap())
            .collect()
    };
    // The bond, and the strongest wrong attraction, of every two.
    let known: Vec<Vec<[f64; 2]>> = own
        .iter()
        .map(|one| {
            own.iter()
                .map(|other| {
                    let all = energies(one, other);
                    let wrong = |(slide, energy): (usize, &f64)| {
                        (slide != 3 || one != other).then_some(-energy)
                    };
                    let strongest = all.iter().enumerate().filter_map(wrong).fold(0.0, f64::max);
                    [-all[3], strongest]
                })
                .collect()
        })
        .collect();
    let gap = |set: &[usize]| {
        let weakest = set
            .iter()
            .map(|&k| known[k][k][0])
            .fold(f64::INFINITY, f64::min);
        let pairs = set.iter().flat_map(|&i| set.iter().map(move |&j| (i, j)));
        1.0 - pairs.map(|(i, j)| known[i][j][1]).fold(0.0, f64::max) / weakest
    };
    let sets = (1..1 << own.len())
        .map(|bits| -> Vec<usize> { (0..own.len()).filter(|k| bits >> k & 1 == 1).collect() });
    let fit = sets
        .map(|set| (set.len(), gap(&set)))
        .filter(|(_, gap)| *gap >= least);
    let (size, best) = fit.fold((0, 0.0), |best, it| if it > best { it } else { best });
    assert_eq!((own.len(), size), (4, 3));
    best
}

/// Words for a design are for tiles of its side, and lengths have no rounding errors.
#[test]
fn words_for_a_design_keep_its_side() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("small.toml");
    std::fs::write(&design, SMALL).unwrap();
    let out = folder.path().join("out");
    let [design, shown] = [&design, &out].map(|path| path.to_str().unwrap());
    let found = json(&[
        "words", design, "--length", "4", "--count", "5", "--json", "--out", shown,
    ]);
    assert_eq!(found["settings"]["inset_m"], 0.0006);
    let text = std::fs::read_to_string(out.join("words.toml")).unwrap();
    assert!(text.contains("[tile]\nside = 0.06\n"), "{text}");
}

#[test]
fn what_cannot_be_is_no_error() {
    let none = json(&["words", "--length", "4", "--gap", "0.99", "--json"]);
    assert_eq!((&none["count"], &none["proved"]), (&0.into(), &true.into()));
    assert!(none["gap"].is_null() && none["worst"].is_null());
    let none = json(&["words", "--length", "3", "--count", "1000", "--json"]);
    assert_eq!((&none["count"], &none["proved"]), (&0.into(), &true.into()));
    let told = stdout(&tilebind(&["words", "--length", "4", "--gap", "0.99"]));
    assert!(told.starts_with("none exists, proved"), "{told}");
}

#[test]
fn nonsense_is_refused_with_the_mend() {
    for arguments in [
        &["words"][..],
        &["words", "--length", "0"],
        &["words", "--length", "1000000"],
        &["words", "--length", "8", "--gap", "2"],
        &["words", "--length", "8", "--gap", "-0.1"],
        &["words", "--length", "8", "--count", "0"],
        &["words", "--length", "8", "--gap", "0.5", "--count", "3"],
        &["words", "--slots", "4", "--magnets", "9"],
        &["words", "--slots", "8"],
        &["words", "--length", "8", "--pitch", "0.001"],
        &["words", "--length", "8", "--faces", "some"],
        &["words", "--length", "8", "--seconds", "0"],
        &["words", "missing.toml", "--length", "8"],
        &["words", "--magnets", "4", "--gap", "0.5"],
        &[
            "words",
            "--length",
            "8",
            "--gap",
            "0.5",
            "--tolerate",
            "missing=2",
        ],
        &[
            "words",
            "--length",
            "8",
            "--contacts",
            "4",
            "--tolerate",
            "missing=1",
        ],
        &["words", "--length", "8", "--contacts", "8"],
        &["words", "--length", "8", "--min-mismatch", "2,2"],
        &["words", "--length", "8", "--consecutive", "3:1"],
        &["words", "--length", "8", "--word-word", "0:-1"],
        &["words", "--continuous", "--magnets", "4"],
        &["words", "--continuous", "--magnets", "4", "--count", "30"],
        &["words", "--continuous", "--magnets", "20", "--count", "1"],
        &[
            "words",
            "--continuous",
            "--magnets",
            "4",
            "--count",
            "2",
            "--slots",
            "9",
        ],
        &[
            "words",
            "--continuous",
            "--magnets",
            "4",
            "--count",
            "2",
            "--pitch",
            "0.005",
        ],
        &["words", "--length", "4", "--face", "0.3", "--count", "2"],
        &["crosstalk", "missing.toml"],
        &["match", "missing.toml"],
    ] {
        let output = tilebind(arguments);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{arguments:?}: {}",
            stderr(&output)
        );
        assert!(
            stdout(&output).is_empty() && !stderr(&output).is_empty(),
            "{arguments:?}"
        );
    }
}

#[test]
fn a_design_gives_its_magnets() {
    let of = |more: &[&str]| {
        let mut arguments = vec!["words", "--length", "6", "--gap", "0.45", "--json"];
        arguments.extend(more);
        json(&arguments)
    };
    let (paper, design) = (of(&[]), of(&["shapes/paper-tile.toml"]));
    assert_eq!(paper["words"], design["words"]);
    assert_eq!(paper["bond_J"], design["bond_J"]);
    let blocks = of(&["--model", "cuboid"]);
    assert!(blocks["bond_J"].as_f64() > paper["bond_J"].as_f64());
}

#[test]
fn a_set_is_written_read_and_judged_over_all_poses() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str, name: &str| {
        let out = folder.path().join(name);
        let arguments = ["words", "--length", "4", "--gap", "0.3", "--out"];
        let mut arguments = arguments.to_vec();
        arguments.extend([out.to_str().unwrap(), "--threads", threads, "--quiet"]);
        assert_eq!(tilebind(&arguments).status.code(), Some(0));
        contents(&out)
    };
    let (one, two) = (run("1", "one"), run("2", "two"));
    assert!(one == two, "the same bytes on any number of threads");
    for name in [
        "words.csv",
        "crosstalk.csv",
        "words.toml",
        "report.json",
        "report.html",
    ] {
        assert!(one.contains_key(name), "{name}");
    }
    judged(&folder.path().join("one/words.toml"));
}

/// Crosstalk is symmetric, includes the bonds, and lies above its bounds and below the energies of
/// slides.
fn judged(set: &Path) {
    let set = set.to_str().unwrap();
    let found = json(&[
        "crosstalk",
        set,
        "--certify=2e-3",
        "--certify-cells",
        "20000",
        "--json",
    ]);
    let m = words(&found).len();
    let rows = |key: &str| -> Vec<Vec<f64>> {
        found[key]
            .as_array()
            .expect("a matrix")
            .iter()
            .map(numbers)
            .collect()
    };
    let (strongest, lower) = (rows("strongest_J"), rows("lower_J"));
    assert_eq!(strongest.len(), 2 * m);
    for i in 0..2 * m {
        for j in 0..2 * m {
            assert_eq!(strongest[i][j], strongest[j][i]);
            assert!(lower[i][j] <= strongest[i][j], "{i} {j}");
        }
        let mate = if i < m { i + m } else { i - m };
        // Four contacts of 16.4 mJ, minus the effect of neighbours.
        assert!(strongest[i][mate] < -0.06, "{}", strongest[i][mate]);
    }
    assert_eq!(found["poses"].as_array().unwrap().len(), 2 * m);
    // A trap holds less than the bond.
    for (trap, bond) in found["traps_J"].as_array().unwrap().iter().zip(&strongest) {
        let deepest = bond.iter().copied().fold(0.0, f64::min);
        assert!(trap.is_null() || trap.as_f64().unwrap() > deepest, "{trap}");
    }
}

#[test]
fn sets_from_elsewhere_are_judged_and_faults_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("kit.toml");
    let path = file.to_str().unwrap();
    std::fs::write(
        &file,
        "[faces]\nA = { code = \"NN.S\" }\n\"A*\" = { code = \"N.SS\" }\n",
    )
    .unwrap();
    let found = json(&["crosstalk", path, "--json"]);
    assert_eq!(words(&found), ["NN.S"]);
    assert!(found["lower_J"].is_null());
    for (text, told) in [
        ("words = []", "no words"),
        ("words = [\"NNS\", \"NN\"]", "2 positions"),
        ("words = [\"NNX\"]", "not a pole"),
        ("words = [\"NNS\", \"NNS\"]", "twice"),
        ("words = [\"NNS\"]\nside = 3", "side"),
        (
            "words = [\"NNS\"]\n[tile]\nside = 0.05",
            "need a face of 0.0900 m",
        ),
        (
            "[faces]\nA = { magnets = [{ at = 0.0, pole = \"N\" }] }",
            "the length of its faces",
        ),
        (
            "[tile]\nside = 0.1\n[faces]\nA = { magnets = [{ at = 0.05, pole = \"N\" }] }",
            "extends beyond",
        ),
        (
            "[tile]\nside = 0.1\n[faces]\nA = { magnets = [{ at = 0.0, pole = \"N\" }, \
             { at = 0.005, pole = \"S\" }] }",
            "overlap",
        ),
        (
            "[tile]\nside = 0.1\n[faces]\nA = { magnets = [{ at = 0.0, pole = \"X\" }] }",
            "a pole is",
        ),
        ("words = [\"NNS\"]\n[tile]\nside = -1.0", "above zero"),
        ("words = ", "kit.toml:1"),
    ] {
        std::fs::write(&file, text).unwrap();
        let output = tilebind(&["crosstalk", path]);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(
            stderr(&output).contains(told),
            "{text}: {}",
            stderr(&output)
        );
    }
}

#[test]
fn faults_cost_words_and_are_told() {
    let of = |more: &[&str]| {
        let arguments = ["words", "--length", "8", "--gap", "0.2", "--json"];
        json(&[&arguments[..], more].concat())
    };
    let (none, missing) = (of(&[]), of(&["--tolerate", "missing=1"]));
    let count = |found: &Value| found["count"].as_u64().unwrap();
    assert!(0 < count(&missing) && count(&missing) < count(&none));
    assert_eq!(missing["settings"]["tolerate"], "missing=1");
    assert!(missing["gap"].as_f64().unwrap() >= 0.2);
    // Two of eight magnets may be missing.
    assert!(missing["bond_J"].as_f64().unwrap() < 0.77 * none["bond_J"].as_f64().unwrap());
    assert_eq!(missing["worst"]["faulty"].as_array().unwrap().len(), 2);
}

#[test]
fn positions_and_poles_are_found_together_and_judged_over_all_poses() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("spaced");
    let run = |threads: &str| {
        json(&[
            "words",
            "--continuous",
            "--magnets",
            "3",
            "--pitch",
            "0.02",
            "--count",
            "2",
            "--seconds",
            "0.3",
            "--threads",
            threads,
            "--out",
            out.to_str().unwrap(),
            "--json",
        ])
    };
    let (one, two) = (run("1"), run("2"));
    assert_eq!(one, two, "the same on any number of threads");
    assert_eq!((&one["count"], &one["proved"]), (&2.into(), &false.into()));
    assert!(one["upper_bound"].is_null());
    for positions in one["positions_m"].as_array().unwrap() {
        let positions = numbers(positions);
        assert!(
            positions
                .windows(2)
                .all(|two| two[1] - two[0] >= 0.02 - 2e-6),
            "{positions:?}"
        );
    }
    // The evaluation of the set's file equals that of the set.
    let set = out.join("words.toml");
    let judged = json(&["crosstalk", set.to_str().unwrap(), "--json"]);
    assert_eq!(judged["gap"], one["gap"]);
    assert_eq!(judged["bond_J"], one["bond_J"]);
    let text = std::fs::read_to_string(&set).unwrap();
    assert!(text.contains("magnets = [{ at = "), "{text}");
}

/// Words of upright magnets that repel each other everywhere are not followed to infinity.
#[test]
fn faces_of_upright_magnets_that_only_repel_are_judged() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("upright.toml");
    let path = file.to_str().unwrap();
    // A proof for blocks takes a minute and a half.
    for (magnet, is_proved) in [
        ("shape = \"disc\"\ndiameter = 0.010\nheight = 0.003", true),
        ("size = [0.003, 0.010, 0.010]", false),
    ] {
        let text = format!(
            "words = [\"UUU\"]\n[magnet]\n{magnet}\naxis = \"up\"\n[potential]\nmodel = \
             \"cuboid\"\n"
        );
        std::fs::write(&file, text).unwrap();
        let found = json(&["crosstalk", path, "--json"]);
        let strongest = found["strongest_J"].as_array().unwrap();
        let (alike, bond) = (&numbers(&strongest[0])[0], &numbers(&strongest[0])[1]);
        assert!(*bond < -0.01, "{found}");
        // It is least far apart, and less than a thousandth there.
        assert!((0.0..-1e-3 * bond).contains(alike), "{found}");
        if is_proved {
            let found = json(&["crosstalk", path, "--certify", "--json"]);
            let [sampled, proved] = ["strongest_J", "lower_J"].map(|key| numbers(&found[key][0]));
            assert!(
                sampled.iter().zip(&proved).all(|(e, least)| least <= e),
                "{found}"
            );
            assert!(proved[1] > 1.2 * sampled[1], "{found}");
        }
    }
}

#[test]
fn outlines_match_longest_contact_first() {
    let found = json(&["match", "shapes/tab-20mm.toml", "--json"]);
    let matches = found.as_array().unwrap();
    let lengths: Vec<f64> = matches
        .iter()
        .map(|one| one["contact_m"].as_f64().unwrap())
        .collect();
    assert!(lengths.is_sorted_by(|a, b| *a >= b - 1e-6), "{lengths:?}");
    // The tab in its slot touches along more than a plain side.
    assert!(lengths[0] > 0.43, "{}", lengths[0]);
    for one in matches {
        assert_eq!(numbers(&one["pose"]).len(), 3);
        assert!(one["gap_m2"].as_f64().unwrap() >= 0.0);
    }
}

/// A design with upright blocks or discs, on faces of 10 cm.
fn standing(folder: &Path, magnet: &str) -> String {
    let text = format!(
        "name = \"standing\"\n[table]\nsize = [0.6, 0.6]\n[magnet]\n{magnet}\naxis = \"up\"\nremanence = 1.3\n\
         pitch = 0.02\n[fixed]\nside = 0.1\nthickness = 0.013\nmass = 0.1\n[fixed.faces]\n\
         all = {{ code = \"UUDU\" }}\n[moving]\nside = 0.1\nthickness = 0.013\nmass = 0.1\n\
         [moving.faces]\nwest = {{ mates = \"east\" }}\n[target]\nfixed = \"east\"\nmoving = \"west\"\n"
    );
    let path = folder.join("standing.toml");
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn words_of_magnets_that_stand_are_written_u_and_d_everywhere() {
    for magnet in [
        "size = [0.005, 0.01, 0.006]",
        "shape = \"disc\"\ndiameter = 0.01\nheight = 0.005",
    ] {
        let folder = tempfile::tempdir().unwrap();
        let design = standing(folder.path(), magnet);
        let out = folder.path().join("words");
        let out = out.to_str().unwrap();
        let length = ["--length", "4", "--gap", "0.4"];
        let asked = [&["words", design.as_str()][..], &length, &["--out", out]].concat();
        let told = stdout(&tilebind(&asked));
        assert!(told.contains("UU") || told.contains("UD"), "{told}");
        let set = format!("{out}/words.toml");
        for file in [
            &set,
            &format!("{out}/report.json"),
            &format!("{out}/words.csv"),
        ] {
            let text = std::fs::read_to_string(file).unwrap();
            assert!(
                !text.contains("NN") && !text.contains("NS"),
                "{file}\n{text}"
            );
            assert!(
                !text.contains("\"N\"") && text.contains('U'),
                "{file}\n{text}"
            );
        }
        let page = std::fs::read_to_string(format!("{out}/report.html")).unwrap();
        assert!(page.contains("\"stands\":{\"up\":"), "{magnet}");
        let found = json(&["crosstalk", &set, "--json"]);
        let letters = found["faces"].to_string();
        assert!(letters.contains('U') && !letters.contains('N'), "{letters}");
    }
}

#[test]
fn turned_over_magnets_that_stand_are_their_own_mates() {
    let folder = tempfile::tempdir().unwrap();
    let design = standing(folder.path(), "size = [0.005, 0.01, 0.006]");
    super::refused(
        &["words", &design, "--length", "4", "--gap", "0.4", "--flip"],
        &["its own mate"],
    );
}

#[test]
fn words_longer_than_the_face_are_remarked_on() {
    let length = ["--length", "14", "--gap", "0.99"];
    for design in [None, Some("shapes/paper-tile.toml")] {
        let words: Vec<&str> = ["words"].into_iter().chain(design).chain(length).collect();
        let told = stdout(&tilebind(&words)).replace('\n', " ");
        assert!(
            told.contains("! 14 positions 40.00 mm apart take 530.0 mm of face"),
            "{told}"
        );
        assert!(
            told.contains("430.0 mm: use --pitch 0.0323 or less"),
            "{told}"
        );
        let fits = [&words[..], &["--pitch", "0.0323"]].concat();
        let told = stdout(&tilebind(&fits));
        assert!(!told.contains("of face"), "{told}");
    }
}

/// A word that is its own mate binds its own kind: that is no wrong meeting, and the gap is the one that
/// `words --self` finds.
#[test]
fn words_that_bind_their_own_kind_are_no_wrong_meetings() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("own").display().to_string();
    let sought = json(&[
        "words", "--self", "--length", "6", "--gap", "0.3", "--out", &out, "--json",
    ]);
    let set = format!("{out}/words.toml");
    let found = json(&["crosstalk", &set, "--json"]);
    let [of_words, of_poses] = [&sought, &found].map(|it| it["gap"].as_f64().unwrap());
    assert!(of_words >= 0.3, "{of_words}");
    // Tilted and separated faces attract a little more than slid ones.
    assert!(
        of_poses <= of_words + 1e-6 && of_poses > of_words - 0.1,
        "{of_poses} {of_words}"
    );

    // Beside words that have other mates.
    let mixed = folder.path().join("mixed.toml");
    std::fs::write(&mixed, "words = [\"NSNS\", \"NNNS\"]\n").unwrap();
    let mixed = mixed.display().to_string();
    let out = folder.path().join("out").display().to_string();
    assert!(
        tilebind(&["crosstalk", &mixed, "--out", &out])
            .status
            .success()
    );
    let table = std::fs::read_to_string(format!("{out}/crosstalk.csv")).unwrap();
    let of = |faces: &str| {
        let rows = table.lines().filter(|row| row.starts_with(faces));
        rows.map(|row| row.rsplit(',').next().unwrap())
            .collect::<Vec<_>>()
    };
    assert_eq!(of("A,A,"), ["bond", "trap"], "{table}");
    assert_eq!(of("B,B,"), ["wrong"], "{table}");
    assert_eq!(of("B,B*,")[0], "bond", "{table}");
    assert_eq!(of("A,B*,"), ["wrong"], "{table}");
}
