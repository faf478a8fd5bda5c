//! One trajectory: free flight and contact steps in turn.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::body::{Body, Motion, Phase};
use super::collision::{self, Stride};
use super::flight;
use super::force::Forces;
use super::simulation::{Run, Simulation, Snapshot, Stop};
use super::vicinity::{Ahead, Vicinity};

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
    /// The change of the kinetic energy (J) from the time of the velocity to that of the position:
    /// in contact the velocity belongs to the middle of the last step.
    lag: f64,
    /// Distance (m) that a point of the tile can move before the clearance must be computed again.
    room: f64,
    vicinity: Vicinity,
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
            lag: 0.0,
            room: 0.0,
            vicinity: Vicinity::new(),
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
            kinetic: (self.simulation.body.kinetic_energy(&self.phase.velocity) + self.lag)
                .max(0.0),
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
                crate::interruption::check();
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
        let settings = &simulation.settings;
        let (_, mut acceleration) = self.forces.conservative(&self.phase.place, self.time);
        // The leapfrog's velocities belong to the middles of its steps: a step begins with the
        // acceleration over half of the previous step and half of this one.
        let mut before = 0.0;
        let mut rested = 0.0;
        self.room = 0.0;
        loop {
            let left = until - self.time;
            let travel = self.time_to_travel(&acceleration, settings.contact_travel);
            let h = travel.min(settings.contact_step).min(left);
            let stride = Stride {
                acceleration,
                before,
                h,
            };
            let velocity = self.phase.velocity + stride.push();
            let way = h * simulation.fastest(&velocity);
            let ahead = if self.room > way {
                Ahead::Room(self.room)
            } else {
                self.vicinity.ahead(simulation, &self.phase, way)
            };
            match ahead {
                Ahead::Room(room) if room > 2.0 * settings.contact_range => {
                    self.phase.velocity += acceleration * (0.5 * before);
                    self.lag = 0.0;
                    self.room = room - 0.5 * settings.contact_range;
                    self.touching = false;
                    self.free_step = h;
                    return None;
                }
                Ahead::Room(room) => {
                    self.phase.velocity = velocity;
                    self.phase.place += velocity * h;
                    self.room = room - way;
                }
                Ahead::Contact(points) => {
                    let (body, phase) = (&simulation.body, &self.phase);
                    self.phase = collision::step(
                        body,
                        (settings, simulation.problem.scale()),
                        phase,
                        &stride,
                        &points,
                    );
                    self.room = 0.0;
                }
            }
            before = h;
            if self.forces.drag > 0.0 {
                self.phase.velocity *= libm::exp(-self.forces.drag * h);
            }
            self.time = if h == left { until } else { self.time + h };
            self.contact_steps += 1;
            (self.potential, acceleration) = self.forces.conservative(&self.phase.place, self.time);
            let force = acceleration.component_mul(&simulation.body.masses());
            self.lag = 0.5 * h * force.dot(&self.phase.velocity);
            if watch(&self.snapshot()) {
                return Some(Stop::Watcher);
            }
            let fast = simulation.fastest(&self.phase.velocity) > REST_SPEED;
            rested = if fast { 0.0 } else { rested + h };
            if rested >= simulation.problem.scale().time(REST_TIME) && simulation.rest_lasts() {
                return Some(Stop::Rest);
            }
            if self.time >= until {
                return None;
            }
        }
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

/// A velocity (m/s, m/s, rad/s) of a body in equilibrium at kT (J).
pub fn thermal_velocity(body: &Body, kt: f64, rng: &mut ChaCha8Rng) -> Vector3<f64> {
    body.masses().map(|mass| (kt / mass).sqrt() * normal(rng))
}

/// A normally distributed number of mean 0 and variance 1 (Box and Muller 1958).
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - rng.random::<f64>())).sqrt();
    radius * libm::cos(TAU * rng.random::<f64>())
}
