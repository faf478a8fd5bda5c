//! `tilebind bond` and `tilebind yield`.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::Value;

use super::{json, numbers, tilebind};
use crate::program::{stderr, stdout};

const PAPER: &str = "shapes/paper-tile.toml";

/// Triangles with a bond and traps of very unlike lifetimes.
const TRIANGLES: &str = r#"
name = "triangles"
[table]
size = [1, 1]
[magnet]
size = [0.010, 0.010, 0.003]
remanence = 1.2
pitch = 0.02
[fixed]
sides = 3
side = 0.11
thickness = 0.013
mass = 0.05
[fixed.faces]
all = { code = "NNS" }
1 = { code = "SN.N", magnet = { remanence = 0.9 } }
[moving]
side = 0.11
thickness = 0.013
mass = 0.05
[moving.faces]
all = { code = "NS" }
west = { mates = "0" }
[target]
fixed = "0"
moving = "west"
[potential]
model = "dipole"
"#;

fn design(file: &str) -> String {
    format!("{}/{file}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn ln_k_is_depth_less_docking_cost() {
    let file = design(PAPER);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("bond");
    let found = json(&[
        "bond",
        &file,
        "--kt",
        "3.0e-3",
        "--coverage",
        "0.3",
        "--json",
        "--out",
        out.to_str().unwrap(),
    ]);
    // One holds less the more tiles are shaken.
    let course = found["over_kT"].as_array().unwrap();
    let own = course.iter().filter(|row| row["state"] == "A");
    let ln_ks: Vec<f64> = own.map(|row| row["ln_K"].as_f64().unwrap()).collect();
    assert!(ln_ks.len() > 5 && ln_ks.is_sorted_by(|a, b| a > b));
    for name in [
        "report.html",
        "states.csv",
        "over-kt.csv",
        "pictures/shaking.png",
    ] {
        assert!(out.join(name).is_file(), "{name}");
    }
    let of = |key: &str| found[key].as_f64().unwrap_or_else(|| panic!("{key}"));
    assert!((of("ln_K") - (of("bond_kT") - of("docking_cost_kT"))).abs() < 1e-12);
    assert!((of("bond_kT") - 65.47 / 3.0).abs() < 0.01);
    let volume = found["bond"]["Z0_m2_rad"].as_f64().unwrap();
    let density = 0.3 / (0.43 * 0.43);
    let cost = -(density * volume * 4.0 / std::f64::consts::TAU).ln();
    assert!((of("docking_cost_kT") - cost).abs() < 1e-9);
    let closed = found["bond"]["closed_form_error"].as_f64().unwrap();
    // Its error grows with kT: 6 % at a hundredth of the depth.
    assert!(closed < -0.2 && closed > -0.35, "{closed}");
    // One holds up to kT = bond / 21, two up to bond / 8.5.
    let window = numbers(&found["two_hold_one_does_not_J"]);
    let depths = window.iter().map(|kt| 65.47e-3 / kt).collect::<Vec<_>>();
    assert!((depths[0] - 21.0).abs() < 0.7, "{depths:?}");
    assert!((depths[1] - 8.5).abs() < 0.7, "{depths:?}");
    assert_eq!(found["bond"]["moving_copies"], 4);
}

#[test]
fn what_is_wrong_with_a_shaking_is_told() {
    let file = design(PAPER);
    for (arguments, what) in [
        (
            vec!["bond", &file, "--kt", "0", "--coverage", "0.3"],
            "--kt",
        ),
        (
            vec!["bond", &file, "--kt", "1e-3", "--coverage", "1.5"],
            "--coverage",
        ),
        (vec!["bond", &file, "--kt", "1e-3"], "--coverage"),
        (
            vec![
                "yield", &file, "--tiles", "1", "--time", "60", "--kt", "1e-3",
            ],
            "--tiles",
        ),
        (
            vec![
                "yield", &file, "--tiles", "4", "--time", "60", "--kt", "1e-3,x",
            ],
            "--kt",
        ),
    ] {
        let output = tilebind(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(what), "{}", stderr(&output));
        assert!(stdout(&output).is_empty());
    }
}

/// In a list, each kT has an answer or the reason why it has none.
#[test]
fn shakings_without_an_answer_leave_the_others_theirs() {
    let file = design(PAPER);
    let asked = |kts: &str| {
        vec![
            "yield".to_owned(),
            file.clone(),
            format!("--kt={kts}"),
            "--tiles=4".to_owned(),
            "--time=60".to_owned(),
            "--runs=10".to_owned(),
            "--duration=0.5".to_owned(),
            "--simulations=0".to_owned(),
        ]
    };
    let told = asked("1e-9,3e-3,1");
    let told: Vec<&str> = told.iter().map(String::as_str).collect();
    let found = json(&[&told[..], &["--json"]].concat());
    let settings = found["settings"].as_array().unwrap();
    let kts: Vec<f64> = settings
        .iter()
        .map(|it| it["kT_J"].as_f64().unwrap())
        .collect();
    assert_eq!(kts, [1e-9, 3e-3, 1.0]);
    assert!(settings[0]["yield"].is_null() && settings[2]["yield"].is_null());
    assert!(settings[1]["yield"].is_number() && settings[1]["why_not"].is_null());
    let why = |k: usize| settings[k]["why_not"].as_str().unwrap().to_owned();
    assert!(why(0).contains("choose a larger --kt"), "{}", why(0));
    assert!(why(2).contains("below 32.7 mJ"), "{}", why(2));
    assert_eq!(found["best_kT_J"], 3e-3);
    let alone = json(&[&told[..2], &["--kt=3e-3"], &told[3..], &["--json"]].concat());
    assert_eq!(alone["settings"][0], settings[1]);
    let output = tilebind(&told);
    assert!(output.status.success());
    assert!(stdout(&output).contains("at kT = 1.000 J the bond"));
}

/// Traps with different lifetimes: the share of the answer agrees with its own simulation.
#[test]
fn a_yield_agrees_with_its_simulation_whatever_the_lifetimes_of_traps() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("triangles.toml");
    std::fs::write(&file, TRIANGLES).unwrap();
    let found = json(&[
        "yield",
        file.to_str().unwrap(),
        "--tiles=4",
        "--time=600",
        "--kt=1.6e-3,2.1e-3",
        "--runs=120",
        "--duration=6",
        "--simulations=1000",
        "--json",
    ]);
    let mut best: f64 = 0.0;
    for setting in found["settings"].as_array().unwrap() {
        let share = |key: &str| setting[key].as_f64().unwrap();
        let offs = setting["states"].as_array().unwrap().iter();
        let offs: Vec<f64> = offs.map(|it| it["off_per_s"].as_f64().unwrap()).collect();
        let [least, most] =
            [f64::min, f64::max].map(|pick| offs.iter().copied().reduce(pick).unwrap());
        assert!(offs.len() > 3 && most > 100.0 * least, "{offs:?}");
        let simulated = &setting["yield_simulated"];
        let [mean, error] = ["mean", "standard_error"].map(|key| simulated[key].as_f64().unwrap());
        assert!((share("yield") - mean).abs() < 4.0 * error, "{setting}");
        assert!(
            setting["yield_method"]
                .as_str()
                .unwrap()
                .contains("forward equation")
        );
        best = best.max(share("yield"));
    }
    // A schedule of as many tiles is no worse than its best setting.
    assert_eq!(found["mixture"]["tiles"], 4);
    assert!(
        found["mixture"]["yield"].as_f64().unwrap() > best - 1e-6,
        "{best}"
    );
}

