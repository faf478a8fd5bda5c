//! One time step of tiles that are near each other or the rim.
//!
//! # Steps
//! Velocity Verlet with contact as in RATTLE (Andersen 1983, J. Comput. Phys. 52, 24): impulses at
//! the start of a step keep the gaps at its end from closing, and impulses at the end stop the
//! velocities into the contact. Both act along the rows of their own places, so that the step is
//! symmetric in time and tiles that slide without friction keep their energy to second order. The
//! gaps are those of the moved tiles, not of a linear forecast.
//!
//! How long a step may be is in [limits](super::limits), its mean velocities in [way](super::way), the rest
//! of it in [step](super::step). A step ends where a gap closes, with a [knock](super::knock). A step whose
//! impulses, those of its knock among them, are not found is repeated with half the time.

use nalgebra::Vector3;

use super::World;
use super::account::Account;
use super::fan::Winds;
use super::hold::Hold;
use super::margins::Margins;
use super::motion::{Forces, State, Strength, Unsolved, fastest};
use super::mover::{Mover, Rider};
use super::near::NearPair;
use super::pair::{Pose, Two};
use super::short::Each;
use super::solve::Solver;

/// A step is halved this often at most.
const HALVINGS: i32 = 12;
/// The shortest step that is tried where contact cannot be solved, as a share of the first.
pub const SHORTEST_TRIED: f64 = 1.0 / 4096.0;
/// Overlaps beyond this share of the skin are undone.
const KEPT: f64 = 0.9;
/// They are undone to this share.
const UNDONE: f64 = 0.8;
/// A step of the table has ended if less than this share of it is left: what halved steps leave of it may be too
/// short for the time to go on.
const ENDED: f64 = 1e-12;
/// The displacement by the error of the impulses in a step, relative to the rounding of gaps.
pub(super) const PRECISE: f64 = 0.1;

/// The laws by which tiles move.
#[derive(Clone, Copy, Debug)]
pub struct Laws<'a> {
    /// Coulomb's coefficient of friction between tiles, and between a tile and the rim.
    pub friction: f64,
    /// The same between a tile and the table it lies on.
    pub table_friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Whether the table has a rim.
    pub walls: bool,
    /// The fans.
    pub fans: Winds<'a>,
    /// Whether random kicks act between the steps.
    pub is_shaken: bool,
    /// The longest step (s). Steps in contact are shorter, and scale with it.
    pub step: f64,
}

/// Mass, mass and moment of inertia of each tile that moves (kg, kg, kg m^2), and their inverses.
pub type Masses<'a> = [&'a [Vector3<f64>]; 2];

/// A group of tiles connected by being near each other. Tiles whose index is the number of `riders` or
/// more stand still.
pub struct Island<'a, W> {
    pub world: &'a W,
    pub laws: Laws<'a>,
    /// The time (s) at the start of the step.
    pub time: f64,
    pub margins: &'a Margins,
    /// The tiles.
    pub riders: Vec<Rider>,
    /// Tiles that stand still.
    pub still: Vec<Mover>,
    /// The poses of both, in this order.
    pub poses: Vec<Pose>,
    /// Their accelerations by other tiles and the table's motion (m/s^2, m/s^2, rad/s^2).
    pub steady: Vec<Vector3<f64>>,
    /// Pairs, by indices of this island's tiles.
    pub pairs: Vec<(Two, &'a mut NearPair)>,
    /// What became of the energy.
    pub account: Account,
    /// The number of steps made.
    pub steps: u64,
    /// Whether contact was solved.
    pub is_solved: bool,
    /// Room for the solution of contact.
    pub solver: Solver,
}

