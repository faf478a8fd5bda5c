//! The models of the magnets.

use crate::tile::magnet::Form;
use crate::tile::{Magnet, Pair};

/// How magnets are modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MagnetModel {
    /// Point dipoles at the blocks' centres.
    Dipole,
    /// Uniformly magnetised blocks and discs: the default.
    #[default]
    Cuboid,
}

impl MagnetModel {
    /// The name of each model in design files.
    pub const NAMES: [(&'static str, Self); 2] =
        [("dipole", Self::Dipole), ("cuboid", Self::Cuboid)];

    /// The plural for a pair's magnets in this model: `dipoles`, `blocks`, `discs`.
    pub fn plural(self, pair: &Pair) -> &'static str {
        match self {
            Self::Dipole => "dipoles",
            Self::Cuboid => pair.bodies(),
        }
    }

    /// Whether magnets need [`super::BodyPotential`]: blocks and dipoles that lie flat have their
    /// own formulas.
    pub fn is_of_bodies(self, magnets: &[Magnet]) -> bool {
        magnets.iter().any(|magnet| match self {
            Self::Dipole => magnet.form.stands.is_some(),
            Self::Cuboid => magnet.form != Form::default(),
        })
    }

    /// The name of this model in design files.
    pub fn name(self) -> &'static str {
        let own = Self::NAMES.iter().find(|(_, model)| *model == self);
        own.expect("all are named").0
    }
}