#[test]
fn a_yield_with_its_three_views() {
    let file = design(PAPER);
    let run = |threads: &str| {
        json(&[
            "yield",
            &file,
            "--tiles",
            "6",
            "--time",
            "300",
            "--kt",
            "3e-3,6e-3",
            "--runs",
            "24",
            "--duration",
            "3",
            "--simulations",
            "300",
            "--threads",
            threads,
            "--json",
        ])
    };
    let found = run("1");
    assert_eq!(found, run("2"));
    for setting in found["settings"].as_array().unwrap() {
        let share = |key: &str| setting[key].as_f64().unwrap_or_else(|| panic!("{key}"));
        let simulated = &setting["yield_simulated"];
        let [mean, error] = ["mean", "standard_error"].map(|key| simulated[key].as_f64().unwrap());
        assert!(
            (share("yield") - mean).abs() < 5.0 * error + 0.02,
            "{setting}"
        );
        assert!((share("yield") - share("yield_difference_equations")).abs() < 0.15);
        let [low, high] = numbers(&setting["yield_interval"])[..] else {
            panic!()
        };
        assert!(low <= share("yield") && share("yield") <= high);
    }
    let mixture = &found["mixture"];
    let of = |key: &str| mixture[key].as_f64().unwrap();
    assert!(of("yield") <= of("upper_bound") + 1e-9 && of("upper_bound") <= 1.0 + 1e-9);
    assert!(of("yield") >= found["yield"].as_f64().unwrap() - 1e-9);
}

