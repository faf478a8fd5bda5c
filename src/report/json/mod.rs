//! `report.json`: what an analysis found, with all that reproduces it.
//!
//! Every number carries its unit in its key (`energy_J`); poses are `[x, y, theta]` in m, m and
//! rad. All that depends on the machine is under `timing`: everything else is the same for the
//! same design, settings and version.

mod layout;

use serde::Serialize;
use serde_json::{Value, json};

pub use layout::text;

use super::dynamics::DynamicsEntry;
use crate::analysis::{Alternative, Analysis, Counts, PathwayCost, Settings, Stage};
use crate::configuration::Configuration;
use crate::design::{Design, Drawing};
use crate::landscape::{Barrier, Place, Proportion, State, StateKind};
use crate::pipeline;
use crate::roadmap::neighbour;

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

/// The configuration in which the target faces coincide.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct BoundEntry {
    pub pose: [f64; 3],
    pub energy_J: f64,
    /// The state in which the tiles are bound; null if the bond does not hold.
    pub state: Option<usize>,
}

/// A local minimum.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct StateEntry {
    pub id: usize,
    pub kind: &'static str,
    pub pose: [f64; 3],
    pub energy_J: f64,
    /// Energy of uniformly magnetised blocks in this pose, where `energy_J` is that of point
    /// dipoles; null otherwise.
    pub block_energy_J: Option<f64>,
    /// Lowest id among the states that symmetries of the tiles map onto this one.
    pub class: usize,
    /// How many states there are in the class.
    pub copies: usize,
    /// Names of the faces in contact: of the fixed tile, of the moving tile.
    pub faces: Vec<[String; 2]>,
    pub attracting: usize,
    pub repelling: usize,
    pub capture: Option<ProportionEntry>,
    /// Barrier to the nearest lower state or to free; null where no way out was found.
    pub escape: Option<BarrierEntry>,
}

/// What is said of the tiles apart.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct FreeEntry {
    /// Share of the far starts that ended in no state.
    pub capture: ProportionEntry,
    /// Inner and outer radius of the ring from which the far starts are drawn.
    pub ring_m: [f64; 2],
}

/// A sampled proportion with its 95 % Wilson interval.
#[derive(Debug, Serialize)]
pub struct ProportionEntry {
    pub share: f64,
    pub low: f64,
    pub high: f64,
    pub count: usize,
    pub of: usize,
}

/// A barrier.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct BarrierEntry {
    pub from: Value,
    pub to: Value,
    /// Null where there is no way.
    pub saddle_energy_J: f64,
    pub saddle_pose: Option<[f64; 3]>,
    pub lower_J: Option<f64>,
    pub upper_J: Option<f64>,
    /// Proved that there is no way at all; `saddle_energy_J` is then null.
    pub caged: bool,
    pub forward_J: f64,
    pub reverse_J: f64,
    /// Lowest and highest saddle energy over repeated runs; null for a single run.
    pub spread_J: Option<[f64; 2]>,
    /// File of the pathway, relative to the report; null where no way is known, or its file was
    /// not asked for.
    pub pathway: Option<String>,
}

/// A pathway by another cost than the highest energy.
#[derive(Debug, Serialize)]
#[allow(non_snake_case)]
pub struct AlternativeEntry {
    pub from: Value,
    pub to: Value,
    /// `work` or `probability`.
    pub by: &'static str,
    /// Work against the energy on the way; null by another cost.
    pub work_J: Option<f64>,
    /// -ln of the product of the transition probabilities; null by another cost.
    pub minus_ln_probability: Option<f64>,
    pub pathway: String,
}

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

