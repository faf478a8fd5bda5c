//! The points of a sweep as a page's data.

use serde::Serialize;

use super::finite;
use super::thumbnail::Thumbnail;
use crate::figures::cell;
use crate::plots::curve_data::{Content, Variable, contents, variables};
use crate::plots::curve_names::series_name;
use crate::sweep::Sweep;
use jobs::comparison::quantity::{Measure, NO_TRAPS, Place, QUANTITIES, placed};
use jobs::comparison::{Assessment, Quantity};

/// What a page needs to draw curves and maps.
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
    panels: Vec<ChartPanel>,
    curves: Vec<ChartCurves>,
    maps: Vec<ChartMap>,
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

#[derive(Clone, Debug, Serialize)]
struct ChartPanel {
    heading: &'static str,
    /// SI unit, or `%` for a share.
    unit: &'static str,
    /// Which of a point's figures.
    figures: Vec<usize>,
}

#[derive(Clone, Debug, Serialize)]
struct ChartCurves {
    title: String,
    /// The axis' name with its unit.
    axis: String,
    series: Vec<ChartSeries>,
}

#[derive(Clone, Debug, Serialize)]
struct ChartSeries {
    name: String,
    /// Place on the axis, and number of the point.
    points: Vec<(f64, usize)>,
}

#[derive(Clone, Debug, Serialize)]
struct ChartMap {
    title: String,
    axes: [String; 2],
    x: Vec<f64>,
    y: Vec<f64>,
    /// Numbers of points row by row from the lowest.
    cells: Vec<Option<usize>>,
}

impl Charts {
    /// The charts of a finished sweep.
    pub fn new(sweep: &Sweep) -> Self {
        let panels = placed(|quantity| quantity.panel).into_iter();
        let variables = variables(sweep);
        let mut tiles = Vec::new();
        let points = 0..sweep.points.len();
        let points = points.map(|k| point(sweep, k, &variables, &mut tiles));
        let mut charts = Self {
            points: points.collect(),
            axes: variables.iter().map(|axis| axis.shown().1).collect(),
            figures: QUANTITIES
                .iter()
                .map(|quantity| ChartFigure {
                    label: quantity.label,
                    unit: unit(quantity),
                })
                .collect(),
            tiles,
            baseline: sweep.baseline(),
            panels: panels.map(|(place, shown)| panel(place, &shown)).collect(),
            curves: Vec::new(),
            maps: Vec::new(),
        };
        for (_, content) in contents(sweep) {
            match content {
                Content::Curves(variable, group) => charts.curves.push(ChartCurves {
                    title: group.title,
                    axis: variable.shown().1,
                    series: group
                        .series
                        .into_iter()
                        .map(|series| ChartSeries {
                            name: series.name,
                            points: series.points.iter().map(|p| (tidy(p.x), p.index)).collect(),
                        })
                        .collect(),
                }),
                Content::Map(map) => {
                    let [x, y] = [&map.x, &map.y].map(|variable| {
                        let factor = variable.shown().0;
                        variable.values.iter().map(|v| tidy(factor * v)).collect()
                    });
                    charts.maps.push(ChartMap {
                        title: map.title,
                        axes: [map.x.shown().1, map.y.shown().1],
                        x,
                        y,
                        cells: map.cells,
                    });
                }
            }
        }
        charts
    }
}

/// Without the dust of a change of unit.
fn tidy(value: f64) -> f64 {
    super::rounded(value, 9)
}

fn panel(place: Place, shown: &[&Quantity]) -> ChartPanel {
    let shows = |known: &Quantity| shown.iter().any(|quantity| quantity.key == known.key);
    ChartPanel {
        heading: place.heading,
        unit: unit(shown[0]),
        figures: (0..QUANTITIES.len())
            .filter(|&k| shows(&QUANTITIES[k]))
            .collect(),
    }
}

fn unit(quantity: &Quantity) -> &'static str {
    match quantity.measure {
        Measure::Share => "%",
        measure => measure.unit(),
    }
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
    let plain = ChartPoint {
        series: series_name(sweep, point),
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