/// The same drag, the same kT, the same states: both tiles of `yield` move, so its rates are at least twice
/// those that `rates` solves for one; and each names the other's drag.
#[test]
fn yield_and_rates_have_one_answer_for_one_drag() {
    let file = design(PAPER);
    let kt = "6e-3";
    let common = ["--kt", kt, "--drag", "20", "--json"];
    let rates = json(&[&["rates", &file][..], &common].concat());
    let asked = "--rates overdamped --tiles 2 --time 60 --simulations 0";
    let asked: Vec<&str> = asked.split(' ').collect();
    let yields = json(&[&["yield", &file][..], &asked, &common].concat());
    let area = yields["settings"][0]["free_area_m2"].as_f64().unwrap();
    let states = yields["settings"][0]["states"].as_array().unwrap();
    assert!(states.len() > 1);
    for state in states {
        let name = state["state"].as_str().unwrap();
        let is = |place: &Value| place.as_str().unwrap().split(' ').next_back() == Some(name);
        let between = |from: &dyn Fn(&Value) -> bool, to: &dyn Fn(&Value) -> bool| {
            let list = rates["rates"].as_array().unwrap();
            let entry = list.iter().find(|it| from(&it["from"]) && to(&it["to"]));
            let entry = entry.unwrap_or_else(|| panic!("{name}"));
            entry["value_per_s"].as_f64().unwrap()
        };
        let is_free = |place: &Value| place == "free";
        let own = |key: &str| state[key].as_f64().unwrap();
        let [on, off] = [
            own("on_m2_per_s") / area / between(&is_free, &is),
            own("off_per_s") / between(&is, &is_free),
        ];
        // Twice by steps, and more as a turn of the other tile carries its faces along.
        for ratio in [on, off] {
            assert!((2.0..3.0).contains(&ratio), "{name}: {on} {off}");
        }
    }
    // Each names the other.
    for (command, other) in [
        ("rates --kt 9e-3 --traps 0", "tilebind yield"),
        (
            "yield --kt 6e-3 --tiles 2 --time 60 --runs 8 --duration 2 --simulations 0",
            "tilebind rates",
        ),
    ] {
        let mut words: Vec<&str> = command.split(' ').collect();
        words.insert(1, &file);
        let text = stdout(&tilebind(&words));
        assert!(text.replace('\n', " ").contains(other), "{text}");
    }
}

/// Small squares that come to equilibrium within a second, on a square table of this size (m).
fn small(folder: &Path, table: f64) -> String {
    let tile = "side = 0.04\nthickness = 0.005\nmass = 0.002\n";
    let text = format!(
        "name = \"small\"\n[table]\nsize = [{table}, {table}]\n\
         [magnet]\nsize = [0.004, 0.004, 0.002]\nremanence = 1.2\npitch = 0.012\n\
         [fixed]\n{tile}[fixed.faces]\nall = {{ code = \"NN\" }}\n\
         [moving]\n{tile}[moving.faces]\nall = {{ code = \"SS\" }}\n\
         [target]\nfixed = \"east\"\nmoving = \"west\"\n[potential]\nmodel = \"dipole\"\n"
    );
    let file = folder.join(format!("small-{table}.toml"));
    std::fs::write(&file, text).unwrap();
    file.to_str().unwrap().to_owned()
}

/// The bond's K (m^2) of such squares, with all its 16 copies, of which `bond` counts 4.
fn association(file: &str, kt: &str) -> f64 {
    let found = json(&["bond", file, "--kt", kt, "--coverage", "0.3", "--json"]);
    let density = 0.3 / (0.04 * 0.04);
    4.0 / density * found["ln_K"].as_f64().unwrap().exp()
}

/// The bond's entry among the states of a yield of small squares.
fn bond_of(file: &str, kt: &str, asked: &str) -> Value {
    let common = "--tiles=2 --time=60 --simulations=0 --json";
    let words = ["yield", file, "--kt", kt].into_iter();
    let words: Vec<&str> = words
        .chain(asked.split(' '))
        .chain(common.split(' '))
        .collect();
    json(&words)["settings"][0]["states"][0].clone()
}

