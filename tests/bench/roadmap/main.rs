//! The cost of a roadmap: time and energies of each stage, edges per second, memory.
//!
//! The paper's tile; edges are proved free, and their highest energy is known to 1 % (or 1e-5 of
//! the bond's depth). The share of contact tests is of the time of the edges.
//!
//! `cargo bench --bench roadmap`: the default roadmap on one thread and on all, medians of several
//! rounds in which both take turns.
//!
//! `cargo bench --bench roadmap -- --scale 1e4,1e5,1e6`: growth with the number of milestones, as
//! CSV; `--neighbours K` for other than the default number. `--draw results/scale.csv` draws such
//! a table beside it.

#![allow(clippy::disallowed_methods)]

#[path = "../../shared/designs.rs"]
mod designs;
mod figure;
#[path = "../ratio.rs"]
mod ratio;

use std::path::Path;
use std::time::Instant;

use ratio::ratio;
use tilebind::problem::Problem;
use tilebind::roadmap::{
    Acceptance, EdgeSettings, MilestoneSettings, ProfileTolerance, edge, milestone, neighbour,
};

const ROUNDS: usize = 7;

fn main() {
    let design = designs::load("shapes/paper-tile.toml");
    let problem = design.problem();
    let depth = problem.depth();
    let arguments: Vec<String> = std::env::args().collect();
    let value = |name: &str| {
        let at = arguments.iter().position(|a| a == name)?;
        arguments.get(at + 1).cloned()
    };
    let neighbours = value("--neighbours").and_then(|k| k.parse().ok());
    if let Some(table) = value("--draw") {
        if let Err(error) = figure::draw(Path::new(&table)) {
            eprintln!("{table}: {error}");
        }
        return;
    }
    match value("--scale") {
        None => rates(&problem, depth, neighbours),
        Some(counts) => {
            let counts = counts.split(',').filter_map(|n| n.parse::<f64>().ok());
            scale(&problem, depth, counts.map(|n| n as usize), neighbours);
        }
    }
}

/// One roadmap: wall times (s) of its three stages, of the edges' contact tests alone, and of the
/// milestones' energies in one batch; its size and its energies.
struct Built {
    seconds: [f64; 5],
    milestones: usize,
    edges: usize,
    /// Energies of the edges' profiles.
    energies: u64,
}

fn build(problem: &Problem, depth: f64, count: usize, neighbours: Option<usize>) -> Built {
    let mut times = vec![Instant::now()];
    let milestones = milestone::milestones(
        problem,
        &MilestoneSettings {
            count,
            acceptance: Acceptance::Linear {
                lowest: -depth,
                highest: 0.1 * depth,
            },
            seed: 1,
        },
    );
    times.push(Instant::now());
    let k = neighbours.unwrap_or_else(|| neighbour::neighbours_per_milestone(count));
    let pairs = neighbour::neighbour_pairs(&milestones, &problem.space, k);
    times.push(Instant::now());
    let before = problem.evaluations();
    let settings = EdgeSettings {
        tolerance: ProfileTolerance {
            relative: 0.01,
            absolute: 1e-5 * depth,
        },
        thermal_energy: 0.01 * depth,
        probability_step: 5e-3,
    };
    let edges = edge::edges(problem, &milestones, &pairs, &settings);
    let energies = problem.evaluations() - before;
    times.push(Instant::now());
    let free = edge::free_motions(problem, &milestones, &pairs);
    times.push(Instant::now());
    assert_eq!(free.len(), edges.len());
    let places: Vec<_> = milestones.iter().map(|m| m.q).collect();
    std::hint::black_box(problem.energies(&places));
    times.push(Instant::now());
    Built {
        seconds: [0, 1, 2, 3, 4].map(|i| (times[i + 1] - times[i]).as_secs_f64()),
        milestones: milestones.len(),
        edges: edges.len(),
        energies,
    }
}

fn rates(problem: &Problem, depth: f64, neighbours: Option<usize>) {
    let all = std::thread::available_parallelism().map_or(1, |n| n.get());
    let pools = [1, all].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        (threads, pool.expect("threads can be started"))
    });
    let mut rounds: [Vec<Built>; 2] = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        for ((_, pool), built) in pools.iter().zip(&mut rounds) {
            built.push(pool.install(|| {
                // The system takes some tens of milliseconds to spread threads over cores.
                build(problem, depth, 8000, neighbours);
                build(problem, depth, 8000, neighbours)
            }));
        }
    }
    let first = &rounds[0][0];
    println!(
        "{} milestones, {} edges, {:.2} energies an edge",
        first.milestones,
        first.edges,
        first.energies as f64 / first.edges as f64
    );
    println!(
        "{:8} {:>13} {:>13} {:>11} {:>11} {:>14}",
        "threads", "milestones/s", "neighbours/s", "edges/s", "energies/s", "contact tests"
    );
    let rate = |built: &[Built], stage: usize, amount: f64| {
        amount / median(built.iter().map(|b| b.seconds[stage]).collect())
    };
    for ((threads, _), built) in pools.iter().zip(&rounds) {
        println!(
            "{threads:8} {:13.0} {:13.0} {:11.0} {:11.0} {:12.0} %",
            rate(built, 0, first.milestones as f64),
            rate(built, 1, first.milestones as f64),
            rate(built, 2, first.edges as f64),
            rate(built, 2, first.energies as f64),
            100.0 * median(built.iter().map(|b| b.seconds[3] / b.seconds[2]).collect()),
        );
    }
    println!("{all} threads over one:");
    for (stage, name) in ["milestones-threads", "neighbours-threads", "edges-threads"]
        .into_iter()
        .enumerate()
    {
        let pairs = rounds[0].iter().zip(&rounds[1]);
        ratio(
            name,
            pairs.map(|(a, b)| a.seconds[stage] / b.seconds[stage]),
        );
    }
    // Energies per second of edges, including contact, over those of one batch.
    ratio(
        "edges-of-kernel",
        rounds[0].iter().map(|built| {
            let of_edges = built.energies as f64 / built.seconds[2];
            of_edges * built.seconds[4] / built.milestones as f64
        }),
    );
}

fn scale(
    problem: &Problem,
    depth: f64,
    counts: impl Iterator<Item = usize>,
    neighbours: Option<usize>,
) {
    println!(
        "neighbours,milestones,edges,milestones_s,neighbours_s,edges_s,energies_per_edge,\
         peak_memory_MB"
    );
    for count in counts {
        let k = neighbours.unwrap_or_else(|| neighbour::neighbours_per_milestone(count));
        let kind = if neighbours.is_some() {
            "fixed"
        } else {
            "default"
        };
        let built = build(problem, depth, count, neighbours);
        let [milestones, found, edges, ..] = built.seconds;
        println!(
            "{k} {kind},{},{},{milestones:.3},{found:.3},{edges:.3},{:.2},{}",
            built.milestones,
            built.edges,
            built.energies as f64 / built.edges as f64,
            peak_memory().map_or(String::new(), |mb| format!("{mb:.0}"))
        );
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The peak memory (MB) of the process so far, if the system reports it.
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024.0 / 1e6)
}
