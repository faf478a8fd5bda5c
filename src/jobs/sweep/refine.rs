//! Adds points where the curves of a sweep bend most.

use ordered_float::OrderedFloat;

use super::plan::Plan;
use super::store::Outcome;
use super::vary::{Value, rounded};
use crate::comparison::Assessment;
use crate::comparison::quantity::{Measure, QUANTITIES};
use physics::order::Order;

/// The figures considered.
const FIGURES: [&str; 5] = [
    "bond_depth",
    "trap_depth",
    "selectivity",
    "unbinding",
    "captured",
];
/// A figure counts as straight if it bends by less than this, relative to its total change: the
/// statistical error of shares is about a twentieth.
const STRAIGHT: f64 = 0.05;
/// Smallest step relative to the whole range.
const FINEST: f64 = 1.0 / 512.0;

/// The plan with at most `more` values added to its only numerical axis, midway between the values
/// where the figures bend most. `None` if nothing bends, or if there is not exactly one such axis.
pub(super) fn refined(plan: &Plan, outcomes: &[Outcome], more: usize) -> Option<Plan> {
    let varied = |k: &usize| plan.axes[*k].numbers().is_some_and(|all| all.len() > 1);
    let mut varied = (0..plan.axes.len()).filter(varied);
    let (Some(which), None) = (varied.next(), varied.next()) else {
        return None;
    };
    let axis = &plan.axes[which];
    let numbers = axis.numbers()?;
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    order.order_by_key(|&k| OrderedFloat(numbers[k]));
    let x: Vec<f64> = order.iter().map(|&k| numbers[k]).collect();

    let scores = scores(plan, outcomes, which, &order, &x);
    let least = FINEST * (x[x.len() - 1] - x[0]);
    let mut wanted: Vec<usize> = (0..x.len() - 1)
        .filter(|&k| scores[k] > STRAIGHT && x[k + 1] - x[k] > 2.0 * least)
        .collect();
    wanted.order_by_key(|&k| std::cmp::Reverse(OrderedFloat(scores[k])));
    let whole = axis.values.iter().all(|v| matches!(v, Value::Whole(_)));
    let between = wanted.into_iter().filter_map(|k| {
        let middle = rounded((x[k] + x[k + 1]) / 2.0);
        match whole {
            true => Some(middle.floor())
                .filter(|middle| *middle > x[k])
                .map(|middle| Value::Whole(middle as i64)),
            false => Some(Value::Number(middle)),
        }
    });
    let added: Vec<Value> = between.take(more).collect();
    if added.is_empty() {
        return None;
    }
    let mut finer = plan.clone();
    let values = &mut finer.axes[which].values;
    values.extend(added);
    values.order_by_key(|value| value.number().map(OrderedFloat));
    Some(finer)
}

/// The largest bend of the figures at the ends of each step of the axis, relative to their total
/// change in the sweep.
fn scores(plan: &Plan, outcomes: &[Outcome], which: usize, order: &[usize], x: &[f64]) -> Vec<f64> {
    let lengths: Vec<usize> = plan.axes.iter().map(|axis| axis.values.len()).collect();
    let stride: usize = lengths[which + 1..].iter().product();
    let length = lengths[which];
    // Points that differ only in the axis.
    let firsts = (0..outcomes.len()).filter(|index| (index / stride).is_multiple_of(length));
    let series: Vec<Vec<&Outcome>> = firsts
        .map(|first| {
            order
                .iter()
                .map(|k| &outcomes[first + k * stride])
                .collect()
        })
        .collect();
    let mut scores = vec![0.0; x.len() - 1];
    for quantity in QUANTITIES.iter().filter(|one| FIGURES.contains(&one.key)) {
        let value = |outcome: &&Outcome| -> Option<f64> {
            let assessment: &Assessment = match outcome {
                Outcome::Done { result } => result,
                Outcome::Impossible { .. } | Outcome::Failed { .. } => return None,
            };
            let value = quantity.of(assessment)?.value;
            let value = match quantity.measure {
                Measure::Ratio => libm::log10(value),
                _ => value,
            };
            value.is_finite().then_some(value)
        };
        let curves: Vec<Vec<Option<f64>>> = series
            .iter()
            .map(|points| points.iter().map(value).collect())
            .collect();
        let known = || curves.iter().flatten().flatten().copied();
        let [low, high] = [
            known().fold(f64::INFINITY, f64::min),
            known().fold(f64::NEG_INFINITY, f64::max),
        ];
        let spread = high - low;
        // Without two known values there is no spread.
        if spread.is_nan() || spread <= 1e-3 * low.abs().max(high.abs()) {
            continue;
        }
        for curve in &curves {
            for k in 1..x.len() - 1 {
                let (Some(before), Some(here), Some(after)) =
                    (curve[k - 1], curve[k], curve[k + 1])
                else {
                    continue;
                };
                let share = (x[k] - x[k - 1]) / (x[k + 1] - x[k - 1]);
                let bend = (here - before - share * (after - before)).abs() / spread;
                for step in [k - 1, k] {
                    scores[step] = f64::max(scores[step], bend);
                }
            }
        }
    }
    scores
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::{Bond, Thoroughness, WayOut};

    /// A sweep over depth, with the bond's depth as a given function of it.
    fn plan(values: &str, depth: impl Fn(f64) -> f64) -> (Plan, Vec<Outcome>) {
        let plan = Plan {
            tilebind: String::new(),
            designs: Vec::new(),
            axes: vec![format!("a.depth={values}").parse().unwrap()],
            settings: Thoroughness::default(),
            seed: 1,
            baseline: None,
        };
        let numbers = plan.axes[0].numbers().unwrap();
        let done = |x: f64| Outcome::Done {
            result: Box::new(Assessment {
                bond: Some(Bond {
                    pose: [0.0; 3],
                    energy: -depth(x),
                    way_out: WayOut::default(),
                    capture_range: None,
                }),
                ..Assessment::default()
            }),
        };
        let outcomes = numbers.into_iter().map(done).collect();
        (plan, outcomes)
    }

    #[test]
    fn points_are_added_beside_a_bend() {
        // There is nothing between adjacent whole numbers.
        let (coarse, outcomes) = plan("0:4:5", |x| (x - 2.0).abs() + 1.0);
        assert_eq!(refined(&coarse, &outcomes, 2), None);
        let (coarse, outcomes) = plan("0.0,1.0,2.0,3.0,4.0", |x| (x - 2.0).abs() + 1.0);
        let finer = refined(&coarse, &outcomes, 2).unwrap();
        let added = [0.0, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0];
        assert_eq!(finer.axes[0].numbers().unwrap(), added);
    }

    #[test]
    fn straight_lines_need_no_more() {
        let (coarse, outcomes) = plan("0.0,1.0,3.0,4.0", |x| 2.0 + 0.5 * x);
        assert_eq!(refined(&coarse, &outcomes, 5), None);
        let (coarse, outcomes) = plan("0.0,1.0,2.0", |_| 2.0);
        assert_eq!(refined(&coarse, &outcomes, 5), None);
    }

    #[test]
    fn whole_numbers_stay_whole() {
        let (coarse, outcomes) = plan("0,1,4,8", |x| (x - 4.0).abs() + 1.0);
        let finer = refined(&coarse, &outcomes, 2).unwrap();
        let whole = |v: &Value| matches!(v, Value::Whole(_));
        assert!(finer.axes[0].values.iter().all(whole));
    }
}
