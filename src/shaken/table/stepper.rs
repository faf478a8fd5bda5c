//! Advances all tiles step by step, and keeps the energy balance.

use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;

use super::crowd::Crowd;
use super::drive::Drive;
use super::neighbours::Neighbours;
use super::scratch::{Scratch, ahead, refill};
use super::settings::TableSettings;
use crate::rigid::{Account, Laws, Margins, Mover, NearPair, Pose, Rider, Solver, Two, Winds};

/// Largest travel, as a share of the same distance.
const MOST_OF_NEAR: f64 = 2.0;

/// Why a run cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// A tile became too fast.
    #[error(transparent)]
    BlowUp(#[from] BlowUp),
    /// Impulses of contact were not found.
    #[error(
        "at {time:.6} s the impulses of {tiles} touching tiles (among them tile {tile}) are not found even in steps \
         of {step:.1e} s: the run has failed; use less friction or another seed"
    )]
    Unsolved {
        /// The time (s).
        time: f64,
        /// The first of the tiles, from 0.
        tile: usize,
        /// Their number.
        tiles: usize,
        /// The shortest step (s) tried.
        step: f64,
    },
}

/// A run in progress.
pub struct Stepper<'a> {
    pub(super) crowd: &'a Crowd,
    pub(super) settings: &'a TableSettings,
    drive: Drive<'a>,
    pub(super) riders: Vec<Rider>,
    /// Mass (kg, kg) and moment of inertia (kg m^2) of each.
    pub(super) masses: Vec<Vector3<f64>>,
    /// The random numbers of each tile.
    random: Vec<ChaCha8Rng>,
    /// Since the start (s).
    pub time: f64,
    /// The energy balance.
    pub account: Account,
    /// The number of steps that islands have made within those of the table.
    pub steps: u64,
    since_kick: usize,
    pub(super) neighbours: Neighbours,
    pub(super) near: Vec<NearPair>,
    pub(super) margins: Margins,
    pub(super) least_near: f64,
    scratch: Scratch,
    /// Solvers of earlier islands, kept to save allocating what they hold.
    pub(super) solvers: Vec<Solver>,
}

/// A tile became too fast for the step.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "at {time:.6} s tile {tile} moves at {speed:.3e} m/s, too fast for steps of {step:.3e} s: the motion \
     is unstable; shorten the step"
)]
pub struct BlowUp {
    /// The time (s).
    pub time: f64,
    /// The tile's index.
    pub tile: usize,
    /// Its speed (m/s).
    pub speed: f64,
    /// The step (s).
    pub step: f64,
}

impl<'a> Stepper<'a> {
    /// Starts with the given tiles; `random` are the random number generators of each tile.
    pub fn new(
        crowd: &'a Crowd,
        settings: &'a TableSettings,
        movers: Vec<Mover>,
        random: &dyn Fn(usize) -> ChaCha8Rng,
    ) -> Self {
        let drive = Drive::new(settings);
        let random = (0..movers.len()).map(random).collect();
        let masses = movers.iter().map(|it| crowd.kinds[it.kind].body.masses());
        let masses = masses.collect();
        let movers = movers.into_iter();
        let riders = movers.map(|mover| Rider { mover, debt: 0.0 });
        let nears = crowd.couples().iter().map(|couple| couple.near);
        let mut stepper = Self {
            crowd,
            settings,
            drive,
            riders: riders.collect(),
            masses,
            random,
            time: 0.0,
            account: Account::default(),
            steps: 0,
            since_kick: 0,
            neighbours: Neighbours::default(),
            near: Vec::new(),
            margins: crowd.margins(),
            least_near: nears.fold(f64::INFINITY, f64::min),
            scratch: Scratch::default(),
            solvers: Vec::new(),
        };
        stepper.prepare(0.0, &mut Scratch::default());
        stepper
    }

