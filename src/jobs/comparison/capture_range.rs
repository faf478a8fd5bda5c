//! The capture range: how far from the bond the way into it still leads downhill.
//!
//! Three straight lines of starts are tried. In all of them the moving tile's target face is in
//! front of the fixed tile's and moved straight towards it until the tiles touch:
//!
//! - *offset*: slid along the target face to either side (m), in contact, not tilted;
//! - *gap*: drawn straight back from contact (m), neither slid nor tilted;
//! - *tilt*: turned about the middle of the moving tile's target face to either side (rad), in
//!   contact, not slid.
//!
//! A start is captured if overdamped motion from it (`v = -M^-1 grad U`, sliding along contact,
//! without friction) ends in a minimum that lies within [`SAME_BOND`] of the bound state and at
//! most [`ENERGY_SHARE`] of the bond's depth above its energy. The range along a line is the
//! largest amount up to which every tried start is captured. Starts are tried in [`STEPS`] equal
//! steps from 0 to the line's limit; between the last captured start and the first that is not,
//! [`HALVINGS`] bisections follow. A region narrower than a step in which the tile is not captured
//! can be missed. Limits: half the face's length, the distance at which the tiles are free of each
//! other, and half a turn; a range may reach its limit.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use physics::bisection::bisected;
use physics::configuration::Configuration;
use physics::landscape::approach::Approach;
use physics::landscape::minimum::{Known, Outcome, learn};
use physics::parallel;
use physics::problem::Problem;

/// Number of equal steps along a line of starts.
pub const STEPS: u32 = 48;
/// Number of bisections of the step in which capture ends.
pub const HALVINGS: u32 = 6;
/// Largest distance from the bound state that still counts as the bond (m, metric of the
/// configuration space; stated for the paper's tile and scaled for others).
pub const SAME_BOND: f64 = 5e-3;
/// Energy above that of the bound state that still counts as the bond, as a fraction of its depth.
pub const ENERGY_SHARE: f64 = 1e-3;

/// The largest offset, gap and tilt from which the way into the bond is downhill.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaptureRange {
    /// To either side along the target face (m): at most 0, at least 0. Along the face means
    /// counter-clockwise around the fixed tile.
    #[serde(rename = "offset_m")]
    pub offset: [f64; 2],
    /// Away from contact (m).
    #[serde(rename = "gap_m")]
    pub gap: f64,
    /// To either side (rad): at most 0, at least 0. Positive is counter-clockwise.
    #[serde(rename = "tilt_rad")]
    pub tilt: [f64; 2],
    /// The largest offset, gap (m) and tilt (rad) that were tried: a range that ends here may
    /// extend farther.
    pub limits: [f64; 3],
}

/// The capture range of the bound state at `bond` with its energy (J); `known` are known ends of
/// motions. `None` if not even an aligned tile is captured.
///
/// Starts of a line are close together: most of them reach the path of an earlier one, and need not
/// be followed from there on.
pub fn find(
    problem: &Problem,
    mut known: Known,
    bond: &Configuration,
    energy: f64,
) -> Option<CaptureRange> {
    let pair = problem.pair.as_deref()?;
    let approach = Approach::new(pair);
    let captured = |known: &mut Known, tilt: f64, offset: f64, gap: f64| {
        let start = approach.before_contact(problem, tilt, offset, gap);
        start.is_some_and(|start| is_captured(problem, known, &start, bond, energy))
    };
    if !captured(&mut known, 0.0, 0.0, 0.0) {
        return None;
    }
    let length = pair.target_face().length();
    let farthest = problem.space.free_distance - pair.bound.position().norm();
    // Tilt, offset and gap at the end of each line.
    let ends = [
        [0.0, -length / 2.0, 0.0],
        [0.0, length / 2.0, 0.0],
        [0.0, 0.0, farthest.max(0.0)],
        [-PI, 0.0, 0.0],
        [PI, 0.0, 0.0],
    ];
    // Each line keeps its own known ends, so that the order of computation does not matter.
    let shares: Vec<f64> = parallel::map(&ends[..], |[tilt, offset, gap]| {
        let mut known = known.clone();
        reach(|share| captured(&mut known, share * tilt, share * offset, share * gap))
    });
    let amount = |line: usize| shares[line] * ends[line].iter().sum::<f64>();
    Some(CaptureRange {
        offset: [amount(0), amount(1)],
        gap: amount(2),
        tilt: [amount(3), amount(4)],
        limits: [ends[1][1], ends[2][2], ends[4][0]],
    })
}

