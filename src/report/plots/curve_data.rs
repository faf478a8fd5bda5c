//! What the pictures of a sweep show: its points sorted into series over one or two numbers.

use super::curve_names::{Common, LENGTHS, common, file, titled};
use super::style::Axis;
use super::{curve_map, curves};
use crate::document::Drawing;
use crate::sweep::Sweep;
use jobs::comparison::Assessment;
use jobs::sweep::{Point, Value};
use ordered_float::OrderedFloat;
use physics::order::Order;

/// Most pictures of a sweep.
const MOST_PICTURES: usize = 24;

/// A varied number.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Which of the plan's axes.
    pub axis: usize,
    /// Its key in the design.
    pub key: String,
    /// From the lowest, two at least.
    pub values: Vec<f64>,
}

impl Variable {
    /// What the numbers of the file are multiplied by on an axis, and its name.
    pub fn shown(&self) -> (f64, String) {
        let mut parts = self.key.rsplit('.');
        let mut last = parts.next().unwrap_or_default().to_owned();
        if last.parse::<usize>().is_ok() {
            // An item of an array.
            last = format!("{} {last}", parts.next().unwrap_or_default());
        }
        let word = last.split(' ').next().unwrap_or_default();
        if LENGTHS.contains(&word) {
            (1e3, format!("{last} (mm)"))
        } else {
            (1.0, last)
        }
    }

    /// What a point has of it.
    pub fn value(&self, point: &Point) -> Option<f64> {
        point.values[self.axis].number()
    }

    /// The axis, a little longer than the numbers.
    pub fn axis(&self) -> Axis {
        let (factor, name) = self.shown();
        let (low, high) = (self.values[0], self.values[self.values.len() - 1]);
        let room = 0.03 * (high - low);
        Axis::linear(factor * (low - room)..factor * (high + room), 6, name)
    }
}

/// One curve: what came of each point over the varied number.
#[derive(Clone, Debug)]
pub struct Series<'a> {
    /// What the legend calls it.
    pub name: String,
    /// Its points, in the order of the varied number.
    pub points: Vec<CurvePoint<'a>>,
}

/// A point of a curve.
#[derive(Clone, Copy, Debug)]
pub struct CurvePoint<'a> {
    /// The varied number, as the axis shows it.
    pub x: f64,
    /// Place of the point in the sweep.
    pub index: usize,
    /// `None` where the design is impossible.
    pub result: Option<&'a Assessment>,
}

/// The content of a picture of curves.
#[derive(Clone, Debug)]
pub struct Group<'a> {
    /// What the page calls it.
    pub title: String,
    /// A curve each.
    pub series: Vec<Series<'a>>,
    /// Series that found no place.
    pub left_out: usize,
}

/// The content of a picture of maps.
#[derive(Clone, Debug)]
pub struct Map {
    /// What the page calls it.
    pub title: String,
    /// What varies to the right.
    pub x: Variable,
    /// What varies upwards.
    pub y: Variable,
    /// Places of the points in the sweep, row by row from the lowest; `None` where there is no such
    /// point.
    pub cells: Vec<Option<usize>>,
}

/// What a picture shows.
#[derive(Clone, Debug)]
pub enum Content<'a> {
    /// Over one varied number.
    Curves(Variable, Group<'a>),
    /// Over two.
    Map(Map),
}

/// The pictures of a sweep: curves where one number is varied, maps where two are; none otherwise.
/// Everything else that is varied tells series and pictures apart. The page draws its own.
pub fn drawings<'a>(sweep: &'a Sweep) -> Vec<Drawing<'a>> {
    let draw = |(name, content): (String, Content<'a>)| match content {
        Content::Curves(variable, group) => Drawing::new(group.title.clone(), move |sheet| {
            curves::draw(&name, &group, &variable, sheet)
        }),
        Content::Map(map) => Drawing::new(map.title.clone(), move |sheet| {
            let results = map.cells.iter();
            let results = results.map(|cell| cell.map(|index| sweep.assessment(index)));
            curve_map::draw(&name, &map, &results.collect::<Vec<_>>(), sheet)
        }),
    };
    let all = contents(sweep).into_iter().map(draw);
    all.map(Drawing::off_page).collect()
}

