//! Integrals over the gap alone: one line of configurations at a time.

use super::frame::Frame;
use crate::interruption;
use crate::problem::Problem;

/// Abscissas and weights of Gauss' rule of eight points on [-1, 1] (Abramowitz and Stegun, table
/// 25.4).
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];
const POINTS: usize = 8;
/// The exponent may change by this much over a panel: eight points then err by less than 1e-9.
const RANGE: f64 = 5.0;
/// Panels are halved so often at most.
const DEEPEST: u32 = 12;
/// Beyond this exponent a weight is nothing.
const NOTHING: f64 = 60.0;
/// Halvings by which the end of the basin is found.
const BISECTIONS: usize = 24;
/// Shortest first panel, as a share of the longest line.
const SHORTEST: f64 = 1e-7;
/// Gaps looked at for the lowest energy on a line, each double the one before.
const LOOKS: usize = 14;

/// What is integrated: `exp(-(U - lowest) / kT)` where U lies below `level` (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    /// U at which the weight is 1 (J).
    pub lowest: f64,
    /// Where the basin ends (J).
    pub level: f64,
    /// kT (J).
    pub kt: f64,
}

/// Lines of configurations along which the gap opens.
pub struct Lines<'a> {
    pub problem: &'a Problem,
    pub frame: Frame,
    /// Largest gap that is looked at, and how far below the state's (m).
    pub reach: f64,
}

impl Lines<'_> {
    /// The intervals of the gap (m) in which the tiles do not overlap, ascending.
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

    /// The lowest energy (J) of an interval, as far as a few looks tell.
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

    /// The integral (m) of the weight over an interval, from where the basin begins to where it
    /// ends.
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
        let (mut low, mut inside, mut sum) = (start, energy < weight.level, 0.0);
        while low < end {
            let high = (low + length).min(end);
            let inside_next = is_inside(high);
            let edge = (inside != inside_next).then(|| bisected(low, high, &is_inside));
            sum += match (inside, inside_next) {
                (false, false) => 0.0,
                (false, true) => self.panel(at, [edge.unwrap_or(low), high], weight, 0),
                (true, _) => self.panel(at, [low, edge.unwrap_or(high)], weight, 0),
            };
            if inside && !inside_next {
                break;
            }
            (low, inside) = (high, inside_next);
            length = (2.0 * length).min(longest);
        }
        sum
    }

    /// Gauss' rule (m) over a panel, halved where the exponent changes too much.
    fn panel(&self, at: [f64; 2], [low, high]: [f64; 2], weight: &Weight, depth: u32) -> f64 {
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let gaps: [f64; POINTS] = std::array::from_fn(|k| {
            let x = GAUSS[k % 4].0;
            middle + if k < 4 { -x } else { x } * half
        });
        let exponents = self
            .energies(at, gaps)
            .map(|u| (u - weight.lowest) / weight.kt);
        let least = exponents.into_iter().fold(f64::INFINITY, f64::min);
        let most = exponents.into_iter().fold(f64::NEG_INFINITY, f64::max);
        if least < NOTHING && most - least > RANGE && depth < DEEPEST {
            let parts = [[low, middle], [middle, high]];
            return parts
                .map(|part| self.panel(at, part, weight, depth + 1))
                .iter()
                .sum();
        }
        let terms = exponents.iter().enumerate();
        half * terms
            .map(|(k, exponent)| GAUSS[k % 4].1 * (-exponent).exp())
            .sum::<f64>()
    }
}

/// Where between two gaps (m) a line crosses the basin's end.
fn bisected(mut low: f64, mut high: f64, is_inside: impl Fn(f64) -> bool) -> f64 {
    let inside = is_inside(low);
    for _ in 0..BISECTIONS {
        let middle = (low + high) / 2.0;
        if is_inside(middle) == inside {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high) / 2.0
}
