//! Trajectories released on both sides of a saddle.

use nalgebra::Vector3;

use super::super::{Side, SideVerdict};
use super::{ARRIVED, Checker};
use crate::dynamics::docking::stream;
use crate::dynamics::{Motion, Stop};
use landscape::{Barrier, PathwayPoint, Place, State, highest_point};
use tiles::configuration::Configuration;

/// Energy below the saddle at which the tile is released on both sides, in units of the barrier.
const BESIDE: f64 = 0.01;
/// Largest time (s) for the tile to come to rest.
const SETTLING: f64 = 60.0;

impl Checker<'_> {
    /// Releases the tile at rest on both sides of the saddle, where the pathway from each end first
    /// rises that high.
    pub(super) fn sides(&self, steps: &mut usize) -> [Option<Side>; 2] {
        let path = &self.barrier.pathway;
        let Some(highest) = highest_point(path) else {
            return [None; 2];
        };
        let top = path.iter().position(|p| p == highest).unwrap_or(0);
        let (before, behind) = (&path[..top], &path[top + 1..]);
        let Barrier { from, to, .. } = self.barrier;
        let on = [
            self.places_on(before, *from, *to),
            self.places_on(behind, *to, *from),
        ];
        [0, 1].map(|side| {
            if side == 1 && *to == Place::Free {
                return None;
            }
            let drop = match to {
                Place::Free => self.barrier.forward(),
                Place::State(_) => self.barrier.forward().min(self.barrier.reverse()),
            };
            // The path from its own end stays below the ceiling, so an end on the other side
            // refutes the claim.
            let low = (highest.energy - BESIDE * drop).min(self.ceiling);
            let is_low = |p: &&PathwayPoint| p.energy < low;
            let released = match side {
                0 => before.iter().take_while(is_low).last(),
                _ => behind.iter().rev().take_while(is_low).last(),
            };
            let start = Motion {
                configuration: released?.configuration,
                velocity: Vector3::zeros(),
            };
            let ended = self.settled_place(&start, steps);
            let other = [*to, *from][side];
            let verdict = match ended {
                Some(place) if on[side].contains(&place) => SideVerdict::OnThePathway,
                Some(place) if place == other => SideVerdict::Opposite,
                _ => SideVerdict::Elsewhere,
            };
            Some(Side { ended, verdict })
        })
    }

    /// The places on one half of the pathway: its own end and states on the way there.
    fn places_on(&self, path: &[PathwayPoint], own: Place, other: Place) -> Vec<Place> {
        let near = |state: &&State| {
            let distance = |q: &Configuration| self.problem.space.distance(&state.configuration, q);
            path.iter()
                .any(|p| distance(&p.configuration) < self.problem.scaled(ARRIVED))
        };
        let passed = self.states.iter().filter(near);
        let passed = passed.map(|state| Place::State(state.id));
        let passed = passed.filter(|place| *place != other);
        std::iter::once(own).chain(passed).collect()
    }

    /// The place where a trajectory with light drag comes to rest; also `None` if the integration
    /// error raised it above the ceiling.
    fn settled_place(&self, start: &Motion, steps: &mut usize) -> Option<Place> {
        let space = &self.problem.space;
        let slow = 1e-3 * self.barrier.forward();
        let mut rng = stream(self.settings.seed, 0);
        let mut spoilt = false;
        let run = self.settling.run(
            start,
            self.problem.scale().time(SETTLING),
            &mut rng,
            &mut |snapshot| {
                let q = &snapshot.motion.configuration;
                spoilt |= snapshot.total() >= self.ceiling;
                let is_here = |s: &State| {
                    space.distance(&s.configuration, q) < 0.1 * self.problem.scaled(ARRIVED)
                };
                spoilt
                    || space.is_far(q)
                    || (snapshot.kinetic < slow && self.states.iter().any(is_here))
            },
        );
        spoilt |= run.stop == Stop::Failed;
        *steps += run.free_steps + run.contact_steps;
        (!spoilt).then(|| self.place_below(&run.last)).flatten()
    }
}
