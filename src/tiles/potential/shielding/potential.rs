//! The energy of two tiles whose magnets are shielded.

use nalgebra::{Vector2, Vector3};

use super::kernel::{self, Columns, PairColumns};
use super::{ShieldRule, Shields, nearest_faces};
use crate::configuration::Configuration;
use crate::potential::cuboid::block::Block;
use crate::potential::cuboid::limits::{Limits, face_distances};
use crate::potential::lever::Lever;
use crate::potential::simd::Level;
use crate::potential::{CuboidPotential, MagnetModel, Potential, finite};
use crate::tile::Tile;

/// The interaction energy of two tiles with shields: each pair's energy times its factor.
#[derive(Clone, Debug)]
pub struct ShieldedPotential {
    level: Level,
    /// Magnets as blocks, if they are not dipoles.
    blocks: Option<Blocks>,
    rule: ShieldRule,
    fixed: Vec<kernel::Magnet>,
    moving: Vec<kernel::Magnet>,
    columns: Columns,
    /// Midpoints of the faces (m), for the nearest-face rule.
    fixed_middles: Vec<Vector2<f64>>,
    moving_middles: Vec<Vector2<f64>>,
    lever: Lever,
}

/// Data of blocks besides their dipoles.
#[derive(Clone, Debug)]
struct Blocks {
    potential: CuboidPotential,
    fixed: Vec<Block>,
    moving: Vec<Block>,
    /// For each pair, in the order of the second magnets.
    limits: Vec<Limits>,
    /// For each pair of faces, in the order of the fixed faces: the bare blocks of the two.
    faces: Vec<CuboidPotential>,
}

impl Blocks {
    fn new(fixed: &Tile, moving: &Tile, level: Level) -> Self {
        let blocks = |tile: &Tile| tile.magnets.iter().map(Block::from).collect::<Vec<_>>();
        let (first, second) = (blocks(fixed), blocks(moving));
        let limits = second
            .iter()
            .flat_map(|second| first.iter().map(|first| Limits::new(first, second)));
        Self {
            potential: CuboidPotential::with_level(&fixed.magnets, &moving.magnets, level),
            limits: limits.collect(),
            fixed: first,
            moving: second,
            faces: Vec::new(),
        }
    }

    /// The same with the blocks of each pair of faces separately.
    fn by_face(self, fixed: &Tile, moving: &Tile, level: Level) -> Self {
        let on = |tile: &Tile, face: usize| -> Vec<_> {
            let magnets = tile.magnets.iter().filter(|magnet| magnet.face == face);
            magnets.cloned().collect()
        };
        let [first, second] = [fixed, moving].map(|tile| {
            let faces = 0..tile.faces.len();
            faces.map(|face| on(tile, face)).collect::<Vec<_>>()
        });
        let pairs = first
            .iter()
            .flat_map(|a| second.iter().map(move |b| (a, b)));
        let faces = pairs.map(|(a, b)| CuboidPotential::with_level(a, b, level));
        Self {
            faces: faces.collect(),
            ..self
        }
    }

    /// Bounds of |u|, |u'| and |u''| of each pair (see [`Limits`]), in columns of the given stride.
    fn limits(&self, q: &Configuration, turn: f64, reach: f64, stride: usize) -> [Vec<f64>; 3] {
        let (sin, cos) = libm::sincos(q.theta);
        let mut columns = [(); 3].map(|()| vec![0.0; self.moving.len() * stride]);
        let mut limits = self.limits.iter();
        for (j, second) in self.moving.iter().enumerate() {
            let moved = second.moved(cos, sin, q.position());
            for (i, (first, limits)) in self.fixed.iter().zip(limits.by_ref()).enumerate() {
                let r = (moved.position - first.position).norm() - reach;
                let distance = r - first.radius() - moved.radius();
                let faces = face_distances(first, &moved).map(|d| (d - reach).max(reach / 16.0));
                let bend = limits.curvature(turn, distance);
                let row = [
                    limits.energy(distance),
                    limits.gradient(turn, distance),
                    bend.min(limits.curvature_of_faces(turn, faces)),
                ];
                for (column, entry) in columns.iter_mut().zip(row) {
                    column[j * stride + i] = entry;
                }
            }
        }
        columns
    }
}

impl ShieldedPotential {
    /// The potential of two tiles with shields, for the fastest instruction set of this machine.
    /// Faces beyond the ends of the lists of shields have none.
    pub fn new(model: MagnetModel, fixed: &Tile, moving: &Tile, shields: &Shields) -> Self {
        Self::with_level(model, fixed, moving, shields, Level::best())
    }

