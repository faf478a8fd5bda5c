//! One time step of tiles that are near each other or the rim.
//!
//! # Steps
//! Velocity Verlet, with constant forces of the drives and of tiles outside the island. A step is
//! short enough that the forces of pairs in relative motion change little: `h <= 0.05 sqrt(l / a)`,
//! with l half the shortest side of a magnet and a the acceleration of the pair by its own force.
//! Where tiles touch and hardly bounce, contact stops most of this acceleration: there
//! `h <= 0.2 sqrt(l / s)`, with s the acceleration along the contact that friction cannot stop, and
//! `h <= 0.8 sqrt(l / a)`; and tiles in contact move by no more than 0.2 mm per step, or the step is
//! repeated with a shorter time. All these limits scale with the step of the table. (Tiles that
//! hardly move need no short steps.)
//!
//! # Knocks
//! The gap of a point changes as `g + u t + a t^2 / 2`. If it closes with a velocity u1 that makes
//! the tiles bounce for longer than the shortest step, and not slowly, the step ends at that time,
//! and the impulse acts on the velocities of that time: energy changes only by the impulse. Other
//! contacts last for the whole step: the tiles end at contact and not beyond it, and their
//! velocities into the contact are removed. After shorter bounces tiles return with the velocity of
//! the parabola, so that elastic contact conserves energy there too. Where many points or friction
//! would increase the energy (Kane and Levinson 1985), the restitution is reduced until they do
//! not.

use nalgebra::{Vector2, Vector3};

use super::crowd::Crowd;
use super::drive::Rider;
use super::hold::{Hold, hold_back, kinetic, share_within};
use super::mover::Mover;
use super::pair::{Pose, Pull, Two, pull};
use super::settings::TableSettings;
use crate::configuration::Configuration;
use crate::contact::{ContactPoint, NearPairs};
use crate::tile::outline::cross;

/// The error (m) of places in contact per step at which the solver stops: over a step of h (s), an error
/// of velocities by this over h.
const MISPLACED: f64 = 2e-8;
/// The same for the velocities (m/s) after a step: 1/300 of a typical kick of the shaking.
const VELOCITY_ERROR: f64 = 3e-5;
/// Points with gaps below this (m) are in contact: about ten times [`MISPLACED`].
const TOUCHED: f64 = 2e-7;
/// Outlines are kept apart by this (m). The force of two blocks changes sign where their pole faces
/// pass through each other, so tiles must not overlap at all; this changes an energy by the force
/// times this distance.
pub const SKIN: f64 = 3e-7;
/// Overlapping tiles are pushed apart by at most this per step (m).
const PUSHED_OUT: f64 = 1e-6;
/// Smallest distance (m) within which contact points are searched for.
const LEAST_MARGIN: f64 = 1e-4;
/// The same where nothing is near (m).
const SEEN: f64 = 3e-3;
/// Travel of a tile in contact within a usual step (m), by its velocity at the start.
const TRAVEL: f64 = 1.6e-4;
/// A step in which a tile in contact travels farther than this many times as much is repeated.
const FARTHEST: f64 = 1.25;
/// A usual step as a share of the time in which forces change.
const SHARE: f64 = 0.05;
/// Tiles slower than this (m/s) need no short steps.
const SLOW: f64 = 2e-3;
/// Steps are longer by this factor where tiles touch and hardly bounce, by what accelerates them
/// along the contact.
const ALONG: f64 = 4.0;
/// The same, by the whole acceleration.
const TOGETHER: f64 = 16.0;
/// Ratio of the longest to the shortest step.
const SHORTEST: f64 = 16.0;
/// Bounces slower than this (m/s) are ignored.
const LEAST_BOUNCE: f64 = 2e-4;
/// Points of contact closer than this (m) to one of the step before are the same.
const SAME: f64 = 1e-3;
/// The pairs of edges and corners that may touch are searched for this much farther (m) than
/// needed, and so less often.
const AHEAD: f64 = 4e-3;