/// What the pictures show, by the stems of their files.
pub fn contents<'a>(sweep: &'a Sweep) -> Vec<(String, Content<'a>)> {
    let numbers = variables(sweep);
    let fixed: Vec<usize> = (0..sweep.plan.axes.len())
        .filter(|axis| numbers.iter().all(|number| number.axis != *axis))
        .collect();
    let mut groups: Vec<(Common, Vec<&Point>)> = Vec::new();
    for point in &sweep.points {
        let common = common(sweep, point, &fixed);
        match groups.iter_mut().find(|(known, _)| *known == common) {
            Some((_, points)) => points.push(point),
            None => groups.push((common, vec![point])),
        }
    }
    match &numbers[..] {
        [number] => curves_of(sweep, number, &groups),
        [x, y] => groups
            .iter()
            .take(MOST_PICTURES)
            .map(|(common, points)| {
                let map = Map {
                    title: titled(sweep, common),
                    x: x.clone(),
                    y: y.clone(),
                    cells: cells(points, x, y),
                };
                (file("map", common), Content::Map(map))
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// A group for each value of all but the first word that is varied, a series for each value of
/// that first one.
fn curves_of<'a>(
    sweep: &'a Sweep,
    number: &Variable,
    groups: &[(Common, Vec<&Point>)],
) -> Vec<(String, Content<'a>)> {
    let mut pictures: Vec<(Common, Vec<Series>)> = Vec::new();
    for (common, points) in groups {
        let (name, rest) = match common.split_first() {
            Some((first, rest)) => (first.1.clone(), rest.to_vec()),
            None => (String::new(), Vec::new()),
        };
        let points = points.iter().map(|point| {
            let value = point.values[number.axis].number().unwrap_or(f64::NAN);
            CurvePoint {
                x: number.shown().0 * value,
                index: point.index,
                result: sweep.assessment(point.index),
            }
        });
        let mut points: Vec<_> = points.collect();
        points.order_by_key(|point| OrderedFloat(point.x));
        let series = Series { name, points };
        match pictures.iter_mut().find(|(known, _)| *known == rest) {
            Some((_, all)) => all.push(series),
            None => pictures.push((rest, vec![series])),
        }
    }
    pictures
        .into_iter()
        .take(MOST_PICTURES)
        .map(|(rest, mut series)| {
            let left_out = series.len().saturating_sub(curves::MOST_SERIES);
            series.truncate(curves::MOST_SERIES);
            let group = Group {
                title: titled(sweep, &rest),
                series,
                left_out,
            };
            (
                file("curves", &rest),
                Content::Curves(number.clone(), group),
            )
        })
        .collect()
}

/// The axes along which more than one number is varied.
pub fn variables(sweep: &Sweep) -> Vec<Variable> {
    let axes = sweep.plan.axes.iter().enumerate();
    axes.filter_map(|(axis, varied)| {
        let values: Option<Vec<f64>> = varied.values.iter().map(Value::number).collect();
        let mut values = values?;
        values.order_by(f64::total_cmp);
        values.dedup();
        (values.len() > 1).then(|| Variable {
            axis,
            key: varied.key.clone(),
            values,
        })
    })
    .collect()
}

/// The points of a map by their places in the sweep.
fn cells(points: &[&Point], x: &Variable, y: &Variable) -> Vec<Option<usize>> {
    let mut cells = vec![None; x.values.len() * y.values.len()];
    for point in points {
        let place = |variable: &Variable| {
            let value = point.values[variable.axis].number()?;
            variable.values.iter().position(|known| *known == value)
        };
        if let (Some(i), Some(j)) = (place(x), place(y)) {
            cells[j * x.values.len() + i] = Some(point.index);
        }
    }
    cells
}
