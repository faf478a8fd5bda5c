//! Checks of the magnets' blocks: where they overlap, stick out of their tile or break through its
//! outline.

use nalgebra::Vector2;

use super::build::BuiltTile;
use physics::contact::{Placement, separation};
use physics::tile::assembly::{face_edges, surface_height};
use physics::tile::outline::ConvexPart;
use physics::tile::{Face, Magnet};

/// Depth (m) up to which blocks may overlap or stick out, to allow for rounding: a ten-thousandth
/// of the thinnest accepted magnets (10 um).
pub(super) const ROUNDING: f64 = 1e-9;

/// The rectangle of a magnet.
pub(super) fn block(magnet: &Magnet) -> ConvexPart {
    ConvexPart::new(magnet.outline())
}

/// Whether two rectangles of magnets overlap.
pub(super) fn overlap(a: &ConvexPart, b: &ConvexPart) -> bool {
    separation(a, b, &Placement::none()) < -ROUNDING
}

/// Whether a block's centre, a corner of its inner half, or a corner beyond the ends of its face
/// lies outside the tile.
pub(super) fn sticks_out(built: &BuiltTile, magnet: &Magnet) -> bool {
    let face = &built.tile.faces[magnet.face];
    let beyond_its_face = |p: &Vector2<f64>| {
        (p - face.middle()).dot(&face.tangent()).abs() > face.length() / 2.0 + ROUNDING
    };
    let in_the_inner_half =
        |p: &Vector2<f64>| (p - magnet.position).dot(&face.normal()) <= ROUNDING;
    magnet
        .outline()
        .into_iter()
        .filter(|p| beyond_its_face(p) || in_the_inner_half(p))
        .chain([magnet.position])
        .any(|p| built.tile.outline.signed_distance(p) > ROUNDING)
}

/// Whether a corner of a magnet is above the surface of its face.
pub(super) fn breaks_through(built: &BuiltTile, magnet: &Magnet) -> bool {
    let face = &built.tile.faces[magnet.face];
    let edges = face_edges(&built.ring, face, magnet.face);
    excess(&edges, face, magnet) > ROUNDING
}

/// How far (m, along the face's normal) the highest corner of a block is above the lowest surface
/// within the block's width.
pub(super) fn excess(edges: &[[[f64; 2]; 2]], face: &Face, magnet: &Magnet) -> f64 {
    let local: Vec<_> = magnet
        .outline()
        .iter()
        .map(|p| {
            let d = p - face.middle();
            [d.dot(&face.tangent()), d.dot(&face.normal())]
        })
        .collect();
    let fold =
        |k: usize, f: fn(f64, f64) -> f64| local.iter().map(|p| p[k]).reduce(f).unwrap_or(0.0);
    let (low, high) = (fold(0, f64::min), fold(0, f64::max));
    let corners_between = edges
        .iter()
        .map(|[a, _]| a[0])
        .filter(|s| (low..=high).contains(s));
    let lowest = corners_between
        .chain([low, high])
        .filter_map(|s| surface_height(edges, s))
        .fold(f64::INFINITY, f64::min);
    fold(1, f64::max) - lowest
}
