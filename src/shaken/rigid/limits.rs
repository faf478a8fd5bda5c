//! How long a step may be, and the points that may come into contact within it.
//!
//! A step is short enough that the forces of pairs in relative motion change little:
//! `h <= 0.05 sqrt(l / a)`, with l half the shortest side of a magnet and a the acceleration of the
//! pair by its own force. Where tiles touch and hardly bounce, contact stops most of this
//! acceleration: there `h <= 0.2 sqrt(l / s)`, with s the acceleration along the contact that
//! friction cannot stop, and `h <= 0.8 sqrt(l / a)`; and touching tiles travel by no more than a
//! ninth of l. All these limits scale with the step of the table.

use nalgebra::Vector3;

use super::World;
use super::fan::longest_step;
use super::hold::Hold;
use super::island::{Island, mover};
use super::margins::Margins;
use super::motion::{State, Strength, fastest, relative};
use super::near::{NearPair, at_rim};
use super::pair::Two;
use super::short::Each;
use tiles::contact::{ContactPoint, TurnsWith};

/// Tiles that friction holds and that travel less than this share of the travel of touching tiles
/// in a step of the table need no short steps.
const RESTING: f64 = 1.0 / 32.0;
/// Steps are longer by this factor where tiles touch and hardly bounce, by what accelerates them
/// along the contact.
const ALONG: f64 = 4.0;
/// The same, by the whole acceleration.
const TOGETHER: f64 = 16.0;
/// The same of tiles that slide to and fro, in radians: the energy of such a swing errs by a quarter of the
/// square, as a share, until velocities are put right.
const SWING: f64 = 0.2;
/// Ratio of the longest step to the shortest bounce.
const SHORTEST: f64 = 16.0;

impl<W: World> Island<'_, W> {
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
            let speed = self.relative(*two, &state.velocities);
            let travel = speed * self.laws.step;
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
            let lightness = lightness[0] + lightness[1];
            let along = near.slide(pull.force, self.laws.friction);
            // Where they swing to and fro, and friction cannot stop them at the end of a swing.
            let rate = (near.stiffness * lightness).sqrt();
            let swings = along * lightness + speed * rate > 0.0;
            let swing = if swings { SWING / rate } else { f64::INFINITY };
            (ALONG * longest_step(feature, along * lightness))
                .min(TOGETHER * whole)
                .min(swing)
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
    pub(super) fn time_to_travel(&self, velocities: &[Vector3<f64>], holds: &[Hold]) -> f64 {
        let speed = |hold: &Hold| match (hold.pair, hold.tiles[1]) {
            (Some(pair), _) => self.relative(self.pairs[pair].0, velocities),
            (None, tile) => tile.map_or(0.0, |tile| self.fastest(tile, &velocities[tile])),
        };
        let touching = |hold: &&Hold| hold.gap <= self.travel();
        let time = |of_pairs: bool, travel: f64| {
            // The points of a pair, or of a tile at the rim, follow each other and have one speed.
            let alike = holds.chunk_by(|a, b| (a.pair, a.tiles) == (b.pair, b.tiles));
            let alike = alike.filter(|it| it[0].pair.is_some() == of_pairs);
            let fastest = alike.filter_map(|it| it.iter().find(touching)).map(speed);
            let fastest = fastest.fold(0.0, f64::max);
            travel * self.fineness() / fastest.max(f64::MIN_POSITIVE)
        };
        let Margins {
            travel, rim_travel, ..
        } = *self.margins;
        time(true, travel).min(time(false, rim_travel))
    }

    /// Finds the longest step from a state, of at most a time (s), and the points for it.
    pub(super) fn look(&mut self, state: &mut State, inverse: &[Vector3<f64>], time: f64) {
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
        let mut holds = Vec::with_capacity(4 * self.pairs.len());
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
}
