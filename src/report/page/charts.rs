//! The points of a sweep as data of the page.

use serde::Serialize;

use super::numbers::{finite, rounded};
use super::thumbnail::Thumbnail;
use crate::figures::cell;
use crate::points::FinishedSweep;
use crate::points::Variable;
use jobs::comparison::quantity::{Measure, NO_TRAPS, QUANTITIES};
use jobs::comparison::{Assessment, Quantity};

/// The data for plotting figures of points against each other.
#[derive(Clone, Debug, Serialize)]
pub struct Charts {
    /// The varied numbers, with their units.
    axes: Vec<String>,
    /// All figures, in the order of the points' values.
    figures: Vec<ChartFigure>,
    /// The tiles of points; empty if there are many points.
    tiles: Vec<Thumbnail>,
    points: Vec<ChartPoint>,
    /// The initial baseline point.
    baseline: Option<usize>,
}

/// A selectable figure.
#[derive(Clone, Debug, Serialize)]
struct ChartFigure {
    label: &'static str,
    /// SI unit, or `%` for a share.
    unit: &'static str,
}

/// A point of the sweep.
#[derive(Clone, Debug, Serialize)]
struct ChartPoint {
    /// Its name.
    name: String,
    /// The series it belongs to: all points that differ only in the varied numbers.
    series: String,
    /// Its coordinates on the axes; null if it is not a number.
    places: Vec<Option<f64>>,
    /// The index of its tiles.
    tiles: Option<usize>,
    /// The file of its design beside the page.
    design: Option<String>,
    /// The figures that are missing because there is no trap.
    without: Vec<usize>,
    /// The text under the pointer.
    readout: String,
    /// For each figure the value and its bounds (SI), with a value of null if there is no path at
    /// all; null if the figure is not known. Empty for an impossible design.
    figures: Vec<Option<[Option<f64>; 3]>>,
}

impl Charts {
    /// The charts of a finished sweep.
    pub fn new(sweep: &FinishedSweep) -> Self {
        let variables = sweep.variables();
        let mut tiles = Vec::new();
        let points = 0..sweep.points.len();
        let points = points.map(|k| point(sweep, k, &variables, &mut tiles));
        Self {
            points: points.collect(),
            axes: variables.iter().map(|axis| axis.shown().1).collect(),
            figures: drawn()
                .map(|quantity| ChartFigure {
                    label: quantity.label,
                    unit: match quantity.measure {
                        Measure::Share => "%",
                        measure => measure.unit(),
                    },
                })
                .collect(),
            tiles,
            baseline: sweep.baseline(),
        }
    }
}

/// The figures of the charts.
fn drawn() -> impl Iterator<Item = &'static Quantity> {
    QUANTITIES.iter().filter(|quantity| !quantity.is_asked_for)
}

/// Removes rounding errors of a change of unit.
fn tidy(value: f64) -> f64 {
    rounded(value, 9)
}

fn point(
    sweep: &FinishedSweep,
    index: usize,
    variables: &[Variable],
    tiles: &mut Vec<Thumbnail>,
) -> ChartPoint {
    let point = &sweep.points[index];
    let name = sweep.called(point);
    let place = |axis: &Variable| Some(tidy(axis.shown().0 * axis.value(point)?));
    let words = sweep.common(point, variables).into_iter();
    let words: Vec<String> = words.map(|(_, value)| value).collect();
    let plain = ChartPoint {
        series: words.join(", "),
        places: variables.iter().map(place).collect(),
        tiles: None,
        design: sweep.design_file(point),
        without: Vec::new(),
        readout: format!("{name}: {}", sweep.reason(index).unwrap_or_default()),
        figures: Vec::new(),
        name,
    };
    let Some(assessment) = sweep.assessment(index) else {
        return plain;
    };
    let lacks = |quantity: &Quantity| (quantity.read)(assessment).err() == Some(NO_TRAPS);
    ChartPoint {
        readout: format!("{}: {}", plain.name, readout(assessment)),
        figures: drawn().map(|q| figure(q, assessment)).collect(),
        without: drawn()
            .enumerate()
            .filter(|(_, quantity)| lacks(quantity))
            .map(|(k, _)| k)
            .collect(),
        tiles: Thumbnail::of(sweep, point).map(|thumbnail| {
            let known = tiles.iter().position(|known| *known == thumbnail);
            known.unwrap_or_else(|| {
                tiles.push(thumbnail);
                tiles.len() - 1
            })
        }),
        ..plain
    }
}

fn figure(quantity: &Quantity, assessment: &Assessment) -> Option<[Option<f64>; 3]> {
    let numbers = quantity.of(assessment)?.finite();
    Some(numbers.map(|number| number.and_then(|value| finite(value, 6))))
}

fn readout(assessment: &Assessment) -> String {
    let shown = QUANTITIES.iter().filter(|quantity| quantity.in_readout);
    let shown = shown.map(|one| format!("{} {}", one.label, cell(&[one], assessment)));
    shown.collect::<Vec<_>>().join(", ")
}
