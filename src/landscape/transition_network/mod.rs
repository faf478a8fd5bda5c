//! The transition network that answers barrier queries: milestones, states and transition states as
//! nodes, the ways between them as links. It contains the roadmap and everything found by following
//! the energy from it.
//!
//! The ends of a straight motion that the roadmap did not try give a lower bound of its cost: its
//! peak is at least the higher end, and its climb at least the difference between them. Searches
//! use these bounds, and only the motions that turn out best are checked for contact and weighed
//! (expensive edge evaluations: Dellin and Srinivasa, *A unifying formalism for shortest path
//! problems with expensive edge evaluations via lazy best-first search over paths with edge
//! selectors*, ICAPS 2016).

mod ahead;
mod forest;
mod routes;
mod weighing;

use std::collections::HashMap;
use std::sync::OnceLock;

use fixedbitset::FixedBitSet;
use nalgebra::Vector3;
use ordered_float::OrderedFloat;
use petgraph::graph::{NodeIndex, UnGraph};

pub use ahead::Cost;
pub use forest::Merge;
pub use routes::Route;

use crate::roadmap::edge::{EdgeCosts, costs_of_energies};
use crate::roadmap::{Edge, EdgeSettings, Point, Roadmap};
use tiles::configuration::Configuration;
use tiles::contact::Known;
use tiles::parallel;
use tiles::problem::{Problem, Symmetry};

/// A link between two nodes.
#[derive(Clone, Debug)]
pub struct Link {
    /// The node it leaves.
    pub from: u32,
    /// The node it reaches.
    pub to: u32,
    /// The costs in both directions; empty until the link is weighed, and [`EdgeCosts::BLOCKED`] if
    /// it is then found not to be free.
    costs: OnceLock<EdgeCosts>,
}

impl Link {
    /// The node at the other end of a link.
    fn other_end(&self, node: u32) -> u32 {
        if node == self.from {
            self.to
        } else {
            self.from
        }
    }
}

/// Nodes and links. A link takes 88 bytes including its part in the graph; few have a path that is
/// not straight.
#[derive(Clone)]
pub struct Network<'a> {
    /// The problem whose configurations the nodes are.
    pub problem: &'a Problem,
    /// Configuration and energy (J) of every node; `None` for the node that stands for `free`.
    pub nodes: Vec<Option<(Configuration, f64)>>,
    /// For the first nodes, the roadmap's milestones: the energy's gradient and what is known about
    /// contact.
    of_milestones: Vec<(Vector3<f64>, Option<Known>)>,
    /// The links.
    pub links: Vec<Link>,
    /// The weighed links, except those weighed by searches: these run in parallel, and none may
    /// depend on what another has done.
    settled: FixedBitSet,
    /// How links are weighed.
    settings: EdgeSettings,
    /// Number of links that are motions of the roadmap; they come first.
    of_roadmap: usize,
    /// The points, from the first node to the second, of links that are not straight motions.
    ways: HashMap<usize, Vec<Point>>,
    /// The graph; its edges are numbered like the links.
    graph: UnGraph<(), (), u32>,
    /// For each node, the motions that minimax paths use, the links without motion, and all links
    /// added since the network was spanned.
    around: Vec<Vec<u32>>,
}

impl<'a> Network<'a> {
    /// The network whose nodes are the milestones and whose links are the motions between them,
    /// weighed ones first.
    pub fn new(problem: &'a Problem, roadmap: Roadmap, settings: &EdgeSettings) -> Self {
        let nodes = roadmap.milestones.len();
        let links = roadmap.edges.len() + roadmap.untried.len();
        let of_milestone = |m: &Point| (m.gradient, problem.known(&m.q));
        let mut network = Self {
            problem,
            nodes: Vec::with_capacity(nodes),
            of_milestones: parallel::map(&roadmap.milestones, of_milestone),
            links: Vec::with_capacity(links),
            settled: FixedBitSet::new(),
            settings: *settings,
            of_roadmap: links,
            ways: HashMap::new(),
            graph: UnGraph::with_capacity(nodes, links),
            around: Vec::with_capacity(nodes),
        };
        for milestone in &roadmap.milestones {
            network.add_node(Some((milestone.q, milestone.energy)));
        }
        for Edge { from, to, costs } in roadmap.edges {
            network.push(from, to, OnceLock::from(costs));
        }
        for (from, to) in roadmap.untried {
            network.push(from, to, OnceLock::new());
        }
        network.span_first();
        network
    }

    /// Adds a node without links, `None` for free tiles; returns its number.
    pub fn add_node(&mut self, node: Option<(Configuration, f64)>) -> usize {
        self.nodes.push(node);
        self.around.push(Vec::new());
        self.graph.add_node(()).index()
    }

    /// Adds a free straight motion.
    pub fn add_motion(&mut self, from: usize, to: usize, costs: EdgeCosts) -> usize {
        self.add_link(from as u32, to as u32, OnceLock::from(costs))
    }

    /// Adds a straight motion that is weighed on demand.
    pub fn add_untried(&mut self, from: usize, to: usize) -> usize {
        self.add_link(from as u32, to as u32, OnceLock::new())
    }

    fn add_link(&mut self, from: u32, to: u32, costs: OnceLock<EdgeCosts>) -> usize {
        let number = self.push(from, to, costs);
        self.hang(number);
        number
    }

