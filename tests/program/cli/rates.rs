//! `tilebind rates` on the paper's tile.

use super::equal::sector;
use super::{json, refused, tilebind};
use crate::program::stdout;

const SLID: [&str; 8] = [
    "rates",
    "shapes/paper-tile.toml",
    "--kt",
    "3.037e-3",
    "--start",
    "0.43,-0.04,0",
    "--free-at",
    "0.75",
];

#[test]
fn an_exit_is_told_with_its_ends_and_scales_with_the_drag() {
    let entry = json(
        &[
            &SLID[..],
            &["--drag", "50", "--basin-energy", "-0.03", "--json"],
        ]
        .concat(),
    );
    let number = |path: &str| entry.pointer(path).and_then(|x| x.as_f64()).unwrap();
    // kT / (50 /s 0.1 kg)
    let diffusion = number("/diffusion_m2_s");
    assert!((diffusion - 6.074e-4).abs() < 1e-9);
    assert!((number("/mean_exit_s") * diffusion - 0.0176).abs() < 0.0004);
    assert!((number("/exits/bound") - 0.405).abs() < 0.01);
    assert!((number("/exits/bound") + number("/exits/free") - 1.0).abs() < 1e-12);
    assert!(entry["mean_exit_bounds_s"].is_null());
    assert!((0.0..0.05).contains(&number("/mean_exit_error")));
    assert!((0.0..0.05).contains(&number("/mesh/of_basins")));
    assert_eq!(
        (number("/basin_energy_J"), number("/free_at_m")),
        (-0.03, 0.75)
    );

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("exit");
    let more = ["--drag", "100", "--out", out.to_str().unwrap()];
    let text = stdout(&tilebind(&[&SLID[..], &more].concat()));
    // Wherever lines end.
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for told in [
        "paper-tile",
        "bound first",
        "750.0 mm apart",
        "-32.73 mJ",
        "100 /s",
        "estimated",
    ] {
        assert!(text.contains(told), "{told} in\n{text}");
    }
    for name in [
        "report.html",
        "report.json",
        "meshes.csv",
        "pictures/meshes.png",
    ] {
        assert!(out.join(name).is_file(), "{name}");
    }
}

/// Elastic collisions and strong drag: moving tiles have a temperature and leave like overdamped
/// ones. Weak drag and lossy collisions: they have none, and the ratio is only a bound if some runs
/// are abandoned.
#[test]
fn moving_tiles_tell_where_overdamped_rates_hold() {
    let ways = ["--start", "0.43,-0.04,0", "--free-at", "0.65"];
    let check = |more: &[&str]| {
        let common = [
            "rates",
            "shapes/paper-tile.toml",
            "--kt",
            "6e-3",
            "--check",
            "40",
            "--json",
        ];
        json(&[&common[..], &ways, more].concat())["check"].clone()
    };
    let of = |check: &serde_json::Value, key: &str| {
        check
            .pointer(&format!("/{key}"))
            .and_then(|x| x.as_f64())
            .expect("a number")
    };
    let good = check(&[]);
    assert_eq!(good["has_temperature"], true);
    assert_eq!(good["runs"]["given_up"], 0);
    let far = (of(&good, "ratio") - 1.0) / of(&good, "ratio_error");
    assert!(far.abs() < 3.5, "{good}");
    let cold = check(&["--drag", "2", "--restitution", "0"]);
    assert_eq!(cold["has_temperature"], false, "{cold}");
    assert!(of(&cold, "runs/given_up") > 10.0, "{cold}");
    assert!(of(&cold, "ratio") > 10.0, "{cold}");
}

#[test]
fn a_start_in_the_bond_is_refused_with_what_mends_it() {
    let asked = ["--kt", "3e-3", "--start", "0.43,0,0"];
    refused(
        &[&["rates", "shapes/paper-tile.toml"][..], &asked].concat(),
        &["--basin-energy"],
    );
}

/// A basin below the bond holds nothing, whatever is asked for.
#[test]
fn a_basin_below_the_bond_is_refused() {
    let asked = [
        "rates",
        "shapes/tab-20mm.toml",
        "--kt",
        "3e-3",
        "--basin-energy",
        "-1",
    ];
    for start in [&[][..], &["--start", "0.45,0,0"]] {
        refused(&[&asked[..], start].concat(), &["--basin-energy", "-1"]);
    }
}

