//! The models of the magnets.

use crate::tile::magnet::Form;
use crate::tile::{Magnet, Pair};

/// How magnets are modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MagnetModel {
    /// Point dipoles at the blocks' centres.
    Dipole,
    /// Uniformly magnetised blocks and discs: what magnets are, and what is taken where nothing is said.
    #[default]
    Cuboid,
}

impl MagnetModel {
    /// What design files call each model.
    pub const NAMES: [(&'static str, Self); 2] =
        [("dipole", Self::Dipole), ("cuboid", Self::Cuboid)];

    /// What a reader calls a pair's magnets of this model: `dipoles`, `blocks`, `discs`.
    pub fn plural(self, pair: &Pair) -> &'static str {
        match self {
            Self::Dipole => "dipoles",
            Self::Cuboid => pair.bodies(),
        }
    }

    /// Whether magnets have to be taken for [`super::BodyPotential`]'s bodies: blocks that lie have formulas of
    /// their own, and so have dipoles that do.
    pub fn is_of_bodies(self, magnets: &[Magnet]) -> bool {
        magnets.iter().any(|magnet| match self {
            Self::Dipole => magnet.form.stands.is_some(),
            Self::Cuboid => magnet.form != Form::default(),
        })
    }

    /// What design files call this model.
    pub fn name(self) -> &'static str {
        let own = Self::NAMES.iter().find(|(_, model)| *model == self);
        own.expect("all are named").0
    }
}
