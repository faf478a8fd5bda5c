//! Barriers, the ways over them, and what both are called.

use serde::Serialize;
use serde_json::{Value, json};

use super::{pose, positive_zero};
use crate::landscape::{Alternative, Barrier, PathwayCost, Place};

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

impl BarrierEntry {
    /// The entry of a barrier whose pathway is in the file that [`pathway_file`] names.
    pub fn new(barrier: &Barrier) -> Self {
        Self {
            from: place(barrier.from),
            to: place(barrier.to),
            saddle_energy_J: positive_zero(barrier.saddle_energy),
            saddle_pose: (!barrier.pathway.is_empty()).then(|| pose(&barrier.saddle)),
            lower_J: barrier.bounds.lower,
            upper_J: barrier.bounds.upper,
            caged: barrier.bounds.caged,
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
    pub(super) fn new(alternative: &Alternative) -> Self {
        let cost = |by: PathwayCost| (alternative.by == by).then_some(alternative.cost);
        Self {
            from: place(alternative.from),
            to: place(alternative.to),
            by: cost_name(alternative.by),
            work_J: cost(PathwayCost::Work),
            minus_ln_probability: cost(PathwayCost::Probability),
            pathway: alternative_file(alternative),
        }
    }
}

fn cost_name(cost: PathwayCost) -> &'static str {
    match cost {
        PathwayCost::Work => "work",
        PathwayCost::Probability => "probability",
    }
}

/// A place as an entry names it: a state's id, or `free`.
pub(in crate::report) fn place(place: Place) -> Value {
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
