//! The readers of tile sets, of rgrow and of xgrow, on arbitrary bytes.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| tilebind_fuzz::tile_set(text));
