//! Two tiles and their intended contact.

use std::f64::consts::PI;

use nalgebra::Vector2;

use super::magnet::Shape;
use super::{Face, Tile};
use crate::configuration::{Configuration, wrap_angle};

/// Two tiles and their intended bond.
#[derive(Clone, Debug)]
pub struct Pair {
    /// The tile at the table's centre, unrotated.
    pub fixed: Tile,
    /// The tile that moves.
    pub moving: Tile,
    /// The faces of the fixed and of the moving tile that are meant to bind.
    pub target: (usize, usize),
    /// The configuration in which the target faces coincide.
    pub bound: Configuration,
    /// Whether only this contact is the bond, and not those equal to it by symmetry, by exchange of
    /// equal tiles, or of other faces with the same magnets.
    pub only: bool,
}

impl Pair {
    /// A word for the magnets of both tiles: blocks, discs or both.
    pub fn bodies(&self) -> &'static str {
        let magnets = self.fixed.magnets.iter().chain(&self.moving.magnets);
        let [discs, blocks] = [Shape::Disc, Shape::Block]
            .map(|shape| magnets.clone().any(|magnet| magnet.form.shape == shape));
        match (discs, blocks) {
            (true, false) => "discs",
            (true, true) => "blocks and discs",
            _ => "blocks",
        }
    }

    /// The same pair with both tiles drawn about their centres of mass, as far as they are not.
    #[must_use]
    pub fn centred(&self) -> Self {
        let of = |tile: &Tile| tile.centred().unwrap_or_else(|| tile.clone());
        let mut centred = Self {
            fixed: of(&self.fixed),
            moving: of(&self.moving),
            ..self.clone()
        };
        centred.bound = centred.pose_of(&self.bound, self);
        centred
    }

    /// The configuration in which the tiles lie as those of `other`, the same pair drawn elsewhere, do
    /// at `q`.
    pub fn pose_of(&self, q: &Configuration, other: &Self) -> Configuration {
        let shift = |from: &Tile, to: &Tile| {
            let by = from.faces[0].start - to.faces[0].start;
            Configuration::new(by.x, by.y, 0.0)
        };
        // Points of the moving tile, from this drawing to the other, and back for the fixed one.
        let [moving, fixed] = [
            shift(&other.moving, &self.moving),
            shift(&self.fixed, &other.fixed),
        ];
        fixed.compose(q).compose(&moving)
    }

    /// The fixed tile's target face.
    pub fn target_face(&self) -> &Face {
        &self.fixed.faces[self.target.0]
    }

    /// The distance of the reference points (m) beyond which the tiles cannot touch in any
    /// orientation: the sum of their circumradii about the reference points.
    pub fn free_distance(&self) -> f64 {
        self.fixed.outline.circumradius() + self.moving.outline.circumradius()
    }
}

/// The configuration in which the base lines of two faces lie against each other, the moving one
/// `slide` (m) along the fixed one and turned by `tilt` (rad) about its middle.
pub fn face_to_face(fixed: &Face, moving: &Face, slide: f64, tilt: f64) -> Configuration {
    let direction = |v: Vector2<f64>| libm::atan2(v.y, v.x);
    let theta = wrap_angle(direction(fixed.normal()) + PI - direction(moving.normal()) + tilt);
    let turned = Configuration::new(0.0, 0.0, theta).transform(moving.middle());
    let position = fixed.point(slide, 0.0) - turned;
    Configuration::new(position.x, position.y, theta)
}
