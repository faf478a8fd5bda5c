//! Searches: the best point with its bounds, the same bytes however the work is divided.

use super::{DESIGN, QUICK, assert_same, done, run, text};
use crate::program::stderr;

/// A cheap search in which deeper magnets bind less.
fn arguments<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let what = [
        DESIGN,
        "--vary",
        "magnet.inset=0:0.01",
        "--vary",
        "fixed.faces.east.code=NNNS,NNSS",
        "--maximise",
        "bond_depth",
        "--points",
        "12",
    ];
    [&what[..], &QUICK, more].concat()
}

#[test]
fn a_search_finds_the_end_of_a_range_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let told = done(&arguments(&["--threads", "2", "--out", text(&out)]));
    assert!(
        told.contains("the best is at the end of the range of inset (lower)"),
        "{told}"
    );
    assert!(told.contains("proved better than all"), "{told}");
    let report = std::fs::read(out.join("report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    let best = &report["best"];
    assert_eq!(best["values"]["magnet.inset"], 0.0, "{best}");
    assert_eq!(best["file"], "best.toml");
    assert_eq!(
        best["proved_better_than"],
        best["analysed"].as_u64().unwrap() - 1
    );
    assert_eq!(best["sensitivity"][0]["at_lower_end"], true);
    // The best design is ready to run.
    let best = out.join("best.toml");
    let design = std::fs::read_to_string(best).unwrap();
    assert!(design.contains("inset = 0.0"), "{design}");
}

#[test]
fn a_search_is_the_same_on_any_number_of_threads_after_an_interruption_and_in_parts() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, resumed, parts] =
        ["whole", "resumed", "parts"].map(|name| folder.path().join(name));
    done(&arguments(&["--threads", "1", "--out", text(&whole)]));

    // Half of the points are there already.
    let points = resumed.join("points");
    std::fs::create_dir_all(&points).unwrap();
    let mut names: Vec<_> = std::fs::read_dir(whole.join("points")).unwrap().collect();
    names.truncate(names.len() / 2);
    for name in names {
        let name = name.unwrap();
        std::fs::copy(name.path(), points.join(name.file_name())).unwrap();
    }
    done(&arguments(&["--threads", "2", "--out", text(&resumed)]));
    assert_same(&whole, &resumed);

    let plan = parts.join("plan.json");
    let plan = text(&plan);
    done(&arguments(&["--plan", plan]));
    assert!(done(&["--status", plan]).contains("0 points tried of about 12"));
    let early = run(&["--merge", plan]);
    assert_eq!(early.status.code(), Some(1));
    assert!(
        stderr(&early).contains("not finished"),
        "{}",
        stderr(&early)
    );
    let mut rounds = 0;
    while !done(&["--status", plan]).contains("finished") {
        for part in ["1/2", "2/2"] {
            done(&["--run", plan, "--shard", part, "--threads", "1"]);
        }
        rounds += 1;
        assert!(rounds < 20);
    }
    done(&["--merge", plan]);
    assert_same(&whole, &parts);
}

#[test]
fn wrong_searches_are_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new");
    let vary = ["--vary", "magnet.inset=0:0.01"];
    let wrong: [(&[&str], &str); 13] = [
        (
            &["--maximise", "captured", "--subject", "bond > 1 J"],
            "the nearest: magnet.inset = ",
        ),
        (
            &["--maximise", "depth"],
            "there is no figure `depth`: known: bond_depth",
        ),
        (&["--minimise", "trap"], "there is no figure `trap`"),
        (&["--subject", "captured > 0.5"], "add --maximise"),
        (&["--points", "5"], "add --maximise"),
        (&["--maximise", "bond", "--points", "1"], "from 2 to"),
        (
            &["--maximise", "bond", "--subject", "captured = 0.5"],
            "FIGURE > VALUE",
        ),
        (
            &["--maximise", "bond", "--subject", "bond > 3 mm"],
            "such as 20 mJ",
        ),
        (&["--maximise", "bond", "--minimise", "bond"], "twice"),
        (
            &[
                "--maximise",
                "bond",
                "--maximise",
                "captured",
                "--minimise",
                "trap_depth",
            ],
            "one objective, or two",
        ),
        (
            &["--maximise", "bond", "--refine", "3"],
            "cannot be used with",
        ),
        (
            &["--maximise", "bond", "--vary", "magnet.pitch=0.04:0.02"],
            "range of `magnet.pitch` is empty",
        ),
        (
            &["--maximise", "bond", "--vary", "magnet.pitch=0.0001:0.001"],
            "points is possible; the first: ",
        ),
    ];
    for (arguments, said) in wrong {
        let output = run(&[&[DESIGN], &vary[..], arguments, &["--out", text(&out)]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
        assert!(!out.exists(), "{arguments:?}");
    }
}

#[test]
fn a_search_in_which_nothing_fits_says_what_is_nearest() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = run(&arguments(&[
        "--subject",
        "captured > 0.99",
        "--out",
        text(&out),
    ]));
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("no point is fit: relax a condition"));
    let told = crate::program::stdout(&output);
    assert!(told.contains("not captured > 0.99"), "{told}");
    assert!(out.join("report.html").exists() && !out.join("best.toml").exists());
}
