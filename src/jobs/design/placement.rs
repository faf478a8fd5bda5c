//! Where the magnets of a face sit in their tile.

use nalgebra::Vector2;

use super::error::Result;
use super::face::{FaceContent, Pattern};
use super::magnet::{ListedMagnet, impossible, missing_key};
use super::quantity::four_digits;
use super::tile::TileEntry;
use physics::configuration::wrap_angle;
use physics::tile::assembly::surface_height;
use physics::tile::barcode::Pole;
use physics::tile::{Face, Magnet};

/// The magnets of a face with all that they take from the keys above them.
pub(super) fn placed(
    entry: &TileEntry,
    content: &FaceContent,
    length: f64,
) -> Result<Vec<ListedMagnet>> {
    match &content.pattern {
        Pattern::List(magnets) => Ok(magnets
            .iter()
            .map(|magnet| ListedMagnet {
                keys: magnet.keys.over(content.keys),
                ..*magnet
            })
            .collect()),
        Pattern::Code(code, spans) => {
            let pitch = match content.keys.pitch {
                Some(pitch) => pitch,
                None if code.len() < 2 => 0.0,
                None => {
                    return Err(missing_key("pitch", |message, help| {
                        entry
                            .section
                            .source
                            .error(content.pattern_span, message, help)
                    }));
                }
            };
            let wide = content.keys.size.map_or(0.0, |size| size[1]);
            let needed = code.len().saturating_sub(1) as f64 * pitch + wide;
            if needed > length * (1.0 + 1e-12) {
                return Err(entry.section.source.error(
                    content.pattern_span,
                    format!(
                        "the code {code} is {} m long, its face {} m",
                        four_digits(needed),
                        four_digits(length)
                    ),
                    match ((length - wide) / pitch).floor().max(-1.0) + 1.0 {
                        1.0 => format!("at a pitch of {pitch} m there is room for 1 magnet"),
                        room => format!("at a pitch of {pitch} m there is room for {room} magnets"),
                    },
                ));
            }
            Ok(code
                .places(pitch)
                .map(|(k, at, pole)| ListedMagnet {
                    at,
                    pole,
                    keys: content.keys,
                    span: spans[k],
                })
                .collect())
        }
    }
}

/// A magnet in the tile's frame: its outermost point `inset` behind the surface at its s.
pub(super) fn magnet(
    entry: &TileEntry,
    (number, face): (usize, &Face),
    edges: &[[[f64; 2]; 2]],
    listed: &ListedMagnet,
) -> Result<Magnet> {
    let error =
        |message: String, help: String| entry.section.source.error(listed.span, message, help);
    let (size, moment) = listed.keys.block().map_err(|key| missing_key(key, error))?;
    if let Some((message, help)) = impossible(size, listed.keys.strength, moment) {
        return Err(error(message, help));
    }
    let Some(surface) = surface_height(edges, listed.at) else {
        return Err(error(
            format!(
                "a magnet at s = {} sits beyond the end of face {}",
                four_digits(listed.at),
                face.name
            ),
            format!(
                "s runs from {} to {} m",
                four_digits(-face.length() / 2.0),
                four_digits(face.length() / 2.0)
            ),
        ));
    };
    let axis = listed.keys.axis.unwrap_or(0.0);
    // How far the block reaches from its centre towards the surface.
    let reach = (size[0] * libm::cos(axis).abs() + size[1] * libm::sin(axis).abs()) / 2.0;
    let height = surface - listed.keys.inset.unwrap_or(0.0) - reach;
    let outward = match listed.pole {
        Pole::North => face.normal(),
        Pole::South => -face.normal(),
    };
    Ok(Magnet {
        position: face.point(listed.at, height),
        angle: direction(outward, axis),
        moment,
        size,
        face: number,
    })
}

/// The angle (rad) of a vector turned by `turn`.
fn direction(vector: Vector2<f64>, turn: f64) -> f64 {
    // Adding zero turns -0 into 0, so that west is pi and never -pi.
    wrap_angle(libm::atan2(vector.y + 0.0, vector.x + 0.0) + turn)
}
