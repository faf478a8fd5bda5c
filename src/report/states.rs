//! States and barriers as tables. Scripts may count the columns of these files: existing columns
//! keep their places, and new ones are appended.

use serde_json::{Value, json};

use crate::document::{Link, Rows, Table, rows};
use crate::names::{face_names, kind, pathway_file};
use crate::plots::Scene;
use crate::values::read_pose;
use jobs::design::Design;
use jobs::pipeline::Analysis;
use physics::configuration::Configuration;
use physics::landscape::{Barrier, Catalogue, Kind, Place, Proportion, State, StateKind};

/// A state with its further data.
pub struct StateRow<'a> {
    /// The state itself.
    pub state: &'a State,
    /// Its letter.
    pub name: &'a str,
    /// The number of states in its class.
    copies: usize,
    /// Names of the faces in contact: of the fixed tile, of the moving tile.
    faces: Vec<[String; 2]>,
    /// Share of the far starts that end here.
    pub capture: Option<Proportion>,
    /// The lowest way out.
    pub escape: Option<Barrier>,
}

impl<'a> StateRow<'a> {
    fn new(design: &Design, analysis: &'a Analysis, names: &'a [String], state: &'a State) -> Self {
        let same = |other: &&State| other.class == state.class;
        Self {
            state,
            name: &names[state.id],
            copies: analysis.catalogue.states.iter().filter(same).count(),
            faces: face_names(design, state),
            capture: state.capture,
            escape: analysis.escape(state.id),
        }
    }

    /// A kind of states, represented by its first state, with the share of far starts that end in
    /// any of them.
    pub fn of_kind(
        design: &Design,
        analysis: &'a Analysis,
        names: &'a [String],
        kind: &Kind<'a>,
    ) -> Self {
        Self {
            capture: Some(kind.captured()),
            ..Self::new(design, analysis, names, kind.first())
        }
    }

    /// The lowest way out, if one is known.
    fn way_out(&self) -> Option<&Barrier> {
        self.escape.as_ref().filter(|escape| escape.has_way())
    }

    fn is_caged(&self) -> bool {
        let escape = self.escape.as_ref();
        escape.is_some_and(|escape| escape.bounds.caged)
    }

    /// The faces in contact as a text.
    fn pairs(&self) -> String {
        let pairs: Vec<_> = self.faces.iter().map(|pair| pair.join("-")).collect();
        pairs.join(" ")
    }
}

/// The columns of states, for programs and for people. `is_whole` says whether escapes of copies name
/// their pathways.
// One line a column.
#[rustfmt::skip]
fn columns<'a>(catalogue: &'a Catalogue, states: impl IntoIterator<Item = StateRow<'a>>, is_whole: bool) -> Rows<'a, StateRow<'a>> {
    let leads_to = |it: &StateRow| match it.escape.as_ref().map(|way| (why_no_way(way), way.to)) {
        Some((Some(why), _)) => why.to_owned(),
        Some((None, to)) => catalogue.name_of(to),
        None => "-".to_owned(),
    };
    let escape = move |row: &StateRow| -> Option<Value> {
        let mut entry = barriers([row.escape.as_ref()?]).json()[0].take();
        if !is_whole && row.state.id != row.state.class {
            entry["pathway"] = Value::Null;
        }
        Some(entry)
    };
    rows(states)
        .column("id", "number", "", |it| it.state.id)
        .data("kind", |it| kind(it.state.kind))
        .shown("kind", "", |it| if it.state.kind == StateKind::Bond { "bond" } else { "trap" })
        .column("class", "class", "lowest id among the states that symmetries map onto this one", |it| it.state.class)
        .column("copies", "copies", "copies by symmetry", |it| it.copies)
        .column("pose", "x, y (mm), \u{3b8}", "of the copy nearest to the bond", |it| it.state.configuration)
        .column("energy_J", "energy", "of the magnets, 0 far apart", |it| it.state.energy)
        // To the nearest lower state or to free.
        .column("escape_J", "escape", "the lowest barrier out", |it| it.escape.as_ref().map(Barrier::forward)).in_csv()
        .data("escape_to", |it| it.way_out().map(|way| way.to)).in_csv()
        .shown("leads to", "end of the lowest path", leads_to)
        .column("capture", "captured", "fraction of the far starts that end in any of them", |it| it.capture).sampled()
        .column("attracting", "attracting", "magnet pairs close together", |it| it.state.attracting)
        .column("repelling", "repelling", "magnet pairs close together", |it| it.state.repelling)
        .column("faces", "faces", "in contact", StateRow::pairs).in_csv()
        .data("faces", |it| json!(it.faces)).in_json()
        .column("block_energy_J", "energy of blocks", "in place of point dipoles", |it| it.state.block_energy)
        .column("dipole_error_J", "error of dipoles", "", |it| it.state.dipole_error()).in_csv()
        .column("name", "state", "letters by depth", |it| it.name)
        // It is proved that there is no way out.
        .column("caged", "caged", "", StateRow::is_caged).in_csv()
        .data("escape", escape).in_json()
}