/// Two tiles that are near each other, with the state of their contact.
#[derive(Debug)]
pub struct NearPair {
    pub two: Two,
    /// Whether the tiles may touch, or attract or repel each other too strongly for the step of the
    /// table: they are in one island then.
    pub is_tied: bool,
    edges: NearPairs,
    /// The distance (m) from `at` that `edges` cover.
    seen: f64,
    at: Configuration,
    /// The tiles are apart by at least this (m) at `room_at`.
    room: f64,
    room_at: Configuration,
    /// The last places of both tiles, and their pull there.
    pulled: Option<([Vector3<f64>; 2], Pull)>,
    /// The last contact points.
    held: Vec<Touch>,
}

/// A contact point of the last step, in the frame of the first tile.
#[derive(Clone, Copy, Debug)]
struct Touch {
    /// Its position (m).
    at: Vector2<f64>,
    /// The normal, from the first tile to the second.
    normal: Vector2<f64>,
    /// The forces (N) along normal and tangent.
    forces: [f64; 2],
}

impl NearPair {
    pub fn new(two: Two) -> Self {
        Self {
            two,
            is_tied: true,
            edges: NearPairs::default(),
            seen: f64::NEG_INFINITY,
            at: Configuration::new(0.0, 0.0, 0.0),
            room: f64::NEG_INFINITY,
            room_at: Configuration::new(0.0, 0.0, 0.0),
            pulled: None,
            held: Vec::new(),
        }
    }

    /// The pull of the tiles on each other, which is known from the end of the last step unless one
    /// has moved since.
    fn pull(&mut self, crowd: &Crowd, movers: [&Mover; 2], poses: [&Pose; 2]) -> Pull {
        let places = movers.map(|mover| mover.place);
        match self.pulled {
            Some((at, known)) if at == places => known,
            _ => {
                let couple = crowd.couple(movers[0].kind, movers[1].kind).0;
                let found = pull(couple, movers, poses);
                self.pulled = Some((places, found));
                found
            }
        }
    }

    /// The last forces (N) at a point, in the first tile's frame.
    fn force(&self, at: &Vector2<f64>) -> [f64; 2] {
        let same = |it: &&Touch| (it.at - at).norm_squared() < SAME * SAME;
        self.held.iter().find(same).map_or([0.0; 2], |it| it.forces)
    }

    /// The force (N) along the contact that friction cannot stop, of a force on the second tile in
    /// the frame of the first: by the contact point where it is largest.
    fn slide(&self, force: Vector2<f64>, friction: f64) -> f64 {
        let along = self.held.iter().map(|touch| {
            let press = -touch.normal.dot(&force);
            cross(touch.normal, force).abs() - friction * press.max(0.0)
        });
        along.fold(0.0, f64::max)
    }

    /// The points of contact within a margin (m), if there may be any.
    fn points(
        &mut self,
        crowd: &Crowd,
        q: &Configuration,
        kinds: [usize; 2],
        margin: f64,
    ) -> Vec<ContactPoint> {
        let contact = &crowd.couple(kinds[0], kinds[1]).0.contact;
        let radius = contact.moving().circumradius();
        let moved = |from: &Configuration| {
            let step = from.step_to(q);
            step.xy().norm() + radius * step.z.abs()
        };
        if self.room - moved(&self.room_at) > margin {
            return Vec::new();
        }
        let seen = margin.max(SEEN);
        let needed = 1.5 * seen;
        if self.seen - moved(&self.at) < needed {
            self.seen = needed + AHEAD;
            self.at = *q;
            self.edges = contact.near(q, self.seen);
        }
        let mut points = contact.points(q, margin, &self.edges);
        if points.is_empty() {
            points = contact.points(q, seen, &self.edges);
        }
        self.room = points.iter().map(|point| point.gap).fold(seen, f64::min);
        self.room_at = *q;
        points.retain(|point| point.gap <= margin);
        points
    }
}

