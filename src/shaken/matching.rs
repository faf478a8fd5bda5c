//! The criterion by which two tiles count as matched.

use nalgebra::Vector2;
use ordered_float::OrderedFloat;

use tiles::configuration::Configuration;
use tiles::problem::{Equal, Problem, Symmetry, of_faces};
use tiles::tile::congruence::near_face;
use tiles::tile::{Magnet, Pair, Tile};

/// A target face has no magnets to match by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a match needs magnets on both target faces, but one of them has none")]
pub struct NoMagnets;

/// A match in the paper's sense: every magnet of the target face is within a threshold of its
/// partner on the other tile. A single magnet does not determine how tiles lie against each other,
/// and in the corners of a tile they belong to its other faces: there, the ends of the faces take
/// the magnets' place. All contacts that count as the bond ([`Problem::bonds`]) match.
#[derive(Clone, Debug)]
pub struct MatchRule {
    /// Largest distance of two partners' centres (m).
    pub threshold: f64,
    /// The contacts that count as the bond.
    contacts: Vec<Wanted>,
    symmetries: Vec<Symmetry>,
}

/// A contact that counts as the bond.
#[derive(Clone, Debug)]
struct Wanted {
    /// Its exact configuration.
    pose: Configuration,
    /// The partners in the fixed and in the moving tile's frame (m).
    partners: Vec<[Vector2<f64>; 2]>,
}

impl Wanted {
    /// Its image under a map.
    fn image(&self, map: &Equal) -> Self {
        Self {
            pose: map.apply(&self.pose),
            partners: self.partners.iter().map(|it| map.of_points(*it)).collect(),
        }
    }

    fn holds(&self, q: &Configuration, threshold: f64) -> bool {
        let rotation = q.rotation();
        let apart = |[a, b]: &[Vector2<f64>; 2]| (q.position() + rotation * b - a).norm();
        self.partners.iter().all(|it| apart(it) <= threshold)
    }
}

impl MatchRule {
    /// The rule of a pair of tiles. Without a `threshold` (m) it is 1.5 lengths of the longest magnet of
    /// the target face; where partners are more than one length apart in the bound configuration,
    /// that distance and half a length; but never so large that tiles match which are slid by half
    /// the least spacing of the magnets, or by a quarter of a face without a row of magnets.
    ///
    /// # Errors
    /// If one of the target faces has no magnets, and none in its corners.
    pub fn new(problem: &Problem, threshold: Option<f64>) -> Result<Self, NoMagnets> {
        let maps = problem.bonds().iter().map(|bond| bond.map);
        Self::of(problem, threshold, maps.collect())
    }

    /// The rule of two other tiles whose faces may bind as the target faces of a pair do.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn between(problem: &Problem, tiles: [&Tile; 2]) -> Result<Self, NoMagnets> {
        let pair = problem.pair.as_deref().ok_or(NoMagnets)?;
        Self::of(problem, None, of_faces(pair, tiles))
    }

    /// The rule of a pair of tiles of one kind, where it does not matter which of them counts as the
    /// fixed one.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn of_equals(problem: &Problem) -> Result<Self, NoMagnets> {
        let mut rule = Self::new(problem, None)?;
        let swapped = rule.contacts.iter().map(|it| it.image(&Equal::SWAP));
        let swapped: Vec<_> = swapped.collect();
        rule.contacts.extend(swapped);
        Ok(rule)
    }

    fn of(problem: &Problem, threshold: Option<f64>, maps: Vec<Equal>) -> Result<Self, NoMagnets> {
        let pair = problem.pair.as_deref().ok_or(NoMagnets)?;
        let (partners, usual) = partners(pair).ok_or(NoMagnets)?;
        let target = Wanted {
            pose: pair.bound,
            partners,
        };
        Ok(Self {
            threshold: threshold.unwrap_or(usual),
            contacts: maps.iter().map(|map| target.image(map)).collect(),
            symmetries: problem.symmetries.clone(),
        })
    }

    /// Whether the tiles are matched at `q`.
    pub fn holds(&self, q: &Configuration) -> bool {
        self.contacts.iter().any(|it| it.holds(q, self.threshold))
    }

    /// The exact configuration of the contact that matches at `q`.
    pub fn pose_of(&self, q: &Configuration) -> Option<Configuration> {
        let found = self.contacts.iter().find(|it| it.holds(q, self.threshold));
        found.map(|it| it.pose)
    }

    /// The exact configurations of all contacts that match.
    pub fn poses(&self) -> impl Iterator<Item = Configuration> {
        self.contacts.iter().map(|it| it.pose)
    }

    /// For each contact that matches, the middle of the partners on the fixed and on the moving tile,
    /// in the tile's own frame (m).
    pub fn middles(&self) -> impl Iterator<Item = [Vector2<f64>; 2]> {
        self.contacts.iter().map(|it| {
            let sum = |k: usize| it.partners.iter().map(|pair| pair[k]).sum::<Vector2<f64>>();
            [sum(0), sum(1)].map(|sum| sum / it.partners.len() as f64)
        })
    }

    /// The distance (metric of the space) of `q` to the nearest symmetric copy of `other`.
    pub(super) fn distance(
        &self,
        space: &tiles::ConfigurationSpace,
        q: &Configuration,
        other: &Configuration,
    ) -> f64 {
        self.symmetries
            .iter()
            .map(|symmetry| space.distance(&symmetry.apply(q), other))
            .fold(f64::INFINITY, f64::min)
    }
}

/// The partners of the target faces in the fixed and in the moving tile's frame (m), and the usual
/// threshold of a match (m); `None` if one of the faces has no magnets.
fn partners(pair: &Pair) -> Option<(Vec<[Vector2<f64>; 2]>, f64)> {
    let fixed = near_face(&pair.fixed, pair.target.0);
    let moving = near_face(&pair.moving, pair.target.1);
    if fixed.is_empty() || moving.is_empty() {
        return None;
    }
    let length = fixed.iter().chain(&moving).map(|m| m.size[0]);
    let length = length.fold(0.0, f64::max);
    let apart = |a: &Vector2<f64>, b: &Vector2<f64>| (pair.bound.transform(*b) - a).norm();
    let are_a_row = |magnets: &[&Magnet], face: usize| {
        magnets.len() > 1 && magnets.iter().all(|it| it.face == face)
    };
    if !are_a_row(&fixed, pair.target.0) || !are_a_row(&moving, pair.target.1) {
        let face = pair.target_face();
        let ends = [face.start, face.end].map(|end| [end, pair.bound.inverse_transform(end)]);
        return Some((ends.to_vec(), (1.5 * length).min(face.length() / 4.0)));
    }
    let partner = |magnet: &&Magnet| {
        let nearest = moving
            .iter()
            .map(|it| it.position)
            .min_by_key(|it| OrderedFloat(apart(&magnet.position, it)));
        nearest.map(|it| [magnet.position, it])
    };
    let partners: Vec<_> = fixed.iter().filter_map(partner).collect();
    let farthest = partners
        .iter()
        .map(|[a, b]| apart(a, b))
        .fold(0.0, f64::max);
    let spacing = fixed
        .windows(2)
        .map(|two| (two[1].position - two[0].position).norm())
        .fold(f64::INFINITY, f64::min);
    let usual = farthest.max(length) + 0.5 * length;
    Some((partners, usual.min(libm::hypot(farthest, 0.5 * spacing))))
}
