//! One trajectory: free flight and contact steps in turn.

use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;

use super::encounter::{BOTH, Encounter, FIXED, MOVING};
use super::flight;
use super::force::Forces;
use super::simulation::{Run, Simulation, Snapshot, Stop};
use crate::rigid::{Account, Island, Masses, Mover, NearPair, Pose, Rider, Solver, State};
use crate::rigid::{Motion, Phase, normal};

/// A tile in contact is at rest when no point of it moves faster than this (m/s), which is a
/// ten-thousandth of the speed at which magnets bring tiles of any size together, ...
const REST_SPEED: f64 = 1e-5;
/// ... for this long (s).
const REST_TIME: f64 = 0.02;
/// Shortest free step (s): no magnetic force changes a path faster.
const SHORTEST_STEP: f64 = 1e-7;
/// The first free step (s).
const FIRST_STEP: f64 = 1e-3;

impl Simulation<'_> {
    /// The snapshot of a motion at time 0.
    pub fn snapshot(&self, motion: &Motion) -> Snapshot {
        let mut trajectory = Trajectory::new(self, motion);
        trajectory.sense_contact();
        trajectory.snapshot()
    }

    /// The trajectory from `start` over `duration` (s). `watch` is called at every step and ends
    /// the trajectory by returning true; `rng` provides the random numbers of the shaking.
    pub fn run(
        &self,
        start: &Motion,
        duration: f64,
        rng: &mut ChaCha8Rng,
        watch: &mut dyn FnMut(&Snapshot) -> bool,
    ) -> Run {
        let mut trajectory = Trajectory::new(self, start);
        let stop = trajectory.advance(duration, rng, watch);
        Run {
            last: trajectory.snapshot(),
            stop,
            free_steps: trajectory.free_steps,
            contact_steps: trajectory.contact_steps,
        }
    }
}

/// A trajectory in progress.
struct Trajectory<'a, 'b> {
    simulation: &'b Simulation<'a>,
    forces: Forces<'b>,
    phase: Phase,
    time: f64,
    potential: f64,
    touching: bool,
    /// The correction of the kinetic energy in contact that is still outstanding (J).
    debt: f64,
    /// Distance (m) that a point of the tile can move before the clearance must be computed again.
    room: f64,
    /// What is known of contact from earlier.
    near: Option<NearPair>,
    free_step: f64,
    free_steps: usize,
    contact_steps: usize,
}

impl<'a, 'b> Trajectory<'a, 'b> {
    fn new(simulation: &'b Simulation<'a>, start: &Motion) -> Self {
        Self {
            simulation,
            forces: simulation.forces(),
            phase: simulation.body.phase(start),
            time: 0.0,
            potential: 0.0,
            touching: false,
            debt: 0.0,
            room: 0.0,
            near: None,
            free_step: simulation.problem.scale().time(FIRST_STEP),
            free_steps: 0,
            contact_steps: 0,
        }
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot {
            time: self.time,
            motion: self.simulation.body.motion(&self.phase),
            potential: self.potential,
            kinetic: self.simulation.body.kinetic_energy(&self.phase.velocity),
            in_contact_range: self.touching,
        }
    }

    /// Measures the clearance and decides between flight and contact.
    fn sense_contact(&mut self) {
        let range = self.simulation.settings.contact_range;
        let clearance = self.simulation.clearance(&self.phase);
        self.touching = clearance <= range;
        self.room = clearance - 0.5 * range;
        self.potential = self.forces.conservative(&self.phase.place, self.time).0;
    }

    fn advance(
        &mut self,
        duration: f64,
        rng: &mut ChaCha8Rng,
        watch: &mut dyn FnMut(&Snapshot) -> bool,
    ) -> Stop {
        self.sense_contact();
        let shaken = self.simulation.settings.shaking;
        let scale = self.simulation.problem.scale();
        let interval = self.simulation.settings.kick_interval(scale);
        let mut stop = None;
        while stop.is_none() && self.time < duration {
            let until = match shaken {
                Some(_) => (self.time + interval).min(duration),
                None => duration,
            };
            let since = self.time;
            while stop.is_none() && self.time < until {
                tiles::interruption::check();
                stop = if self.touching {
                    self.touch(until, watch)
                } else {
                    self.fly(until, watch)
                };
            }
            if let Some(energy) = shaken {
                self.kick(energy, self.time - since, rng);
            }
        }
        stop.unwrap_or(Stop::Time)
    }

    /// Free flight until contact is near or the time is over.
    fn fly(&mut self, until: f64, watch: &mut dyn FnMut(&Snapshot) -> bool) -> Option<Stop> {
        let settings = &self.simulation.settings;
        let scale = self.simulation.problem.scale();
        let rho = self.simulation.problem.space.rho;
        let shortest = scale.time(SHORTEST_STEP);
        let mut acceleration = self.forces.acceleration(&self.phase, self.time);
        while self.time < until {
            let left = until - self.time;
            let h = self
                .free_step
                .min(settings.longest_step)
                .min(self.time_to_travel(&acceleration, self.room.max(0.0)))
                .max(shortest)
                .min(left);
            let trial = flight::attempt(
                &self.forces,
                &self.phase,
                acceleration,
                (self.time, h),
                (rho, scale),
            );
            let factor = flight::step_factor(trial.error / settings.tolerance);
            if trial.error > settings.tolerance && h > shortest {
                self.free_step = h * factor;
                continue;
            }
            self.free_step = if factor < 1.0 {
                h * factor
            } else {
                self.free_step.max(h * factor)
            };
            self.room -= self.way(&acceleration, h);
            self.phase = trial.phase;
            acceleration = trial.acceleration;
            self.time = if h == left { until } else { self.time + h };
            self.free_steps += 1;
            if self.room <= 0.5 * settings.contact_range {
                self.sense_contact();
            } else {
                self.potential = self.forces.conservative(&self.phase.place, self.time).0;
            }
            if watch(&self.snapshot()) {
                return Some(Stop::Watcher);
            }
            if self.touching {
                break;
            }
        }
        None
    }

