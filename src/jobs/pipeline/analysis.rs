//! The result of an analysis, as plain values.

use std::borrow::Cow;
use std::sync::Arc;

use super::Settings;
use physics::budget::Ended;
use physics::configuration::Configuration;
use physics::dynamics::check::BarrierCheck;
use physics::landscape::{Barrier, Catalogue, Completeness, LeftOut, Uncaptured, Uncertified};
use physics::problem::Problem;
use physics::roadmap::RoadmapSettings;

/// The result of the main job, with everything that reproduces it.
#[derive(Clone)]
pub struct Analysis {
    /// What was analysed.
    pub problem: Arc<Problem>,
    /// What was asked for.
    pub settings: Settings,
    /// What that meant for the roadmap.
    pub roadmap: RoadmapSettings,
    /// The configuration in which the target faces coincide, and its energy (J).
    pub bound: (Configuration, f64),
    /// States, barriers and pathways.
    pub catalogue: Catalogue,
    /// What is proved of the states that the catalogue may lack, or why nothing is.
    pub completeness: Result<Completeness, Uncertified>,
    /// Shares of the far starts that end in no state.
    pub uncaptured: Uncaptured,
    /// Inner and outer radius (m) of the ring of far starts.
    pub ring: [f64; 2],
    /// Why the barriers have no certified bounds, where they have none.
    pub uncertified: Option<Uncertified>,
    /// What ended the certificate before all bounds were as narrow as was asked for; `None` if
    /// nothing did.
    pub certificate_ended: Option<Ended>,
    /// What moving tiles say of the barriers; `None` if they were not asked.
    pub dynamics: Option<Vec<BarrierCheck>>,
    /// How much was done.
    pub counts: Counts,
    /// Wall time (s) and energy evaluations of each stage, in order.
    pub stages: Vec<Stage>,
}

impl Analysis {
    /// The barrier from a state to the nearest lower one or to `free`, see [`Catalogue::escape`].
    pub fn escape(&self, id: usize) -> Option<Barrier> {
        self.catalogue.escape(&self.problem, id)
    }

    /// The barriers that moving tiles contradict: they cross below what is certified.
    pub fn contradicted(&self) -> impl Iterator<Item = &BarrierCheck> {
        let checks = self.dynamics.iter().flatten();
        checks.filter(|check| check.is_contradicted())
    }

    /// The barriers without certified bounds that moving tiles show to be estimated too high.
    pub fn overestimated(&self) -> impl Iterator<Item = &BarrierCheck> {
        let checks = self.dynamics.iter().flatten();
        checks.filter(|check| check.is_overestimated())
    }
}

/// How much was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Counts {
    /// Milestones of the roadmap.
    pub milestones: usize,
    /// Its free motions.
    pub edges: usize,
    /// Transition states found, copies counted one by one.
    pub transition_states: usize,
    /// Kinds of states that were found and are not listed, as so many are asked for only.
    #[serde(default)]
    pub left_out: Option<LeftOut>,
    /// Energies computed, with their gradients or without.
    pub energy_evaluations: u64,
    /// Cells of the certificate.
    pub cells: usize,
}

/// A stage of the main job.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Stage {
    /// What the observer was told.
    pub name: Cow<'static, str>,
    /// Wall time (s).
    pub wall_s: f64,
    /// Energies computed meanwhile.
    pub energy_evaluations: u64,
}
