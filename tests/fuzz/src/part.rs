//! The reader of parts of tables on arbitrary bytes.

#![no_main]

use std::sync::LazyLock;

use jobs::Design;
use libfuzzer_sys::fuzz_target;

static PAIR: LazyLock<Design> = LazyLock::new(|| {
    let text = include_str!("../../../shapes/tab-20mm.toml");
    Design::parse(text, "tab-20mm.toml").expect("a shipped design")
});

fuzz_target!(|text: &str| tilebind_fuzz::part(text, &PAIR));
