//! The points of a sweep as a page's data.

use serde::Serialize;

use super::finite;
use crate::comparison::{Assessment, Quantity};
use crate::report::figures::cell;
use crate::report::plots::curve_data::{Content, contents};
use crate::report::plots::curves::panels;
use crate::report::sweep::Sweep;

/// What a page needs to draw curves and maps.
#[derive(Clone, Debug, Serialize)]
pub struct Charts {
    points: Vec<Point>,
    panels: Vec<Panel>,
    curves: Vec<Curves>,
    maps: Vec<Map>,
}

/// A point of the sweep.
#[derive(Clone, Debug, Serialize)]
struct Point {
    /// What is said of it under the pointer.
    told: String,
    /// Of each figure the value and its bounds (SI), a value of null where there is no way at all;
    /// null where the figure is not known. None at all for an impossible design.
    figures: Vec<Option<[Option<f64>; 3]>>,
}

#[derive(Clone, Debug, Serialize)]
struct Panel {
    heading: &'static str,
    /// SI unit, or `%` for a share.
    unit: &'static str,
    /// Which of a point's figures.
    figures: Vec<usize>,
}

#[derive(Clone, Debug, Serialize)]
struct Curves {
    title: String,
    /// The axis' name with its unit.
    axis: String,
    series: Vec<Series>,
}

#[derive(Clone, Debug, Serialize)]
struct Series {
    name: String,
    /// Place on the axis, and number of the point.
    points: Vec<(f64, usize)>,
}

#[derive(Clone, Debug, Serialize)]
struct Map {
    title: String,
    axes: [String; 2],
    x: Vec<f64>,
    y: Vec<f64>,
    /// Numbers of points row by row from the lowest.
    cells: Vec<Option<usize>>,
}

impl Charts {
    pub fn new(sweep: &Sweep) -> Self {
        let mut charts = Self {
            points: (0..sweep.points.len()).map(|k| point(sweep, k)).collect(),
            panels: panels().map(|(heading, of)| panel(heading, of)).collect(),
            curves: Vec::new(),
            maps: Vec::new(),
        };
        for (_, content) in contents(sweep) {
            match content {
                Content::Curves(variable, group) => charts.curves.push(Curves {
                    title: group.title,
                    axis: variable.shown().1,
                    series: group
                        .series
                        .into_iter()
                        .map(|series| Series {
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
                    charts.maps.push(Map {
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

fn panel(heading: &'static str, of: &[Quantity]) -> Panel {
    Panel {
        heading,
        unit: match of {
            [Quantity::Captured] => "%",
            _ => of[0].unit(),
        },
        figures: of
            .iter()
            .filter_map(|q| Quantity::ALL.iter().position(|known| known == q))
            .collect(),
    }
}

fn point(sweep: &Sweep, index: usize) -> Point {
    let called = sweep.called(&sweep.points[index]);
    match sweep.assessment(index) {
        Some(assessment) => Point {
            told: format!("{called}: {}", told(assessment)),
            figures: Quantity::ALL.map(|q| figure(q, assessment)).to_vec(),
        },
        None => Point {
            told: format!("{called}: {}", sweep.reason(index).unwrap_or_default()),
            figures: Vec::new(),
        },
    }
}

fn figure(quantity: Quantity, assessment: &Assessment) -> Option<[Option<f64>; 3]> {
    let estimate = quantity.of(assessment)?;
    let number = |value: Option<f64>| value.and_then(|value| finite(value, 6));
    Some([
        number(Some(estimate.value)),
        number(estimate.low),
        number(estimate.high),
    ])
}

fn told(assessment: &Assessment) -> String {
    [
        Quantity::BondDepth,
        Quantity::TrapDepth,
        Quantity::Unbinding,
        Quantity::Captured,
    ]
    .map(|quantity| format!("{} {}", quantity.label(), cell(quantity, assessment)))
    .join(", ")
}
