//! `tilebind analyse`: files, keys, and the same bytes every time.

use std::path::Path;

use serde_json::Value;

use super::{numbers, tilebind};
use crate::folder::{assert_same, contents, untimed};
use crate::program::{command, stderr, stdout};

const DESIGN: &str = "shapes/paper-tile.toml";

/// The list of states is proved complete.
const PROVED: [&str; 2] = ["--complete-seconds", "60"];

/// A quick analysis into `out`; without [`PROVED`] nothing is proved of its list of states.
fn analyse(out: &Path, more: &[&str]) -> std::process::Output {
    let mut arguments = vec![
        "analyse",
        DESIGN,
        "--out",
        out.to_str().unwrap(),
        "--milestones",
        "500",
        "--far-starts",
        "50",
    ];
    arguments.extend(more);
    if !more.iter().any(|option| option.starts_with("--complete")) {
        arguments.extend(["--complete-seconds", "0"]);
    }
    let output = tilebind(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    output
}

fn report(out: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(out.join("report.json")).unwrap()).unwrap()
}

#[test]
fn everything_but_the_timing_is_the_same_on_one_thread_and_two() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["one", "two"].map(|name| folder.path().join(name));
    analyse(&one, &["--threads", "1"]);
    let quiet = analyse(&two, &["--threads", "2", "--quiet"]);
    assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty());
    assert_same(&untimed(&one), &untimed(&two), "one thread");
}

