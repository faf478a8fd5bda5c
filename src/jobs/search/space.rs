//! All designs among which a search chooses, as a lattice.

use rand::{RngExt, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;

use crate::sweep::{Axis, Plan, Value};

/// Decimal places of a range's values below its length's first.
const PLACES: f64 = 4.0;
/// A step beside the best, relative to a number's range.
const STEP: f64 = 0.05;
/// Number of Latin hypercubes of which the widest is taken.
const HYPERCUBES: usize = 24;

/// A place: the level along each dimension.
pub type GridPoint = Vec<usize>;

/// A varied key, or the choice among designs.
#[derive(Clone, Debug, PartialEq)]
pub struct Dimension {
    /// The index of its axis in the plan; `None` for the design.
    pub axis: Option<usize>,
    /// Number of different values.
    pub levels: usize,
    /// Whether neighbouring levels are neighbouring numbers.
    pub is_ordered: bool,
    /// The ends of a range, and the step of its levels.
    range: Option<[f64; 3]>,
}

impl Dimension {
    fn of(index: usize, axis: &Axis) -> Self {
        let numbers = axis
            .numbers()
            .filter(|all| all.is_sorted() && all.len() > 1);
        let range = numbers.clone().filter(|_| axis.is_range).map(|ends| {
            let length = ends[1] - ends[0];
            let step = libm::pow(10.0, libm::floor(libm::log10(length)) - PLACES);
            [ends[0], ends[1], step]
        });
        let levels = range.map_or(axis.values.len(), |[from, to, step]| {
            ((to - from) / step - 1e-6).ceil() as usize + 1
        });
        Self {
            axis: Some(index),
            levels,
            is_ordered: numbers.is_some(),
            range,
        }
    }

    fn value(&self, axis: &Axis, level: usize) -> Value {
        match self.range {
            Some([_, to, _]) if level + 1 == self.levels => Value::Number(to),
            Some([from, _, step]) => {
                Value::Number(crate::sweep::rounded(from + level as f64 * step))
            }
            None => axis.values[level].clone(),
        }
    }

    /// A level as a number from 0 to 1.
    pub fn share(&self, level: usize) -> f64 {
        level as f64 / (self.levels - 1).max(1) as f64
    }

    /// The level at a number from 0 to 1.
    fn level(&self, share: f64) -> usize {
        ((share * self.levels as f64) as usize).min(self.levels - 1)
    }
}

/// The designs of a plan whose axes may be ranges.
#[derive(Clone, Debug)]
pub struct Space {
    /// The design first, if there are several; then the plan's axes of more than one value.
    pub dimensions: Vec<Dimension>,
}

impl Space {
    /// The space of a plan.
    pub fn of(plan: &Plan) -> Self {
        let designs = Dimension {
            axis: None,
            levels: plan.designs.len(),
            is_ordered: false,
            range: None,
        };
        let axes = plan.axes.iter().enumerate();
        let axes = axes.map(|(index, axis)| Dimension::of(index, axis));
        let all = [designs].into_iter().chain(axes);
        Self {
            dimensions: all.filter(|one| one.levels > 1).collect(),
        }
    }

    /// The design and the values of all axes at a place.
    pub fn values(&self, plan: &Plan, place: &GridPoint) -> (usize, Vec<Value>) {
        let mut values: Vec<Value> = plan
            .axes
            .iter()
            .map(|axis| axis.values[0].clone())
            .collect();
        let mut design = 0;
        for (dimension, &level) in self.dimensions.iter().zip(place) {
            match dimension.axis {
                Some(axis) => values[axis] = dimension.value(&plan.axes[axis], level),
                None => design = level,
            }
        }
        (design, values)
    }

    /// The number of places; the largest number if there are more.
    pub fn count(&self) -> usize {
        let levels = self.dimensions.iter().map(|one| one.levels);
        levels.fold(1, usize::saturating_mul)
    }

    /// All places, in order.
    pub fn all(&self) -> Vec<GridPoint> {
        self.dimensions
            .iter()
            .fold(vec![Vec::new()], |places, one| {
                let longer = |place: &GridPoint| {
                    let place = place.clone();
                    (0..one.levels).map(move |level| [&place[..], &[level]].concat())
                };
                places.iter().flat_map(longer).collect()
            })
    }

    /// The squared distance of two places: along numbers relative to their whole range, 1 between
    /// different words.
    pub fn differences<'a>(
        &'a self,
        a: &'a GridPoint,
        b: &'a GridPoint,
    ) -> impl Iterator<Item = f64> + 'a {
        let all = self.dimensions.iter().zip(a.iter().zip(b));
        all.map(|(one, (&a, &b))| match one.is_ordered {
            true => {
                let step = one.share(a) - one.share(b);
                step * step
            }
            false => f64::from(u8::from(a != b)),
        })
    }

    /// Places spread over the space: along each dimension in as many equal parts, one in each.
    pub fn spread(&self, count: usize, random: &mut ChaCha8Rng) -> Vec<GridPoint> {
        let cube = |random: &mut ChaCha8Rng| {
            let columns = self.dimensions.iter().map(|dimension| {
                let mut parts: Vec<usize> = (0..count).collect();
                parts.shuffle(random);
                let mut within =
                    |part: usize| (part as f64 + random.random::<f64>()) / count as f64;
                parts
                    .iter()
                    .map(|&part| dimension.level(within(part)))
                    .collect()
            });
            let columns: Vec<Vec<usize>> = columns.collect();
            (0..count)
                .map(|k| columns.iter().map(|column| column[k]).collect())
                .collect::<Vec<GridPoint>>()
        };
        let narrowest = |places: &[GridPoint]| {
            let pairs = places.iter().enumerate();
            let pairs = pairs.flat_map(|(k, a)| places[..k].iter().map(move |b| (a, b)));
            let distances = pairs.map(|(a, b)| self.differences(a, b).sum::<f64>());
            distances.fold(f64::INFINITY, f64::min)
        };
        let mut best = cube(random);
        let mut width = narrowest(&best);
        for _ in 1..HYPERCUBES {
            let other = cube(random);
            let its = narrowest(&other);
            if its > width {
                (best, width) = (other, its);
            }
        }
        best
    }

    /// A place anywhere.
    pub fn anywhere(&self, random: &mut ChaCha8Rng) -> GridPoint {
        let levels = self.dimensions.iter();
        levels
            .map(|one| random.random_range(0..one.levels))
            .collect()
    }

    /// A place within `reach` of the range of each number; along a word another one now and then.
    pub fn near(&self, place: &GridPoint, reach: f64, random: &mut ChaCha8Rng) -> GridPoint {
        let levels = self.dimensions.iter().zip(place);
        levels
            .map(|(one, &level)| {
                let chance: f64 = random.random();
                let step = reach * (2.0 * random.random::<f64>() - 1.0);
                match one.is_ordered {
                    // Half the numbers stay, so that single keys are moved as well.
                    _ if chance < 0.4 => level,
                    true => {
                        let most = (one.levels - 1) as f64;
                        let step = step * most;
                        // At least to the next level.
                        let step = if step.abs() < 1.0 {
                            step.signum()
                        } else {
                            step.round()
                        };
                        (level as f64 + step).clamp(0.0, most) as usize
                    }
                    false if chance > 0.9 => random.random_range(0..one.levels),
                    false => level,
                }
            })
            .collect()
    }

    /// The dimensions whose levels are numbers in order.
    pub fn numbers(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        (0..self.dimensions.len()).filter(|&k| self.dimensions[k].is_ordered)
    }

    /// Every two of them.
    pub fn pairs(&self) -> Vec<[usize; 2]> {
        let second = |j: usize| self.numbers().filter(move |&k| k > j);
        self.numbers()
            .flat_map(|j| second(j).map(move |k| [j, k]))
            .collect()
    }

    /// A step along a dimension: a twentieth of its range, at least one level.
    pub fn step(&self, dimension: usize) -> usize {
        let most = self.dimensions[dimension].levels - 1;
        ((STEP * most as f64).round() as usize).max(1)
    }

    /// The places one step beside a place along these dimensions at once, to all combinations of sides
    /// that are within the ranges.
    pub fn beside(&self, place: &GridPoint, dimensions: &[usize]) -> Vec<GridPoint> {
        let both_ways = |places: Vec<GridPoint>, &k: &usize| {
            let most = self.dimensions[k].levels - 1;
            let step = self.step(k);
            let moved = |one: &GridPoint| {
                let sides = [one[k].checked_sub(step), Some(one[k] + step)];
                let levels = sides.into_iter().flatten().filter(|to| *to <= most);
                let moved = levels.map(|level| {
                    let mut beside = one.clone();
                    beside[k] = level;
                    beside
                });
                moved.collect::<Vec<_>>()
            };
            places.iter().flat_map(moved).collect()
        };
        dimensions.iter().fold(vec![place.clone()], both_ways)
    }
}
