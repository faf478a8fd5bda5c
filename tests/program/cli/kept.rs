//! The folder of results: what tilebind did not write stays, and a folder that cannot be written is
//! refused before the computation.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::tilebind;
use crate::folder::contents;
use crate::program::stderr;

const DESIGN: &str = "shapes/one-face.toml";
const SHORT: [&str; 5] = [
    "--milestones",
    "200",
    "--far-starts",
    "10",
    "--complete-cells=0",
];

fn analyse(out: &Path, more: &[&str]) -> Output {
    let quick = "--milestones 200 --far-starts 5 --certify-seconds 0 --complete-seconds 0 --quiet";
    let mut arguments = vec!["analyse", DESIGN, "--out", out.to_str().unwrap()];
    arguments.extend(quick.split(' '));
    arguments.extend(more);
    tilebind(&arguments)
}

fn done(out: &Path, more: &[&str]) -> Output {
    let output = analyse(out, more);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    output
}

fn sha256(content: &[u8]) -> String {
    let digest = Sha256::digest(content);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Writes files, by their names, into a folder.
fn place(folder: &Path, files: &[(&str, &str)]) {
    for (name, content) in files {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
}

fn check(folder: &Path, files: &[(&str, &str)]) {
    for (name, content) in files {
        let found = fs::read_to_string(folder.join(name));
        assert_eq!(found.ok().as_deref(), Some(*content), "{name}");
    }
}

#[test]
fn the_report_lists_all_files_with_their_checksums() {
    let folder = tempfile::tempdir().unwrap();
    done(folder.path(), &["--arrays"]);
    let mut files = contents(folder.path());
    let report: Value = serde_json::from_slice(&files.remove("report.json").unwrap()).unwrap();
    let sums = files.iter().map(|(name, content)| (name, sha256(content)));
    assert_eq!(report["files"], json!(sums.collect::<BTreeMap<_, _>>()));
}

#[test]
fn only_what_an_earlier_analysis_wrote_is_replaced_or_taken_away() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mine = [
        ("notes.txt", "mine"),
        ("pathways/999-0.csv", "mine"),
        ("pictures/holiday.png", "mine"),
        ("topsearch/min.data", "mine"),
    ];
    place(&out, &mine[..3]);
    place(&out, &[("states.csv", "in the way")]);
    let first = done(&out, &["--arrays"]);
    assert!(stderr(&first).contains("states.csv.kept-1"), "{first:?}");
    check(&out, &mine[..3]);
    check(&out, &[("states.csv.kept-1", "in the way")]);

    // Files that were changed are no longer tilebind's.
    place(&out, &mine[3..]);
    let edited = [
        ("report.html", "edited"),
        ("arrays/around_x_m.npy", "edited"),
    ];
    place(&out, &edited);
    let before = contents(&out);
    let again = done(&out, &["--compact"]);
    assert!(stderr(&again).is_empty(), "{again:?}");
    check(&out, &mine);
    check(&out, &edited);
    let after = contents(&out);
    let gone = |name: &str| before.contains_key(name) && !after.contains_key(name);
    assert!(gone("pictures/map.png") && gone("arrays/states.npy"));
    assert!(!after.keys().any(|name| name.contains("partial")));

    // Edited and in the way: kept under another name. Emptied folders go.
    fs::remove_file(out.join(edited[1].0)).unwrap();
    done(&out, &["--arrays"]);
    check(&out, &[("report.html.kept-1", "edited")]);
    done(&out, &["--compact"]);
    assert!(!out.join("arrays").exists());
}

/// Of commands that write no report, whose files `.tilebind.sha256` lists.
#[test]
fn what_is_in_the_way_of_tables_and_pictures_goes_under_another_name_once() {
    let dock = ["dock", DESIGN, "--runs", "2", "--duration", "1"];
    let sweep = [
        "sweep",
        DESIGN,
        "--vary",
        "fixed.mass=0.1",
        "--certify-cells=0",
    ];
    let sweep = [&sweep, &SHORT[..]].concat();
    let cases = [
        (&dock[..], ["report.html", "pictures/chances.svg"]),
        (&["make", DESIGN], ["sheet.md", "fixed.svg"]),
        (&sweep, ["report.html", "sweep.csv"]),
    ];
    for (command, names) in cases {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let run = || {
            let output = tilebind(&[command, &["--out", out.to_str().unwrap()]].concat());
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            stderr(&output)
        };
        place(&out, &names.map(|name| (name, "mine")));
        let told = run();
        for name in names {
            let kept = format!("{name}.kept-1");
            assert!(told.contains(&kept), "{command:?}: {told}");
            check(&out, &[(&kept, "mine")]);
            assert_ne!(fs::read(out.join(name)).unwrap(), b"mine");
        }
        // The command's own files are replaced; an edited one is the user's.
        run();
        place(&out, &[(names[0], "edited")]);
        run();
        check(&out, &[(&format!("{}.kept-2", names[0]), "edited")]);
        let kept = |name: &&String| name.contains(".kept-");
        assert_eq!(contents(&out).keys().filter(kept).count(), 3);
    }
}

/// A list can name anything; only what lies in the folder counts.
#[test]
fn lists_that_lead_out_of_the_folder_are_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let precious = folder.path().join("precious.txt");
    fs::write(&precious, "mine").unwrap();
    let sum = sha256(b"mine");
    let list = json!({"../precious.txt": sum, precious.to_str().unwrap(): sum});
    let report = json!({"tilebind": "0.1.0", "files": list}).to_string();
    place(&out, &[("report.json", &report)]);
    done(&out, &[]);
    assert_eq!(fs::read_to_string(precious).unwrap(), "mine");
}