/// In place of the efforts, which cannot be asked for beside it.
#[test]
fn quick_is_an_analysis_without_proofs() {
    let folder = tempfile::tempdir().unwrap();
    let [quick, without] = ["quick", "without"].map(|name| folder.path().join(name));
    let ask = |out: &Path, options: &[&str]| {
        let few = ["--milestones", "500", "--far-starts", "50", "--no-pictures"];
        let design = ["analyse", DESIGN, "--out", out.to_str().unwrap()];
        tilebind(&[&design, &few[..], options].concat())
    };
    let output = ask(&quick, &["--quick"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("barriers are not certified: no proof was requested"));
    let efforts = ["--certify-work", "0", "--complete-work", "0"];
    assert_eq!(ask(&without, &efforts).status.code(), Some(0));
    assert_same(&untimed(&quick), &untimed(&without), "no efforts");
    let both = ask(&quick, &["--quick", "--certify-seconds", "3"]);
    assert_eq!(both.status.code(), Some(2), "{}", stderr(&both));
}

/// TopSearch 0.0.3 takes a file of one line for a row of numbers.
#[test]
fn a_network_of_one_transition_state_has_two_lines_for_it() {
    let folder = tempfile::tempdir().unwrap();
    let tile = |name: &str, face: &str, pole: &str| {
        format!(
            "[{name}]\nside = 0.06\nthickness = 0.01\nmass = 0.03\n[{name}.faces]\n{face} = {{ code = \
             \"{pole}\" }}\n"
        )
    };
    let text = format!(
        "[table]\nsize = [1.0, 1.0]\n[magnet]\nsize = [0.004, 0.006, 0.006]\nremanence = 1.3\n{}{}\
         [target]\nfixed = \"east\"\nmoving = \"west\"\n",
        tile("fixed", "east", "N"),
        tile("moving", "west", "S")
    );
    let design = folder.path().join("one.toml");
    std::fs::write(&design, text).unwrap();
    let [design, out] = [&design, folder.path()].map(|path| path.to_str().unwrap());
    let few = ["--quick", "--far-starts", "50", "--force"];
    let output = tilebind(&[&["analyse", design, "--out", out], &few[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let lines = |name: &str| -> Vec<String> {
        let text = std::fs::read_to_string(folder.path().join("topsearch").join(name)).unwrap();
        text.lines().map(str::to_owned).collect()
    };
    for (name, count) in [
        ("min.data", 2),
        ("ts.data", 2),
        ("ts.coords", 2),
        ("pairlist", 1),
    ] {
        assert_eq!(lines(name).len(), count, "{name}");
    }
    assert_eq!(lines("ts.data")[0], lines("ts.data")[1]);
}

/// Enough magnets for far groups to be replaced, and enough slides for several paths to be searched
/// in parallel.
const MANY: &str = r#"
name = "many"
[table]
size = [2.0, 2.0]
[magnet]
size = [0.002, 0.0075, 0.003]
remanence = 1.2
pitch = 0.0125
inset = 0.0
[fixed]
side = 0.43
thickness = 0.013
mass = 0.1
[fixed.faces]
all = { code = "NSSNNSSNNSSNNSSNNSSNNSSNNSSNNSSN" }
[moving]
side = 0.43
thickness = 0.013
mass = 0.1
[moving.faces]
all = { code = "SNNSSNNSSNNSSNNSSNNSSNNSSNNSSNNS" }
west = { mates = "east" }
[target]
fixed = "east"
moving = "west"
[potential]
model = "dipole"
"#;

#[test]
fn as_many_energies_of_many_magnets_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("many.toml");
    std::fs::write(&design, MANY).unwrap();
    let on = |threads: &str| {
        let out = folder.path().join(threads);
        let few = "--milestones 60 --far-starts 2 --kinds 1 --certify-work 0 --complete-work 0";
        let mut arguments = vec![
            "analyse",
            design.to_str().unwrap(),
            "--no-pictures",
            "--quiet",
        ];
        arguments.extend(["--out", out.to_str().unwrap(), "--threads", threads]);
        arguments.extend(few.split(' '));
        let output = tilebind(&arguments);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let report = report(&out);
        let stages = report["timing"]["stages"].as_array().unwrap().iter();
        let of_stages: Vec<Value> = stages.map(|it| it["energy_evaluations"].clone()).collect();
        (untimed(&out), of_stages)
    };
    let one = on("1");
    assert!(one.1.iter().all(Value::is_u64));
    let three = on("3");
    assert_same(&three.0, &one.0, "three threads");
    assert_eq!(three.1, one.1, "three threads");
}

/// Does work while every core is busy with something else.
fn beside_busy_loops<T>(work: impl FnOnce() -> T) -> T {
    use std::sync::atomic::{AtomicBool, Ordering};
    let is_done = AtomicBool::new(false);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                while !is_done.load(Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        let done = work();
        is_done.store(true, Ordering::Relaxed);
        done
    })
}

/// With proofs that finish, and with proofs whose effort is spent before, where a clock would matter.
#[test]
fn the_same_bytes_on_a_busy_machine_and_on_an_idle_one() {
    let folder = tempfile::tempdir().unwrap();
    for (name, proofs) in [
        ("done", ["--certify-work", "20", "--complete-work", "20"]),
        (
            "ended",
            ["--certify-work", "0.05", "--complete-work", "0.1"],
        ),
    ] {
        let run = |on: &str| {
            let out = folder.path().join(name).join(on);
            let more = ["--threads", on, "--no-pictures"];
            let output = analyse(&out, &[&proofs[..], &more].concat());
            let text = stdout(&output).replace(out.to_str().unwrap(), "out");
            (report(&out), untimed(&out), text)
        };
        let alone = run("1");
        let ended = if name == "done" {
            Value::Null
        } else {
            "work".into()
        };
        assert_eq!(alone.0["certificate_ended_by"], ended);
        assert_eq!(alone.0["inventory"]["ended_by"], ended);
        assert_eq!(alone.0["inventory"]["complete"], name == "done");
        let told = alone
            .2
            .contains("(--complete-work 0.1): raise it to continue");
        assert_eq!(told, name == "ended", "{}", alone.2);
        if name == "ended" {
            let busy = beside_busy_loops(|| run("2"));
            assert_same(&busy.1, &alone.1, name);
            assert_eq!(busy.2, alone.2);
        }
    }
}

#[test]
fn a_clock_that_ends_a_proof_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    // A clock that has gone on before the first cells are looked at.
    let soon = [
        "--certify-seconds",
        "0.02",
        "--complete-seconds",
        "0.01",
        "--tolerance",
        "1e-9",
    ];
    let output = analyse(&out, &soon);
    let report = report(&out);
    assert_eq!(report["settings"]["complete_s"], 0.01);
    assert_eq!(report["settings"]["complete_work"], 180.0);
    assert_eq!(report["inventory"]["ended_by"], "clock");
    let text = stdout(&output);
    let told = "the proof reached its time limit (--complete-seconds 0.01): another run may differ";
    assert!(text.contains(told), "{text}");
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains(told));
}

