//! The impulses of a cluster's contact points by sweeps that solve one point after the other.
//!
//! After each sweep the impulses go on by a share of its change, as in momentum methods (Polyak 1964, USSR
//! Computational Mathematics and Mathematical Physics 4, 1), with the share from how much less this sweep changed
//! than the one before; without this, clusters take thousands of sweeps. (On 1,247 clusters of 6 to 85 points
//! from a frozen table this takes 1.4 million solutions of a point; with conjugate directions,
//! Silcowitz-Hansen, Niebe and Erleben 2010, The Visual Computer 26, 893, it takes 2.6 million. Newton steps on
//! the set of active points cycle among points that carry little.)
//!
//! Where tiles rub on the table they lie on, the points of [`super::rest`] belong to the same sweeps.

use nalgebra::Vector3;

use super::point::{SolverPoint, change};
use super::rest::{Four, RestPoint};
use tiles::potential::simd::lanes::{Lanes, Task};

/// Largest number of sweeps.
const SWEEPS: usize = 1000;
/// This many sweeps at the end are plain ones, which always converge towards the solution.
const PLAIN: usize = 500;
/// Slowest convergence that is assumed: the share of a sweep's change that the next one makes.
const SLOWEST: f64 = 0.99;
/// Largest share of a sweep's change by which the impulses go on after it.
const MOMENTUM: f64 = 0.85;

/// Solves for all points of a cluster whose masses have these inverse roots; its result is the number
/// of sweeps, or `None` if they did not suffice.
pub struct Sweeps<'a> {
    pub roots: &'a [Vector3<f64>],
    pub velocities: &'a mut [Four],
    /// Room for the velocities before and after a sweep.
    pub before: &'a mut Vec<Four>,
    pub swept: &'a mut Vec<Four>,
    pub points: &'a mut [SolverPoint],
    pub rests: &'a mut [RestPoint],
    pub error: f64,
}

impl Task for Sweeps<'_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> Option<usize> {
        let Self {
            roots,
            velocities,
            before,
            swept,
            points,
            rests,
            error,
        } = self;
        for point in points.iter() {
            point.push(point.impulses, velocities);
        }
        for point in rests.iter() {
            point.push(point.impulse, velocities);
        }
        for it in [&mut *before, &mut *swept] {
            it.clear();
            it.extend_from_slice(velocities);
        }
        let mut last = f64::INFINITY;
        for sweep in 0..SWEEPS {
            for point in points.iter_mut() {
                point.solve(velocities);
            }
            for point in rests.iter_mut() {
                point.solve(velocities);
            }
            // Nearly redundant points may keep correcting each other, so the change over a whole
            // sweep counts.
            let [size, fastest] = change([&*velocities, &*before], roots);
            // If each sweep changes them by a share of the one before, this much is still to come.
            let share = (size / last).sqrt();
            let to_come = 1.0 / (1.0 - share.min(SLOWEST));
            if fastest * to_come * to_come < error * error {
                return Some(sweep + 1);
            }
            if sweep + PLAIN < SWEEPS {
                let share = share.min(MOMENTUM);
                for (now, swept) in velocities.iter_mut().zip(&mut *swept) {
                    for (now, swept) in now.iter_mut().zip(swept) {
                        let change = *now - *swept;
                        *swept = *now;
                        *now += change * share;
                    }
                }
                for point in points.iter_mut() {
                    point.go_on(share, velocities);
                }
                for point in rests.iter_mut() {
                    point.go_on(share, velocities);
                }
            }
            last = size;
            before.copy_from_slice(velocities);
        }
        None
    }
}
