//! Checks that the machine has the memory a request needs.

use physics::roadmap;
use physics::units::counted;

/// The assumed free memory if the machine does not report it (bytes).
const SUPPOSED: f64 = 8e9;
/// The memory of an analysis besides roadmaps, including threads and pictures (bytes): with less
/// than a sixth of it the program does not start, with four fifths the analysis of a shipped design
/// finishes.
const BESIDES: f64 = 1.2e8;
/// Address space (bytes) that a process with a limit of it needs for itself, and for each thread: a
/// stack and a heap of 64 MB, which the C library reserves as a whole. With less, allocations fail
/// at places that differ from run to run.
const RESERVED: f64 = 1.3e8;
const RESERVED_BY_THREAD: f64 = 6.8e7;
/// The memory (bytes) of rates per function on the mesh: up to 4 kB per unknown, and the default
/// number of unknowns.
const OF_A_FUNCTION: f64 = 4e3 * 6e4;
/// The memory (bytes) of a far start until all are counted: where it ends, and its slides.
const OF_A_START: f64 = 500.0;
/// Requests above this are reported (bytes).
const WORTH_TELLING: f64 = 1e9;

/// The memory for roadmaps of which `at_once` are built at the same time, as a message if it is
/// large. `None` for the number of neighbours means the PRM* rule.
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
    let told = fits(needed, available()).map_err(|told| {
        format!("{work} about {told}: use fewer --milestones, --neighbours or --threads")
    })?;
    Ok((needed > WORTH_TELLING).then(|| format!("{work} about {told}")))
}

/// Checks the memory for far starts, by each of `at_once` analyses.
///
/// # Errors
/// If the machine does not have enough memory.
pub fn check_starts(starts: usize, at_once: usize) -> Result<(), String> {
    check_bytes(OF_A_START * starts as f64 * at_once as f64)
        .map_err(|told| format!("{starts} far starts: {told}: use fewer --far-starts"))
}

/// Checks that the process may reserve what its threads need.
///
/// # Errors
/// If its limit (`ulimit -v`) is lower.
pub fn check_threads(threads: usize) -> Result<(), String> {
    let needed = reserved(threads);
    match limit() {
        Some(allowed) if allowed < needed => Err(format!(
            "the program with {} needs {} of address space, but is limited to {}: \
             use fewer --threads or raise the limit (ulimit -v)",
            counted(threads, "thread"),
            gigabytes(needed),
            gigabytes(allowed)
        )),
        _ => Ok(()),
    }
}

/// Checks that the meshes between a number of places (with a function for each, and one for the
/// mean time) fit beside the threads into the memory that the process may reserve.
///
/// # Errors
/// If the process's limit (`ulimit -v`) is lower.
pub fn check_meshes(places: usize, threads: usize) -> Result<(), String> {
    let needed = BESIDES + OF_A_FUNCTION * (places + 1) as f64;
    let Some(allowed) = limit() else {
        return Ok(());
    };
    fits(needed, Some((allowed - reserved(threads)).max(0.0)))
        .map(drop)
        .map_err(|told| format!("the meshes of overdamped motion take up to about {told}"))
}

/// Checks that a number of bytes is available.
///
/// # Errors
/// If the machine does not have enough memory.
pub fn check_bytes(needed: f64) -> Result<(), String> {
    fits(needed, available())
        .map(drop)
        .map_err(|told| format!("this takes {told}"))
}

/// A message with the needed and the free memory.
///
/// # Errors
/// The same message, if less is free.
fn fits(needed: f64, free: Option<f64>) -> Result<String, String> {
    let free = free.unwrap_or(SUPPOSED);
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

fn gigabytes(bytes: f64) -> String {
    match bytes / 1e9 {
        many if many >= 1e6 => format!("{many:.1e} GB"),
        some if some >= 0.95 => format!("{some:.1} GB"),
        few => format!("{:.0} MB", 1e3 * few),
    }
}

fn reserved(threads: usize) -> f64 {
    RESERVED + RESERVED_BY_THREAD * threads as f64
}

/// Memory (bytes) available without swapping: the machine's, or the process's limit if that is
/// lower.
fn available() -> Option<f64> {
    unused().into_iter().chain(limit()).reduce(f64::min)
}

/// The machine's memory (bytes) available without swapping, as reported by Linux.
fn unused() -> Option<f64> {
    first_number("/proc/meminfo", "MemAvailable:").map(|kibibytes| 1024.0 * kibibytes)
}

/// The process's limit (`ulimit -v`, bytes), as reported by Linux.
fn limit() -> Option<f64> {
    first_number("/proc/self/limits", "Max address space")
}

/// The first number of the line with this beginning.
fn first_number(file: &str, beginning: &str) -> Option<f64> {
    let told = std::fs::read_to_string(file).ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix(beginning))?;
    line.split_whitespace().next()?.parse().ok()
}
