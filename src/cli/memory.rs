//! Checks that the machine has the memory a request needs.

use tilebind::memory;

use super::{Failure, tell};

/// Says what memory roadmaps take of which `at_once` are built at the same time, and refuses what
/// the machine does not have.
pub fn check(milestones: usize, neighbours: Option<usize>, at_once: usize) -> Result<(), Failure> {
    let worth_telling = memory::check(milestones, neighbours, at_once).map_err(Failure::Usage)?;
    if let Some(told) = worth_telling {
        tell(format!("note: {told}"));
    }
    Ok(())
}
