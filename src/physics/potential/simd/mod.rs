//! Arithmetic on vectors of f64 lanes with the best instruction set of the CPU, the same bits with each.

pub mod lanes;
mod level;
mod portable;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use level::Level;
