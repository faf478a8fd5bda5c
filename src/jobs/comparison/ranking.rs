//! Ranks designs by a figure, and states which part of the order is proved.

use super::{Assessment, Quantity};
use ordered_float::OrderedFloat;
use physics::landscape::minimax::{self, Ordering};
use physics::order::Order;
use std::cmp::Reverse;

/// The indices of `assessments` from the best to the worst design by a figure (larger is better).
/// Designs without the figure come last (but see [`value`]); equal ones keep their order.
pub fn ranked(assessments: &[Assessment], by: &Quantity) -> Vec<usize> {
    let value = |index: usize| value(&assessments[index], by);
    let mut order: Vec<usize> = (0..assessments.len()).collect();
    order.order_by_key(|&k| (Reverse(OrderedFloat(value(k))), k));
    order
}

/// The value a design is ranked by: the figure; infinite if the figure compares the bond with a
/// trap and there is none; below all others if it is not known.
pub fn value(assessment: &Assessment, by: &Quantity) -> f64 {
    match by.of(assessment) {
        Some(estimate) => estimate.value,
        None if by.key == "selectivity" && assessment.has_no_trap() => f64::INFINITY,
        None => f64::NEG_INFINITY,
    }
}

/// The same, but designs whose tiles do not reach the bond come after all others, whatever the
/// figure: see [`Assessment::obstacle`].
pub fn ranked_for_use(assessments: &[Assessment], by: &Quantity) -> Vec<usize> {
    let mut order = ranked(assessments, by);
    order.order_by_key(|&k| assessments[k].obstacle().map_or(0, |(degree, _)| degree));
    order
}

/// Which of two designs is proved to have the higher figure: undecided if bounds overlap or are not
/// known, or if the models of the magnets differ.
///
/// The bounds are those of the saddle; the energy of the state from which the barrier is measured
/// is computed in double precision at the minimum found.
pub fn order(a: &Assessment, b: &Assessment, quantity: &Quantity) -> Ordering {
    let bounds = |assessment| {
        let estimate = quantity.of(assessment)?;
        Some((estimate.low?, estimate.high))
    };
    match (bounds(a), bounds(b)) {
        (Some(a_bounds), Some(b_bounds)) if a.model == b.model => {
            minimax::order(a_bounds, b_bounds)
        }
        _ => Ordering::Undecided,
    }
}
