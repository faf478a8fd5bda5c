//! Contact points by [pivots](super::pivot) where tiles rub on the table as well: its friction is no linear law, so
//! both take turns, each with the impulses that the other has found.

use nalgebra::Vector3;

use super::pivot::by_pivots;
use super::point::{SolverPoint, change};
use super::rest::{Four, RestPoint};

/// Pivots and friction on the table take turns this often at most.
const TURNS: usize = 200;
/// What they would still change is extrapolated after so many.
const AITKEN: usize = 6;
/// Friction on the table is solved for alone until a sweep changes velocities by less than this share of the error,
/// for no more than so many sweeps.
const RUBBED: f64 = 0.01;
const SWEEPS: usize = 1000;

/// All points of a cluster whose masses have these inverse roots, from the velocities without impulses.
pub struct Turns<'a> {
    pub roots: &'a [Vector3<f64>],
    pub free: &'a [Four],
    pub velocities: &'a mut Vec<Four>,
    /// Room for the velocities before a sweep.
    pub before: &'a mut Vec<Four>,
    pub points: &'a mut [SolverPoint],
    pub rests: &'a mut [RestPoint],
    pub error: f64,
}

impl Turns<'_> {
    /// Solves by pivots; friction on the table takes turns with them, as it is no linear law.
    pub fn pivot(mut self) -> Option<()> {
        let mut last = f64::INFINITY;
        for turn in 1..=TURNS {
            self.velocities.copy_from_slice(self.free);
            for rest in &*self.rests {
                rest.push(rest.impulse, self.velocities);
            }
            let impulses = by_pivots(self.points, self.velocities)?;
            for (point, impulses) in self.points.iter_mut().zip(impulses) {
                point.impulses = impulses;
                point.push(impulses, self.velocities);
            }
            let before: Vec<_> = self.rests.iter().map(|it| it.impulse).collect();
            self.rub();
            let mut points = self.points.iter();
            if points.all(|it| it.obeys(self.velocities, self.error)) {
                return Some(());
            }
            if self.rests.is_empty() {
                return None;
            }
            let each = self.rests.iter().zip(&before);
            let each = each.map(|(it, before)| [0, 1].map(|k| it.impulse[k] - before[k]));
            let changes: Vec<[f64; 2]> = each.collect();
            let squares = changes.iter().flatten().map(|it| it * it);
            let size = squares.sum::<f64>().sqrt();
            // Each turn changes by a share of the one before: from time to time by all that is to come (Aitken).
            let share = size / last;
            last = size;
            if turn.is_multiple_of(AITKEN) && share < 1.0 {
                for (rest, change) in self.rests.iter_mut().zip(changes) {
                    let more = share / (1.0 - share);
                    rest.impulse = rest.within([0, 1].map(|k| rest.impulse[k] + change[k] * more));
                }
                last = f64::INFINITY;
            }
        }
        None
    }

    /// Solves for friction on the table alone.
    fn rub(&mut self) {
        for _ in 0..SWEEPS {
            self.before.clone_from(self.velocities);
            for rest in &mut *self.rests {
                rest.solve(self.velocities);
            }
            let [_, fastest] = change([&*self.velocities, &*self.before], self.roots);
            if fastest < (RUBBED * self.error).powi(2) {
                return;
            }
        }
    }
}