#[test]
fn the_report_has_every_key_and_every_file_that_it_names() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new/folder");
    analyse(&out, &PROVED);
    let report = report(&out);
    for key in [
        "tilebind", "design", "seed", "settings", "bound", "states", "barriers", "counts", "timing",
    ] {
        assert!(report.get(key).is_some(), "{key}");
    }
    assert_eq!(report["inventory"]["complete"], true);
    assert_eq!(report["inventory"]["open"], Value::Array(Vec::new()));
    assert_eq!(report["tilebind"], env!("CARGO_PKG_VERSION"));
    assert_eq!(report["design"]["name"], "paper-tile");
    assert_eq!(report["design"]["sha256"].as_str().unwrap().len(), 64);
    for key in ["milestones", "edges", "energy_evaluations"] {
        assert!(report["counts"][key].as_u64().unwrap() > 0, "{key}");
    }
    assert!(report["timing"]["total_wall_s"].as_f64().unwrap() > 0.0);
    let bound = &report["bound"];
    assert_eq!(numbers(&bound["pose"]), [0.43, 0.0, 0.0]);
    assert!((bound["energy_J"].as_f64().unwrap() + 65.47e-3).abs() < 1e-5);

    let states = report["states"].as_array().unwrap();
    assert_eq!(states[0]["kind"], "bound");
    for (id, state) in states.iter().enumerate() {
        assert_eq!(state["id"], id);
        assert_eq!(numbers(&state["pose"]).len(), 3);
        let capture = &state["capture"];
        let bounds = ["low", "share", "high"].map(|key| capture[key].as_f64().unwrap());
        assert!(bounds.is_sorted() && bounds[0] >= 0.0 && bounds[2] <= 1.0);
        check_barrier(&out, states, &state["escape"], Some(id));
    }
    for barrier in report["barriers"].as_array().unwrap() {
        check_barrier(&out, states, barrier, None);
    }
    let shares: f64 = states
        .iter()
        .map(|state| state["capture"]["share"].as_f64().unwrap())
        .sum();
    let uncaptured = report["free"]["capture"]["share"].as_f64().unwrap();
    assert!((shares + uncaptured - 1.0).abs() < 1e-9);
    let count = |key: &str| report["free"][key]["count"].as_u64().unwrap();
    assert_eq!(count("at_rest") + count("gone"), count("capture"));
}

/// A barrier's numbers agree with its ends and with its pathway.
fn check_barrier(out: &Path, states: &[Value], barrier: &Value, from: Option<usize>) {
    if let Some(from) = from {
        assert_eq!(barrier["from"], from);
    }
    let number = |key: &str| barrier[key].as_f64().unwrap_or_else(|| panic!("{key}"));
    let energy = |place: &Value| match place.as_u64() {
        Some(id) => states[id as usize]["energy_J"].as_f64().unwrap(),
        None => 0.0,
    };
    let saddle = number("saddle_energy_J");
    let above = |end: &str| saddle - energy(&barrier[end]);
    assert!((number("forward_J") - above("from")).abs() < 1e-12);
    // No barrier is negative, although paths to free may end slightly below 0.
    assert!((number("reverse_J") - above("to").max(0.0)).abs() < 1e-12);
    assert!(number("forward_J") > 0.0);
    assert_eq!(numbers(&barrier["saddle_pose"]).len(), 3);
    assert!(barrier.get("lower_J").is_some() && barrier.get("upper_J").is_some());

    let table = std::fs::read_to_string(out.join(barrier["pathway"].as_str().unwrap())).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("s,x,y,theta,energy_J,clearance_m"));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let ends = [
        (&barrier["from"], &rows[0]),
        (&barrier["to"], &rows[rows.len() - 1]),
    ];
    for (place, row) in ends {
        match place.as_u64() {
            Some(id) => {
                let pose = numbers(&states[id as usize]["pose"]);
                let turn = (row[3] - pose[2]).rem_euclid(std::f64::consts::TAU);
                // -pi and pi are the same angle.
                let turn = turn.min(std::f64::consts::TAU - turn);
                let off = [row[1] - pose[0], row[2] - pose[1], turn].map(f64::abs);
                let off = off.into_iter().fold(0.0, f64::max);
                assert!(off < 1e-6, "{barrier} ends at {row:?}");
            }
            // Circles about the two squares no longer meet.
            None => assert!(row[1].hypot(row[2]) >= 0.43 * 2f64.sqrt() - 1e-9),
        }
    }
    assert!(rows.iter().all(|row| row[5] > -1e-9), "{barrier} overlaps");
    assert!(rows.is_sorted_by(|a, b| a[0] < b[0]), "{barrier} goes back");
}

