//! The files of an analysis by their names.

use std::collections::BTreeMap;

use serde_json::Value;

use super::json as layout;
use super::page::Page;
use crate::checksum::sha256;

/// Files by their names relative to the folder they go to.
pub type Files = BTreeMap<String, Vec<u8>>;

/// The file that is written last: where it is, the others are too.
pub const REPORT: &str = "report.json";

/// The folder of pictures.
pub const PICTURES: &str = "pictures";

/// The page for a browser.
pub const PAGE: &str = "report.html";

/// Tables with the page that shows them, if any, made by `command`, and with the report, which lists
/// them all with their checksums.
pub fn with_report(tables: Files, page: Option<Page>, mut report: Value, command: &str) -> Files {
    let mut files = tables;
    if let Some(page) = page {
        let others: Vec<String> = files.keys().cloned().chain([REPORT.to_owned()]).collect();
        let page = page.made_by(command).beside(&others).to_html();
        files.insert(PAGE.to_owned(), page.into_bytes());
    }
    let sums = files
        .iter()
        .map(|(name, bytes)| (name.clone(), sha256(bytes).into()));
    report["files"] = Value::Object(sums.collect());
    files.insert(REPORT.to_owned(), layout::text(&report).into_bytes());
    files
}
