//! The order in which barriers are certified, and how narrow their bounds become.

use std::cmp::Reverse;

use super::CertificationSettings;
use crate::catalogue::Catalogue;
use crate::results::{Barrier, Place};

/// Bounds are first narrowed to this fraction of the bond's depth.
const FIRST: f64 = 0.01;
/// If no width is requested, bounds are narrowed to this fraction of the barrier, but not below
/// this fraction of the bond's depth.
const SHARE_OF_BARRIER: f64 = 0.05;
const LEAST_SHARE: f64 = 1e-5;
/// Cells spent on narrowing a barrier's bounds beyond the first width, if no width is requested.
const MORE_CELLS: usize = 20_000;
/// Traps whose barriers come first: the deepest, and those that capture most.
const FOREMOST: usize = 4;

/// The widths (J) to which bounds are narrowed in turn: from a hundredth of `depth` (J) down, each
/// half the last, until one is at most `wanted` (J).
///
/// Only the last one depends on the requested width: the work for a narrow bracket begins with all
/// the work for a wide one, so that the narrow one is never worse.
pub fn widths(depth: f64, wanted: f64) -> impl Iterator<Item = f64> {
    let halved = move |width: &f64| (*width > wanted).then_some(width / 2.0);
    std::iter::successors(Some(FIRST * depth), halved)
}

/// Rounds of certification: a width (J), and the indices of the barriers to narrow to it, unless a
/// narrower one is requested for them.
///
/// Barriers that a summary lists come before the others: those of the bond, of the deepest trap and
/// of the traps that capture most. If a width is requested, all barriers are narrowed to each width
/// before any to the next; otherwise the foremost are narrowed as far as worthwhile before the
/// others.
pub fn rounds(
    catalogue: &Catalogue,
    settings: &CertificationSettings,
    depth: f64,
) -> Vec<(f64, Vec<usize>)> {
    let [first, rest] = by_rank(catalogue, settings);
    if let Some(wanted) = settings.tolerance {
        let all = [first, rest].concat();
        return widths(depth, wanted)
            .map(|width| (width, all.clone()))
            .collect();
    }
    let group = |group: Vec<usize>| [(FIRST * depth, group.clone()), (0.0, group)];
    [group(first), group(rest)].concat()
}

/// The numbers of the barriers that are to be certified: those that a summary lists, and the others.
fn by_rank(catalogue: &Catalogue, settings: &CertificationSettings) -> [Vec<usize>; 2] {
    let mut ranked: Vec<(Reverse<usize>, usize)> = catalogue
        .kinds()
        .filter(|kind| !kind.is_bond())
        .map(|kind| (Reverse(kind.captured().count), kind.first().class))
        .collect();
    // The deepest trap stands first in the catalogue.
    let deepest = ranked.first().map(|trap| trap.1);
    ranked.sort();
    let foremost = ranked.iter().take(FOREMOST).map(|trap| trap.1);
    let foremost: Vec<usize> = foremost
        .chain(deepest)
        .chain(catalogue.bound_state)
        .collect();
    let is_foremost = |barrier: &Barrier| match barrier.from {
        Place::State(id) => foremost.contains(&catalogue.states[id].class),
        Place::Free => false,
    };
    let claimed = catalogue.barriers.iter().enumerate();
    let claimed = claimed.filter(|(_, barrier)| settings.claims.include(barrier, catalogue));
    let (first, rest): (Vec<_>, Vec<_>) = claimed.partition(|(_, barrier)| is_foremost(barrier));
    [first, rest].map(|group| group.into_iter().map(|(number, _)| number).collect())
}

/// The target width (J) of a barrier's bounds, such that it is also meaningful for a barrier much
/// smaller than the bond.
pub fn wanted(barrier: &Barrier, settings: &CertificationSettings, depth: f64) -> f64 {
    settings.tolerance.unwrap_or_else(|| {
        let of_barrier = (SHARE_OF_BARRIER * barrier.forward()).max(LEAST_SHARE * depth);
        of_barrier.min(FIRST * depth)
    })
}

/// The width (J) of the next bracket of a barrier for which `wanted` (J) is requested: a step of
/// the sequence if one width is requested for all.
pub fn step(width: f64, wanted: f64, settings: &CertificationSettings) -> f64 {
    match settings.tolerance {
        Some(_) => width,
        None => width.max(wanted),
    }
}

/// Cells left for a barrier after a step: none where the width was not reached.
pub fn cells_left(left: usize, reached: bool, settings: &CertificationSettings) -> usize {
    match settings.tolerance {
        _ if !reached => 0,
        Some(_) => left,
        None => left.min(MORE_CELLS),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_bracket_begins_with_the_steps_of_a_wide_one() {
        let [wide, narrow] = [4e-3, 1e-5].map(|wanted| widths(2.0, wanted).collect::<Vec<f64>>());
        assert_eq!(wide, [2e-2, 1e-2, 5e-3, 2.5e-3]);
        assert_eq!(narrow[..wide.len()], wide);
        assert!(
            narrow
                .last()
                .is_some_and(|width| (5e-6..=1e-5).contains(width))
        );
    }
    #[test]
    fn a_width_that_is_reached_is_the_last() {
        let exactly: Vec<f64> = widths(2.0, 5e-3).collect();
        assert_eq!(exactly, [2e-2, 1e-2, 5e-3]);
        assert_eq!(widths(2.0, 1.0).collect::<Vec<f64>>(), [2e-2]);
    }

    fn settings(tolerance: Option<f64>) -> CertificationSettings {
        CertificationSettings {
            tolerance,
            allowed: tiles::budget::Allowance::UNLIMITED,
            cells: 1_000_000,
            claims: crate::barrier_bounds::Claims::All,
        }
    }

    /// A twentieth of the barrier, between a hundred-thousandth and a hundredth of the depth.
    #[test]
    fn small_barriers_are_wanted_narrower() {
        let start = tiles::Configuration::new(0.0, 0.0, 0.0);
        let wanted = |height: f64, tolerance: Option<f64>| {
            let ends = (Place::State(0), -2.0);
            let barrier = Barrier {
                saddle_energy: -2.0 + height,
                ..Barrier::without_a_way(ends, start, (Place::Free, 0.0))
            };
            wanted(&barrier, &settings(tolerance), 2.0)
        };
        let close = |found: f64, width: f64| assert!((found / width - 1.0).abs() < 1e-9, "{found}");
        close(wanted(2.0, None), 0.02);
        close(wanted(0.1, None), 0.005);
        close(wanted(1e-5, None), 2e-5);
        close(wanted(0.1, Some(0.3)), 0.3);
    }

    #[test]
    fn cells_are_left_only_where_a_width_was_reached() {
        let left = |reached, tolerance| cells_left(50_000, reached, &settings(tolerance));
        assert_eq!(left(false, None), 0);
        assert_eq!(left(false, Some(1e-3)), 0);
        assert_eq!(left(true, Some(1e-3)), 50_000);
        assert_eq!(left(true, None), MORE_CELLS);
    }
}
