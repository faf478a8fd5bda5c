//! `report.html`: results as one page that needs nothing but a browser.
//!
//! A [`Page`] holds what is to be seen: facts, a landscape to move about in, pictures, tables that
//! sort. It is written as one file: markup, style, script, and the data as JSON. A content security
//! policy lets the page run its own script and style, known by their SHA-256, and load nothing at
//! all; it opens from disk. The same page comes out as the same bytes.

mod charts;
mod crowd;
mod html;
pub(super) mod landscape;
pub(super) mod meetings;
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
/// In the order in which they build on each other.
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

/// What a page shows.
#[derive(Clone, Debug, Serialize)]
pub struct Page {
    /// The heading.
    pub title: String,
    /// A line below it.
    pub subtitle: String,
    /// What to know first.
    pub facts: Vec<Fact>,
    /// The energy over configurations, with pathways; `None` where there is no one landscape.
    pub landscape: Option<Landscape>,
    /// The points of a sweep; `None` elsewhere.
    pub charts: Option<Charts>,
    /// All faces of a set of words against all; `None` elsewhere.
    pub meetings: Option<Meetings>,
    /// Many tiles on a table, to be played; `None` elsewhere.
    pub crowd: Option<Crowd>,
    /// Pictures, in order.
    pub pictures: Vec<Illustration>,
    /// Tables, in order.
    pub tables: Vec<Table>,
    /// What else to know, a paragraph each.
    pub notes: Vec<String>,
    /// How it was made: version, seed, checksum.
    pub origin: String,
    /// The command line that makes the same page; empty where it is not known.
    pub command: String,
    /// What to cite, as BibTeX.
    pub citation: &'static str,
    /// The files beside it that it links to, by their names from its folder.
    pub files: Vec<String>,
}

/// A quantity told in a few words.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fact {
    /// What it is.
    pub name: String,
    /// Its value, with the unit.
    pub value: String,
    /// What to know of it, in small letters; may be empty.
    pub note: String,
}

/// A picture, as an SVG document.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Illustration {
    /// What it shows.
    pub title: String,
    /// Whether it says so itself.
    pub is_titled: bool,
    /// A whole document, put into the page as it is.
    pub svg: String,
    /// The same for the screen of a phone; empty where that is with another.
    pub narrow: String,
}

/// A table that sorts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table {
    /// What its rows are.
    pub title: String,
    /// What a row is.
    pub note: String,
    /// The columns, in order.
    pub columns: Vec<Column>,
    /// Numbers (in SI units), texts, null, or a pair of a number that it sorts by and the text
    /// that is shown; one a column.
    pub rows: Vec<Vec<Value>>,
    /// For each row the state whose pose it shows when clicked; empty where rows show none.
    pub states: Vec<usize>,
    /// For each row the pathway that it takes when clicked; empty where rows take none.
    pub paths: Vec<Option<usize>>,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Column {
    /// The heading.
    pub name: String,
    /// What it means, told under the pointer; may be empty.
    pub meaning: &'static str,
}

impl Table {
    /// What reproduces a result: settings by their names.
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
    /// A page with nothing on it but its title.
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

    /// The page with the command line that makes it.
    #[must_use]
    pub fn made_by(self, command: &str) -> Self {
        let command = command.to_owned();
        Self { command, ..self }
    }

    /// The page with links to files beside it, by their names from its folder.
    #[must_use]
    pub fn beside<'a>(self, files: impl IntoIterator<Item = &'a String>) -> Self {
        let files = files.into_iter().cloned().collect();
        Self { files, ..self }
    }

    /// The file.
    ///
    /// # Panics
    /// Never: plain values with string keys are written.
    pub fn to_html(&self) -> String {
        let data = serde_json::to_string(self).expect("plain values are written");
        let script = format!("\"use strict\";\n{}", SCRIPTS.concat());
        let parts = [
            ("{title}", escaped(&self.title)),
            ("{style-hash}", hash(STYLE)),
            ("{script-hash}", hash(&script)),
            ("{style}", STYLE.to_owned()),
            ("{script}", script),
            // JSON holds `<` within strings alone, where its escape means the same.
            ("{data}", data.replace('<', "\\u003c")),
        ];
        filled(MARKUP, &parts)
    }
}

/// A number with `digits` significant digits, 0 for what is not finite.
fn rounded(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.*e}", digits - 1);
    let rounded = text.parse().unwrap_or(value);
    if f64::is_finite(rounded) {
        super::values::positive_zero(rounded)
    } else {
        0.0
    }
}

/// A length (m) or an angle to 8 decimals: ten nanometres, a hundred-thousandth of a tile of 1 mm.
fn fixed(value: f64) -> f64 {
    let scale = 1e8;
    super::values::positive_zero((value * scale).round() / scale)
}

/// Like [`rounded`], `None` for what is not finite.
fn finite(value: f64, digits: usize) -> Option<f64> {
    value.is_finite().then(|| rounded(value, digits))
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

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        assert_eq!(rounded(0.123_456_78, 4), 0.1235);
        assert_eq!(rounded(-0.0, 4).to_bits(), 0);
        assert_eq!(finite(f64::INFINITY, 4), None);
        assert_eq!(fixed(-1.3e-17).to_bits(), 0);
        assert_eq!(fixed(0.477_512_902_9), 0.477_512_9);
    }
}
