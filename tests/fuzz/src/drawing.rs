//! The drawing reader on arbitrary bytes, as a tile's outline and as a face's profile.

#![no_main]

use std::collections::BTreeMap;

use jobs::Design;
use libfuzzer_sys::fuzz_target;

/// Tiles that are drawn, and a face that is.
const DESIGNS: [&str; 2] = [include_str!("outline.toml"), include_str!("line.toml")];

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = str::from_utf8(bytes) else {
        return;
    };
    let drawings = BTreeMap::from([("a.svg".to_owned(), text.to_owned())]);
    for design in DESIGNS {
        tilebind_fuzz::check(Design::parse_with(design, "fuzz.toml", &drawings));
    }
});
