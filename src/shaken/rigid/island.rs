//! One time step of tiles that are near each other or the rim.
//!
//! # Steps
//! Velocity Verlet with contact as in RATTLE (Andersen 1983, J. Comput. Phys. 52, 24): impulses at
//! the start of a step keep the gaps at its end from closing, and impulses at the end stop the
//! velocities into the contact. Both act along the rows of their own places, so that the step is
//! symmetric in time and tiles that slide without friction keep their energy to second order. The
//! gaps are those of the moved tiles, not of a linear forecast.
//!
//! A step is short enough that the forces of pairs in relative motion change little:
//! `h <= 0.05 sqrt(l / a)`, with l half the shortest side of a magnet and a the acceleration of the
//! pair by its own force. Where tiles touch and hardly bounce, contact stops most of this
//! acceleration: there `h <= 0.2 sqrt(l / s)`, with s the acceleration along the contact that
//! friction cannot stop, and `h <= 0.8 sqrt(l / a)`; and touching tiles travel by no more than a
//! ninth of l. All these limits scale with the step of the table. A step whose impulses are not
//! found is repeated with half the time. A step ends where a gap closes, with a
//! [knock](super::knock).

use nalgebra::{Vector2, Vector3};
use ordered_float::OrderedFloat;

use super::World;
use super::account::Account;
use super::fan::{Winds, longest_step};
use super::hold::{Hold, hold_back, kinetic};
use super::margins::Margins;
use super::motion::{
    Forces, State, Strength, Unsolved, Way, closes, fastest, put_right, put_right_held, relative,
};
use super::mover::{Mover, Rider};
use super::near::{NearPair, Touch, at_rim};
use super::pair::{Pose, Two};
use super::rest::{GRAVITY, Rest};
use super::short::{Each, Points};
use tiles::contact::{ContactPoint, TurnsWith};