impl Report {
    /// The report of an analysis that took `total_wall` (s).
    pub fn new(design: &Design, analysis: &Analysis, total_wall: f64) -> Self {
        let states = analysis.states.iter().zip(&analysis.escapes);
        Self {
            tilebind: env!("CARGO_PKG_VERSION"),
            design: DesignEntry {
                name: design.name.clone(),
                description: design.description.clone(),
                sha256: design.sha256.clone(),
                drawings: design.drawings.clone(),
            },
            seed: analysis.settings.seed,
            settings: SettingsEntry::new(design, &analysis.settings, &analysis.counts),
            bound: BoundEntry {
                pose: pose(&analysis.bound.0),
                energy_J: positive_zero(analysis.bound.1),
                state: analysis.bound_state,
            },
            states: states
                .map(|(state, escape)| {
                    StateEntry::new(design, state, &analysis.states, escape.as_ref())
                })
                .collect(),
            free: FreeEntry {
                capture: (&analysis.uncaptured).into(),
                ring_m: analysis.ring,
            },
            barriers: analysis.barriers.iter().map(BarrierEntry::new).collect(),
            uncertified: analysis.uncertified.map(|why| why.to_string()),
            dynamics: DynamicsEntry::new(analysis),
            alternatives: analysis
                .alternatives
                .iter()
                .map(AlternativeEntry::new)
                .collect(),
            counts: CountsEntry {
                milestones: analysis.counts.milestones,
                edges: analysis.counts.edges,
                transition_states: analysis.counts.transition_states,
                shallow_minima: analysis.shallow,
                energy_evaluations: analysis.counts.energy_evaluations,
                cells: analysis.counts.cells,
            },
            timing: TimingEntry {
                total_wall_s: total_wall,
                stages: analysis.stages.iter().map(StageEntry::from).collect(),
            },
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

impl SettingsEntry {
    fn new(design: &Design, settings: &Settings, counts: &Counts) -> Self {
        let problem = pipeline::problem(design);
        Self {
            model: design.model.name(),
            shields: (!design.shields.is_none()).then(|| design.shields.rule.name()),
            milestones: settings.milestones,
            neighbours: settings
                .neighbours
                .unwrap_or_else(|| neighbour::neighbours_per_milestone(counts.milestones)),
            boltzmann_J: settings.boltzmann,
            thermal_energy_J: settings
                .thermal_energy
                .unwrap_or_else(|| 0.01 * pipeline::energy_scale(design, &problem)),
            settled: settings.settled,
            least_depth: settings.least_depth,
            far_starts: settings.far_starts,
            repeats: settings.repeats,
            tolerance_J: settings.tolerance,
            certify_s: settings.certify_seconds,
        }
    }
}

impl StateEntry {
    fn new(design: &Design, state: &State, all: &[State], escape: Option<&Barrier>) -> Self {
        Self {
            id: state.id,
            kind: kind(state.kind),
            pose: pose(&state.configuration),
            energy_J: positive_zero(state.energy),
            block_energy_J: state.block_energy,
            class: state.class,
            copies: copies(state, all),
            faces: face_names(design, state),
            attracting: state.attracting,
            repelling: state.repelling,
            capture: state.capture.as_ref().map(ProportionEntry::from),
            escape: escape.map(BarrierEntry::new),
        }
    }
}

/// What a kind of state is called.
pub fn kind(kind: StateKind) -> &'static str {
    match kind {
        StateKind::Bound => "bound",
        StateKind::Misbound => "misbound",
    }
}

/// How many states there are in the class of one.
pub fn copies(state: &State, all: &[State]) -> usize {
    all.iter()
        .filter(|other| other.class == state.class)
        .count()
}

/// Names of the faces in contact: of the fixed tile, of the moving tile.
pub fn face_names(design: &Design, state: &State) -> Vec<[String; 2]> {
    let name = |tile: &crate::tile::Tile, i: usize| tile.faces[i].name.clone();
    state
        .faces
        .iter()
        .map(|&(f, m)| [name(&design.fixed, f), name(&design.moving, m)])
        .collect()
}

impl BarrierEntry {
    /// The entry of a barrier whose pathway is in the file that [`pathway_file`] names.
    pub fn new(barrier: &Barrier) -> Self {
        Self {
            from: place(barrier.from),
            to: place(barrier.to),
            saddle_energy_J: positive_zero(barrier.saddle_energy),
            saddle_pose: (!barrier.pathway.is_empty()).then(|| pose(&barrier.saddle)),
            lower_J: barrier.lower,
            upper_J: barrier.upper,
            caged: barrier.caged,
            forward_J: positive_zero(barrier.forward()),
            reverse_J: positive_zero(barrier.reverse()),
            spread_J: barrier.spread.map(|(low, high)| [low, high]),
            pathway: (!barrier.pathway.is_empty()).then(|| pathway_file(barrier)),
        }
    }
}

/// The file of a barrier's pathway, relative to the report.
pub fn pathway_file(barrier: &Barrier) -> String {
    let (from, to) = (place_name(barrier.from), place_name(barrier.to));
    format!("pathways/{from}-{to}.csv")
}

/// The file of an alternative pathway, relative to the report.
pub fn alternative_file(alternative: &Alternative) -> String {
    let (from, to) = (place_name(alternative.from), place_name(alternative.to));
    let by = cost_name(alternative.by);
    format!("pathways/{from}-{to}-by-{by}.csv")
}

impl AlternativeEntry {
    fn new(alternative: &Alternative) -> Self {
        let cost = |by: PathwayCost| (alternative.by == by).then_some(alternative.cost);
        Self {
            from: place(alternative.from),
            to: place(alternative.to),
            by: cost_name(alternative.by),
            work_J: cost(PathwayCost::Work),
            minus_ln_probability: cost(PathwayCost::Improbability),
            pathway: alternative_file(alternative),
        }
    }
}

fn cost_name(cost: PathwayCost) -> &'static str {
    match cost {
        PathwayCost::Work => "work",
        PathwayCost::Improbability => "probability",
    }
}

impl From<&Proportion> for ProportionEntry {
    fn from(proportion: &Proportion) -> Self {
        Self {
            share: proportion.share(),
            low: proportion.low,
            high: proportion.high,
            count: proportion.count,
            of: proportion.of,
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

pub(super) fn place(place: Place) -> Value {
    match place {
        Place::State(id) => json!(id),
        Place::Free => json!("free"),
    }
}

/// What a place is called in tables and file names: a state's id, or `free`.
pub fn place_name(place: Place) -> String {
    match place {
        Place::State(id) => id.to_string(),
        Place::Free => "free".to_owned(),
    }
}

fn pose(q: &Configuration) -> [f64; 3] {
    q.to_array().map(positive_zero)
}

/// The number itself, but 0 for -0.
pub fn positive_zero(value: f64) -> f64 {
    value + 0.0
}
