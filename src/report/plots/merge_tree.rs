//! The merge tree of a disconnectivity graph.

use ordered_float::OrderedFloat;
use physics::order::Order;

use super::scale::EnergyScale;

/// Saddles this close on the pictures' scale are drawn as one.
const SAME_LEVEL: f64 = 0.004;

/// A merge tree of classes of states.
#[derive(Clone, Debug, PartialEq)]
pub enum Tree {
    /// A class by its index; `None` for free tiles.
    Leaf { class: Option<usize>, energy: f64 },
    Merge {
        /// Saddle energy (J).
        energy: f64,
        /// Certified bounds of the saddle energy (J).
        bounds: Option<(f64, f64)>,
        /// The lowest first.
        children: Vec<Tree>,
    },
}

/// A saddle between two classes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Join {
    pub ends: [Option<usize>; 2],
    /// Saddle energy (J).
    pub energy: f64,
    /// Certified bounds of the saddle energy (J).
    pub bounds: Option<(f64, f64)>,
}

impl Tree {
    /// Energy (J) of a state, or of the saddle that joins several.
    pub fn energy(&self) -> f64 {
        match self {
            Self::Leaf { energy, .. } | Self::Merge { energy, .. } => *energy,
        }
    }

    /// Lowest energy (J) of the tree's states.
    pub fn lowest(&self) -> f64 {
        self.deepest().0.into_inner()
    }

    /// Energy (J) and class of the tree's deepest state; of equal ones that of the lowest index.
    fn deepest(&self) -> (OrderedFloat<f64>, Option<usize>) {
        match self {
            Self::Leaf { class, energy } => (OrderedFloat(*energy), *class),
            Self::Merge { children, .. } => children
                .iter()
                .map(Tree::deepest)
                .min()
                .unwrap_or((OrderedFloat(f64::INFINITY), None)),
        }
    }

    /// The number of states of the tree.
    pub fn leaves(&self) -> usize {
        match self {
            Self::Leaf { .. } => 1,
            Self::Merge { children, .. } => children.iter().map(Tree::leaves).sum(),
        }
    }

    /// The classes of the tree's states, in their order.
    pub fn classes(&self) -> Vec<Option<usize>> {
        match self {
            Self::Leaf { class, .. } => vec![*class],
            Self::Merge { children, .. } => children.iter().flat_map(Tree::classes).collect(),
        }
    }

    /// Whether a class is among the tree's states.
    pub fn holds(&self, wanted: Option<usize>) -> bool {
        match self {
            Self::Leaf { class, .. } => *class == wanted,
            Self::Merge { children, .. } => children.iter().any(|child| child.holds(wanted)),
        }
    }

    /// Joins two trees over a saddle. A tree that was joined at visually the same level contributes
    /// its children.
    fn join(trees: [Tree; 2], over: &Join, scale: &EnergyScale) -> Self {
        let mut children = Vec::new();
        for tree in trees {
            let rise = scale.position(over.energy) - scale.position(tree.energy());
            match tree {
                Self::Merge { children: own, .. } if rise < SAME_LEVEL => children.extend(own),
                other => children.push(other),
            }
        }
        children.order_by_key(Tree::deepest);
        Self::Merge {
            energy: over.energy,
            bounds: over.bounds,
            children,
        }
    }
}

/// Joins leaves (class and energy) over saddles, lowest first. Unconnected leaves remain separate
/// trees; saddles to other classes are ignored.
pub fn merge(
    leaves: Vec<(Option<usize>, f64)>,
    mut joins: Vec<Join>,
    scale: &EnergyScale,
) -> Vec<Tree> {
    joins.order_by_key(|join| OrderedFloat(join.energy));
    let leaf = |(class, energy)| Tree::Leaf { class, energy };
    let mut trees: Vec<Tree> = leaves.into_iter().map(leaf).collect();
    for join in &joins {
        let [a, b] = join
            .ends
            .map(|end| trees.iter().position(|tree| tree.holds(end)));
        if let (Some(a), Some(b)) = (a, b)
            && a != b
        {
            let second = trees.remove(a.max(b));
            let first = trees.remove(a.min(b));
            trees.push(Tree::join([first, second], join, scale));
        }
    }
    trees.order_by_key(Tree::deepest);
    trees
}

#[cfg(test)]
mod tests {
    use super::*;

    fn join(a: Option<usize>, b: Option<usize>, energy: f64) -> Join {
        Join {
            ends: [a, b],
            energy,
            bounds: None,
        }
    }

    fn leaf(class: Option<usize>, energy: f64) -> Tree {
        Tree::Leaf { class, energy }
    }

    #[test]
    fn states_merge_at_the_lowest_saddle_that_joins_them() {
        let scale = EnergyScale::holding([-1.0]);
        let leaves = vec![(Some(7), -1.0), (Some(2), -0.5), (None, 0.0)];
        // Between 2 and 7 the indirect path is lower than the direct one.
        let joins = vec![
            join(Some(2), Some(7), 0.4),
            join(None, Some(2), 0.1),
            join(Some(7), None, 0.3),
            join(Some(7), Some(9), -0.9),
        ];
        let trees = merge(leaves, joins, &scale);
        let [
            Tree::Merge {
                energy, children, ..
            },
        ] = trees.as_slice()
        else {
            panic!("{trees:?}");
        };
        assert_eq!(
            (*energy, trees[0].leaves(), trees[0].lowest()),
            (0.3, 3, -1.0)
        );
        assert_eq!(children[0], leaf(Some(7), -1.0));
        assert_eq!(children[1].energy(), 0.1);
    }

    #[test]
    fn saddles_of_one_height_make_one_level() {
        let scale = EnergyScale::holding([-1.0]);
        let leaves = vec![(Some(0), -1.0), (Some(1), -0.4), (Some(2), -0.4)];
        let joins = vec![
            join(Some(0), Some(1), -0.1),
            join(Some(0), Some(2), -0.099_999_9),
        ];
        let trees = merge(leaves, joins, &scale);
        let expected = [
            leaf(Some(0), -1.0),
            leaf(Some(1), -0.4),
            leaf(Some(2), -0.4),
        ];
        let [Tree::Merge { children, .. }] = trees.as_slice() else {
            panic!("{trees:?}");
        };
        assert_eq!(children[..], expected);
    }

    #[test]
    fn what_no_saddle_joins_stays_apart() {
        let scale = EnergyScale::holding([-1.0]);
        let trees = merge(vec![(None, 0.0), (Some(0), -1.0)], Vec::new(), &scale);
        assert_eq!(trees, [leaf(Some(0), -1.0), leaf(None, 0.0)]);
    }
}
