//! How analyses divide over threads: the time of each stage on one thread, its critical path, and
//! the least speed-up that these two allow on 2 to 64 threads (threads that cost nothing and never
//! idle while there is work); beside it the speed-up measured on all threads of this machine, in the
//! same run. Proofs have their usual effort.
//!
//! `cargo bench --bench split` for dipoles, `-- --model cuboid` for blocks (minutes), `-- --design FILE`
//! for one design.

#![allow(clippy::disallowed_methods)]

#[path = "../shared/designs.rs"]
mod designs;
mod ratio;

use std::sync::Mutex;
use std::time::Instant;

use clap::Parser;
use tilebind::design::{Design, MagnetModel};
use tilebind::observer::{Observer, Silent};
use tilebind::parallel::split::{Split, recorded, so_far};
use tilebind::pipeline::{Settings, analyse};

const THREADS: [usize; 6] = [2, 4, 8, 16, 32, 64];

#[derive(Parser)]
struct Options {
    /// The designs
    #[arg(long)]
    design: Vec<String>,
    /// The model of the magnets
    #[arg(long, default_value = "dipole", value_parser = tilebind::request::model())]
    model: MagnetModel,
    /// Given by `cargo bench`
    #[arg(long)]
    bench: bool,
}

/// What was recorded when each stage began.
#[derive(Default)]
struct Stages(Mutex<Vec<Split>>);

impl Observer for Stages {
    fn stage(&self, _: &str, _: f64) {
        self.0.lock().expect("one thread").push(so_far());
    }
}

fn main() {
    let options = Options::parse();
    let mut names = options.design;
    if names.is_empty() {
        names = ["paper-tile", "hexagon", "sine-teeth-20mm", "tab-20mm"]
            .map(|name| format!("shapes/{name}.toml"))
            .into();
    }
    let mut sixteen = Vec::new();
    for name in &names {
        let mut design = designs::load(name);
        design.interaction.model = options.model;
        sixteen.push(measure(&design));
    }
    ratio::ratio("sixteen-threads-at-least", sixteen.into_iter());
}

/// Prints how an analysis divides; returns the least speed-up on 16 threads.
fn measure(design: &Design) -> f64 {
    let settings = Settings::of([design]);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.expect("one thread");
    let stages = Stages::default();
    let (_, whole) = pool.install(|| recorded(|| analyse(design, &settings, &stages)));
    let on_all = Instant::now();
    let all = analyse(design, &settings, &Silent);
    let on_all = on_all.elapsed().as_secs_f64();
    println!(
        "\n{}, {}; seconds on one thread, and how many times as fast on more",
        design.name,
        design.interaction.model.name()
    );
    print!("{:<28} {:>8} {:>8} {:>8}", "", "work", "serial", "path");
    for threads in THREADS {
        print!(" {threads:>6}");
    }
    println!(" measured on {}", rayon::current_num_threads());
    let mut begun = stages.0.into_inner().expect("one thread");
    begun.push(whole);
    // Without repeats, every stage is there once.
    for (pair, on_all) in begun.windows(2).zip(&all.stages) {
        print(&on_all.name, &pair[1].since(&pair[0]), on_all.wall_s);
    }
    print("whole", &whole, on_all);
    whole.work / whole.time_on(16)
}

fn print(name: &str, split: &Split, measured: f64) {
    let Split { work, serial, path } = split;
    print!("{name:<28} {work:>8.3} {serial:>8.3} {path:>8.3}");
    for threads in THREADS {
        print!(" {:>6.2}", work / split.time_on(threads));
    }
    println!(" {:>6.2}", work / measured);
}
