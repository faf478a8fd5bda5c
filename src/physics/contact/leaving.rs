//! Tests whether a tile moved out along a ray from the fixed tile's centre leaves contact once and
//! for all.

use nalgebra::Vector2;

use super::Contact;
use crate::tile::Outline;
use crate::tile::outline::cross;

impl Contact {
    /// A bound from below of n . p (m) over all configurations of two tiles in contact, p the moving
    /// tile's position and n the direction, out of the fixed tile, in which contact pushes it.
    ///
    /// Where that is positive, the positions at which the tiles overlap, at any angle, hold the
    /// whole ray from the centre to each of them: a ray that met them once more beyond would enter
    /// them at a contact with n . p <= 0. Then it leaves them at a distance g that is continuous in
    /// the ray's direction and the angle, and steep at most as `|p|^2 / (n . p)`.
    ///
    /// In contact a convex vertex w of one tile lies on an edge of the other, at the height h of that
    /// edge's line above its tile's centre: `n . p = h + u . w` with u the direction into the edge,
    /// which lies between the normals of the edges that meet in w. There `u . w` is least at one of
    /// these normals, where it is the height of that edge's line, or opposite to w.
    pub fn least_lever(&self) -> f64 {
        let of = |own: &Outline, other: &Outline| least_height(own) + least_reach(other);
        let (fixed, moving) = (self.fixed(), self.moving());
        of(fixed, moving).min(of(moving, fixed))
    }
}

/// How far edge i's line lies above the outline's centre (m); below 0 where its outer side holds that.
fn height(outline: &Outline, i: usize) -> f64 {
    outline.normals()[i].dot(&outline.vertices()[i])
}

fn least_height(outline: &Outline) -> f64 {
    let all = (0..outline.vertices().len()).map(|i| height(outline, i));
    all.fold(f64::INFINITY, f64::min)
}

/// The least of u . w over an outline's convex vertices w, u between the normals there (m).
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
