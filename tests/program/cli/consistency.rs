//! Summary, page, tables, report and pictures of one analysis agree: of a caged bond, of a design
//! without a bond and of one without traps.

use std::path::Path;

use serde_json::Value;

use super::tilebind;
use crate::program::{stderr, stdout};

/// One analysis in all its forms.
struct Told {
    summary: String,
    report: Value,
    page: Value,
    states: Vec<Vec<String>>,
    barriers: Vec<Vec<String>>,
    /// Texts of the pictures of the graph and of the profiles.
    graph: String,
    profiles: Option<String>,
}

fn told(design: &str) -> Told {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let quick = ["--milestones", "600", "--far-starts", "40"];
    let output = tilebind(&[&["analyse", design, "--out", out], &quick[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let page = read("report.html");
    let (_, data) = page.split_once("id=\"data\">").unwrap();
    let (data, _) = data.split_once("</script>").unwrap();
    let profiles = folder.path().join("pictures/profiles.svg");
    Told {
        summary: stdout(&output),
        report: serde_json::from_str(&read("report.json")).unwrap(),
        page: serde_json::from_str(data).unwrap(),
        states: rows(&folder.path().join("states.csv")),
        barriers: rows(&folder.path().join("barriers.csv")),
        graph: read("pictures/disconnectivity.svg"),
        profiles: std::fs::read_to_string(profiles).ok(),
    }
}

/// All records of a table, its header first.
fn rows(path: &Path) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_path(path)
        .unwrap();
    let text = |record: csv::StringRecord| record.iter().map(str::to_owned).collect();
    reader.records().map(|row| text(row.unwrap())).collect()
}

/// The cell of a row in the column with a name.
fn cell<'a>(rows: &'a [Vec<String>], row: usize, column: &str) -> &'a str {
    let place = rows[0].iter().position(|name| name == column);
    &rows[row][place.unwrap_or_else(|| panic!("no column {column}"))]
}

impl Told {
    /// The page's fact with a name: its value and its note.
    fn fact(&self, name: &str) -> Option<String> {
        let facts = self.page["facts"].as_array().unwrap();
        let fact = facts.iter().find(|fact| fact["name"] == name)?;
        let text = |key: &str| fact[key].as_str().unwrap().to_owned();
        Some(text("value") + "; " + &text("note"))
    }

    /// Checks for every design: names and counts of states agree in all forms.
    fn agrees(&self) {
        let states = self.report["states"].as_array().unwrap();
        assert_eq!(states.len() + 1, self.states.len());
        let kinds = states.iter().filter(|state| state["id"] == state["class"]);
        let kinds: Vec<&str> = kinds.map(|state| state["name"].as_str().unwrap()).collect();
        for (id, state) in states.iter().enumerate() {
            assert_eq!(
                cell(&self.states, id + 1, "name"),
                state["name"].as_str().unwrap()
            );
            let drawn = &self.page["landscape"]["states"][id];
            assert!(
                drawn["name"]
                    .as_str()
                    .unwrap()
                    .ends_with(state["name"].as_str().unwrap())
            );
            let caged = &state["escape"]["caged"];
            let listed = cell(&self.states, id + 1, "caged") == "true";
            assert_eq!(caged.as_bool().unwrap_or(false), listed, "{id}");
            let way = state["escape"]["forward_J"].as_f64().is_some();
            assert_eq!(
                way,
                !cell(&self.states, id + 1, "escape_J").is_empty(),
                "{id}"
            );
        }
        let listed = self.page["tables"][0]["rows"].as_array().unwrap();
        assert_eq!(listed.len(), kinds.len());
        for row in listed {
            assert!(kinds.contains(&row[0][1].as_str().unwrap()), "{row}");
        }
        let barriers = self.report["barriers"].as_array().unwrap();
        assert_eq!(barriers.len() + 1, self.barriers.len());
        for (k, barrier) in barriers.iter().enumerate() {
            let caged = barrier["caged"].to_string();
            assert_eq!(cell(&self.barriers, k + 1, "caged"), caged);
        }
        for word in ["misbound", "no path found"] {
            assert!(
                !self.summary.contains(word) && !self.graph.contains(word),
                "{word}"
            );
        }
    }
}

#[test]
fn a_caged_bond_is_caged_everywhere() {
    let told = told("shapes/dovetail.toml");
    told.agrees();
    let escape = &told.report["states"][0]["escape"];
    assert_eq!(escape["caged"], true);
    assert!(escape["saddle_energy_J"].is_null() && escape["to"] == "free");
    let row = told.summary.lines().find(|line| line.starts_with("bond A"));
    assert!(row.unwrap().contains("caged, proved"), "{}", told.summary);
    let fact = told.fact("barrier out of the bond").unwrap();
    assert!(fact.starts_with("caged, proved"), "{fact}");
    assert!(told.graph.contains("caged, proved"));
    let apart = told.page["landscape"]["tree"].as_array().unwrap();
    let says = |graph: &Value| graph.as_str().unwrap().contains("caged, proved");
    assert!(apart.iter().all(says) && !apart.is_empty());
    let ways = told.profiles.unwrap_or_default();
    assert!(!ways.contains("bond A \u{2192} free"));
}

#[test]
fn a_missing_bond_is_missing_everywhere() {
    let text = std::fs::read_to_string("tests/designs/good/flat.toml").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("repelled.toml");
    // Equal poles face each other on the target faces.
    let repelled = text.replace("NSSS", "NNNN").replace("NNNS", "NNNN");
    std::fs::write(&file, repelled.replace("west = { mates = \"east\" }", "")).unwrap();
    let told = told(file.to_str().unwrap());
    told.agrees();
    assert!(told.report["bound"]["state"].is_null());
    assert!(told.summary.contains("no bond"), "{}", told.summary);
    assert!(told.fact("no bond").is_some() && told.fact("bond").is_none());
    let states = told.report["states"].as_array().unwrap();
    assert!(states.iter().all(|state| state["kind"] == "misbound"));
    assert!(states.iter().all(|state| state["name"] != "A"));
    assert!(!told.graph.contains("bond A") && !told.summary.contains("bond A"));
}

#[test]
fn missing_traps_are_missing_everywhere() {
    let told = told("shapes/shielded-nearest-face.toml");
    told.agrees();
    let states = told.report["states"].as_array().unwrap();
    assert!(states.iter().all(|state| state["kind"] == "bound"));
    assert!(told.summary.contains("no traps"), "{}", told.summary);
    assert!(told.fact("traps").unwrap().starts_with("none"));
    assert_eq!(told.page["tables"][0]["rows"].as_array().unwrap().len(), 1);
    assert!(!told.graph.contains("trap ") && told.graph.contains("bond A"));
}