/// The number of pairs per area at given rates depends on neither the design's table nor, in docking
/// runs, on how long they take; and attachment over detachment is the bond's partition sum.
#[test]
#[ignore = "slow"]
fn rates_of_attachment_are_those_of_the_bond_alone() {
    let folder = tempfile::tempdir().unwrap();
    let [narrow, wide] = [0.16, 0.3].map(|table| small(folder.path(), table));
    let rate = |state: &Value, key: &str| state[key].as_f64().unwrap();
    let solved = [&narrow, &wide].map(|file| bond_of(file, "4e-4", "--rates=overdamped"));
    let [on, off] = ["on_m2_per_s", "off_per_s"].map(|key| rate(&solved[0], key));
    assert!((on / rate(&solved[1], "on_m2_per_s") - 1.0).abs() < 1e-9);
    let constant = association(&narrow, "4e-4");
    assert!(
        (on / off / constant - 1.0).abs() < 0.03,
        "{on} {off} {constant}"
    );

    let motion = "--drag=5 --restitution=1 --friction=0";
    let counted = |file: &String, runs: &str| bond_of(file, "6e-4", &format!("{motion} {runs}"));
    let counted = [
        counted(&narrow, "--runs=500 --duration=1"),
        counted(&narrow, "--runs=30 --duration=20"),
        counted(&wide, "--runs=60 --duration=20"),
    ];
    let constant = association(&narrow, "6e-4");
    for state in &counted {
        let found = rate(state, "on_m2_per_s") / rate(state, "off_per_s");
        assert!((found / constant - 1.0).abs() < 0.01, "{state} {constant}");
    }
    // Bound tiles come loose as often.
    let asked = format!("dock {wide} --from-bond --shaking 6e-4 {motion} --duration 5 --runs 40");
    let words = asked.split(' ').chain(["--json"]).collect::<Vec<_>>();
    let loose = json(&words)["off_rate"]["interval_per_s"].clone();
    let counted = counted
        .iter()
        .map(|state| state["off_interval_per_s"].clone());
    let all: Vec<Vec<f64>> = counted.chain([loose]).map(|it| numbers(&it)).collect();
    for (a, b) in all.iter().flat_map(|a| all.iter().map(move |b| (a, b))) {
        assert!(a[0] < b[1], "{all:?}");
    }
}

/// Without attachments in docking runs only limits are known.
/// Docking runs need no more of the table than tiles that are apart do, so that attachments are counted
/// on a large table as on a small one; and they are repeated until enough are counted.
#[test]
fn attachments_are_counted_whatever_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let [narrow, wide] = [0.4, 0.8].map(|table| small(folder.path(), table));
    let asked = "--runs=20 --duration=1 --drag=5";
    let of = |file: &str, more: &str| bond_of(file, "4e-4", &format!("{asked}{more}"));
    let [one, two] = [&narrow, &wide].map(|file| of(file, ""));
    assert_eq!(one, two);
    let count = |state: &Value| state["attachments"].as_f64().unwrap();
    let width = |state: &Value| {
        let [low, high] = [0, 1].map(|end| state["on_interval_m2_per_s"][end].as_f64().unwrap());
        (high - low) / state["on_m2_per_s"].as_f64().unwrap()
    };
    let many = of(&narrow, " --attachments=40");
    assert!(count(&one) >= 5.0 && count(&many) >= 40.0, "{one} {many}");
    assert!(width(&many) < 0.7 && width(&one) > 1.0, "{one} {many}");
}

#[test]
fn no_attachment_is_not_told_as_never() {
    let file = design(PAPER);
    let asked = "--kt 3e-3 --tiles 4 --time 60 --runs 4 --duration 0.1 --simulations 0";
    let asked: Vec<&str> = ["yield", &file]
        .into_iter()
        .chain(asked.split(' '))
        .collect();
    let text = stdout(&tilebind(&asked)).replace('\n', " ");
    for told in ["longer than", "below", "none of 4 docking runs"] {
        assert!(
            text.contains(told) && !text.contains("never"),
            "{told}: {text}"
        );
    }
    let found = json(&[&asked[..], &["--json"]].concat());
    let setting = &found["settings"][0];
    assert!(setting["mean_time_to_bond_s"].is_null());
    let least = setting["mean_time_to_bond_at_least_s"].as_f64().unwrap();
    // 3.689 attachments are the upper limit of none; each of two tiles has half of the area in which
    // they meet.
    let [apart, area] = ["apart_s", "free_area_m2"].map(|key| setting[key].as_f64().unwrap());
    let table = found["meeting_area_m2"].as_f64().unwrap() / 2.0;
    assert!(
        (least * 3.689 * area / apart / table - 1.0).abs() < 1e-3,
        "{setting}"
    );
    assert!(setting["yield_equilibrium"].as_f64().unwrap() > 0.0);
}

