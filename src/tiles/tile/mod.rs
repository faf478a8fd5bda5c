//! Tiles: an outline, its faces and the magnets they carry.

pub mod assembly;
pub mod barcode;
pub mod congruence;
mod convex;
pub mod demagnetising;
pub mod edge_grid;
pub mod grade;
pub mod magnet;
pub mod outline;
mod pair;
pub mod plane;
pub mod profile;
pub mod strength;
pub mod symmetry;

pub use magnet::Magnet;
pub use outline::Outline;
pub use pair::{Pair, face_to_face};

use nalgebra::Vector2;

use crate::configuration::Configuration;

/// A face of a tile: the straight base line between two corners of the tile. A profile may replace
/// the base line in the outline; the face's frame (s along it, h outwards) is unchanged.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Its name in the design file: `east`, or its number.
    pub name: String,
    /// First corner, counter-clockwise (m).
    pub start: Vector2<f64>,
    /// Second corner (m).
    pub end: Vector2<f64>,
}

impl Face {
    /// Length of the base line (m).
    pub fn length(&self) -> f64 {
        (self.end - self.start).norm()
    }

    /// Unit vector along the face, counter-clockwise (the direction of s).
    pub fn tangent(&self) -> Vector2<f64> {
        (self.end - self.start) / self.length()
    }

    /// Outward unit normal (the direction of h).
    pub fn normal(&self) -> Vector2<f64> {
        let t = self.tangent();
        Vector2::new(t.y, -t.x)
    }

    /// Midpoint of the base line (m).
    pub fn middle(&self) -> Vector2<f64> {
        (self.start + self.end) / 2.0
    }

    /// Its frame: the middle of the base line, turned so that x points outwards.
    pub fn frame(&self) -> Configuration {
        let (middle, normal) = (self.middle(), self.normal());
        Configuration::new(middle.x, middle.y, libm::atan2(normal.y, normal.x))
    }

    /// The point at `s` along the face from its midpoint and `h` outwards (m), in the tile's frame.
    pub fn point(&self, s: f64, h: f64) -> Vector2<f64> {
        self.middle() + self.tangent() * s + self.normal() * h
    }
}

/// A tile: a rigid, flat body with magnets.
#[derive(Clone, Debug)]
pub struct Tile {
    /// Its rim, profiles included.
    pub outline: Outline,
    /// Its faces, counter-clockwise.
    pub faces: Vec<Face>,
    /// Its magnets, face by face.
    pub magnets: Vec<Magnet>,
    /// Mass (kg).
    pub mass: f64,
    /// Thickness (m).
    pub thickness: f64,
}

/// A centre of mass that is nearer to the reference point than this share of the tile's radius is there.
const CENTRED: f64 = 1e-6;

/// Overlaps (m) below this, and below this share of the faces, come from poses with few digits.
const ROUNDED: f64 = 50e-6;
const ROUNDED_SHARE: f64 = 1e-3;

/// Overlaps (m) of two tiles below this depth come from poses written with few digits: the tiles are
/// meant to touch.
pub fn rounded_overlap(tiles: [&Tile; 2]) -> f64 {
    let faces = tiles.map(Tile::longest_face);
    ROUNDED.min(ROUNDED_SHARE * faces[0].min(faces[1]))
}

impl Tile {
    /// Moment of inertia (kg m^2) about the centre of mass, with the mass distributed evenly over
    /// the outline's area.
    pub fn inertia(&self) -> f64 {
        self.mass * self.outline.second_moment_about_centroid() / self.outline.area()
    }

    /// The same tile drawn about its centre of mass; `None` if it is, or if its outline cannot be moved.
    pub fn centred(&self) -> Option<Self> {
        let by = -self.outline.centroid();
        if by.norm() <= CENTRED * self.outline.circumradius() {
            return None;
        }
        let mut moved = Self {
            outline: self.outline.moved(by).ok()?,
            ..self.clone()
        };
        for face in &mut moved.faces {
            face.start += by;
            face.end += by;
        }
        for magnet in &mut moved.magnets {
            magnet.position += by;
        }
        Some(moved)
    }

    /// The largest length or width of a magnet (m), 0 without magnets.
    pub fn largest_magnet(&self) -> f64 {
        let sizes = self.magnets.iter();
        let sizes = sizes.map(|magnet| magnet.size[0].max(magnet.size[1]));
        sizes.fold(0.0, f64::max)
    }

    /// Length (m) of its longest face.
    pub fn longest_face(&self) -> f64 {
        self.faces.iter().map(Face::length).fold(0.0, f64::max)
    }

    /// Radius of gyration (m) about the reference point.
    pub fn radius_of_gyration(&self) -> f64 {
        let c = self.outline.centroid();
        (self.inertia() / self.mass + c.norm_squared()).sqrt()
    }
}
