//! Checks that the machine has the memory a request needs.

use physics::roadmap;

/// The assumed free memory if the machine does not report it (bytes).
const SUPPOSED: f64 = 8e9;
/// The memory of an analysis besides roadmaps, including threads and pictures (bytes): with less
/// than a sixth of it the program does not start, with four fifths the analysis of a shipped design
/// finishes.
const BESIDES: f64 = 1.2e8;
/// Requests above this are reported (bytes).
const WORTH_TELLING: f64 = 1e9;

/// The memory for roadmaps of which `at_once` are built at the same time, as a message if it is
/// large.
///
/// # Errors
/// If the machine does not have enough memory.
pub fn check(
    milestones: usize,
    neighbours: Option<usize>,
    at_once: usize,
) -> Result<Option<String>, String> {
    let work = match at_once {
        1 => "the work takes".to_owned(),
        _ => format!("work on {at_once} roadmaps at once takes"),
    };
    let needed = BESIDES + at_once as f64 * roadmap::memory(milestones, neighbours);
    let told = fits(needed).map_err(|told| {
        format!("{work} about {told}: use fewer --milestones, --neighbours or --threads")
    })?;
    Ok((needed > WORTH_TELLING).then(|| format!("{work} about {told}")))
}

/// Checks that a number of bytes is available.
///
/// # Errors
/// If the machine does not have enough memory.
pub fn check_bytes(needed: f64) -> Result<(), String> {
    fits(needed)
        .map(drop)
        .map_err(|told| format!("this takes {told}"))
}

/// A message with the needed and the free memory.
///
/// # Errors
/// The same message, if less is free.
fn fits(needed: f64) -> Result<String, String> {
    let free = available().unwrap_or(SUPPOSED);
    let gigabytes = |bytes: f64| match bytes / 1e9 {
        many if many >= 1e6 => format!("{many:.1e} GB"),
        some => format!("{some:.1} GB"),
    };
    let told = format!(
        "{} of memory; {} are free",
        gigabytes(needed),
        gigabytes(free)
    );
    match needed <= free {
        true => Ok(told),
        false => Err(told),
    }
}

/// Memory available without swapping (bytes), as reported by Linux: the machine's, or the process's
/// limit (`ulimit -v`) if that is lower.
fn available() -> Option<f64> {
    let free = first_number("/proc/meminfo", "MemAvailable:").map(|kibibytes| 1024.0 * kibibytes);
    let allowed = first_number("/proc/self/limits", "Max address space");
    free.into_iter().chain(allowed).reduce(f64::min)
}

/// The first number of the line with this beginning.
fn first_number(file: &str, beginning: &str) -> Option<f64> {
    let told = std::fs::read_to_string(file).ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix(beginning))?;
    line.split_whitespace().next()?.parse().ok()
}
