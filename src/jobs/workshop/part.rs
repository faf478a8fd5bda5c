//! The cutting lines of a tile.

use nalgebra::Vector2;

use super::Making;
use super::rim::{Corner, rim};
use crate::request::Unanswered;
use physics::configuration::Configuration;
use physics::contact::Contact;
use physics::tile::assembly::{FaceLine, assemble};
use physics::tile::barcode::Pole;
use physics::tile::{Face, Magnet, Outline, Tile};

/// Thinnest stable wall (m) between a pocket and the rim or another pocket.
const THINNEST: f64 = 5e-4;

/// Why a part cannot be cut.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PartError {
    /// The cutter is wider than details of the outline.
    #[error("a cut {0} m wide is wider than details of the outline: use a narrower --kerf")]
    Kerf(f64),
    /// A pocket vanishes.
    #[error("a cut {0} m wide leaves no pocket for the magnets: use a narrower --kerf")]
    Pocket(f64),
}

impl Unanswered for PartError {}

/// The cutting lines of a tile, in its own frame (m).
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The cutter's centre line around the tile, counter-clockwise. Arcs are true arcs, although
    /// the tile's outline has chords.
    pub outline: Vec<Corner>,
    /// A pocket for each magnet, in order.
    pub pockets: Vec<Pocket>,
    /// The thickness of the tile (m).
    pub thickness: f64,
}

/// A pocket for one magnet.
#[derive(Clone, Debug, PartialEq)]
pub struct Pocket {
    /// Its name, such as `east 2`: the face, and the index of its magnet, counter-clockwise from 1.
    pub name: String,
    /// The pole that points out of the face, or up.
    pub pole: Pole,
    /// The cutter's centre line, counter-clockwise: two arcs around an upright disc.
    pub corners: Vec<Corner>,
    /// The vector from the magnet's centre to its north pole (m) in the tile's plane.
    pub north: Vector2<f64>,
    /// The magnet's centre.
    pub middle: Vector2<f64>,
    /// Milling depth of the pocket (m), from either side, that centres the magnet in the tile's
    /// thickness.
    pub depth: f64,
    /// The thinnest wall between the pocket and the tile's rim (m), negative if it breaks through.
    pub wall: f64,
    /// The thinnest wall between the pocket and another one (m), negative if they overlap; `None`
    /// for a single pocket.
    pub between: Option<f64>,
}

impl Pocket {
    /// The letters engraved in it, with position (m) and height (m): both poles, or the one that is
    /// up.
    pub fn letters(&self) -> Vec<(char, Vector2<f64>, f64)> {
        let reach = (self.corners[0].point - self.middle).norm();
        match self.pole.stands() {
            true => vec![(self.pole.letter(), self.middle, 0.6 * reach)],
            false => [('N', 0.5), ('S', -0.5)]
                .map(|(letter, side)| {
                    let at = self.middle + self.north * side;
                    (letter, at, 0.6 * self.north.norm())
                })
                .to_vec(),
        }
    }

    /// Whether the pocket opens through the tile's rim, or leaves too thin a wall.
    pub fn is_open(&self) -> bool {
        self.wall < THINNEST
    }

    /// How much its wall to the rim is too thin (m).
    pub fn wanting(&self) -> f64 {
        (THINNEST - self.wall).max(0.0)
    }

    /// How much its wall to another pocket is too thin (m).
    pub fn crowded(&self) -> f64 {
        self.between.map_or(0.0, |wall| (THINNEST - wall).max(0.0))
    }
}

impl Part {
    /// Computes the lines of a tile.
    ///
    /// # Errors
    /// If the kerf is too wide for the tile's details.
    pub fn new(tile: &Tile, making: &Making) -> Result<Self, PartError> {
        let holes = tile.magnets.iter();
        let holes: Vec<Magnet> = holes.map(|it| grown(it, making.clearance)).collect();
        let mut pockets = Vec::new();
        for (i, magnet) in tile.magnets.iter().enumerate() {
            let before = tile.magnets[..=i].iter();
            let number = before.filter(|other| other.face == magnet.face).count();
            pockets.push(pocket(tile, (magnet, &holes[i]), number, making)?);
        }
        for (pocket, wall) in pockets.iter_mut().zip(walls(&holes)) {
            pocket.between = wall;
        }
        Ok(Self {
            outline: outline(tile, making.kerf)?,
            pockets,
            thickness: tile.thickness,
        })
    }
}

/// The outline offset outwards by half the kerf.
fn outline(tile: &Tile, kerf: f64) -> Result<Vec<Corner>, PartError> {
    let wide = || PartError::Kerf(kerf);
    if kerf > 0.0 {
        check_details(tile, kerf)?;
    }
    rim(&tile.outline, kerf / 2.0).ok_or_else(wide)
}

/// Rejects a kerf wider than details of the outline: an edge would be reversed.
fn check_details(tile: &Tile, kerf: f64) -> Result<(), PartError> {
    let corners = tile.outline.vertices();
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let faces: Vec<Face> = edges
        .map(|(start, end)| Face {
            name: String::new(),
            start: *start,
            end: *end,
        })
        .collect();
    let line = FaceLine {
        fit: -kerf / 2.0,
        ..FaceLine::default()
    };
    let ring = assemble(&faces, &vec![line; faces.len()]);
    ring.map(|_| ()).map_err(|_| PartError::Kerf(kerf))
}