#[test]
fn tables_pictures_and_the_summary() {
    let folder = tempfile::tempdir().unwrap();
    let output = analyse(folder.path(), &["--repeats", "2"]);
    let report = report(folder.path());
    let table = std::fs::read_to_string(folder.path().join("states.csv")).unwrap();
    let states = report["states"].as_array().unwrap();
    assert_eq!(table.lines().count(), 1 + states.len());
    assert!(table.starts_with("id,kind,class,copies,x_m,y_m,theta_rad,energy_J,"));
    let header = table.lines().next().unwrap();
    assert!(header.ends_with("faces,block_energy_J,dipole_error_J,name,caged"));
    for (row, state) in table.lines().skip(1).zip(states) {
        let cells: Vec<&str> = row.split(',').collect();
        let [blocks, error] = [cells.len() - 4, cells.len() - 3].map(|k| cells[k].parse::<f64>());
        let energy = state["energy_J"].as_f64().unwrap();
        let expected = energy - state["block_energy_J"].as_f64().unwrap();
        assert!((error.unwrap() - expected).abs() < 1e-9 * expected.abs());
        assert!((blocks.unwrap() + expected - energy).abs() < 1e-9);
    }
    let table = std::fs::read_to_string(folder.path().join("barriers.csv")).unwrap();
    let barriers = report["barriers"].as_array().unwrap();
    assert_eq!(table.lines().count(), 1 + barriers.len());
    let columns: Vec<usize> = table.lines().map(|l| l.split(',').count()).collect();
    assert!(columns.iter().all(|n| *n == columns[0]));
    assert!(barriers.iter().any(|b| b["spread_J"].is_array()));
    for name in [
        "map",
        "approach",
        "profiles",
        "docking",
        "models",
        "disconnectivity",
    ] {
        for (kind, start) in [("svg", "<svg"), ("png", "\u{89}PNG")] {
            let file = folder.path().join(format!("pictures/{name}.{kind}"));
            let content = std::fs::read(&file).unwrap_or_else(|_| panic!("{}", file.display()));
            let text: String = content.iter().take(400).map(|&b| b as char).collect();
            assert!(text.contains(start), "{}", file.display());
        }
    }
    let summary = stdout(&output);
    for said in [
        "far starts",
        "end in the bond",
        "in traps",
        "-65.47 mJ",
        "trap",
        "selectivity",
        "dipoles are off by",
    ] {
        assert!(summary.contains(said), "{said:?} in\n{summary}");
    }
    assert!((8..=21).contains(&summary.lines().count()), "{summary}");
    assert!(
        summary.lines().all(|line| line.chars().count() <= 110),
        "{summary}"
    );
    assert!(stderr(&output).is_empty(), "silent where nobody watches");
}

#[test]
fn compact_results_leave_out_copies_and_pixels_and_json_goes_to_standard_output() {
    let folder = tempfile::tempdir().unwrap();
    let output = analyse(folder.path(), &["--compact", "--json"]);
    let files = contents(folder.path());
    assert!(!files.keys().any(|name| name.ends_with(".png")));
    // Half of it pathways, with as many points as straight motions between them need to be free; a tenth
    // the picture of the roadmap.
    assert!(files.values().map(Vec::len).sum::<usize>() < 1_300_000);
    assert_eq!(stdout(&output).as_bytes(), files["report.json"]);
    // Without pictures the rest is the same.
    let bare = tempfile::tempdir().unwrap();
    analyse(bare.path(), &["--no-pictures"]);
    let mut rest = untimed(folder.path());
    rest.retain(|name, _| !name.starts_with("pictures/"));
    assert_same(&untimed(bare.path()), &rest, "no pictures");
    let report = report(folder.path());
    for state in report["states"].as_array().unwrap() {
        let pathway = &state["escape"]["pathway"];
        assert_eq!(pathway.is_string(), state["id"] == state["class"]);
        if let Some(name) = pathway.as_str() {
            assert!(files.contains_key(name));
        }
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_analysis_leaves_nothing() {
    use std::process::{Command, Stdio};
    use std::time::Duration;

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let mut child = command(&["analyse", DESIGN, "--milestones", "3000000", "--out"])
        .arg(&out)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(500));
    let kill = Command::new("kill").arg(child.id().to_string()).status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(75));
    assert!(!out.exists());
}
