//! A step along its way, and what it did to the energy.

use nalgebra::{Vector2, Vector3};

use super::World;
use super::hold::{Hold, kinetic};
use super::island::{Island, Masses};
use super::motion::{State, StepWay, Unsolved, put_right, put_right_held};
use super::near::Touch;
use super::rest::{GRAVITY, Rest};
use super::short::{Each, Points};

/// A step that ends in an overlap which was not foreseen, or by whose error contact gives energy, is repeated
/// with half the time, this often at most.
const FORESEEN: i32 = 6;
/// The largest share of the kinetic energy that the error of a step may give where a point comes back.
const GAINED: f64 = 1e-3;
/// Points move apart if they do so faster than this many times the error of velocities.
const RETURNED: f64 = 10.0;

impl<W: World> Island<'_, W> {
    /// Makes a step and the knock at its end, with `after` (s) left after it. Returns the energy lost in contact (J).
    pub(super) fn step(
        &mut self,
        state: &mut State,
        way: StepWay,
        [masses, inverse]: Masses,
        after: f64,
    ) -> Result<f64, Unsolved> {
        let StepWay {
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
        let rates: Points<f64> = state
            .holds
            .iter()
            .map(|hold| hold.rate(&state.velocities))
            .collect();
        let lasts = |(k, hold): (usize, &Hold)| {
            let slow = self.slow(&next, hold);
            // Whether the nearest point moved apart, by its normal at the start: where tiles turn together, that at
            // the end would show a bounce.
            let bounced = || {
                let all = state.holds.iter().zip(&rates);
                let fast = all.clone().filter(|it| *it.1 > slow && it.0.is_like(hold));
                let nearest = fast.map(|it| it.0.apart(hold)).reduce(f64::min);
                // What lasts has much the same place in both lists, so the search from there is short.
                let mut others = all.cycle().skip(k).take(rates.len());
                let mut is_any_within = |distance: f64| {
                    others.any(|(it, rate)| {
                        *rate <= slow && it.is_like(hold) && it.apart(hold) <= distance
                    })
                };
                nearest.is_some_and(|distance| !is_any_within(distance))
            };
            held.iter().any(|it| it.is_like(hold)) && hold.rate(&way) >= -slow && !bounced()
        };
        let last = next.holds.iter().enumerate().filter(|it| lasts(*it));
        let mut holds: Vec<Hold> = last.map(|it| *it.1).collect();
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
        let rubs = rests.iter().map(|it| it.impulse / (0.5 * h));
        next.rubs = rubs.collect();
        // Velocities are not put right where tiles are shaken: the correction changes volumes in phase space,
        // which makes bonds rarer than in equilibrium, and the kicks level errors of energy anyway.
        let is_at_rim = |hold: &Hold| hold.pair.is_none() && hold.is_held();
        let is_mechanical = !self.laws.is_shaken && rests.is_empty();
        let is_put_right = !is_free && is_mechanical && !holds.iter().any(is_at_rim);
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
            // This holds the error of what slides in the step, too, of either sign; shorter steps err less.
            if lost < -GAINED * kinetic(masses, &state.velocities) && state.halvings < FORESEEN {
                self.put_back(&before);
                return Err(Unsolved);
            }
            // Where the velocities are put right by it, contact gives nothing so; where not, it is what the
            // step did.
            if is_put_right {
                lost = lost.max(0.0);
            }
        }
        if is_put_right {
            let places: Each<_> = self.riders.iter().map(|it| it.mover.place).collect();
            // Tiles that stand still stop the common motion.
            let places = self.still.is_empty().then_some(&places[..]);
            put_right_held(&mut next, (masses, places), energy - lost);
        }
        self.remember(&holds, h);
        let Ok(settled) = self.settle(&mut next, [masses, inverse]) else {
            self.put_back(&before);
            return Err(Unsolved);
        };
        self.account.table_loss -= rubbed;
        self.account.work += swung;
        self.steps += 1;
        *state = next;
        Ok(lost + settled)
    }

    /// Stops the velocities at the end of a step (s) into the contact, and lets the table rub. A point that
    /// slid on the table in the first half of the step slides in the same direction in the second, so
    /// that the step is symmetric in time; unless this would turn its sliding round.
    fn stop(
        &mut self,
        next: &mut State,
        way: &[Vector3<f64>],
        (holds, rests): (&mut [Hold], Vec<Rest>),
        inverse: &[Vector3<f64>],
        h: f64,
    ) -> Result<Vec<Rest>, Unsolved> {
        // The next step may be longer: it starts with these velocities, and must not take errors for a bounce.
        let [friction, error] = self.law(h.max(next.unhurried));
        let mut now = self.rests(inverse, 0.5 * h);
        for (now, first) in now.iter_mut().zip(&rests) {
            now.impulse = first.impulse;
            now.is_given = first.slides();
        }
        let solver = &mut self.solver;
        solver.prepare(inverse.len(), (holds, &now), friction);
        if now.is_empty() {
            let held = (holds, &mut now[..]);
            let is_found = solver.hold_back(inverse, &mut next.velocities, held, error);
            return is_found.then_some(now).ok_or(Unsolved);
        }
        let free = next.velocities.clone();
        loop {
            if !solver.hold_back(inverse, &mut next.velocities, (holds, &mut now), error) {
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
    pub(super) fn rests(&self, inverse: &[Vector3<f64>], time: f64) -> Vec<Rest> {
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
