//! The names of states, places, faces and pathways in all files.

use serde_json::{Value, json};

use jobs::design::Design;
use physics::landscape::{Alternative, Barrier, PathwayCost, Place, State, StateKind};
use physics::tile::Tile;

/// The name of a kind of state.
pub fn kind(kind: StateKind) -> &'static str {
    match kind {
        StateKind::Bond => "bound",
        StateKind::Trap => "misbound",
    }
}

/// The name of a cost of pathways.
pub(super) fn cost(cost: PathwayCost) -> &'static str {
    match cost {
        PathwayCost::Work => "work",
        PathwayCost::Probability => "probability",
    }
}

/// Names of the faces in contact: of the fixed tile, of the moving tile.
pub fn face_names(design: &Design, state: &State) -> Vec<[String; 2]> {
    let name = |tile: &Tile, i: usize| tile.faces[i].name.clone();
    state
        .faces
        .iter()
        .map(|&(f, m)| [name(&design.pair.fixed, f), name(&design.pair.moving, m)])
        .collect()
}

/// A face in a sentence: `east face`, `face 3`.
pub(super) fn face(name: &str) -> String {
    match name.parse::<usize>() {
        Ok(number) => format!("face {number}"),
        Err(_) => format!("{name} face"),
    }
}

/// A place in an entry: a state's id, or `free`.
pub(super) fn place(place: Place) -> Value {
    match place {
        Place::State(id) => json!(id),
        Place::Free => json!("free"),
    }
}

/// The name of a place in tables and file names: a state's id, or `free`.
pub fn place_name(place: Place) -> String {
    match place {
        Place::State(id) => id.to_string(),
        Place::Free => "free".to_owned(),
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
    let by = cost(alternative.by);
    format!("pathways/{from}-{to}-by-{by}.csv")
}
