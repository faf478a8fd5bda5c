//! Minima and transition states in the plain files of TopSearch
//! (<https://github.com/IBM/topography-searcher>), from which it and others draw disconnectivity
//! graphs.
//!
//! One minimum per class of states, in ascending order of energy; the last one stands for tiles far
//! apart with U = 0, which are also a basin. `min.data` has lines `i E`, `ts.data` lines `i j E`
//! (J) with the lowest transition state between two minima; `min.coords` and `ts.coords` have x, y
//! (m) and theta (rad) of each line, `pairlist` the connected pairs. TopSearch requires all five.
//!
//! TopSearch 0.0.3 reads a file of one line as a row of numbers, not as a table. A single transition
//! state, as of two minima, is therefore written twice; to it these are one edge.
//!
//! TopSearch 0.0.3 (`pip install topsearch`) reads `topsearch/` with `read_network` and draws the
//! paper tile's graph: the same ten minima (nine kinds of state and free tiles), in which the
//! shifted bonds join the bond first and all are joined at the top. It draws a linear scale with
//! 100 levels, so that the merges at -140 and -47 µJ coincide. It uses LaTeX for text;
//! `matplotlib.rcParams["text.usetex"] = False` after the import avoids that.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::files::Files;
use super::plots::Scene;
use physics::configuration::Configuration;
use physics::landscape::Place;

/// The folder of the files.
pub const FOLDER: &str = "topsearch";

/// The names of the files.
pub const NAMES: [&str; 5] = ["min.data", "min.coords", "ts.data", "ts.coords", "pairlist"];

/// All files of a landscape; `far` (m) is a distance at which the tiles are far apart.
pub fn files(scene: &Scene, far: f64) -> Files {
    let classes = scene.kinds();
    let free = classes.len();
    let number = |place: Place| match place {
        Place::Free => Some(free),
        Place::State(_) => {
            let class = scene.class_of(place)?;
            classes.iter().position(|c| c.first().class == class)
        }
    };
    // Between two minima only the lowest one counts.
    let mut lowest: BTreeMap<(usize, usize), (f64, Configuration)> = BTreeMap::new();
    for barrier in scene.barriers() {
        let (Some(from), Some(to)) = (number(barrier.from), number(barrier.to)) else {
            continue;
        };
        // U = 0 far apart, so no path to there has a lower maximum energy.
        let least = if to.max(from) == free {
            0.0
        } else {
            f64::NEG_INFINITY
        };
        let energy = barrier.saddle_energy.max(least);
        if from == to || !energy.is_finite() {
            continue;
        }
        let known = lowest
            .entry((from.min(to), from.max(to)))
            .or_insert((energy, barrier.saddle));
        if energy < known.0 {
            *known = (energy, barrier.saddle);
        }
    }
    let minima = classes
        .iter()
        .map(|class| (class.first().energy, class.first().configuration))
        .chain([(0.0, Configuration::new(far, 0.0, 0.0))]);
    let mut texts = NAMES.map(|name| (name, String::new()));
    let [min, min_coords, ts, ts_coords, pairs] = texts.each_mut().map(|(_, text)| text);
    for (i, (energy, q)) in minima.enumerate() {
        // Writing to a string succeeds.
        let _ = writeln!(min, "{i} {energy:?}");
        let _ = writeln!(min_coords, "{}", coordinates(&q));
    }
    let times = if lowest.len() == 1 { 2 } else { 1 };
    for ((i, j), (energy, q)) in &lowest {
        for _ in 0..times {
            let _ = writeln!(ts, "{i} {j} {energy:?}");
            let _ = writeln!(ts_coords, "{}", coordinates(q));
        }
        let _ = writeln!(pairs, "{i} {j}");
    }
    texts
        .into_iter()
        .map(|(name, text)| (format!("{FOLDER}/{name}"), text.into_bytes()))
        .collect()
}

fn coordinates(q: &Configuration) -> String {
    q.to_array().map(|value| format!("{value:?}")).join(" ")
}