    /// Largest path (m) of a point of the tile in a time, for constant acceleration.
    fn way(&self, acceleration: &Vector3<f64>, h: f64) -> f64 {
        let simulation = self.simulation;
        h * simulation.fastest(&self.phase.velocity)
            + 0.5 * h * h * simulation.fastest(acceleration)
    }

    /// Shortest time (s) until a point of the tile has moved by `way` (m), for constant
    /// acceleration.
    fn time_to_travel(&self, acceleration: &Vector3<f64>, way: f64) -> f64 {
        if way.is_infinite() {
            return f64::INFINITY;
        }
        let speed = self.simulation.fastest(&self.phase.velocity);
        let growth = self.simulation.fastest(acceleration);
        2.0 * way / (speed + (speed * speed + 2.0 * growth * way).sqrt()).max(f64::MIN_POSITIVE)
    }

    /// Contact until the tile has left, rests, or the time is over.
    fn touch(&mut self, until: f64, watch: &mut dyn FnMut(&Snapshot) -> bool) -> Option<Stop> {
        let simulation = self.simulation;
        let Some(encounter) = &simulation.encounter else {
            self.touching = false;
            self.room = f64::INFINITY;
            return None;
        };
        let masses = [simulation.body.masses()];
        let inverse = masses.map(|it| it.map(|mass| 1.0 / mass));
        let masses: Masses = [&masses, &inverse];
        let mut near = self.near.take().unwrap_or_else(|| NearPair::new(BOTH));
        let mover = Mover {
            kind: MOVING,
            place: self.phase.place,
            velocity: self.phase.velocity,
        };
        let fixed = Mover {
            kind: FIXED,
            place: Vector3::zeros(),
            velocity: Vector3::zeros(),
        };
        let mut island = Island {
            world: encounter,
            laws: Encounter::laws(&simulation.settings),
            time: self.time,
            margins: &encounter.margins,
            riders: vec![Rider {
                mover,
                debt: self.debt,
            }],
            still: vec![fixed],
            poses: [mover, fixed].map(|it| Pose::of(encounter, &it)).to_vec(),
            steady: vec![Vector3::zeros()],
            pairs: vec![(BOTH, &mut near)],
            account: Account::default(),
            steps: 0,
            is_solved: true,
            solver: Solver::default(),
        };
        let stop = self.slide(&mut island, masses, until, watch);
        self.near = Some(near);
        stop
    }

    /// The same, of an island.
    fn slide(
        &mut self,
        island: &mut Island<Encounter>,
        masses: Masses,
        until: f64,
        watch: &mut dyn FnMut(&Snapshot) -> bool,
    ) -> Option<Stop> {
        let simulation = self.simulation;
        let (since, most) = (self.time, until - self.time);
        let mut state = island.start(masses[0]);
        if island.begin(&mut state, masses, most).is_err() {
            return Some(Stop::Failed);
        }
        let mut rested = 0.0;
        loop {
            tiles::interruption::check();
            let Ok(h) = island.move_on(&mut state, masses, most) else {
                return Some(Stop::Failed);
            };
            if self.forces.drag > 0.0 {
                state.velocities[0] *= libm::exp(-self.forces.drag * h);
            }
            self.phase = Phase {
                place: island.riders[0].mover.place,
                velocity: state.velocities[0],
            };
            self.debt = state.debt;
            self.time = if state.time >= most {
                until
            } else {
                since + state.time
            };
            self.contact_steps += 1;
            self.potential = state.potential + self.swing();
            if watch(&self.snapshot()) {
                return Some(Stop::Watcher);
            }
            let fast = simulation.fastest(&self.phase.velocity) > REST_SPEED;
            rested = if fast { 0.0 } else { rested + h };
            if rested >= simulation.problem.scale().time(REST_TIME) && simulation.rest_lasts() {
                return Some(Stop::Rest);
            }
            let range = simulation.settings.contact_range;
            let room = self.room_of(island, &state);
            if room > 2.0 * range {
                self.room = room - 0.5 * range;
                self.touching = false;
                self.free_step = h;
                return None;
            }
            if self.time >= until {
                return None;
            }
        }
    }

    /// A lower bound of the clearance (m), of the tiles and to the rim; 0 where contact is near.
    fn room_of(&self, island: &Island<Encounter>, state: &State) -> f64 {
        if !state.holds.is_empty() {
            return 0.0;
        }
        let q = island.poses[0].at;
        island.room().min(self.simulation.rim_clearance(&q))
    }

    /// The energy (J) of the oscillation of fans.
    fn swing(&self) -> f64 {
        let place = self.phase.place.xy();
        let fans = self.forces.fans.iter().filter(|fan| fan.amplitude != 0.0);
        fans.map(|fan| fan.swing(place, self.time)).sum()
    }

    /// Drag and random kicks over a time `h`: an Ornstein-Uhlenbeck step of the velocity, exact,
    /// `v <- v e^(-c h) + sqrt(kT/m (1 - e^(-2 c h))) xi` with xi of unit variance, for each
    /// degree of freedom with its mass or moment of inertia.
    fn kick(&mut self, energy: f64, h: f64, rng: &mut ChaCha8Rng) {
        let decay = libm::exp(-self.simulation.settings.drag * h);
        let masses = self.simulation.body.masses();
        for i in 0..3 {
            let spread = (energy / masses[i] * (1.0 - decay * decay)).sqrt();
            self.phase.velocity[i] = self.phase.velocity[i] * decay + spread * normal(rng);
        }
    }
}