/// All states; for point dipoles with the energy of the blocks they represent, and the difference.
/// `is_whole` says whether escapes of copies name their pathways.
pub fn states(design: &Design, analysis: &Analysis, is_whole: bool) -> Table {
    let (catalogue, names) = (&analysis.catalogue, analysis.catalogue.names());
    let states = catalogue.states.iter();
    let states = states.map(|state| StateRow::new(design, analysis, &names, state));
    let table = columns(catalogue, states, is_whole).table("states");
    table.in_file("states").in_data()
}

/// The kinds of states, for people: one row for those that symmetry maps onto each other.
// One line a column.
#[rustfmt::skip]
pub fn kinds(design: &Design, analysis: &Analysis, scene: &Scene) -> Table {
    let (names, kinds) = (scene.catalogue.names(), scene.kinds());
    let states = kinds.iter().map(|kind| StateRow::of_kind(design, analysis, &names, kind));
    columns(&analysis.catalogue, states, true)
        .energies(4)
        .view(&[
            "state", "kind", "copies", "energy", "escape", "leads to", "captured", "x, y (mm), \u{3b8}",
            "attracting", "repelling", "faces",
        ])
        .on_page()
        .titled(
            "States",
            "One row per kind of state; symmetric copies are counted together, and the pose is \
             that of the copy nearest to the bond. Captured: fraction of far starts that end in \
             any copy. Attracting, repelling: magnet pairs close together. Click a row to show \
             its pose.",
        )
        .linked(kinds.iter().map(|kind| Some(Link::State(kind.first().id))))
}

/// Some kinds of states in the summary, with this number of digits.
// One line a column.
#[rustfmt::skip]
pub fn listed<'a>(design: &Design, analysis: &'a Analysis, kinds: impl Iterator<Item = Kind<'a>>, digits: usize) -> Table {
    let (catalogue, names) = (&analysis.catalogue, analysis.catalogue.names());
    let copies = |it: &StateRow| match it.copies { 1 => String::new(), copies => format!(" x{copies}") };
    let leads_to = |it: &StateRow| match it.escape.as_ref().map(|way| (why_no_way(way), way.to)) {
        // The letter says which state it is.
        Some((None, Place::State(to))) => names[to].clone(),
        Some((None, Place::Free)) => catalogue.name_of(Place::Free),
        Some((Some(why), _)) => why.to_owned(),
        None => "none found".to_owned(),
    };
    let pairs = |it: &StateRow| Some(it.pairs()).filter(|pairs| !pairs.is_empty());
    rows(kinds.map(|kind| StateRow::of_kind(design, analysis, &names, &kind)))
        .shown("state", "", |it| catalogue.name_of(Place::State(it.state.id)) + &copies(it))
        .shown("captures", "", |it| it.capture)
        .column("_J", "energy", "", |it| it.state.energy).digits(digits)
        .column("_J", "escape", "", |it| it.way_out().map(Barrier::forward)).digits(digits)
        .column("bounds_J", "certified", "", |it| certified(it.escape.as_ref().filter(|way| !way.bounds.caged)?)).digits(digits).beside()
        .shown("to", "", leads_to)
        .shown("x, y (mm), theta, faces", "", |it| {
            format!("{}, {}", pose(&it.state.configuration), pairs(it).unwrap_or_else(|| "no contact".to_owned()))
        })
        .table("").in_view()
        .on_terminal()
}

