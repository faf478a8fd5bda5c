//! Time from the start of the process to an answer: a barrier, and an energy.
//!
//! The slid state of the paper's tile, back to the bond, to 1 % and to 0.1 % of the barrier; medians
//! over ten seeds.
//!
//! `cargo bench --bench barrier`

#![allow(clippy::disallowed_methods)]

mod ratio;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use ratio::ratio;

const SEEDS: u64 = 10;
/// The barrier (J) from the slid state to the bond.
const BARRIER: f64 = 15.19e-3;

fn main() {
    let design = Path::new(env!("CARGO_MANIFEST_DIR")).join("shapes/paper-tile.toml");
    let Some(design) = design.to_str() else {
        return eprintln!("the path of the shipped designs is not UTF-8");
    };
    println!("{:32} {:>9} {:>9}", "", "median", "longest");
    let barrier = |share: f64, seed: u64| {
        let (tolerance, seed) = ((share * BARRIER).to_string(), seed.to_string());
        let to = ["--from", "0.43,0.04,0", "--to", "0.43,0,0"];
        let how = ["--tolerance", &tolerance, "--seed", &seed];
        seconds(&[["barrier", design].as_slice(), &to, &how].concat())
    };
    let rounds: Vec<[f64; 3]> = (1..=SEEDS)
        .map(|seed| {
            let pose = ["energy", design, "--pose", "0.43,0.04,0"];
            [barrier(1e-2, seed), barrier(1e-3, seed), seconds(&pose)]
        })
        .collect();
    for (i, name) in ["barrier to 1 %", "barrier to 0.1 %", "energy of one pose"]
        .into_iter()
        .enumerate()
    {
        report(name, rounds.iter().map(|round| round[i]).collect());
    }
    ratio(
        "barrier-to-0.1%-over-1%",
        rounds.iter().map(|round| round[1] / round[0]),
    );
}

fn report(name: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    println!(
        "{name:32} {:6.0} ms {:6.0} ms",
        1e3 * times[times.len() / 2],
        1e3 * times[times.len() - 1]
    );
}

/// Wall time (s) of one run of the program.
fn seconds(arguments: &[&str]) -> f64 {
    let start = Instant::now();
    let status = Command::new(env!("CARGO_BIN_EXE_tilebind"))
        .args(arguments)
        .stdout(Stdio::null())
        .status();
    let took = start.elapsed().as_secs_f64();
    match status {
        Ok(status) if status.success() => took,
        _ => f64::NAN,
    }
}
