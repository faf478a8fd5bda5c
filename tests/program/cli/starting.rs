//! `tilebind init` and `tilebind schema`.

use std::fs;
use std::process::Command;

use super::{json, tilebind};
use crate::program::{stderr, stdout};

#[test]
fn the_starter_is_written_once_and_can_be_used() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let name = path.to_str().unwrap();
    let output = tilebind(&["init", name]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(output.stdout.is_empty());
    let written = fs::read_to_string(&path).unwrap();
    assert_eq!(written, stdout(&tilebind(&["init", "-"])));

    let energy = json(&["energy", name, "--pose", "0.43,0,0"]);
    assert_eq!(energy[0]["free"], true);
    assert!(energy[0]["energy_J"].as_f64().unwrap() < 0.0);

    fs::write(&path, "my own work").unwrap();
    let again = tilebind(&["init", name]);
    assert_eq!(again.status.code(), Some(2));
    assert!(stderr(&again).contains("help: give another name"));
    assert_eq!(fs::read_to_string(&path).unwrap(), "my own work");
}

/// A first design has a bond that starts reach, and no trap that is nearly as strong.
#[test]
fn the_starter_binds() {
    let folder = tempfile::tempdir().unwrap();
    let [file, out] = ["mine.toml", "out"].map(|name| folder.path().join(name));
    let [file, out] = [&file, &out].map(|path| path.to_str().unwrap());
    assert_eq!(tilebind(&["init", file]).status.code(), Some(0));
    let quick = [
        "--milestones",
        "1500",
        "--far-starts",
        "100",
        "--complete-seconds",
        "0",
        "--json",
    ];
    let report = json(&[&["analyse", file, "--out", out], &quick[..]].concat());
    let states = report["states"].as_array().unwrap();
    let energy = |k: usize| states[k]["energy_J"].as_f64().unwrap();
    assert_eq!(
        (&states[0]["kind"], &states[0]["copies"]),
        (&"bound".into(), &1.into())
    );
    assert!(states[0]["capture"]["share"].as_f64().unwrap() > 0.25);
    assert!((1..states.len()).all(|k| energy(k) > 0.1 * energy(0)));
}

#[test]
fn the_starter_is_called_design_toml() {
    let folder = tempfile::tempdir().unwrap();
    let status = Command::new(env!("CARGO_BIN_EXE_tilebind"))
        .arg("init")
        .current_dir(folder.path())
        .status()
        .unwrap();
    assert!(status.success());
    assert!(folder.path().join("design.toml").is_file());
}

#[test]
fn a_starter_that_cannot_be_written_is_a_failed_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("missing/design.toml");
    let output = tilebind(&["init", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("cannot write"));
}

#[test]
fn the_schema_is_json_of_its_draft() {
    let schema = json(&["schema"]);
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
}

/// The verdict of an independent validator on designs: `sound` and `faulty`, each a list of files.
/// Exits with 77 if it is not installed.
const VALIDATE: &str = r#"
import json, sys
try:
    import tomllib
    from jsonschema import Draft202012Validator
except ImportError as missing:
    print(missing)
    sys.exit(77)
schema, sound, faulty = json.loads(sys.stdin.read())
Draft202012Validator.check_schema(schema)
validator = Draft202012Validator(schema)
wrong = 0
for files, want in ((sound, True), (faulty, False)):
    for name in files:
        with open(name, "rb") as file:
            errors = list(validator.iter_errors(tomllib.load(file)))
        if (not errors) != want:
            wrong += 1
            print(name, "accepted" if not errors else [e.message for e in errors])
print(len(sound), "sound", len(faulty), "faulty")
sys.exit(1 if wrong else 0)
"#;

/// Designs with a fault that a schema can detect.
const FAULTY: [&str; 25] = [
    "code-and-magnets",
    "code-in-lower-case",
    "draft-in-degrees",
    "fit-in-millimetres",
    "grade-and-pull",
    "half-a-tooth",
    "magnet-in-millimetres",
    "magnet-with-a-wrong-pole",
    "magnet-without-pole",
    "mates-and-code",
    "negative-inset",
    "no-table",
    "no-target",
    "no-thickness",
    "number-as-string",
    "shield-in-percent",
    "shield-with-a-wrong-key",
    "two-numbers-for-three",
    "two-sides",
    "two-strengths",
    "unknown-face-key",
    "unknown-model",
    "unknown-profile-key",
    "unknown-shape",
    "vertices-and-side",
];

#[test]
fn an_independent_validator_takes_sound_designs_and_refuses_faulty_ones() {
    use std::io::Write;
    use std::process::Stdio;

    let root = env!("CARGO_MANIFEST_DIR");
    let mut sound = Vec::new();
    for folder in ["shapes", "tests/designs/good"] {
        for entry in fs::read_dir(format!("{root}/{folder}")).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "toml") {
                sound.push(path);
            }
        }
    }
    sound.push(format!("{root}/src/jobs/design/starter.toml").into());
    let faulty = FAULTY.map(|name| format!("{root}/tests/designs/bad/{name}.toml"));
    let input = serde_json::json!([json(&["schema"]), sound, faulty]);

    let python = Command::new("python3")
        .args(["-c", VALIDATE])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn();
    let Ok(mut python) = python else {
        eprintln!("skipped: no python3 to validate designs with");
        return;
    };
    // Without a validator the process ends before it reads.
    let _ = python
        .stdin
        .take()
        .unwrap()
        .write_all(input.to_string().as_bytes());
    let output = python.wait_with_output().unwrap();
    if output.status.code() == Some(77) {
        eprintln!("skipped: no validator: {}", stdout(&output));
        return;
    }
    assert!(output.status.success(), "{}", stdout(&output));
    println!("{}", stdout(&output));
}
