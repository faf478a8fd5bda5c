//! The way of a step: the mean velocities in it, with the impulses of the points that last, and its length.

use nalgebra::Vector3;

use super::World;
use super::hold::{Hold, Move};
use super::island::{Island, PRECISE};
use super::margins::Margins;
use super::motion::{State, StepWay, Unsolved, closes};
use super::rest::Rest;
use super::short::{Each, Points};
use super::solve::Solver;

/// The relative error of the travel of touching tiles in a step.
const TRAVEL_ERROR: f64 = 0.01;
/// Forecasts of the places at the end of a step, each with the gaps of the one before.
const FORECASTS: usize = 8;
/// Searches for the time of a knock, or for the points that last.
const SEARCHES: usize = 60;

impl<W: World> Island<'_, W> {
    /// The mean velocities in a step, the points that last with their impulses, and the length (s) of
    /// the step: at most `longest`, and shorter if touching tiles would travel too far or a gap closes.
    pub(super) fn way(
        &mut self,
        state: &State,
        inverse: &[Vector3<f64>],
        longest: f64,
    ) -> Result<StepWay, Unsolved> {
        let mut solver = std::mem::take(&mut self.solver);
        let way = self.search(state, inverse, longest, &mut solver);
        self.solver = solver;
        way
    }

    fn search(
        &self,
        state: &State,
        inverse: &[Vector3<f64>],
        mut longest: f64,
        solver: &mut Solver,
    ) -> Result<StepWay, Unsolved> {
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
        let lasting = state.holds.iter().zip(&lasts).filter(|it| *it.1);
        let mut holds: Vec<Hold> = lasting.map(|it| *it.0).collect();
        let mut is_new = true;
        // The longest step known to travel too little, the shortest known to travel too far, and the last one
        // with its pace.
        const UNKNOWN: [f64; 2] = [0.0, f64::INFINITY];
        let (mut bounds, mut known) = (UNKNOWN, (0.0, 1.0 / now));
        // Tiles turn much as they did.
        let mut guess = state.velocities.clone();
        for _ in 0..SEARCHES {
            let mut rests = self.rests(inverse, 0.5 * h);
            for (rest, rub) in rests.iter_mut().zip(&state.rubs) {
                rest.impulse = rub * (0.5 * h);
            }
            if is_new {
                solver.prepare(inverse.len(), (&holds, &rests), self.laws.friction);
                is_new = false;
            }
            for hold in &mut holds {
                hold.impulses = hold.forces.map(|force| force * 0.5 * h);
            }
            let points = (&mut holds[..], &mut rests[..]);
            let (way, moves) = self.forecast(state, points, inverse, (h, &guess), solver)?;
            for hold in &mut holds {
                hold.forces = hold.impulses.map(|impulse| impulse / (0.5 * h));
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
                    guess = way;
                    h = match least < next && next < most {
                        true => next,
                        false => 0.5 * (least + most.min(longest)),
                    };
                    continue;
                }
                if is_too_far && h > least {
                    guess = way;
                    h = least;
                    continue;
                }
            }
            let mut first = h;
            for (k, hold) in state.holds.iter().enumerate() {
                let gap = hold.gap_after(&moves, skin);
                if lasts[k] || gap >= hold.gap.min(0.0) - rounding {
                    continue;
                }
                // The parabola through both gaps.
                let u = hold.rate(&state.velocities);
                let a = 2.0 * (gap - hold.gap - u * h) / (h * h);
                match closes(hold.gap - 0.5 * touched, u, a) {
                    Some((time, speed)) if speed > slow[k] => first = first.min(time),
                    _ => {
                        let before = lasts[..k].iter().filter(|it| **it).count();
                        holds.insert(before, *hold);
                        lasts[k] = true;
                        is_new = true;
                    }
                }
            }
            if !is_new && first == h {
                return Ok(StepWay {
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
            guess = way;
            bounds = UNKNOWN;
            known = (0.0, 1.0 / now);
        }
        Err(Unsolved)
    }

    /// The mean velocities in a step (s) that keep the gaps of lasting points from closing, and how each tile moves
    /// so.
    fn forecast(
        &self,
        state: &State,
        (holds, rests): (&mut [Hold], &mut [Rest]),
        inverse: &[Vector3<f64>],
        (h, guess): (f64, &[Vector3<f64>]),
        solver: &mut Solver,
    ) -> Result<(Each<Vector3<f64>>, Each<Move>), Unsolved> {
        let free = state.halfway(h);
        // By how much the gaps at the end differ from a linear forecast (m).
        let bent = |hold: &Hold, way: &[Vector3<f64>], moves: &[Move]| {
            let linear = hold.gap + h * hold.rate(way);
            hold.gap_after(moves, self.margins.skin) - linear
        };
        let guessed = moves(guess, h);
        let bends = holds.iter().map(|hold| bent(hold, guess, &guessed));
        let mut bends: Points<f64> = bends.collect();
        for _ in 0..FORECASTS {
            for (hold, bend) in holds.iter_mut().zip(&bends) {
                // Overlaps within the skin stay as they are: to undo them would add energy.
                hold.least = -(hold.gap.max(0.0) + bend) / h;
            }
            let mut way = free.clone();
            let [_, error] = self.law(h);
            if !solver.hold_back(inverse, &mut way, (holds, rests), error) {
                return Err(Unsolved);
            }
            let moves = moves(&way, h);
            let mut change: f64 = 0.0;
            for (hold, bend) in holds.iter().zip(&mut bends) {
                let linear = hold.gap + h * hold.rate(&way);
                let now = bent(hold, &way, &moves);
                if hold.is_held() || linear + now < hold.gap.min(0.0) {
                    change = change.max((now - *bend).abs());
                    *bend = now;
                }
            }
            if change <= PRECISE * self.margins.rounding {
                return Ok((way, moves));
            }
        }
        Err(Unsolved)
    }
}

/// How each tile moves in a time (s).
fn moves(way: &[Vector3<f64>], h: f64) -> Each<Move> {
    way.iter().map(|way| Move::new(way, h)).collect()
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
