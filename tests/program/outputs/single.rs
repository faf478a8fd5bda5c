//! Single files: pathways, pictures, manifests, designs to start from.

use super::*;

/// The commands that write a file, each without its name.
const COMMANDS: [(&str, &str); 3] = [
    ("show d.toml --out", "mine.svg"),
    (
        "barrier d.toml --from 0.43,0,0 --to free --milestones 200 --certify-seconds 0 --quiet \
         --pathway",
        "mine.csv",
    ),
    ("sweep d.toml --vary fixed.mass=0.1,0.2 --plan", "mine.json"),
];

#[test]
fn a_file_is_replaced_by_the_command_that_wrote_it() {
    for (line, name) in COMMANDS {
        let desk = desk();
        let here = desk.path();
        let line = [words(line), vec![name]].concat();
        let forced = [&line[..], &["--force"]].concat();
        place(here, &[(name, "mine")]);
        refused(
            here,
            &line,
            &[name, "not recorded", "another name", "--force"],
        );
        done(here, &forced);
        done(here, &line);
        place(here, &[(name, "edited")]);
        refused(here, &line, &[name, "was changed since"]);
        done(here, &forced);
        assert_ne!(fs::read(here.join(name)).unwrap(), b"edited");
        // One of another command's.
        let other = ["make", "d.toml", "--out", "R"];
        done(here, &other);
        let theirs = [&line[..line.len() - 1], &["R/sheet.md"]].concat();
        if !line.contains(&"show") {
            refused(
                here,
                &theirs,
                &["R/sheet.md", "is a result of `tilebind make`"],
            );
        }
        // Other files of the command's stay.
        let second = format!("second-{name}");
        done(here, &[&line[..line.len() - 1], &[&second]].concat());
        done(here, &line);
        assert!(here.join(second).exists());
    }
}

#[test]
fn a_design_to_start_from_is_the_users_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    done(here, &["init", "a.toml"]);
    assert!(!here.join(RECORD).exists());
    refused(
        here,
        &["init", "a.toml", "--sides", "6"],
        &["a.toml already exists", "another name", "--force"],
    );
    done(here, &["init", "a.toml", "--sides", "6", "--force"]);
    assert!(
        fs::read_to_string(here.join("a.toml"))
            .unwrap()
            .contains("sides = 6")
    );
    refused(here, &["init", "."], &["is a folder"]);
}

#[test]
fn names_may_be_unusual() {
    let desk = desk();
    let here = desk.path();
    for name in [
        "-.svg",
        "a b\n\u{e9}.svg",
        ".hidden.svg",
        "..svg",
        "new/folder/a.svg",
    ] {
        let argument = format!("--out={name}");
        done(here, &["show", "d.toml", &argument]);
        done(here, &["show", "d.toml", &argument]);
        fs::write(here.join(name), "edited").unwrap();
        let output = run(here, &["show", "d.toml", &argument]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert_eq!(fs::read(here.join(name)).unwrap(), b"edited");
    }
    let barrier = words("barrier d.toml --from 0.43,0,0 --to free --milestones 200 --pathway");
    for (name, said) in [(".", "folder"), ("R/..", "folder"), (RECORD, "records")] {
        fs::create_dir_all(here.join("R")).unwrap();
        refused(here, &[&barrier[..], &[name, "--force"]].concat(), &[said]);
    }
}

#[cfg(unix)]
#[test]
fn names_need_not_be_text() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    let desk = desk();
    let show = |name: &[u8]| {
        let mut show = program(desk.path(), &["show", "d.toml", "--out"]);
        show.arg(OsStr::from_bytes(name))
            .output()
            .unwrap()
            .status
            .code()
    };
    let content = |name: &[u8]| fs::read(desk.path().join(OsStr::from_bytes(name))).unwrap();
    let mut barrier = program(
        desk.path(),
        &words(
            "barrier d.toml --from 0.43,0,0 --to free --milestones 200 --certify-seconds 0 --pathway",
        ),
    );
    let barrier = barrier
        .arg(OsStr::from_bytes(b"a\xff.csv"))
        .output()
        .unwrap();
    assert_eq!(barrier.status.code(), Some(0), "{}", stderr(&barrier));
    assert!(content(b"a\xff.csv").starts_with(b"s,x,y,theta"));
    // `show` wants an ending that it knows.
    assert_eq!(show(b"b.\xff"), Some(2));
    assert_eq!(show(b"b\xff.svg"), Some(0));
    assert!(content(b"b\xff.svg").starts_with(b"<svg"));
}

