//! The order of tried points, in which every failure has its place.

use super::aim::Aim;
use super::interval::FigureBounds;
use super::tried::Tried;
use crate::sweep::Outcome;
use physics::order::Order;

/// The shortfall of a design whose tiles do not reach the bond, more than of any violated
/// condition, and of one without a figure that is asked for.
const OBSTACLE: f64 = 100.0;
const NO_FIGURE: f64 = 10.0;
/// The weight of the sum of all objectives beside the least of them (Knowles 2006), and of the bond
/// among equals.
const SUM: f64 = 0.05;
const BOND: f64 = 1e-6;

/// How a point stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Standing {
    /// All conditions hold.
    Fit {
        /// Its figures.
        figures: Figures,
        /// See [`Standing::margin`].
        margin: f64,
    },
    /// A condition does not hold, or tiles do not reach the bond.
    Unfit {
        /// Its figures, if they are known nevertheless.
        figures: Option<Figures>,
        /// See [`Standing::margin`].
        margin: f64,
        /// By how much.
        shortfall: f64,
        /// Why, as a message to the designer.
        reason: String,
        /// Whether bounds prove it.
        is_proved: bool,
    },
    /// There is no such design.
    Impossible,
}

/// The figures by which points are ranked.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// Those of the objectives: more is better.
    pub gains: Vec<FigureBounds>,
    /// The depth of the bond (J), which decides between equals.
    pub depth: f64,
}

impl Standing {
    /// How a point stands.
    pub fn of(aim: &Aim, tried: &Tried) -> Self {
        let result = match (tried.known(), tried.refused) {
            (Outcome::Done { result }, _) => result,
            (Outcome::Impossible { reason }, Some(violation)) => {
                return Self::Unfit {
                    figures: None,
                    margin: -squashed(violation),
                    shortfall: squashed(violation),
                    reason: reason.clone(),
                    is_proved: true,
                };
            }
            _ => return Self::Impossible,
        };
        let (mut reasons, mut shortfall, mut is_proved) = (Vec::new(), 0.0, false);
        let mut margin: f64 = 1.0;
        if let Some((degree, reason)) = result.obstacle() {
            shortfall += OBSTACLE * f64::from(degree);
            margin = -1.0;
            is_proved |= result.bond.is_none() || result.is_caged();
            reasons.push(reason);
        }
        for condition in &aim.subject {
            let Ok(own) = condition.margin(result) else {
                shortfall += NO_FIGURE;
                margin = -1.0;
                reasons.push(format!("not {condition}"));
                continue;
            };
            margin = margin.min(squashed(own));
            if condition.violation(result) == Ok(0.0) {
                continue;
            }
            // At most 1 for each.
            shortfall += squashed(own.abs()).max(f64::MIN_POSITIVE);
            is_proved |= condition.is_proved(result) == Some(false);
            reasons.push(format!("not {condition}"));
        }
        let gains = aim.objectives.iter().map(|one| {
            let missing = |reason: &str| format!("{} is not known: {reason}", one.quantity);
            one.gain(result).map_err(missing)
        });
        let gains = gains.collect::<Result<Vec<_>, _>>();
        if let Err(reason) = &gains {
            // An obstacle has said so already.
            if reasons.is_empty() {
                reasons.push(reason.clone());
            }
            shortfall += NO_FIGURE;
            margin = -1.0;
        }
        let depth = result.bond.as_ref().map_or(0.0, |bond| -bond.energy);
        let figures = gains.ok().map(|gains| Figures { gains, depth });
        match figures {
            Some(figures) if reasons.is_empty() => Self::Fit { figures, margin },
            figures => Self::Unfit {
                figures,
                margin,
                shortfall,
                reason: reasons.join("; "),
                is_proved,
            },
        }
    }

    /// By how much the conditions hold, the least of them: from 1 for far on the right side to -1,
    /// also for a design without a figure, and one that is impossible.
    pub fn margin(&self) -> f64 {
        match self {
            Self::Fit { margin, .. } | Self::Unfit { margin, .. } => *margin,
            Self::Impossible => -1.0,
        }
    }

    /// The figures, also of a point that is not fit.
    pub fn figures(&self) -> Option<&Figures> {
        match self {
            Self::Fit { figures, .. } => Some(figures),
            Self::Unfit { figures, .. } => figures.as_ref(),
            Self::Impossible => None,
        }
    }

    /// The gains of a point that is fit.
    pub fn gains(&self) -> Option<&[FigureBounds]> {
        match self {
            Self::Fit { figures, .. } => Some(&figures.gains),
            Self::Unfit { .. } | Self::Impossible => None,
        }
    }

    /// Whether another point surpasses it: in one objective, and in no other less.
    pub fn is_surpassed_by(&self, other: &Self) -> bool {
        let (Some(own), Some(others)) = (self.gains(), other.gains()) else {
            return other.gains().is_some();
        };
        let pairs = || own.iter().zip(others);
        pairs().all(|(a, b)| b.value >= a.value) && pairs().any(|(a, b)| b.value > a.value)
    }
}

