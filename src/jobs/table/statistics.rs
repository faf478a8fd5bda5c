//! Statistics over the runs of a table.

use std::collections::{BTreeMap, BTreeSet};

use physics::dynamics::docking::poisson_interval;
use physics::order::Order;
use physics::table::TableSettings;
use physics::table::contacts::Tie;
use physics::table::run::{Life, Run};
use physics::table::structures::{Structure, StructureShape};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A mean over runs with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeanInterval {
    /// The mean.
    pub mean: f64,
    /// The standard deviation of single runs; `None` for one run.
    pub sd: Option<f64>,
    /// The lower end; `None` for a single run.
    pub low: Option<f64>,
    /// The upper end.
    pub high: Option<f64>,
}

impl MeanInterval {
    /// Computed from counts, one a run, by Student's t or, if that is wider, from how rarely the
    /// counts differ from their median: runs that agree do not prove that all do.
    pub fn of(counts: &[usize]) -> Self {
        let n = counts.len() as f64;
        let mean = counts.iter().sum::<usize>() as f64 / n;
        let off = |count: &usize| (*count as f64 - mean).powi(2);
        let squares: f64 = counts.iter().map(off).sum();
        let [below, above] = rare(counts);
        let half = (counts.len() > 1).then(|| {
            let t = StudentsT::new(0.0, 1.0, n - 1.0);
            let t = t.map_or(f64::NAN, |t| t.inverse_cdf(0.975));
            t * (squares / (n - 1.0) / n).sqrt()
        });
        Self {
            mean,
            sd: (counts.len() > 1).then(|| (squares / (n - 1.0)).sqrt()),
            low: half.map(|half| (mean - half.max(below)).max(0.0)),
            high: half.map(|half| mean + half.max(above)),
        }
    }

    /// With an end that no count can exceed.
    pub fn up_to(self, most: usize) -> Self {
        Self {
            high: self.high.map(|high| high.min(most as f64)),
            ..self
        }
    }

    /// As shares of the largest possible count.
    pub fn of_at_most(self, most: usize) -> Self {
        let share = |count: f64| (count / most.max(1) as f64).min(1.0);
        Self {
            mean: share(self.mean),
            sd: self.sd.map(|sd| sd / most.max(1) as f64),
            low: self.low.map(share),
            high: self.high.map(share),
        }
    }
}

/// How far the mean may lie below and above that of these counts if differences from the median are
/// independent rare events: their numbers up and down have Poisson intervals, of which the
/// interval of the difference follows (Zou and Donner 2008, doi:10.1002/sim.3095).
fn rare(counts: &[usize]) -> [f64; 2] {
    let mut sorted = counts.to_vec();
    sorted.order_by_key(|count| *count);
    let median = sorted[sorted.len() / 2];
    let total =
        |off: fn(usize, usize) -> usize| counts.iter().map(|count| off(*count, median)).sum();
    let [up, down]: [usize; 2] = [
        total(usize::saturating_sub),
        total(|a, b| b.saturating_sub(a)),
    ];
    let margins = |events: usize| poisson_interval(events).map(|end| (end - events as f64).abs());
    let ([up_low, up_high], [down_low, down_high]) = (margins(up), margins(down));
    [
        libm::hypot(up_low, down_high),
        libm::hypot(up_high, down_low),
    ]
    .map(|off| off / counts.len() as f64)
}

/// The state of a table at the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndOfTable {
    /// Its kinetic energy corresponds to kT.
    Thermal,
    /// It has less, or nothing drives it.
    Frozen,
    /// It has more, or something other than shaking drives it.
    Driven,
}

impl EndOfTable {
    /// Its name in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Thermal => "thermal",
            Self::Frozen => "frozen",
            Self::Driven => "driven",
        }
    }
}

/// Largest relative deviation of a thermal table's kinetic energy from that of kT, unless the
/// statistical error is larger.
pub const THERMAL: f64 = 0.1;

