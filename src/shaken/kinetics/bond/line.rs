//! Integrals over the gap alone, along one line of configurations.

use super::frame::Frame;
use tiles::bisection::bisected;
use tiles::interruption;
use tiles::problem::Problem;

/// Abscissas and weights of the seven-point Gauss rule on [-1, 1] (Abramowitz and Stegun, table
/// 25.4); the eighth energy of a batch is that at the panel's end.
const GAUSS: [(f64, f64); 7] = [
    (-0.949_107_912_342_758_5, 0.129_484_966_168_869_7),
    (-0.741_531_185_599_394_5, 0.279_705_391_489_276_6),
    (-0.405_845_151_377_397_2, 0.381_830_050_505_118_9),
    (0.0, 0.417_959_183_673_469_4),
    (0.405_845_151_377_397_2, 0.381_830_050_505_118_9),
    (0.741_531_185_599_394_5, 0.279_705_391_489_276_6),
    (0.949_107_912_342_758_5, 0.129_484_966_168_869_7),
];
/// Largest change of the exponent over a panel: the error of seven points is then below 1e-7.
const RANGE: f64 = 4.0;
/// Largest number of bisections of a panel.
const DEEPEST: u32 = 12;
/// Beyond this exponent a weight counts as 0.
const NOTHING: f64 = 60.0;
/// Number of bisections for the end of the basin.
const BISECTIONS: u32 = 14;
/// Parts with less than this share of a line are omitted.
const LEAST: f64 = 1e-7;
/// Shortest first panel, as a share of the longest line.
const SHORTEST: f64 = 1e-7;
/// Number of gaps sampled for the lowest energy on a line, each twice the previous one.
const LOOKS: usize = 14;

/// The integrand: `exp(-(U - lowest) / kT)` where U is below `level` (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    /// U at which the weight is 1 (J).
    pub lowest: f64,
    /// The upper limit of the basin (J).
    pub level: f64,
    /// kT (J).
    pub kt: f64,
}

impl Weight {
    /// The weight of an energy (J), ignoring the level.
    fn at(&self, energy: f64) -> f64 {
        libm::exp(-(energy - self.lowest) / self.kt)
    }
}

/// Lines of configurations along which the gap opens.
pub struct Lines<'a> {
    pub problem: &'a Problem,
    pub frame: Frame,
    /// Largest gap considered, and the distance below the state's gap (m).
    pub reach: f64,
}

impl Lines<'_> {
    /// The intervals of the gap (m) in which the tiles do not overlap, in ascending order.
    pub fn free(&self, at: [f64; 2]) -> Vec<[f64; 2]> {
        interruption::check();
        let range = [-self.reach, self.reach];
        match &self.problem.contact {
            None => vec![range],
            Some(contact) => {
                let level = self.frame.configuration(at, 0.0);
                contact.free_translations(&level, self.frame.normal(), range)
            }
        }
    }

    /// The lowest energy (J) of an interval, from a few samples.
    pub fn lowest(&self, at: [f64; 2], [start, end]: [f64; 2]) -> f64 {
        let length = end - start;
        let share = |k: usize| match k {
            0 => 0.0,
            _ => 0.5f64.powi((LOOKS - 1 - k) as i32),
        };
        let looks: [f64; LOOKS] = std::array::from_fn(|k| start + length * share(k));
        self.energies(at, looks)
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }

    fn energies<const N: usize>(&self, at: [f64; 2], gaps: [f64; N]) -> [f64; N] {
        let poses = gaps.map(|gap| self.frame.configuration(at, gap));
        let mut energies = [0.0; N];
        self.problem.potential().energies(&poses, &mut energies);
        energies
    }

    /// The integral (m) of the weight over the part of an interval within the basin.
    pub fn integral(&self, at: [f64; 2], [start, end]: [f64; 2], weight: &Weight) -> f64 {
        let q = self.frame.configuration(at, start);
        let (energy, gradient) = self.problem.potential().energy_and_gradient(&q);
        let slope = gradient.xy().dot(&self.frame.normal()).abs();
        let decay = if slope > 0.0 {
            weight.kt / slope
        } else {
            self.reach
        };
        let longest = self.reach / 16.0;
        let mut length = decay.clamp(SHORTEST * self.reach, longest);
        let is_inside = |gap: f64| self.energies(at, [gap])[0] < weight.level;
        let (mut low, mut before, mut sum) = (start, energy, 0.0);
        while low < end {
            let high = (low + length).min(end);
            let whole = self.panel(at, [low, high], weight, 0);
            let (was_inside, inside) = (before < weight.level, whole.end < weight.level);
            if was_inside && inside {
                sum += whole.sum;
            } else if was_inside != inside && weight.at(weight.level) * length > LEAST * sum {
                let is_as_before = |gap: f64| is_inside(gap) == was_inside;
                let [last, next] = bisected(low, high, BISECTIONS, is_as_before);
                let edge = (last + next) / 2.0;
                let part = if inside { [edge, high] } else { [low, edge] };
                sum += self.panel(at, part, weight, 0).sum;
            } else if was_inside || inside {
                sum += whole.sum;
            }
            let falls = whole.end > before && weight.at(whole.end) * self.reach < LEAST * sum;
            if falls || (was_inside && !inside) {
                break;
            }
            (low, before) = (high, whole.end);
            length = (2.0 * length).min(longest);
        }
        sum
    }

    /// Gauss quadrature over a panel, bisected if the exponent changes too much.
    fn panel(&self, at: [f64; 2], [low, high]: [f64; 2], weight: &Weight, depth: u32) -> Panel {
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let gaps: [f64; 8] =
            std::array::from_fn(|k| GAUSS.get(k).map_or(high, |point| middle + half * point.0));
        let energies = self.energies(at, gaps);
        let least = energies.into_iter().fold(f64::INFINITY, f64::min);
        let most = energies.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let is_nothing = (least - weight.lowest) / weight.kt > NOTHING;
        if !is_nothing && most - least > RANGE * weight.kt && depth < DEEPEST {
            let parts = [[low, middle], [middle, high]];
            let [a, b] = parts.map(|part| self.panel(at, part, weight, depth + 1));
            return Panel {
                sum: a.sum + b.sum,
                ..b
            };
        }
        let terms = GAUSS.iter().zip(energies);
        let sum: f64 = terms.map(|(point, u)| point.1 * weight.at(u)).sum();
        Panel {
            sum: half * sum,
            end: energies[7],
        }
    }
}

struct Panel {
    /// The integral (m).
    sum: f64,
    /// U at its end (J).
    end: f64,
}
