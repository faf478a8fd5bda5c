//! Runs of a table: their observations, and the energy balance.

use std::collections::BTreeMap;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::contacts::{Held, Tie, clusters, held};
use super::crowd::Crowd;
use super::settings::TableSettings;
use super::start::{StartError, at_random, check};
use super::stepper::{StepError, Stepper};
use super::structures::{Structure, structures};
use crate::rigid::{Account, Mover};

/// Largest allowed share of missing energy, relative to the largest term of the balance; beyond it
/// the step is halved.
pub const ACCOUNTED: f64 = 0.01;
/// The step is halved at most this often.
pub const HALVINGS: usize = 4;

/// The table at one time.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Sample {
    /// Since the start (s).
    pub time: f64,
    /// Kinetic energy (J).
    pub kinetic: f64,
    /// Magnetic energy, and that of tiles in fans without their oscillation (J).
    pub potential: f64,
    /// The other terms of the energy balance.
    pub account: Account,
    /// Bonds, traps and other contacts.
    pub held: Vec<Held>,
    /// Sizes of clusters, in descending order.
    pub clusters: Vec<usize>,
    /// What the tiles have built.
    pub structures: Vec<Structure>,
    /// The tiles, if they are recorded.
    pub movers: Option<Vec<Mover>>,
}

impl Sample {
    /// The number of bonds, traps or other contacts.
    pub fn count(&self, tie: Tie) -> usize {
        self.held.iter().filter(|held| held.tie == tie).count()
    }

    /// The energy (J) that is missing from the balance since the start.
    fn missing(&self, start: &Self) -> f64 {
        self.kinetic + self.potential - self.account.work
            + self.account.contact_loss
            + self.account.drag_loss
            + self.account.table_loss
            - start.kinetic
            - start.potential
    }

    /// The largest term of the energy balance (J).
    fn largest(&self) -> f64 {
        let Account {
            work,
            contact_loss,
            drag_loss,
            table_loss,
        } = self.account;
        let losses = [contact_loss, drag_loss, table_loss];
        [self.kinetic, self.potential, work]
            .into_iter()
            .chain(losses)
            .map(f64::abs)
            .fold(0.0, f64::max)
    }
}

/// A finished run.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Run {
    /// Its number, from 0.
    pub index: usize,
    /// The table at regular times, including the first and the last.
    pub samples: Vec<Sample>,
    /// The tiles at the end.
    pub movers: Vec<Mover>,
    /// Mean kinetic energy per degree of freedom (J) over the second half of the time.
    pub kinetic: f64,
    /// The largest missing energy over the largest term.
    pub energy_error: f64,
    /// The step (s) after any halving.
    pub step: f64,
    /// The number of steps that tiles near each other, the rim or a fan have made within those.
    pub steps: u64,
    /// The lifetimes of bonds and traps, ended or not.
    pub lives: Vec<Life>,
}

/// A bond or a trap from its beginning to its end.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Life {
    /// The tiles.
    pub tiles: [usize; 2],
    /// The kind of contact.
    pub tie: Tie,
    /// The time it formed (s).
    pub from: f64,
    /// The time it ended (s); `None` if it lasted to the end of the run.
    pub to: Option<f64>,
}

/// The starting positions of the tiles.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Start {
    /// Numbers of tiles of each kind, at random positions.
    Random(Vec<usize>),
    /// Given tiles.
    Given(Vec<Mover>),
}

impl Start {
    /// The number of tiles.
    pub fn tiles(&self) -> usize {
        match self {
            Self::Random(counts) => counts.iter().sum(),
            Self::Given(movers) => movers.len(),
        }
    }
}

/// Why a run failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The run could not start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The run could not go on.
    #[error(transparent)]
    Step(#[from] StepError),
}

/// The random numbers of a run, independent of all others.
pub fn stream(seed: u64, index: usize) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream((1 << 42) + index as u64);
    rng
}

/// Simulates one run. `frames` records the tiles in every sample.
///
/// # Errors
/// If the run cannot start, or the steps are far too long.
pub fn run(
    crowd: &Crowd,
    settings: &TableSettings,
    which: (u64, usize),
    start: &Start,
    frames: bool,
) -> Result<Run, RunError> {
    watched(crowd, settings, which, start, (frames, &|_| ()))
}