/// Only regular files are replaced. A link is, if it must be; what it leads to is not touched.
#[cfg(unix)]
#[test]
fn folders_links_and_pipes_are_not_replaced() {
    use std::os::unix::fs::symlink;

    let desk = desk();
    let here = desk.path();
    let make = words("make d.toml --out R");
    let forced = words("make d.toml --out R --force");
    place(here, &[("precious.md", "mine"), ("R/sheet.md/a", "mine")]);
    refused(here, &make, &["R/sheet.md is not a regular file"]);
    refused(here, &forced, &["R/sheet.md is not a regular file"]);
    fs::remove_dir_all(here.join("R/sheet.md")).unwrap();
    for target in ["../precious.md", "nowhere"] {
        symlink(target, here.join("R/sheet.md")).unwrap();
        let output = run(here, &make);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(here.join("R/sheet.md").is_symlink());
        done(here, &forced);
        assert!(!here.join("R/sheet.md").is_symlink());
        fs::remove_file(here.join("R/sheet.md")).unwrap();
    }
    // Not even one that leads to what it replaced.
    fs::rename(here.join("R/fixed.svg"), here.join("moved.svg")).unwrap();
    symlink("../moved.svg", here.join("R/fixed.svg")).unwrap();
    refused(here, &make, &["R/fixed.svg"]);
    check(here, &[("precious.md", "mine")]);
    let pipe = here.join("pipe.svg");
    let made = Command::new("mkfifo").arg(&pipe).status();
    if made.is_ok_and(|made| made.success()) {
        let output = run(here, &["show", "d.toml", "--out", "pipe.svg", "--force"]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    }
}

/// No link to another folder is followed, with or without `--force`, and no leftover that is one.
#[cfg(unix)]
#[test]
fn nothing_beyond_the_folder_is_touched() {
    use std::os::unix::fs::symlink;

    let mine = [
        ("U/user.txt", "mine"),
        ("U/sheet.md", "mine"),
        ("U/pictures/glance.svg", "mine"),
        ("U/0", "tilebind"),
    ];
    for inner in ["old", "new", "gone", ""] {
        let desk = desk();
        let here = desk.path();
        place(here, &mine);
        done(here, &words(MAKE));
        let left = here.join("R/.tilebind-1-0.partial");
        let link = match inner {
            "" => left.clone(),
            inner => left.join(inner),
        };
        fs::create_dir_all(link.parent().unwrap()).unwrap();
        symlink(here.join("U"), &link).unwrap();
        if inner == "new" {
            fs::create_dir(left.join("gone")).unwrap();
        }
        for line in [MAKE.to_owned(), format!("{MAKE} --force")] {
            let output = run(here, &words(&line));
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            check(here, &mine);
            assert!(link.is_symlink(), "{inner}");
            assert!(!here.join("R/user.txt").exists(), "{inner}");
        }
    }
    for line in [DOCK, COMPARE] {
        let desk = desk();
        let here = desk.path();
        place(here, &mine);
        fs::create_dir(here.join("R")).unwrap();
        symlink(here.join("U"), here.join("R/pictures")).unwrap();
        refused(here, &words(line), &["R/pictures is a link"]);
        refused(here, &words(&format!("{line} --force")), &["R/pictures"]);
        check(here, &mine);
    }
    let desk = desk();
    let here = desk.path();
    place(here, &mine);
    fs::create_dir(here.join("R")).unwrap();
    symlink(here.join("U"), here.join("R/points")).unwrap();
    refused(here, &words(SWEEP), &["R/points is a link"]);
}

/// What `--force` was moving aside when it was killed comes back, and is not taken for a result.
#[test]
fn what_force_moved_aside_is_restored() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    done(here, &words(MAKE));
    let mut record: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join(RECORD)).unwrap()).unwrap();
    record["aside"] = serde_json::json!({"sheet.md": sha256(b"mine")});
    let record = record.to_string();
    fs::remove_file(out.join("sheet.md")).unwrap();
    let old = ".tilebind-1-0.partial/old/sheet.md";
    place(&out, &[(RECORD, record.as_str()), (old, "mine")]);
    let said = ["R/sheet.md", "was changed since"];
    let output = run(here, &words(MAKE));
    assert_eq!(output.status.code(), Some(2));
    assert!(said.iter().all(|said| stderr(&output).contains(said)));
    check(&out, &[("sheet.md", "mine")]);
    refused(here, &words(MAKE), &said);
    done(here, &words(&format!("{MAKE} --force")));
    assert!(
        !fs::read_to_string(out.join(RECORD))
            .unwrap()
            .contains("aside")
    );
}

/// A record that is no file is neither read nor replaced.
#[cfg(unix)]
#[test]
fn a_record_that_is_no_file_is_refused() {
    let desk = desk();
    let (here, record) = (desk.path(), desk.path().join("R").join(RECORD));
    place(here, &[("mine.json", "{}")]);
    fs::create_dir(here.join("R")).unwrap();
    std::os::unix::fs::symlink("../mine.json", &record).unwrap();
    let forced = format!("{MAKE} --force");
    refused(here, &words(&forced), &[RECORD, "not a regular file"]);
    fs::remove_file(&record).unwrap();
    let made = Command::new("mkfifo").arg(&record).status();
    if made.is_ok_and(|made| made.success()) {
        // Reading the pipe would wait forever.
        for line in [MAKE, &forced] {
            let output = Command::new("timeout")
                .arg("20")
                .arg(command(&[]).get_program())
                .args(words(line))
                .current_dir(here)
                .output()
                .unwrap();
            assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        }
    }
}
