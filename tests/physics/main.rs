//! Magnets and shields, by principle and against independent numbers; tiles as design files say.

mod blocks;
mod bounds;
mod design_files;
#[path = "../shared/designs.rs"]
mod designs;
mod dipole_kernel;
mod dipoles;
mod dynamics;
mod fixtures;
mod shielding;
