//! The bounds of energies over cells, made from arbitrary bytes.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| tilebind_fuzz::bounds(bytes));
