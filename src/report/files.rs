//! The files of an analysis by their names.

use std::collections::BTreeMap;

/// Files by their names relative to the folder they go to.
pub type Files = BTreeMap<String, Vec<u8>>;

/// The file that is written last: where it is, the others are too.
pub const REPORT: &str = "report.json";

/// The folder of pictures.
pub const PICTURES: &str = "pictures";

/// The page for a browser.
pub const PAGE: &str = "report.html";