/// A group of tiles connected by being near each other.
pub struct Island<'a> {
    pub crowd: &'a Crowd,
    pub settings: &'a TableSettings,
    /// Half a magnet's shortest side (m).
    pub feature: f64,
    /// The tiles.
    pub riders: Vec<Rider>,
    /// Their poses.
    pub poses: Vec<Pose>,
    /// Their accelerations by other tiles, fans and the table's motion (m/s^2, m/s^2, rad/s^2).
    pub steady: Vec<Vector3<f64>>,
    /// Pairs, by indices of this island's tiles.
    pub pairs: Vec<(Two, &'a mut NearPair)>,
    /// Kinetic energy lost in contact (J).
    pub contact_loss: f64,
}

/// The own force of a pair of tiles.
#[derive(Clone, Copy)]
struct Strength {
    /// The relative acceleration (m/s^2) of the tiles' fastest points by it.
    acceleration: f64,
    /// On the second tile, in the frame of the first (N).
    force: Vector2<f64>,
}

/// Accelerations and energies at one time.
struct State {
    velocities: Vec<Vector3<f64>>,
    accelerations: Vec<Vector3<f64>>,
    pulls: Vec<Strength>,
    /// The potential energy of the pairs (J).
    potential: f64,
    /// The correction of kinetic energy that is still outstanding (J).
    debt: f64,
}

impl State {
    /// The velocities after half a step (s) without contact.
    fn halfway(&self, h: f64) -> Vec<Vector3<f64>> {
        let each = self.velocities.iter().zip(&self.accelerations);
        each.map(|(v, a)| v + a * (0.5 * h)).collect()
    }
}

