//! A command never replaces its input files, by whatever name they are given.

use super::*;

/// Command lines that would replace one of their inputs.
const LINES: [(&str, &str); 14] = [
    (
        "sweep d.toml --vary fixed.mass=0.1,0.2 --plan d.toml",
        "d.toml",
    ),
    (
        "sweep wave.toml --vary fixed.mass=0.1,0.2 --plan wave.svg",
        "wave.svg",
    ),
    (
        "barrier d.toml --from 0.43,0,0 --to free --milestones 3000000 --pathway d.toml",
        "d.toml",
    ),
    ("show wave.toml --out wave.svg", "wave.svg"),
    ("make sheet.md --out .", "sheet.md"),
    (
        "analyse report.json --milestones 3000000 --out .",
        "report.json",
    ),
    ("compare d.toml compare.md --out .", "compare.md"),
    ("dock runs.csv --runs 1000000 --out .", "runs.csv"),
    (
        "yield yield.csv --tiles 4 --time 10 --kt 3e-3 --out .",
        "yield.csv",
    ),
    ("rates rates.csv --kt 3e-3 --out .", "rates.csv"),
    (
        "words words.toml --length 4 --gap 0.3 --out .",
        "words.toml",
    ),
    ("crosstalk crosstalk.csv --out .", "crosstalk.csv"),
    (
        "assemble tileset.yaml --kt 5e-3 --coverage 0.1 --out .",
        "tileset.yaml",
    ),
    (
        "assemble lattice --lattice 2x2 --kt 4e-3 --coverage 0.1 --words words.toml --out .",
        "words.toml",
    ),
];

fn inputs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for name in [
        "d.toml",
        "sheet.md",
        "report.json",
        "compare.md",
        "runs.csv",
        "yield.csv",
        "rates.csv",
    ] {
        copy(here, &[(DESIGN, name)]);
    }
    copy(
        here,
        &[
            ("shapes/drawn-wave.svg", "wave.svg"),
            ("shapes/assemblies/binary-counter.yaml", "tileset.yaml"),
        ],
    );
    let wave = fs::read_to_string("shapes/drawn-wave.toml").unwrap();
    let set = "words = [\"NNSN\", \"NSSS\", \"NNSS\"]\n";
    place(
        here,
        &[
            ("wave.toml", &wave.replace("drawn-wave.svg", "wave.svg")[..]),
            ("crosstalk.csv", set),
        ],
    );
    folder
}

#[test]
fn no_input_is_replaced_not_even_by_force() {
    for (line, input) in LINES {
        let folder = inputs();
        let here = folder.path();
        let set = line.starts_with("assemble lattice");
        let text = if set {
            "words = [\"NNSN\"]\n".to_owned()
        } else {
            fs::read_to_string(DESIGN).unwrap()
        };
        place(here, &[("words.toml", &text)]);
        refused(here, &words(line), &[input, "never replaced"]);
        refused(
            here,
            &words(&format!("{line} --force")),
            &[input, "never replaced"],
        );
    }
}

#[cfg(unix)]
#[test]
fn inputs_are_known_by_other_names() {
    let folder = inputs();
    let here = folder.path();
    fs::create_dir(here.join("sub")).unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let other = elsewhere.path().join("other");
    std::os::unix::fs::symlink(here, &other).unwrap();
    let other = other.join("wave.svg");
    std::os::unix::fs::symlink("wave.svg", here.join("soft.svg")).unwrap();
    fs::hard_link(here.join("wave.svg"), here.join("hard.svg")).unwrap();
    let absolute = here.join("wave.svg");
    for name in [
        "./wave.svg",
        "sub/../wave.svg",
        other.to_str().unwrap(),
        absolute.to_str().unwrap(),
        "soft.svg",
        "hard.svg",
    ] {
        for force in [&[][..], &["--force"]] {
            let line = [&["show", "wave.toml", "--out", name], force].concat();
            refused(here, &line, &["never replaced"]);
        }
    }
    // The input itself may be a link.
    let show = ["show", "soft.toml", "--out", "wave.svg", "--force"];
    std::os::unix::fs::symlink("wave.toml", here.join("soft.toml")).unwrap();
    refused(here, &show, &["never replaced"]);
    assert!(here.join("soft.svg").is_symlink());
}

/// A manifest among the results is unchanged; one with the name of another result is refused.
#[test]
fn manifests_are_inputs_of_merging() {
    let desk = desk();
    let here = desk.path();
    done(here, &words(SWEEP));
    let spaced = fs::read_to_string(here.join("R/plan.json")).unwrap() + "\n\n";
    place(here, &[("R/plan.json", &spaced)]);
    for plan in ["R", "R/plan.json", "./R/../R/plan.json"] {
        done(here, &["sweep", "--merge", plan, "--quiet"]);
        done(here, &["sweep", "--run", plan, "--quiet"]);
        check(here, &[("R/plan.json", &spaced)]);
    }
    fs::copy(here.join("R/plan.json"), here.join("R/report.json")).unwrap();
    let merge = ["sweep", "--merge", "R/report.json", "--quiet", "--force"];
    refused(here, &merge, &["R/report.json", "never replaced"]);
    // The same sweep again would replace what was edited.
    fs::remove_file(here.join("R/report.json")).unwrap();
    refused(here, &words(SWEEP), &["R/plan.json", "was changed since"]);
}

/// Old results that are read are not removed with the others.
#[test]
fn an_old_result_that_is_read_stays() {
    let desk = desk();
    let here = desk.path();
    done(here, &words(ASSEMBLE));
    let set = fs::read(here.join("R/words.toml")).unwrap();
    let again = "assemble lattice --lattice 2x2 --kt 4e-3 --coverage 0.1 --words R/words.toml \
                 --quiet --out R --force";
    refused(here, &words(again), &["R/words.toml", "never replaced"]);
    assert_eq!(fs::read(here.join("R/words.toml")).unwrap(), set);
    let crosstalk = words("crosstalk R/words.toml --quiet --out R --force");
    done(here, &crosstalk);
    assert_eq!(fs::read(here.join("R/words.toml")).unwrap(), set);
}
