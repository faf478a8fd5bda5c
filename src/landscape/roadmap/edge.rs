//! Motions between milestones and their costs.

use ordered_float::OrderedFloat;

use super::knot::work;
use super::point::Point;
use super::profile::Profile;
use super::stretch::ProfileTolerance;
use tiles::configuration::Configuration;
use tiles::parallel;
use tiles::problem::Problem;

/// The costs of a motion, from one energy profile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeCosts {
    /// Highest energy along it, both ends included (J).
    pub peak: f64,
    /// Where it is reached, as a fraction of the motion.
    pub peak_at: f64,
    /// Length in the metric of the space (m).
    pub length: f64,
    /// Mechanical work against the energy, forwards and backwards (J).
    pub work: [f64; 2],
    /// -ln of the transition probability, forwards and backwards.
    pub minus_ln_probability: [f64; 2],
}

impl EdgeCosts {
    /// The costs of a motion that is not free: higher than any others.
    pub const BLOCKED: Self = Self {
        peak: f64::INFINITY,
        peak_at: 0.0,
        length: f64::INFINITY,
        work: [f64::INFINITY; 2],
        minus_ln_probability: [f64::INFINITY; 2],
    };
}

/// A free motion between two milestones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The milestone it leaves.
    pub from: u32,
    /// The milestone it reaches.
    pub to: u32,
    /// The costs of the motion in both directions.
    pub costs: EdgeCosts,
}

/// How edges are weighed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct EdgeSettings {
    /// How closely the energy is followed along an edge.
    pub tolerance: ProfileTolerance,
    /// Thermal energy kT (J) of the transition probabilities.
    pub thermal_energy: f64,
    /// Step (m, in the metric of the space) at which transition probabilities are taken.
    pub probability_step: f64,
}

/// Number of edges that are collected together.
const BATCH: usize = 1 << 20;
/// Number of motions whose energies are evaluated together.
pub(crate) const SIDE_BY_SIDE: usize = 64;

/// The free motions among candidate pairs of milestones, with their costs, in the order given.
pub fn edges(
    problem: &Problem,
    milestones: &[Point],
    pairs: &[(u32, u32)],
    settings: &EdgeSettings,
) -> Vec<Edge> {
    let free = free_motions(problem, milestones, pairs);
    let of_some = |some: &[(u32, u32)]| -> Vec<Edge> {
        let ends = some.iter();
        let ends = ends.map(|&(from, to)| [from, to].map(|end| &milestones[end as usize]));
        let costs = costs_side_by_side(problem, &ends.collect::<Vec<_>>(), settings);
        let edge = |(&(from, to), costs)| Edge { from, to, costs };
        some.iter().zip(costs).map(edge).collect()
    };
    let mut edges = Vec::with_capacity(free.len());
    // In parts, because collecting in parallel takes twice the memory.
    for part in free.chunks(BATCH) {
        let part: Vec<&[(u32, u32)]> = part.chunks(SIDE_BY_SIDE).collect();
        edges.append(&mut parallel::flat_map(&part, |some| of_some(some)));
    }
    edges
}

/// The pairs of milestones between which the straight motion is free.
pub fn free_motions(
    problem: &Problem,
    milestones: &[Point],
    pairs: &[(u32, u32)],
) -> Vec<(u32, u32)> {
    let configurations: Vec<Configuration> = milestones.iter().map(|m| m.q).collect();
    problem.free_motions(&configurations, pairs)
}

/// The costs of some straight motions, whose energies are evaluated together.
pub(crate) fn costs_side_by_side(
    problem: &Problem,
    ends: &[[&Point; 2]],
    settings: &EdgeSettings,
) -> Vec<EdgeCosts> {
    let profiles = Profile::of_many(problem, ends, &settings.tolerance);
    let costs = profiles.iter().zip(ends);
    let costs = costs.map(|(profile, ends)| costs_of_profile(problem, profile, *ends, settings));
    costs.collect()
}

/// The costs of the straight motion between two milestones.
pub fn costs(problem: &Problem, ends: [&Point; 2], settings: &EdgeSettings) -> EdgeCosts {
    costs_side_by_side(problem, &[ends], settings)[0]
}

fn costs_of_profile(
    problem: &Problem,
    profile: &Profile,
    [a, b]: [&Point; 2],
    settings: &EdgeSettings,
) -> EdgeCosts {
    let peak = profile.peak();
    let length = problem.space.distance(&a.q, &b.q);
    EdgeCosts {
        peak: peak.energy,
        peak_at: peak.t,
        length,
        work: profile.work(),
        minus_ln_probability: improbabilities(profile.energies(steps(length, settings)), settings),
    }
}

/// The costs of a path given by energies (J) at points close enough for the energy between two of
/// them to be nearly linear, and the lengths (m) between them.
pub fn costs_of_energies(energies: &[f64], lengths: &[f64], settings: &EdgeSettings) -> EdgeCosts {
    if let [only] = energies {
        return EdgeCosts {
            peak: *only,
            ..EdgeCosts::default()
        };
    }
    let mut along = vec![0.0];
    for step in lengths {
        along.push(along[along.len() - 1] + step);
    }
    let length = along[along.len() - 1];
    let highest = (0..energies.len())
        .max_by_key(|&k| OrderedFloat(energies[k]))
        .unwrap_or(0);
    let count = steps(length, settings);
    let evenly = (0..=count).map(|k| {
        let s = k as f64 / count as f64 * length;
        let i = along
            .partition_point(|a| *a < s)
            .clamp(1, along.len().max(2) - 1);
        let (a, b) = (along[i - 1], along[i]);
        let share = if b > a { (s - a) / (b - a) } else { 1.0 };
        energies[i - 1] + (energies[i] - energies[i - 1]) * share
    });
    EdgeCosts {
        peak: energies[highest],
        peak_at: along[highest] / length.max(f64::MIN_POSITIVE),
        length,
        work: work(energies.iter().copied()),
        minus_ln_probability: improbabilities(evenly, settings),
    }
}