/// A number between -1 and 1.
fn squashed(value: f64) -> f64 {
    match value.is_infinite() {
        true => value.signum(),
        false => value / (1.0 + value.abs()),
    }
}

/// The share of numbers below each number, from 0 to 1.
fn shares(values: &[f64]) -> Vec<f64> {
    let most = (values.len().max(2) - 1) as f64;
    let below = |value: &f64| values.iter().filter(|other| *other < value).count() as f64;
    values.iter().map(|value| below(value) / most).collect()
}

/// A level for each point: larger is better, with these weights of the objectives. The order alone
/// determines the levels of fit points.
pub fn levels(standings: &[Standing], weights: &[f64]) -> Vec<f64> {
    let fit = standings.iter().filter_map(|one| match one {
        Standing::Fit { figures, .. } => Some(figures),
        _ => None,
    });
    let mut fit = weighted(&fit.collect::<Vec<_>>(), weights).into_iter();
    let level = |one: &Standing| match one {
        Standing::Fit { .. } => fit.next().unwrap_or_default(),
        Standing::Unfit { shortfall, .. } => -shortfall,
        Standing::Impossible => f64::NEG_INFINITY,
    };
    standings.iter().map(level).collect()
}

/// A level for each of several figures, by their order alone.
pub fn weighted(all: &[&Figures], weights: &[f64]) -> Vec<f64> {
    let of_objective =
        |k: usize| shares(&all.iter().map(|one| one.gains[k].value).collect::<Vec<_>>());
    let objectives: Vec<Vec<f64>> = (0..weights.len()).map(of_objective).collect();
    let depths = shares(&all.iter().map(|one| one.depth).collect::<Vec<_>>());
    let level = |at: usize| {
        let weighted = || {
            objectives
                .iter()
                .zip(weights)
                .map(|(all, weight)| weight * all[at])
        };
        let least = weighted().fold(f64::INFINITY, f64::min);
        least + SUM * weighted().sum::<f64>() + BOND * depths[at]
    };
    (0..all.len()).map(level).collect()
}

/// Levels as numbers for a model: the logistic quantiles of their ranks, equal ones with the mean of
/// theirs.
pub fn scores(levels: &[f64]) -> Vec<f64> {
    let count = levels.len() as f64;
    let score = |level: &f64| {
        let below = levels.iter().filter(|other| *other < level).count() as f64;
        let equal = levels.iter().filter(|other| *other == level).count() as f64;
        let share = (below + 0.5 * equal) / count;
        libm::log(share / (1.0 - share))
    };
    match levels.len() {
        ..2 => vec![0.0; levels.len()],
        _ => levels
            .iter()
            .map(score)
            .map(|score| if score.is_finite() { score } else { 0.0 })
            .collect(),
    }
}

/// The index of the first of the largest levels.
pub fn first(levels: &[f64]) -> Option<usize> {
    let mut order: Vec<usize> = (0..levels.len()).collect();
    order.order_by(|&a, &b| levels[b].total_cmp(&levels[a]));
    order.first().copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(value: f64) -> Standing {
        let gain = FigureBounds {
            value,
            low: value,
            high: value,
        };
        Standing::Fit {
            figures: Figures {
                gains: vec![gain],
                depth: 0.0,
            },
            margin: 1.0,
        }
    }

    fn unfit(shortfall: f64) -> Standing {
        Standing::Unfit {
            figures: None,
            margin: -shortfall,
            shortfall,
            reason: "a".to_owned(),
            is_proved: false,
        }
    }

    #[test]
    fn every_failure_has_its_place() {
        let all = [
            Standing::Impossible,
            fit(-5.0),
            unfit(0.2),
            fit(f64::INFINITY),
            unfit(0.1),
            fit(2.0),
        ];
        let levels = levels(&all, &[1.0]);
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|&a, &b| levels[a].total_cmp(&levels[b]));
        assert_eq!(order, [0, 2, 4, 1, 5, 3]);
        assert_eq!(first(&levels), Some(3));
        let scores = scores(&levels);
        assert!(
            order
                .windows(2)
                .all(|pair| scores[pair[0]] < scores[pair[1]])
        );
        assert!(scores.iter().all(|score| score.is_finite()));
    }

    #[test]
    fn a_point_is_surpassed_by_one_that_is_nowhere_worse() {
        assert!(fit(1.0).is_surpassed_by(&fit(2.0)));
        assert!(!fit(2.0).is_surpassed_by(&fit(2.0)));
        assert!(Standing::Impossible.is_surpassed_by(&fit(2.0)));
        assert!(!fit(2.0).is_surpassed_by(&Standing::Impossible));
    }
}
