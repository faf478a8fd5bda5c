//! How often shaken tiles attach, counted in docking runs or solved on a mesh.
//!
//! The rate kappa (m^2/s) of a pair, for one partner per square metre, is the rate (1/s) at which a
//! pair that is apart attaches, times the area a (m^2) that it then has: the Boltzmann factor of the
//! configurations that count as apart, integrated over x, y and theta, over 2 pi. Both refer to what
//! was simulated ([`docking::arrivals`]) or solved ([`MeshRates`](physics::kinetics::rates::MeshRates)),
//! so kappa does not depend on the design's table, and kappa over the rate of detachment is the
//! bond's partition sum over 2 pi (detailed balance).

use std::f64::consts::TAU;

use nalgebra::DMatrix;

use super::{Request, YieldError};
use crate::pipeline::Analysis;
use crate::request::{self, ContactOptions, Word, options};
use physics::configuration::Configuration;
use physics::dynamics::MotionSettings;
use physics::dynamics::docking::{self, Arrivals, Caught, DockingError, DockingSettings, Starts};
use physics::kinetics::OVERDAMPED;
use physics::kinetics::bond::Hold;
use physics::kinetics::rates::{Basin, RateSettings, rates};
use physics::landscape::{Catalogue, Kind};
use physics::problem::Problem;

/// Two configurations closer than this (m, metric of the space) are the same state.
const SAME: f64 = 5e-3;

options! {
    /// The method for attachment rates, and the motion of tiles.
    #[derive(Clone, Debug, PartialEq)]
    pub struct AttachmentOptions {
        /// Docking runs per kT
        pub runs: usize = value("N", request::runs).or(400),

        /// Repeat the docking runs, up to ten times in all, until so many attached to the bond
        ///
        /// 100 determine the attachment rate to 20 %; 0: no repeats.
        pub attachments: usize = value("N", request::runs_or_none).or(0),

        /// Duration of each docking run (s)
        pub duration: f64 = value("S", crate::docking::duration).or(10.0),

        /// Source of attachment rates: docking or overdamped
        ///
        /// docking: counted in docking runs of tiles with inertia, lossy contact and drag. overdamped:
        /// overdamped motion solved on a mesh, which ignores --runs, --duration, --friction and
        /// --restitution.
        pub source: RateSource = value("SOURCE", source()).named("rates").or("docking"),

        /// Drag rate (1/s) [default: 0.005 for docking runs, 50 for overdamped motion]
        pub drag: Option<f64> = value("C", request::rate),

        /// Friction and restitution.
        pub contact: ContactOptions = group(),
    }
}

impl AttachmentOptions {
    /// The name of its progress stage.
    pub fn stage(&self) -> &'static str {
        match self.source {
            RateSource::Docking => "docking",
            RateSource::Overdamped => "rates",
        }
    }

    /// Drag, restitution and friction; the shaking is set by kT.
    pub fn motion(&self) -> MotionSettings {
        let usual = MotionSettings::default();
        let drag = match self.source {
            RateSource::Docking => usual.drag,
            RateSource::Overdamped => OVERDAMPED,
        };
        MotionSettings {
            drag: self.drag.unwrap_or(drag),
            restitution: self.contact.restitution,
            friction: self.contact.friction,
            ..usual
        }
    }

    /// The docking runs at `kt` (J).
    pub fn runs_at(&self, kt: f64, seed: u64) -> DockingSettings {
        DockingSettings {
            runs: self.runs,
            seed,
            duration: self.duration,
            starts: Starts::default(),
            motion: MotionSettings {
                shaking: Some(kt),
                ..self.motion()
            },
            threshold: None,
        }
    }

    /// A description of the source of its rates.
    pub fn describe(&self) -> String {
        let MotionSettings {
            drag,
            restitution,
            friction,
            ..
        } = self.motion();
        match self.source {
            RateSource::Docking => format!(
                "attachment counted in {}{} docking runs for each kT (drag {drag} per s, restitution \
                 {restitution}, friction {friction})",
                self.runs,
                if self.attachments > 0 { " or more" } else { "" }
            ),
            RateSource::Overdamped => format!(
                "attachment of overdamped motion, solved on a mesh (drag {drag} per s, \
                 elastic collisions)"
            ),
        }
    }
}

