//! What an analysis was asked for.

use serde::Serialize;

use crate::design::Design;
use crate::pipeline::Analysis;

/// All that decides the result, besides the design and the seed.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct SettingsEntry {
    pub model: &'static str,
    /// The rule by which shields act; null for bare magnets.
    pub shields: Option<&'static str>,
    pub milestones: usize,
    /// Neighbours of each milestone.
    pub neighbours: usize,
    /// Energy of Boltzmann's acceptance rule; null for the linear rule.
    pub boltzmann_J: Option<f64>,
    pub thermal_energy_J: f64,
    pub settled: f64,
    pub least_depth: f64,
    pub far_starts: usize,
    pub repeats: usize,
    /// Width to which certified bounds are narrowed; null for a hundredth of the bond or a twentieth
    /// of the barrier, whichever is less.
    pub tolerance_J: Option<f64>,
    pub certify_s: f64,
}

impl SettingsEntry {
    pub(super) fn new(design: &Design, analysis: &Analysis) -> Self {
        let settings = &analysis.settings;
        Self {
            model: design.interaction.model.name(),
            shields: (!design.interaction.shields.is_none())
                .then(|| design.interaction.shields.rule.name()),
            milestones: settings.milestones,
            neighbours: analysis.roadmap.neighbours,
            boltzmann_J: settings.boltzmann,
            thermal_energy_J: analysis.roadmap.edges.thermal_energy,
            settled: settings.settled,
            least_depth: settings.least_depth,
            far_starts: settings.far_starts,
            repeats: settings.repeats,
            tolerance_J: settings.tolerance,
            certify_s: settings.certify_seconds,
        }
    }
}
