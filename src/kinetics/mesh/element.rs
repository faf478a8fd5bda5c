//! What is integrated over a cell: e^(-U/kT) times products of shape functions' gradients.

use nalgebra::{Matrix3, Vector3};

use super::chart::Chart;
use super::octree::Leaf;
use crate::configuration::Configuration;
use crate::contact::cells::{CellContact, ContactCells};
use crate::interruption;
use crate::problem::Problem;

/// Weights are kept between these powers of e about the level of the barriers: below them no flux
/// goes, and above them all is in equilibrium anyway.
const GREATEST: f64 = 16.0;
const LEAST: f64 = -32.0;
/// Powers of e beyond which loads, which nothing holds in bounds, are no numbers any more.
const FARTHEST: f64 = 700.0;

/// The integrals over the free part of a cell, its eight corners numbered as in [`Leaf::corner`].
#[derive(Clone, Debug)]
pub(in crate::kinetics) struct Element {
    /// Of w grad(i) . grad(j), the upper triangle row by row (rad), the weight w kept in bounds.
    pub stiffness: [f64; 36],
    /// Of w, kept in bounds (m^2 rad).
    pub weight: f64,
    /// Of w times each shape function (m^2 rad).
    pub load: [f64; 8],
    /// The least U met (J).
    pub lowest: f64,
}

impl Element {
    /// The entry of the stiffness for two corners.
    pub fn entry(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        self.stiffness[i * 8 - i * (i + 1) / 2 + j]
    }

    /// The stiffness times values at the corners.
    pub fn times(&self, values: &[f64; 8]) -> [f64; 8] {
        std::array::from_fn(|i| (0..8).map(|j| self.entry(i, j) * values[j]).sum())
    }
}

/// The two points of Gauss on [0, 1].
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Looks at the clearance along a line through a cell.
const LOOKS: usize = 6;
/// Halvings that find where contact begins.
const HALVINGS: usize = 14;
/// Change of U/kT across a panel of a line, at most ...
const PANEL: f64 = 1.2;
/// ... unless there would be more panels.
const PANELS: f64 = 24.0;
/// Part of a cell's face is halved where the integrals along its lines differ by more than this
/// power of e ...
const UNEVEN: f64 = 1.0;
/// ... so often at most in cells of the smallest sizes and less often in larger ones, which will be
/// divided where it matters, or so often where some of the lines are blocked, ...
const MOST_HALVED: usize = 6;
const MOST_CUT: usize = 3;
/// Halvings before lines that are all blocked are believed.
const LEAST_CUT: usize = 2;
/// ... and where the mean weight or load along one of them is above this.
const MATTERS: f64 = 1e-3;

/// Integrates over cells at one temperature.
pub(in crate::kinetics) struct Integrator<'a> {
    problem: &'a Problem,
    contact: Option<ContactCells>,
    /// kT (J).
    kt: f64,
    /// The energy (J) at which weights are 1.
    pub level: f64,
    /// The energy (J) at which loads are 1.
    pub ground: f64,
}

/// The free parts of a line through a cell along r.
struct Line {
    /// Where it crosses the cell's face, in parts of phi's and theta's sizes.
    at: [f64; 2],
    /// Points of the integral along it: part of r's size, share of it, weight and load.
    points: Vec<(f64, f64, [f64; 2])>,
    /// The integrals of weight and load.
    sums: [f64; 2],
}

impl<'a> Integrator<'a> {
    pub fn new(problem: &'a Problem, kt: f64, level: f64, ground: f64) -> Self {
        Self {
            problem,
            contact: problem.contact.as_ref().map(ContactCells::new),
            kt,
            level,
            ground,
        }
    }

    /// The integrals over a cell, and whether it is proved blocked.
    pub fn integrate(&self, chart: &Chart, leaf: &Leaf) -> (Option<Box<Element>>, bool) {
        interruption::check();
        let contact = self.contact.as_ref();
        let found = contact.map(|cells| cells.classify(&chart.around(leaf.low, leaf.level)));
        let cut = match found {
            None => false,
            Some(CellContact::Blocked) => return (None, true),
            Some(CellContact::Open {
                cuts,
                corners,
                depth,
            }) => !(cuts.is_empty() && corners.is_empty() && depth == 0.0),
        };
        let mut sum = Sum {
            chart,
            leaf,
            element: Element {
                stiffness: [0.0; 36],
                weight: 0.0,
                load: [0.0; 8],
                lowest: f64::INFINITY,
            },
        };
        self.fill(&mut sum, [[0.0, 1.0]; 2], cut, 0);
        let element = sum.element;
        ((element.weight > 0.0).then(|| Box::new(element)), false)
    }