/// Number of steps of a motion for transition probabilities.
fn steps(length: f64, settings: &EdgeSettings) -> usize {
    (length / settings.probability_step).ceil().max(1.0) as usize
}

/// -ln of the probability of following a profile, forwards and backwards, from its energies (J) at
/// evenly spaced points: at each inner point of a fine subdivision the motion goes on to the next
/// point (energy difference D+) rather than back to the last one (D-) with probability `e^(-D+/kT)
/// / (e^(-D+/kT) + e^(-D-/kT))`; the first step is weighed against staying (D- = 0). Source: Singh,
/// Latombe and Brutlag, *A motion planning approach to flexible ligand binding* (ISMB 1999),
/// section "Edge weights". Both ends count.
fn improbabilities(energies: impl Iterator<Item = f64>, settings: &EdgeSettings) -> [f64; 2] {
    let kt = settings.thermal_energy;
    let mut energies = energies;
    let (Some(first), Some(second)) = (energies.next(), energies.next()) else {
        return [0.0; 2];
    };
    let (mut last, mut here) = (first, second);
    // -ln of e^-f / (e^-f + e^-b) is ln(1 + e^(f - b)), with f - b the difference of the next and
    // the last energy over kT; in the other direction it is that minus the difference. The
    // differences add up to those at the ends.
    let mut inner = Softplus::default();
    for next in energies {
        inner.add((next - last) / kt);
        (last, here) = (here, next);
    }
    let inner = inner.total();
    let climbs = (here + last - second - first) / kt;
    let end = |climb: f64| {
        let mut end = Softplus::default();
        end.add(climb / kt);
        end.total()
    };
    [
        inner + end(second - first),
        (inner - climbs).max(0.0) + end(last - here),
    ]
}

/// A lower bound of -ln of the transition probabilities along a path of at least this length (m)
/// that leads up by `climb` (J) from end to end.
///
/// Every other one of its n steps and, if n is odd, the first, together make up the whole climb D:
/// the arguments of their m >= n / 2 terms `ln(1 + e^x)` add up to D / kT, and the other terms are
/// not negative. The function is convex, so the sum of those m terms is at least `m ln(1 + e^(D /
/// (m kT)))` (Jensen), which grows with m.
pub(crate) fn improbability_at_least(length: f64, climb: f64, settings: &EdgeSettings) -> f64 {
    let terms = length / (2.0 * settings.probability_step);
    let x = climb / settings.thermal_energy;
    if terms * Softplus::LARGE <= x {
        return x.max(0.0);
    }
    let mut each = Softplus::default();
    each.add(x / terms);
    terms * each.total()
}

/// A sum of `ln(1 + e^x)`, without overflow and with few logarithms: the logarithm of a product.
struct Softplus {
    sum: f64,
    product: f64,
}

impl Default for Softplus {
    fn default() -> Self {
        Self {
            sum: 0.0,
            product: 1.0,
        }
    }
}

impl Softplus {
    /// Beyond this, `ln(1 + e^x)` is x to within 1e-15.
    const LARGE: f64 = 35.0;

    fn add(&mut self, x: f64) {
        if x > Self::LARGE {
            self.sum += x;
            return;
        }
        self.product *= 1.0 + libm::exp(x);
        if self.product > 1e250 {
            self.sum += libm::log(self.product);
            self.product = 1.0;
        }
    }

    fn total(&self) -> f64 {
        self.sum + libm::log(self.product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Over paths of few and of many steps: level, steep and rugged.
    #[test]
    fn no_way_is_more_probable_than_is_said() {
        let settings = EdgeSettings {
            tolerance: ProfileTolerance {
                relative: 1e-3,
                absolute: 1e-6,
            },
            thermal_energy: 0.1,
            probability_step: 0.05,
        };
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut closest = f64::INFINITY;
        for turn in 0..2000 {
            let slope = rng.random_range(-20.0..20.0) / f64::from(1 + turn % 50);
            let rugged = [0.0, 0.01, 1.0][turn as usize % 3];
            let mut energies = vec![0.0];
            let mut lengths = Vec::new();
            for _ in 0..rng.random_range(1..12) {
                let length = rng.random_range(0.001..0.3);
                let here = energies[energies.len() - 1];
                energies.push(here + slope * length + rugged * rng.random_range(-0.5..0.5));
                lengths.push(length);
            }
            let costs = costs_of_energies(&energies, &lengths, &settings);
            let climb = energies[energies.len() - 1];
            for (told, climb) in costs.minus_ln_probability.into_iter().zip([climb, -climb]) {
                let least = improbability_at_least(costs.length, climb, &settings);
                assert!(least <= told * (1.0 + 1e-9) + 1e-12, "{least} {told}");
                closest = f64::min(closest, told / least);
            }
        }
        assert!((1.0..1.01).contains(&closest), "{closest}");
    }
}
