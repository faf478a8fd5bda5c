//! Whole analyses of small designs.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| tilebind_fuzz::analyse(bytes));
