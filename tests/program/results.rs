//! The stored results of the shipped designs in `results` are what the program computes, byte for
//! byte.

use std::fs;
use std::path::Path;

use crate::program::{stderr, stdout};
use crate::readme::{run, with_shapes};

/// Designs of which results are compared: dipoles, with flat faces, with shaped ones, and behind
/// shields.
pub const KEPT: [&str; 3] = ["paper-tile", "tab-20mm", "shielded-backs"];

/// The command of a design's results.
pub fn analysis(design: &str) -> String {
    format!("tilebind analyse shapes/{design}.toml --out target/{design}")
}

/// Tables, pictures and the summary of a design.
#[test]
fn what_is_kept_of_three_designs_is_what_the_program_gives() {
    for design in KEPT {
        let folder = with_shapes();
        let out = format!("target/{design}");
        let command = analysis(design);
        let output = run(&command, folder.path());
        assert!(output.status.success(), "{command}\n{}", stderr(&output));
        let out = folder.path().join(out);
        fs::write(out.join("summary.txt"), stdout(&output)).unwrap();
        let kept = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("results")
            .join(design);
        let names = fs::read_dir(&kept).unwrap();
        let names: Vec<_> = names.map(|entry| entry.unwrap().file_name()).collect();
        assert!(names.iter().any(|name| name == "states.csv"));
        let differing = names.iter().filter(|name| {
            let mut made = out.join(name);
            if !made.exists() {
                made = out.join("pictures").join(name);
            }
            fs::read(kept.join(name)).unwrap() != fs::read(made).unwrap_or_default()
        });
        let differing: Vec<_> = differing.collect();
        assert!(
            differing.is_empty(),
            "results/{design}: {differing:?} differ from what `{command}` gives; \
             `results/make.py {design}` makes them anew"
        );
    }
}
