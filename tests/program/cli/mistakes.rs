//! Mistakes on the command line or in a design file end with status 2 and a message that says how
//! to fix them, and leave no files.

use std::path::Path;

use super::{refused, tilebind};
use crate::folder::contents;
use crate::program::{command, stderr};

#[test]
fn every_broken_design_is_refused_with_its_place_and_leaves_no_results() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let designs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs/bad");
    let mut tried = 0;
    for entry in std::fs::read_dir(designs).unwrap() {
        let path = entry.unwrap().path();
        let name = format!(
            "tests/designs/bad/{}",
            path.file_name().unwrap().to_str().unwrap()
        );
        // A fault of a drawing is reported at the drawing's line.
        let place = match name.ends_with("svg-without-id.toml") {
            true => "tests/designs/bad/../drawings/inkscape.svg:35:",
            false => &format!("{name}:"),
        };
        let out = out.to_str().unwrap();
        refused(&["analyse", &name, "--out", out], &[place, "help:"]);
        refused(&["energy", &name, "--pose", "0.5,0,0"], &[place]);
        refused(
            &["barrier", &name, "--from", "0.5,0,0", "--to", "free"],
            &[place],
        );
        tried += 1;
    }
    assert!(tried > 50);
    assert!(!out.exists());
}

#[test]
fn a_design_that_is_not_there() {
    refused(
        &["energy", "nowhere.toml", "--pose", "0,0,0"],
        &["nowhere.toml", "cannot read"],
    );
}

/// A number below 0 looks like an option; the message comes from the option that it belongs to.
#[test]
fn negative_numbers_are_told_in_our_words() {
    let paper = "shapes/paper-tile.toml";
    for (command, option, value, said) in [
        ("bond", "--coverage", "-0.1", "between 0 and 1"),
        ("bond", "--kt", "-1e-3", "a kT between"),
        ("bond", "--seed", "-1", "a whole number"),
        ("assemble", "--coverage", "-.5", "between 0 and 1"),
        ("assemble", "--kt", "-1", "a kT between"),
        ("assemble", "--lattice", "-3x3", "ROWSxCOLUMNS"),
        ("assemble", "--length", "-8", "a whole number"),
        ("assemble", "--pitch", "-4 cm", "a length from"),
        ("assemble", "--proofread", "-1", "from 1 to 6"),
        ("calibrate", "--area", "-1", "a area from"),
        ("calibrate", "--within", "-75cm", "a length from"),
        ("calibrate", "--hold-out", "-2", "from 2 to 65535"),
        ("bond", "--threads", "-2", "from 1 to 65535"),
        ("yield", "--kt", "-1e-3,2e-3", "a kT between"),
        ("yield", "--tiles", "-4", "a whole number"),
        ("yield", "--time", "-600", "a time from"),
        ("rates", "--free-at", "-5 cm", "a length from"),
        ("rates", "--drag", "-50", "a rate from"),
        ("rates", "--certify", "-0.1", "no longer have bounds"),
        ("rates", "--traps", "-1", "a whole number"),
        ("rates", "--check", "-10", "a whole number"),
        ("rates", "--check", "1", "2 or more"),
        ("rates", "--restitution", "1.5", "from 0 to 1"),
    ] {
        // The wrong entry of a list is named.
        let (wrong, _) = value.split_once(',').unwrap_or((value, ""));
        let named = format!("'{wrong}' for '{option} <");
        refused(&[command, paper, option, value], &[&named, said]);
    }
}

/// Values with which trajectories would never end.
#[test]
fn docking_has_limits() {
    let dock = |option, value, said| {
        refused(
            &["dock", "shapes/paper-tile.toml", option, value],
            &[option, said],
        );
    };
    for option in ["--direction", "--orientation", "--aim"] {
        dock(option, "1e308", "from 0 to 6.2832");
    }
    dock("--spin", "1e11", "from 0 to 1000 ");
    dock("--speed", "0,1e300", "from 0 to 100 ");
    dock("--drag", "1e11", "from 0 to 10000 ");
    dock("--shaking", "1e308", "a kT between");
}

