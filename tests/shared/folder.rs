//! The contents of a folder.

use std::collections::BTreeMap;
use std::path::Path;

/// tilebind's record of its files in a folder, with checksums of files that contain times.
pub const RECORD: &str = ".tilebind.json";

/// All files below a folder, without its record, by their names relative to it, with their
/// contents.
pub fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(here) = open.pop() {
        for entry in std::fs::read_dir(here).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path != folder.join(RECORD) {
                let name = path.strip_prefix(folder).expect("below").display();
                let content = std::fs::read(&path).expect("a file");
                all.insert(name.to_string(), content);
            }
        }
    }
    all
}

/// The same for results, without the timing of the report.
pub fn untimed(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = contents(folder);
    let report = all.get_mut("report.json").expect("a report");
    let mut value: serde_json::Value = serde_json::from_slice(report).expect("JSON");
    let timing = value.as_object_mut().expect("an object").remove("timing");
    assert!(timing.is_some(), "a report has its timing");
    *report = value.to_string().into_bytes();
    all
}

/// Asserts that two folders have the same files, byte for byte; `what` names them in messages.
pub fn assert_same(
    found: &BTreeMap<String, Vec<u8>>,
    expected: &BTreeMap<String, Vec<u8>>,
    what: &str,
) {
    assert!(found.keys().eq(expected.keys()), "{what}: other files");
    for (name, content) in found {
        assert!(*content == expected[name], "{what}: {name} differs");
    }
}