/// The same; calls `watch` with the share of the run that is done after every sample, again from 0 if
/// the run is repeated with shorter steps.
///
/// # Errors
/// As [`run`].
pub fn watched(
    crowd: &Crowd,
    settings: &TableSettings,
    (seed, index): (u64, usize),
    start: &Start,
    (frames, watch): (bool, &dyn Fn(f64)),
) -> Result<Run, RunError> {
    let mut rng = stream(seed, index);
    let movers = match start {
        Start::Random(counts) => at_random(crowd, counts, settings.shaking, &mut rng)?,
        Start::Given(movers) => movers.clone(),
    };
    check(crowd, &movers, settings.walls)?;
    let mut settings = settings.clone();
    for halving in 0.. {
        let run = once(crowd, &settings, index, (&movers, &rng), (frames, watch));
        let is_sound = run.as_ref().is_ok_and(|run| run.energy_error <= ACCOUNTED);
        if is_sound || halving == HALVINGS {
            return Ok(run?);
        }
        settings.step *= 0.5;
    }
    unreachable!("the last of the halvings returns")
}

fn once(
    crowd: &Crowd,
    settings: &TableSettings,
    index: usize,
    (movers, rng): (&[Mover], &ChaCha8Rng),
    (frames, watch): (bool, &dyn Fn(f64)),
) -> Result<Run, StepError> {
    let random = |tile: usize| {
        let mut rng = rng.clone();
        rng.set_stream(rng.get_stream() + ((1 + tile as u64) << 43));
        rng.set_word_pos(0);
        rng
    };
    let mut stepper = Stepper::new(crowd, settings, movers.to_vec(), &random);
    let [steps, between] = settings.steps();
    let mut samples = vec![sample(crowd, &mut stepper, frames)];
    let mut sums = (0.0, 0u64);
    let mut lives: Vec<Life> = Vec::new();
    let mut open = BTreeMap::new();
    follow(&mut lives, &mut open, &samples[0]);
    for step in 1..=steps {
        stepper.step()?;
        if 2 * step >= steps {
            sums = (sums.0 + stepper.kinetic(), sums.1 + 1);
        }
        if step % between == 0 || step == steps {
            samples.push(sample(crowd, &mut stepper, frames));
            follow(&mut lives, &mut open, &samples[samples.len() - 1]);
            watch(step as f64 / steps as f64);
        }
    }
    let missing = samples.iter().map(|it| it.missing(&samples[0]).abs());
    let missing = missing.fold(0.0, f64::max);
    let largest = samples.iter().map(Sample::largest).fold(0.0, f64::max);
    Ok(Run {
        index,
        kinetic: sums.0 / sums.1 as f64 / (3 * movers.len()) as f64,
        energy_error: if largest > 0.0 {
            missing / largest
        } else {
            0.0
        },
        step: settings.step,
        steps: stepper.steps,
        movers: stepper.movers(),
        samples,
        lives,
    })
}

fn sample(crowd: &Crowd, stepper: &mut Stepper, frames: bool) -> Sample {
    let movers = stepper.movers();
    let held = held(crowd, &movers, stepper.near_pairs());
    Sample {
        time: stepper.time,
        kinetic: stepper.kinetic(),
        potential: stepper.potential(),
        account: stepper.account,
        clusters: clusters(movers.len(), &held),
        structures: structures(crowd, &movers, &held),
        held,
        movers: frames.then_some(movers),
    }
}

/// Updates the lifetimes with a sample; `open` are the indices of those that have not ended.
fn follow(lives: &mut Vec<Life>, open: &mut BTreeMap<([usize; 2], Tie), usize>, sample: &Sample) {
    let mut last = std::mem::take(open);
    for held in &sample.held {
        let key = (held.tiles, held.tie);
        let known = last.remove(&key).unwrap_or_else(|| {
            lives.push(Life {
                tiles: held.tiles,
                tie: held.tie,
                from: sample.time,
                to: None,
            });
            lives.len() - 1
        });
        open.insert(key, known);
    }
    for ended in last.into_values() {
        lives[ended].to = Some(sample.time);
    }
}
