//! Motions between milestones and what they cost.

use rayon::prelude::*;

use super::Milestone;
use super::profile::{Profile, ProfileTolerance};
use crate::problem::Problem;

/// What a motion costs, read off one energy profile.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EdgeCosts {
    /// Highest energy on the way, both ends included (J).
    pub peak: f64,
    /// Where it is reached, as a fraction of the motion.
    pub peak_at: f64,
    /// Length in the metric of the space (m).
    pub length: f64,
    /// Mechanical work against the energy, forwards and backwards (J).
    pub work: [f64; 2],
    /// -ln of the transition probability, forwards and backwards.
    pub improbability: [f64; 2],
}

/// A free motion between two milestones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    pub from: u32,
    pub to: u32,
    pub costs: EdgeCosts,
}

/// How edges are weighed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeSettings {
    pub tolerance: ProfileTolerance,
    /// Thermal energy kT (J) of the transition probabilities.
    pub thermal_energy: f64,
    /// Step (m, in the metric of the space) at which transition probabilities are taken.
    pub probability_step: f64,
}

/// The free motions among candidate pairs of milestones, with their costs, in the order given.
pub fn edges(
    problem: &Problem,
    milestones: &[Milestone],
    pairs: &[(u32, u32)],
    settings: &EdgeSettings,
) -> Vec<Edge> {
    pairs
        .par_iter()
        .with_min_len(64)
        .filter_map(|&(from, to)| {
            let (a, b) = (&milestones[from as usize], &milestones[to as usize]);
            let costs = costs(problem, a, b, settings)?;
            Some(Edge { from, to, costs })
        })
        .collect()
}

/// The costs of the straight motion between two milestones; `None` where it is blocked.
pub fn costs(
    problem: &Problem,
    a: &Milestone,
    b: &Milestone,
    settings: &EdgeSettings,
) -> Option<EdgeCosts> {
    if !problem.motion_is_free(&a.configuration, &b.configuration) {
        return None;
    }
    let profile = Profile::new(problem, a, b, &settings.tolerance);
    let peak = profile.peak();
    let work = profile.work();
    let length = problem.space.distance(&a.configuration, &b.configuration);
    Some(EdgeCosts {
        peak: peak.energy,
        peak_at: peak.t,
        length,
        work: [work.0, work.1],
        improbability: improbabilities(|t| profile.energy_at(t), length, settings),
    })
}

/// The costs of a way given by energies (J) at points so close that the energy between two of them
/// is as good as linear, and the lengths (m) between them.
pub fn costs_of_energies(energies: &[f64], lengths: &[f64], settings: &EdgeSettings) -> EdgeCosts {
    let mut along = vec![0.0];
    for step in lengths {
        along.push(along[along.len() - 1] + step);
    }
    let length = along[along.len() - 1];
    let highest = (0..energies.len())
        .max_by(|&a, &b| energies[a].total_cmp(&energies[b]))
        .unwrap_or(0);
    let mut work = [0.0; 2];
    for pair in energies.windows(2) {
        let climb = pair[1] - pair[0];
        work[0] += climb.max(0.0);
        work[1] += (-climb).max(0.0);
    }
    let energy_at = |t: f64| {
        let s = t * length;
        let i = along
            .partition_point(|a| *a < s)
            .clamp(1, along.len().max(2) - 1);
        let (a, b) = (along[i - 1], along[i]);
        let share = if b > a { (s - a) / (b - a) } else { 1.0 };
        energies[i - 1] + (energies[i] - energies[i - 1]) * share
    };
    EdgeCosts {
        peak: energies[highest],
        peak_at: along[highest] / length.max(f64::MIN_POSITIVE),
        length,
        work,
        improbability: improbabilities(energy_at, length, settings),
    }
}

/// -ln of the probability of going along a profile, forwards and backwards: at each inner point of
/// a fine subdivision the motion goes on to the next point (energy difference D+) rather than back
/// to the last one (D-) with probability `e^(-D+/kT) / (e^(-D+/kT) + e^(-D-/kT))`; the first step
/// is weighed against staying (D- = 0). Source: Singh, Latombe and Brutlag, *A motion planning
/// approach to flexible ligand binding* (ISMB 1999), section "Edge weights". Both ends count.
fn improbabilities(
    energy_at: impl Fn(f64) -> f64,
    length: f64,
    settings: &EdgeSettings,
) -> [f64; 2] {
    let steps = (length / settings.probability_step).ceil().max(1.0) as usize;
    let energies: Vec<f64> = (0..=steps)
        .map(|i| energy_at(i as f64 / steps as f64))
        .collect();
    let mut reversed = energies.clone();
    reversed.reverse();
    [&energies, &reversed].map(|e| improbability(e, settings.thermal_energy))
}

fn improbability(energies: &[f64], thermal_energy: f64) -> f64 {
    (0..energies.len() - 1)
        .map(|i| {
            let back = if i == 0 { energies[0] } else { energies[i - 1] };
            // -ln of e^-f / (e^-f + e^-b) is ln(1 + e^(f - b)), with f - b the difference of the
            // next and the last energy.
            softplus((energies[i + 1] - back) / thermal_energy)
        })
        .sum()
}

/// ln(1 + e^x) without overflow.
fn softplus(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}