#[test]
fn pairs_that_bind_and_part_tell_kt() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("times.csv");
    // Exponential quantiles with means of 40 s and 10 s.
    let quantile = |k: usize| -(1.0 - (k as f64 + 0.5) / 40.0).ln();
    let rows: String = (0..40)
        .map(|k| format!("{},{}\n", 40.0 * quantile(k), 10.0 * quantile(k)))
        .collect();
    std::fs::write(&file, format!("bound_s,apart_s\n{rows}")).unwrap();
    let table = file.to_str().unwrap();
    let design = design(PAPER);
    let found = json(&[
        "calibrate",
        &design,
        "--bonds",
        table,
        "--area",
        "0.6163",
        "--json",
    ]);
    let kt = found["kT_J"].as_f64().unwrap();
    let [low, high] = numbers(&found["kT_interval_J"])[..] else {
        panic!()
    };
    assert!(low < kt && kt < high, "{found}");
    // 0.6163 m^2 for a tile of 0.1849 m^2 is 30 % coverage; all four faces of the fixed tile bind:
    // ln K + ln 4 = ln 4 there.
    let bond = json(&[
        "bond",
        &design,
        "--kt",
        &kt.to_string(),
        "--coverage",
        "0.3",
        "--json",
    ]);
    let ln_k = bond["ln_K"].as_f64().unwrap();
    assert!(ln_k.abs() < 0.03, "{ln_k}");
    std::fs::write(&file, "bound_s,apart_s\n1,x\n").unwrap();
    let output = tilebind(&["calibrate", &design, "--bonds", table]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("line 2"), "{}", stderr(&output));
}

/// Without `--area` a pair has what the rim and the fixed tile leave: of squares of side a on a table
/// of width w the mean over all angles of (w - a (|cos| + |sin|))^2, less 2 a^2 + (4 a)^2 / 2 pi.
#[test]
fn a_pair_has_the_area_that_the_rim_and_the_other_tile_leave() {
    let folder = tempfile::tempdir().unwrap();
    let (w, a) = (0.16, 0.04);
    let file = small(folder.path(), w);
    let inside = w * w - 8.0 * w * a / PI + a * a * (1.0 + 2.0 / PI);
    let area = inside - 2.0 * a * a - (4.0 * a).powi(2) / (2.0 * PI);
    let odds = association(&file, "4e-4") / area;
    let rows: String = (1..40)
        .map(|k| format!("{},{k}\n", odds * f64::from(k)))
        .collect();
    let table = folder.path().join("intervals.csv");
    std::fs::write(&table, format!("bound_s,apart_s\n{rows}")).unwrap();
    let found = json(&[
        "calibrate",
        &file,
        "--bonds",
        table.to_str().unwrap(),
        "--json",
    ]);
    assert!(
        (found["area_m2"].as_f64().unwrap() / area - 1.0).abs() < 0.01,
        "{found}"
    );
    assert!(
        (found["kT_J"].as_f64().unwrap() / 4e-4 - 1.0).abs() < 0.005,
        "{found}"
    );
}

#[test]
fn distances_of_pairs_tell_kt() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("distances.csv");
    // Half of all pairs at contact, the others anywhere else.
    let far = |k: usize| (0.21 + 0.28 * (k as f64 + 0.5) / 20.0).sqrt();
    let rows: String = (0..20).map(|k| format!("0.431\n{:.4}\n", far(k))).collect();
    std::fs::write(&file, format!("distance_m\n{rows}0.9\n")).unwrap();
    let (table, design) = (file.to_str().unwrap(), design(PAPER));
    let asked = ["calibrate", &design, "--bonds", table, "--within", "0.7"];
    let found = json(&[&asked[..], &["--json"]].concat());
    let kt = found["kT_J"].as_f64().unwrap();
    let [low, high] = numbers(&found["kT_interval_J"])[..] else {
        panic!()
    };
    // Nothing is held out of a fit to pairs.
    let output = tilebind(&[&asked[..], &["--hold-out", "5"]].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("cannot be used with '--hold-out"));
    // Bond and traps of 65 and 33 mJ hold half of all pairs at a seventh to a thirtieth of the bond.
    assert!(low < kt && kt < high, "{found}");
    assert!((2e-3..9e-3).contains(&kt), "{kt}");
    assert_eq!(found["distances"]["beyond"], 1);
    std::fs::write(
        &file,
        "distance_m\n0.5\n0.2\n".to_owned() + &"0.6\n".repeat(10),
    )
    .unwrap();
    let output = tilebind(&asked);
    assert_eq!(output.status.code(), Some(2));
    let told = stderr(&output);
    assert!(
        told.contains("line 3") && told.contains("overlap"),
        "{told}"
    );
}