impl<W: World> Island<'_, W> {
    /// Advances by one step of the table.
    pub fn advance(&mut self) {
        let masses: Vec<_> = self
            .riders
            .iter()
            .map(|it| self.world.body(it.mover.kind).masses())
            .collect();
        let inverse: Vec<_> = masses.iter().map(|it| it.map(|mass| 1.0 / mass)).collect();
        if self.move_as_one([&masses, &inverse]) {
            return;
        }
        let mut state = self.start(&masses);
        self.is_solved = self.go_on(&mut state, [&masses, &inverse]).is_ok();
        for (rider, velocity) in self.riders.iter_mut().zip(&state.velocities) {
            rider.mover.velocity = *velocity;
        }
        let share = state.debt / self.riders.len() as f64;
        for rider in &mut self.riders {
            rider.debt = share;
        }
    }

    /// The motion at the start, without points of contact.
    pub fn start(&mut self, masses: &[Vector3<f64>]) -> State {
        let forces = self.forces(masses, 0.0);
        let velocities = self.riders.iter().map(|it| it.mover.velocity).collect();
        let mut state = State::new(0.0, velocities, forces);
        state.debt = self.riders.iter().map(|it| it.debt).sum();
        state
    }

    /// A lower bound of the distance (m) of any two tiles, as known from the last points of contact.
    pub fn room(&self) -> f64 {
        let rooms = self.pairs.iter().map(|(two, near)| {
            let [a, b] = [two.first, two.second].map(|tile| &self.poses[tile]);
            let kinds = [two.first, two.second];
            let kinds = kinds.map(|tile| mover(&self.riders, &self.still, tile).kind);
            near.room(self.world, &a.to(&b.at), kinds)
        });
        rooms.fold(f64::INFINITY, f64::min)
    }

    /// Advances by one step of the table with constant external forces.
    fn go_on(&mut self, state: &mut State, masses: Masses) -> Result<(), Unsolved> {
        let duration = self.laws.step;
        self.begin(state, masses, duration)?;
        while state.time < duration * (1.0 - ENDED) {
            tiles::interruption::check();
            self.move_on(state, masses, duration)?;
        }
        Ok(())
    }

    /// Prepares a state for steps of at most this length (s).
    ///
    /// # Errors
    /// If tiles that overlap are not set apart, or the impulses of a knock are not found.
    pub fn begin(
        &mut self,
        state: &mut State,
        masses: Masses,
        longest: f64,
    ) -> Result<(), Unsolved> {
        self.look(state, masses[1], longest);
        self.account.contact_loss += self.settle(state, masses)?;
        Ok(())
    }

    /// Sets apart what overlaps, and then knocks; returns the energy lost (J).
    pub(super) fn settle(&mut self, state: &mut State, masses: Masses) -> Result<f64, Unsolved> {
        let longest = state.longest;
        Ok(self.set_apart(state, masses, longest)? + self.knock(state, masses)?)
    }

    /// Makes one step with constant external forces, at most to a time (s); returns its length (s).
    ///
    /// # Errors
    /// If the impulses of contact are not found even in the shortest steps.
    pub fn move_on(
        &mut self,
        state: &mut State,
        masses: Masses,
        until: f64,
    ) -> Result<f64, Unsolved> {
        loop {
            let left = until - state.time;
            let longest = state.longest.min(left) * libm::ldexp(1.0, -state.halvings);
            let moved = self.way(state, masses[1], longest).and_then(|way| {
                let h = way.h;
                let after = if h < left {
                    until - (state.time + h)
                } else {
                    self.laws.step
                };
                Ok((self.step(state, way, masses, after)?, h))
            });
            let Ok((loss, h)) = moved else {
                if state.halvings == HALVINGS {
                    return Err(Unsolved);
                }
                state.halvings += 1;
                continue;
            };
            state.halvings = (state.halvings - 1).max(0);
            self.account.contact_loss += loss;
            if h >= left {
                state.time = until;
            }
            return Ok(h);
        }
    }

    /// All accelerations (m/s^2, rad/s^2), the own forces of the pairs, and the potential energy (J) at a
    /// time (s) since the start of the step of the table.
    pub(super) fn forces(&mut self, masses: &[Vector3<f64>], time: f64) -> Forces {
        let mut all = Each::from_slice(&self.steady);
        let mut strengths = Each::new();
        let mut potential = 0.0;
        let (world, riders, poses) = (self.world, &self.riders, &self.poses);
        for (two, near) in &mut self.pairs {
            let tiles = [two.first, two.second];
            let movers = tiles.map(|k| mover(riders, &self.still, k));
            let (energy, pulls) = near.pull(world, movers, tiles.map(|k| &poses[k]), self.margins);
            potential += energy;
            let mut acceleration = 0.0;
            for ((tile, mover), pull) in tiles.into_iter().zip(movers).zip(pulls) {
                let Some(masses) = masses.get(tile) else {
                    continue;
                };
                let own = pull.component_div(masses);
                all[tile] += own;
                acceleration += fastest(world, mover, &own);
            }
            let force = poses[two.first].rotation.inverse() * pulls[1].xy();
            strengths.push(Strength {
                acceleration,
                force,
            });
        }
        let mut winds = Vec::new();
        if !self.laws.fans.0.is_empty() {
            let places = riders.iter().map(|it| it.mover.place.xy());
            winds.extend(places.map(|place| self.laws.fans.wind(place, self.time + time)));
            for ((acceleration, wind), masses) in all.iter_mut().zip(&winds).zip(masses) {
                *acceleration += wind.whole().push(0.0) / masses.x;
                potential += wind.energy;
            }
        }
        Forces {
            accelerations: all,
            pulls: strengths,
            winds,
            potential,
        }
    }

    /// The law of contact: friction, and the error of velocities (m/s) for a step (s).
    pub(super) fn law(&self, h: f64) -> [f64; 2] {
        [self.laws.friction, PRECISE * self.margins.rounding / h]
    }

    /// Moves overlapping tiles apart, as little as possible and without friction, where they use up
    /// nearly all of the skin. Returns the energy lost (J): negative, as they move against the forces.
    fn set_apart(
        &mut self,
        state: &mut State,
        [masses, inverse]: Masses,
        time: f64,
    ) -> Result<f64, Unsolved> {
        let skin = self.margins.skin;
        if state.holds.iter().all(|hold| hold.gap >= -KEPT * skin) {
            return Ok(0.0);
        }
        let touches = |hold: &&Hold| hold.gap <= self.margins.touched;
        let mut holds: Vec<Hold> = state.holds.iter().filter(touches).copied().collect();
        for hold in &mut holds {
            hold.least = (-UNDONE * skin - hold.gap).min(skin);
            hold.impulses = [0.0; 2];
        }
        let mut shifts: Each<_> = self.riders.iter().map(|_| Vector3::zeros()).collect();
        let error = PRECISE * self.margins.rounding;
        let solver = &mut self.solver;
        solver.prepare(shifts.len(), (&holds, &[]), 0.0);
        if !solver.hold_back(inverse, &mut shifts, (&mut holds, &mut []), error) {
            return Err(Unsolved);
        }
        let forces = state.accelerations.iter().zip(masses);
        let work = forces
            .zip(&shifts)
            .map(|((a, mass), shift)| mass.component_mul(a).dot(shift));
        let lost = work.sum();
        for (tile, shift) in shifts.into_iter().enumerate() {
            self.put(tile, self.riders[tile].mover.place + shift);
        }
        let forces = self.forces(masses, state.time);
        *state = State {
            debt: state.debt,
            halvings: state.halvings,
            rubs: std::mem::take(&mut state.rubs),
            ..State::new(state.time, std::mem::take(&mut state.velocities), forces)
        };
        self.look(state, inverse, time);
        Ok(lost)
    }

    /// Puts all tiles back where they were.
    pub(super) fn put_back(&mut self, places: &[Vector3<f64>]) {
        for (tile, place) in places.iter().enumerate() {
            self.put(tile, *place);
        }
    }

    /// Puts a tile at a place.
    pub(super) fn put(&mut self, tile: usize, place: Vector3<f64>) {
        let mover = &mut self.riders[tile].mover;
        mover.place = place;
        self.poses[tile] = Pose::of(self.world, mover);
    }
}

/// A tile by its index: among those that move, then among those that stand still.
pub(super) fn mover<'a>(riders: &'a [Rider], still: &'a [Mover], tile: usize) -> &'a Mover {
    match riders.get(tile) {
        Some(rider) => &rider.mover,
        None => &still[tile - riders.len()],
    }
}
