//! Which points are proved: a race by intervals.

use super::manifest::{Search, Stage};
use super::rank::Standing;
use super::tried::Tried;
use crate::sweep::{Outcome, Plan, SweepPoint};
use physics::order::Order;

/// Number of points that are proved at the same time, after the first.
const BATCH: usize = 4;

/// Analyses contenders with proofs: first the best, then the best of those that may still be better
/// by their bounds. A point whose upper bound lies below the lower bound of a proved one is dropped.
/// With two objectives the points of the front are proved.
///
/// # Errors
/// As [`Search::run`].
pub fn race<E>(
    search: &Search,
    tried: &mut [Tried],
    work: &mut impl FnMut(&Plan, &[SweepPoint]) -> Result<Result<Vec<Outcome>, usize>, E>,
) -> Result<Result<(), usize>, E> {
    let plan = search.stage(Stage::Proofs);
    if plan.settings == search.stage(Stage::States).settings {
        return Ok(Ok(()));
    }
    let mut left = search.most_proofs();
    let mut together = if search.aim.objectives.len() == 1 {
        1
    } else {
        BATCH
    };
    while left > 0 {
        let next = contenders(search, tried, together.min(left));
        if next.is_empty() {
            break;
        }
        let point = |k: &usize| {
            let point = &tried[*k].point;
            plan.point_of(point.index, point.design, point.values.clone())
        };
        let points: Vec<SweepPoint> = next.iter().map(point).collect();
        let outcomes = match work(&plan, &points)? {
            Ok(outcomes) => outcomes,
            Err(missing) => return Ok(Err(missing)),
        };
        left -= next.len();
        for (k, outcome) in next.into_iter().zip(outcomes) {
            tried[k].proved = Some(outcome);
        }
        together = BATCH;
    }
    Ok(Ok(()))
}

/// The best points without a proof that may still be the best, at most `most`.
fn contenders(search: &Search, tried: &[Tried], most: usize) -> Vec<usize> {
    let standings = tried.iter().map(|one| Standing::of(&search.aim, one));
    let standings: Vec<Standing> = standings.collect();
    let unproved = |k: &usize| tried[*k].proved.is_none() && standings[*k].gains().is_some();
    let mut next: Vec<usize> = (0..tried.len()).filter(unproved).collect();
    if search.aim.objectives.len() > 1 {
        next.retain(|&k| {
            !standings
                .iter()
                .any(|other| standings[k].is_surpassed_by(other))
        });
        next.truncate(most);
        return next;
    }
    let lows = (0..tried.len()).filter(|&k| tried[k].proved.is_some());
    let lows = lows.filter_map(|k| Some(standings[k].gains()?[0].low));
    let bar = lows.fold(None, |bar: Option<f64>, low| {
        Some(bar.map_or(low, |bar| bar.max(low)))
    });
    let key = |k: usize| match &standings[k] {
        Standing::Fit { figures, .. } => (figures.gains[0], figures.depth),
        _ => unreachable!("only fit points are left"),
    };
    match bar {
        // Nothing bounds the figure: proofs cannot decide between points.
        Some(bar) if bar == f64::NEG_INFINITY => return Vec::new(),
        Some(bar) => next.retain(|&k| key(k).0.high >= bar),
        None => {}
    }
    next.order_by(|&a, &b| {
        let ((one, deep), (other, deeper)) = (key(a), key(b));
        other
            .value
            .total_cmp(&one.value)
            .then(deeper.total_cmp(&deep))
    });
    next.truncate(most);
    next
}
