//! Tiles: outlines, faces and their profiles, barcodes, symmetries.

mod assembly;
mod barcode;
mod edge_grid;
mod outline;
mod profile;
mod symmetry;