fn is_captured(
    problem: &Problem,
    known: &mut Known,
    start: &Configuration,
    bond: &Configuration,
    energy: f64,
) -> bool {
    if !problem.is_free(start) {
        return false;
    }
    match learn(problem, &[*start], known, &|_| ()).pop() {
        Some(Outcome::Minimum(end)) => {
            problem.space.distance(&end.point.q, bond) < problem.scaled(SAME_BOND)
                && end.point.energy <= energy + ENERGY_SHARE * energy.abs()
        }
        _ => false,
    }
}

/// The largest share of a line, 0 to 1, up to which every trial holds.
fn reach(mut holds: impl FnMut(f64) -> bool) -> f64 {
    let at = |step: f64| step / f64::from(STEPS);
    let first_miss = (1..=STEPS).find(|&step| !holds(at(step.into())));
    let Some(miss) = first_miss else {
        return 1.0;
    };
    let [inside, _] = bisected(at(f64::from(miss) - 1.0), at(miss.into()), HALVINGS, holds);
    inside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;

    #[test]
    fn a_reach_ends_where_holding_ends() {
        let resolution = 1.0 / f64::from(STEPS) / f64::from(1 << HALVINGS);
        for end in [0.001, 0.3, 0.777, 0.999] {
            let found = reach(|share| share <= end);
            assert!(found <= end && end - found <= resolution, "{end}: {found}");
        }
        assert_eq!(reach(|_| true), 1.0);
        assert_eq!(reach(|_| false), 0.0);
        // Captured starts beyond a gap do not count.
        assert!(reach(|share| !(0.2..0.4).contains(&share)) < 0.2);
    }

    #[test]
    fn every_start_within_the_range_of_the_paper_tile_binds_and_one_beyond_does_not() {
        let design = Design::load("../../shapes/paper-tile.toml".as_ref()).unwrap();
        let problem = design.problem();
        let energy = problem.energy(&design.pair.bound);
        let range = find(&problem, Known::default(), &design.pair.bound, energy).unwrap();
        // The barrier between the bond and the state slid by one magnet lies between them.
        assert!(
            range.offset[1] > 0.005 && range.offset[1] < 0.040,
            "{range:?}"
        );
        // Flush against the face, the magnets are symmetric on both sides of the tile.
        assert!(
            (range.offset[0] + range.offset[1]).abs() < 0.004,
            "{range:?}"
        );
        assert!(range.gap > 0.010, "{range:?}");
        assert!(range.tilt[0] < -0.05 && range.tilt[1] > 0.05, "{range:?}");
        let slid = |offset: f64| {
            let start = Configuration::new(0.43, offset, 0.0);
            is_captured(
                &problem,
                &mut Known::default(),
                &start,
                &design.pair.bound,
                energy,
            )
        };
        assert!(slid(0.5 * range.offset[1]) && slid(0.98 * range.offset[1]));
        assert!(!slid(range.offset[1] + 0.0005));
    }
    /// Known ends of earlier starts save work and change no result.
    #[test]
    fn what_earlier_starts_teach_leaves_the_range_as_it_is() {
        let design = Design::load("../../shapes/sine-teeth-10mm.toml".as_ref()).unwrap();
        let problem = design.problem();
        let bond = &design.pair.bound;
        let energy = problem.energy(bond);
        let range = find(&problem, Known::default(), bond, energy).unwrap();
        let approach = Approach::new(problem.pair.as_deref().unwrap());
        let end = range.limits[0];
        let alone = reach(|share| {
            let start = approach.before_contact(&problem, 0.0, share * end, 0.0);
            let nothing = &mut Known::default();
            start.is_some_and(|start| is_captured(&problem, nothing, &start, bond, energy))
        });
        let resolution = 1.0 / f64::from(STEPS) / f64::from(1 << HALVINGS);
        let found = range.offset[1] / end;
        assert!((found - alone).abs() <= resolution, "{found} {alone}");
    }
}
