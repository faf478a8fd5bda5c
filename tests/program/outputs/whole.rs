//! A set of files is all new or all old.

use std::collections::BTreeMap;

use super::*;

/// Commands, and options that change their results.
const COMMANDS: [(&str, &str); 5] = [
    (MAKE, "--kerf 0.0001"),
    (COMPARE, "--by bond_depth"),
    (DOCK, "--seed 2"),
    (SWEEP, "--seed 2"),
    (ANALYSE, "--seed 2"),
];

/// The results of a command; the records of points are not part of a set.
fn results(out: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = contents(out);
    all.retain(|name, _| !name.starts_with("points/"));
    all
}

/// A command under a shell that first limits itself.
fn limited(folder: &Path, limit: &str, arguments: &[&str]) -> Output {
    let program = command(&[]);
    Command::new("sh")
        .args(["-c", &format!("{limit}; exec \"$0\" \"$@\"")])
        .arg(program.get_program())
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("a shell")
}

#[test]
fn where_files_may_not_grow_the_old_set_stays() {
    for (line, other) in COMMANDS {
        let desk = desk();
        let (here, out) = (desk.path(), desk.path().join("R"));
        done(here, &words(line));
        let old = results(&out);
        let record = fs::read(out.join(RECORD)).unwrap();
        let largest = old.values().map(Vec::len).max().unwrap();
        let line = format!("{line} {other}");
        for blocks in [0, largest * 3 / 4 / 512] {
            let limit = format!("ulimit -f {blocks}");
            let output = limited(here, &limit, &words(&line));
            let message = stderr(&output);
            assert_eq!(output.status.code(), Some(1), "{line} {blocks}: {message}");
            assert!(
                message.contains("cannot write"),
                "{line} {blocks}: {message}"
            );
            assert!(results(&out) == old, "{line} {blocks}");
            assert!(fs::read(out.join(RECORD)).unwrap() == record);
        }
        done(here, &words(&line));
        assert!(results(&out) != old, "{line}");
    }
}

/// A small file system, which only the superuser can mount.
struct Mounted<'a>(&'a Path);

impl<'a> Mounted<'a> {
    fn new(at: &'a Path, kilobytes: u64) -> Option<Self> {
        let size = format!("size={kilobytes}k");
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", &size, "tmpfs"]).arg(at);
        let mounted = mount.output().is_ok_and(|output| output.status.success());
        mounted.then_some(Self(at))
    }
}

impl Drop for Mounted<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(self.0).status();
    }
}

/// Fills the file system except for some bytes.
fn fill(file: &Path, room: u64) {
    use std::io::Write;
    let mut file = fs::File::create(file).unwrap();
    while file.write(&[b' '; 4096]).is_ok_and(|written| written > 0) {}
    let length = file.metadata().unwrap().len();
    file.set_len(length.saturating_sub(room)).unwrap();
}

#[test]
fn on_a_full_disk_the_old_set_stays() {
    for (line, other) in COMMANDS {
        let desk = desk();
        let (here, out) = (desk.path(), desk.path().join("R"));
        fs::create_dir(&out).unwrap();
        let Some(_mounted) = Mounted::new(&out, 20_000) else {
            eprintln!("skipped: no file system can be mounted");
            return;
        };
        done(here, &words(line));
        let old = results(&out);
        let size: usize = old.values().map(Vec::len).sum();
        let line = format!("{line} {other}");
        // Room for the last part of the new set is missing, or for nearly all.
        for room in [size * 3 / 4, 20_000] {
            fill(&out.join("fill"), room as u64);
            let output = run(here, &words(&line));
            let message = stderr(&output);
            assert_eq!(output.status.code(), Some(1), "{line} {room}: {message}");
            fs::remove_file(out.join("fill")).unwrap();
            assert!(results(&out) == old, "{line} {room}");
        }
        done(here, &words(&line));
        assert!(results(&out) != old, "{line}");
    }
}

/// Killed at any moment: the same command can replace the remaining files, whatever was in place by
/// then.
#[test]
fn after_a_kill_the_same_command_goes_on() {
    use std::time::Duration;

    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    let kerfs = ["0.0001", "0.0002", "0.0003"].map(|kerf| format!("{MAKE} --kerf {kerf}"));
    let sets = kerfs.clone().map(|line| {
        done(here, &words(&line));
        results(&out)
    });
    for moment in 0..60 {
        let line = &kerfs[moment % 3];
        let mut child = program(here, &words(line));
        let child = child.stdout(std::process::Stdio::null());
        let mut child = child.stderr(std::process::Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_micros(200 * moment as u64));
        let _ = child.kill();
        child.wait().unwrap();
        let mut found = results(&out);
        found.retain(|name, _| !name.contains(".partial/"));
        let is_part = |set: &BTreeMap<String, Vec<u8>>| {
            found
                .iter()
                .all(|(name, content)| set.get(name) == Some(content))
        };
        assert!(sets.iter().any(is_part), "old and new ones together");
    }
    done(here, &words(&kerfs[0]));
    assert!(results(&out) == sets[0]);
}