#[test]
fn bound_tiles_come_loose_where_they_are_shaken_enough() {
    let file = design(PAPER);
    let rate = |kt: &str| {
        let found = json(&[
            "dock",
            &file,
            "--from-bond",
            "--shaking",
            kt,
            "--drag",
            "20",
            "--runs",
            "12",
            "--duration",
            "3",
            "--json",
        ]);
        found["off_rate"]["rate_per_s"].as_f64().unwrap()
    };
    assert_eq!(rate("1e-4"), 0.0);
    assert!(rate("0.1") > 0.1);
}

#[test]
fn overdamped_motion_is_told_beside_the_rate_of_detachment() {
    let file = design(PAPER);
    let asked = "--from-bond --overdamped --shaking 1e-2 --drag 50 --restitution 1 --friction 0 \
                 --runs 2 --duration 0.1";
    let asked: Vec<&str> = ["dock", &file]
        .into_iter()
        .chain(asked.split(' '))
        .collect();
    let found = json(&[&asked[..], &["--json"]].concat());
    let [rate, in_well] =
        ["rate_per_s", "in_well_per_s"].map(|key| found["overdamped"][key].as_f64().unwrap());
    // The way from the well to free tiles takes time.
    assert!(0.0 < rate && rate < in_well, "{found}");
}

/// Equal tiles with two binding faces make chains and rings: bonds, tiles and structures add up, with the
/// rates of the pair, and a ring of eight sectors is the only one.
#[test]
fn a_yield_of_equal_tiles_has_chains_and_rings() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string("shapes/ring-of-eight.toml").unwrap();
    // A small table, on which tiles soon meet.
    let text = text.replace("size = [1.0, 1.0]", "size = [0.2, 0.2]");
    let file = folder.path().join("ring.toml");
    std::fs::write(&file, text).unwrap();
    let file = file.display().to_string();
    let asked = "--tiles 16 --time 300 --kt 2e-4 --drag 2 --restitution 0.5 --friction 0 --runs 60 \
                 --duration 4 --simulations 100 --json";
    let run = |threads: &str| {
        let words = ["yield", &file, "--threads", threads].into_iter();
        json(&words.chain(asked.split_whitespace()).collect::<Vec<_>>())
    };
    let found = run("1");
    assert_eq!(found, run("2"));
    let rows = &found["settings"][0]["rows"];
    let of = |value: &Value| value["mean"].as_f64().unwrap();
    let [single, chains, rings] =
        ["single", "chains", "rings"].map(|key| of(&rows["tiles_in"][key]));
    assert!((single + chains + rings - 1.0).abs() < 1e-9);
    assert!(rings > 0.2 && chains > 0.05, "{rows}");
    let (mut tiles, mut bonds) = (16.0 * single, 0.0);
    for it in rows["structures"].as_array().unwrap() {
        let size = it["size"].as_f64().unwrap();
        tiles += size * of(it);
        match it["kind"].as_str().unwrap() {
            "ring" => {
                assert_eq!(size, 8.0);
                bonds += size * of(it);
            }
            kind => {
                assert!(kind == "chain" && (2.0..=8.0).contains(&size), "{it}");
                bonds += (size - 1.0) * of(it);
            }
        }
    }
    assert!((tiles - 16.0).abs() < 1e-9, "{tiles}");
    assert!((bonds - of(&rows["bonds"])).abs() < 1e-9, "{bonds}");
    assert_eq!(rows["longest_chain"], 8);
    assert_eq!(rows["closures"].as_array().unwrap().len(), 1);
    assert_eq!(found["structures"], rows["structures"]);
}