    /// Adds the integrals along lines through a part of the face, given by its ends in phi and
    /// theta.
    fn fill(&self, sum: &mut Sum, face: [[f64; 2]; 2], cut: bool, halved: usize) {
        let place = |axis: usize, k: usize| {
            let [from, to] = face[axis];
            from + GAUSS[k] * (to - from)
        };
        let lines: [Line; 4] =
            std::array::from_fn(|k| self.line(sum, [place(0, k & 1), place(1, k >> 1)], cut));
        if let Some(axis) = uneven(&lines, cut, sum.leaf.level, halved) {
            let [from, to] = face[axis];
            let middle = 0.5 * (from + to);
            for ends in [[from, middle], [middle, to]] {
                let mut half = face;
                half[axis] = ends;
                self.fill(sum, half, cut, halved + 1);
            }
            return;
        }
        let share = face.iter().map(|[from, to]| to - from).product::<f64>() / 4.0;
        for line in &lines {
            for &(u, width, weights) in &line.points {
                let part = [u, line.at[0], line.at[1]];
                let metric = self.problem.mass_metric(sum.coordinates(part)[2]);
                let inverse = metric.try_inverse().unwrap_or_else(Matrix3::identity);
                sum.add(part, &inverse, share * width, weights);
            }
        }
    }

    /// A line through a cell.
    fn line(&self, sum: &mut Sum, at: [f64; 2], cut: bool) -> Line {
        let mut line = Line {
            at,
            points: Vec::new(),
            sums: [0.0; 2],
        };
        for [from, to] in self.free_parts(sum, at, cut) {
            self.extend(sum, &mut line, [from, to]);
        }
        line
    }

    /// The free parts of a line.
    fn free_parts(&self, sum: &Sum, [v, w]: [f64; 2], cut: bool) -> Vec<[f64; 2]> {
        if !cut {
            return vec![[0.0, 1.0]];
        }
        let is_free = |u: f64| self.problem.is_clear(&sum.configuration([u, v, w]));
        let mut parts = Vec::new();
        let mut before = (0.0, is_free(0.0));
        let mut since = 0.0;
        for look in 1..=LOOKS {
            let here = look as f64 / LOOKS as f64;
            let here = (here, is_free(here));
            if here.1 != before.1 {
                let edge = edge(&is_free, before, here.0);
                if here.1 {
                    since = edge;
                } else {
                    parts.push([since, edge]);
                }
            }
            before = here;
        }
        if before.1 {
            parts.push([since, 1.0]);
        }
        parts
    }

    /// Adds a free part to a line.
    fn extend(&self, sum: &mut Sum, line: &mut Line, [from, to]: [f64; 2]) {
        let place = |u: f64| sum.configuration([u, line.at[0], line.at[1]]);
        let potential = self.problem.potential();
        let mut ends = [0.0; 3];
        potential.energies(&[from, 0.5 * (from + to), to].map(place), &mut ends);
        let change = (ends[0] - ends[1]).abs().max((ends[1] - ends[2]).abs()) / self.kt;
        let panels = (2.0 * change / PANEL).ceil().clamp(1.0, PANELS);
        let width = (to - from) / panels;
        let us: Vec<f64> = (0..panels as usize)
            .flat_map(|panel| GAUSS.map(|t| from + (panel as f64 + t) * width))
            .collect();
        let qs: Vec<Configuration> = us.iter().map(|&u| place(u)).collect();
        let mut energies = vec![0.0; qs.len()];
        potential.energies(&qs, &mut energies);
        sum.element.lowest = ends.iter().copied().fold(sum.element.lowest, f64::min);
        for (u, energy) in us.into_iter().zip(energies) {
            let above = |level: f64| (level - energy) / self.kt;
            let weights = [
                above(self.level).clamp(LEAST, GREATEST).exp(),
                above(self.ground).min(FARTHEST).exp(),
            ];
            for (sum, weight) in line.sums.iter_mut().zip(weights) {
                *sum += weight * width / 2.0;
            }
            line.points.push((u, width / 2.0, weights));
        }
    }
}

