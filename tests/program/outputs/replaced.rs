//! Folders of results: a command replaces the files that it wrote and that have not changed since.

use serde_json::{Value, json};
use tilebind::output::Command;
use tilebind::report;

use super::*;

/// The commands that write folders, with one of their files each.
const COMMANDS: [(&str, &Command, &str); 10] = [
    (ANALYSE, &report::analysis::FILES, "pathways/0-free.csv"),
    (DOCK, &report::docking::FILES, "pictures/chances.svg"),
    (MAKE, &report::workshop::FILES, "sheet.md"),
    (COMPARE, &report::comparison::FILES, "pictures/ranking.svg"),
    (SWEEP, &report::sweep::FILES, "sweep.csv"),
    (YIELD, &report::yields::FILES, "pictures/course.svg"),
    (WORDS, &report::words::FILES, "words.toml"),
    (CROSSTALK, &report::crosstalk::FILES, "crosstalk.csv"),
    (MATCH, &report::matching::FILES, "matches.csv"),
    (ASSEMBLE, &report::assembly::FILES, "report.html"),
];

#[test]
fn a_command_replaces_its_own_files_and_no_others() {
    for (line, command, name) in COMMANDS {
        let desk = desk();
        let (here, out) = (desk.path(), desk.path().join("R"));
        let forced = format!("{line} --force");
        let path = format!("R/{name}");
        // A file of the user's is in the way.
        place(&out, &[(name, "mine")]);
        refused(
            here,
            &words(line),
            &[&path, "not recorded", "another folder", "--force"],
        );
        done(here, &words(&forced));
        assert_ne!(fs::read(out.join(name)).unwrap(), b"mine", "{line}");
        // Its own files it replaces, and there are no more of them than before.
        let before = contents(&out);
        done(here, &words(line));
        let after = contents(&out);
        assert!(before.keys().eq(after.keys()), "{line}");
        // An edited file is the user's.
        place(&out, &[(name, "edited")]);
        refused(here, &words(line), &[&path, "was changed since", "--force"]);
        done(here, &words(&forced));
        assert!(after.keys().eq(contents(&out).keys()), "{line}");
        // All that it writes is recorded, but for points of sweeps, and is known to be its own.
        let known = recorded(&out);
        let all = after.keys().filter(|name| !name.starts_with("points/"));
        assert!(all.eq(known.keys()), "{line}");
        for (name, entry) in known {
            assert!(command.writes(&name), "{line}: {name}");
            assert_eq!(entry["command"], line.split(' ').next().unwrap());
            assert_eq!(
                entry["sha256"],
                json!([sha256(&fs::read(out.join(&name)).unwrap())])
            );
        }
    }
}

/// Whatever a record states, nothing else is removed as an old result.
#[test]
fn names_of_results_are_known() {
    for (command, own, others) in [
        (
            &report::analysis::FILES,
            &[
                "states.csv",
                "pathways/12-free.csv",
                "pathways/0-3-by-work.csv",
                "pictures/map.svg",
                "pictures/map-a.csv",
                "topsearch/min.data",
            ][..],
            &[
                "states.csv2",
                "sweep.csv",
                "pathways/mine.csv",
                "pathways/1-mine.csv",
                "pathways/1-2-by-work.csv/../../thesis.csv",
                "../pathways/1-2.csv",
                "/pathways/1-2.csv",
                "pictures/maps.svg",
                "pictures/map.txt",
                "pictures/map-/../../a.svg",
                "topsearch/../min.data",
                "map.svg",
                "",
            ][..],
        ),
        (
            &report::assembly::FILES,
            &["designs/a-b.toml", "pictures/grown.svg"],
            &[
                "designs/a/b.toml",
                "designs/../thesis.toml",
                "designs/a.svg",
            ],
        ),
    ] {
        for name in own {
            assert!(command.writes(name), "{name}");
        }
        for name in others {
            assert!(!command.writes(name), "{name}");
        }
    }
}

fn recorded(out: &Path) -> serde_json::Map<String, Value> {
    let record: Value = serde_json::from_slice(&fs::read(out.join(RECORD)).unwrap()).unwrap();
    record["files"].as_object().unwrap().clone()
}

#[test]
fn old_results_go_unless_they_were_changed_and_what_else_is_there_stays() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    let mine = [
        ("notes.txt", "mine"),
        ("pathways/mine.csv", "mine"),
        ("pictures/holiday.png", "mine"),
        ("topsearch/mine.data", "mine"),
    ];
    place(&out, &mine);
    done(here, &words(ANALYSE));
    let edited = [
        ("topsearch/min.data", "edited"),
        ("pictures/map.png", "edited"),
    ];
    place(&out, &edited);
    let before = contents(&out);
    // None of the edited files is in the way of new ones.
    done(here, &words(&format!("{ANALYSE} --compact")));
    let after = contents(&out);
    let gone = |name: &str| before.contains_key(name) && !after.contains_key(name);
    assert!(gone("pictures/profiles.png") && gone("topsearch/ts.data") && gone("report.html"));
    check(&out, &mine);
    check(&out, &edited);
    refused(
        here,
        &words(ANALYSE),
        &["R/pictures/map.png", "was changed since"],
    );
    fs::remove_file(out.join("topsearch/min.data")).unwrap();
    fs::remove_file(out.join("pictures/map.png")).unwrap();
    done(here, &words(ANALYSE));
    done(here, &words(&format!("{ANALYSE} --compact")));
    assert!(out.join("topsearch/mine.data").exists());
    assert!(!out.join("topsearch/min.data").exists());
    check(&out, &mine);
}