#[test]
fn the_folder_of_another_program_is_refused_as_it_is() {
    for report in ["{\"name\": \"another\"}", "not JSON", ""] {
        let folder = tempfile::tempdir().unwrap();
        let theirs = [("report.json", report), ("pictures/map.svg", "theirs")];
        place(folder.path(), &theirs);
        let before = contents(folder.path());
        let output = analyse(folder.path(), &[]);
        assert_eq!(output.status.code(), Some(2));
        let message = stderr(&output);
        assert!(message.contains("not a report of tilebind") && message.contains("help:"));
        assert_eq!(before, contents(folder.path()));
    }
}

/// The computation asked for would take minutes.
#[test]
fn folders_that_cannot_be_written_are_refused_before_the_computation() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let taken = here.join("taken");
    let half = here.join("half");
    place(here, &[("taken", "mine"), ("half/pictures", "mine")]);
    let long = here.join("new").join("n".repeat(300));
    let before = contents(here);
    let refused = |arguments: &[&str], out: &Path, status| {
        let output = tilebind(&[arguments, &[out.to_str().unwrap()]].concat());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(status), "{arguments:?} {out:?}");
        assert!(message.contains("cannot write to the folder"), "{message}");
        assert_eq!(before, contents(here));
        assert!(!here.join("new").exists());
    };
    let endless = ["--milestones", "3000000"];
    let analyse = [&["analyse", DESIGN], &endless[..], &["--out"]].concat();
    let compare = [&["compare", DESIGN], &endless[..], &["--out"]].concat();
    let sweep = ["sweep", DESIGN, "--vary", "fixed.mass=0.1,0.2"];
    let sweep = [&sweep, &endless[..], &["--out"]].concat();
    let dock = ["dock", DESIGN, "--runs", "1000000", "--out"];
    for command in [&analyse[..], &compare, &sweep, &dock] {
        refused(command, &taken, 2);
        refused(command, &taken.join("below"), 2);
        refused(command, &long, 1);
        // Not even the superuser makes files there.
        #[cfg(target_os = "linux")]
        refused(command, Path::new("/proc/results"), 1);
    }
    refused(&analyse, &half, 2);
    refused(&sweep, &half, 2);
    let barrier = ["barrier", DESIGN, "--from", "0.43,0,0", "--to", "free"];
    let barrier = [&barrier, &endless[..], &["--pathway"]].concat();
    refused(&barrier, &taken.join("way.csv"), 2);
    refused(&barrier, &long.join("way.csv"), 1);
    #[cfg(unix)]
    {
        let link = here.join("link");
        std::os::unix::fs::symlink("nowhere", &link).unwrap();
        let output = tilebind(&[&analyse[..], &[link.to_str().unwrap()]].concat());
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    }
}