    pub(super) fn winds(&self) -> Winds<'a> {
        Winds(&self.settings.fans)
    }

    pub(super) fn laws(&self) -> Laws<'a> {
        let settings = self.settings;
        Laws {
            friction: settings.friction,
            table_friction: settings.table_friction,
            restitution: settings.restitution,
            walls: settings.walls,
            fans: self.winds(),
            is_shaken: settings.shaking.is_some(),
            step: settings.step,
        }
    }

    /// The tiles.
    pub fn movers(&self) -> Vec<Mover> {
        self.riders.iter().map(|it| it.mover).collect()
    }

    /// Kinetic energy (J).
    pub fn kinetic(&self) -> f64 {
        let each = self.riders.iter().map(|it| it.mover);
        each.map(|it| self.crowd.kinds[it.kind].body.kinetic_energy(&it.velocity))
            .sum()
    }

    /// Magnetic energy of all pairs, and the energy of all tiles in fans without their oscillation (J).
    pub fn potential(&mut self) -> f64 {
        let (crowd, movers) = (self.crowd, self.movers());
        let poses: Vec<_> = movers.iter().map(|it| Pose::of(crowd, it)).collect();
        let positions: Vec<_> = poses.iter().map(|pose| pose.at.position()).collect();
        let pairs = self.neighbours.within(crowd.range(), &positions);
        let energy = |&[i, j]: &[usize; 2]| {
            let two = Two::of([movers[i].kind, movers[j].kind], [i, j]);
            let [first, second] = [two.first, two.second];
            let couple = crowd.couple(movers[first].kind, movers[second].kind).0;
            couple.pull(&poses[first].to(&poses[second].at)).0
        };
        let magnetic: f64 = pairs.iter().map(energy).sum();
        let places = movers.iter().map(|it| it.place.xy());
        let winds = places.map(|place| self.winds().wind(place, self.time).energy);
        magnetic + winds.sum::<f64>()
    }

    /// Pairs of tiles that are near each other, with their poses.
    pub fn near_pairs(&self) -> impl Iterator<Item = Two> + '_ {
        self.near.iter().map(|near| near.two)
    }

    /// Makes one step.
    ///
    /// # Errors
    /// If a tile is too fast for the step, or contact cannot be solved.
    pub fn step(&mut self) -> Result<(), StepError> {
        let h = self.settings.step;
        self.check_speeds()?;
        // Half of the drag before the step and half after it: a free tile goes as far as it should.
        if self.settings.shaking.is_none() {
            self.damp(0.5 * h);
        }
        let mut scratch = std::mem::take(&mut self.scratch);
        self.prepare(h, &mut scratch);
        self.move_all(&scratch)?;
        let tiles = self.riders.iter().zip(&self.masses);
        for ((rider, masses), before) in tiles.zip(&scratch.movers) {
            let way = rider.mover.place - before.place;
            self.account.work += masses.x * scratch.carried.dot(&way.xy());
        }
        self.scratch = scratch;
        self.time += h;
        self.since_kick += 1;
        if self.settings.shaking.is_none() {
            self.damp(0.5 * h);
        } else if self.since_kick >= self.settings.steps_between_kicks() {
            let since = self.since_kick as f64 * h;
            self.since_kick = 0;
            self.damp(since);
        }
        Ok(())
    }

    /// Applies drag over a time (s), and the kicks of shaking.
    fn damp(&mut self, time: f64) {
        let tiles = self.riders.iter_mut().zip(&mut self.random);
        for ((rider, random), masses) in tiles.zip(&self.masses) {
            let velocity = &mut rider.mover.velocity;
            let [work, loss] = self.drive.damp(velocity, random, masses, time);
            self.account.work += work;
            self.account.drag_loss += loss;
        }
    }

    fn check_speeds(&self) -> Result<(), BlowUp> {
        let step = self.settings.step;
        for (tile, rider) in self.riders.iter().enumerate() {
            let mover = &rider.mover;
            let reach = self.crowd.kinds[mover.kind].reach;
            let speed = mover.velocity.xy().norm() + reach * mover.velocity.z.abs();
            let may_go = speed * step <= MOST_OF_NEAR * self.least_near;
            if !(may_go && mover.place.iter().all(|x| x.is_finite())) {
                return Err(BlowUp {
                    time: self.time,
                    tile,
                    speed,
                    step,
                });
            }
        }
        Ok(())
    }

    /// Prepares a step of length h (s): finds the near pairs, ties those that may touch, and
    /// computes the poses and the accelerations by the table's motion and by pairs apart.
    fn prepare(&mut self, h: f64, scratch: &mut Scratch) {
        let crowd = self.crowd;
        let Scratch { movers, poses, .. } = scratch;
        refill(movers, self.riders.iter().map(|it| it.mover));
        refill(poses, movers.iter().map(|it| Pose::of(crowd, it)));
        let halfway = movers.iter().map(|mover| ahead(crowd, mover, 0.5 * h));
        refill(&mut scratch.halfway, halfway);
        scratch.carried = self.drive.carry(self.time + 0.5 * h);
        let steady = scratch.carried.push(0.0);
        refill(&mut scratch.steady, movers.iter().map(|_| steady));
        self.sort_pairs(scratch);
        self.pull_apart(scratch);
    }
}
