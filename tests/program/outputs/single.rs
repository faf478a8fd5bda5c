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
