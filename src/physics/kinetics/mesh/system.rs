//! The linear system of a mesh's corners.

use super::equations::{Equations, Unsolved};
use super::nodes::Nodes;
use super::octree::Octree;

/// The stiffness of the corners whose values are to be found.
pub(in crate::kinetics) struct System<'a> {
    nodes: &'a Nodes,
    equations: Equations<'a>,
}

impl<'a> System<'a> {
    /// With the values at `pinned` corners given.
    pub fn new(mesh: &'a Octree, nodes: &'a Nodes, pinned: &[bool]) -> Self {
        let is_asked = |node: usize| !nodes.is_hanging(node) && !pinned[node];
        let entries = move |call: &mut dyn FnMut(usize, usize, f64)| each_entry(mesh, nodes, call);
        Self {
            nodes,
            equations: Equations::new(nodes.len(), &is_asked, Box::new(entries)),
        }
    }

    /// How many values are to be found.
    pub fn len(&self) -> usize {
        self.equations.len()
    }

    /// The function with these values at the pinned corners and this load at each corner, found
    /// from a guess.
    ///
    /// # Errors
    /// Where it is not found.
    pub fn solve(&self, pinned: &[f64], load: &[f64], guess: &[f64]) -> Result<Vec<f64>, Unsolved> {
        let mut values = self.equations.solve(pinned, load, guess)?;
        self.nodes.interpolate(&mut values);
        Ok(values)
    }

    /// What flows out of each corner that does not hang: the stiffness times the values (rad).
    pub fn fluxes(&self, values: &[f64]) -> Vec<f64> {
        self.equations.product(values)
    }
}

/// Calls with every entry that a cell adds to the stiffness of corners that do not hang.
fn each_entry(mesh: &Octree, nodes: &Nodes, call: &mut dyn FnMut(usize, usize, f64)) {
    for (id, _, element) in mesh.live() {
        let corners = nodes.corners[id];
        for (a, &corner) in corners.iter().enumerate() {
            for (b, &other) in corners.iter().enumerate() {
                let entry = element.entry(a, b);
                for &(i, by_i) in &nodes.sources[corner as usize] {
                    for &(j, by_j) in &nodes.sources[other as usize] {
                        call(i as usize, j as usize, entry * by_i * by_j);
                    }
                }
            }
        }
    }
}

/// What the loads of cells that are not `left_out` add up to at each corner that does not hang.
pub(in crate::kinetics) fn loads(mesh: &Octree, nodes: &Nodes, left_out: &[bool]) -> Vec<f64> {
    let mut sums = vec![0.0; nodes.len()];
    for (id, _, element) in mesh.live().filter(|(id, ..)| !left_out[*id]) {
        for (&corner, load) in nodes.corners[id].iter().zip(element.load) {
            for &(of, share) in &nodes.sources[corner as usize] {
                sums[of as usize] += share * load;
            }
        }
    }
    sums
}
