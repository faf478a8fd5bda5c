//! The impulses of a cluster's contact points by sweeps that solve one point after the other.
//!
//! After each sweep the impulses go on by a share of its change, as in momentum methods (Polyak 1964, USSR
//! Computational Mathematics and Mathematical Physics 4, 1), with the share from how much less this sweep changed
//! than the one before; without this, clusters take thousands of sweeps. (On 1,247 clusters of 6 to 85 points
//! from a frozen table this takes 1.4 million solutions of a point; with conjugate directions,
//! Silcowitz-Hansen, Niebe and Erleben 2010, The Visual Computer 26, 893, it takes 2.6 million. Newton steps on
//! the set of active points cycle among points that carry little.)
//!
//! Of many points few carry anything. Most sweeps leave the others out, and they end after one of all points that
//! changes little.
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

/// Sweeps leave points out if there are more than these ...
const FEW: usize = 16;
/// ... but for every so many.
const WHOLE: usize = 8;

/// Solves for all points of a cluster whose masses have these inverse roots; its result is the number
/// of sweeps, or `None` if they did not suffice.
pub struct Sweeps<'a> {
    pub roots: &'a [Vector3<f64>],
    pub velocities: &'a mut [Four],
    /// Room for the velocities before and after a sweep.
    pub before: &'a mut Vec<Four>,
    pub swept: &'a mut Vec<Four>,
    pub points: &'a mut [SolverPoint],
    /// Room for the numbers of the points that a sweep takes.
    pub taken: &'a mut Vec<usize>,
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
            taken,
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
        taken.clear();
        taken.extend(0..points.len());
        let is_many = points.len() > FEW;
        let mut is_whole = true;
        for sweep in 0..SWEEPS {
            for k in taken.iter() {
                points[*k].solve(velocities);
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
            let is_found = fastest * to_come * to_come < error * error;
            if is_found && is_whole {
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
                for k in taken.iter() {
                    points[*k].go_on(share, velocities);
                }
                for point in rests.iter_mut() {
                    point.go_on(share, velocities);
                }
            }
            if is_many {
                if is_whole {
                    taken.retain(|k| points[*k].carries());
                }
                is_whole = is_found || (sweep + 1) % WHOLE == 0;
                if is_whole {
                    taken.clear();
                    taken.extend(0..points.len());
                }
            }
            last = size;
            before.copy_from_slice(velocities);
        }
        None
    }
}
