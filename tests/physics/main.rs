//! Magnets and shields, by principle and against independent numbers; tiles as design files say.

mod blocks;
mod design_files;
#[path = "../shared/designs.rs"]
mod designs;
mod fixtures;
mod shielding;
