//! The only place where the energy between two tiles is chosen.
//!
//! An [`Interaction`] is the physics as given in a design. [`Interaction::between`] turns it into
//! an [`Energy`]: the potential with its feature length, and its bounds over cells, or the reason
//! why there are none. All other modules use a [`Problem`](crate::problem::Problem) and do not
//! depend on the model.
//!
//! # Adding physics
//! To add another force between tiles (for example capillary attraction of faces coded by wetting),
//! add:
//!
//! 1. a new module here with its `Potential` (energy, gradient, bounds of derivatives, feature
//!    length), and one with its `CellBounds`, or none;
//! 2. `potential/mod.rs`: the module's name and a line of the table of models;
//! 3. this file: its description in a design, as a field of [`Interaction`], and its branch in
//!    [`Interaction::between`]; a sum of two energies is a `Potential` of its own, whose enclosures
//!    are the sums of theirs;
//! 4. `tile/mod.rs`: the features of a face other than magnets;
//! 5. `problem/symmetry.rs`: the turns of a tile onto itself that preserve it;
//! 6. `landscape/meeting.rs`: the report on faces in contact;
//! 7. `report/json.rs`: the model's name in results;
//!
//! and its keys in the design reader. Roadmap, landscape, certificates, dynamics and pictures stay
//! as they are.

use std::sync::LazyLock;

use super::bounds::{
    BoxedBounds, CuboidBounds, DipoleBounds, MixedBounds, ShieldedBounds, ShieldedPairBounds,
};
use super::shielding::{ShieldRule, Shields};
use super::{
    BodyPotential, CuboidPotential, DipolePotential, MagnetModel, Potential, ShieldedPotential,
};
use crate::tile::magnet::{Form, Shape};
use crate::tile::{Magnet, Pair, Tile};

/// Up to this many pairs of blocks are interpolated one by one.
const FEW_PAIRS: usize = 64;

/// The interaction between two tiles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Interaction {
    /// How magnets are modelled.
    pub model: MagnetModel,
    /// The soft-iron shields of the faces, and how they act.
    pub shields: Shields,
}

/// Why an energy has no bounds over cells.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, serde::Serialize, serde::Deserialize,
)]
pub enum Unbounded {
    /// Discs and upright magnets that stick out of their tiles.
    #[error(
        "bounds over cells are not available for discs and upright magnets that stick out of their tiles"
    )]
    Bodies,
    /// The nearest-face rule, see [`super::shielding`].
    #[error("the energy is discontinuous where the nearest-face rule changes faces")]
    NearestFace,
    /// A caller's energy without bounds.
    #[error("bounds over cells are not available for this energy")]
    Unknown,
}

/// An energy and its proved bounds.
pub struct Energy {
    /// U and its derivatives.
    pub potential: Box<dyn Potential + Send>,
    /// Its bounds over cells, or why there are none.
    pub bounds: Result<LazyBounds, Unbounded>,
}

/// Bounds over cells, built on first use: for blocks this takes longer than many energies.
pub type LazyBounds = LazyLock<BoxedBounds, Box<dyn FnOnce() -> BoxedBounds + Send>>;

/// Makes bounds for a model of magnets, two tiles and their shields.
pub type MakeBounds = fn(MagnetModel, &Tile, &Tile, &Shields) -> BoxedBounds;

impl Interaction {
    /// Makes bounds of the energy between two tiles over cells.
    ///
    /// # Errors
    /// Why there are none.
    pub fn bounds(&self, fixed: &Tile, moving: &Tile) -> Result<MakeBounds, Unbounded> {
        let Self { model, shields } = self;
        let (first, second) = (&fixed.magnets, &moving.magnets);
        match model {
            _ if shields.rule == ShieldRule::NearestFace => Err(Unbounded::NearestFace),
            _ if model.is_of_bodies(first) || model.is_of_bodies(second) => {
                match MixedBounds::exist(*model, [fixed, moving]) {
                    true if shields.is_none() => {
                        Ok(|model, a, b, _| Box::new(MixedBounds::new(model, a, b)))
                    }
                    true => Ok(of_shielded_pairs),
                    false => Err(Unbounded::Bodies),
                }
            }
            MagnetModel::Dipole if shields.is_none() => {
                Ok(|_, a, b, _| Box::new(DipoleBounds::new(a, b)))
            }
            MagnetModel::Dipole => {
                Ok(|_, a, b, shields| Box::new(ShieldedBounds::new(a, b, shields)))
            }
            MagnetModel::Cuboid if shields.is_none() => {
                Ok(|_, a, b, _| Box::new(CuboidBounds::new(a, b)))
            }
            MagnetModel::Cuboid => Ok(of_shielded_pairs),
        }
    }