/// Certified bounds of a barrier.
fn certified(barrier: &Barrier) -> Option<[f64; 2]> {
    barrier.certified().map(<[f64; 2]>::from)
}

/// Barriers with their bounds and pathways.
pub fn barriers<'a>(barriers: impl IntoIterator<Item = &'a Barrier>) -> Table {
    barrier_columns(barriers)
        .table("barriers")
        .in_file("barriers")
        .in_data()
}

// One line a column.
#[rustfmt::skip]
fn barrier_columns<'a>(barriers: impl IntoIterator<Item = &'a Barrier>) -> Rows<'a, &'a Barrier> {
    let file = |it: &&Barrier| it.has_way().then(|| pathway_file(it));
    rows(barriers)
        .data("from", |it| it.from)
        .data("to", |it| it.to)
        .column("saddle_energy_J", "saddle", "highest energy on the best path found", |it| it.saddle_energy)
        // Null if no path is known, as is the file of the pathway, relative to the report.
        .data("saddle_pose", |it| it.has_way().then_some(it.saddle)).in_json()
        .data("lower_J", |it| it.bounds.lower) // proved bound of the saddle's energy
        .data("upper_J", |it| it.bounds.upper) // proved bound of the saddle's energy
        .column("forward_J", "barrier", "saddle above the start", |it| it.forward()).beside()
        .column("reverse_J", "barrier back", "saddle above the end", |it| it.reverse()).beside()
        // Lowest and highest saddle energy over repeated runs; null for a single run.
        .data("spread_bounds_J", |it| it.spread.map(|spread| [spread.0, spread.1])).in_csv()
        .data("spread_J", |it| json!(it.spread)).in_json()
        .data("pose", |it| it.saddle).in_csv() // of the saddle
        .data("pathway", file)
        // It is proved that there is no path; the saddle energy is then infinite.
        .data("caged", |it| it.bounds.caged)
        // Work against the energy along the pathway and back, and its length.
        .column("work_J", "work", "sum of all climbs", |it| it.work().map(|work| work[0]))
        .data("reverse_work_J", |it| it.work().map(|work| work[1]))
        .column("length_m", "length", "of the path", |it| it.length())
}

/// The barriers for people; `way` gives the animated path of the page over a barrier.
// One line a column.
#[rustfmt::skip]
pub fn shown_barriers(analysis: &Analysis, scene: &Scene, way: impl Fn(&Barrier) -> Option<usize>) -> Table {
    let barriers = &analysis.catalogue.barriers;
    barrier_columns(barriers)
        .shown("from", "", |it| scene.name_of(it.from))
        .shown("to", "", |it| scene.name_of(it.to))
        .column("bounds_J", "certified", "proved bounds of the barrier", |it| certified(it)).beside()
        .shown("no way", "", |it| why_no_way(it))
        .energies(4)
        .view(&["from", "to", "saddle", "barrier", "certified", "barrier back", "no way", "work", "length"])
        .on_page()
        .titled(
            "Barriers",
            "Saddle: highest energy on the best path found. Barrier: the saddle above the start, \
             with certified bounds; barrier back: the saddle above the end. Click a row to play \
             the path.",
        )
        .linked(barriers.iter().map(|barrier| way(barrier).map(Link::Way)))
}

/// Why a barrier has no path, if it has none.
pub fn why_no_way(barrier: &Barrier) -> Option<&'static str> {
    match barrier.has_way() {
        _ if barrier.bounds.caged => Some("caged, proved"),
        true => None,
        false => Some("none found"),
    }
}

/// A pose in a sentence.
pub(super) fn pose(q: &Configuration) -> String {
    let [x, y, theta] = read_pose(q);
    format!("{x}, {y}, {theta}°")
}
