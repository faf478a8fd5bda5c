//! The points of a sweep as data of the page.

use serde::Serialize;

use super::finite;
use super::thumbnail::Thumbnail;
use crate::figures::cell;
use crate::sweep::Sweep;
use crate::sweep::points::Variable;
use jobs::comparison::quantity::{Measure, NO_TRAPS, QUANTITIES};
use jobs::comparison::{Assessment, Quantity};

/// What a page needs to tell of points and to draw a figure of them against another.
#[derive(Clone, Debug, Serialize)]
pub struct Charts {
    /// The varied numbers, with their units.
    axes: Vec<String>,
    /// All figures, in the order in which points have them.
    figures: Vec<ChartFigure>,
    /// The tiles of points; none where there are many points.
    tiles: Vec<Thumbnail>,
    points: Vec<ChartPoint>,
    /// The point that all are set against at first.
    baseline: Option<usize>,
}

/// A figure that can be chosen.
#[derive(Clone, Debug, Serialize)]
struct ChartFigure {
    label: &'static str,
    /// SI unit, or `%` for a share.
    unit: &'static str,
}

/// A point of the sweep.
#[derive(Clone, Debug, Serialize)]
struct ChartPoint {
    /// What it is called.
    name: String,
    /// What it has in common with others, but for the varied numbers.
    series: String,
    /// Its places on the axes; null where it is not a number.
    places: Vec<Option<f64>>,
    /// Which of the tiles are its own.
    tiles: Option<usize>,
    /// The file of its design beside the page.
    design: Option<String>,
    /// The figures that it has not for want of a trap.
    without: Vec<usize>,
    /// What is said of it under the pointer.
    readout: String,
    /// Of each figure the value and its bounds (SI), a value of null where there is no way at all;
    /// null where the figure is not known. None at all for an impossible design.
    figures: Vec<Option<[Option<f64>; 3]>>,
}

impl Charts {
    /// The charts of a finished sweep.
    pub fn new(sweep: &Sweep) -> Self {
        let variables = sweep.variables();
        let mut tiles = Vec::new();
        let points = 0..sweep.points.len();
        let points = points.map(|k| point(sweep, k, &variables, &mut tiles));
        Self {
            points: points.collect(),
            axes: variables.iter().map(|axis| axis.shown().1).collect(),
            figures: QUANTITIES
                .iter()
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

/// Without the dust of a change of unit.
fn tidy(value: f64) -> f64 {
    super::rounded(value, 9)
}

fn point(
    sweep: &Sweep,
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
        figures: QUANTITIES.iter().map(|q| figure(q, assessment)).collect(),
        without: (0..QUANTITIES.len())
            .filter(|&k| lacks(&QUANTITIES[k]))
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