#[test]
fn a_pathway_is_not_lost_below_the_report() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("q");
    let way = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let ends = ["--from", "0.43,0,0", "--to", "free", "--out"];
    for name in ["q/report.json", "q/../q/report.html", "q/pathway.csv"] {
        let name = way(name);
        let asked = ["barrier", "shapes/paper-tile.toml", "--pathway", &name];
        let asked = [&asked[..], &ends, &[out.to_str().unwrap()]].concat();
        refused(&asked, &["give another name"]);
    }
    assert!(contents(folder.path()).is_empty());
}

#[test]
fn wrong_poses() {
    for pose in ["1,2", "1,2,three", "1,2,nan", "1,2,3,4", "1e308,0,0", ""] {
        refused(
            &["energy", "shapes/paper-tile.toml", "--pose", pose],
            &["X,Y,THETA"],
        );
    }
    refused(&["energy", "shapes/paper-tile.toml"], &["--pose"]);
}

/// A number with a comma is not misread, and the message gives the correct form.
#[test]
fn decimal_commas_are_named() {
    let paper = "shapes/paper-tile.toml";
    for (arguments, meant) in [
        (["energy", paper, "--pose", "0,43,0,0"], "0.43,0,0"),
        (["energy", paper, "--pose", "0,43 m,0,0"], "0.43 m,0,0"),
        (["bond", paper, "--kt", "0,003"], "0.003"),
        (["bond", paper, "--coverage", "0,3"], "0.3"),
        (["rates", paper, "--drag", "0,5"], "0.5"),
    ] {
        let said = format!("use a decimal point, not a comma: {meant}");
        refused(&arguments, &[&said]);
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("poses.csv");
    let poses = file.to_str().unwrap();
    for text in [
        "x,y,theta\n0,43,0,0\n",
        "0,43,0,0\n",
        "0.43,0,0\n0,44,0,0\n",
        "x,y,theta\n\"0,43\",0,0\n",
    ] {
        std::fs::write(&file, text).unwrap();
        let said = ["line", "use a decimal point, not a comma: 0.4"];
        refused(&["energy", paper, "--poses", poses], &said);
    }
    // An empty entry behind the last comma, as spreadsheets write it.
    std::fs::write(&file, "x,y,theta\n0.43,0,0,\n").unwrap();
    assert!(
        tilebind(&["energy", paper, "--poses", poses])
            .status
            .success()
    );
    let design = folder.path().join("design.toml");
    let text = std::fs::read_to_string(format!("{}/{paper}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    for (from, to, said) in [
        ("side = 0.43", "side = 0,43", "write 0.43"),
        (
            "[0.010, 0.010, 0.003]",
            "[0,010, 0,010, 0,003]",
            "write 0.010",
        ),
        (
            "[2.0, 2.0]",
            "[2,0, 2,0]",
            "use a decimal point, not a comma",
        ),
        ("{ code", "{ magnet = { pitch = 0,04 }, code", "write 0.04"),
    ] {
        assert!(text.contains(from), "{from}");
        std::fs::write(&design, text.replace(from, to)).unwrap();
        let path = design.to_str().unwrap();
        refused(&["show", path], &[said, "design.toml:"]);
    }
}

#[test]
fn ends_of_a_barrier_that_overlap_or_lie_off_the_table() {
    let design = "shapes/paper-tile.toml";
    for (from, to, said) in [
        ("0.4,0,0", "0.43,0,0", "overlap by 30.0000 mm"),
        ("0.43,0,0", "0.4,0,0", "overlap"),
        ("1.2,0,0", "free", "off the table"),
        ("0.43,0,0", "0,-1.01,0", "off the table"),
    ] {
        refused(&["barrier", design, "--from", from, "--to", to], &[said]);
    }
}

#[test]
fn wrong_options() {
    let design = "shapes/paper-tile.toml";
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let out = out.to_str().unwrap();
    for option in [
        ["--milestones", "0"],
        ["--milestones", "-5"],
        ["--settled", "0"],
        ["--settled", "2"],
        ["--boltzmann", "nan"],
        ["--thermal-energy", "-1"],
        ["--threads", "0"],
        ["--repeats", "0"],
        ["--repeats", "1e9"],
        ["--seed", "x"],
        ["--sed", "1"],
    ] {
        refused(
            &["analyse", design, "--out", out, option[0], option[1]],
            &[option[0]],
        );
    }
    refused(&["analyse", design], &["--out"]);
    refused(&["analyze", design], &["analyse"]);
    refused(&[], &["Usage"]);
    assert!(contents(folder.path()).is_empty());
}

#[test]
fn results_cannot_go_into_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("taken");
    std::fs::write(&file, "precious").unwrap();
    for out in [file.clone(), file.join("below")] {
        refused(
            &[
                "analyse",
                "shapes/paper-tile.toml",
                "--out",
                out.to_str().unwrap(),
            ],
            &["is a file"],
        );
    }
    assert_eq!(std::fs::read_to_string(file).unwrap(), "precious");
}

#[test]
fn more_memory_than_the_machine_has_is_refused_before_anything_is_done() {
    let design = "shapes/paper-tile.toml";
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let out = out.to_str().unwrap();
    let many = "4294967295";
    let said = ["GB of memory", "are free", "--milestones"];
    for command in ["analyse", "compare", "sweep"] {
        let work = [command, design, "--out", out, "--milestones"];
        refused(&[&work[..], &[many]].concat(), &said);
        refused(&[&work[..], &["1e6", "--neighbours", many]].concat(), &said);
        refused(&[&work[..], &["18446744073709551615"]].concat(), &said);
    }
    let ends = ["--from", "0.5,0,0", "--to", "free"];
    let barrier = ["barrier", design, "--milestones", many];
    refused(&[&barrier[..], &ends[..]].concat(), &said);
    assert!(contents(folder.path()).is_empty());
    // A milestone has no more neighbours than there are other milestones.
    let few = [&["barrier", design, "--milestones", "1"][..], &ends[..]].concat();
    assert_ne!(tilebind(&few).status.code(), Some(2));
}

/// A terminal would interpret them.
#[test]
fn messages_hold_no_control_characters() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("keyed.toml");
    let text = std::fs::read_to_string("shapes/paper-tile.toml").unwrap();
    std::fs::write(&design, format!("\"\\u001b[2J\" = 1\n{text}")).unwrap();
    for file in [design.to_str().unwrap(), "\u{1b}[2J.toml"] {
        let output = tilebind(&["energy", file, "--pose", "0.43,0,0"]);
        assert_eq!(output.status.code(), Some(2));
        let message = stderr(&output);
        let odd = |c: char| c.is_control() && c != '\n';
        assert!(
            message.contains("[2J") && !message.contains(odd),
            "{message:?}"
        );
    }
}

