//! The positions of a face's magnets in their tile.

use nalgebra::Vector2;

use super::error::Result;
use super::face::{FaceContent, Pattern};
use super::magnet::{AxisDirection, ListedMagnet, impossible, missing_key};
use super::quantity::four_digits;
use super::tile::TileEntry;
use physics::configuration::wrap_angle;
use physics::tile::assembly::surface_height;
use physics::tile::barcode::Pole;
use physics::tile::magnet::{Form, Standing};
use physics::tile::{Face, Magnet};

/// The magnets of a face, with inherited keys.
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
            let wide = content.keys.width().unwrap_or(0.0);
            let needed = code.len().saturating_sub(1) as f64 * pitch + wide;
            if needed > length * (1.0 + 1e-12) {
                return Err(entry.section.source.error(
                    content.pattern_span,
                    format!(
                        "the code {code} is {} m long but its face is {} m long",
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
    let body = listed.keys.body().map_err(|key| missing_key(key, error))?;
    if let Some((message, help)) = impossible(&body, listed.keys.strength) {
        return Err(error(message, help));
    }
    let Some(surface) = surface_height(edges, listed.at) else {
        return Err(error(
            format!(
                "a magnet at s = {} is beyond the end of face {}",
                four_digits(listed.at),
                face.name
            ),
            format!(
                "s ranges from {} to {} m",
                four_digits(-face.length() / 2.0),
                four_digits(face.length() / 2.0)
            ),
        ));
    };
    let stands = standing(listed).map_err(|(message, help)| error(message, help))?;
    let axis = match listed.keys.axis {
        Some(AxisDirection::Lying(angle)) => angle,
        _ => 0.0,
    };
    let size = body.in_plane(stands.is_some());
    // The extent of the block from its centre towards the surface.
    let reach = (size[0] * libm::cos(axis).abs() + size[1] * libm::sin(axis).abs()) / 2.0;
    let height = surface - listed.keys.inset.unwrap_or(0.0) - reach;
    let outward = match listed.pole {
        Pole::South if stands.is_none() => -face.normal(),
        _ => face.normal(),
    };
    Ok(Magnet {
        position: face.point(listed.at, height),
        angle: direction(outward, axis),
        moment: body.moment,
        size,
        form: Form {
            shape: body.shape,
            stands,
        },
        face: number,
    })
}

/// Whether a magnet's axis points up, or what is wrong with its pole.
fn standing(listed: &ListedMagnet) -> std::result::Result<Option<Standing>, (String, String)> {
    let up = listed.keys.axis == Some(AxisDirection::Up);
    let letter = listed.pole.letter();
    match (listed.pole, up) {
        (Pole::Up, true) => Ok(Some(Standing::Up)),
        (Pole::Down, true) => Ok(Some(Standing::Down)),
        (Pole::North | Pole::South, false) => Ok(None),
        (_, true) => Err((
            format!("`{letter}` is a pole out of the face, but these magnets are upright"),
            "use U for a north pole up and D for a south pole up".to_owned(),
        )),
        (_, false) => Err((
            format!("`{letter}` is a pole up or down, but these magnets are not upright"),
            "write axis = \"up\" for upright magnets; otherwise use N and S".to_owned(),
        )),
    }
}

/// The angle (rad) of a vector turned by `turn`.
fn direction(vector: Vector2<f64>, turn: f64) -> f64 {
    // Adding zero turns -0 into 0, so that west is pi and never -pi.
    wrap_angle(libm::atan2(vector.y + 0.0, vector.x + 0.0) + turn)
}
