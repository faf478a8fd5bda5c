//! The choice of the energy that acts between two tiles, in this one place.
//!
//! An [`Interaction`] is what a design says of the physics; [`Interaction::between`] makes of it an
//! [`Energy`]: the potential with its feature length, and its bounds over cells, or why there are
//! none. Everything above asks a [`Problem`](crate::problem::Problem) and knows no model.
//!
//! # Adding physics
//! Another force between tiles (say, capillary attraction of faces coded by wetting) takes:
//!
//! 1. a module of its own here with its `Potential` (energy, gradient, bounds of derivatives,
//!    feature length), and one with its `CellBounds`, or none;
//! 2. `potential/mod.rs`: the module's name and a line of the table of models;
//! 3. this file: what a design says of it, as a field of [`Interaction`], and its arm in
//!    [`Interaction::between`]; a sum of two energies is a `Potential` of its own, whose
//!    enclosures are the sums of theirs;
//! 4. `tile/mod.rs`: what a face carries beside its magnets;
//! 5. `problem/symmetry.rs`: which turns of a tile onto itself keep it;
//! 6. `landscape/meeting.rs`: what is reported of faces that meet;
//! 7. `report/json/mod.rs`: how the model is named in results;
//!
//! and its keys in the design reader. Roadmap, landscape, certificates, dynamics and pictures stay
//! as they are.

use std::sync::LazyLock;

use super::bounds::{CellBounds, CuboidBounds, DipoleBounds, ShieldedBlockBounds, ShieldedBounds};
use super::shielding::{ShieldRule, Shields};
use super::{
    BodyPotential, CuboidPotential, DipolePotential, MagnetModel, Potential, ShieldedPotential,
};
use crate::tile::{Magnet, Tile};

/// What acts between two tiles.
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
    /// Discs, and magnets that stand.
    #[error("bounds over cells are not available for discs and upright magnets")]
    Bodies,
    /// The nearest-face rule, see [`super::shielding`].
    #[error("the energy is discontinuous where the nearest-face rule changes faces")]
    NearestFace,
    /// An energy that came without bounds.
    #[error("bounds over cells are not available for this energy")]
    Unknown,
}

/// An energy and what is proved of it.
pub struct Energy {
    /// U and its derivatives.
    pub potential: Box<dyn Potential + Send>,
    /// Its bounds over cells, or why there are none.
    pub bounds: Result<LazyBounds, Unbounded>,
}

/// Bounds over cells, made when they are first asked for: those of blocks take longer than many
/// energies.
pub type LazyBounds = LazyLock<BoxedBounds, Box<dyn FnOnce() -> BoxedBounds + Send>>;

/// Bounds over cells of any energy.
pub type BoxedBounds = Box<dyn CellBounds + Send>;

impl Interaction {
    /// The energy between two tiles.
    pub fn between(&self, fixed: &Tile, moving: &Tile) -> Energy {
        let Self { model, shields } = self;
        let (first, second) = (&fixed.magnets, &moving.magnets);
        let bounds: Result<fn(&Tile, &Tile, &Shields) -> BoxedBounds, _> = match model {
            _ if shields.rule == ShieldRule::NearestFace => Err(Unbounded::NearestFace),
            _ if model.is_of_bodies(first) || model.is_of_bodies(second) => Err(Unbounded::Bodies),
            MagnetModel::Dipole if shields.is_none() => {
                Ok(|a, b, _| Box::new(DipoleBounds::new(a, b)))
            }
            MagnetModel::Dipole => Ok(|a, b, shields| Box::new(ShieldedBounds::new(a, b, shields))),
            MagnetModel::Cuboid if shields.is_none() => {
                Ok(|a, b, _| Box::new(CuboidBounds::new(a, b)))
            }
            MagnetModel::Cuboid => {
                Ok(|a, b, shields| Box::new(ShieldedBlockBounds::new(a, b, shields)))
            }
        };
        let bounds = bounds.map(|make| {
            let (fixed, moving, shields) = (fixed.clone(), moving.clone(), shields.clone());
            let make: Box<dyn FnOnce() -> BoxedBounds + Send> =
                Box::new(move || make(&fixed, &moving, &shields));
            LazyBounds::new(make)
        });
        let potential: Box<dyn Potential + Send> = match shields.is_none() {
            true => bare(*model, first, second),
            false => Box::new(ShieldedPotential::new(*model, fixed, moving, shields)),
        };
        Energy { potential, bounds }
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
