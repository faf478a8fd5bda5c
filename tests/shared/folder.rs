//! What lies in a folder.

use std::collections::BTreeMap;
use std::path::Path;

/// What tilebind notes about its files in a folder; it has the checksums of files that tell times.
pub const RECORD: &str = ".tilebind.json";

/// All files below a folder but its record with their contents, by their names relative to it.
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