/// The source of attachment rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RateSource {
    /// Counted in docking runs of tiles with inertia, lossy contact and drag.
    Docking,
    /// Overdamped motion solved on a mesh.
    Overdamped,
}

fn source() -> Word<RateSource> {
    let names = [
        ("docking", RateSource::Docking),
        ("overdamped", RateSource::Overdamped),
    ];
    Word::new(&names, "a source is docking or overdamped")
}

/// Numbers of attachments of a pair on the design's table, by kind of state.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachments {
    /// To the bond, then to each kind of trap.
    pub counts: Vec<usize>,
    /// Number of runs that ended at rest elsewhere.
    pub elsewhere: usize,
    /// Number of runs whose ends are unknown: the impulses of contact were not found.
    pub unsolved: usize,
    /// Total time (s) of all runs until attachment or their end.
    pub time: f64,
    /// ... for which their tiles were apart.
    pub apart: f64,
    /// Area (m^2) of a pair that is apart.
    pub area: f64,
    /// Runs.
    pub runs: usize,
    /// The rates of overdamped motion; `None` if attachments are counted.
    pub solved: Option<Solved>,
}

/// Rates of overdamped motion among kinds of states and free tiles, both of which move.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// Rates from free to each kind of state (1/s), and the relative difference of the two finest
    /// meshes.
    pub on: Vec<[f64; 2]>,
    /// Rates from each kind of state to free (1/s).
    pub off: Vec<f64>,
    /// Rates between kinds of states (1/s); the row is the initial one.
    pub turns: DMatrix<f64>,
}

impl Attachments {
    /// kappa (m^2/s) of a kind of state: the rate times the area.
    pub fn rate(&self, kind: usize) -> f64 {
        match &self.solved {
            Some(solved) => solved.on[kind][0] * self.area,
            None if self.apart > 0.0 => self.counts[kind] as f64 * self.area / self.apart,
            None => 0.0,
        }
    }

    /// The detachment rate (1/s) of a kind of state; `None` if it was not solved.
    pub fn off(&self, kind: usize) -> Option<f64> {
        self.solved.as_ref().map(|solved| solved.off[kind])
    }

    /// The rates (1/s) among some kinds of states without passing through free tiles.
    pub fn turns(&self, kinds: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(kinds.len(), kinds.len(), |i, j| match &self.solved {
            Some(solved) => solved.turns[(kinds[i], kinds[j])],
            None => 0.0,
        })
    }

    /// Whether docking runs were to count attachments to a kind of state, and counted none.
    pub fn counts_none(&self, kind: usize) -> bool {
        self.solved.is_none() && self.counts[kind] == 0
    }

    /// Its 95 % interval, that of a Poisson count, however unsolved runs end; for solved rates, from the
    /// difference of meshes.
    pub fn interval(&self, kind: usize) -> [f64; 2] {
        match &self.solved {
            Some(solved) => {
                let [rate, spread] = solved.on[kind];
                [1.0 - spread, 1.0 + spread].map(|part| part.max(0.0) * rate * self.area)
            }
            None => docking::poisson_at_least(self.counts[kind], self.unsolved)
                .map(|ends| ends * self.area / self.apart),
        }
    }
}

/// Attachments to each kind of state, from the requested source.
pub(super) fn attached(
    analysis: &Analysis,
    holds: &[&Hold],
    kt: f64,
    request: &Request,
) -> Result<Attachments, YieldError> {
    let (problem, effort) = (&analysis.problem, &request.method);
    if effort.source == RateSource::Docking {
        let catalogue = &analysis.catalogue;
        return Ok(count(problem, catalogue, kt, effort, request.seed)?);
    }
    let basins: Vec<Option<Basin>> = holds
        .iter()
        .enumerate()
        .map(|(kind, hold)| {
            let height = hold.well.level - hold.energy;
            let basin = Basin::of_state(hold.configuration, hold.energy, height);
            (kind == 0 || Basin::holds(height, kt)).then_some(basin)
        })
        .collect();
    solve(problem, &basins, kt, effort.motion().drag)
}

