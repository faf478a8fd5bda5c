//! Design files, good and bad: what loads, what it loads as, and what is said of what does not.

use std::path::{Path, PathBuf};

use tilebind::design::Design;

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    files.sort();
    files
}

#[test]
fn every_shipped_design_loads_without_a_doubt() {
    let shapes = files("shapes");
    for path in &shapes {
        let design = Design::load(path).unwrap_or_else(|error| panic!("{error}"));
        for warning in &design.warnings {
            panic!("{warning}");
        }
        let stem = path.file_stem().unwrap().to_string_lossy();
        assert_eq!(design.name, stem);
        assert!(
            std::fs::read_to_string(path).unwrap().starts_with("# "),
            "{stem} has no comment"
        );
    }
}
