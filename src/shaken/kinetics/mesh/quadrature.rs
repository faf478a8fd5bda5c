//! Integrals over the free part of a cell. Lines along s are integrated one by one: contact is
//! located very precisely and the steps adapt to the energy. The lines are as dense as their
//! differences require.

use nalgebra::Matrix3;

use super::chart::Chart;
use super::element::{Element, QuadraturePoint};
use super::octree::Leaf;
use tiles::configuration::Configuration;
use tiles::contact::cells::ContactCells;
use tiles::interruption;
use tiles::problem::Problem;

/// Weights are limited to this power of e around the level of the barriers: smaller weights carry
/// no flux, and regions with larger ones are in equilibrium anyway.
const GREATEST: f64 = 16.0;
const LEAST: f64 = -32.0;
/// Powers of e beyond which loads, which are not limited, would overflow.
const FARTHEST: f64 = 700.0;

/// The two points of Gauss on [0, 1].
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Largest change of U/kT across a panel of a line ...
const PANEL: f64 = 1.2;
/// ... unless this would need more panels than this.
const PANELS: f64 = 24.0;
/// Part of a cell's face is bisected if the integrals along its lines differ by more than this
/// power of e ...
const UNEVEN: f64 = 1.0;
/// ... at most this often in the smallest cells and less often in larger ones, which will be
/// divided where it matters, or this often if some of the lines are blocked, ...
const MOST_HALVED: usize = 6;
const MOST_CUT: usize = 3;
/// Number of bisections before a face with only blocked lines is accepted as blocked.
const LEAST_CUT: usize = 2;
/// ... and if the mean weight or load along one of them is above this.
const LEAST_WEIGHT: f64 = 1e-3;

/// Integrates over cells at one temperature.
pub(in crate::kinetics) struct Integrator<'a> {
    problem: &'a Problem,
    contact: Option<ContactCells>,
    /// kT (J).
    kt: f64,
    /// Whether the fixed tile moves, too.
    both_move: bool,
    /// The energy (J) at which weights are 1.
    pub level: f64,
    /// The energy (J) at which loads are 1.
    pub ground: f64,
}

/// The free parts of a line through a cell along s.
struct Line {
    /// Where it crosses the cell's face, in parts of phi's and theta's sizes.
    at: [f64; 2],
    /// Points of the integral along it: part of s's size, share of it, weight and load, and U (J).
    points: Vec<(f64, f64, [f64; 2], f64)>,
    /// The integrals of weight and load.
    sums: [f64; 2],
}

impl<'a> Integrator<'a> {
    pub fn new(
        problem: &'a Problem,
        (kt, both_move): (f64, bool),
        level: f64,
        ground: f64,
    ) -> Self {
        Self {
            problem,
            contact: problem.contact.as_ref().map(ContactCells::new),
            kt,
            both_move,
            level,
            ground,
        }
    }

    /// Computes the integrals over a cell, and whether it is proved blocked.
    pub fn integrate(&self, chart: &Chart, leaf: &Leaf) -> (Option<Box<Element>>, bool) {
        interruption::check();
        let contact = self.contact.as_ref();
        let found = contact.map(|cells| cells.classify(&chart.around(leaf.low, leaf.level)));
        let cut = match found {
            None => false,
            Some(None) => return (None, true),
            Some(Some(cuts)) => !cuts.is_none(),
        };
        let mut lines = Lines::new(self, chart, leaf, cut);
        let middle = lines.coordinates([0.5; 3]);
        let mut element = Element::new(upright(middle) * lines.gradients(middle));
        let mut free = [0.0; 2];
        lines.fill([[0.0, 1.0]; 2], 0, &mut |point| {
            free[0] += point.share;
            free[1] += point.share * point.energy;
            element.add(point);
        });
        [element.lowest, element.highest] = lines.range;
        element.mean = free[1] / free[0];
        ((element.weight > 0.0).then(|| Box::new(element)), false)
    }

