//! The document of every job agrees in all its forms.

use std::collections::{HashMap, HashSet};

use serde_json::Value;
use tilebind::Design;
use tilebind::comparison::quantity::QUANTITIES;
use tilebind::comparison::{self, Assessment};
use tilebind::docking::Paths;
use tilebind::dynamics::docking::{DockingSettings, dock};
use tilebind::observer::Silent;
use tilebind::pipeline::{self, Certify, Request};
use tilebind::report::analysis::{self, Extent};
use tilebind::report::comparison::Comparison;
use tilebind::report::document::{Cell, Document, Drawing, Table, Unit};
use tilebind::report::plots::{Scene, Sheet};
use tilebind::report::{docking, yields as of_yields};
use tilebind::request::of_keywords;
use tilebind::yields::{self, yields};

fn design() -> Design {
    Design::load("shapes/tab-20mm.toml".as_ref()).unwrap()
}

fn few() -> Request {
    Request::without_proofs(1).surveyed(500, 20)
}

fn keywords(words: &[(&str, &str)]) -> Vec<(String, Vec<String>)> {
    let owned = |(key, value): &(&str, &str)| ((*key).to_owned(), vec![(*value).to_owned()]);
    words.iter().map(owned).collect()
}

/// Two numbers that are the same to the ten digits of a file.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(f64::MIN_POSITIVE)
}

/// The numbers of a table's file are those of the report.
fn numbers_agree(table: &Table, rows: &Value) {
    let text = table.csv();
    let mut lines = text.lines();
    let keys: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(lines.clone().count(), rows.as_array().unwrap().len());
    for (line, row) in lines.zip(rows.as_array().unwrap()) {
        // Texts may hold commas in quotes; those of these tables do not.
        for (key, cell) in keys.iter().zip(line.split(',')) {
            match row.get(*key) {
                Some(Value::Number(number)) => {
                    let told: f64 = cell.parse().unwrap();
                    assert!(
                        same(told, number.as_f64().unwrap()),
                        "{key}: {cell} {number}"
                    );
                }
                Some(Value::Null) => assert_eq!(cell, "", "{key}"),
                _ => {}
            }
        }
    }
}

/// Checks for any document.
fn check(document: &Document) {
    assert!(!document.title.is_empty() && document.answer.contains(char::is_alphabetic));
    let report: Value = serde_json::from_str(&document.report()).unwrap();
    let (text, markdown) = (document.text(None), document.markdown());
    let html = document.html("tilebind").unwrap();
    // Wherever lines end.
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words(&text).starts_with(&words(&document.answer)), "{text}");
    assert!(!document.facts().is_empty() || !document.tables().is_empty());
    let mut files = HashSet::new();
    for table in document.tables() {
        let mut keys = HashSet::new();
        for head in table
            .heads
            .iter()
            .filter(|head| head.is_csv && table.file.is_some())
        {
            assert!(
                !head.key.is_empty() && keys.insert(head.key.clone()),
                "{}",
                head.key
            );
        }
        for (k, head) in table.heads.iter().enumerate() {
            let unit = Unit::of_key(&head.key);
            assert!(
                head.unit == unit || head.unit == Unit::Share,
                "{}",
                head.key
            );
            // Displayed values have a unit, once: in the cell or in the heading.
            let shown = head.is_viewed && table.is_viewed;
            let (heading, cells) = table.column(k);
            for cell in cells.iter().filter(|_| shown) {
                let symbol = head.unit.symbol();
                let is_number = cell.contains(|c: char| c.is_ascii_digit());
                let of_all = heading.ends_with(&format!("{symbol})"));
                let has_unit = match symbol {
                    "" | "s" | "rad" => true,
                    symbol => !is_number || of_all != cell.ends_with(symbol),
                };
                assert!(has_unit, "{heading}: {cell}");
            }
        }
        for k in table.viewed().filter(|_| table.is_viewed) {
            for (row, cell) in table.column(k).1.into_iter().enumerate() {
                let plain: String = cell.chars().filter(|c| !"<>&|\"".contains(*c)).collect();
                if plain != cell || cell.is_empty() {
                    continue;
                }
                if table.is_paged && cell != "-" {
                    assert!(html.contains(&cell), "{cell}");
                }
                if table.is_printed && table.heads[k].is_printed && row < table.listed {
                    assert!(text.contains(&cell), "{cell}\n{text}");
                    assert!(markdown.contains(&cell), "{cell}");
                }
            }
        }
        if let Some(file) = table.file {
            assert!(files.insert(file), "{file} is there twice");
            if table.is_data {
                numbers_agree(table, &report[&*table.key]);
            }
        }
    }
    // Pictures have all their forms, and numbers.
    let sheet = Sheet::for_print(120.0, 7.0).unwrap();
    let (drawn, whole) = document.files(&sheet, "tilebind");
    whole.unwrap();
    let mut forms: HashMap<&str, Vec<&str>> = HashMap::new();
    for name in drawn
        .keys()
        .filter_map(|name| name.strip_prefix("pictures/"))
    {
        let (stem, form) = name.rsplit_once('.').unwrap();
        forms.entry(stem).or_default().push(form);
    }
    for (stem, mut forms) in forms {
        forms.sort_unstable();
        // Of a picture on several pages the first has the numbers of all.
        let is_first = !stem.ends_with(|c: char| c.is_ascii_digit());
        let numbers = usize::from(!is_first);
        assert_eq!(forms, ["csv", "pdf", "png", "svg"][numbers..], "{stem}");
    }
}

