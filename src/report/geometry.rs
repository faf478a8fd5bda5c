//! The tiles of a design as plain numbers: outlines, magnets and shields, as their energy and their
//! contact are computed from them. With these a report holds everything needed to check it again.

use nalgebra::Vector2;
use serde_json::{Value, json};

use super::values::{pose, positive_zero};
use jobs::design::Design;
use physics::potential::shielding::Shield;
use physics::tile::magnet::Shape;
use physics::tile::{Magnet, Tile};

/// Both tiles, and the pose in which the target faces coincide. Curves are polygons.
pub(super) fn tiles(design: &Design) -> Value {
    let shields = &design.interaction.shields;
    json!({
        "fixed": tile(&design.pair.fixed, &shields.fixed),
        "moving": tile(&design.pair.moving, &shields.moving),
        "target_pose": pose(&design.pair.bound),
        "table_m": design.space().half_size.map(|half| 2.0 * half),
    })
}

fn tile(tile: &Tile, shields: &[Option<Shield>]) -> Value {
    let outline = tile.outline.vertices().iter();
    let outline = outline.map(|p| point(*p));
    json!({
        "outline_m": outline.collect::<Vec<_>>(),
        "magnets": tile.magnets.iter().map(magnet).collect::<Value>(),
        // One entry a face: its outward normal, and its shield, if it has one.
        "faces": tile.faces.iter().enumerate().map(|(number, face)| json!({
            "name": face.name,
            "middle_m": point(face.middle()),
            "normal": point(face.normal()),
            "shield": shields.get(number).copied().flatten().map(|shield| json!({
                "attenuation": shield.attenuation,
                "length_m": shield.length,
                "width": shield.width,
                "front_gain": shield.front_gain,
            })),
        })).collect::<Value>(),
    })
}

fn point(p: Vector2<f64>) -> [f64; 2] {
    [p.x, p.y].map(positive_zero)
}

/// A magnet: its centre, the direction of its moment (rad; of an upright one that of its first size),
/// its moment, and its size along that direction, across it in the plane, and through the tile.
fn magnet(magnet: &Magnet) -> Value {
    json!({
        "face": magnet.face,
        "position_m": point(magnet.position),
        "angle": positive_zero(magnet.angle),
        "moment_Am2": magnet.moment,
        "size_m": magnet.size,
        "shape": match magnet.form.shape {
            Shape::Block => "block",
            Shape::Disc => "disc",
        },
        // 1 with the north pole up, -1 with it down, null for an axis in the plane.
        "up": magnet.form.stands.map(|stands| stands.sign()),
    })
}
