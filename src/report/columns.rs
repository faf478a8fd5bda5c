//! The columns of states and of barriers, once for CSV, JSON and the page.
//!
//! A new column is one entry here, and appears in every output in which it is given a place.

use serde_json::{Map, Value, json};

use super::names::{face_names, kind, pathway_file, place};
use super::values::{pose, positive_zero, proportion};
use jobs::design::Design;
use jobs::pipeline::Analysis;
use physics::configuration::Configuration;
use physics::landscape::{Barrier, Place, Proportion, State, StateKind};
use physics::order::Order;

/// What shows columns.
#[derive(Clone, Copy, Debug)]
pub enum Output {
    /// `states.csv` and `barriers.csv`.
    Csv,
    /// `report.json`.
    Json,
    /// The page's tables.
    Page,
}

/// A column of a table whose rows are made from `Row`s.
pub struct Column<Row> {
    name: &'static str,
    /// SI unit; `%` for a share; empty for whole numbers, names and JSON.
    pub unit: &'static str,
    /// What the page calls it.
    pub heading: &'static str,
    /// Its place in each [`Output`], 0 where it is not shown. Readers of files may count columns:
    /// what has a place keeps it, and what is new comes last.
    places: [u8; 3],
    /// Its entry of a row.
    pub get: fn(&Row) -> Cell,
}

/// An entry of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// A whole number, a name, or what JSON alone shows; null where there is none.
    Value(Value),
    /// A quantity; NaN where it is not known, infinite for a barrier without a way.
    Real(f64),
    /// A state or `free`, which outputs name as they do.
    Place(Place),
}

/// A state, and what is said of it elsewhere.
pub struct StateRow<'a> {
    /// The state itself.
    pub state: &'a State,
    at: &'a Configuration,
    /// What people call it.
    name: &'a str,
    /// How many states there are in its class.
    copies: usize,
    /// Names of the faces in contact: of the fixed tile, of the moving tile.
    faces: Vec<[String; 2]>,
    /// Share of the far starts that end here.
    pub capture: Option<Proportion>,
    /// The lowest way out.
    pub escape: Option<Barrier>,
}

impl<'a> StateRow<'a> {
    /// The row of a state, `names` being those of all states.
    pub fn new(
        design: &Design,
        analysis: &'a Analysis,
        names: &'a [String],
        state: &'a State,
    ) -> Self {
        let same = |other: &&State| other.class == state.class;
        let states = &analysis.inventory.states;
        Self {
            state,
            at: &state.configuration,
            name: &names[state.id],
            copies: states.iter().filter(same).count(),
            faces: face_names(design, state),
            capture: state.capture,
            escape: analysis.escape(state.id),
        }
    }

    fn is_bound(&self) -> bool {
        self.state.kind == StateKind::Bond
    }

    fn is_caged(&self) -> bool {
        self.escape
            .as_ref()
            .is_some_and(|escape| escape.bounds.caged)
    }

    /// What there is to say of the way out.
    fn out(&self, get: fn(&Barrier) -> Cell) -> Cell {
        self.escape.as_ref().map_or(value(Value::Null), get)
    }

    /// The faces in contact as a text.
    fn pairs(&self) -> String {
        let pairs: Vec<_> = self.faces.iter().map(|pair| pair.join("-")).collect();
        pairs.join(" ")
    }

    /// The rows of all states.
    pub fn all(design: &Design, analysis: &'a Analysis, names: &'a [String]) -> Vec<Self> {
        let states = analysis.inventory.states.iter();
        states
            .map(|state| Self::new(design, analysis, names, state))
            .collect()
    }
}

impl<Row> Column<Row> {
    fn new(
        places: [u8; 3],
        name: &'static str,
        unit: &'static str,
        heading: &'static str,
        get: fn(&Row) -> Cell,
    ) -> Self {
        Self {
            name,
            unit,
            heading,
            places,
            get,
        }
    }

    /// What files call it: the name, and its unit if it has one.
    pub fn key(&self) -> String {
        match self.unit {
            "" | "%" => self.name.to_owned(),
            unit => format!("{}_{unit}", self.name),
        }
    }
}

