//! Tiles that rest relative to each other and hold each other so move as one.
//!
//! A bond that neither slides, opens nor rattles needs no search for what lasts in a step. Where all tiles of an
//! island have one common rigid motion, and one solution of contact with the points and forces of the step
//! before shows that this motion needs no impulse outside the friction cones, the step is that of a rigid body.
//! In all other cases the step is solved in full ([`super::island`]). This is the full solution, too: it would
//! hold the same points and find the same impulses, since the law of contact is satisfied by them. Steps after
//! the kicks of shaking are not among them, even where friction stops the kick within the step: each lets the tiles
//! slide a little, which adds up to a creep (of 25 um in a second for the paper's one-faced tiles, kT a twentieth of
//! the bond's energy).

use nalgebra::{Rotation2, Vector2, Vector3};

use super::World;
use super::hold::{Hold, kinetic};
use super::island::{Island, Masses};
use super::motion::{Common, fastest};
use super::near::at_rim;
use super::short::Each;

/// Tiles rest relative to each other if their speeds differ by less than this many times the error of
/// velocities.
const AT_REST: f64 = 10.0;
/// Of the friction there is, this share may be needed.
const FRICTION: f64 = 0.95;

impl<W: World> Island<'_, W> {
    /// Moves all tiles as one body through a step of the table. Returns false, and changes nothing, if they do
    /// not rest relative to each other, contact does not hold them so, or the rim, fans, tiles that stand
    /// still or friction on the table may act.
    pub(super) fn move_as_one(&mut self, [masses, inverse]: Masses) -> bool {
        let laws = self.laws;
        let is_ruled_out = self.riders.len() < 2
            || !self.still.is_empty()
            || !laws.fans.0.is_empty()
            || laws.table_friction > 0.0
            || laws.friction == 0.0;
        if is_ruled_out {
            return false;
        }
        let h = laws.step;
        let error = self.law(h)[1];
        let places: Each<_> = self.riders.iter().map(|it| it.mover.place).collect();
        let velocities: Each<_> = self.riders.iter().map(|it| it.mover.velocity).collect();
        let common = Common::of(masses, &places, &velocities);
        let own = places.iter().zip(&velocities);
        let own: Each<_> = own.map(|(at, v)| v - common.at(at)).collect();
        if !self.are_slow(&own, AT_REST * error) || !self.still_touch() {
            return false;
        }
        let forces = self.forces(masses, 0.0);
        let pushed = Common::of(masses, &places, &forces.accelerations);
        let step = common.velocity * h + pushed.velocity * (0.5 * h * h);
        let way = step.xy().norm() + common.reach(&places) * step.z.abs();
        if laws.walls && self.are_at_rim(self.margins.least + 3.0 * way) {
            return false;
        }
        // What the forces would change of the common motion; arms turn about the centre.
        let spin = common.velocity.z + 0.5 * h * pushed.velocity.z;
        let each = places.iter().zip(&forces.accelerations);
        let change = each.map(|(at, a)| {
            let inwards = (at.xy() - common.centre) * (spin * spin);
            (a - pushed.at(at) + inwards.push(0.0)) * h
        });
        let mut change: Each<Vector3<f64>> = change.collect();
        let mut holds = self.last_holds(h);
        let friction = FRICTION * laws.friction;
        let solver = &mut self.solver;
        solver.prepare(change.len(), (&holds, &[]), friction);
        let is_held = solver.hold_back(inverse, &mut change, (&mut holds, &mut []), error);
        if !is_held || !self.are_slow(&change, AT_REST * error) {
            return false;
        }
        self.account.contact_loss += kinetic(masses, &own);
        let turn = Rotation2::new(step.z);
        let after = common.velocity + pushed.velocity * h;
        for rider in &mut self.riders {
            let mover = &mut rider.mover;
            let arm: Vector2<f64> = turn * (mover.place.xy() - common.centre);
            mover.place = (common.centre + step.xy() + arm).push(mover.place.z + step.z);
            let v = after.xy() + Vector2::new(-arm.y, arm.x) * after.z;
            mover.velocity = v.push(after.z);
        }
        let mut holds = holds.iter();
        for (_, near) in &mut self.pairs {
            for (touch, hold) in near.held.iter_mut().zip(&mut holds) {
                touch.forces = hold.impulses.map(|impulse| impulse / h);
            }
        }
        self.steps += 1;
        true
    }

    /// Whether a corner is within a margin (m) of the rim.
    fn are_at_rim(&self, margin: f64) -> bool {
        let mut is_any = false;
        for (rider, pose) in self.riders.iter().zip(&self.poses) {
            at_rim(self.world, (&rider.mover, pose), margin, &mut |_, _, _| {
                is_any = true;
            });
        }
        is_any
    }

    /// Whether no point of a tile is faster than a limit (m/s).
    fn are_slow(&self, velocities: &[Vector3<f64>], most: f64) -> bool {
        let mut each = self.riders.iter().zip(velocities);
        each.all(|(it, v)| fastest(self.world, &it.mover, v) <= most)
    }

    /// Whether all pairs with points of contact are where they were when these were found.
    fn still_touch(&self) -> bool {
        let touching = self.pairs.iter().filter(|(_, near)| !near.held.is_empty());
        let mut is_any = false;
        for (two, near) in touching {
            let [first, second] = [two.first, two.second];
            let q = self.poses[first].to(&self.poses[second].at);
            let kinds = [first, second].map(|k| self.riders[k].mover.kind);
            if near.moved_since_held(self.world, &q, kinds) > self.margins.touched {
                return false;
            }
            is_any = true;
        }
        is_any
    }

    /// The points of contact of the step before, pair by pair, with what their forces do in a time (s).
    fn last_holds(&self, time: f64) -> Vec<Hold> {
        let centre = |tile: usize| self.riders[tile].mover.place.xy();
        let mut holds = Vec::new();
        for (k, (two, near)) in self.pairs.iter().enumerate() {
            let pose = &self.poses[two.first];
            let tiles = [Some(two.first), Some(two.second)];
            holds.extend(near.held.iter().map(|touch| {
                let normal = (pose.rotation * touch.normal, touch.turns_with);
                let mut hold = Hold::new(tiles, pose.transform(touch.at), normal, 0.0, centre);
                hold.pair = Some(k);
                hold.impulses = touch.forces.map(|force| force * time);
                hold
            }));
        }
        holds
    }
}
