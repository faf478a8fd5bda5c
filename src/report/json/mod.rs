//! `report.json`: what an analysis found, with all that reproduces it.
//!
//! Every number carries its unit in its key (`energy_J`); poses are `[x, y, theta]` in m, m and
//! rad. All that depends on the machine is under `timing`: everything else is the same for the
//! same design, settings and version.

mod barriers;
mod effort;
mod layout;
mod settings;
mod states;

use serde::Serialize;

pub(super) use barriers::place;
pub use barriers::{AlternativeEntry, BarrierEntry, alternative_file, pathway_file, place_name};
pub use effort::{CountsEntry, StageEntry, TimingEntry};
pub use layout::text;
pub use settings::SettingsEntry;
pub use states::{FreeEntry, ProportionEntry, StateEntry, copies, face_names, kind};

use super::dynamics::DynamicsEntry;
use crate::configuration::Configuration;
use crate::design::{Design, Drawing};
use crate::pipeline::Analysis;

/// The content of `report.json`.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Version of tilebind.
    pub tilebind: &'static str,
    pub design: DesignEntry,
    pub seed: u64,
    pub settings: SettingsEntry,
    pub bound: BoundEntry,
    pub states: Vec<StateEntry>,
    pub free: FreeEntry,
    pub barriers: Vec<BarrierEntry>,
    /// Why the bounds of all barriers are null; itself null where they are certified.
    pub uncertified: Option<String>,
    /// What moving tiles say of the barriers; null where they were not asked.
    pub dynamics: Option<DynamicsEntry>,
    pub alternatives: Vec<AlternativeEntry>,
    pub counts: CountsEntry,
    pub timing: TimingEntry,
}

/// Which design was analysed.
#[derive(Debug, Serialize)]
pub struct DesignEntry {
    pub name: String,
    pub description: String,
    /// Of the design file's bytes.
    pub sha256: String,
    /// The drawings that the design refers to.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub drawings: Vec<Drawing>,
}

/// The configuration in which the target faces coincide.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct BoundEntry {
    pub pose: [f64; 3],
    pub energy_J: f64,
    /// The state in which the tiles are bound; null if the bond does not hold.
    pub state: Option<usize>,
}

impl Report {
    /// The report of an analysis that took `total_wall` (s).
    pub fn new(design: &Design, analysis: &Analysis, total_wall: f64) -> Self {
        let states = analysis.inventory.states.iter();
        Self {
            tilebind: env!("CARGO_PKG_VERSION"),
            design: DesignEntry {
                name: design.name.clone(),
                description: design.description.clone(),
                sha256: design.sha256.clone(),
                drawings: design.drawings.clone(),
            },
            seed: analysis.settings.seed,
            settings: SettingsEntry::new(design, analysis),
            bound: BoundEntry {
                pose: pose(&analysis.bound.0),
                energy_J: positive_zero(analysis.bound.1),
                state: analysis.inventory.bound_state,
            },
            states: states
                .map(|state| {
                    let escape = analysis.escape(state.id);
                    StateEntry::new(design, state, &analysis.inventory.states, escape.as_ref())
                })
                .collect(),
            free: FreeEntry::new(analysis),
            barriers: analysis
                .inventory
                .barriers
                .iter()
                .map(BarrierEntry::new)
                .collect(),
            uncertified: analysis.uncertified.map(|why| why.to_string()),
            dynamics: DynamicsEntry::new(analysis),
            alternatives: analysis
                .inventory
                .alternatives
                .iter()
                .map(AlternativeEntry::new)
                .collect(),
            counts: CountsEntry::new(analysis),
            timing: TimingEntry::new(analysis, total_wall),
        }
    }

    /// Names no pathway for the escapes of states that are copies of another one.
    pub fn without_copies(mut self) -> Self {
        for state in self.states.iter_mut().filter(|s| s.id != s.class) {
            if let Some(escape) = &mut state.escape {
                escape.pathway = None;
            }
        }
        self
    }

    /// The text of `report.json`.
    pub fn to_text(&self) -> String {
        text(self)
    }
}

/// A configuration as entries have it.
fn pose(q: &Configuration) -> [f64; 3] {
    q.to_array().map(positive_zero)
}

/// The number itself, but 0 for -0.
pub fn positive_zero(value: f64) -> f64 {
    value + 0.0
}
