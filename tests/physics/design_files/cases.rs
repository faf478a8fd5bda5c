//! The fuzzer's seeds and findings, replayed: see `tests/fuzz`.

use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tilebind::Design;

#[path = "../../fuzz/src/lib.rs"]
mod answers;

/// The texts of a folder of cases.
fn cases(kind: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/cases");
    let entries = std::fs::read_dir(folder.join(kind)).expect("a folder");
    let texts = entries.map(|entry| std::fs::read(entry.unwrap().path()).unwrap());
    // As the fuzzer's targets do with other bytes.
    texts
        .filter_map(|bytes| String::from_utf8(bytes).ok())
        .collect()
}

#[test]
fn every_design_of_the_fuzzer_has_an_answer() {
    let all = cases("design");
    assert!(!all.is_empty());
    for text in all {
        answers::design(&text);
    }
}

#[test]
fn every_drawing_of_the_fuzzer_has_an_answer() {
    let all = cases("drawing");
    assert!(!all.is_empty());
    for text in all {
        answers::drawing(&text);
    }
}

#[test]
fn every_tile_set_of_the_fuzzer_has_an_answer() {
    cases("tileset")
        .iter()
        .for_each(|text| answers::tile_set(text));
}

#[test]
fn every_set_of_words_of_the_fuzzer_has_an_answer() {
    cases("words")
        .iter()
        .for_each(|text| answers::word_set(text));
}

#[test]
fn every_manifest_of_the_fuzzer_has_an_answer() {
    cases("plan").iter().for_each(|text| answers::plan(text));
}

#[test]
fn every_table_of_the_fuzzer_has_an_answer() {
    let pair = Design::load("shapes/tab-20mm.toml".as_ref()).unwrap();
    for text in cases("table") {
        answers::table(&text, &pair);
    }
}

#[test]
fn every_start_part_and_gap_of_the_fuzzer_has_an_answer() {
    let pair = Design::load("shapes/tab-20mm.toml".as_ref()).unwrap();
    for text in cases("start").iter().chain(&cases("table")) {
        answers::start(text, &pair);
    }
    cases("part")
        .iter()
        .for_each(|text| answers::part(text, &pair));
    cases("gaps")
        .iter()
        .for_each(|text| answers::gaps(text, &pair));
}

/// Whole analyses of small designs, on the fuzzer's findings and on bytes by chance.
#[test]
fn small_designs_of_all_kinds_are_analysed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/cases/analyse");
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        answers::analyse(&std::fs::read(entry.unwrap().path()).unwrap());
    }
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..6 {
        let bytes: [u8; 60] = std::array::from_fn(|_| rng.random());
        answers::analyse(&bytes);
    }
}

/// The fuzzer's check of bounds of energies over cells, on bytes by chance.
#[test]
fn energies_in_plain_intervals_lie_within_their_bounds() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..60 {
        let bytes: [u8; 160] = std::array::from_fn(|_| rng.random());
        answers::bounds(&bytes);
    }
}