/// Records and old reports can name any file with its checksum.
#[test]
fn forged_lists_get_nothing_of_the_users_away() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    done(here, &words(ANALYSE));
    let mine = [
        ("thesis.txt", "mine"),
        ("pathways/thesis.csv", "mine"),
        ("pictures/thesis.png", "mine"),
        ("points/thesis.json", "mine"),
    ];
    place(&out, &mine);
    place(
        here,
        &[("thesis.txt", "mine"), ("topsearch/min.data", "mine")],
    );
    let absolute = here.join("thesis.txt");
    let names = mine.map(|(name, _)| name);
    let more = [
        "../thesis.txt",
        "../topsearch/min.data",
        "arrays/../../topsearch/min.data",
        absolute.to_str().unwrap(),
    ];
    let mut record: Value = serde_json::from_slice(&fs::read(out.join(RECORD)).unwrap()).unwrap();
    let mut list = serde_json::Map::new();
    for name in names.iter().chain(&more) {
        let sum = sha256(b"mine");
        record["files"][name] = json!({"command": "analyse", "sha256": [sum]});
        list.insert((*name).to_owned(), sum.into());
    }
    fs::write(out.join(RECORD), record.to_string()).unwrap();
    done(here, &words(&format!("{ANALYSE} --compact")));
    check(&out, &mine);
    check(
        here,
        &[("thesis.txt", "mine"), ("topsearch/min.data", "mine")],
    );

    let report = json!({"tilebind": "0.1.0", "files": list}).to_string();
    for line in [ANALYSE, YIELD, RATES, WORDS, CROSSTALK, ASSEMBLE] {
        let desk = super::desk();
        let out = desk.path().join("R");
        place(&out, &mine);
        let sums: String = names
            .iter()
            .map(|name| format!("{}  {name}\n", sha256(b"mine")))
            .collect();
        place(
            &out,
            &[("report.json", &report), (".tilebind.sha256", &sums)],
        );
        refused(
            desk.path(),
            &words(line),
            &["R/report.json", "not recorded"],
        );
        if line != RATES {
            done(desk.path(), &words(&format!("{line} --force")));
        }
        check(&out, &mine);
    }
}

#[test]
fn a_folder_of_another_command_is_refused_or_its_files_stay_beside() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    done(here, &words(ANALYSE));
    let analysed = contents(&out);
    for line in [MAKE, YIELD, RATES, WORDS, CROSSTALK, ASSEMBLE] {
        refused(
            here,
            &words(line),
            &[
                "R/report",
                "is a result of `tilebind analyse`",
                "another folder",
            ],
        );
    }
    for line in [DOCK, COMPARE, SWEEP] {
        refused(
            here,
            &words(line),
            &["R/report.html", "is a result of `tilebind analyse`"],
        );
    }
    let unchanged = || {
        let now = contents(&out);
        analysed
            .iter()
            .all(|(name, content)| now.get(name) == Some(content))
    };
    // No two of their files have one name.
    done(here, &words("show d.toml -o R/look.svg"));
    done(here, &words("show d.toml -o R/look.svg --model cuboid"));
    assert!(unchanged());
    done(here, &words(ANALYSE));
    assert!(out.join("look.svg").exists());
    let analysed = contents(&out);
    done(here, &words(&format!("{YIELD} --force")));
    let now = contents(&out);
    let replaced = |name: &String| now.get(name) != analysed.get(name);
    let replaced: Vec<&String> = analysed.keys().filter(|name| replaced(name)).collect();
    assert_eq!(replaced, ["report.html", "report.json"]);
    refused(here, &words(ANALYSE), &["is a result of `tilebind yield`"]);
}

