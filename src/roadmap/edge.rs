//! Motions between milestones and what they cost.

use rayon::prelude::*;

use super::Milestone;
use super::profile::{Profile, ProfileTolerance, Sample};
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
        improbability: improbabilities(&profile, length, settings),
    })
}

/// The costs of a way given by energies (J) at points so close that the energy between two of them
/// is as good as linear, and the lengths (m) between them.
pub fn costs_of_energies(energies: &[f64], lengths: &[f64], settings: &EdgeSettings) -> EdgeCosts {
    let length: f64 = lengths.iter().sum();
    let mut t = 0.0;
    let mut samples = vec![Sample {
        t,
        energy: energies[0],
        slope: 0.0,
    }];
    for (energy, step) in energies[1..].iter().zip(lengths) {
        t += step / length.max(f64::MIN_POSITIVE);
        samples.push(Sample {
            t,
            energy: *energy,
            slope: 0.0,
        });
    }
    let profile = Profile { samples };
    let peak = profile.peak();
    let work = profile.work();
    EdgeCosts {
        peak: peak.energy,
        peak_at: peak.t,
        length,
        work: [work.0, work.1],
        improbability: improbabilities(&profile, length, settings),
    }
}

/// -ln of the probability of going along a profile, forwards and backwards: at each inner point of
/// a fine subdivision the motion goes on to the next point (energy difference D+) rather than back
/// to the last one (D-) with probability `e^(-D+/kT) / (e^(-D+/kT) + e^(-D-/kT))`; the first step
/// is weighed against staying (D- = 0). Source: Singh, Latombe and Brutlag, *A motion planning
/// approach to flexible ligand binding* (ISMB 1999), section "Edge weights". Both ends count.
fn improbabilities(profile: &Profile, length: f64, settings: &EdgeSettings) -> [f64; 2] {
    let steps = (length / settings.probability_step).ceil().max(1.0) as usize;
    let energies: Vec<f64> = (0..=steps)
        .map(|i| profile.energy_at(i as f64 / steps as f64))
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
