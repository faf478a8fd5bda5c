//! The points of a sweep as a page's data.

use serde::Serialize;

use super::finite;
use crate::comparison::quantity::{Measure, Place, QUANTITIES, placed};
use crate::comparison::{Assessment, Quantity};
use crate::report::figures::cell;
use crate::report::plots::curve_data::{Content, contents};
use crate::report::sweep::Sweep;

/// What a page needs to draw curves and maps.
#[derive(Clone, Debug, Serialize)]
pub struct Charts {
    points: Vec<ChartPoint>,
    panels: Vec<ChartPanel>,
    curves: Vec<ChartCurves>,
    maps: Vec<ChartMap>,
}

/// A point of the sweep.
#[derive(Clone, Debug, Serialize)]
struct ChartPoint {
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
        let mut charts = Self {
            points: (0..sweep.points.len()).map(|k| point(sweep, k)).collect(),
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
    let measure = shown[0].measure;
    let shows = |known: &Quantity| shown.iter().any(|quantity| quantity.key == known.key);
    ChartPanel {
        heading: place.heading,
        unit: match measure {
            Measure::Share => "%",
            _ => measure.unit(),
        },
        figures: (0..QUANTITIES.len())
            .filter(|&k| shows(&QUANTITIES[k]))
            .collect(),
    }
}

fn point(sweep: &Sweep, index: usize) -> ChartPoint {
    let called = sweep.called(&sweep.points[index]);
    match sweep.assessment(index) {
        Some(assessment) => ChartPoint {
            readout: format!("{called}: {}", readout(assessment)),
            figures: QUANTITIES.iter().map(|q| figure(q, assessment)).collect(),
        },
        None => ChartPoint {
            readout: format!("{called}: {}", sweep.reason(index).unwrap_or_default()),
            figures: Vec::new(),
        },
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