/// Files in the way are reported before the computation, which would take minutes.
#[test]
fn what_is_in_the_way_is_refused_before_the_computation() {
    let desk = desk();
    let here = desk.path();
    let much = "--milestones 3000000";
    let barrier = "barrier d.toml --from 0.43,0,0 --to free --milestones 3000000";
    let lines = [
        (format!("{ANALYSE} {much}"), "R/pathways/7-free-by-work.csv"),
        (format!("{ANALYSE} {much}"), "R/topsearch/ts.data"),
        (format!("{COMPARE} {much}"), "R/compare.md"),
        (format!("{SWEEP} {much}"), "R/designs/a.toml"),
        (format!("{DOCK} --runs 1000000"), "R/map.csv"),
        (RATES.to_owned(), "R/pictures/committor.svg"),
        (format!("{YIELD} --runs 10000000"), "R/course.csv"),
        (
            format!("{WORDS} --length 20 --seconds 10000"),
            "R/words.csv",
        ),
        (format!("{CROSSTALK} --certify"), "R/crosstalk.csv"),
        (format!("{barrier} --pathway way.csv"), "way.csv"),
    ];
    for (line, name) in &lines {
        // If an option is given twice, the last one counts.
        let mut words = words(line);
        let last = |option: &str| words.iter().rposition(|word| *word == option);
        for option in ["--milestones", "--runs", "--length"] {
            let first = words.iter().position(|word| *word == option);
            if let Some(first) = first.filter(|first| last(option) != Some(*first)) {
                words.drain(first..first + 2);
                break;
            }
        }
        place(here, &[(name, "mine")]);
        refused(here, &words, &[name]);
        fs::remove_file(here.join(name)).unwrap();
        fs::remove_dir_all(here.join("R")).unwrap_or_default();
    }
}

/// The computation asked for would take minutes.
#[test]
fn folders_that_cannot_be_written_are_refused_before_the_computation() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let taken = here.join("taken");
    let half = here.join("half");
    place(here, &[("taken", "mine"), ("half/pictures", "mine")]);
    let long = here.join("new").join("n".repeat(300));
    let before = contents(here);
    let refused = |arguments: &[&str], out: &Path, status| {
        let output = run(root, &[arguments, &[out.to_str().unwrap()]].concat());
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
        let output = run(root, &[&analyse[..], &[link.to_str().unwrap()]].concat());
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    }
}

#[test]
fn a_record_that_is_none_is_not_replaced() {
    for mine in ["mine", "{}", "[]", "{\"tilebind\": 1, \"files\": {}}", ""] {
        let desk = desk();
        let out = desk.path().join("R");
        place(&out, &[(RECORD, mine)]);
        refused(desk.path(), &words(MAKE), &[RECORD, "not recorded"]);
        done(desk.path(), &words(&format!("{MAKE} --force")));
        done(desk.path(), &words(MAKE));
    }
}

#[test]
fn the_folder_one_is_in_and_folders_behind_links_are_folders_too() {
    let desk = desk();
    let here = desk.path();
    done(here, &["make", "d.toml", "--out", "."]);
    done(here, &["make", "d.toml", "--out", "./"]);
    done(here, &["make", "d.toml", "--out", here.to_str().unwrap()]);
    #[cfg(unix)]
    {
        fs::create_dir(here.join("far")).unwrap();
        std::os::unix::fs::symlink("far", here.join("near")).unwrap();
        done(here, &["make", "d.toml", "--out", "near"]);
        done(here, &["make", "d.toml", "--out", "far"]);
        assert!(here.join("near").is_symlink() && here.join("far/sheet.md").exists());
    }
}

/// Links of a results folder to another file system are seen before work that would take minutes, and
/// what they lead to stays as it was.
#[test]
#[cfg(unix)]
fn links_to_another_device_are_seen_before_the_work() {
    use std::os::unix::fs::{MetadataExt, symlink};
    let desk = desk();
    let Ok(away) = tempfile::tempdir_in("/dev/shm") else {
        return;
    };
    let device = |path: &Path| fs::metadata(path).expect("a folder").dev();
    if device(away.path()) == device(desk.path()) {
        return;
    }
    let user = away.path().join("user.txt");
    fs::write(&user, "mine").expect("a file");
    let is_untouched = || {
        fs::read(&user).expect("a file") == b"mine"
            && fs::read_dir(away.path()).expect("a folder").count() == 1
    };
    for (name, to, options) in [
        ("pictures", away.path(), "--force"),
        ("pathways", away.path(), "--force"),
        (".tilebind.json", &*user, "--force"),
        ("report.json", &*user, ""),
        ("report.html", &*user, ""),
    ] {
        let out = format!("R-{}", name.trim_start_matches('.'));
        fs::create_dir(desk.path().join(&out)).expect("a folder");
        symlink(to, desk.path().join(&out).join(name)).expect("a link");
        let line = format!("analyse d.toml --milestones 3000000 --out {out} {options}");
        let since = std::time::Instant::now();
        refused(desk.path(), &words(&line), &[name]);
        assert!(since.elapsed().as_secs() < 20, "{name}");
        assert!(is_untouched(), "{name}");
    }
    // With --force a link in the place of a file gives way itself, and is not followed.
    done(
        desk.path(),
        &words("dock d.toml --runs 2 --out R-report.json --force"),
    );
    let report = desk.path().join("R-report.json/report.json");
    assert!(report.symlink_metadata().expect("a report").is_file() && is_untouched());
}
