//! The kinds of tiles on a table, and the interaction of every two of them.

use nalgebra::Vector2;

use super::goal::Goal;
use crate::matching::MatchRule;
use crate::rigid::{Body, Margins, Rim, World, supports};
use tiles::configuration::Configuration;
use tiles::contact::Contact;
use tiles::potential::shielding::ShieldRule;
use tiles::potential::{Interaction, Potential};
use tiles::tile::Tile;

/// A kind of tiles.
pub struct Kind {
    /// Its name.
    pub name: String,
    /// Its outline and magnets.
    pub tile: Tile,
    /// Its mass and inertia.
    pub body: Body,
    /// Largest distance of a point of the tile from its centre of mass (m).
    pub reach: f64,
    /// The points at which it lies on the table, about its centre of mass (m).
    pub supports: Vec<Vector2<f64>>,
}

impl Kind {
    /// A kind with this name.
    pub fn new(name: impl Into<String>, tile: Tile) -> Self {
        let body = Body::of_tile(&tile);
        let corners = tile.outline.vertices().iter();
        let reach = corners.map(|it| (it - body.centre).norm());
        Self {
            name: name.into(),
            reach: reach.fold(0.0, f64::max),
            supports: supports(&tile.outline),
            body,
            tile,
        }
    }
}

/// The cut-off of two tiles' energy: the energy is complete up to the distance `from` of the
/// reference points and zero from `to` on; between them it is multiplied by `1 - 10 s^3 + 15 s^4 -
/// 6 s^5`, s from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutoff {
    /// Below this distance (m) the energy is complete.
    pub from: f64,
    /// From this distance (m) on the energy is zero.
    pub to: f64,
    /// The largest pair energy (J) that is cut off, over the sampled poses: [`BEARINGS`] directions
    /// times as many orientations, at `from`.
    pub left_out: f64,
}

/// The error of each pair of magnets whose energy is interpolated, as a share of their dipoles' energy.
const INTERPOLATED: f64 = 1e-5;

/// Number of directions and of orientations sampled for the cut-off.
pub const BEARINGS: usize = 18;

impl Cutoff {
    /// The smallest distance beyond which the energy stays below a tolerance (J).
    fn new(potential: &dyn Potential, touching: f64, tolerance: f64) -> Self {
        let largest = |r: f64| {
            let turn = std::f64::consts::TAU / BEARINGS as f64;
            let mut poses = Vec::with_capacity(BEARINGS * BEARINGS);
            for k in 0..BEARINGS {
                let bearing = turn * k as f64;
                let (x, y) = (r * libm::cos(bearing), r * libm::sin(bearing));
                let poses_here =
                    (0..BEARINGS).map(|l| Configuration::from([x, y, turn * l as f64]));
                poses.extend(poses_here);
            }
            let mut energies = vec![0.0; poses.len()];
            potential.energies(&poses, &mut energies);
            energies.into_iter().map(f64::abs).fold(0.0, f64::max)
        };
        // Energies fall like the third power of the distance or faster, once tiles are apart.
        let (mut low, mut high) = (touching, touching);
        let mut left_out = largest(high);
        while left_out > tolerance && high < 1e3 * touching {
            low = high;
            high *= 1.5;
            left_out = largest(high);
        }
        for _ in 0..4 {
            let middle = 0.5 * (low + high);
            let there = largest(middle);
            match there > tolerance {
                true => low = middle,
                false => (high, left_out) = (middle, there),
            }
        }
        Self {
            from: high,
            to: 1.15 * high,
            left_out,
        }
    }

    /// The factor at a distance r (m), and its derivative (1/m).
    pub(super) fn factor(&self, r: f64) -> (f64, f64) {
        if r <= self.from {
            return (1.0, 0.0);
        }
        if r >= self.to {
            return (0.0, 0.0);
        }
        let width = self.to - self.from;
        let s = (r - self.from) / width;
        let value = 1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0));
        let slope = -30.0 * s * s * (1.0 - s) * (1.0 - s) / width;
        (value, slope)
    }
}

/// The interaction of two kinds: the first takes the place of a pair's fixed tile.
pub struct Couple {
    /// Their outlines.
    pub contact: Contact,
    /// U(x, y, theta).
    pub potential: Box<dyn Potential + Send>,
    /// The criteria of their bonds; empty for kinds that do not bond.
    pub bonds: Vec<MatchRule>,
    /// The cut-off of the energy.
    pub cutoff: Cutoff,
    /// Outlines closer than this (m) count as near.
    pub near: f64,
}

/// The kinds of tiles on a table, with their interactions.
pub struct Crowd {
    /// The kinds.
    pub kinds: Vec<Kind>,
    /// The couple of the kinds i <= j has the index `j (j + 1) / 2 + i`.
    couples: Vec<Couple>,
    /// The rim of the table.
    pub rim: Rim,
    /// What the tiles are to build, if it is stated.
    pub goal: Option<Goal>,
    /// The number of faces of each kind by which it can bind.
    binding_faces: Vec<usize>,
    /// The energy (J) of the shallowest bond; 0 without bonds.
    shallowest: f64,
}

/// Why tiles cannot be simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CrowdError {
    /// Shields follow the nearest-face rule.
    #[error(
        "with [shield] rule = \"nearest-face\" energies jump and forces are not their gradients: use the \
         smooth rule"
    )]
    NearestFace,
}

