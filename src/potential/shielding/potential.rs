//! The energy of two tiles whose magnets are shielded.

use nalgebra::{Vector2, Vector3};

use super::{Front, PairFactor, ShieldRule, Shields, pair_factor};
use crate::configuration::Configuration;
use crate::potential::cuboid::block::{Block, PairEnergy};
use crate::potential::cuboid::limits::{Limits, face_distances};
use crate::potential::dipole::{self, Dipole, dipoles};
use crate::potential::lever::Lever;
use crate::potential::{CuboidPotential, MagnetModel, Potential, finite};
use crate::tile::{Magnet, Tile};

/// Energies of single pairs.
#[derive(Clone, Debug)]
enum Pairs {
    Dipole(Vec<Dipole>, Vec<Dipole>),
    Cuboid(CuboidPotential),
}

/// A magnet with what its shield needs.
#[derive(Clone, Debug)]
struct Shielded {
    block: Block,
    face: usize,
    front: Front,
}

/// The interaction energy of two tiles with shields: each pair's energy times its factor.
///
/// It costs several times as much as the bare model, since every pair is weighted by itself.
#[derive(Clone, Debug)]
pub struct ShieldedPotential {
    pairs: Pairs,
    rule: ShieldRule,
    fixed: Vec<Shielded>,
    moving: Vec<Shielded>,
    /// Middles of the faces (m), for the nearest-face rule.
    fixed_middles: Vec<Vector2<f64>>,
    moving_middles: Vec<Vector2<f64>>,
    /// For each pair, second magnet by second magnet.
    limits: Vec<Limits>,
    lever: Lever,
}

fn shielded(tile: &Tile, shields: &[Option<super::Shield>]) -> Vec<Shielded> {
    let front = |magnet: &Magnet| {
        let shield = shields.get(magnet.face).copied().flatten();
        (shield, tile.faces[magnet.face].normal())
    };
    tile.magnets
        .iter()
        .map(|magnet| Shielded {
            block: Block::from(magnet),
            face: magnet.face,
            front: front(magnet),
        })
        .collect()
}

impl ShieldedPotential {
    /// Of two tiles with shields. Faces beyond the ends of the lists of shields have none.
    pub fn new(model: MagnetModel, fixed: &Tile, moving: &Tile, shields: &Shields) -> Self {
        let middles = |tile: &Tile| tile.faces.iter().map(|face| face.middle()).collect();
        let (first, second) = (
            shielded(fixed, &shields.fixed),
            shielded(moving, &shields.moving),
        );
        let limits = second.iter().flat_map(|second| {
            first
                .iter()
                .map(|first| Limits::new(&first.block, &second.block))
        });
        let corners = moving.magnets.iter().flat_map(|magnet| magnet.corners());
        Self {
            pairs: match model {
                MagnetModel::Dipole => {
                    Pairs::Dipole(dipoles(&fixed.magnets), dipoles(&moving.magnets))
                }
                MagnetModel::Cuboid => {
                    Pairs::Cuboid(CuboidPotential::new(&fixed.magnets, &moving.magnets))
                }
            },
            rule: shields.rule,
            limits: limits.collect(),
            fixed: first,
            moving: second,
            fixed_middles: middles(fixed),
            moving_middles: middles(moving),
            lever: Lever::of(corners),
        }
    }

    /// The same with other shields. Faces beyond the ends of the lists have none.
    pub fn with_shields(&self, shields: &Shields) -> Self {
        let mut changed = self.clone();
        changed.rule = shields.rule;
        for (magnets, shields) in [
            (&mut changed.fixed, &shields.fixed),
            (&mut changed.moving, &shields.moving),
        ] {
            for magnet in magnets {
                magnet.front.0 = shields.get(magnet.face).copied().flatten();
            }
        }
        changed
    }

    /// The pairs' energies, second magnet by second magnet.
    fn energies_of_pairs(&self, q: &Configuration) -> Vec<PairEnergy> {
        let (fixed, moving) = match &self.pairs {
            Pairs::Cuboid(potential) => return potential.pairs(q),
            Pairs::Dipole(fixed, moving) => (fixed, moving),
        };
        let rotation = q.rotation();
        let mut out = Vec::with_capacity(fixed.len() * moving.len());
        for second in moving {
            let (place, moment) = (q.transform(second.position), rotation * second.moment);
            for first in fixed {
                let (energy, force, slope) =
                    dipole::pair(first.moment, moment, place - first.position);
                out.push(PairEnergy {
                    energy,
                    gradient: -force,
                    slope,
                });
            }
        }
        out
    }