/// Bounds on a mesh proved nothing; whoever asks for them learns what there is instead.
#[test]
fn bounds_are_refused_with_what_there_is_instead() {
    let kt = ["rates", "shapes/paper-tile.toml", "--kt", "3e-3"];
    for more in [&[][..], &["--start", "0.43,-0.04,0"]] {
        refused(
            &[&kt[..], more, &["--certify", "0.1"]].concat(),
            &["no longer have bounds", "--check"],
        );
    }
}

#[test]
fn a_shaking_that_no_table_has_is_refused() {
    for command in ["rates", "bond", "yield"] {
        for kt in ["0", "-1e-3", "nan", "1e300", "1e-300"] {
            refused(
                &[command, "shapes/paper-tile.toml", &format!("--kt={kt}")],
                &["a kT between"],
            );
        }
    }
}

#[test]
fn shaking_that_nothing_holds_or_leaves_at_is_refused_at_once() {
    let tiles = ["--tiles", "10", "--time", "600"];
    for (command, kt, more, said) in [
        ("yield", "1e3", &tiles[..], "choose a --kt below 32.7 mJ"),
        ("yield", "1e2,1e3", &tiles, "kT = 100.0 J"),
        ("yield", "1e-9", &tiles, "choose a larger --kt"),
        ("rates", "1e-9", &[], "choose a larger --kt"),
        (
            "rates",
            "5e-5",
            &["--start", "0.43,-0.04,0"],
            "the start is 321 kT deep",
        ),
    ] {
        refused(
            &[&[command, "shapes/paper-tile.toml", "--kt", kt][..], more].concat(),
            &[said],
        );
    }
}

/// A dovetail does not come out sideways: contact proves this, so the rates are 0 with certainty.
#[test]
fn of_a_bond_that_contact_shuts_in_the_rates_are_known_to_be_none() {
    let dovetail = ["rates", "shapes/dovetail.toml", "--kt", "3e-3"];
    let entry = json(&[&dovetail[..], &["--json"]].concat());
    for rate in entry["rates"].as_array().unwrap() {
        assert_eq!(rate["value_per_s"], 0.0, "{rate}");
        assert!(rate["error"].is_null(), "{rate}");
        assert!(rate["first"].is_null() && rate["mean_first_passage_s"].is_null());
    }
    let bond = &entry["places"][0];
    assert_eq!(bond["way_out"], "blocked");
    assert_eq!(bond["leaving_per_s"], 0.0);
    assert!(bond["mean_exit_s"].is_null());
    let output = tilebind(&dovetail);
    let text = stdout(&output);
    assert!(text.contains("tiles never bind or unbind: contact blocks every path"));
    assert!(!text.contains("at most"), "{text}");
}

/// Square teeth slide into each other without play: no mesh has a path there, and none is excluded.
#[test]
fn of_a_bond_without_a_known_way_nothing_is_claimed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("rates");
    let entry = json(&[
        "rates",
        "shapes/square-teeth-10mm.toml",
        "--kt",
        "8.2e-3",
        "--out",
        out.to_str().unwrap(),
        "--json",
    ]);
    let bond = &entry["places"][0];
    assert_eq!(bond["way_out"], "not found");
    for key in ["leaving_per_s", "mean_exit_s", "occupation", "inside"] {
        assert!(bond[key].is_null(), "{key}: {bond}");
    }
    let rates = entry["rates"].as_array().unwrap();
    assert_eq!(rates.len(), 2);
    for rate in rates {
        for key in ["value_per_s", "error", "first", "mean_first_passage_s"] {
            assert!(rate[key].is_null(), "{key}: {rate}");
        }
    }
    assert!(entry["mesh"]["error"].is_null());
    let table = std::fs::read_to_string(out.join("rates.csv")).unwrap();
    assert!(table.contains("\nbond A,free,,,,,,"), "{table}");
    for at in entry["over_kT"].as_array().unwrap() {
        assert!(at["leaving_per_s"]["bond A"].is_null(), "{at}");
    }
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("no path into the bond was found"));
    for wrong in [" 0 /s", "inf", "NaN", "e0 %"] {
        assert!(!page.contains(&format!("\"{wrong}")), "{wrong}");
    }
}

