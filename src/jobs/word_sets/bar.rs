//! The magnets of words.

use super::face;
use crate::design::{Design, MagnetModel};
use physics::words::Bar;

/// The magnets of a design's target face and the face's length (m); without a design the paper's
/// magnets, on a face as long as needed. A given pitch (m) or model overrides the design's.
///
/// # Errors
/// If the design gives no pitch, or words cannot be made of its magnets.
pub fn bar(
    design: Option<&Design>,
    pitch: Option<f64>,
    model: Option<MagnetModel>,
) -> Result<(Bar, Option<f64>), String> {
    let (bar, face) = match design {
        None => (Bar::paper(), None),
        Some(design) => {
            let (pair, why) = (&design.pair, "words need equal magnets behind a flat face");
            let pitch = pitch
                .or(design.pitch)
                .ok_or("the design has no pitch; give one, such as 0.04 (m)")?;
            let bar = Bar::of_face(&pair.fixed, pair.target.0, &design.interaction, pitch)
                .map_err(|error| format!("{error}; {why}, as in shapes/paper-tile.toml"))?;
            (bar, Some(face(design)))
        }
    };
    let bar = Bar {
        pitch: pitch.unwrap_or(bar.pitch),
        model: model.unwrap_or(bar.model),
        ..bar
    };
    Ok((bar, face))
}

/// Least distance of two magnets in places, so that they do not overlap.
pub fn least_spacing(bar: &Bar) -> usize {
    (bar.size[1] / bar.pitch * (1.0 - 1e-9)).ceil() as usize
}