/// Where a line enters or leaves what is free, between a place of which that is known and one where
/// it is otherwise.
fn edge(is_free: &dyn Fn(f64) -> bool, (mut from, free): (f64, bool), mut to: f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        if is_free(middle) == free {
            from = middle;
        } else {
            to = middle;
        }
    }
    0.5 * (from + to)
}

/// The coordinate, phi or theta, along which four lines differ too much to stand for all between
/// them.
fn uneven(lines: &[Line; 4], cut: bool, level: u8, halved: usize) -> Option<usize> {
    if cut && halved < LEAST_CUT && lines.iter().all(|line| line.points.is_empty()) {
        return Some(halved % 2);
    }
    let mut steps = [0.0_f64; 2];
    for which in 0..2 {
        let sum = |k: usize| lines[k].sums[which];
        if (0..4).map(sum).fold(0.0, f64::max) < MATTERS {
            continue;
        }
        for (axis, step) in steps.iter_mut().enumerate() {
            for k in (0..4).filter(|k| k >> axis & 1 == 0) {
                let [a, b] = [sum(k), sum(k | 1 << axis)];
                let change = match a.min(b) > 0.0 {
                    true => (a / b).ln().abs(),
                    false if a.max(b) > 0.0 && halved < MOST_CUT => f64::MAX,
                    false => 0.0,
                };
                *step = step.max(change);
            }
        }
    }
    let axis = if steps[0] > steps[1] { 0 } else { 1 };
    let most = MOST_HALVED.min(2 * usize::from(level));
    (steps[axis] > UNEVEN && halved < most).then_some(axis)
}

/// A cell's integrals as they grow.
struct Sum<'a> {
    chart: &'a Chart,
    leaf: &'a Leaf,
    element: Element,
}

impl Sum<'_> {
    fn coordinates(&self, part: [f64; 3]) -> [f64; 3] {
        let size = self.leaf.size() as f64;
        self.chart.coordinates(std::array::from_fn(|i| {
            self.leaf.low[i] as f64 + part[i] * size
        }))
    }

    fn configuration(&self, part: [f64; 3]) -> Configuration {
        let [r, phi, theta] = self.coordinates(part);
        Configuration::new(r * phi.cos(), r * phi.sin(), theta)
    }

    /// Adds a point with the inverse of the mass metric there, its share of the cell and its weights,
    /// the one kept in bounds and the other not.
    fn add(&mut self, part: [f64; 3], inverse: &Matrix3<f64>, share: f64, weights: [f64; 2]) {
        let [r, phi, _] = self.coordinates(part);
        let size = self.chart.size(self.leaf.level);
        let volume = share * r * size[0] * size[1] * size[2];
        // Gradients by x, y and theta of the parts of r, phi and theta.
        let (sin, cos) = phi.sin_cos();
        let by = Matrix3::from_columns(&[
            Vector3::new(cos, sin, 0.0) / size[0],
            Vector3::new(-sin, cos, 0.0) / (r * size[1]),
            Vector3::new(0.0, 0.0, 1.0 / size[2]),
        ]);
        let metric = by.transpose() * inverse * by * (weights[0] * volume);
        let gradients = gradients(part);
        let flows = gradients.map(|gradient| metric * gradient);
        let mut entry = 0;
        for i in 0..8 {
            for flow in &flows[i..] {
                self.element.stiffness[entry] += gradients[i].dot(flow);
                entry += 1;
            }
        }
        self.element.weight += weights[0] * volume;
        for (load, shape) in self.element.load.iter_mut().zip(shapes(part)) {
            *load += weights[1] * volume * shape;
        }
    }
}

/// The shape functions of the corners at a point of the cell, given in parts of its size.
pub(in crate::kinetics) fn shapes(part: [f64; 3]) -> [f64; 8] {
    std::array::from_fn(|number| {
        (0..3)
            .map(|i| {
                if number >> i & 1 == 1 {
                    part[i]
                } else {
                    1.0 - part[i]
                }
            })
            .product()
    })
}

/// Their gradients by the parts.
pub(in crate::kinetics) fn gradients(part: [f64; 3]) -> [Vector3<f64>; 8] {
    std::array::from_fn(|number| {
        let value = |i: usize| {
            if number >> i & 1 == 1 {
                part[i]
            } else {
                1.0 - part[i]
            }
        };
        let slope = |i: usize| if number >> i & 1 == 1 { 1.0 } else { -1.0 };
        Vector3::new(
            slope(0) * value(1) * value(2),
            value(0) * slope(1) * value(2),
            value(0) * value(1) * slope(2),
        )
    })
}