#[test]
fn rates_between_the_states_balance_in_detail() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("rates");
    let entry = json(&[
        "rates",
        "shapes/paper-tile.toml",
        "--kt",
        "3e-3",
        "--traps",
        "1",
        "--out",
        out.to_str().unwrap(),
        "--json",
    ]);
    let places = entry["places"].as_array().unwrap();
    let names: Vec<&str> = places
        .iter()
        .map(|place| place["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["bond A", "trap B", "free"]);
    let share = |name: &serde_json::Value| {
        let place = places.iter().find(|place| place["name"] == *name).unwrap();
        place["occupation"].as_f64().unwrap()
    };
    let all: f64 = places.iter().map(|place| share(&place["name"])).sum();
    assert!((all - 1.0).abs() < 1e-9);
    let rates = entry["rates"].as_array().unwrap();
    assert_eq!(rates.len(), 6);
    let flow =
        |rate: &serde_json::Value| share(&rate["from"]) * rate["value_per_s"].as_f64().unwrap();
    for rate in rates {
        assert!(rate["value_per_s"].as_f64().unwrap() > 0.0, "{rate}");
        let error = rate["error"].as_f64().unwrap();
        assert!((0.0..0.05).contains(&error), "{rate}");
        let is_back =
            |other: &&serde_json::Value| other["from"] == rate["to"] && other["to"] == rate["from"];
        let back = rates.iter().find(is_back).unwrap();
        assert!(
            (flow(rate) / flow(back) - 1.0).abs() < 1e-9,
            "{rate} {back}"
        );
    }
    let table = std::fs::read_to_string(out.join("rates.csv")).unwrap();
    assert!(table.starts_with("from,to,value_per_s,error,"));
    assert_eq!(table.lines().count(), 7);
    let table = std::fs::read_to_string(out.join("occupation.csv")).unwrap();
    assert_eq!(table.lines().count(), 4);
    let report = std::fs::read_to_string(out.join("report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["places"], entry["places"]);
    // Rates grow with kT; far below the barrier the corner's closed form is much the same.
    let course = report["over_kT"].as_array().unwrap();
    let of = |at: &serde_json::Value, key: &str| at[key]["bond A"].as_f64().unwrap();
    let leaving: Vec<f64> = course.iter().map(|at| of(at, "leaving_per_s")).collect();
    assert!(leaving.len() > 3 && leaving.is_sorted(), "{leaving:?}");
    let off = of(&course[0], "corner_leaving_per_s") / leaving[0];
    assert!((0.8..1.4).contains(&off), "{off}");
    for name in [
        "report.html",
        "committor.csv",
        "pictures/committor.svg",
        "pictures/rates.svg",
    ] {
        assert!(out.join(name).is_file(), "{name}");
    }
}

/// Sectors drawn about the middle of their ring, whose reference points coincide in the bond, have the rates
/// of the same sectors drawn about their own centres.
#[test]
fn rates_do_not_depend_on_where_a_drawing_has_its_origin() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sector.toml").display().to_string();
    let of = |away: f64| {
        std::fs::write(&file, sector(away)).unwrap();
        let rates = json(&["rates", &file, "--kt", "4e-4", "--traps", "0", "--json"]);
        let of_rates = |k: usize| rates["rates"][k]["value_per_s"].as_f64().unwrap();
        (
            of_rates(0),
            of_rates(1),
            rates["places"][1]["free_at_m"].clone(),
        )
    };
    let about_ring = of(0.0);
    let own = of(0.049);
    let near = |a: f64, b: f64| a > 0.0 && (a / b - 1.0).abs() < 0.05;
    assert!(
        near(about_ring.0, own.0) && near(about_ring.1, own.1),
        "{about_ring:?} {own:?}"
    );
    assert!((about_ring.2.as_f64().unwrap() / own.2.as_f64().unwrap() - 1.0).abs() < 1e-6);
}
