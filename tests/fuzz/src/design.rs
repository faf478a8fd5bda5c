//! The design reader on arbitrary bytes: it must answer, and quickly, and its answer must be
//! printable.

#![no_main]

use jobs::Design;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = str::from_utf8(bytes) else {
        return;
    };
    // No drawings, because the fuzzer must not read files of this machine.
    tilebind_fuzz::check(Design::parse_with(text, "fuzz.toml", &Default::default()));
});