    /// The pair of faces whose middles are nearest to each other; of equal ones the first.
    fn nearest_faces(&self, q: &Configuration) -> (usize, usize) {
        let mut nearest = (f64::INFINITY, (0, 0));
        for (i, fixed) in self.fixed_middles.iter().enumerate() {
            for (j, moving) in self.moving_middles.iter().enumerate() {
                let distance = (q.transform(*moving) - fixed).norm();
                if distance < nearest.0 {
                    nearest = (distance, (i, j));
                }
            }
        }
        nearest.1
    }
}

impl Potential for ShieldedPotential {
    fn energy(&self, q: &Configuration) -> f64 {
        self.energy_and_gradient(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let rotation = q.rotation();
        let nearest = self.nearest_faces(q);
        let mut energy = 0.0;
        let mut gradient = Vector3::zeros();
        let mut pairs = self.energies_of_pairs(q).into_iter();
        for second in &self.moving {
            let arm = rotation * second.block.position;
            let front = (second.front.0, rotation * second.front.1);
            for first in &self.fixed {
                let pair = pairs.next().unwrap_or_default();
                let factor = match self.rule {
                    ShieldRule::Smooth => {
                        let r = q.position() + arm - first.block.position;
                        pair_factor(first.front, front, r)
                    }
                    ShieldRule::NearestFace => PairFactor {
                        value: f64::from((first.face, second.face) == nearest),
                        gradient: Vector2::zeros(),
                        slope: 0.0,
                    },
                };
                if factor.value == 0.0 && factor.gradient == Vector2::zeros() {
                    continue;
                }
                let place = pair.gradient * factor.value + factor.gradient * pair.energy;
                let turn = pair.slope * factor.value + factor.slope * pair.energy;
                energy += factor.value * pair.energy;
                gradient += Vector3::new(place.x, place.y, turn + arm.perp(&place));
            }
        }
        finite(energy, gradient)
    }

    /// From `|(w u)''| <= |w| |u''| + 2 |w'| |u'| + |w''| |u|` for each pair, with the bounds of
    /// [`Limits`] for u and of [`super::Shield::limits`] for w. With the nearest-face rule it holds
    /// between the jumps only.
    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        let turn = self.lever.turn();
        let (sin, cos) = q.theta.sin_cos();
        let blocks = matches!(self.pairs, Pairs::Cuboid(_));
        let mut bound = 0.0;
        let mut limits = self.limits.iter();
        for second in &self.moving {
            let moved = second.block.moved(cos, sin, q.position());
            for (first, limits) in self.fixed.iter().zip(limits.by_ref()) {
                let r = (moved.position - first.block.position).norm() - reach;
                if r <= 0.0 {
                    return f64::INFINITY;
                }
                let u = if blocks {
                    let distance = r - first.block.radius() - moved.radius();
                    let faces =
                        face_distances(&first.block, &moved).map(|d| (d - reach).max(reach / 16.0));
                    [
                        limits.energy(distance),
                        limits.gradient(turn, distance),
                        limits
                            .curvature(turn, distance)
                            .min(limits.curvature_of_faces(turn, faces)),
                    ]
                } else {
                    [
                        limits.derivative(0, r),
                        limits.derivative(1, r) + turn * limits.derivative(0, r),
                        limits.curvature(turn, r),
                    ]
                };
                let [a, b] = [first.front.0, second.front.0].map(|shield| match self.rule {
                    ShieldRule::Smooth => shield.map_or([1.0, 0.0, 0.0], |s| s.limits(turn, r)),
                    ShieldRule::NearestFace => [1.0, 0.0, 0.0],
                });
                let w = [
                    a[0] * b[0],
                    a[1] * b[0] + a[0] * b[1],
                    a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2],
                ];
                bound += w[0] * u[2] + 2.0 * w[1] * u[1] + w[2] * u[0];
            }
        }
        bound
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        self.lever.displacement(step)
    }

    /// That of the bare pairs.
    fn noise(&self) -> f64 {
        match &self.pairs {
            Pairs::Dipole(..) => 1e-12,
            Pairs::Cuboid(potential) => potential.noise(),
        }
    }
}
