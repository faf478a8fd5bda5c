//! The criterion by which two tiles count as matched.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use super::DockingError;
use crate::configuration::Configuration;
use crate::problem::{Problem, Symmetry};

/// A match in the paper's sense: every magnet of the target face is within a threshold of its
/// partner on the other tile. Faces that a symmetry of the tiles maps onto the target faces count
/// as well.
#[derive(Clone, Debug)]
pub struct MatchRule {
    /// Largest distance of two partners' centres (m).
    pub threshold: f64,
    /// Centres of the partners in the fixed and in the moving tile's frame (m).
    pairs: Vec<(Vector2<f64>, Vector2<f64>)>,
    symmetries: Vec<Symmetry>,
}

impl MatchRule {
    /// The rule of a pair of tiles. Without a `threshold` (m) it is 1.5 lengths of the longest magnet of
    /// the target face; where partners are more than one length apart in the bound configuration,
    /// that distance and half a length.
    ///
    /// # Errors
    /// If one of the target faces has no magnets.
    pub fn new(problem: &Problem, threshold: Option<f64>) -> Result<Self, DockingError> {
        let pair = problem.pair.as_deref().ok_or(DockingError::NoMagnets)?;
        let on = |magnets: &'_ [crate::tile::Magnet], face: usize| -> Vec<_> {
            magnets.iter().filter(|m| m.face == face).cloned().collect()
        };
        let fixed = on(&pair.fixed.magnets, pair.target.0);
        let moving = on(&pair.moving.magnets, pair.target.1);
        let apart = |a: &Vector2<f64>, b: &Vector2<f64>| (pair.bound.transform(*b) - a).norm();
        let mut pairs = Vec::new();
        for magnet in &fixed {
            let partner = moving
                .iter()
                .map(|m| m.position)
                .min_by_key(|partner| OrderedFloat(apart(&magnet.position, partner)));
            pairs.extend(partner.map(|partner| (magnet.position, partner)));
        }
        if pairs.is_empty() {
            return Err(DockingError::NoMagnets);
        }
        let length = fixed
            .iter()
            .chain(&moving)
            .map(|m| m.size[0])
            .fold(0.0, f64::max);
        let bound = pairs
            .iter()
            .map(|(a, b)| apart(a, b))
            .fold(length, f64::max);
        Ok(Self {
            threshold: threshold.unwrap_or(bound + 0.5 * length),
            pairs,
            symmetries: problem.symmetries.clone(),
        })
    }

    /// Whether the tiles are matched at `q`.
    pub fn holds(&self, q: &Configuration) -> bool {
        self.symmetries.iter().any(|symmetry| {
            let image = symmetry.apply(q);
            self.pairs
                .iter()
                .all(|(a, b)| (image.transform(*b) - a).norm() <= self.threshold)
        })
    }

    /// The distance (metric of the space) of `q` to the nearest symmetric copy of `other`.
    pub(super) fn distance(
        &self,
        space: &crate::ConfigurationSpace,
        q: &Configuration,
        other: &Configuration,
    ) -> f64 {
        self.symmetries
            .iter()
            .map(|symmetry| space.distance(&symmetry.apply(q), other))
            .fold(f64::INFINITY, f64::min)
    }
}
