//! The network that is asked for barriers: milestones, states and transition states as nodes, and
//! the ways between them as links. It holds the roadmap and everything that was found by following
//! the energy from it.

use std::collections::{HashMap, HashSet};

use petgraph::algo::{astar, min_spanning_tree};
use petgraph::data::Element;
use petgraph::graph::{NodeIndex, UnGraph};
use petgraph::unionfind::UnionFind;
use petgraph::visit::{EdgeFiltered, EdgeRef};

use super::slide::Point;
use crate::configuration::Configuration;
use crate::problem::Problem;
use crate::roadmap::edge::{EdgeCosts, costs_of_energies};
use crate::roadmap::{EdgeSettings, Roadmap};

/// A way between two nodes.
#[derive(Clone, Debug)]
pub enum Way {
    /// The straight motion.
    Straight,
    /// A sequence of points, from the link's first node to its second.
    Points(Vec<Point>),
    /// No motion: the two nodes are taken as one (a far configuration and `free`).
    Same,
}

/// What joins two nodes.
#[derive(Clone, Debug)]
pub struct Link {
    pub from: usize,
    pub to: usize,
    pub costs: EdgeCosts,
    pub way: Way,
}

/// Weight of a link in the graph: its peak (J), and its number, which breaks ties.
type Weight = (f64, u32);

/// Nodes and links.
#[derive(Clone, Debug, Default)]
pub struct Network {
    /// Configuration and energy (J) of every node; `None` for the node that stands for `free`.
    pub nodes: Vec<Option<(Configuration, f64)>>,
    pub links: Vec<Link>,
    graph: UnGraph<(), Weight, u32>,
}

/// Two basins that meet, in ascending order of the energy at which they do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Merge {
    /// The link that joins them.
    pub link: usize,
    /// The labelled node with the lowest energy in each basin; the first is the lower one.
    pub lower: usize,
    pub upper: usize,
}

/// A path through the network: links with the direction in which each is gone.
pub type Route = Vec<(usize, bool)>;

/// By which cost paths are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cost {
    /// Mechanical work against the energy (J).
    Work,
    /// -ln of the transition probabilities.
    Improbability,
    /// Work, and the given energy (J) for each metre of the way, over links whose peak does not
    /// exceed `highest` (J).
    Below { highest: f64, per_metre: f64 },
}

impl Network {
    pub fn new(roadmap: &Roadmap) -> Self {
        let mut network = Self::default();
        for milestone in &roadmap.milestones {
            network.add_node(Some((milestone.configuration, milestone.energy)));
        }
        for edge in &roadmap.edges {
            network.add_link(Link {
                from: edge.from as usize,
                to: edge.to as usize,
                costs: edge.costs,
                way: Way::Straight,
            });
        }
        network
    }

    pub fn add_node(&mut self, node: Option<(Configuration, f64)>) -> usize {
        self.nodes.push(node);
        self.graph.add_node(()).index()
    }

    pub fn add_link(&mut self, link: Link) -> usize {
        let number = self.links.len();
        self.graph.add_edge(
            NodeIndex::new(link.from),
            NodeIndex::new(link.to),
            (link.costs.peak, number as u32),
        );
        self.links.push(link);
        number
    }

    /// Whether no link leads to a node.
    pub fn is_isolated(&self, node: usize) -> bool {
        self.graph.neighbors(NodeIndex::new(node)).next().is_none()
    }

    /// Adds a link along a sequence of points.
    pub fn add_way(
        &mut self,
        problem: &Problem,
        from: usize,
        to: usize,
        points: Vec<Point>,
        settings: &EdgeSettings,
    ) -> usize {
        let energies: Vec<f64> = points.iter().map(|p| p.energy).collect();
        let lengths: Vec<f64> = points
            .windows(2)
            .map(|pair| problem.space.distance(&pair[0].q, &pair[1].q))
            .collect();
        let costs = costs_of_energies(&energies, &lengths, settings);
        self.add_link(Link {
            from,
            to,
            costs,
            way: Way::Points(points),
        })
    }

    /// Nodes from which no link leads down all the way: where a descent is worth following.
    pub fn local_minima(&self) -> Vec<usize> {
        let mut lowest = vec![true; self.nodes.len()];
        for link in &self.links {
            for (here, there) in [(link.from, link.to), (link.to, link.from)] {
                let (Some((_, high)), Some((_, low))) = (self.nodes[here], self.nodes[there])
                else {
                    continue;
                };
                if low < high && link.costs.peak <= high {
                    lowest[here] = false;
                }
            }
        }
        (0..self.nodes.len())
            .filter(|&node| lowest[node] && self.nodes[node].is_some())
            .collect()
    }

    /// Where the highest energy of a link is reached; `None` for a link without motion.
    pub fn peak_configuration(&self, link: usize) -> Option<Configuration> {
        let link = &self.links[link];
        match &link.way {
            Way::Same => self.nodes[link.from].or(self.nodes[link.to]).map(|n| n.0),
            Way::Straight => {
                let (a, b) = (self.nodes[link.from]?.0, self.nodes[link.to]?.0);
                Some(a.interpolate(&b, link.costs.peak_at))
            }
            Way::Points(points) => points
                .iter()
                .max_by(|a, b| a.energy.total_cmp(&b.energy))
                .map(|p| p.q),
        }
    }

    /// The tree of the links that minimax paths use (a minimum spanning tree by peak).
    pub fn minimax_tree(&self) -> MinimaxTree {
        let mut tree = UnGraph::default();
        let mut ascending = Vec::new();
        for element in min_spanning_tree(&self.graph) {
            match element {
                Element::Node { .. } => {
                    tree.add_node(());
                }
                Element::Edge {
                    source,
                    target,
                    weight,
                } => {
                    tree.add_edge(NodeIndex::new(source), NodeIndex::new(target), weight);
                    ascending.push(weight);
                }
            }
        }
        ascending.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        MinimaxTree { tree, ascending }
    }

