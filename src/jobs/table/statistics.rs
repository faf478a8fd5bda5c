//! Statistics over the runs of a table.

use physics::dynamics::docking::poisson_interval;
use physics::order::Order;
use physics::table::TableSettings;
use physics::table::contacts::Tie;
use physics::table::run::{Life, Run};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A mean over runs with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The mean.
    pub mean: f64,
    /// The lower end; `None` for a single run.
    pub low: Option<f64>,
    /// The upper end.
    pub high: Option<f64>,
}

impl Interval {
    /// Computed from the runs' values by Student's t.
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
        let half = (values.len() > 1).then(|| {
            let t = StudentsT::new(0.0, 1.0, n - 1.0);
            let t = t.map_or(f64::NAN, |t| t.inverse_cdf(0.975));
            t * (squares / (n - 1.0) / n).sqrt()
        });
        Self {
            mean,
            low: half.map(|half| mean - half),
            high: half.map(|half| mean + half),
        }
    }
}

/// The state of a table at the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Its kinetic energy corresponds to kT.
    Thermal,
    /// It has less, or nothing drives it.
    Frozen,
    /// It has more, or something other than shaking drives it.
    Driven,
}

impl Verdict {
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lifetime {
    /// How many there were.
    pub begun: usize,
    /// How many ended.
    pub ended: usize,
    /// Their total time (s).
    pub time: f64,
    /// Total time over number of ends (s); `None` if none ended.
    pub mean: Option<f64>,
    /// Its 95 % interval (s); the upper end is `None` if nothing bounds it.
    pub interval: [Option<f64>; 2],
}

/// All runs at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Since the start (s).
    pub time: f64,
    /// Bonds.
    pub bonds: Interval,
    /// Traps.
    pub traps: Interval,
    /// Tiles of the largest cluster.
    pub largest: Interval,
}

/// Statistics over the runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    /// Bonds at the end.
    pub bonds: Interval,
    /// Traps at the end.
    pub traps: Interval,
    /// Sizes of clusters at the end with their mean count per run.
    pub clusters: Vec<(usize, f64)>,
    /// Over time.
    pub moments: Vec<Moment>,
    /// Kinetic energy per degree of freedom over kT, of the second half of the time.
    pub kinetic_kt: Option<f64>,
    /// Statistical error of the kinetic energy of thermal tiles, as a share of it.
    pub kinetic_error: f64,
    /// What the kinetic energy means.
    pub verdict: Verdict,
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
        self.verdict == Verdict::Thermal
            && self.kinetic_kt.is_some_and(|share| off(share) > THERMAL)
    }

    /// Computes the statistics of at least one run.
    pub fn of(runs: &[Run], settings: &TableSettings) -> Self {
        let at_end = |tie: Tie| {
            let count = |run: &Run| run.samples.last().map_or(0, |last| last.count(tie)) as f64;
            Interval::of(&runs.iter().map(count).collect::<Vec<_>>())
        };
        let kinetic = runs.iter().map(|run| run.kinetic).sum::<f64>() / runs.len() as f64;
        let kinetic_kt = settings.shaking.map(|kt| kinetic / kt);
        let is_driven = !settings.fans.is_empty() || settings.orbital.is_some();
        let kinetic_error = chance(runs, settings);
        let verdict = match kinetic_kt {
            Some(share) if off(share) <= THERMAL.max(kinetic_error) => Verdict::Thermal,
            Some(share) if share < 0.5 => Verdict::Frozen,
            None if !is_driven => Verdict::Frozen,
            _ => Verdict::Driven,
        };
        Self {
            bonds: at_end(Tie::Bond),
            traps: at_end(Tie::Trap),
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

/// All runs at the times of the first run's samples; with halved steps the times agree to within a
/// step.
fn moments(runs: &[Run]) -> Vec<Moment> {
    let count = runs.iter().map(|run| run.samples.len()).min().unwrap_or(0);
    (0..count)
        .map(|k| {
            let of = |get: &dyn Fn(&physics::table::Sample) -> f64| {
                Interval::of(
                    &runs
                        .iter()
                        .map(|run| get(&run.samples[k]))
                        .collect::<Vec<_>>(),
                )
            };
            Moment {
                time: runs[0].samples[k].time,
                bonds: of(&|it| it.count(Tie::Bond) as f64),
                traps: of(&|it| it.count(Tie::Trap) as f64),
                largest: of(&|it| it.clusters.first().copied().unwrap_or(0) as f64),
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
