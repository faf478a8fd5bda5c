//! Checks that the machine has the memory a request needs.

use physics::roadmap;

/// What is taken to be free where the machine does not say (bytes).
const SUPPOSED: f64 = 8e9;
/// What an analysis takes besides roadmaps, its threads and pictures among it (bytes): with less than a
/// sixth of it the program does not start, with four fifths the analysis of a shipped design ends.
const BESIDES: f64 = 1.2e8;
/// Requests for more are told of (bytes).
const WORTH_TELLING: f64 = 1e9;

/// What memory work on roadmaps takes of which `at_once` are built at the same time, where that is worth telling.
///
/// # Errors
/// If the machine does not have it.
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

/// Refuses what takes so many bytes.
///
/// # Errors
/// If the machine does not have them.
pub fn check_bytes(needed: f64) -> Result<(), String> {
    fits(needed)
        .map(drop)
        .map_err(|told| format!("this takes {told}"))
}

/// So many bytes and what is free, in words.
///
/// # Errors
/// The same, where less is free.
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

/// Memory that can be had without swapping (bytes), as Linux tells it: the machine's, or what the
/// process may have (`ulimit -v`) where that is less.
fn available() -> Option<f64> {
    let free = first_number("/proc/meminfo", "MemAvailable:").map(|kibibytes| 1024.0 * kibibytes);
    let allowed = first_number("/proc/self/limits", "Max address space");
    free.into_iter().chain(allowed).reduce(f64::min)
}

/// The first number of the line with such a beginning.
fn first_number(file: &str, beginning: &str) -> Option<f64> {
    let told = std::fs::read_to_string(file).ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix(beginning))?;
    line.split_whitespace().next()?.parse().ok()
}
