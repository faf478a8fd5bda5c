//! What an analysis took: how much was done, and how long it lasted.

use serde::Serialize;

use crate::pipeline::{Analysis, Stage};

/// How much was done.
#[derive(Debug, Serialize)]
pub struct CountsEntry {
    pub milestones: usize,
    pub edges: usize,
    pub transition_states: usize,
    /// Minima left out because next to nothing keeps them.
    pub shallow_minima: usize,
    pub energy_evaluations: u64,
    /// Cells of the certificate.
    pub cells: usize,
}

/// How long it took.
#[derive(Debug, Serialize)]
pub struct TimingEntry {
    pub total_wall_s: f64,
    pub stages: Vec<StageEntry>,
}

/// A stage of the work.
#[derive(Debug, Serialize)]
pub struct StageEntry {
    pub name: &'static str,
    pub wall_s: f64,
    pub energy_evaluations: u64,
}

impl CountsEntry {
    pub(super) fn new(analysis: &Analysis) -> Self {
        let counts = &analysis.counts;
        Self {
            milestones: counts.milestones,
            edges: counts.edges,
            transition_states: counts.transition_states,
            shallow_minima: analysis.inventory.shallow,
            energy_evaluations: counts.energy_evaluations,
            cells: counts.cells,
        }
    }
}

impl TimingEntry {
    pub(super) fn new(analysis: &Analysis, total_wall: f64) -> Self {
        Self {
            total_wall_s: total_wall,
            stages: analysis.stages.iter().map(StageEntry::from).collect(),
        }
    }
}

impl From<&Stage> for StageEntry {
    fn from(stage: &Stage) -> Self {
        Self {
            name: stage.name,
            wall_s: stage.wall_s,
            energy_evaluations: stage.energy_evaluations,
        }
    }
}