/// A magnet that is larger by this much (m) on every side.
fn grown(magnet: &Magnet, extra: f64) -> Magnet {
    let [a, b, thickness] = magnet.size;
    Magnet {
        size: [a + 2.0 * extra, b + 2.0 * extra, thickness],
        ..magnet.clone()
    }
}

fn pocket(
    tile: &Tile,
    (magnet, hole): (&Magnet, &Magnet),
    number: usize,
    making: &Making,
) -> Result<Pocket, PartError> {
    let face = &tile.faces[magnet.face];
    let cut = grown(magnet, making.clearance - making.kerf / 2.0);
    if cut.size[0] <= 0.0 || cut.size[1] <= 0.0 {
        return Err(PartError::Pocket(making.kerf));
    }
    Ok(Pocket {
        name: format!("{} {number}", face.name),
        pole: magnet.pole(face.normal()),
        corners: pocket_rim(&cut),
        north: magnet.moment_vector() / magnet.moment * (magnet.size[0] / 2.0),
        middle: magnet.position,
        depth: (tile.thickness + magnet.size[2]) / 2.0,
        wall: -reach(&tile.outline, hole),
        between: None,
    })
}

/// The thinnest wall (m) between each hole and the others.
fn walls(holes: &[Magnet]) -> Vec<Option<f64>> {
    let radius = |hole: &Magnet| libm::hypot(hole.size[0], hole.size[1]) / 2.0;
    let mut walls = vec![None; holes.len()];
    for (i, one) in holes.iter().enumerate() {
        for (j, other) in holes[..i].iter().enumerate() {
            let apart = (one.position - other.position).norm() - radius(one) - radius(other);
            let is_known = |wall: &Option<f64>| wall.is_some_and(|wall| wall <= apart);
            if is_known(&walls[i]) && is_known(&walls[j]) {
                continue;
            }
            let Some(wall) = between([&one.outline(), &other.outline()]) else {
                continue;
            };
            for k in [i, j] {
                walls[k] = Some(walls[k].map_or(wall, |known: f64| known.min(wall)));
            }
        }
    }
    walls
}

/// The distance (m) of two holes, negative if they overlap; `None` for a hole without an area.
fn between(holes: [&[Vector2<f64>]; 2]) -> Option<f64> {
    let [one, other] = holes.map(|hole| Outline::new(hole.to_vec()).ok());
    Some(Contact::new(&one?, &other?).clearance(&Configuration::new(0.0, 0.0, 0.0)))
}

/// How far (m) a hole extends beyond the rim, negative if it leaves a wall.
fn reach(rim: &Outline, hole: &Magnet) -> f64 {
    match hole.is_round() {
        true => rim.signed_distance(hole.position) + hole.size[0] / 2.0,
        false => {
            let corners = hole.corners().map(|p| rim.signed_distance(p));
            corners.into_iter().fold(f64::NEG_INFINITY, f64::max)
        }
    }
}

/// The outline of a magnet.
fn pocket_rim(magnet: &Magnet) -> Vec<Corner> {
    let half_turn = |side: f64| Corner {
        point: magnet.position
            + Vector2::new(libm::cos(magnet.angle), libm::sin(magnet.angle))
                * (side * magnet.size[0] / 2.0),
        bulge: 1.0,
    };
    if magnet.is_round() {
        return vec![half_turn(1.0), half_turn(-1.0)];
    }
    let corners = magnet.corners();
    corners.map(|point| Corner { point, bulge: 0.0 }).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use physics::tile::magnet::{Form, Shape, Standing};

    #[test]
    fn the_wall_between_holes_is_their_distance_or_the_depth_of_their_overlap() {
        let square = |x: f64, y: f64| {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            corners.map(|[dx, dy]| Vector2::new(x + dx, y + dy))
        };
        for (x, y, wall) in [(1.5, 0.2, 0.5), (1.3, -1.4, 0.5), (0.8, 0.1, -0.2)] {
            let found = between([&square(0.0, 0.0), &square(x, y)]).unwrap();
            assert!((found - wall).abs() < 1e-12, "{x} {y}: {found}");
        }
    }

    /// A wall between two corners of any polygon around the disc.
    #[test]
    fn the_wall_beside_a_disc_that_stands_is_that_of_a_circle() {
        let turn = |k: u8| std::f64::consts::PI * (f64::from(k) / 2.0 + 1.0 / 32.0);
        let corner = |k: u8| Vector2::new(libm::cos(turn(k)), libm::sin(turn(k))) * 2f64.sqrt();
        let away = std::f64::consts::FRAC_PI_4;
        let rim = Outline::new([0, 1, 2, 3].map(corner).to_vec()).unwrap();
        let disc = Magnet {
            position: Vector2::zeros(),
            angle: away,
            moment: 1.0,
            size: [1.0, 1.0, 0.5],
            form: Form {
                shape: Shape::Disc,
                stands: Some(Standing::Up),
            },
            face: 0,
        };
        assert!((reach(&rim, &disc) + 0.5).abs() < 1e-12);
    }
}