/// Lengths, times, energies, rates and speeds far beyond any tiles are refused by each option that takes
/// one: those of all commands, as their help lists them.
#[test]
fn numbers_beyond_all_tiles_are_refused_by_every_option() {
    const UNITS: [&str; 16] = [
        "M",
        "S",
        "L",
        "E_J",
        "RATE",
        "C",
        "LOW,HIGH",
        "LENGTH",
        "M,M",
        "A,F",
        "A,F,ANGLE",
        "RAD",
        "DT",
        "M2",
        "MU",
        "E_J:E_J",
    ];
    let help = command(&["--help"]).output().expect("the program");
    let help = String::from_utf8(help.stdout).expect("text");
    let commands = help.lines().filter_map(|line| line.strip_prefix("  "));
    let commands = commands.filter_map(|line| line.split_whitespace().next());
    let mut tried = 0;
    for name in commands.filter(|it| it.chars().all(char::is_alphabetic)) {
        let help = command(&[name, "--help"]).output().expect("the program");
        let help = String::from_utf8(help.stdout).expect("text");
        for line in help.lines() {
            let Some((option, rest)) = line.trim().split_once(" <") else {
                continue;
            };
            let unit = rest.split('>').next().unwrap_or_default();
            let option = option.split_whitespace().last().unwrap_or_default();
            if !option.starts_with("--") || !UNITS.contains(&unit) {
                continue;
            }
            for far in ["1e300", "inf", "nan"] {
                let parts = unit.matches([',', ':']).count();
                let between = if unit.contains(':') { ":" } else { "," };
                let value = vec![far; parts + 1].join(between);
                let done = command(&[name, &format!("{option}={value}")]).output();
                let done = done.expect("the program");
                let told = stderr(&done);
                assert_eq!(
                    done.status.code(),
                    Some(2),
                    "{name} {option}={value}: {told}"
                );
                assert!(
                    told.contains(option) && told.contains("invalid value"),
                    "{name} {told}"
                );
                tried += 1;
            }
        }
    }
    assert!(tried > 100, "{tried}");
}
