//! Checks that the machine has the memory a request needs.

use tilebind::memory;

use super::{Failure, tell};

/// Reports the memory for roadmaps of which `at_once` are built at the same time; an error if the
/// machine does not have it.
pub fn check(milestones: usize, neighbours: Option<usize>, at_once: usize) -> Result<(), Failure> {
    let worth_telling = memory::check(milestones, neighbours, at_once).map_err(Failure::Usage)?;
    if let Some(told) = worth_telling {
        tell(format!("note: {told}"));
    }
    Ok(())
}

/// An error if the meshes of overdamped motion between a number of places do not fit into memory.
pub fn check_meshes(places: usize, threads: usize) -> Result<(), Failure> {
    memory::check_meshes(places + 1, threads).map_err(Failure::Usage)
}

/// An error if the process may not reserve what its threads need.
pub fn check_threads(threads: usize) -> Result<(), Failure> {
    memory::check_threads(threads).map_err(Failure::Usage)
}