    /// The limited weight at an energy (J), as a power of e.
    pub fn power(&self, energy: f64) -> f64 {
        ((self.level - energy) / self.kt).clamp(LEAST, GREATEST)
    }

    /// The integral of the load (m^2 rad) over the part of a cell where U is below a limit (J).
    pub fn held_below(&self, chart: &Chart, leaf: &Leaf, limit: f64) -> f64 {
        let mut held = 0.0;
        let mut lines = Lines::new(self, chart, leaf, self.contact.is_some());
        lines.fill([[0.0, 1.0]; 2], 0, &mut |point| {
            if point.energy < limit {
                held += point.share * point.volume * point.weights[1];
            }
        });
        held
    }
}

/// From the directions of x, y and theta to those along s, across it and of theta.
fn upright([_, phi, _]: [f64; 3]) -> Matrix3<f64> {
    let (sin, cos) = libm::sincos(phi);
    Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0)
}

/// The lines through a cell along which integrals are computed.
struct Lines<'a> {
    of: &'a Integrator<'a>,
    chart: &'a Chart,
    leaf: &'a Leaf,
    /// Whether contact may block part of the cell.
    cut: bool,
    /// The least and the greatest U met (J).
    range: [f64; 2],
}

impl<'a> Lines<'a> {
    fn new(of: &'a Integrator, chart: &'a Chart, leaf: &'a Leaf, cut: bool) -> Self {
        Self {
            of,
            chart,
            leaf,
            cut,
            range: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// (s, phi, theta) of a point given in parts of the cell's size.
    fn coordinates(&self, part: [f64; 3]) -> [f64; 3] {
        self.chart.coordinates(self.leaf.at(part))
    }

    /// The configuration at a part of s's size on the line that crosses the cell's face at `at`.
    fn on_line(&self, at: [f64; 2], part: f64) -> Configuration {
        self.chart
            .configuration(self.coordinates([part, at[0], at[1]]))
    }

    /// Gradients by x, y and theta of the parts of the cell's size at (s, phi, theta), as columns.
    fn gradients(&self, at: [f64; 3]) -> Matrix3<f64> {
        let mut by = self.chart.gradients(at);
        let sizes = self.chart.size(self.leaf.level);
        for (mut column, size) in by.column_iter_mut().zip(sizes) {
            column /= size;
        }
        by
    }

    /// Calls with the points along lines through a part of the face, given by its ends in phi and
    /// theta.
    fn fill(&mut self, face: [[f64; 2]; 2], halved: usize, add: &mut dyn FnMut(&QuadraturePoint)) {
        let place = |axis: usize, k: usize| {
            let [from, to] = face[axis];
            from + GAUSS[k] * (to - from)
        };
        let lines = self.lines(std::array::from_fn(|k| [place(0, k & 1), place(1, k >> 1)]));
        if let Some(axis) = uneven(&lines, self.cut, self.leaf.level, halved) {
            let [from, to] = face[axis];
            let middle = 0.5 * (from + to);
            for ends in [[from, middle], [middle, to]] {
                let mut half = face;
                half[axis] = ends;
                self.fill(half, halved + 1, add);
            }
            return;
        }
        let share = face.iter().map(|[from, to]| to - from).product::<f64>() / 4.0;
        let size: f64 = self.chart.size(self.leaf.level).iter().product();
        for line in &lines {
            for &(u, width, weights, energy) in &line.points {
                let part = [u, line.at[0], line.at[1]];
                let at @ [s, ..] = self.coordinates(part);
                let q = self.chart.configuration(at);
                let mobility = self.of.problem.mobility(&q, self.of.both_move);
                let volume = self.chart.volume(s) * size;
                let by = self.gradients(at);
                add(&QuadraturePoint {
                    part,
                    metric: by.transpose() * mobility * by * volume,
                    volume,
                    share: share * width,
                    weights,
                    energy,
                });
            }
        }
    }

    /// Lines through a cell. The energies along all of them are computed at once, which is faster
    /// than a few at a time.
    fn lines(&mut self, at: [[f64; 2]; 4]) -> [Line; 4] {
        let Integrator { kt, .. } = *self.of;
        let mut lines = at.map(|at| Line {
            at,
            points: Vec::new(),
            sums: [0.0; 2],
        });
        let parts = lines.iter().enumerate().flat_map(|(k, line)| {
            let free = self.free_parts(line.at).into_iter();
            free.map(move |ends| (k, ends))
        });
        let parts: Vec<(usize, [f64; 2])> = parts.collect();
        let ends = parts.iter().flat_map(|&(k, [from, to])| {
            let three = [from, 0.5 * (from + to), to];
            three.map(|u| (k, u))
        });
        let at_ends = self.energies(&lines, ends);
        // The line of each point, its place on it, and the width of its panel.
        let mut points: Vec<(usize, f64, f64)> = Vec::new();
        for (&(k, [from, to]), ends) in parts.iter().zip(at_ends.chunks(3)) {
            let change = (ends[0] - ends[1]).abs().max((ends[1] - ends[2]).abs()) / kt;
            let panels = (2.0 * change / PANEL).ceil().clamp(1.0, PANELS);
            let width = (to - from) / panels;
            for panel in 0..panels as usize {
                let all = GAUSS.map(|t| (k, from + (panel as f64 + t) * width, width));
                points.extend(all);
            }
            let [lowest, highest] = self.range;
            self.range = [
                ends.iter().copied().fold(lowest, f64::min),
                ends.iter().copied().fold(highest, f64::max),
            ];
        }
        let energies = self.energies(&lines, points.iter().map(|&(k, u, _)| (k, u)));
        for ((k, u, width), energy) in points.into_iter().zip(energies) {
            let load = ((self.of.ground - energy) / kt).min(FARTHEST);
            let weights = [self.of.power(energy), load].map(libm::exp);
            for (sum, weight) in lines[k].sums.iter_mut().zip(weights) {
                *sum += weight * width / 2.0;
            }
            lines[k].points.push((u, width / 2.0, weights, energy));
        }
        lines
    }

    /// U (J) at places on lines, given by the line's number and the part of s's size.
    fn energies(&self, lines: &[Line; 4], places: impl Iterator<Item = (usize, f64)>) -> Vec<f64> {
        let qs = places.map(|(k, u)| self.on_line(lines[k].at, u));
        let qs: Vec<Configuration> = qs.collect();
        let mut energies = vec![0.0; qs.len()];
        self.of.problem.potential().energies(&qs, &mut energies);
        energies
    }

    /// The free parts of a line.
    fn free_parts(&self, at: [f64; 2]) -> Vec<[f64; 2]> {
        let Some(contact) = self.of.problem.contact.as_ref().filter(|_| self.cut) else {
            return vec![[0.0, 1.0]];
        };
        interruption::check();
        let [from, to] = [0.0, 1.0].map(|u| self.on_line(at, u));
        let way = to.position() - from.position();
        let length = way.norm();
        let free = contact.free_stretches(&from, way / length, length);
        free.into_iter()
            .map(|ends| ends.map(|end| end / length))
            .collect()
    }
}

/// The coordinate, phi or theta, along which four lines differ too much to represent all lines
/// between them.
fn uneven(lines: &[Line; 4], cut: bool, level: u8, halved: usize) -> Option<usize> {
    if cut && halved < LEAST_CUT && lines.iter().all(|line| line.points.is_empty()) {
        return Some(halved % 2);
    }
    let mut steps = [0.0_f64; 2];
    for which in 0..2 {
        let sum = |k: usize| lines[k].sums[which];
        if (0..4).map(sum).fold(0.0, f64::max) < LEAST_WEIGHT {
            continue;
        }
        for (axis, step) in steps.iter_mut().enumerate() {
            for k in (0..4).filter(|k| k >> axis & 1 == 0) {
                let [a, b] = [sum(k), sum(k | 1 << axis)];
                let change = match a.min(b) > 0.0 {
                    true => libm::log(a / b).abs(),
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
