//! Finished points that are damaged or of another version are computed again and never merged.

use std::fs;
use std::path::{Path, PathBuf};

use tilebind::sweep::{Plan, Store, SweepPoint};

use super::{DEPTH, DESIGN, QUICK, assert_same, done, run, text};
use crate::program::stderr;

/// A sweep of a possible and an impossible design.
fn sweep(out: &Path) {
    let depth = format!("{DEPTH}=0.01,0.4");
    let what = [DESIGN, "--vary", &depth, "--threads", "2"];
    done(&[&what[..], &QUICK, &["--out", text(out)]].concat());
}

fn points(out: &Path) -> Vec<(SweepPoint, PathBuf)> {
    let plan = fs::read_to_string(out.join("plan.json")).unwrap();
    let points = Plan::parse(&plan).unwrap().points().into_iter();
    points
        .map(|point| {
            let file = out.join("points").join(format!("{}.json", point.name));
            (point, file)
        })
        .collect()
}

#[test]
fn no_flipped_bit_changes_what_is_read_of_a_point() {
    let folder = tempfile::tempdir().unwrap();
    sweep(folder.path());
    let store = Store::new(folder.path());
    for (point, file) in points(folder.path()) {
        let sound = fs::read(&file).unwrap();
        let outcome = store.load(&point).expect("a finished point");
        let mut refused = 0;
        for at in 0..sound.len() {
            let mut damaged = sound.clone();
            damaged[at] ^= 1 << (at % 8);
            fs::write(&file, &damaged).unwrap();
            match store.load(&point) {
                None => refused += 1,
                // Of what lies between the values.
                Some(found) => assert_eq!(found, outcome, "bit {} of byte {at}", at % 8),
            }
        }
        assert!(2 * refused > sound.len(), "{refused} of {}", sound.len());
        fs::write(&file, &sound).unwrap();
    }
}

#[test]
fn damaged_points_and_those_of_another_version_are_worked_on_again() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, broken] = ["whole", "broken"].map(|name| folder.path().join(name));
    sweep(&whole);
    sweep(&broken);
    let version = format!("\"tilebind\": \"{}\"", env!("CARGO_PKG_VERSION"));
    let damage: [(&str, &str); 2] = [
        (&version, "\"tilebind\": \"0.0.9\""),
        ("\"status\": \"", "\"status\": \"im"),
    ];
    let (_, file) = &points(&broken)[0];
    for (sound, damaged) in damage {
        let record = fs::read_to_string(file).unwrap();
        assert!(record.contains(sound), "{record}");
        fs::write(file, record.replacen(sound, damaged, 1)).unwrap();
        let status = done(&["--status", text(&broken)]);
        assert_eq!(status, "2 points: 1 impossible, 1 missing\n");
        let merged = run(&["--merge", text(&broken)]);
        assert_eq!(merged.status.code(), Some(1), "{}", stderr(&merged));
        done(&["--run", text(&broken)]);
        done(&["--merge", text(&broken)]);
        assert_same(&whole, &broken);
    }
}
