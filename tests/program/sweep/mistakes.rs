//! Mistakes on the command line: found before anything is written.

use super::{DEPTH, DESIGN, done, run, text};
use crate::program::stderr;

#[test]
fn wrong_axes_designs_and_parts_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new");
    let wrong: [(&[&str], &str); 14] = [
        (
            &[
                DESIGN,
                "--vary",
                "fixed.faces.east.profile.deepth=0.01,0.02",
            ],
            "did you mean `depth`",
        ),
        (&[DESIGN, "--vary", "fixed.side.depth=1"], "does not exist"),
        (&[DESIGN, "--vary", "magnet.size.3=0.01"], "array of 3"),
        (&[DESIGN, "--vary", "magnet.pitch"], "KEY="),
        (&[DESIGN, "--vary", "magnet.pitch=0:1:0"], "whole number"),
        (
            &[DESIGN, "--vary", "magnet.pitch=0.02:0.04"],
            "magnet.pitch=0.02:0.04:11",
        ),
        (
            &[DESIGN, "--vary", "magnet.pitch=0.001,0.002"],
            "none of the 2 points is possible; the first: magnet.pitch = 0.001: ",
        ),
        (
            &[
                DESIGN,
                "--vary",
                "magnet.pitch=1",
                "--vary",
                "magnet.pitch=2",
            ],
            "twice",
        ),
        (
            &[
                DESIGN,
                "--vary",
                "magnet.pitch=0:1:2000",
                "--vary",
                "mass=0:1:2000",
            ],
            "more than",
        ),
        (
            &[DESIGN, "--vary", "depth=0:0.01:3"],
            "such as `fixed.faces.east.profile.depth`",
        ),
        (
            &[
                DESIGN,
                "--vary",
                "magnet.pitch=0.03,0.04",
                "--baseline",
                "pitch=5",
            ],
            "such as `pitch=0.03`",
        ),
        (
            &[DESIGN, "--vary", "magnet.pitch=0.03,0.04", "--refine", "2"],
            "three values or more",
        ),
        (&["tests/designs/bad/no-size.toml"], "no-size.toml"),
        (&["--vary", "magnet.pitch=1"], "DESIGNS"),
    ];
    for (arguments, said) in wrong {
        let output = run(&[arguments, &["--out", text(&out)]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
        assert!(!out.exists(), "{arguments:?}");
    }
}

#[test]
fn manifests_and_parts_are_checked() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("plan.json");
    let plan = text(&file);
    let depth = format!("{DEPTH}=0.01,0.02");
    done(&[DESIGN, "--vary", &depth, "--plan", plan]);
    for part in ["0/4", "5/4", "1", "a/b", "1/0"] {
        let output = run(&["--run", plan, "--shard", part]);
        assert_eq!(output.status.code(), Some(2), "{part}");
    }
    let older = std::fs::read_to_string(&file)
        .unwrap()
        .replace(env!("CARGO_PKG_VERSION"), "0.0.1");
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    let with = |pointer: &str, value: serde_json::Value| {
        let mut changed = manifest.clone();
        *changed.pointer_mut(pointer).unwrap() = value;
        changed.to_string()
    };
    let axis = |k: usize| serde_json::json!({"key": format!("a.{k}"), "values": vec![0; 1000]});
    for (content, said) in [
        (older.as_str(), "plan the sweep again"),
        (&with("/designs", serde_json::json!([])), "has no design"),
        (
            &with("/axes/0/values", serde_json::json!([])),
            "has no values",
        ),
        (
            &with("/axes", (0..7).map(axis).collect()),
            "more than 1000000",
        ),
        (
            &with("/axes", [0, 0].map(axis).into_iter().collect()),
            "varied twice",
        ),
        (
            &with("/settings/tolerance_J", serde_json::json!(-1)),
            "tolerance = -1",
        ),
        (
            &with("/settings/far_starts", serde_json::json!(1e12 as u64)),
            "far_starts = 1000000000000",
        ),
        (
            &with("/settings/milestones", serde_json::json!(0)),
            "milestones = 0",
        ),
        ("{}", "not a manifest"),
    ] {
        std::fs::write(&file, content).unwrap();
        for what in ["--run", "--status", "--merge"] {
            let output = run(&[what, plan]);
            assert_eq!(output.status.code(), Some(2), "{what}");
            assert!(stderr(&output).contains(said), "{}", stderr(&output));
        }
    }
    let output = run(&["--status", "nowhere/plan.json"]);
    assert_eq!(output.status.code(), Some(2));
}
