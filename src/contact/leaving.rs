//! Whether rays from the fixed tile's centre leave contact once and for good.

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::Configuration;
    use crate::design::Design;

    /// Along rays at 1100 angles and directions: whether contact lies inwards of where it is left.
    fn is_left_once(name: &str) -> (f64, bool) {
        let path = format!("shapes/{name}.toml");
        let problem = Design::load(path.as_ref()).unwrap().problem();
        let contact = problem.contact.as_ref().unwrap();
        // Both about the bond and all over.
        let rays = (0..1100).map(|k| {
            let (a, b) = (f64::from(k % 33) - 16.0, f64::from(k / 33) - 16.0);
            let wide = if k % 2 == 0 { 0.19 } else { 0.004 };
            [wide * a, wide * b]
        });
        let is_left = |[phi, theta]: [f64; 2]| {
            let out = Vector2::new(libm::cos(phi), libm::sin(phi));
            let place = |r: f64| Configuration::new(r * out.x, r * out.y, theta);
            let end = contact.landing(&place(0.0), out).unwrap();
            let inwards = (1..120).map(|k| end - 5e-4 * f64::from(k) - 1e-6);
            inwards
                .filter(|r| *r > 0.0)
                .all(|r| !contact.is_free(&place(r)))
        };
        let mut rays = rays;
        (contact.least_lever(), rays.all(is_left))
    }

    #[test]
    fn contact_with_a_positive_lever_is_left_once() {
        for name in [
            "paper-tile",
            "tab-20mm",
            "slot-15mm",
            "snug-tab",
            "dogleg",
            "arrowhead",
        ] {
            let (lever, once) = is_left_once(name);
            assert!(lever > 0.05 && once, "{name}: {lever}");
        }
    }

    /// A dovetail hooks in, and square teeth have walls along the way out.
    #[test]
    fn contact_that_is_left_twice_has_no_positive_lever() {
        let (lever, once) = is_left_once("dovetail");
        assert!(lever < 0.0 && !once, "{lever}");
        assert!(is_left_once("square-teeth-10mm").0 <= 0.0);
    }
}