    /// Adds a link to those around its nodes.
    fn hang(&mut self, number: usize) {
        let Link { from, to, .. } = self.links[number];
        for node in [from, to] {
            self.around[node as usize].push(number as u32);
        }
    }

    /// Whether a link involves no motion: one of its nodes stands for `free`.
    pub fn is_same(&self, link: usize) -> bool {
        let Link { from, to, .. } = &self.links[link];
        [from, to]
            .iter()
            .any(|node| self.nodes[**node as usize].is_none())
    }

    fn push(&mut self, from: u32, to: u32, costs: OnceLock<EdgeCosts>) -> usize {
        let ends = [from, to].map(|node| NodeIndex::new(node as usize));
        self.graph.add_edge(ends[0], ends[1], ());
        self.settled.grow(self.links.len() + 1);
        self.settled.set(self.links.len(), costs.get().is_some());
        self.links.push(Link { from, to, costs });
        self.links.len() - 1
    }

    /// Adds the image of a link under a symmetry between two nodes, the images of its own.
    pub fn add_image(&mut self, link: usize, [from, to]: [usize; 2], symmetry: &Symmetry) {
        let costs = self.links[link].costs.clone();
        let number = self.add_link(from as u32, to as u32, costs);
        if let Some(points) = self.ways.get(&link) {
            let image = points.iter().map(|point| point.image(symmetry)).collect();
            self.ways.insert(number, image);
        }
    }

    /// The costs of a link, or lower bounds of them as long as it is not weighed.
    pub fn costs(&self, link: usize) -> EdgeCosts {
        let costs = self.links[link].costs.get();
        costs.copied().unwrap_or_else(|| self.costs_at_least(link))
    }

    /// Lower bounds of the costs of a straight motion between a link's nodes.
    fn costs_at_least(&self, link: usize) -> EdgeCosts {
        let Link { from, to, .. } = self.links[link];
        let ends = [from, to].map(|node| self.nodes[node as usize]);
        let [Some((a, from)), Some((b, to))] = ends else {
            return EdgeCosts::default();
        };
        EdgeCosts {
            peak: from.max(to),
            length: self.problem.space.distance(&a, &b),
            work: [(to - from).max(0.0), (from - to).max(0.0)],
            ..EdgeCosts::default()
        }
    }

    /// The same for its peak alone (J).
    fn peak(&self, link: usize) -> f64 {
        match self.links[link].costs.get() {
            Some(costs) => costs.peak,
            None => self.peak_at_least(link),
        }
    }

    fn peak_at_least(&self, link: usize) -> f64 {
        let Link { from, to, .. } = &self.links[link];
        let ends = [*from, *to].map(|node| self.nodes[node as usize]);
        let energies = ends.into_iter().flatten().map(|end| end.1);
        energies.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Adds a link that identifies a far configuration with this energy (J) with `free`.
    pub fn add_same(&mut self, node: usize, free: usize, energy: f64) -> usize {
        let costs = EdgeCosts {
            peak: energy,
            ..EdgeCosts::default()
        };
        self.add_motion(node, free, costs)
    }

    /// The points of a link that is neither a straight motion between its nodes nor without motion.
    pub fn way(&self, link: usize) -> Option<&[Point]> {
        self.ways.get(&link).map(Vec::as_slice)
    }

    /// Whether no link leads to a node.
    pub fn is_isolated(&self, node: usize) -> bool {
        self.graph.neighbors(NodeIndex::new(node)).next().is_none()
    }

    /// Adds a link along a sequence of points.
    pub fn add_way(&mut self, from: usize, to: usize, points: Vec<Point>) -> usize {
        let energies: Vec<f64> = points.iter().map(|p| p.energy).collect();
        let lengths: Vec<f64> = points
            .windows(2)
            .map(|pair| self.problem.space.distance(&pair[0].q, &pair[1].q))
            .collect();
        let costs = costs_of_energies(&energies, &lengths, &self.settings);
        let number = self.add_motion(from, to, costs);
        self.ways.insert(number, points);
        number
    }

    /// Nodes from which no link leads downhill all the way, and a descent is worth following.
    pub fn local_minima(&self) -> Vec<usize> {
        let mut lowest = vec![true; self.nodes.len()];
        for link in &self.links {
            let (from, to) = (link.from as usize, link.to as usize);
            // If any of its links leads downhill, one of the spanning forest does: it peaks at the
            // node, which none undercuts.
            let Some(costs) = link.costs.get() else {
                continue;
            };
            for (here, there) in [(from, to), (to, from)] {
                let (Some((_, high)), Some((_, low))) = (self.nodes[here], self.nodes[there])
                else {
                    continue;
                };
                if low < high && costs.peak <= high {
                    lowest[here] = false;
                }
            }
        }
        (0..self.nodes.len())
            .filter(|&node| lowest[node] && self.nodes[node].is_some())
            .collect()
    }

    /// The configuration of a link's highest energy; `None` for a link without motion.
    pub fn peak_configuration(&self, link: usize) -> Option<Configuration> {
        if let Some(points) = self.way(link) {
            let highest = points.iter().max_by_key(|p| OrderedFloat(p.energy));
            return highest.map(|p| p.q);
        }
        let Link { from, to, .. } = &self.links[link];
        let [from, to] = [*from, *to].map(|node| self.nodes[node as usize].map(|n| n.0));
        match (from, to) {
            (Some(from), Some(to)) => Some(from.interpolate(&to, self.costs(link).peak_at)),
            _ => from.or(to),
        }
    }
}