/// The columns of states that an output shows, in its order.
pub fn states<'a>(output: Output) -> Vec<Column<StateRow<'a>>> {
    shown(output, state_columns())
}

/// The columns of barriers that an output shows, in its order.
pub fn barriers(output: Output) -> Vec<Column<Barrier>> {
    shown(output, barrier_columns())
}

fn shown<Row>(output: Output, mut columns: Vec<Column<Row>>) -> Vec<Column<Row>> {
    let place = |column: &Column<Row>| column.places[output as usize];
    columns.retain(|column| place(column) > 0);
    columns.order_by_key(place);
    columns
}

// One line a column: places in CSV, JSON and on the page; name, unit, heading; how to get it.
#[rustfmt::skip]
fn state_columns<'a>() -> Vec<Column<StateRow<'a>>> {
    let c = Column::<StateRow>::new;
    vec![
        c([ 1,  1,  0], "id", "", "id", |s| value(s.state.id)),
        // What people call it: letters by depth.
        c([19, 13,  1], "name", "", "state", |s| value(s.name)),
        c([ 2,  2,  0], "kind", "", "kind", |s| value(kind(s.state.kind))),
        c([ 0,  0,  2], "kind", "", "kind", |s| value(if s.is_bound() { "bond" } else { "trap" })),
        // Lowest id among the states that symmetries of the tiles map onto this one.
        c([ 3,  6,  0], "class", "", "class", |s| value(s.state.class)),
        c([ 4,  7,  3], "copies", "", "copies", |s| value(s.copies)),
        c([ 0,  3,  0], "pose", "", "pose", |s| value(json!(pose(s.at)))),
        c([ 5,  0,  8], "x", "m", "x", |s| real(s.at.x)),
        c([ 6,  0,  9], "y", "m", "y", |s| real(s.at.y)),
        c([ 7,  0, 10], "theta", "rad", "\u{3b8}", |s| real(s.at.theta)),
        c([ 8,  4,  4], "energy", "J", "energy", |s| real(s.state.energy)),
        // To the nearest lower state or to free.
        c([ 9,  0,  5], "escape", "J", "way out", |s| s.out(|b| real(b.forward()))),
        c([10,  0,  0], "escape_to", "", "leads to", |s| s.out(goal)),
        c([ 0,  0,  6], "escape_to", "", "leads to", |s| s.out(goal_or_why)),
        // Proved that there is no way out at all.
        c([20,  0,  0], "caged", "", "caged", |s| value(s.is_caged())),
        c([ 0, 12,  0], "escape", "", "way out", |s| s.out(|b| value(object(&barriers(Output::Json), b)))),
        c([11,  0,  7], "capture_share", "%", "captured", |s| real(s.capture.map(|c| c.share()))),
        c([12,  0,  0], "capture_low", "%", "at least", |s| real(s.capture.map(|c| c.low))),
        c([13,  0,  0], "capture_high", "%", "at most", |s| real(s.capture.map(|c| c.high))),
        c([ 0, 11,  0], "capture", "", "captured", |s| value(s.capture.map(proportion))),
        // Magnet pairs close together.
        c([14,  9, 11], "attracting", "", "attracting", |s| value(s.state.attracting)),
        c([15, 10, 12], "repelling", "", "repelling", |s| value(s.state.repelling)),
        c([16,  0, 13], "faces", "", "faces", |s| value(s.pairs())),
        c([ 0,  8,  0], "faces", "", "faces", |s| value(json!(s.faces))),
        // Of uniformly magnetised blocks, where the other energies are those of point dipoles; and
        // how much higher the dipoles' is.
        c([17,  5,  0], "block_energy", "J", "as blocks", |s| real(s.state.block_energy)),
        c([18,  0,  0], "dipole_error", "J", "error", |s| real(s.state.dipole_error())),
    ]
}

