//! Tile sets, of rgrow and of xgrow, of any bytes.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| tilebind_fuzz::tile_set(text));
