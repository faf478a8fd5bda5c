//! Mistakes on the command line: found before anything is written.

use super::{DEPTH, DESIGN, done, run, text};
use crate::program::stderr;

#[test]
fn wrong_axes_designs_and_parts_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new");
    let wrong: [(&[&str], &str); 9] = [
        (
            &[
                DESIGN,
                "--vary",
                "fixed.faces.east.profile.deepth=0.01,0.02",
            ],
            "did you mean `depth`",
        ),
        (&[DESIGN, "--vary", "fixed.side.depth=1"], "leads nowhere"),
        (&[DESIGN, "--vary", "magnet.size.3=0.01"], "array of 3"),
        (&[DESIGN, "--vary", "magnet.pitch"], "KEY="),
        (&[DESIGN, "--vary", "magnet.pitch=0:1:0"], "whole number"),
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
    let planned = std::fs::read_to_string(&file).unwrap();
    let older = planned.replace(env!("CARGO_PKG_VERSION"), "0.0.1");
    // 1000^7 points are more than a machine's numbers count.
    let mut manifest: serde_json::Value = serde_json::from_str(&planned).unwrap();
    let axis = |k: usize| serde_json::json!({"key": format!("a{k}"), "values": vec![k; 1000]});
    manifest["axes"] = (0..7).map(axis).collect();
    for (content, said) in [
        (older.as_str(), "plan the sweep anew"),
        (&manifest.to_string(), "more than 1000000"),
        ("{}", "no manifest"),
    ] {
        std::fs::write(&file, content).unwrap();
        let output = run(&["--run", plan]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
    let output = run(&["--status", "nowhere/plan.json"]);
    assert_eq!(output.status.code(), Some(2));
}