/// A process that was killed after any number of renamings: the next process that opens the folder
/// restores the old files, or completes the new ones.
#[test]
fn what_a_killed_process_left_is_settled() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    let place_of_new = out.join(".tilebind-4000000-0.partial");
    let path = |name: &str| match name.strip_prefix("P/") {
        Some(name) => place_of_new.join(name),
        None => out.join(name),
    };
    done(here, &words(MAKE));
    let old = results(&out);
    done(here, &words(&format!("{MAKE} --kerf 0.0001")));
    let new = results(&out);
    let record = |sets: &[&BTreeMap<String, Vec<u8>>]| {
        let entry = |name: &String| {
            let sums: Vec<String> = sets.iter().map(|set| sha256(&set[name])).collect();
            (
                name.clone(),
                serde_json::json!({"command": "make", "sha256": sums}),
            )
        };
        let files: serde_json::Map<_, _> = new.keys().map(entry).collect();
        serde_json::json!({"tilebind": "0.1.0", "files": files}).to_string()
    };
    let names: Vec<&String> = new.keys().collect();
    let taken = names
        .iter()
        .map(|name| (name.to_string(), format!("P/old/{name}")));
    let put = names
        .iter()
        .map(|name| (format!("P/new/{name}"), name.to_string()));
    let done_with = ("P/old".to_owned(), "P/gone".to_owned());
    let steps: Vec<_> = taken.chain([done_with]).chain(put).collect();
    for killed in 0..=steps.len() {
        fs::remove_dir_all(&out).unwrap();
        fs::create_dir_all(path("P/old")).unwrap();
        fs::create_dir(path("P/new")).unwrap();
        for name in &names {
            place(&out, &[(name, &old[*name])]);
            place(&path("P/new"), &[(name, &new[*name])]);
            fs::create_dir_all(path("P/old").join(name).parent().unwrap()).unwrap();
        }
        fs::write(out.join(RECORD), record(&[&new, &old])).unwrap();
        for (from, to) in &steps[..killed] {
            fs::rename(path(from), path(to)).unwrap();
        }
        // A refused command does this, too.
        let other = format!("{WORDS} --length 0");
        assert_ne!(run(here, &words(&other)).status.code(), Some(0));
        place(&out, &[("words.csv", "mine")]);
        assert_eq!(run(here, &words(WORDS)).status.code(), Some(2));
        fs::remove_file(out.join("words.csv")).unwrap();
        assert!(!place_of_new.exists());
        let expected = if killed <= names.len() { &old } else { &new };
        assert!(
            results(&out) == *expected,
            "{killed} of {} steps",
            steps.len()
        );
        done(here, &words(MAKE));
        assert!(results(&out) == old);
        assert_eq!(
            serde_json::from_slice::<serde_json::Value>(&fs::read(out.join(RECORD)).unwrap())
                .unwrap(),
            serde_json::from_str::<serde_json::Value>(&record(&[&old])).unwrap()
        );
    }
}

/// A file that is mounted can neither be renamed nor replaced: the last one of a set.
#[test]
fn where_a_renaming_fails_all_is_as_it_was() {
    let desk = desk();
    let (here, out) = (desk.path(), desk.path().join("R"));
    done(here, &words(MAKE));
    let mounted = out.join("sheet.md");
    let mut mount = Command::new("mount");
    mount.arg("--bind").arg(here.join("d.toml")).arg(&mounted);
    fs::copy(&mounted, here.join("d.toml")).unwrap();
    if !mount.output().is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: nothing can be mounted");
        return;
    }
    let _mounted = Mounted(&mounted);
    copy(here, &[(DESIGN, "e.toml")]);
    let (old, record) = (results(&out), fs::read(out.join(RECORD)).unwrap());
    let output = run(here, &words("make e.toml --kerf 0.0001 --out R"));
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot write R/sheet.md"), "{message}");
    assert!(results(&out) == old);
    assert!(fs::read(out.join(RECORD)).unwrap() == record);
}

/// On Unix a name is any bytes.
#[test]
fn names_that_are_no_text_are_names() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let desk = desk();
    let design = desk.path().join(OsStr::from_bytes(b"d\xff.toml"));
    fs::copy(desk.path().join("d.toml"), &design).unwrap();
    let name = OsStr::from_bytes(b"R\xff");
    for line in [
        "words --length 3 --gap 0.2 --quiet --out",
        "show d\u{fffd}.toml --force --out",
        "make d\u{fffd}.toml --force --out",
        "sweep d\u{fffd}.toml --vary fixed.mass=0.1,0.2 --milestones 100 --far-starts 1 \
         --certify-cells 0 --complete-cells 0 --quiet --force --out",
        "show d\u{fffd}.toml --out P\u{fffd}.svg",
    ] {
        let mut command = command(&[]);
        command.current_dir(desk.path());
        for word in words(line) {
            let word = word.replace('\u{fffd}', "\u{1}").into_bytes();
            let word: Vec<u8> = word
                .iter()
                .map(|b| if *b == 1 { 0xff } else { *b })
                .collect();
            command.arg(OsStr::from_bytes(&word));
        }
        if line.ends_with("--out") {
            command.arg(name);
        }
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
    }
    assert!(desk.path().join(name).join("report.json").exists());
    assert!(desk.path().join(OsStr::from_bytes(b"P\xff.svg")).exists());
    assert!(!desk.path().join("R\u{fffd}").exists());
}
