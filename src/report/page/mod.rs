//! `report.html`: results as one self-contained page.
//!
//! A [`Page`] has facts, an interactive landscape, pictures and sortable tables. It is written as
//! one file: markup, style, script, and the data as JSON. A content security policy allows only the
//! page's own script and style, identified by their SHA-256, and no other resources; the page opens
//! from disk. The same contents give the same bytes.

mod charts;
mod crowd;
mod html;
pub(super) mod landscape;
pub(super) mod meetings;
mod numbers;
mod packed;
pub(crate) mod pathways;
mod thumbnail;

use serde::Serialize;
use serde_json::Value;

use html::{escaped, filled, hash};

pub use charts::Charts;
pub use crowd::Crowd;
pub use html::CITATION;
pub use landscape::Landscape;
pub use meetings::Meetings;
pub use pathways::Played;

const MARKUP: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
/// In the order of their dependencies.
const SCRIPTS: [&str; 13] = [
    include_str!("data.js"),
    include_str!("draw.js"),
    include_str!("maps.js"),
    include_str!("tiles.js"),
    include_str!("profile.js"),
    include_str!("tree.js"),
    include_str!("tables.js"),
    include_str!("charts.js"),
    include_str!("sweep.js"),
    include_str!("meetings.js"),
    include_str!("crowd.js"),
    include_str!("glossary.js"),
    include_str!("main.js"),
];

/// The contents of a page.
#[must_use]
#[derive(Clone, Debug, Serialize)]
pub struct Page {
    /// The heading.
    pub title: String,
    /// A line below it.
    pub subtitle: String,
    /// The main facts.
    pub facts: Vec<Fact>,
    /// The energy over configurations, with pathways; `None` if there is not exactly one landscape.
    pub landscape: Option<Landscape>,
    /// The points of a sweep; `None` elsewhere.
    pub charts: Option<Charts>,
    /// All pairs of faces of a set of words; `None` elsewhere.
    pub meetings: Option<Meetings>,
    /// The animation of many tiles on a table; `None` elsewhere.
    pub crowd: Option<Crowd>,
    /// Pictures, in order.
    pub pictures: Vec<Illustration>,
    /// Tables, in order.
    pub tables: Vec<SortableTable>,
    /// Notes, one paragraph each.
    pub notes: Vec<String>,
    /// How it was made: version, seed, checksum.
    pub origin: String,
    /// The command line that makes the same page; empty if it is not known.
    pub command: String,
    /// The citation, as BibTeX.
    pub citation: &'static str,
    /// The files that it links to, relative to its folder.
    pub files: Vec<String>,
}

/// A quantity in a few words.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fact {
    /// Its name.
    pub name: String,
    /// Its value, with the unit.
    pub value: String,
    /// A note in small type; may be empty.
    pub note: String,
}

/// A picture, as an SVG document.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Illustration {
    /// Its title.
    pub title: String,
    /// Whether the picture contains its title.
    pub is_titled: bool,
    /// A complete document, embedded in the page unchanged.
    pub svg: String,
    /// The same for a phone's screen; empty if another picture contains it.
    pub narrow: String,
}

/// A sortable table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SortableTable {
    /// Its title.
    pub title: String,
    /// A note on its rows.
    pub note: String,
    /// The columns, in order.
    pub columns: Vec<Column>,
    /// One value per column: numbers (in SI units), texts, null, or a pair of a sort key and the
    /// text to show.
    pub rows: Vec<Vec<Value>>,
    /// For each row the state shown when it is clicked; empty for none.
    pub states: Vec<usize>,
    /// For each row the pathway selected when it is clicked; empty for none.
    pub paths: Vec<Option<usize>>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Column {
    /// The heading.
    pub name: String,
    /// Its meaning, shown under the pointer; may be empty.
    pub meaning: &'static str,
}

impl SortableTable {
    /// The table of settings that reproduce a result.
    pub(super) fn of_settings(settings: Vec<(String, Value)>) -> Self {
        let column = |name: &str| Column {
            name: name.to_owned(),
            meaning: "",
        };
        let rows = settings.into_iter();
        Self {
            title: "How it was computed".to_owned(),
            note: String::new(),
            columns: vec![column("setting"), column("value")],
            rows: rows
                .map(|(name, value)| vec![Value::from(name), value])
                .collect(),
            states: Vec::new(),
            paths: Vec::new(),
        }
    }
}

impl Page {
    /// An empty page with a title.
    pub(super) fn titled(title: String) -> Self {
        Self {
            title,
            subtitle: String::new(),
            facts: Vec::new(),
            landscape: None,
            charts: None,
            meetings: None,
            crowd: None,
            pictures: Vec::new(),
            tables: Vec::new(),
            notes: Vec::new(),
            origin: String::new(),
            command: String::new(),
            citation: CITATION,
            files: Vec::new(),
        }
    }

    /// Adds the command line that makes it.
    pub fn made_by(self, command: &str) -> Self {
        let command = command.to_owned();
        Self { command, ..self }
    }

    /// Adds links to files, relative to its folder.
    pub fn beside<'a>(self, files: impl IntoIterator<Item = &'a String>) -> Self {
        let files = files.into_iter().cloned().collect();
        Self { files, ..self }
    }

    /// The page as a file.
    ///
    /// # Panics
    /// Never: plain values with string keys can be serialised.
    pub fn to_html(&self) -> String {
        let data = serde_json::to_string(self).expect("plain values are written");
        let script = format!("\"use strict\";\n{}", SCRIPTS.concat());
        let parts = [
            ("{title}", escaped(&self.title)),
            ("{style-hash}", hash(STYLE)),
            ("{script-hash}", hash(&script)),
            ("{style}", STYLE.to_owned()),
            ("{script}", script),
            // In JSON `<` occurs only within strings, where its escape is equivalent.
            ("{data}", data.replace('<', "\\u003c")),
        ];
        filled(MARKUP, &parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(title: &str) -> Page {
        Page::titled(title.into())
    }

    #[test]
    fn no_text_of_a_design_leaves_its_place() {
        let html = page("</script><img src=x>{script}&").to_html();
        assert!(!html.contains("<img"));
        assert!(html.contains("<title>&lt;/script>&lt;img src=x>{script}&amp;</title>"));
        assert_eq!(html.matches("</script>").count(), 2);
    }

    #[test]
    fn the_policy_knows_the_script_and_forbids_the_rest() {
        let html = page("a").to_html();
        let script = html.split("<script>").nth(1).unwrap();
        let script = script.split("</script>").next().unwrap();
        assert!(html.contains(&format!("script-src {}", hash(script))));
        assert!(html.contains("default-src 'none'"));
        for word in ["http://", "https://", "url(", "@import", "eval("] {
            let own = html.replace("http://www.w3.org/2000/svg", "");
            assert!(!own.contains(word), "{word}");
        }
    }
}