    /// The lowest possible highest energy on a route from a node to any of the `goals`: Dijkstra's
    /// algorithm, paths added up by their maximum.
    pub fn minimax(&self, from: usize, goals: &HashSet<usize>) -> Option<f64> {
        let allowed = EdgeFiltered::from_fn(&self.graph, |edge| {
            self.is_motion(edge.weight().1, from, goals)
        });
        let (peak, _) = astar(
            &allowed,
            NodeIndex::new(from),
            |node| goals.contains(&node.index()),
            |edge| Highest(edge.weight().0),
            |_| Highest::default(),
        )?;
        Some(peak.0)
    }

    /// The cheapest route from a node to any of the `goals`, by Dijkstra's algorithm: its end, its
    /// cost and its links.
    pub fn cheapest(
        &self,
        from: usize,
        goals: &HashSet<usize>,
        cost: Cost,
    ) -> Option<(usize, f64, Route)> {
        let highest = match cost {
            Cost::Below { highest, .. } => highest,
            _ => f64::INFINITY,
        };
        let allowed = EdgeFiltered::from_fn(&self.graph, |edge| {
            edge.weight().0 <= highest && self.is_motion(edge.weight().1, from, goals)
        });
        let (total, nodes) = astar(
            &allowed,
            NodeIndex::new(from),
            |node| goals.contains(&node.index()),
            |edge| {
                let number = edge.weight().1 as usize;
                self.cost(number, edge.source().index(), cost)
            },
            |_| 0.0,
        )?;
        let route = nodes
            .windows(2)
            .filter_map(|pair| self.cheapest_link(pair[0], pair[1], highest, cost))
            .collect();
        Some((nodes.last()?.index(), total, route))
    }

    /// Whether a route between these ends may use a link: one without motion only where it starts
    /// or ends at the node that stands for `free`. Far configurations are one place to come from
    /// and to go to, but to pass from one to another takes a motion.
    fn is_motion(&self, number: u32, from: usize, goals: &HashSet<usize>) -> bool {
        let link = &self.links[number as usize];
        !matches!(link.way, Way::Same)
            || [link.from, link.to]
                .iter()
                .filter(|&&node| self.nodes[node].is_none())
                .any(|free| *free == from || goals.contains(free))
    }

    fn cheapest_link(
        &self,
        from: NodeIndex<u32>,
        to: NodeIndex<u32>,
        highest: f64,
        cost: Cost,
    ) -> Option<(usize, bool)> {
        self.graph
            .edges_connecting(from, to)
            .map(|edge| *edge.weight())
            .filter(|weight| weight.0 <= highest)
            .min_by(|a, b| {
                let price = |w: &Weight| self.cost(w.1 as usize, from.index(), cost);
                price(a).total_cmp(&price(b)).then(a.1.cmp(&b.1))
            })
            .map(|weight| {
                let number = weight.1 as usize;
                (number, self.links[number].from == from.index())
            })
    }

    fn cost(&self, number: usize, from: usize, cost: Cost) -> f64 {
        let link = &self.links[number];
        let direction = usize::from(link.from != from);
        match cost {
            Cost::Work => link.costs.work[direction],
            Cost::Improbability => link.costs.improbability[direction],
            Cost::Below { per_metre, .. } => {
                link.costs.work[direction] + per_metre * link.costs.length
            }
        }
    }
}

/// A highest energy (J): "adding" two of them gives the larger one, so that a shortest path is a
/// minimax path. The neutral element is minus infinity, not 0: energies may be negative.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Highest(f64);

impl Default for Highest {
    fn default() -> Self {
        Self(f64::NEG_INFINITY)
    }
}

impl std::ops::Add for Highest {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
}

/// The minimum spanning tree by peak: between any two nodes, the path in it has the lowest
/// possible highest peak.
pub struct MinimaxTree {
    tree: UnGraph<(), Weight, u32>,
    ascending: Vec<Weight>,
}

impl MinimaxTree {
    /// The merges of the basins of `labelled` nodes (with their energies, J), ascending: the merge
    /// tree. Links join basins in the order of their peaks; each basin is known by its lowest
    /// labelled node.
    pub fn merges(&self, labelled: &[(usize, f64)]) -> Vec<Merge> {
        let mut basins = UnionFind::<usize>::new(self.tree.node_count());
        let mut lowest: Vec<Option<(f64, usize)>> = vec![None; self.tree.node_count()];
        for &(node, energy) in labelled {
            lowest[node] = Some((energy, node));
        }
        let ends: HashMap<u32, (usize, usize)> = self
            .tree
            .edge_references()
            .map(|e| (e.weight().1, (e.source().index(), e.target().index())))
            .collect();
        let mut merges = Vec::new();
        for &(_, number) in &self.ascending {
            let (a, b) = ends[&number];
            let (a, b) = (basins.find(a), basins.find(b));
            let (first, second) = (lowest[a], lowest[b]);
            basins.union(a, b);
            let joined = basins.find(a);
            lowest[joined] = match (first, second) {
                (Some(x), Some(y)) => {
                    let (low, high) = if x <= y { (x, y) } else { (y, x) };
                    merges.push(Merge {
                        link: number as usize,
                        lower: low.1,
                        upper: high.1,
                    });
                    Some(low)
                }
                (x, y) => x.or(y),
            };
        }
        merges
    }
}
