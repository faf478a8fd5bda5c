//! The disconnectivity graph as a page's data.

use serde::Serialize;

use super::rounded;
use crate::plots::disconnectivity::{merge_tree, why_apart};
use crate::plots::merge_tree::Tree;
use crate::plots::scale::EnergyScale;
use crate::plots::scene::Scene;
use physics::landscape::Kind;

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

/// A merge tree, and why no way leads from it to `free` where that is so.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnTree {
    root: Node,
    apart: Option<&'static str>,
}

/// The merge trees of the lowest kinds of states.
pub fn trees(scene: &Scene, scale: &EnergyScale) -> Vec<DrawnTree> {
    let kinds = scene.kinds();
    let kinds = &kinds[..kinds.len().min(MOST)];
    let trees = merge_tree(scene, kinds, scale);
    let drawn = |tree| DrawnTree {
        root: node(tree, kinds),
        apart: why_apart(scene, tree),
    };
    trees.iter().map(drawn).collect()
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
