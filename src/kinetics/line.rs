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
/// ... and so often to find where the basin ends.
const DEEPEST_EDGE: u32 = 7;
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

    /// The integral (m) of the weight over an interval, up to where the basin ends.
    pub fn integral(&self, at: [f64; 2], [start, end]: [f64; 2], weight: &Weight) -> f64 {
        let q = self.frame.configuration(at, start);
        let (_, gradient) = self.problem.potential().energy_and_gradient(&q);
        let slope = gradient.xy().dot(&self.frame.normal()).abs();
        let decay = if slope > 0.0 {
            weight.kt / slope
        } else {
            self.reach
        };
        let mut length = decay.clamp(SHORTEST * self.reach, self.reach / 16.0);
        let (mut low, mut sum, mut was_inside) = (start, 0.0, false);
        while low < end {
            let high = (low + length).min(end);
            let panel = self.panel(at, [low, high], weight, 0);
            if was_inside && panel.share == 0.0 {
                break;
            }
            was_inside |= panel.share > 0.0;
            sum += panel.sum;
            length = (2.0 * length).min(self.reach / 16.0);
            low = high;
        }
        sum
    }

    /// Gauss' rule over a panel, halved where the exponent changes too much and where the basin
    /// ends in it.
    fn panel(&self, at: [f64; 2], [low, high]: [f64; 2], weight: &Weight, depth: u32) -> Panel {
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let gaps: [f64; POINTS] = std::array::from_fn(|k| {
            let x = GAUSS[k % 4].0;
            middle + if k < 4 { -x } else { x } * half
        });
        let energies = self.energies(at, gaps);
        let inside = energies.iter().filter(|u| **u < weight.level).count();
        let exponents = energies.map(|u| (u - weight.lowest) / weight.kt);
        let least = exponents.into_iter().fold(f64::INFINITY, f64::min);
        let most = exponents.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let ends_here = inside > 0 && inside < POINTS && depth < DEEPEST_EDGE;
        let matters = inside > 0 && least < 60.0;
        if ends_here || (matters && most - least > RANGE && depth < DEEPEST) {
            let [a, b] =
                [[low, middle], [middle, high]].map(|part| self.panel(at, part, weight, depth + 1));
            return Panel {
                sum: a.sum + b.sum,
                share: (a.share + b.share) / 2.0,
            };
        }
        let terms = energies.iter().zip(exponents).enumerate();
        let sum = terms
            .filter(|(_, (u, _))| **u < weight.level)
            .map(|(k, (_, exponent))| GAUSS[k % 4].1 * (-exponent).exp())
            .sum::<f64>();
        Panel {
            sum: sum * half,
            share: inside as f64 / POINTS as f64,
        }
    }
}

struct Panel {
    /// The integral (m).
    sum: f64,
    /// Share of it that lies in the basin.
    share: f64,
}