/// The rates of overdamped motion at `kt` (J) and a drag rate (1/s) to the kinds of states with these
/// basins; 0 to those that are `None`.
///
/// # Errors
/// As [`rates()`], and where nothing is known of the bond's rate, the first one.
pub fn solve(
    problem: &Problem,
    basins: &[Option<Basin>],
    kt: f64,
    drag: f64,
) -> Result<Attachments, YieldError> {
    let held: Vec<Basin> = basins.iter().copied().flatten().collect();
    let settings = RateSettings {
        both_move: true,
        ..RateSettings::new(kt, held, problem.space.free_distance)
    };
    let found = rates(problem, &settings)?;
    let mass = problem.pair.as_ref().map_or(1.0, |pair| pair.moving.mass);
    let free = settings.basins.len();
    let ground = settings.ground(problem);
    let volume = found.finest().volumes[free] * libm::exp(-ground / kt);
    if !found.is_known(free, 0) {
        return Err(YieldError::Lost);
    }
    // The indices of the kinds that hold a tile.
    let mut place = 0;
    let places = basins.iter().map(|basin| {
        basin.map(|_| {
            place += 1;
            place - 1
        })
    });
    let places: Vec<Option<usize>> = places.collect();
    let diffusion = kt / (drag * mass);
    let rate = |from: Option<usize>, to: Option<usize>| match (from, to) {
        (Some(from), Some(to)) if from != to => found.finest().rates[from][to] * diffusion,
        _ => 0.0,
    };
    let on = |place: &Option<usize>| {
        let spread = place.map_or(0.0, |place| found.spread(free, place));
        [rate(Some(free), *place), spread]
    };
    let solved = Solved {
        on: places.iter().map(on).collect(),
        off: places
            .iter()
            .map(|place| rate(*place, Some(free)))
            .collect(),
        turns: DMatrix::from_fn(places.len(), places.len(), |i, j| {
            rate(places[i], places[j])
        }),
    };
    Ok(Attachments {
        counts: vec![0; basins.len()],
        elsewhere: 0,
        unsolved: 0,
        time: 0.0,
        apart: 0.0,
        area: volume / TAU,
        runs: 0,
        solved: Some(solved),
    })
}

/// Counts attachments in docking runs of tiles that start apart, in equilibrium at `kt` (J), and are
/// shaken until they are bound or the run ends. Traps are counted at the end of runs, so a trap that
/// releases tiles within a run is underestimated; but such a trap holds few tiles.
///
/// # Errors
/// As [`docking::arrivals`].
pub fn count(
    problem: &Problem,
    catalogue: &Catalogue,
    kt: f64,
    effort: &AttachmentOptions,
    seed: u64,
) -> Result<Attachments, DockingError> {
    let settings = effort.runs_at(kt, seed);
    let arrivals = docking::arrivals(problem, &settings, effort.attachments, &|| ())?;
    Ok(tally(problem, catalogue, &arrivals))
}

fn tally(problem: &Problem, catalogue: &Catalogue, arrivals: &Arrivals) -> Attachments {
    let kinds: Vec<_> = catalogue.kinds().collect();
    // The bond first, then the traps, in the order of their holds; other contacts that count as the
    // bond are counted with it.
    let bond = kinds.iter().position(Kind::is_bond);
    let traps = (0..kinds.len()).filter(|&k| !kinds[k].is_bond());
    let order: Vec<usize> = bond.into_iter().chain(traps).collect();
    let kind_of = |q: Configuration| {
        let distance = |k: usize| {
            let states = kinds[k].states.iter();
            let distances = states.map(|s| problem.space.distance(&s.configuration, &q));
            distances.fold(f64::INFINITY, f64::min)
        };
        (0..order.len()).find(|&place| distance(order[place]) < problem.scaled(SAME))
    };
    let mut found = Attachments {
        counts: vec![0; kinds.len()],
        elsewhere: 0,
        unsolved: 0,
        time: arrivals.runs.iter().map(|run| run.time).sum(),
        apart: arrivals.runs.iter().map(|run| run.apart).sum(),
        area: arrivals.area,
        runs: arrivals.runs.len(),
        solved: None,
    };
    for caught in arrivals.runs.iter().filter_map(|run| run.caught) {
        let kind = match caught {
            Caught::Bond => Some(0),
            Caught::Minimum(minimum) => minimum.and_then(kind_of),
            Caught::Unsolved => {
                found.unsolved += 1;
                continue;
            }
        };
        match kind {
            Some(kind) => found.counts[kind] += 1,
            None => found.elsewhere += 1,
        }
    }
    found
}
