//! The well of a state: all configurations that can be reached from it without rising above a given
//! level.
//!
//! The flood covers a grid of slides and tilts around the state; on each line along which the gap
//! opens it follows the free intervals. Configurations between the nodes count as part of the basin
//! if they are below the level and an adjacent node belongs to the basin.

use std::collections::{HashMap, VecDeque};

use super::frame::Frame;
use super::line::Lines;
use landscape::roadmap::Point;
use tiles::configuration::Configuration;
use tiles::problem::Problem;

/// Spacing of the grid's nodes, as a share of the moving tile's circumradius.
const SPACING: f64 = 1.0 / 128.0;
/// The level is lowered by these shares of the depth, each time the flood has crossed a saddle
/// between two nodes.
const MARGINS: [f64; 6] = [0.002, 0.005, 0.01, 0.02, 0.05, 0.1];
/// Largest number of nodes of a flood; larger basins are truncated.
const MOST_NODES: usize = 150_000;
/// Highest level of a basin, as a remaining share of its depth.
const LEFT: f64 = 0.01;

type Node = (i32, i32);

/// The well of a minimum, which is its basin.
pub struct Well<'a> {
    pub(super) lines: Lines<'a>,
    /// U at the minimum (J).
    pub lowest: f64,
    /// The basin lies below this energy (J).
    pub level: f64,
    /// Whether the basin had more nodes than a flood may have.
    pub is_cut: bool,
    spacing: [f64; 2],
    nodes: HashMap<Node, Vec<[f64; 2]>>,
}

impl<'a> Well<'a> {
    /// Floods the basin of a minimum up to its lowest pass (J) (infinite if none is known), less a
    /// small margin so that the grid does not cross it, or up to a hundredth of the minimum's
    /// depth. Other minima, `others`, are never flooded: if one is, the level is lowered.
    pub fn new(problem: &'a Problem, minimum: &Point, pass: f64, others: &[Configuration]) -> Self {
        let frame = Frame::of_minimum(problem, minimum);
        let contact = problem.contact.as_ref();
        let radius = contact.map_or(problem.space.rho, |it| it.moving().circumradius());
        let mut well = Self {
            lines: Lines {
                problem,
                frame,
                reach: radius,
            },
            lowest: minimum.energy,
            level: minimum.energy,
            is_cut: false,
            spacing: [SPACING * radius, SPACING * std::f64::consts::SQRT_2],
            nodes: HashMap::new(),
        };
        let places: Vec<_> = others.iter().map(|q| frame.coordinates(q)).collect();
        for margin in MARGINS {
            let below_pass = pass - margin * (pass - minimum.energy);
            well.level = below_pass.min(LEFT * minimum.energy);
            well.fill();
            if !places.iter().any(|(at, gap)| well.holds(*at, *gap)) {
                break;
            }
        }
        well
    }

    fn fill(&mut self) {
        self.nodes.clear();
        let origin = self.lines.free([0.0, 0.0]);
        // The state itself touches, or lies in free space.
        let own = |[start, end]: &[f64; 2]| start - self.spacing[0] <= 0.0 && 0.0 <= *end;
        let start = origin.into_iter().filter(own).collect();
        self.nodes.insert((0, 0), start);
        let mut queue = VecDeque::from([(0, 0)]);
        while let Some(node) = queue.pop_front() {
            if self.nodes.len() > MOST_NODES {
                self.is_cut = true;
                return;
            }
            let from = self.nodes[&node].clone();
            for (i, j) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let next = (node.0 + i, node.1 + j);
                if self.at(next)[1].abs() > std::f64::consts::PI {
                    continue;
                }
                if self.reaches(&from, next) {
                    queue.push_back(next);
                }
            }
        }
    }

    /// Adds the part of a node's line that is below the level and next to intervals of a neighbour;
    /// returns whether that is new.
    fn reaches(&mut self, from: &[[f64; 2]], node: Node) -> bool {
        let at = self.at(node);
        let known = self.nodes.get(&node);
        if known.is_some_and(|known| from.iter().all(|a| known.iter().any(|b| meet(a, b)))) {
            return false;
        }
        let known = known.cloned().unwrap_or_default();
        let free = self.lines.free(at).into_iter();
        let new: Vec<_> = free
            .filter(|b| !known.contains(b) && from.iter().any(|a| meet(a, b)))
            .filter(|b| self.lines.lowest(at, *b) < self.level)
            .collect();
        let found = !new.is_empty();
        // Also where nothing was found, so that it is not looked for again.
        self.nodes.entry(node).or_default().extend(new);
        found
    }

    /// Slide (m) and tilt (rad) of a node.
    fn at(&self, node: Node) -> [f64; 2] {
        [
            self.spacing[0] * f64::from(node.0),
            self.spacing[1] * f64::from(node.1),
        ]
    }

    /// Whether a line's gap belongs to the basin, its energy aside.
    fn holds(&self, at: [f64; 2], gap: f64) -> bool {
        let margin = self.spacing[0];
        let of_line = self.intervals(at);
        let within = |[start, end]: &[f64; 2]| start - margin <= gap && gap <= end + margin;
        of_line.iter().any(within)
    }

    /// The intervals of the gap that belong to the basin on any line, their energies aside.
    pub(super) fn intervals(&self, at: [f64; 2]) -> Vec<[f64; 2]> {
        let [i, j] = [0, 1].map(|k| (at[k] / self.spacing[k]).floor() as i32);
        let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
        let near: Vec<_> = corners
            .iter()
            .filter_map(|node| self.nodes.get(node))
            .flatten()
            .collect();
        if near.is_empty() {
            return Vec::new();
        }
        let mut free = self.lines.free(at);
        free.retain(|b| near.iter().any(|a| meet(a, b)));
        free
    }

    /// The least and the greatest slide (m) and tilt (rad) that the basin may have.
    pub(super) fn extent(&self) -> [[f64; 2]; 2] {
        let held = self.nodes.iter().filter(|(_, held)| !held.is_empty());
        let places = held.map(|(node, _)| self.at(*node));
        let zero = [[0.0, 0.0], [0.0, 0.0]];
        let ends = places.fold(zero, |ends, at| {
            [0, 1].map(|k| [f64::min(ends[k][0], at[k]), f64::max(ends[k][1], at[k])])
        });
        [0, 1].map(|k| [ends[k][0] - self.spacing[k], ends[k][1] + self.spacing[k]])
    }
}

/// Whether two intervals have a point in common.
fn meet(a: &[f64; 2], b: &[f64; 2]) -> bool {
    a[0] <= b[1] && b[0] <= a[1]
}
