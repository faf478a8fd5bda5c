//! How magnets are modelled.

/// How magnets are modelled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MagnetModel {
    /// Point dipoles at the blocks' centres.
    #[default]
    Dipole,
    /// Uniformly magnetised blocks.
    Cuboid,
}

impl MagnetModel {
    /// What design files call each model.
    pub const NAMES: [(&'static str, Self); 2] =
        [("dipole", Self::Dipole), ("cuboid", Self::Cuboid)];

    /// What design files call this model.
    pub fn name(self) -> &'static str {
        let own = Self::NAMES.iter().find(|(_, model)| *model == self);
        own.expect("all are named").0
    }
}