/// How long bonds or traps last.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Lifetime {
    /// How many there were.
    pub begun: usize,
    /// How many ended.
    pub ended: usize,
    /// Their total time (s).
    #[serde(rename = "time_s")]
    pub time: f64,
    /// Total time over number of ends (s); `None` if none ended.
    #[serde(rename = "mean_s")]
    pub mean: Option<f64>,
    /// Its 95 % interval (s); the upper end is `None` if nothing bounds it.
    #[serde(rename = "interval_s")]
    pub interval: [Option<f64>; 2],
}

/// The structures of a kind and size at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Built {
    /// The kind.
    pub shape: StructureShape,
    /// The number of tiles.
    pub size: usize,
    /// How many there are in a run.
    pub count: MeanInterval,
    /// The share of their possible bonds that are closed.
    pub closed: f64,
    /// Holes in each, mean.
    pub holes: f64,
}

/// All runs at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Since the start (s).
    pub time: f64,
    /// Bonds.
    pub bonds: MeanInterval,
    /// Traps.
    pub traps: MeanInterval,
    /// Tiles of the largest cluster.
    pub largest: MeanInterval,
    /// Tiles in structures that are the goal.
    pub in_target: MeanInterval,
}

/// Statistics over the runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    /// Bonds at the end.
    pub bonds: MeanInterval,
    /// Traps at the end.
    pub traps: MeanInterval,
    /// Held contacts at the end that are neither.
    pub contacts: MeanInterval,
    /// Tiles in traps at the end.
    pub trapped: MeanInterval,
    /// Structures at the end, by kind and size.
    pub structures: Vec<Built>,
    /// Sizes of clusters at the end with their mean count per run.
    pub clusters: Vec<(usize, f64)>,
    /// Over time.
    pub moments: Vec<Moment>,
    /// Kinetic energy per degree of freedom over kT, of the second half of the time.
    pub kinetic_kt: Option<f64>,
    /// Statistical error of the kinetic energy of thermal tiles, as a share of it.
    pub kinetic_error: f64,
    /// What the kinetic energy means.
    pub verdict: EndOfTable,
    /// The largest energy error of the runs.
    pub energy_error: f64,
    /// The shortest step of a run (s).
    pub step: f64,
    /// Runs whose steps were halved.
    pub halved: usize,
    /// Lifetimes of bonds and of traps.
    pub lifetimes: [Lifetime; 2],
}

impl Statistics {
    /// Whether the kinetic energy is compatible with kT only because so few samples determine it.
    pub fn is_undecided(&self) -> bool {
        self.verdict == EndOfTable::Thermal
            && self.kinetic_kt.is_some_and(|share| off(share) > THERMAL)
    }

    /// Computes the statistics of at least one run.
    pub fn of(runs: &[Run], settings: &TableSettings) -> Self {
        let at_end = |tie: Tie| {
            let count = |run: &Run| run.samples.last().map_or(0, |last| last.count(tie));
            MeanInterval::of(&runs.iter().map(count).collect::<Vec<_>>())
        };
        let kinetic = runs.iter().map(|run| run.kinetic).sum::<f64>() / runs.len() as f64;
        let kinetic_kt = settings.shaking.map(|kt| kinetic / kt);
        let kinetic_error = chance(runs, settings);
        let verdict = match kinetic_kt {
            Some(share) if off(share) <= THERMAL.max(kinetic_error) => EndOfTable::Thermal,
            Some(share) if share < 0.5 => EndOfTable::Frozen,
            None if !settings.is_driven() => EndOfTable::Frozen,
            _ => EndOfTable::Driven,
        };
        Self {
            bonds: at_end(Tie::Bond),
            traps: at_end(Tie::Trap),
            contacts: at_end(Tie::Contact),
            trapped: MeanInterval::of(&runs.iter().map(in_traps).collect::<Vec<_>>()),
            structures: structures(runs),
            clusters: clusters(runs),
            moments: moments(runs),
            kinetic_kt,
            kinetic_error,
            verdict,
            energy_error: runs.iter().map(|run| run.energy_error).fold(0.0, f64::max),
            step: runs
                .iter()
                .map(|run| run.step)
                .fold(f64::INFINITY, f64::min),
            halved: runs.iter().filter(|run| run.step < settings.step).count(),
            lifetimes: [Tie::Bond, Tie::Trap].map(|tie| lifetime(runs, tie)),
        }
    }
}