impl Island<'_> {
    /// Advances by one step of the table.
    pub fn advance(&mut self) {
        let masses: Vec<_> = self
            .riders
            .iter()
            .map(|it| self.crowd.kinds[it.mover.kind].body.masses())
            .collect();
        let inverse: Vec<_> = masses.iter().map(|it| it.map(|mass| 1.0 / mass)).collect();
        let (accelerations, pulls, potential) = self.accelerations(&masses);
        let mut state = State {
            velocities: self.riders.iter().map(|it| it.mover.velocity).collect(),
            accelerations,
            pulls,
            potential,
            debt: self.riders.iter().map(|it| it.debt).sum(),
        };
        self.contact_loss = self.go_on(&mut state, [&masses, &inverse], self.settings.step);
        for (rider, velocity) in self.riders.iter_mut().zip(&state.velocities) {
            rider.mover.velocity = *velocity;
        }
        let share = state.debt / self.riders.len() as f64;
        for rider in &mut self.riders {
            rider.debt = share;
        }
    }

    /// Advances by a time (s) with constant external forces; returns the energy lost in contact (J).
    fn go_on(&mut self, state: &mut State, masses: [&[Vector3<f64>]; 2], duration: f64) -> f64 {
        let mut lost = 0.0;
        let mut time = 0.0;
        while time < duration {
            crate::interruption::check();
            let left = duration - time;
            let longest = self.longest_step(state, masses[1]).min(left);
            let points = self.points(state, longest);
            let longest = longest.min(self.time_to_travel(&state.velocities, &points));
            let h = self.until_knock(state, &points, longest);
            let (way, points, h) = self.way(state, points, masses[1], h);
            lost += self.step(state, (way, points), masses, h);
            time = if h == left { duration } else { time + h };
        }
        lost
    }

    /// All accelerations (m/s^2, rad/s^2), the own forces of the pairs, and their energy (J).
    fn accelerations(
        &mut self,
        masses: &[Vector3<f64>],
    ) -> (Vec<Vector3<f64>>, Vec<Strength>, f64) {
        let mut all = self.steady.clone();
        let mut strengths = Vec::with_capacity(self.pairs.len());
        let mut potential = 0.0;
        let (crowd, riders, poses) = (self.crowd, &self.riders, &self.poses);
        for (two, near) in &mut self.pairs {
            let tiles = [two.first, two.second];
            let movers = tiles.map(|k| &riders[k].mover);
            let (energy, pulls) = near.pull(crowd, movers, tiles.map(|k| &poses[k]));
            potential += energy;
            let mut acceleration = 0.0;
            for ((tile, mover), pull) in tiles.into_iter().zip(movers).zip(pulls) {
                let own = pull.component_div(&masses[tile]);
                all[tile] += own;
                acceleration += fastest(crowd, mover, &own);
            }
            let force = poses[two.first].rotation.inverse() * pulls[1].xy();
            strengths.push(Strength {
                acceleration,
                force,
            });
        }
        (all, strengths, potential)
    }

    fn travel(&self) -> f64 {
        TRAVEL * self.settings.fineness()
    }

    fn fastest(&self, tile: usize, of: &Vector3<f64>) -> f64 {
        fastest(self.crowd, &self.riders[tile].mover, of)
    }

    /// The same for the second tile of a pair, relative to the first one in its rotating frame.
    fn relative(&self, two: Two, of: &[Vector3<f64>]) -> f64 {
        let [first, second] = [two.first, two.second].map(|k| &self.riders[k].mover);
        let between = (second.place - first.place).xy();
        let [a, b] = [of[two.first], of[two.second]];
        let carried = Vector2::new(-between.y, between.x) * a.z;
        let reach = self.crowd.kinds[second.kind].reach;
        (b.xy() - a.xy() - carried).norm() + reach * (b.z - a.z).abs()
    }

    /// The longest step (s) in which the forces of pairs in relative motion change little.
    fn longest_step(&self, state: &State, inverse: &[Vector3<f64>]) -> f64 {
        let limit = |(two, near): &(Two, &mut NearPair), pull: &Strength| {
            let speed = self.relative(*two, &state.velocities);
            if speed < SLOW {
                return f64::INFINITY;
            }
            let are_together =
                near.room <= self.travel() && self.settings.restitution * speed < SLOW;
            let whole = longest_step(self.feature, pull.acceleration);
            if !are_together {
                return whole;
            }
            let lightness = [two.first, two.second].map(|tile| inverse[tile].x);
            let along =
                near.slide(pull.force, self.settings.friction) * (lightness[0] + lightness[1]);
            (ALONG * longest_step(self.feature, along)).min(TOGETHER * whole)
        };
        let pairs = self.pairs.iter().zip(&state.pulls);
        let limits = pairs.map(|(pair, pull)| limit(pair, pull));
        self.settings.fineness() * limits.fold(f64::INFINITY, f64::min)
    }

    /// The time (s) in which touching tiles travel as far as contact allows in a step.
    fn time_to_travel(&self, velocities: &[Vector3<f64>], holds: &[Hold]) -> f64 {
        let speed = |hold: &Hold| match hold.tiles {
            [Some(first), Some(second)] => self.relative(Two { first, second }, velocities),
            [_, tile] => tile.map_or(0.0, |tile| self.fastest(tile, &velocities[tile])),
        };
        let touching = holds.iter().filter(|hold| hold.gap <= self.travel());
        let fastest = touching.map(speed).fold(0.0, f64::max);
        self.travel() / fastest.max(f64::MIN_POSITIVE)
    }

    /// The mean velocities in a step, the contacts with their impulses, and the length (s) of the step,
    /// which is shorter than `h` if touching tiles would travel too far.
    fn way(
        &self,
        state: &State,
        mut holds: Vec<Hold>,
        inverse: &[Vector3<f64>],
        mut h: f64,
    ) -> (Vec<Vector3<f64>>, Vec<Hold>, f64) {
        loop {
            for hold in &mut holds {
                hold.least = (-hold.gap / h).min(PUSHED_OUT / h);
                hold.impulses = hold.forces.map(|force| force * 0.5 * h);
            }
            let mut way = state.halfway(h);
            let error = (MISPLACED / h).min(VELOCITY_ERROR);
            let law = [self.settings.friction, error];
            hold_back(inverse, &mut way, &mut holds, law);
            let share = self.time_to_travel(&way, &holds) / h;
            if FARTHEST * share >= 1.0 {
                return (way, holds, h);
            }
            h *= share;
        }
    }

    /// The points that may come into contact in a step of at most this length (s).
    fn points(&mut self, state: &State, h: f64) -> Vec<Hold> {
        let way = |speed: f64, growth: f64| h * (speed + 0.5 * h * growth);
        let ways = self.pairs.iter().map(|(two, _)| {
            let [v, a] =
                [&state.velocities, &state.accelerations].map(|of| self.relative(*two, of));
            way(v, a)
        });
        let ways: Vec<f64> = ways.collect();
        let own = (0..self.riders.len()).map(|tile| {
            let [v, a] =
                [&state.velocities, &state.accelerations].map(|of| self.fastest(tile, &of[tile]));
            way(v, a)
        });
        let own: Vec<f64> = own.collect();
        let margin = |way: f64| LEAST_MARGIN.max(3.0 * way);
        let mut holds = Vec::new();
        let (crowd, riders, poses) = (self.crowd, &self.riders, &self.poses);
        let centre = |tile: usize| riders[tile].mover.place.xy();
        for (k, ((two, near), way)) in self.pairs.iter_mut().zip(ways).enumerate() {
            let tiles = [two.first, two.second];
            let [a, b] = tiles.map(|tile| &poses[tile]);
            let kinds = tiles.map(|tile| riders[tile].mover.kind);
            let margin = margin(way);
            for point in near.points(crowd, &a.to(&b.at), kinds, margin) {
                let at = a.transform(point.on_moving);
                let axis = a.rotation * point.normal;
                let gap = point.gap - SKIN;
                let mut hold = Hold::new(tiles.map(Some), at, axis, gap, centre);
                hold.pair = Some(k);
                hold.forces = near.force(&point.on_moving);
                holds.push(hold);
            }
        }
        if self.settings.walls {
            for (tile, rider) in riders.iter().enumerate() {
                at_rim(
                    crowd,
                    (&rider.mover, &poses[tile]),
                    margin(own[tile]),
                    &mut |point, axis, gap| {
                        holds.push(Hold::new([None, Some(tile)], point, axis, gap, centre));
                    },
                );
            }
        }
        holds
    }

    /// The time (s) of the first collision at which the step must end, or the longest step.
    fn until_knock(&self, state: &State, holds: &[Hold], longest: f64) -> f64 {
        let shortest = longest / SHORTEST;
        let mut first = longest;
        for hold in holds {
            let u = hold.rate(&state.velocities);
            let a = hold.rate(&state.accelerations);
            let Some((time, speed)) = closes(hold.gap, u, a) else {
                continue;
            };
            // Slow bounces, and those that end within the shortest step, are handled by `step`.
            let back = self.settings.restitution * speed;
            let is_resolved = back > SLOW.max(0.5 * shortest * -a);
            if time < first && is_resolved {
                first = time;
            }
        }
        first.max(shortest).min(longest)
    }

    /// Makes a step (s) along a way; returns the energy lost in contact (J).
    fn step(
        &mut self,
        state: &mut State,
        (way, mut holds): (Vec<Vector3<f64>>, Vec<Hold>),
        [masses, inverse]: [&[Vector3<f64>]; 2],
        h: f64,
    ) -> f64 {
        let law = [self.settings.friction, VELOCITY_ERROR];
        let mut free = state.halfway(h);
        let before = state.velocities.clone();
        let pulled = std::mem::take(&mut state.accelerations);
        holds.retain(|hold| hold.gap + hold.rate(&way) * h <= TOUCHED);
        // The return velocities at points where contact lasts for the whole step.
        let back = |hold: &Hold| {
            hold.is_held().then(|| {
                let [u, a] = [&before, &pulled].map(|of| hold.rate(of));
                closes(hold.gap, u, a).map_or(0.0, |(_, speed)| speed)
            })
        };
        let backs: Vec<Option<f64>> = holds.iter().map(back).collect();
        let is_held = backs.iter().any(Option::is_some);
        let is_pushed_out = |hold: &Hold| hold.is_held() && hold.rate(&way) > LEAST_BOUNCE;
        if holds.iter().any(is_pushed_out) {
            // Overlapping tiles are pushed apart in the step, but must not fly apart after it.
            let mut held = holds.clone();
            held.retain(Hold::is_held);
            held.iter_mut().for_each(|hold| hold.least = 0.0);
            hold_back(inverse, &mut free, &mut held, law);
        } else if is_held {
            free.copy_from_slice(&way);
        }
        for ((rider, pose), way) in self.riders.iter_mut().zip(&mut self.poses).zip(&way) {
            rider.mover.place += way * h;
            *pose = Pose::of(self.crowd, &rider.mover);
        }
        let (accelerations, pulls, potential) = self.accelerations(masses);
        state.pulls = pulls;
        let mut velocities = free;
        for (v, a) in velocities.iter_mut().zip(&accelerations) {
            *v += a * (0.5 * h);
        }
        let steady = self.steady.iter().zip(masses).zip(&way);
        let work = steady.map(|((a, mass), way)| mass.component_mul(a).dot(way) * h);
        let energy = kinetic(masses, &before) + work.sum::<f64>() + state.potential - potential;
        state.accelerations = accelerations;
        state.potential = potential;
        if !is_held {
            put_right(state, &mut velocities, (masses, &self.steady), energy, h);
        }
        for (_, near) in &mut self.pairs {
            near.held.clear();
        }
        if holds.is_empty() {
            state.velocities = velocities;
            return 0.0;
        }
        let energy = match is_held {
            true => energy,
            false => kinetic(masses, &velocities),
        };
        let riders = &self.riders;
        let centre = |tile: usize| riders[tile].mover.place.xy();
        let mut approaches = Vec::with_capacity(holds.len());
        for (hold, back) in holds.iter_mut().zip(backs) {
            // The point moves with the tile in front of it.
            let carried = hold.tiles[1].map_or(Vector2::zeros(), |tile| {
                let arm = hold.point - (riders[tile].mover.place.xy() - way[tile].xy() * h);
                (way[tile].xy() + Vector2::new(-arm.y, arm.x) * way[tile].z) * h
            });
            hold.place(hold.point + carried, centre);
            approaches.push(back.unwrap_or(-hold.rate(&velocities)));
        }
        let restitution = self.settings.restitution;
        let bounces = approaches.iter().any(|u| restitution * u > LEAST_BOUNCE);
        let mut after = |restitution: f64| {
            for (hold, approach) in holds.iter_mut().zip(&approaches) {
                hold.least = restitution * approach.max(0.0);
            }
            let mut after = velocities.clone();
            hold_back(inverse, &mut after, &mut holds, law);
            after
        };
        state.velocities = after(if bounces { restitution } else { 0.0 });
        if bounces && kinetic(masses, &state.velocities) > energy {
            let stopped = after(0.0);
            let each = state.velocities.iter().zip(&stopped);
            let change: Vec<_> = each.map(|(bounced, stopped)| bounced - stopped).collect();
            let share = share_within(masses, &stopped, &change, energy);
            state.velocities = stopped;
            for (v, change) in state.velocities.iter_mut().zip(&change) {
                *v += change * share;
            }
        }
        self.remember(&holds, h);
        energy - kinetic(masses, &state.velocities)
    }

    /// Keeps the forces at points of contact, by their impulses in half a step (s), as a guess for the
    /// next step.
    fn remember(&mut self, holds: &[Hold], h: f64) {
        for hold in holds {
            if let (Some(pair), [Some(first), _]) = (hold.pair, hold.tiles) {
                let pose = &self.poses[first];
                let (_, near) = &mut self.pairs[pair];
                near.held.push(Touch {
                    at: pose.inverse_transform(hold.point),
                    normal: pose.rotation.inverse() * hold.axis,
                    forces: hold.impulses.map(|impulse| impulse / (0.5 * h)),
                });
            }
        }
    }
}

