//! The disconnectivity graph as a page's data.

use serde::Serialize;

use super::rounded;
use crate::landscape::Kind;
use crate::report::plots::disconnectivity::merge_tree;
use crate::report::plots::merge_tree::Tree;
use crate::report::plots::scale::EnergyScale;
use crate::report::plots::scene::Scene;

/// Most classes of states in the graph.
const MOST: usize = 24;

/// A state or a merging of states.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum Node {
    Leaf {
        /// Null for tiles far apart.
        state: Option<usize>,
        energy: f64,
        copies: usize,
    },
    Merge {
        /// Saddle energy (J) and its certified bounds.
        energy: f64,
        bounds: Option<[f64; 2]>,
        children: Vec<Node>,
    },
}

/// The merge trees of the lowest classes of states.
pub fn nodes(scene: &Scene, scale: &EnergyScale) -> Vec<Node> {
    let kinds = scene.kinds();
    let kinds = &kinds[..kinds.len().min(MOST)];
    let trees = merge_tree(scene, kinds, scale);
    trees.iter().map(|tree| node(tree, kinds)).collect()
}

fn node(tree: &Tree, kinds: &[Kind]) -> Node {
    match tree {
        Tree::Leaf { class, energy } => {
            let kind = kinds.iter().find(|kind| Some(kind.first().class) == *class);
            Node::Leaf {
                state: kind.map(|kind| kind.first().id),
                energy: rounded(*energy, 6),
                copies: kind.map_or(1, Kind::copies),
            }
        }
        Tree::Merge {
            energy,
            bounds,
            children,
        } => Node::Merge {
            energy: rounded(*energy, 6),
            bounds: bounds.map(|(lower, upper)| [rounded(lower, 6), rounded(upper, 6)]),
            children: children.iter().map(|child| node(child, kinds)).collect(),
        },
    }
}
