//! The linear system for the values at the corners of a mesh.

use super::equations::{Equations, Sought, Unsolved};
use super::nodes::Nodes;
use super::octree::Octree;

/// The stiffness matrix of the corners with unknown values.
pub(in crate::kinetics) struct System<'a> {
    mesh: &'a Octree,
    nodes: &'a Nodes,
    pins: &'a [Option<usize>],
    equations: Equations,
}

impl<'a> System<'a> {
    /// The system with given values at corners that belong to a place.
    pub fn new(mesh: &'a Octree, nodes: &'a Nodes, pins: &'a [Option<usize>]) -> Self {
        let is_asked = |node: usize| !nodes.is_hanging(node) && pins[node].is_none();
        let equations = Equations::new(nodes.len(), &is_asked, &entries(mesh, nodes));
        Self {
            mesh,
            nodes,
            pins,
            equations,
        }
    }

    /// The number of unknowns.
    pub fn len(&self) -> usize {
        self.equations.len()
    }

    /// The function that is 1 in a place and 0 in the others, starting from a guess if there is
    /// one.
    pub fn committor<'b>(&self, place: usize, guess: Option<&'b Vec<f64>>) -> Sought<'b> {
        let one = |pin: &Option<usize>| if *pin == Some(place) { 1.0 } else { 0.0 };
        Sought {
            given: self.pins.iter().map(one).collect(),
            right: None,
            guess: guess.map(Vec::as_slice),
        }
    }

    /// The function that is 0 in all places, with this load at each corner.
    pub fn loaded<'b>(&self, load: &'b [f64], guess: Option<&'b Vec<f64>>) -> Sought<'b> {
        Sought {
            given: vec![0.0; self.pins.len()],
            right: Some(load),
            guess: guess.map(Vec::as_slice),
        }
    }

    /// The values of functions at all corners.
    ///
    /// # Errors
    /// If the solver does not converge.
    pub fn solve<const N: usize>(&self, sought: [Sought; N]) -> Result<[Vec<f64>; N], Unsolved> {
        let found = self.solve_all(&sought)?;
        Ok(found.try_into().expect("as many as were sought"))
    }

    /// The same for any number of functions.
    ///
    /// # Errors
    /// If the solver does not converge.
    pub fn solve_all(&self, sought: &[Sought]) -> Result<Vec<Vec<f64>>, Unsolved> {
        let mut found = self
            .equations
            .solve(&entries(self.mesh, self.nodes), sought)?;
        for values in &mut found {
            self.nodes.interpolate(values);
        }
        Ok(found)
    }

    /// The flow into each place (rad).
    pub fn flows(&self, values: &[f64], places: usize) -> Vec<f64> {
        // Out of each corner that does not hang: the stiffness times the values.
        let mut out = vec![0.0; values.len()];
        entries(self.mesh, self.nodes)(&mut |i, j, entry| out[i] += entry * values[j]);
        let mut into = vec![0.0; places];
        for (pin, out) in self.pins.iter().zip(out) {
            if let Some(place) = pin {
                into[*place] -= out;
            }
        }
        into
    }
}

/// Calls a function with every entry that a cell adds to the stiffness of corners that do not hang.
fn entries(mesh: &Octree, nodes: &Nodes) -> impl Fn(&mut dyn FnMut(usize, usize, f64)) + Sync {
    move |call| {
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
}

/// The sum of the loads of cells that are not `left_out` at each corner that does not hang.
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
