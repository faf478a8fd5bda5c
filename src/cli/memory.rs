//! Whether the machine has the memory that a request needs.

use tilebind::roadmap;

use super::{Failure, tell};

/// What is taken to be free where the machine does not say (bytes).
const SUPPOSED: f64 = 8e9;
/// Requests for more are told of (bytes).
const WORTH_TELLING: f64 = 1e9;

/// Says what memory roadmaps take of which `at_once` are built at the same time, and refuses what
/// the machine does not have.
pub fn check(milestones: usize, neighbours: Option<usize>, at_once: usize) -> Result<(), Failure> {
    let needed = at_once as f64 * roadmap::memory(milestones, neighbours);
    let free = available().unwrap_or(SUPPOSED);
    let roadmaps = match at_once {
        1 => "the roadmap takes".to_owned(),
        _ => format!("{at_once} roadmaps at once take"),
    };
    let gigabytes = |bytes: f64| match bytes / 1e9 {
        many if many >= 1e6 => format!("{many:.1e} GB"),
        some => format!("{some:.1} GB"),
    };
    let (takes, free_now) = (gigabytes(needed), gigabytes(free));
    if needed > free {
        return Err(Failure::Usage(format!(
            "{roadmaps} about {takes} of memory, and {free_now} are free: \
             ask for fewer --milestones or --neighbours, or work on fewer --threads"
        )));
    }
    if needed > WORTH_TELLING {
        tell(format!(
            "note: {roadmaps} about {takes} of memory; {free_now} are free"
        ));
    }
    Ok(())
}

/// Memory that can be had without swapping (bytes), as Linux tells it.
fn available() -> Option<f64> {
    let told = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = told
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(1024.0 * kibibytes)
}
