//! The disconnectivity graph as a page's data.

use serde::Serialize;

use super::rounded;
use crate::report::plots::disconnectivity::merge_tree;
use crate::report::plots::merge_tree::Tree;
use crate::report::plots::scale::EnergyScale;
use crate::report::plots::scene::{Class, Scene};

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
    let classes = scene.classes();
    let classes = &classes[..classes.len().min(MOST)];
    let trees = merge_tree(scene, classes, scale);
    trees.iter().map(|tree| node(tree, classes)).collect()
}

fn node(tree: &Tree, classes: &[Class]) -> Node {
    match tree {
        Tree::Leaf { class, energy } => {
            let class = classes.iter().find(|c| Some(c.state.class) == *class);
            Node::Leaf {
                state: class.map(|class| class.state.id),
                energy: rounded(*energy, 6),
                copies: class.map_or(1, |class| class.copies),
            }
        }
        Tree::Merge {
            energy,
            bounds,
            children,
        } => Node::Merge {
            energy: rounded(*energy, 6),
            bounds: bounds.map(|(lower, upper)| [rounded(lower, 6), rounded(upper, 6)]),
            children: children.iter().map(|child| node(child, classes)).collect(),
        },
    }
}
