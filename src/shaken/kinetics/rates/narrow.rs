//! Wells between contacts that are narrower than the cells of a mesh.
//!
//! A tab in its slot moves by tenths of a millimetre. Few or no integration lines through a cell
//! meet such a well. So the cells with most of its occupation are divided until the integral
//! converges.

use super::field::MeshField;
use super::sets::reaching;
use crate::kinetics::mesh::Leaf;
use tiles::configuration::Configuration;

/// Height (in kT) above a state up to which its well is considered.
const DEEP: f64 = 3.0;
/// Cells with more than this share of it are divided ...
const SHARE: f64 = 1e-3;
/// ... until it changes by less than this share twice in a row, ...
const CHANGE: f64 = 3e-3;
/// ... at most this often.
const ROUNDS: usize = 8;
/// Ratio of successive changes of an integral when its cell is divided.
const LEFT: f64 = 0.5;

impl MeshField<'_> {
    /// Divides the cells around the wells of states until their integrals converge. This leaves
    /// cells without free configurations that are too small to prove anything by: whether there are
    /// paths is to be known before. It may also cut paths, so those from `starts` are opened again.
    pub(super) fn settle(&mut self, states: &[Configuration], starts: &[Configuration]) {
        if self.problem.contact.is_some() {
            states.iter().for_each(|state| self.settle_one(state));
        }
        for start in starts {
            self.open_way(start);
        }
    }

    fn settle_one(&mut self, state: &Configuration) {
        let limit = self.problem.energy(state) + DEEP * self.kt;
        let mut calm = 0;
        for _ in 0..ROUNDS {
            let beside = self.mesh.joined(&|leaf| !leaf.blocked);
            let well = reaching(&self.mesh, &beside, state, limit);
            let whole: f64 = well.iter().map(|&id| self.mesh.held(id)).sum();
            let mut divided: Vec<usize> = Vec::new();
            for &id in well
                .iter()
                .filter(|&&id| self.mesh.held(id) > SHARE * whole)
            {
                let around = beside[id].iter().map(|&other| other as usize);
                let is_closed = |id: &usize| self.mesh.leaves[*id].element.is_none();
                divided.extend(around.filter(is_closed).chain([id]));
            }
            divided.sort_unstable();
            divided.dedup();
            let before = self.mesh.leaves.len();
            let known: Vec<f64> = (0..before).map(|id| self.mesh.held(id)).collect();
            self.divide(&divided);
            let is_gone = |id: &usize| !self.mesh.leaves[*id].is_live();
            let gone: f64 = (0..before).filter(is_gone).map(|id| known[id]).sum();
            let come: f64 = (before..self.mesh.leaves.len())
                .map(|id| self.mesh.held(id))
                .sum();
            calm = match (come - gone).abs() <= CHANGE * whole {
                true => calm + 1,
                false => 0,
            };
            if calm == 2 {
                return;
            }
        }
    }

    /// Divides cells, and records the change of their integrals.
    pub(super) fn divide(&mut self, cells: &[usize]) {
        let weight = |leaf: &Leaf| leaf.element.as_ref().map_or(0.0, |it| it.weight);
        let known: Vec<f64> = self.mesh.leaves.iter().map(weight).collect();
        for &id in cells {
            self.mesh.divide(id);
        }
        self.evaluate();
        let mut parts = vec![0.0; self.mesh.leaves.len()];
        // Parts that are divided themselves come before their own.
        for id in (known.len()..parts.len()).rev() {
            let leaf = &self.mesh.leaves[id];
            if let Some(parent) = leaf.parent {
                parts[parent as usize] += parts[id] + weight(leaf);
            }
        }
        for id in known.len()..parts.len() {
            let parent = self.mesh.leaves[id]
                .parent
                .map_or(id, |parent| parent as usize);
            if let Some(before) = known.get(parent) {
                let most = parts[parent].max(*before).max(f64::MIN_POSITIVE);
                self.mesh.leaves[id].doubt = LEFT * (parts[parent] - before).abs() / most;
            }
        }
    }
}
