//! Shields of a pair of tiles.

use tilebind::potential::shielding::{Shield, Shields};

/// The same shield behind each of the four faces of both tiles.
pub fn behind_all_faces() -> Shields {
    let shield = Shield {
        attenuation: 0.8,
        length: 0.03,
        width: 0.3,
        front_gain: 1.0,
    };
    Shields {
        fixed: vec![Some(shield); 4],
        moving: vec![Some(shield); 4],
        ..Shields::default()
    }
}