/// The relative deviation of a kinetic energy per degree of freedom (kT) from that in equilibrium.
fn off(share: f64) -> f64 {
    (2.0 * share - 1.0).abs()
}

/// The statistical error of the mean kinetic energy of thermal tiles, as a share of it: twice the
/// standard deviation, since the square of a normal velocity varies by sqrt(2) of its mean, and the
/// second half of a run of the time T has `drag T / 2` independent ones of each degree of freedom.
fn chance(runs: &[Run], settings: &TableSettings) -> f64 {
    let tiles: usize = runs.iter().map(|run| run.movers.len()).sum();
    let independent = (settings.drag * settings.duration / 2.0).max(1.0);
    2.0 * (2.0 / (3.0 * tiles as f64 * independent)).sqrt()
}

fn clusters(runs: &[Run]) -> Vec<(usize, f64)> {
    let last = runs.iter().filter_map(|run| run.samples.last());
    let mut sizes: Vec<usize> = last
        .flat_map(|last| last.clusters.iter().copied())
        .collect();
    sizes.order_by_key(|size| *size);
    let mut counted: Vec<(usize, f64)> = Vec::new();
    for size in sizes {
        match counted.last_mut() {
            Some((known, count)) if *known == size => *count += 1.0,
            _ => counted.push((size, 1.0)),
        }
    }
    for (_, count) in &mut counted {
        *count /= runs.len() as f64;
    }
    counted
}

/// The number of tiles in traps at the end.
fn in_traps(run: &Run) -> usize {
    let held = run.samples.last().into_iter().flat_map(|it| &it.held);
    let traps = held.filter(|held| held.tie == Tie::Trap);
    traps
        .flat_map(|held| held.tiles)
        .collect::<BTreeSet<_>>()
        .len()
}

/// The number of tiles, the same in all runs.
fn tiles_of(runs: &[Run]) -> usize {
    runs.first().map_or(0, |run| run.movers.len())
}

fn structures(runs: &[Run]) -> Vec<Built> {
    let tiles = tiles_of(runs);
    let mut found: BTreeMap<(StructureShape, usize), Vec<(usize, &Structure)>> = BTreeMap::new();
    for (number, run) in runs.iter().enumerate() {
        for it in run.samples.last().into_iter().flat_map(|it| &it.structures) {
            let of_kind = found.entry((it.shape, it.tiles.len())).or_default();
            of_kind.push((number, it));
        }
    }
    let built = |((shape, size), all): ((StructureShape, usize), Vec<(usize, &Structure)>)| {
        let in_run = |run: usize| all.iter().filter(|it| it.0 == run).count();
        let counts: Vec<usize> = (0..runs.len()).map(in_run).collect();
        let mean = |of: fn(&Structure) -> f64| {
            all.iter().map(|it| of(it.1)).sum::<f64>() / all.len() as f64
        };
        Built {
            shape,
            size,
            count: MeanInterval::of(&counts).up_to(tiles / size),
            closed: mean(|it| it.bonds as f64 / it.possible as f64),
            holes: mean(|it| it.holes as f64),
        }
    };
    found.into_iter().map(built).collect()
}

