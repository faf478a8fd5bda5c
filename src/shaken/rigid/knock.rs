//! Knocks: impulses with restitution where gaps close, at the end of a step.
//!
//! Where bounces contradict each other, a share of the impulses is given back instead. Where many points or
//! friction would increase the energy (Kane and Levinson 1985), the restitution is reduced until they do
//! not. Knocks so slow that tiles would bounce for less than the shortest step are without restitution, and
//! the points then last for whole steps.

use nalgebra::Vector3;

use super::World;
use super::hold::{Hold, kinetic, share_within};
use super::island::{Island, Masses};
use super::motion::{State, Unsolved};
use super::short::Each;
use super::solve::Solver;

/// The impulses of a knock are searched for this often, each time from those of the last.
const KNOCKS: usize = 8;

impl<W: World> Island<'_, W> {
    /// Changes the velocities where touching points close; returns the energy lost (J).
    pub(super) fn knock(
        &mut self,
        state: &mut State,
        [masses, inverse]: Masses,
    ) -> Result<f64, Unsolved> {
        let law = self.law(state.unhurried);
        let touching = || {
            state
                .holds
                .iter()
                .filter(|it| it.gap <= self.margins.touched)
        };
        if touching().all(|hold| hold.rate(&state.velocities) >= -law[1]) {
            return Ok(0.0);
        }
        let mut holds: Vec<Hold> = touching().copied().collect();
        let before = state.velocities.clone();
        let mut bounces = false;
        let mut backs = Vec::with_capacity(holds.len());
        for hold in &mut holds {
            let back = -self.laws.restitution * hold.rate(&before);
            let back = if back > self.slow(state, hold) {
                back
            } else {
                0.0
            };
            bounces |= back > 0.0;
            backs.push(back);
            hold.least = 0.0;
            hold.impulses = [0.0; 2];
        }
        let [friction, error] = law;
        self.solver.prepare(before.len(), (&holds, &[]), friction);
        let solver = &mut self.solver;
        let mut stopped = knocked(solver, inverse, &before, &mut holds, error)?;
        if bounces {
            let of_stop: Vec<_> = holds.iter().map(|hold| hold.impulses).collect();
            for (hold, back) in holds.iter_mut().zip(backs) {
                hold.least = back;
            }
            let bounced = knocked(solver, inverse, &before, &mut holds, error);
            let bounced = bounced.or_else(|Unsolved| {
                let law = [self.laws.restitution, error];
                let stop = (&stopped[..], &of_stop[..]);
                given_back(solver, inverse, &before, stop, &mut holds, law)
            })?;
            let each = bounced.iter().zip(&stopped);
            let change: Each<_> = each.map(|(bounced, stopped)| bounced - stopped).collect();
            let share = share_within(masses, &stopped, &change, kinetic(masses, &before));
            for (v, change) in stopped.iter_mut().zip(&change) {
                *v += change * share;
            }
            for (hold, stop) in holds.iter_mut().zip(of_stop) {
                for (impulse, stop) in hold.impulses.iter_mut().zip(stop) {
                    *impulse = stop + (*impulse - stop) * share;
                }
            }
        }
        state.velocities = stopped;
        let work = holds.iter().map(|it| it.work(&before, &state.velocities));
        Ok(-work.sum::<f64>())
    }
}

/// The velocities after a knock whose bounces contradict each other, as in wedges: by Poisson's law, a share of
/// the impulses that stop the knock is given back, and what closes then is stopped (Anitescu and Potra 1997).
/// There always are such impulses.
fn given_back(
    solver: &mut Solver,
    inverse: &[Vector3<f64>],
    before: &[Vector3<f64>],
    (stopped, of_stop): (&[Vector3<f64>], &[[f64; 2]]),
    holds: &mut [Hold],
    [share, error]: [f64; 2],
) -> Result<Each<Vector3<f64>>, Unsolved> {
    for hold in holds.iter_mut() {
        hold.least = 0.0;
        hold.impulses = [0.0; 2];
    }
    let each = before.iter().zip(stopped);
    let free: Each<_> = each.map(|(v, stop)| stop + (stop - v) * share).collect();
    let after = knocked(solver, inverse, &free, holds, error)?;
    for (hold, stop) in holds.iter_mut().zip(of_stop) {
        for (impulse, stop) in hold.impulses.iter_mut().zip(stop) {
            *impulse += stop * (1.0 + share);
        }
    }
    Ok(after)
}

/// The velocities after a knock. Where the search does not suffice, as in wedges, it goes on.
fn knocked(
    solver: &mut Solver,
    inverse: &[Vector3<f64>],
    before: &[Vector3<f64>],
    holds: &mut [Hold],
    error: f64,
) -> Result<Each<Vector3<f64>>, Unsolved> {
    for _ in 0..KNOCKS {
        let mut after = Each::from_slice(before);
        if solver.hold_back(inverse, &mut after, (holds, &mut []), error) {
            return Ok(after);
        }
    }
    Err(Unsolved)
}
