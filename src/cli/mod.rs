//! The commands, a file each, and what they share.

pub mod analyse;
pub mod barrier;
pub mod completions;
pub mod dock;
pub mod energy;
mod failure;
pub mod init;
mod input;
mod interrupt;
mod progress;
pub mod schema;

pub use failure::Failure;

use std::io::Write;

/// Writes to standard output.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(())
}
