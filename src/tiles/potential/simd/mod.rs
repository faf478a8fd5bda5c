//! Arithmetic on vectors of f64 lanes with the best instruction set of the CPU, the same bits with each.

pub mod lanes;
mod level;
// On x86-64 for tests only: a third of the kernels' code would be for processors before 2013.
#[cfg(any(not(target_arch = "x86_64"), test, feature = "portable"))]
mod portable;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use level::Level;