#[rustfmt::skip]
fn barrier_columns() -> Vec<Column<Barrier>> {
    let c = Column::<Barrier>::new;
    vec![
        c([ 1,  1,  1], "from", "", "from", |b| Cell::Place(b.from)),
        c([ 2,  2,  2], "to", "", "to", |b| Cell::Place(b.to)),
        c([ 3,  3,  3], "saddle_energy", "J", "saddle", |b| real(b.saddle_energy)),
        c([ 4,  5,  4], "lower", "J", "at least", |b| real(b.bounds.lower)),
        c([ 5,  6,  5], "upper", "J", "at most", |b| real(b.bounds.upper)),
        // Proved that there is no way at all; the saddle energy is then infinite.
        c([14,  7,  0], "caged", "", "caged", |b| value(b.bounds.caged)),
        c([ 0,  0,  8], "caged", "", "no way", |b| value(why_no_way(b))),
        c([ 6,  8,  6], "forward", "J", "forward", |b| real(b.forward())),
        c([ 7,  9,  7], "reverse", "J", "reverse", |b| real(b.reverse())),
        // Lowest and highest saddle energy over repeated runs; null for a single run.
        c([ 8,  0,  0], "spread_low", "J", "lowest", |b| real(b.spread.map(|s| s.0))),
        c([ 9,  0,  0], "spread_high", "J", "highest", |b| real(b.spread.map(|s| s.1))),
        c([ 0, 10,  0], "spread_J", "", "spread", |b| value(json!(b.spread))),
        c([10,  0,  0], "x", "m", "x", |b| real(b.saddle.x)),
        c([11,  0,  0], "y", "m", "y", |b| real(b.saddle.y)),
        c([12,  0,  0], "theta", "rad", "\u{3b8}", |b| real(b.saddle.theta)),
        // Null where no way is known, as is the file of the pathway, relative to the report.
        c([ 0,  4,  0], "saddle_pose", "", "saddle", |b| value(passable(b).map(saddle))),
        c([13, 11,  0], "pathway", "", "pathway", |b| value(passable(b).map(pathway_file))),
        // Work against the energy along the pathway and back, and its length.
        c([15, 12,  9], "work", "J", "work", |b| real(b.work().map(|work| work[0]))),
        c([16, 13,  0], "reverse_work", "J", "back", |b| real(b.work().map(|work| work[1]))),
        c([17, 14, 10], "length", "m", "length", |b| real(b.length())),
    ]
}

/// Where it leads to, if a way over it is known.
fn goal(barrier: &Barrier) -> Cell {
    passable(barrier).map_or(value(Value::Null), |barrier| Cell::Place(barrier.to))
}

/// The same, or the word for why there is no way.
fn goal_or_why(barrier: &Barrier) -> Cell {
    why_no_way(barrier).map_or_else(|| goal(barrier), value)
}

/// Why a barrier has no way over it, if it has none.
pub fn why_no_way(barrier: &Barrier) -> Option<&'static str> {
    match barrier.has_way() {
        _ if barrier.bounds.caged => Some("caged, proved"),
        true => None,
        false => Some("none found"),
    }
}

/// Where its saddle is.
fn saddle(barrier: &Barrier) -> Value {
    json!(pose(&barrier.saddle))
}

/// The barrier itself if a way over it is known.
fn passable(barrier: &Barrier) -> Option<&Barrier> {
    barrier.has_way().then_some(barrier)
}

fn value(value: impl Into<Value>) -> Cell {
    Cell::Value(value.into())
}

fn real(value: impl Into<Option<f64>>) -> Cell {
    Cell::Real(value.into().unwrap_or(f64::NAN))
}

/// A row as an object.
pub fn object<Row>(columns: &[Column<Row>], row: &Row) -> Value {
    let cells = columns.iter().map(|column| {
        let value = match (column.get)(row) {
            Cell::Value(value) => value,
            Cell::Real(value) => json!(positive_zero(value)),
            Cell::Place(at) => place(at),
        };
        (column.key(), value)
    });
    Value::Object(cells.collect::<Map<_, _>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_of_an_output_is_taken_once() {
        fn check<Row>(columns: impl Fn(Output) -> Vec<Column<Row>>) {
            for output in [Output::Csv, Output::Json, Output::Page] {
                let columns = columns(output);
                let places = columns
                    .iter()
                    .map(|c| usize::from(c.places[output as usize]));
                assert!(places.eq(1..=columns.len()), "{output:?}");
            }
        }
        check(states);
        check(barriers);
    }
}