    /// The same for the given instruction set.
    pub fn with_level(
        model: MagnetModel,
        fixed: &Tile,
        moving: &Tile,
        shields: &Shields,
        level: Level,
    ) -> Self {
        let middles = |tile: &Tile| tile.faces.iter().map(|face| face.middle()).collect();
        let corners = moving.magnets.iter().flat_map(|magnet| magnet.corners());
        let blocks = match model {
            MagnetModel::Dipole => None,
            MagnetModel::Cuboid => Some(Blocks::new(fixed, moving, level)),
        };
        let blocks = match shields.rule {
            ShieldRule::NearestFace => blocks.map(|blocks| blocks.by_face(fixed, moving, level)),
            ShieldRule::Smooth => blocks,
        };
        let first = kernel::magnets(fixed, &[]);
        Self {
            level,
            blocks,
            rule: shields.rule,
            columns: Columns::new(&first),
            fixed: first,
            moving: kernel::magnets(moving, &[]),
            fixed_middles: middles(fixed),
            moving_middles: middles(moving),
            lever: Lever::of(corners),
        }
        .with_shields(shields)
    }

    /// The same with other shields that act by the same rule. Faces beyond the ends of the lists have
    /// none.
    pub fn with_shields(&self, shields: &Shields) -> Self {
        let mut changed = self.clone();
        // With the nearest-face rule, magnets act either in full or not at all.
        let smooth = shields.rule == ShieldRule::Smooth;
        for (magnets, shields) in [
            (&mut changed.fixed, &shields.fixed),
            (&mut changed.moving, &shields.moving),
        ] {
            for magnet in magnets {
                let shield = shields.get(magnet.face).copied().flatten();
                magnet.front.0 = shield.filter(|_| smooth);
            }
        }
        changed.columns = Columns::new(&changed.fixed);
        changed
    }

    fn sum<const SLOPE: bool>(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let faces = match self.rule {
            ShieldRule::Smooth => None,
            ShieldRule::NearestFace => Some(nearest_faces(
                [&self.fixed_middles, &self.moving_middles],
                q,
            )),
        };
        if let (Some((i, j)), Some(blocks)) = (faces, &self.blocks) {
            let bare = &blocks.faces[i * self.moving_middles.len() + j];
            return if SLOPE {
                bare.energy_and_gradient(q)
            } else {
                (bare.energy(q), Vector3::zeros())
            };
        }
        let pairs = self.blocks.as_ref().map(|blocks| {
            let pairs = blocks.potential.pairs::<SLOPE>(q);
            PairColumns::new(&pairs, self.fixed.len(), self.columns.len())
        });
        let (energy, gradient) = self.level.run(kernel::Sum::<SLOPE> {
            fixed: &self.columns,
            moving: &self.moving,
            q,
            pairs: pairs.as_ref(),
            faces,
        });
        finite(energy, gradient)
    }
}

impl Potential for ShieldedPotential {
    fn energy(&self, q: &Configuration) -> f64 {
        self.sum::<false>(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        self.sum::<true>(q)
    }

    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        self.bend_bounds(q, reach)[0]
    }

    /// From `|(w u)''| <= |w| |u''| + 2 |w'| |u'| + |w''| |u|` for each pair, and the like of the
    /// third derivative, with the bounds of [`Limits`] for u and those of the factors for w. With
    /// the nearest-face rule they hold only between the jumps.
    fn bend_bounds(&self, q: &Configuration, reach: f64) -> [f64; 2] {
        let (turn, stride) = (self.lever.turn(), self.columns.len());
        let pairs = self
            .blocks
            .as_ref()
            .map(|blocks| blocks.limits(q, turn, reach, stride));
        let [second, third] = self.level.run(kernel::Curvature {
            fixed: &self.columns,
            moving: &self.moving,
            q,
            turn,
            reach,
            pairs: pairs.as_ref(),
        });
        let third = if pairs.is_none() {
            third
        } else {
            f64::INFINITY
        };
        [second, third]
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        self.lever.displacement(step)
    }

    /// The feature length of bare blocks, because shields act over longer distances. Dipoles have
    /// usable bounds.
    fn feature_length(&self) -> f64 {
        self.blocks
            .as_ref()
            .map_or(0.0, |blocks| blocks.potential.feature_length())
    }

    /// The noise of the bare pairs.
    fn noise(&self) -> f64 {
        self.blocks
            .as_ref()
            .map_or(1e-12, |blocks| blocks.potential.noise())
    }
}