/// A failing picture must not discard results.
#[test]
fn a_picture_that_breaks_down_takes_nothing_else_along() {
    let (design, problem) = (design(), design().problem());
    let settings = DockingSettings {
        runs: 5,
        duration: 0.5,
        ..DockingSettings::default()
    };
    let found = dock(&problem, &settings, &|| ()).unwrap();
    let paths = Paths::new(&problem, &found, None).unwrap();
    let mut document = docking::document((&design, &problem), &found, Some(&paths));
    let (all, _) = document.files(&Sheet::SCREEN, "tilebind");
    let broken = Drawing::new("broken", |_| panic!("as it should"));
    document.pictures.insert(0, broken);
    let (files, whole) = document.files(&Sheet::SCREEN, "tilebind");
    assert!(whole.unwrap_err().to_string().contains("(broken)"));
    assert_eq!(files, all);
}

/// All trajectories may start alike.
#[test]
fn starts_of_one_value_are_drawn() {
    let (design, problem) = (design(), design().problem());
    for (orientation, speed) in [
        (0.5, [0.5, 0.5]),
        (0.5, [0.0, 0.0]),
        (0.0, [0.2, 0.6]),
        (0.0, [0.5; 2]),
    ] {
        let mut settings = DockingSettings {
            runs: 40,
            duration: 0.5,
            ..DockingSettings::default()
        };
        settings.starts.orientation = orientation;
        settings.starts.speed = speed;
        let found = dock(&problem, &settings, &|| ()).unwrap();
        let paths = Paths::new(&problem, &found, None).unwrap();
        let document = docking::document((&design, &problem), &found, Some(&paths));
        let (files, whole) = document.files(&Sheet::SCREEN, "tilebind");
        whole.unwrap();
        assert!(files.keys().any(|name| name.ends_with("chances.svg")));
    }
}

#[test]
fn an_analysis_says_the_same_in_all_forms() {
    let design = design();
    let found = pipeline::analyse(&design, &few(), &Silent);
    let scene = Scene::new(&design, &found.problem, &found.catalogue);
    check(&analysis::document(
        &design,
        &found,
        &scene,
        Extent::Full,
        1.0,
    ));
}

#[test]
fn certified_are_bounds_of_the_barrier_in_its_unit() {
    let design = design();
    let settings = Request {
        certify: Certify::of(f64::INFINITY),
        certify_cells: 500,
        ..few()
    };
    let found = pipeline::analyse(&design, &settings, &Silent);
    let scene = Scene::new(&design, &found.problem, &found.catalogue);
    let document = analysis::document(&design, &found, &scene, Extent::Full, 1.0);
    let tables = document.tables();
    let of_page = tables
        .iter()
        .find(|table| table.title == "Barriers")
        .unwrap();
    let of_summary = tables
        .iter()
        .find(|table| table.is_printed && table.is_viewed)
        .unwrap();
    let mut proved = 0;
    for (table, barrier) in [(of_page, "barrier"), (of_summary, "escape")] {
        let place = |name: &str| {
            table
                .heads
                .iter()
                .position(|head| head.name == name)
                .unwrap()
        };
        let [barrier, certified] = [barrier, "certified"].map(place);
        let unit = |k: usize| table.column(k).0.split_once(" (").unwrap().1.to_owned();
        assert_eq!(unit(barrier), unit(certified));
        for row in &table.rows {
            if let (Cell::Number(climb), Cell::Interval([Some(low), Some(high)])) =
                (&row[barrier].0, &row[certified].0)
            {
                assert!(
                    low <= climb && *climb <= high * (1.0 + 1e-9),
                    "{low} {climb} {high}"
                );
                proved += 1;
            }
        }
    }
    assert!(proved >= 4, "{proved}");
}

#[test]
fn a_comparison_says_the_same_in_all_forms() {
    let designs = ["tab-10mm", "tab-20mm"].map(|name| {
        let design = Design::load(format!("shapes/{name}.toml").as_ref()).unwrap();
        Assessment::new(&design, &pipeline::analyse(&design, &few(), &Silent))
    });
    let settings = comparison::Thoroughness::default();
    check(&Comparison::new(&designs, &QUANTITIES[0], settings).document());
}

#[test]
fn docking_says_the_same_in_all_forms() {
    let (design, problem) = (design(), design().problem());
    let settings = DockingSettings {
        runs: 20,
        duration: 1.0,
        ..DockingSettings::default()
    };
    let found = dock(&problem, &settings, &|| ()).unwrap();
    let paths = Paths::new(&problem, &found, None).unwrap();
    check(&docking::document(
        (&design, &problem),
        &found,
        Some(&paths),
    ));
}

#[test]
fn a_yield_says_the_same_in_all_forms() {
    let design = design();
    let asked = [
        ("kt", "3e-3,4e-3"),
        ("tiles", "4"),
        ("time", "60"),
        ("runs", "20"),
        ("duration", "2"),
        ("simulations", "20"),
    ];
    let request: yields::Request = of_keywords(keywords(&asked)).unwrap();
    let found = yields(&design, &request, &Silent).unwrap();
    check(&of_yields::document(&design, &request, &found));
}
