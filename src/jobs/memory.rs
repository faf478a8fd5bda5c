//! Whether the machine has the memory that a request needs.

use physics::roadmap;

/// What is taken to be free where the machine does not say (bytes).
const SUPPOSED: f64 = 8e9;
/// Requests for more are told of (bytes).
const WORTH_TELLING: f64 = 1e9;

/// What memory roadmaps take of which `at_once` are built at the same time, where that is worth telling.
///
/// # Errors
/// Where the machine does not have it.
pub fn check(
    milestones: usize,
    neighbours: Option<usize>,
    at_once: usize,
) -> Result<Option<String>, String> {
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
        return Err(format!(
            "{roadmaps} about {takes} of memory, and {free_now} are free: \
             ask for fewer --milestones or --neighbours, or work on fewer --threads"
        ));
    }
    let told = || format!("{roadmaps} about {takes} of memory; {free_now} are free");
    Ok((needed > WORTH_TELLING).then(told))
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
