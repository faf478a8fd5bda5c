//! The commands, a file each, and what they share.

pub mod analyse;
mod assessment;
pub mod barrier;
pub mod calibrate;
pub mod compare;
pub mod completions;
pub mod dock;
mod docking_starts;
pub mod energy;
mod failure;
pub mod init;
mod input;
mod interrupt;
mod memory;
mod options;
mod progress;
pub mod schema;
pub mod sweep;
mod sweep_progress;
mod word;

pub use failure::Failure;

use std::io::Write;

/// Writes to standard output.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(())
}