impl Crowd {
    /// Creates the kinds on a table. `interaction` gives the interaction of two kinds, `bonds` the
    /// criteria of their bonds. Energies below `tolerance` (J) are cut off.
    ///
    /// # Errors
    /// If the forces are not the gradients of energies.
    pub fn new(
        kinds: Vec<Kind>,
        rim: Rim,
        tolerance: f64,
        interaction: &dyn Fn(usize, usize) -> Interaction,
        mut bonds: impl FnMut(usize, usize) -> Vec<MatchRule>,
    ) -> Result<Self, CrowdError> {
        let mut couples = Vec::new();
        for j in 0..kinds.len() {
            for i in 0..=j {
                let acts = interaction(i, j);
                if acts.shields.rule == ShieldRule::NearestFace {
                    return Err(CrowdError::NearestFace);
                }
                let [first, second] = [&kinds[i].tile, &kinds[j].tile];
                let potential = acts.in_motion(INTERPOLATED, first, second);
                let radii = first.outline.circumradius() + second.outline.circumradius();
                let magnets = first.magnets.iter().chain(&second.magnets);
                let length = magnets.map(|magnet| magnet.size[0]).fold(0.0, f64::max);
                couples.push(Couple {
                    contact: Contact::new(&first.outline, &second.outline),
                    cutoff: Cutoff::new(potential.as_ref(), radii, tolerance),
                    potential,
                    bonds: bonds(i, j),
                    near: (2.0 * length).max(0.05 * radii),
                });
            }
        }
        let bonds = couples.iter().flat_map(|couple| {
            let poses = couple.bonds.iter().flat_map(MatchRule::poses);
            poses.map(|pose| couple.potential.energy(&pose))
        });
        let shallowest = bonds.fold(f64::NEG_INFINITY, f64::max).min(0.0);
        let mut crowd = Self {
            binding_faces: Vec::new(),
            shallowest: if shallowest.is_finite() {
                shallowest
            } else {
                0.0
            },
            goal: None,
            kinds,
            couples,
            rim,
        };
        crowd.binding_faces = (0..crowd.kinds.len())
            .map(|kind| crowd.count_faces(kind))
            .collect();
        Ok(crowd)
    }

    /// The interaction of two kinds, and whether the couple's first kind is the second argument.
    pub fn couple(&self, i: usize, j: usize) -> (&Couple, bool) {
        let (low, high) = (i.min(j), i.max(j));
        (&self.couples[high * (high + 1) / 2 + low], i > j)
    }

    /// The number of faces by which a kind can bind.
    pub fn binding_faces(&self, kind: usize) -> usize {
        self.binding_faces[kind]
    }

    fn count_faces(&self, kind: usize) -> usize {
        let mut faces: Vec<Vector2<f64>> = Vec::new();
        let within = 1e-3 * self.kinds[kind].reach;
        for other in 0..self.kinds.len() {
            let (couple, _) = self.couple(kind, other);
            for middles in couple.bonds.iter().flat_map(MatchRule::middles) {
                let own = match kind.cmp(&other) {
                    std::cmp::Ordering::Less => &middles[..1],
                    std::cmp::Ordering::Equal => &middles[..],
                    std::cmp::Ordering::Greater => &middles[1..],
                };
                for middle in own {
                    if faces.iter().all(|known| (known - middle).norm() > within) {
                        faces.push(*middle);
                    }
                }
            }
        }
        faces.len()
    }

    /// The energy (J) of the shallowest bond; 0 without bonds.
    pub fn shallowest_bond(&self) -> f64 {
        self.shallowest
    }

    /// All couples.
    pub fn couples(&self) -> &[Couple] {
        &self.couples
    }

    /// The largest cut-off distance of all couples (m).
    pub fn range(&self) -> f64 {
        let reach = |couple: &Couple| couple.cutoff.to.max(couple.radii() + couple.near);
        self.couples.iter().map(reach).fold(0.0, f64::max)
    }

    /// The lengths of contact.
    pub(super) fn margins(&self) -> Margins {
        Margins::of(self.kinds.iter().map(|kind| &kind.tile))
    }

    /// The table's area (m^2).
    pub fn area(&self) -> f64 {
        self.rim.area()
    }
}

/// The longest step (s) for which the limits of steps in contact are stated, for tiles of this size.
pub fn usual_step(crowd: &Crowd) -> f64 {
    crowd.margins().usual_step
}

impl World for Crowd {
    fn body(&self, kind: usize) -> &Body {
        &self.kinds[kind].body
    }

    fn reach(&self, kind: usize) -> f64 {
        self.kinds[kind].reach
    }

    fn corners(&self, kind: usize) -> &[Vector2<f64>] {
        self.kinds[kind].tile.outline.vertices()
    }

    fn supports(&self, kind: usize) -> &[Vector2<f64>] {
        &self.kinds[kind].supports
    }

    fn contact(&self, [first, second]: [usize; 2]) -> &Contact {
        &self.couple(first, second).0.contact
    }

    fn pull(&self, [first, second]: [usize; 2], q: &Configuration) -> (f64, Vector2<f64>, f64) {
        self.couple(first, second).0.pull(q)
    }

    fn rim(&self) -> Rim {
        self.rim
    }
}

impl Couple {
    /// The distance (m) of the reference points beyond which the tiles cannot touch.
    pub fn radii(&self) -> f64 {
        self.contact.fixed().circumradius() + self.contact.moving().circumradius()
    }

    /// U (J) of the second tile at a pose in the first one's frame, cut off, with the force (N) on it in
    /// that frame and the torque (N m) about its reference point.
    pub(super) fn pull(&self, q: &Configuration) -> (f64, Vector2<f64>, f64) {
        let r = q.position().norm();
        let (factor, slope) = self.cutoff.factor(r);
        if factor == 0.0 {
            return (0.0, Vector2::zeros(), 0.0);
        }
        let (energy, gradient) = self.potential.energy_and_gradient(q);
        let mut force = -gradient.xy() * factor;
        if slope != 0.0 {
            force -= q.position() * (energy * slope / r);
        }
        (energy * factor, force, -gradient.z * factor)
    }
}
