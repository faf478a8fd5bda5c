//! The same bytes with every instruction set, and with every variant of the C library's functions.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use tilebind::potential::simd::Level;

use crate::folder::{assert_same, contents, untimed};
use crate::program::{command, stderr};

/// Ten designs, and the model that they are computed with.
const DESIGNS: [(&str, &str); 10] = [
    ("one-face", "dipole"),
    ("triangle-teeth-10mm", "dipole"),
    ("arc-20mm", "dipole"),
    ("drawn-wave", "dipole"),
    ("dovetail", "dipole"),
    ("halbach", "dipole"),
    ("sine-teeth-20mm", "cuboid"),
    ("tab-20mm", "cuboid"),
    ("shielded-backs", "dipole"),
    ("shielded-nearest-face", "dipole"),
];

/// The files of an analysis, without its timing.
fn analysed((design, model): (&str, &str), out: &Path, prepare: impl Fn(&mut Command)) -> Files {
    let design = format!("shapes/{design}.toml");
    let mut analyse = command(&[
        "analyse",
        &design,
        "--model",
        model,
        "--out",
        out.to_str().expect("UTF-8"),
        "--milestones",
        "40",
        "--far-starts",
        "3",
        "--kinds",
        "1",
        "--certify-cells",
        "150",
        "--complete-cells",
        "150",
        "--no-pictures",
        "--quiet",
    ]);
    prepare(&mut analyse);
    let output = analyse.output().expect("it starts");
    assert!(output.status.success(), "{}", stderr(&output));
    untimed(out)
}

type Files = BTreeMap<String, Vec<u8>>;

#[test]
fn every_level_writes_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for design in DESIGNS {
        let out = |word: &str| folder.path().join(format!("{}-{word}", design.0));
        let expected = analysed(design, &out("best"), |_| {});
        assert!(expected.keys().any(|name| name.starts_with("pathways/")));
        let best = Level::available().pop();
        let others = Level::available().into_iter();
        for level in others.filter(|level| Some(*level) != best) {
            let found = analysed(design, &out(level.word()), |command| {
                command.env("TILEBIND_KERNEL", level.word());
                // The C library's variants for the same instruction sets, where it is GNU's.
                command.env(
                    "GLIBC_TUNABLES",
                    "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F",
                );
            });
            assert_same(&found, &expected, &format!("{}: {level}", design.0));
        }
    }
}

/// Magnets that the shipped designs do not have, in contact, near and far.
#[test]
fn energies_of_discs_and_upright_magnets_are_the_same_with_every_level() {
    let folder = tempfile::tempdir().unwrap();
    let tile = std::fs::read_to_string("shapes/paper-tile.toml").unwrap();
    let tile = tile.replace("\"dipole\"", "\"cuboid\"");
    let size = "size = [0.010, 0.010, 0.003]";
    assert!(tile.contains(size));
    let disc = "shape = \"disc\"\ndiameter = 0.01\nheight = 0.004";
    let up = "axis = \"up\"";
    for (magnet, stands) in [
        (disc.to_owned(), false),
        (format!("{disc}\n{up}"), true),
        (format!("size = [0.006, 0.01, 0.004]\n{up}"), true),
    ] {
        let mut design = tile.replace(size, &magnet);
        if stands {
            design = design.replace("NNNS", "UUUD").replace("NSSS", "UDDD");
        }
        let file = folder.path().join("tile.toml");
        std::fs::write(&file, design).unwrap();
        let energies = |level: Level| {
            let mut energy = command(&["energy", file.to_str().expect("UTF-8")]);
            for pose in ["0.43,0,0", "0.44,-0.07,0.08", "0.5,0.3,-2.1", "0.9,-0.2,3"] {
                energy.args(["--pose", pose]);
            }
            let output = energy.env("TILEBIND_KERNEL", level.word()).output();
            let output = output.expect("it starts");
            assert!(output.status.success(), "{}", stderr(&output));
            output.stdout
        };
        let found: Vec<Vec<u8>> = Level::available().into_iter().map(energies).collect();
        assert!(found.iter().all(|it| *it == found[0]), "{magnet}");
    }
}

#[test]
fn a_level_that_is_not_there_is_told() {
    let energy = |word: &str| {
        let arguments = ["energy", "shapes/paper-tile.toml", "--pose", "0.5,0,0"];
        let mut command = command(&arguments);
        command.env("TILEBIND_KERNEL", word);
        command.output().expect("it starts")
    };
    for word in ["sse2", "", "AVX2"] {
        let output = energy(word);
        assert_eq!(output.status.code(), Some(2), "{word}");
        assert!(output.stdout.is_empty());
        let said = stderr(&output);
        assert!(
            said.contains("TILEBIND_KERNEL") && said.contains(Level::best().word()),
            "{said}"
        );
    }
    let there: Vec<_> = Level::available().into_iter().map(Level::word).collect();
    for word in ["avx512", "avx2", "portable"] {
        let expected = if there.contains(&word) { 0 } else { 2 };
        assert_eq!(energy(word).status.code(), Some(expected), "{word}");
    }
}

#[test]
fn a_table_is_the_same_with_every_level_and_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let mut ran: Option<Files> = None;
    // One thread is tried with one level.
    let best = Level::available().pop().map(|level| (level, "1"));
    let all = Level::available().into_iter().map(|level| (level, "2"));
    for (level, threads) in all.chain(best) {
        let out = folder.path().join(format!("{level}-{threads}"));
        let mut table = command(&[
            "table",
            "shapes/paper-tile.toml",
            "--count",
            "4,4",
            "--time",
            "3",
            "--runs",
            "2",
            "--shaking",
            "3e-3",
            "--drag",
            "0.5",
            "--model",
            "cuboid",
            "--frames",
            "0.5",
            "--quiet",
            "--threads",
            threads,
            "--out",
        ]);
        table.arg(&out).env("TILEBIND_KERNEL", level.word());
        let output = table.output().expect("it starts");
        assert!(output.status.success(), "{}", stderr(&output));
        let mut files = contents(&out);
        let text = files.remove("report.json").expect("a report");
        let mut report: Value = serde_json::from_slice(&text).expect("JSON");
        for varies in ["wall_s", "threads"] {
            report[varies] = Value::Null;
        }
        files.insert("report.json".to_owned(), report.to_string().into_bytes());
        // The command line on the page contains the folder's name.
        let page = files.remove("report.html").expect("a page");
        let page = String::from_utf8(page).expect("UTF-8");
        let told = |page: &str| {
            page.replace(&format!("{level}-{threads}"), "")
                .replace(&format!("--threads {threads}"), "")
        };
        files.insert("report.html".to_owned(), told(&page).into_bytes());
        match &ran {
            None => ran = Some(files),
            Some(first) => assert_same(&files, first, &format!("{level} on {threads}")),
        }
    }
}
