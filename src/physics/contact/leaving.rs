//! Tests whether a tile moved out along a ray from the fixed tile's centre leaves contact once and
//! for all.

use nalgebra::Vector2;

use super::Contact;
use crate::tile::Outline;
use crate::tile::outline::cross;

impl Contact {
    /// A lower bound of n . p (m) over all configurations of two tiles in contact, where p is the
    /// moving tile's position and n the direction, out of the fixed tile, in which contact pushes
    /// it.
    ///
    /// If it is positive, the set of positions at which the tiles overlap, at any angle, is
    /// star-shaped about the centre: a ray that entered the set again farther out would do so at a
    /// contact with n . p <= 0. The ray then leaves the set at a distance g that is continuous in
    /// the ray's direction and the angle, with a slope of at most `|p|^2 / (n . p)`.
    ///
    /// In contact a convex vertex w of one tile lies on an edge of the other, at the height h of
    /// that edge's line above its tile's centre: `n . p = h + u . w` with u the direction into the
    /// edge, which lies between the normals of the edges that meet in w. There `u . w` is smallest
    /// at one of these normals, where it is the height of that edge's line, or opposite to w.
    pub fn least_lever(&self) -> f64 {
        let of = |own: &Outline, other: &Outline| least_height(own) + least_reach(other);
        let (fixed, moving) = (self.fixed(), self.moving());
        of(fixed, moving).min(of(moving, fixed))
    }
}

/// The height of edge i's line above the outline's centre (m); negative if the centre is on its
/// outer side.
fn height(outline: &Outline, i: usize) -> f64 {
    outline.normals()[i].dot(&outline.vertices()[i])
}

fn least_height(outline: &Outline) -> f64 {
    let all = (0..outline.vertices().len()).map(|i| height(outline, i));
    all.fold(f64::INFINITY, f64::min)
}

/// The minimum of u . w (m) over an outline's convex vertices w and directions u between the
/// normals there.
fn least_reach(outline: &Outline) -> f64 {
    let (vertices, normals) = (outline.vertices(), outline.normals());
    let n = vertices.len();
    let of = |i: usize| {
        let before = (i + n - 1) % n;
        let back: Vector2<f64> = -vertices[i];
        let is_between = cross(normals[before], back) >= 0.0 && cross(back, normals[i]) >= 0.0;
        let ends = height(outline, before).min(height(outline, i));
        if is_between { -back.norm() } else { ends }
    };
    let convex = (0..n).filter(|&i| outline.convex_vertices()[i]);
    convex.map(of).fold(f64::INFINITY, f64::min)
}
