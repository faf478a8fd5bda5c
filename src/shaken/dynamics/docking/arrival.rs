//! How shaken tiles that are apart attach: the counts behind rates of attachment.
//!
//! A pair is *apart* where `|U| < kT`. As long as it has not attached, its density there is
//! `c exp(-U / kT)` with the same c everywhere, so the number of attachments over the time apart is
//! `kappa / a` with
//!
//! `a = integral of exp(-U / kT) over the configurations apart / 2 pi` (m^2),
//!
//! and kappa (m^2/s) is the rate for one partner per square metre, whatever the size of the table.
//! The runs therefore take place on a table only so large that most of its room is apart, where tiles
//! meet soonest. Time that a tile spends in contact or in a trap is not time apart. Runs start in equilibrium
//! among the configurations apart, and end at the first attachment, so their number per time does
//! not depend on the duration either.
//!
//! On a table both tiles move. The moving tile therefore has the pair's reduced mass and moment of
//! inertia ([`Body::relative`]): tiles of one mass meet sqrt 2 times as often as one of them at rest would.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::experiment::{Experiment, minimum_below};
use super::{DockingError, DockingSettings, stream};
use crate::dynamics::{Body, Motion, Stop};
use crate::rigid::thermal_velocity;
use landscape::minimum::Known;
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::{Problem, Room};

/// A matched tile is attached once its total energy lies this many kT below that of tiles at rest far
/// apart: a tile that only flies by keeps its energy, and one that has lost so much leaves again
/// before it has come to equilibrium in about exp(-3) = 5 % of cases.
const ATTACHED_BELOW_KT: f64 = 3.0;

/// The end of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// How long (s) the run took.
    pub time: f64,
    /// How long (s) the tiles were apart.
    pub apart: f64,
    /// What caught the moving tile, if anything did.
    pub caught: Option<Caught>,
}

/// What caught a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Caught {
    /// The bond, at any time of the run.
    Bond,
    /// At the end of the run the tile touches the other one unmatched and is too slow to come free:
    /// the minimum that overdamped motion reaches from there, if any.
    Minimum(Option<Configuration>),
    /// Unknown: at the end of the run the impulses of contact were not found.
    Unsolved,
}

/// The runs of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrivals {
    /// The weighted area a (m^2) of configurations apart.
    pub area: f64,
    /// The runs, in order.
    pub runs: Vec<Arrival>,
}

/// The runs are repeated at most so many times to count enough attachments.
pub const MOST_REPEATS: usize = 10;

/// Simulates shaken tiles that start apart, anywhere inside the rim and in thermal motion, until
/// they attach or the time is over; the starts of `settings` are ignored. More runs follow, as many
/// again each time, until `enough` of all end in the bond.
///
/// # Errors
/// As [`super::dock`]; if the tiles have no place to be apart.
pub fn arrivals(
    problem: &Problem,
    settings: &DockingSettings,
    enough: usize,
    done: &(dyn Fn() + Sync),
) -> Result<Arrivals, DockingError> {
    let mut experiment = Experiment::of_body(problem, settings, Body::relative)?;
    let kt = settings.motion.shaking.unwrap_or(0.0);
    let starts = Apart::new(problem, kt)?;
    experiment.simulation = experiment.simulation.within(starts.half_size);
    let arrive = |index: usize| {
        let arrival = arrive(&experiment, &starts, kt, index);
        done();
        arrival
    };
    let mut runs = Vec::new();
    for repeat in 0..MOST_REPEATS {
        let first = repeat * settings.runs;
        let more = parallel::map(first..first + settings.runs, arrive);
        runs.extend(more);
        let is_bound = |run: &&Arrival| run.caught == Some(Caught::Bond);
        if runs.iter().filter(is_bound).count() >= enough {
            break;
        }
    }
    Ok(Arrivals {
        area: starts.area,
        runs,
    })
}

fn arrive(experiment: &Experiment, starts: &Apart, kt: f64, index: usize) -> Arrival {
    let Experiment {
        problem,
        settings,
        simulation,
        rule,
        ..
    } = experiment;
    let mut rng = stream(settings.seed, index);
    let start = Motion {
        configuration: starts.draw(&mut rng),
        velocity: thermal_velocity(&simulation.body, kt, &mut rng),
    };
    let (mut apart, mut since, mut is_bound) = (0.0, 0.0, false);
    let run = simulation.run(&start, settings.duration, &mut rng, &mut |now| {
        if is_apart(now.potential, kt) {
            apart += now.time - since;
        }
        since = now.time;
        is_bound = now.total() < -ATTACHED_BELOW_KT * kt && rule.holds(&now.motion.configuration);
        is_bound
    });
    let last = &run.last;
    let minimum = || minimum_below(problem, &last.motion.configuration, &Known::default());
    let caught = match (run.stop, is_bound) {
        (Stop::Failed, _) => Some(Caught::Unsolved),
        (_, true) => Some(Caught::Bond),
        (_, false) => {
            (last.in_contact_range && last.total() < 0.0).then(|| Caught::Minimum(minimum()))
        }
    };
    Arrival {
        time: last.time,
        apart,
        caught,
    }
}

fn is_apart(energy: f64, kt: f64) -> bool {
    energy.abs() < kt
}

/// The configurations of a pair that is apart, in equilibrium.
struct Apart {
    places: Vec<Configuration>,
    /// For each place the sum of the Boltzmann factors up to it.
    sums: Vec<f64>,
    area: f64,
    /// Half the size (m) of the table along x and y.
    half_size: [f64; 2],
}

/// Half the size of the smallest table, over the distance at which tiles are free of each other.
const NEAR: f64 = 1.5;
/// How much larger the next one is.
const LARGER: f64 = 1.25;
/// The share of a table's room that is to be apart.
const MOST_APART: f64 = 0.5;

impl Apart {
    /// On the smallest table that leaves room to be apart, at most that of the problem.
    fn new(problem: &Problem, kt: f64) -> Result<Self, DockingError> {
        let whole = problem.space.half_size;
        let mut reach = NEAR * problem.space.free_distance;
        while reach < whole[0].max(whole[1]) {
            let half_size = whole.map(|half| half.min(reach));
            let found = Room::within(problem, half_size).ok().and_then(|room| {
                let apart = Self::of(problem, &room, half_size, kt)?;
                let is_wide = apart.places.len() as f64 >= MOST_APART * room.places.len() as f64;
                is_wide.then_some(apart)
            });
            if let Some(found) = found {
                return Ok(found);
            }
            reach *= LARGER;
        }
        let room = Room::new(problem)?;
        Self::of(problem, &room, whole, kt).ok_or(DockingError::NeverApart(kt))
    }

    /// Those of some room; `None` if there are none.
    fn of(problem: &Problem, room: &Room, half_size: [f64; 2], kt: f64) -> Option<Self> {
        let energies = problem.energies(&room.places);
        let (mut places, mut sums, mut sum) = (Vec::new(), Vec::new(), 0.0);
        for (place, &energy) in room.places.iter().zip(&energies) {
            if is_apart(energy, kt) {
                sum += libm::exp(-energy / kt);
                places.push(*place);
                sums.push(sum);
            }
        }
        let area = room.area * sum / room.places.len() as f64;
        (!places.is_empty()).then_some(Self {
            places,
            sums,
            area,
            half_size,
        })
    }

    fn draw(&self, rng: &mut ChaCha8Rng) -> Configuration {
        let last = self.sums.len() - 1;
        let sought = rng.random::<f64>() * self.sums[last];
        self.places[self.sums.partition_point(|sum| *sum <= sought).min(last)]
    }
}