/// The relative error of the travel of touching tiles in a step.
const TRAVEL_ERROR: f64 = 0.01;
/// Tiles that friction holds and that travel less than this share of the travel of touching tiles
/// in a step of the table need no short steps.
const RESTING: f64 = 1.0 / 32.0;
/// Steps are longer by this factor where tiles touch and hardly bounce, by what accelerates them
/// along the contact.
const ALONG: f64 = 4.0;
/// The same, by the whole acceleration.
const TOGETHER: f64 = 16.0;
/// Ratio of the longest step to the shortest bounce.
const SHORTEST: f64 = 16.0;
/// Forecasts of the places at the end of a step, each with the gaps of the one before.
const FORECASTS: usize = 8;
/// Searches for the time of a knock, or for the points that last.
const SEARCHES: usize = 60;
/// A step is halved this often at most.
const HALVINGS: i32 = 12;
/// A step that ends in an overlap which was not foreseen is repeated with half the time, this often at
/// most.
const FORESEEN: i32 = 6;
/// The shortest step that is tried where contact cannot be solved, as a share of the first.
pub const SHORTEST_TRIED: f64 = 1.0 / 4096.0;
/// Points move apart if they do so faster than this many times the error of velocities.
const RETURNED: f64 = 10.0;
/// Overlaps beyond this share of the skin are undone.
const KEPT: f64 = 0.9;
/// They are undone to this share.
const UNDONE: f64 = 0.8;
/// The displacement by the error of the impulses in a step, relative to the rounding of gaps.
const PRECISE: f64 = 0.1;

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
        while state.time < duration {
            tiles::interruption::check();
            self.move_on(state, masses, duration)?;
        }
        Ok(())
    }

    /// Prepares a state for steps of at most this length (s).
    ///
    /// # Errors
    /// If tiles that overlap are not set apart.
    pub fn begin(
        &mut self,
        state: &mut State,
        masses: Masses,
        longest: f64,
    ) -> Result<(), Unsolved> {
        self.look(state, masses[1], longest);
        self.account.contact_loss += self.set_apart(state, masses, longest)?;
        Ok(())
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
            self.account.contact_loss += self.knock(state, masses)?;
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
            self.account.contact_loss += self.set_apart(state, masses, state.longest)?;
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

    fn travel(&self) -> f64 {
        self.margins.travel * self.fineness()
    }

    /// The factor by which steps are shorter than usual.
    fn fineness(&self) -> f64 {
        (self.laws.step / self.margins.usual_step).min(1.0)
    }

    fn fastest(&self, tile: usize, of: &Vector3<f64>) -> f64 {
        fastest(self.world, &self.riders[tile].mover, of)
    }

    /// The same for the second tile of a pair, relative to the first one.
    fn relative(&self, two: Two, of: &[Vector3<f64>]) -> f64 {
        let tiles = [two.first, two.second];
        let movers = tiles.map(|k| mover(&self.riders, &self.still, k));
        relative(
            self.world,
            movers,
            tiles.map(|k| of.get(k).copied().unwrap_or_default()),
        )
    }

    /// The longest step (s) in which the forces of pairs in relative motion change little.
    fn longest_step(&self, state: &State, inverse: &[Vector3<f64>]) -> f64 {
        let feature = self.margins.feature;
        let limit = |(two, near): &(Two, &mut NearPair), pull: &Strength| {
            let travel = self.relative(*two, &state.velocities) * self.laws.step;
            let rests = RESTING * self.travel();
            if travel < rests && self.laws.friction > 0.0 {
                return f64::INFINITY;
            }
            let are_together =
                near.last_room <= self.travel() && self.laws.restitution * travel < rests;
            let whole = longest_step(feature, pull.acceleration);
            if !are_together {
                return whole;
            }
            let lightness =
                [two.first, two.second].map(|tile| inverse.get(tile).map_or(0.0, |it| it.x));
            let along = near.slide(pull.force, self.laws.friction) * (lightness[0] + lightness[1]);
            (ALONG * longest_step(feature, along)).min(TOGETHER * whole)
        };
        let pairs = self.pairs.iter().zip(&state.pulls);
        let limits = pairs.map(|(pair, pull)| limit(pair, pull));
        let limits = limits.fold(f64::INFINITY, f64::min);
        let winds = self.riders.iter().zip(&state.velocities).zip(inverse);
        let winds = winds.map(|((it, v), inverse)| {
            let place = it.mover.place.xy();
            self.laws
                .fans
                .longest(1.0 / inverse.x, place, v.xy().norm())
        });
        self.fineness() * winds.fold(limits, f64::min)
    }

    /// The time (s) in which touching tiles travel as far as contact allows in a step.
    fn time_to_travel(&self, velocities: &[Vector3<f64>], holds: &[Hold]) -> f64 {
        let speed = |hold: &Hold| match (hold.pair, hold.tiles[1]) {
            (Some(pair), _) => self.relative(self.pairs[pair].0, velocities),
            (None, tile) => tile.map_or(0.0, |tile| self.fastest(tile, &velocities[tile])),
        };
        let touching = |hold: &&Hold| hold.gap <= self.travel();
        let time = |of_pairs: bool, travel: f64| {
            let holds = holds.iter().filter(|hold| hold.pair.is_some() == of_pairs);
            let fastest = holds.filter(touching).map(speed).fold(0.0, f64::max);
            travel * self.fineness() / fastest.max(f64::MIN_POSITIVE)
        };
        let Margins {
            travel, rim_travel, ..
        } = *self.margins;
        time(true, travel).min(time(false, rim_travel))
    }

    /// Finds the longest step from a state, of at most a time (s), and the points for it.
    fn look(&mut self, state: &mut State, inverse: &[Vector3<f64>], time: f64) {
        state.unhurried = self.longest_step(state, inverse).min(self.laws.step);
        state.longest = state.unhurried.min(time);
        state.holds = self.points(state, state.longest);
    }

    /// The points that may come into contact in a step of at most this length (s).
    fn points(&mut self, state: &State, h: f64) -> Vec<Hold> {
        let way = |speed: f64, growth: f64| h * (speed + 0.5 * h * growth);
        let ways = self.pairs.iter().map(|(two, _)| {
            let [v, a] =
                [&state.velocities, &state.accelerations].map(|of| self.relative(*two, of));
            way(v, a)
        });
        let ways: Each<f64> = ways.collect();
        let own = (0..self.riders.len()).map(|tile| {
            let [v, a] =
                [&state.velocities, &state.accelerations].map(|of| self.fastest(tile, &of[tile]));
            way(v, a)
        });
        let own: Each<f64> = own.collect();
        let margins = self.margins;
        let margin = |way: f64| margins.least.max(3.0 * way);
        let mut holds = Vec::new();
        let (world, riders, poses) = (self.world, &self.riders, &self.poses);
        let centre = |tile: usize| riders[tile].mover.place.xy();
        let moves = |tile: usize| (tile < riders.len()).then_some(tile);
        for (k, ((two, near), way)) in self.pairs.iter_mut().zip(ways).enumerate() {
            let tiles = [two.first, two.second];
            let [a, b] = tiles.map(|tile| &poses[tile]);
            let kinds = tiles.map(|tile| mover(riders, &self.still, tile).kind);
            let margin = margin(way);
            let meet = |point: &ContactPoint, forces| {
                let at = a.transform(point.on_moving);
                let axis = a.rotation * point.normal;
                let gap = point.gap - margins.skin;
                let normal = (axis, point.turns_with);
                let mut hold = Hold::new(tiles.map(moves), at, normal, gap, centre);
                hold.pair = Some(k);
                hold.forces = forces;
                holds.push(hold);
            };
            near.points(world, &a.to(&b.at), kinds, (margin, margins), meet);
        }
        if self.laws.walls {
            for (tile, rider) in riders.iter().enumerate() {
                at_rim(
                    world,
                    (&rider.mover, &poses[tile]),
                    margin(own[tile]),
                    &mut |point, axis, gap| {
                        let normal = (axis, TurnsWith::Behind);
                        let mut hold = Hold::new([None, Some(tile)], point, normal, gap, centre);
                        hold.rim = world.rim().radius();
                        holds.push(hold);
                    },
                );
            }
        }
        holds
    }

    /// The velocity (m/s) along the normal below which a point that moves apart comes back, and one
    /// that closes stops, within the step: by bounces shorter than the shortest, or than rounding.
    pub(super) fn slow(&self, state: &State, hold: &Hold) -> f64 {
        let press = -hold.rate(&state.accelerations);
        let bounce = 0.5 * press * state.unhurried / SHORTEST;
        bounce.max(self.margins.touched / state.unhurried)
    }

    /// The law of contact: friction, and the error of velocities (m/s) for a step (s).
    pub(super) fn law(&self, h: f64) -> [f64; 2] {
        [self.laws.friction, PRECISE * self.margins.rounding / h]
    }

    /// The mean velocities in a step, the points that last with their impulses, and the length (s) of
    /// the step: at most `longest`, and shorter if touching tiles would travel too far or a gap closes.
    fn way(
        &self,
        state: &State,
        inverse: &[Vector3<f64>],
        mut longest: f64,
    ) -> Result<Way, Unsolved> {
        let now = self.time_to_travel(&state.velocities, &state.holds);
        let mut h = longest.min(now);
        let Margins {
            skin,
            touched,
            rounding,
            ..
        } = *self.margins;
        let slow: Points<f64> = state
            .holds
            .iter()
            .map(|hold| self.slow(state, hold))
            .collect();
        let is_lasting = |(hold, slow): (&Hold, &f64)| {
            hold.gap <= touched && hold.rate(&state.velocities) <= *slow
        };
        let mut lasts: Points<bool> = state.holds.iter().zip(&slow).map(is_lasting).collect();
        let mut forces: Points<[f64; 2]> = state.holds.iter().map(|hold| hold.forces).collect();
        // The longest step known to travel too little, the shortest known to travel too far, and the last one
        // with its pace.
        const UNKNOWN: [f64; 2] = [0.0, f64::INFINITY];
        let (mut bounds, mut known) = (UNKNOWN, (0.0, 1.0 / now));
        for _ in 0..SEARCHES {
            let mut holds = Vec::new();
            for ((hold, forces), _) in state
                .holds
                .iter()
                .zip(&forces)
                .zip(&lasts)
                .filter(|it| *it.1)
            {
                let mut hold = *hold;
                hold.impulses = forces.map(|force| force * 0.5 * h);
                holds.push(hold);
            }
            let mut rests = self.rests(inverse, 0.5 * h);
            for (rest, rub) in rests.iter_mut().zip(&state.rubs) {
                rest.impulse = rub * (0.5 * h);
            }
            let way = self.forecast(state, (&mut holds, &mut rests), inverse, h)?;
            let solved = forces.iter_mut().zip(&lasts).filter(|it| *it.1);
            for ((forces, _), hold) in solved.zip(&holds) {
                *forces = hold.impulses.map(|impulse| impulse / (0.5 * h));
            }
            // By the velocity in the middle of the step: the step is then as long as the one back from
            // its end, and errors of energy do not add up.
            let pace = 1.0 / self.time_to_travel(&way, &state.holds);
            let is_too_far = pace * h > 1.0 + TRAVEL_ERROR;
            if is_too_far || (pace * h < 1.0 - TRAVEL_ERROR && h < longest) {
                bounds[usize::from(is_too_far)] = h;
                let [least, most] = bounds;
                if least < most * (1.0 - TRAVEL_ERROR) {
                    let next = time_at_pace(known, (h, pace)).min(longest);
                    known = (h, pace);
                    h = match least < next && next < most {
                        true => next,
                        false => 0.5 * (least + most.min(longest)),
                    };
                    continue;
                }
                if is_too_far && h > least {
                    h = least;
                    continue;
                }
            }
            let mut first = h;
            let mut is_new = false;
            for (k, hold) in state.holds.iter().enumerate() {
                let gap = hold.gap_after(&way, h, skin);
                if lasts[k] || gap >= hold.gap.min(0.0) - rounding {
                    continue;
                }
                // The parabola through both gaps.
                let u = hold.rate(&state.velocities);
                let a = 2.0 * (gap - hold.gap - u * h) / (h * h);
                match closes(hold.gap - 0.5 * touched, u, a) {
                    Some((time, speed)) if speed > slow[k] => first = first.min(time),
                    _ => {
                        lasts[k] = true;
                        is_new = true;
                    }
                }
            }
            if !is_new && first == h {
                return Ok(Way {
                    velocities: way,
                    holds,
                    rests,
                    h,
                });
            }
            if !is_new {
                h = first;
                longest = first;
            }
            bounds = UNKNOWN;
            known = (0.0, 1.0 / now);
        }
        Err(Unsolved)
    }

    /// The mean velocities in a step (s) that keep the gaps of lasting points from closing.
    fn forecast(
        &self,
        state: &State,
        (holds, rests): (&mut [Hold], &mut [Rest]),
        inverse: &[Vector3<f64>],
        h: f64,
    ) -> Result<Each<Vector3<f64>>, Unsolved> {
        let free = state.halfway(h);
        // By how much the gaps at the end differ from a linear forecast (m).
        let bent = |hold: &Hold, way: &[Vector3<f64>]| {
            let linear = hold.gap + h * hold.rate(way);
            hold.gap_after(way, h, self.margins.skin) - linear
        };
        // Tiles turn much as they did.
        let bends = holds.iter().map(|hold| bent(hold, &state.velocities));
        let mut bends: Points<f64> = bends.collect();
        for _ in 0..FORECASTS {
            for (hold, bend) in holds.iter_mut().zip(&bends) {
                // Overlaps within the skin stay as they are: to undo them would add energy.
                hold.least = -(hold.gap.max(0.0) + bend) / h;
            }
            let mut way = free.clone();
            if !hold_back(inverse, &mut way, (holds, rests), self.law(h)) {
                return Err(Unsolved);
            }
            let mut change: f64 = 0.0;
            for (hold, bend) in holds.iter().zip(&mut bends) {
                let linear = hold.gap + h * hold.rate(&way);
                let now = bent(hold, &way);
                if hold.is_held() || linear + now < hold.gap.min(0.0) {
                    change = change.max((now - *bend).abs());
                    *bend = now;
                }
            }
            if change <= PRECISE * self.margins.rounding {
                return Ok(way);
            }
        }
        Err(Unsolved)
    }

    /// Makes a step, with `after` (s) left after it. Returns the energy lost in contact (J).
    fn step(
        &mut self,
        state: &mut State,
        way: Way,
        [masses, inverse]: Masses,
        after: f64,
    ) -> Result<f64, Unsolved> {
        let Way {
            velocities: way,
            holds: held,
            rests,
            h,
        } = way;
        let before: Each<_> = self.riders.iter().map(|it| it.mover.place).collect();
        let mut lost: f64 = -held
            .iter()
            .map(|it| it.work(&state.velocities, &way))
            .sum::<f64>();
        let mut rubbed: f64 = rests
            .iter()
            .map(|it| it.work(&state.velocities, &way))
            .sum();
        for (tile, way) in way.iter().enumerate() {
            self.put(tile, before[tile] + way * h);
        }
        let forces = self.forces(masses, state.time + h);
        let velocities = way
            .iter()
            .zip(&forces.accelerations)
            .map(|(v, a)| v + a * (0.5 * h));
        let mut next = State::new(state.time + h, velocities.collect(), forces);
        next.debt = state.debt;
        next.halvings = state.halvings;
        // The oscillation of fans does work.
        let swings = state.winds.iter().zip(&next.winds).zip(&way);
        let swung: f64 = swings
            .map(|((from, to), way)| 0.5 * h * (from.swing + to.swing).dot(&way.xy()))
            .sum();
        let steady = self.steady.iter().zip(masses).zip(&way);
        let work = steady.map(|((a, mass), way)| mass.component_mul(a).dot(way) * h);
        let energy = kinetic(masses, &state.velocities) + work.sum::<f64>();
        let energy = energy + swung + state.potential - next.potential;
        let is_free = held.is_empty() && rests.is_empty();
        if is_free {
            put_right(&mut next, (masses, &self.steady), energy, h);
        }
        self.look(&mut next, inverse, after);
        // What meets at the end may be other corners and edges than those that were nearest at the start.
        let deepest = |holds: &[Hold]| holds.iter().map(|it| it.gap).fold(0.0, f64::min);
        if deepest(&next.holds) < deepest(&state.holds) - self.margins.skin
            && state.halvings < FORESEEN
        {
            self.put_back(&before);
            return Err(Unsolved);
        }
        // The points that lasted, where they are now: not those that meet at the end of the step,
        // nor those that bounced within it.
        let lasts = |hold: &Hold| {
            let slow = self.slow(&next, hold);
            let like = state.holds.iter().filter(|it| it.is_like(hold));
            let same = like.min_by_key(|it| OrderedFloat(it.apart(hold)));
            // By its normal at the start: where tiles turn together, that at the end would show a bounce.
            let bounced = same.is_some_and(|it| it.rate(&state.velocities) > slow);
            held.iter().any(|it| it.is_like(hold)) && hold.rate(&way) >= -slow && !bounced
        };
        let mut holds: Vec<Hold> = next.holds.iter().filter(|it| lasts(it)).copied().collect();
        for hold in &mut holds {
            hold.impulses = hold.forces.map(|force| force * 0.5 * h);
            // What is apart by less than the force moves it in half a step meets in that time.
            hold.least = -2.0 * hold.gap.max(0.0) / h;
        }
        let found = self.stop(&mut next, &way, (&mut holds, rests), inverse, h);
        let Ok(rests) = found else {
            self.put_back(&before);
            return Err(Unsolved);
        };
        lost -= holds
            .iter()
            .map(|it| it.work(&way, &next.velocities))
            .sum::<f64>();
        rubbed += rests
            .iter()
            .map(|it| it.work(&way, &next.velocities))
            .sum::<f64>();
        self.account.table_loss -= rubbed;
        self.account.work += swung;
        let rubs = rests.iter().map(|it| it.impulse / (0.5 * h));
        next.rubs = rubs.collect();
        // Where a point moves apart and comes back within the step, the forces act at rest, and the
        // mean velocities give them work that they do not do.
        let error = self.law(h)[1];
        let returns =
            |hold: &Hold| hold.is_held() && hold.rate(&state.velocities) > RETURNED * error;
        if held.iter().any(returns) {
            let halves = [&*state, &next].map(|at| {
                let each = at.velocities.iter().zip(&way).zip(&at.accelerations);
                let works = each.zip(masses);
                works
                    .map(|(((v, way), a), mass)| mass.component_mul(a).dot(&(v - way)))
                    .sum::<f64>()
            });
            lost -= 0.25 * h * (halves[0] + halves[1]);
        }
        // Not where tiles are shaken: the correction changes volumes in phase space, which makes bonds
        // rarer than in equilibrium, and the kicks level errors of energy anyway.
        let is_at_rim = |hold: &Hold| hold.pair.is_none() && hold.is_held();
        let is_mechanical = !self.laws.is_shaken && rests.is_empty();
        if !is_free && is_mechanical && !holds.iter().any(is_at_rim) {
            let places: Each<_> = self.riders.iter().map(|it| it.mover.place).collect();
            // Tiles that stand still stop the common motion.
            let places = self.still.is_empty().then_some(&places[..]);
            put_right_held(&mut next, (masses, places), energy - lost);
        }
        self.remember(&holds, h);
        self.steps += 1;
        *state = next;
        Ok(lost)
    }

    /// Stops the velocities at the end of a step (s) into the contact, and lets the table rub. A point that
    /// slid on the table in the first half of the step slides in the same direction in the second, so
    /// that the step is symmetric in time; unless this would turn its sliding round.
    fn stop(
        &self,
        next: &mut State,
        way: &[Vector3<f64>],
        (holds, rests): (&mut [Hold], Vec<Rest>),
        inverse: &[Vector3<f64>],
        h: f64,
    ) -> Result<Vec<Rest>, Unsolved> {
        // The next step may be longer: it starts with these velocities, and must not take errors for a bounce.
        let law = self.law(h.max(next.unhurried));
        let mut now = self.rests(inverse, 0.5 * h);
        for (now, first) in now.iter_mut().zip(&rests) {
            now.impulse = first.impulse;
            now.is_given = first.slides();
        }
        if now.is_empty() {
            let held = (holds, &mut now[..]);
            let is_found = hold_back(inverse, &mut next.velocities, held, law);
            return is_found.then_some(now).ok_or(Unsolved);
        }
        let free = next.velocities.clone();
        loop {
            if !hold_back(inverse, &mut next.velocities, (holds, &mut now), law) {
                return Err(Unsolved);
            }
            let is_turned = |it: &Rest| {
                it.is_given && it.velocity(&next.velocities).dot(&it.velocity(way)) <= 0.0
            };
            let turned: Vec<bool> = now.iter().map(is_turned).collect();
            if turned.iter().all(|it| !it) {
                return Ok(now);
            }
            for (rest, is_turned) in now.iter_mut().zip(turned) {
                rest.is_given &= !is_turned;
            }
            next.velocities.clone_from(&free);
        }
    }

    /// The points at which the tiles lie on the table, with what friction may do in a time (s).
    fn rests(&self, inverse: &[Vector3<f64>], time: f64) -> Vec<Rest> {
        let friction = self.laws.table_friction;
        let mut rests = Vec::new();
        if friction == 0.0 {
            return rests;
        }
        for (tile, (rider, pose)) in self.riders.iter().zip(&self.poses).enumerate() {
            let supports = self.world.supports(rider.mover.kind);
            let weight = GRAVITY / (inverse[tile].x * supports.len() as f64);
            rests.extend(supports.iter().map(|arm| Rest {
                tile,
                arm: pose.rotation * arm,
                limit: friction * weight * time,
                impulse: Vector2::zeros(),
                is_given: false,
            }));
        }
        rests
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
        if !hold_back(
            inverse,
            &mut shifts,
            (&mut holds, &mut []),
            [0.0, PRECISE * self.margins.rounding],
        ) {
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
    fn put_back(&mut self, places: &[Vector3<f64>]) {
        for (tile, place) in places.iter().enumerate() {
            self.put(tile, *place);
        }
    }

    /// Puts a tile at a place.
    fn put(&mut self, tile: usize, place: Vector3<f64>) {
        let mover = &mut self.riders[tile].mover;
        mover.place = place;
        self.poses[tile] = Pose::of(self.world, mover);
    }

    /// Keeps the forces at points of contact, by their impulses in half a step (s), as a guess for the
    /// next step.
    fn remember(&mut self, holds: &[Hold], h: f64) {
        for (two, near) in &mut self.pairs {
            let q = self.poses[two.first].to(&self.poses[two.second].at);
            near.hold_anew(q);
        }
        for hold in holds {
            if let Some(pair) = hold.pair {
                let (two, near) = &mut self.pairs[pair];
                let pose = &self.poses[two.first];
                near.held.push(Touch {
                    at: pose.inverse_transform(hold.point),
                    normal: pose.rotation.inverse() * hold.axis,
                    turns_with: hold.turns_with,
                    forces: hold.impulses.map(|impulse| impulse / (0.5 * h)),
                });
            }
        }
    }
}

/// The time after which a way is done whose mean pace (1/s) depends on the time (s) linearly, by two
/// values of it.
fn time_at_pace((first, slow): (f64, f64), (second, fast): (f64, f64)) -> f64 {
    let slope = (fast - slow) / (second - first);
    let start = slow - slope * first;
    // The smaller positive root of `slope h^2 + start h = 1`.
    let time = 2.0 / (start + (start * start + 4.0 * slope).sqrt());
    if time > 0.0 { time } else { 1.0 / fast }
}

/// A tile by its index: among those that move, then among those that stand still.
fn mover<'a>(riders: &'a [Rider], still: &'a [Mover], tile: usize) -> &'a Mover {
    match riders.get(tile) {
        Some(rider) => &rider.mover,
        None => &still[tile - riders.len()],
    }
}