/// The longest step (s) in which a force changes little over `feature` (m), by the acceleration
/// (m/s^2) of the pair by its own force.
pub fn longest_step(feature: f64, pull: f64) -> f64 {
    SHARE * (feature / pull.max(f64::MIN_POSITIVE)).sqrt()
}

/// An upper bound of the speed or acceleration of a tile's fastest point.
pub fn fastest(crowd: &Crowd, mover: &Mover, of: &Vector3<f64>) -> f64 {
    of.xy().norm() + crowd.kinds[mover.kind].reach * of.z.abs()
}

/// Corrects the velocities along the forces of the pairs, by less than a step (s) changed them, so
/// that the kinetic energy (J) matches the change of the potential; what cannot be corrected now is
/// carried over.
fn put_right(
    state: &mut State,
    velocities: &mut [Vector3<f64>],
    (masses, steady): (&[Vector3<f64>], &[Vector3<f64>]),
    energy: f64,
    h: f64,
) {
    let now = kinetic(masses, velocities);
    let wanted = energy + state.debt - now;
    let pulls = state.accelerations.iter().zip(steady);
    let pulls: Vec<Vector3<f64>> = pulls.map(|(all, steady)| all - steady).collect();
    let square = 2.0 * kinetic(masses, &pulls);
    if square == 0.0 {
        state.debt = wanted;
        return;
    }
    let each = masses.iter().zip(velocities.iter()).zip(&pulls);
    let along: f64 = each
        .map(|((mass, v), a)| mass.component_mul(v).dot(a))
        .sum();
    // The root closest to 0 of `along x + square x^2 / 2 = wanted`.
    let root = (along * along + 2.0 * square * wanted).max(0.0).sqrt();
    let x = 2.0 * wanted / (along + root.copysign(along));
    let most = 0.5 * h;
    let x = if x.is_finite() {
        x.clamp(-most, most)
    } else {
        0.0
    };
    for (v, a) in velocities.iter_mut().zip(&pulls) {
        *v += a * x;
    }
    state.debt = energy + state.debt - kinetic(masses, velocities);
}

