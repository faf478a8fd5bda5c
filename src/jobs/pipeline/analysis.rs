//! The result of an analysis, as plain values.

use std::borrow::Cow;
use std::sync::Arc;

use super::Request;
use physics::budget::Ended;
use physics::configuration::Configuration;
use physics::dynamics::check::BarrierCheck;
use physics::landscape::{Barrier, Catalogue, Completeness, LeftOut, Uncaptured, Uncertified};
use physics::problem::Problem;
use physics::roadmap::RoadmapSettings;

/// The result of an analysis, with everything needed to reproduce it.
#[derive(Clone)]
pub struct Analysis {
    /// The analysed problem.
    pub problem: Arc<Problem>,
    /// The request.
    pub request: Request,
    /// The resulting settings of the roadmap.
    pub roadmap: RoadmapSettings,
    /// The configuration in which the target faces coincide, and its energy (J).
    pub bound: (Configuration, f64),
    /// States, barriers and pathways.
    pub catalogue: Catalogue,
    /// What is proved about states missing from the catalogue, or why nothing is.
    pub completeness: Result<Completeness, Uncertified>,
    /// Shares of the far starts that end in no state.
    pub uncaptured: Uncaptured,
    /// Inner and outer radius (m) of the ring of far starts.
    pub ring: [f64; 2],
    /// Why the barriers have no certified bounds, if they have none.
    pub uncertified: Option<Uncertified>,
    /// What ended the certification before all bounds were as narrow as requested; `None` if
    /// nothing did.
    pub certificate_ended: Option<Ended>,
    /// The check of the barriers by moving tiles; `None` without the check.
    pub dynamics: Option<Vec<BarrierCheck>>,
    /// Amounts of work.
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

/// Amounts of work.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Counts {
    /// Milestones of the roadmap.
    pub milestones: usize,
    /// Its free motions.
    pub edges: usize,
    /// Transition states found, copies counted one by one.
    pub transition_states: usize,
    /// Kinds of states that were found but exceed the requested number.
    #[serde(default)]
    pub left_out: Option<LeftOut>,
    /// Number of energies computed, with or without gradients.
    pub energy_evaluations: u64,
    /// Cells of the certificate.
    pub cells: usize,
}

/// A stage of an analysis.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Stage {
    /// Its name for the observer.
    pub name: Cow<'static, str>,
    /// Wall time (s).
    pub wall_s: f64,
    /// Energies computed during the stage.
    pub energy_evaluations: u64,
}