    /// The energy between two tiles.
    pub fn between(&self, fixed: &Tile, moving: &Tile) -> Energy {
        let Self { model, shields } = self;
        let (first, second) = (&fixed.magnets, &moving.magnets);
        let bounds = self.bounds(fixed, moving).map(|make| {
            let model = *model;
            let (fixed, moving, shields) = (fixed.clone(), moving.clone(), shields.clone());
            let make: Box<dyn FnOnce() -> BoxedBounds + Send> =
                Box::new(move || make(model, &fixed, &moving, &shields));
            LazyBounds::new(make)
        });
        let potential: Box<dyn Potential + Send> = match shields.is_none() {
            true => bare(*model, first, second),
            false => Box::new(ShieldedPotential::new(*model, fixed, moving, shields)),
        };
        Energy { potential, bounds }
    }

    /// The energy for motions: where it is much faster, each pair of magnets may err by this fraction of
    /// its dipoles' energy (see [`BodyPotential::within`]).
    pub fn in_motion(&self, error: f64, fixed: &Tile, moving: &Tile) -> Box<dyn Potential + Send> {
        let (model, first, second) = (self.model, &fixed.magnets, &moving.magnets);
        let is_of_bodies = model.is_of_bodies(first) || model.is_of_bodies(second);
        // Among many blocks most pairs are far apart, and their series are faster together.
        let is_of_blocks = model == MagnetModel::Cuboid && first.len() * second.len() <= FEW_PAIRS;
        match self.shields.is_none() {
            true if is_of_bodies || is_of_blocks => {
                Box::new(BodyPotential::within(error, model, first, second))
            }
            false if is_of_bodies => Box::new(ShieldedPotential::within(
                error,
                model,
                fixed,
                moving,
                &self.shields,
            )),
            _ => self.between(fixed, moving).potential,
        }
    }

    /// Whether U is the plain sum over pairs of point dipoles that lie flat.
    pub fn is_sum_of_dipoles(&self, pair: &Pair) -> bool {
        let tiles = [&pair.fixed, &pair.moving];
        let model = MagnetModel::Dipole;
        let is_of_bodies = tiles.iter().any(|tile| model.is_of_bodies(&tile.magnets));
        self.model == model && self.shields.is_none() && !is_of_bodies
    }
}

fn of_shielded_pairs(model: MagnetModel, a: &Tile, b: &Tile, shields: &Shields) -> BoxedBounds {
    Box::new(ShieldedPairBounds::new(model, a, b, shields))
}

/// What the energy of two magnets costs, in units of work (see [`crate::budget`]).
#[derive(Clone, Copy, Debug)]
pub struct PairWork {
    /// Among many pairs far apart.
    pub far: f64,
    /// Closer than `reach`, in addition.
    pub near: f64,
    /// The distance (m) up to which charged faces are summed.
    pub reach: f64,
}

/// What the energy of two like magnets of this size (m) costs: estimates from a few runs, which decide
/// budgets only.
pub fn pair_work(model: MagnetModel, form: Form, size: [f64; 3]) -> PairWork {
    if model == MagnetModel::Dipole {
        return PairWork {
            far: 1.0,
            near: 0.0,
            reach: 0.0,
        };
    }
    let longest = size.into_iter().fold(0.0, f64::max);
    let (near, reach) = match (form.shape, form.stands.is_some()) {
        (Shape::Block, false) => (120.0, 4.0),
        (Shape::Block, true) => (1500.0, 3.0),
        (Shape::Disc, false) => (1000.0, 3.0),
        (Shape::Disc, true) => (500.0, 3.0),
    };
    PairWork {
        far: 5.0,
        near,
        reach: reach * longest,
    }
}

/// The energy of two tiles' magnets, without shields.
pub fn bare(model: MagnetModel, first: &[Magnet], second: &[Magnet]) -> Box<dyn Potential + Send> {
    match model {
        _ if model.is_of_bodies(first) || model.is_of_bodies(second) => {
            Box::new(BodyPotential::new(model, first, second))
        }
        MagnetModel::Dipole => Box::new(DipolePotential::new(first, second)),
        MagnetModel::Cuboid => Box::new(CuboidPotential::new(first, second)),
    }
}