/// All runs at the times of the first run's samples; with halved steps the times agree to within a
/// step.
fn moments(runs: &[Run]) -> Vec<Moment> {
    let tiles = tiles_of(runs);
    let count = runs.iter().map(|run| run.samples.len()).min().unwrap_or(0);
    (0..count)
        .map(|k| {
            let of = |get: &dyn Fn(&physics::table::Sample) -> usize| {
                MeanInterval::of(
                    &runs
                        .iter()
                        .map(|run| get(&run.samples[k]))
                        .collect::<Vec<_>>(),
                )
            };
            Moment {
                time: runs[0].samples[k].time,
                bonds: of(&|it| it.count(Tie::Bond)),
                traps: of(&|it| it.count(Tie::Trap)),
                in_target: of(&in_target).up_to(tiles),
                largest: of(&|it| it.clusters.first().copied().unwrap_or(0)).up_to(tiles),
            }
        })
        .collect()
}

fn lifetime(runs: &[Run], tie: Tie) -> Lifetime {
    let mut lifetime = Lifetime {
        begun: 0,
        ended: 0,
        time: 0.0,
        mean: None,
        interval: [None; 2],
    };
    for run in runs {
        let end = run.samples.last().map_or(0.0, |last| last.time);
        let of_tie = run.lives.iter().filter(|life: &&Life| life.tie == tie);
        for life in of_tie {
            lifetime.begun += 1;
            lifetime.ended += usize::from(life.to.is_some());
            lifetime.time += life.to.unwrap_or(end) - life.from;
        }
    }
    if lifetime.begun > 0 {
        let [low, high] = poisson_interval(lifetime.ended);
        lifetime.mean = (lifetime.ended > 0).then(|| lifetime.time / lifetime.ended as f64);
        lifetime.interval = [high, low].map(|count| (count > 0.0).then(|| lifetime.time / count));
    }
    lifetime
}

/// The number of tiles in structures that are the goal.
pub(super) fn in_target(sample: &physics::table::Sample) -> usize {
    let targets = sample.structures.iter();
    let targets = targets.filter(|it| it.shape == StructureShape::Target);
    targets.map(|it| it.tiles.len()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn runs_that_agree_prove_little() {
        let ends = |counts: &[usize]| {
            let found = MeanInterval::of(counts);
            (found.low, found.high)
        };
        assert_eq!(ends(&[3]), (None, None));
        // Garwood's upper end for no event, over the number of runs.
        let (low, high) = ends(&[0; 4]);
        assert!(low == Some(0.0) && (high.unwrap() - 3.689 / 4.0).abs() < 1e-3);
        let (low, high) = ends(&[12; 20]);
        let off = [12.0 - low.unwrap(), high.unwrap() - 12.0];
        assert!(off.iter().all(|off| (off - 3.689 / 20.0).abs() < 1e-3));
        assert_eq!(MeanInterval::of(&[8; 2]).up_to(8).high, Some(8.0));
        let of_pairs = MeanInterval::of(&[12; 20]).of_at_most(12);
        assert!(of_pairs.mean == 1.0 && of_pairs.high == Some(1.0) && of_pairs.low < Some(0.99));
        // Student's t of four values with a standard deviation of 2.582.
        let (low, high) = ends(&[3, 5, 7, 9]);
        assert!(
            (high.unwrap() - 6.0 - 4.108).abs() < 1e-2 && (6.0 - low.unwrap() - 4.108).abs() < 1e-2
        );
    }

    #[test]
    fn the_mean_of_rare_counts_lies_in_their_intervals() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        for (mean, runs) in [
            (0.06, 4),
            (0.1, 10),
            (0.3, 4),
            (1.0, 10),
            (3.0, 4),
            (9.9, 5),
        ] {
            let mut count = || (0..10).filter(|_| rng.random_bool(mean / 10.0)).count();
            let mut holds = || {
                let found = MeanInterval::of(&(0..runs).map(|_| count()).collect::<Vec<_>>());
                found.low <= Some(mean) && found.high >= Some(mean)
            };
            let held = (0..500).filter(|_| holds()).count();
            assert!(held > 465, "{held} of 500 for {mean} in {runs} runs");
        }
    }
}
