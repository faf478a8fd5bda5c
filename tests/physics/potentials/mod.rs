//! Energies between two tiles. Every kind of energy passes every law: the kinds are the entries of
//! [`kinds::all`], their laws are in [`laws`], those of their bounds over cells in [`cells`], and
//! what is special to one kind has its own file.

mod blocks;
mod cells;
mod dipoles;
mod factor;
mod fixtures;
mod kinds;
mod laws;
mod levels;
mod limits;
mod shielding;
mod vectors;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use tilebind::potential::shielding::{Shield, Shields};

/// Shields on all faces of the one tile and on all but one of the other's, at least 10 to the power
/// `narrowest` wide.
fn any_shields(rng: &mut ChaCha8Rng, narrowest: f64) -> Shields {
    let mut shield = || Shield {
        attenuation: rng.random_range(0.0..1.0),
        length: 10f64.powf(rng.random_range(-2.5..-0.5)),
        width: 10f64.powf(rng.random_range(narrowest..0.0)),
        front_gain: rng.random_range(0.8..1.3),
    };
    Shields {
        fixed: (0..4).map(|_| Some(shield())).collect(),
        moving: (0..4).map(|k| (k > 0).then(&mut shield)).collect(),
        ..Shields::default()
    }
}