/// The time at which a gap (m) that changes as `gap + u t + a t^2 / 2` closes, and its velocity
/// then (m/s).
fn closes(gap: f64, u: f64, a: f64) -> Option<(f64, f64)> {
    let gap = gap.max(0.0);
    let square = u * u - 2.0 * a * gap;
    if square < 0.0 || (u >= 0.0 && a >= 0.0) {
        return None;
    }
    let speed = square.sqrt();
    let time = match u < 0.0 {
        true => 2.0 * gap / (speed - u),
        false => (u + speed) / -a,
    };
    Some((time, speed))
}

/// The corners of a tile within a margin (m) of the rim: position, the rim's normal, and the gap.
pub fn at_rim(
    crowd: &Crowd,
    (mover, pose): (&Mover, &Pose),
    margin: f64,
    found: &mut dyn FnMut(Vector2<f64>, Vector2<f64>, f64),
) {
    let kind = &crowd.kinds[mover.kind];
    let room = rim_room(crowd, mover);
    if room > margin {
        return;
    }
    for corner in kind.tile.outline.vertices() {
        let p = pose.transform(*corner);
        for axis in 0..2 {
            let gap = crowd.half_size[axis] - p[axis].abs();
            if gap <= margin {
                let mut normal = Vector2::zeros();
                normal[axis] = -p[axis].signum();
                found(p, normal, gap);
            }
        }
    }
}

/// A lower bound of a tile's distance (m) from the rim.
pub fn rim_room(crowd: &Crowd, mover: &Mover) -> f64 {
    let [x, y] = crowd.half_size;
    let p = mover.place.xy();
    (x - p.x.abs()).min(y - p.y.abs()) - crowd.kinds[mover.kind].reach
}
