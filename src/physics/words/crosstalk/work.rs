//! What sampling costs.

use super::grid::{slide_step, tilts};
use super::{sampled, traps};
use crate::potential::interaction::{PairWork, pair_work};
use crate::words::Bar;

/// Units of work of an energy besides its pairs of magnets: contact, sines, coefficients.
const AN_ENERGY: f64 = 250.0;
/// Of the poses of the grid, the share in which faces lie along each other.
const FACING: f64 = 0.3;
/// Energies for the refinement of a pose.
const REFINED: f64 = 120.0;

/// Units of work to sample words with so many magnets each anywhere along a face (m), mostly for the
/// energies of all couples at all poses of the grid, and for the refinement of their lowest poses.
pub fn sampling_work(bar: &Bar, face: f64, words: usize, magnets: usize) -> u64 {
    let step = slide_step(face, 2 * words * magnets, bar.size[1]);
    let poses = tilts().len() as f64 * (2.0 * face / step + 1.0);
    let PairWork { far, near, reach } = pair_work(bar.model, bar.form, bar.size);
    // Of a magnet's others, those within reach.
    let beside = (1.0 + 2.0 * reach * magnets as f64 / face).min(magnets as f64);
    let (all, close) = ((magnets * magnets) as f64, magnets as f64 * beside);
    let couples = (words * (words + 1)) as f64;
    let on_grid = AN_ENERGY + all * far + FACING * close * near;
    let refined = AN_ENERGY + all * far + close * near;
    let starts = couples * sampled::POLISHED as f64 + (words * traps::POLISHED) as f64;
    (couples * poses * on_grid + starts * REFINED * refined) as u64
}
