//! The design reader on any bytes: it answers, and soon, and its answer can be told.

#![no_main]

use jobs::Design;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = str::from_utf8(bytes) else {
        return;
    };
    // No drawings: files of this machine are nothing to the fuzzer.
    tilebind_fuzz::check(Design::parse_with(text, "fuzz.toml", &Default::default()));
});
