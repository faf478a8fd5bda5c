//! The drawing reader on arbitrary bytes.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| tilebind_fuzz::drawing(text));
