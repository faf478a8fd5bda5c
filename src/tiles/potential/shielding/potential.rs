//! The energy of two tiles whose magnets are shielded.

use nalgebra::{Vector2, Vector3};

use super::kernel::{self, Columns};
use super::pairs::Bare;
use super::{ShieldRule, Shields, nearest_faces};
use crate::configuration::Configuration;
use crate::potential::lever::Lever;
use crate::potential::simd::Level;
use crate::potential::{BodyPotential, MagnetModel, Potential, finite};
use crate::tile::{Magnet, Tile};

/// The interaction energy of two tiles with shields: each pair's energy times its factor.
#[derive(Clone, Debug)]
pub struct ShieldedPotential {
    level: Level,
    /// Pairs without shields, if they are not dipoles that lie flat.
    bare: Option<Bare>,
    /// The same for each pair of faces, in the order of the fixed faces, for the nearest-face rule.
    faces: Vec<Bare>,
    rule: ShieldRule,
    fixed: Vec<kernel::Magnet>,
    moving: Vec<kernel::Magnet>,
    columns: Columns,
    /// Midpoints of the faces (m), for the nearest-face rule.
    fixed_middles: Vec<Vector2<f64>>,
    moving_middles: Vec<Vector2<f64>>,
    lever: Lever,
}

/// Makes the pairs of magnets without shields, unless they are dipoles that lie flat.
type MakeBare<'a> = dyn Fn(&[Magnet], &[Magnet]) -> Option<Bare> + 'a;

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
        let is_of_bodies = [fixed, moving].map(|tile| model.is_of_bodies(&tile.magnets));
        let bare = |a: &[Magnet], b: &[Magnet]| match model {
            _ if is_of_bodies.contains(&true) => {
                Some(Bare::Bodies(Box::new(BodyPotential::new(model, a, b))))
            }
            MagnetModel::Dipole => None,
            MagnetModel::Cuboid => Some(Bare::blocks(a, b, level)),
        };
        Self::of(&bare, [fixed, moving], shields, level)
    }

    /// Of magnets that are not all blocks that lie flat, faster and with a larger error, see
    /// [`BodyPotential::within`].
    pub fn within(
        error: f64,
        model: MagnetModel,
        fixed: &Tile,
        moving: &Tile,
        shields: &Shields,
    ) -> Self {
        let bare = |a: &[Magnet], b: &[Magnet]| {
            let bodies = BodyPotential::within(error, model, a, b);
            Some(Bare::Bodies(Box::new(bodies)))
        };
        Self::of(&bare, [fixed, moving], shields, Level::best())
    }

    fn of(bare: &MakeBare, [fixed, moving]: [&Tile; 2], shields: &Shields, level: Level) -> Self {
        let middles = |tile: &Tile| tile.faces.iter().map(|face| face.middle()).collect();
        let corners = moving.magnets.iter().flat_map(|magnet| magnet.corners());
        let first = kernel::magnets(fixed, &[]);
        Self {
            level,
            bare: bare(&fixed.magnets, &moving.magnets),
            faces: match shields.rule {
                ShieldRule::NearestFace => by_face(bare, [fixed, moving]),
                ShieldRule::Smooth => Vec::new(),
            },
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
        let own = faces.and_then(|(i, j)| self.faces.get(i * self.moving_middles.len() + j));
        if let Some(bare) = own {
            let bare = bare.potential();
            return match SLOPE {
                true => bare.energy_and_gradient(q),
                false => (bare.energy(q), Vector3::zeros()),
            };
        }
        let bare = self.bare.as_ref();
        let pairs = bare.map(|bare| bare.pairs::<SLOPE>(q, self.fixed.len(), self.columns.len()));
        let (energy, gradient) = self.level.run(kernel::DipoleSum::<SLOPE> {
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
    /// third derivative, with the bounds of pairs for u (`pairs`) and those of the factors for w. With
    /// the nearest-face rule they hold only between the jumps.
    fn bend_bounds(&self, q: &Configuration, reach: f64) -> [f64; 2] {
        let (turn, stride) = (self.lever.turn(), self.columns.len());
        let sizes = [self.moving.len() * stride, stride];
        let bare = self.bare.as_ref();
        let pairs = bare.map(|bare| bare.limits(q, [turn, reach], sizes));
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

    /// The feature length of bare magnets, because shields act over longer distances. Dipoles that lie flat have
    /// usable bounds.
    fn feature_length(&self) -> f64 {
        let bare = self.bare.as_ref();
        bare.map_or(0.0, |bare| bare.potential().feature_length())
    }

    /// The noise of the bare pairs.
    fn noise(&self) -> f64 {
        let bare = self.bare.as_ref();
        bare.map_or(1e-12, |bare| bare.potential().noise())
    }
}

/// The pairs of magnets of each pair of faces, in the order of the fixed faces.
fn by_face(bare: &MakeBare, tiles: [&Tile; 2]) -> Vec<Bare> {
    let on = |tile: &Tile, face: usize| -> Vec<_> {
        let magnets = tile.magnets.iter().filter(|magnet| magnet.face == face);
        magnets.cloned().collect()
    };
    let [first, second] = tiles.map(|tile| {
        let faces = 0..tile.faces.len();
        faces.map(|face| on(tile, face)).collect::<Vec<_>>()
    });
    let pairs = first
        .iter()
        .flat_map(|a| second.iter().map(move |b| (a, b)));
    pairs.filter_map(|(a, b)| bare(a, b)).collect()
}
