//! The cutting lines of a tile.

use nalgebra::Vector2;

use super::error::PartError;
use super::marks::{Marks, marks};
use super::notch;
use super::request::Request;
use super::rim::{Corner, length, rim};
use physics::configuration::Configuration;
use physics::contact::Contact;
use physics::tile::assembly::{FaceLine, assemble};
use physics::tile::barcode::Pole;
use physics::tile::{Face, Magnet, Outline, Tile};

/// Thinnest stable wall (m) between a pocket and the rim or another pocket.
const THINNEST: f64 = 5e-4;
/// Walls that miss it by less than this (m) are as thick: the last bits of two symmetric pockets
/// differ.
const TIE: f64 = 1e-6;
/// Insets are raised in steps of this (m), and by at most this many of them.
const STEP: f64 = 1e-4;
const STEPS: u32 = 300;

/// The cutting lines of a tile, in its own frame (m).
#[derive(Clone, Debug, PartialEq)]
pub struct CutPart {
    /// The cutter's centre line around the tile, counter-clockwise. Arcs are true arcs, although
    /// the tile's outline has chords.
    pub outline: Vec<Corner>,
    /// A pocket for each magnet, in order.
    pub pockets: Vec<Pocket>,
    /// Texts to engrave.
    pub marks: Marks,
    /// How much `inset` must be raised (m) until every pocket has a wall; 0 if all have one, `None`
    /// if that does not help.
    pub deeper: Option<f64>,
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
    /// Whether it is part of the outline: a notch, for want of a wall.
    pub is_notch: bool,
    /// Width (m) of the thinnest piece of material beside a notch that is longer than wide.
    pub sliver: Option<f64>,
    /// The thinnest walls (m) between the pocket and another one of its face, and one of another
    /// face, negative if they overlap; `None` without such a pocket.
    pub beside: [Option<f64>; 2],
}

impl Pocket {
    /// The centre and the radius (m) of a round pocket.
    pub fn circle(&self) -> Option<(Vector2<f64>, f64)> {
        let is_round = self.corners.len() == 2;
        is_round.then(|| (self.middle, (self.corners[0].point - self.middle).norm()))
    }

    /// Whether the pocket opens through the tile's rim, or leaves too thin a wall.
    pub fn is_open(&self) -> bool {
        self.wall < THINNEST - TIE
    }

    /// The thinnest wall (m) between the pocket and any other; `None` for a single pocket.
    pub fn between(&self) -> Option<f64> {
        self.beside.into_iter().flatten().reduce(f64::min)
    }

    /// How much its walls to pockets of its own face and of other faces are too thin (m).
    pub fn crowded(&self) -> [f64; 2] {
        self.beside.map(|wall| {
            let more = wall.map(|wall| THINNEST - wall);
            more.filter(|more| *more > TIE).unwrap_or(0.0)
        })
    }
}

impl CutPart {
    /// Computes the lines of a tile, which is called `name` in its marks.
    ///
    /// # Errors
    /// If the kerf is too wide for the tile's details.
    pub fn new(tile: &Tile, making: &Request, name: &str) -> Result<Self, PartError> {
        let holes = tile.magnets.iter();
        let holes: Vec<Magnet> = holes.map(|it| it.grown(making.clearance)).collect();
        let mut pockets = Vec::new();
        for (i, magnet) in tile.magnets.iter().enumerate() {
            let before = tile.magnets[..=i].iter();
            let number = before.filter(|other| other.face == magnet.face).count();
            pockets.push(pocket(tile, (magnet, &holes[i]), number, making)?);
        }
        for (pocket, wall) in pockets.iter_mut().zip(walls(&holes)) {
            pocket.beside = wall;
        }
        let mut outline = outline(tile, making.kerf)?;
        for (pocket, hole) in pockets.iter_mut().zip(&holes).filter(|it| it.0.is_open()) {
            let (bottom, out) = pocket.bottom(hole, tile.faces[hole.face].normal());
            if let Some(notched) = notch::cut(&outline, &bottom, out) {
                (outline, pocket.is_notch) = (notched, true);
            }
        }
        for (pocket, hole) in pockets.iter_mut().zip(&holes).filter(|it| it.0.is_notch) {
            let (bottom, out) = pocket.bottom(hole, tile.faces[hole.face].normal());
            pocket.sliver = sliver(&outline, &bottom, out, making.kerf);
        }
        let names: Vec<[String; 3]> = pockets.iter().map(Pocket::texts).collect();
        Ok(Self {
            outline,
            deeper: deeper(tile, &holes),
            marks: marks(tile, &holes, &names, name),
            pockets,
            thickness: tile.thickness,
        })
    }

    /// Length of all cuts (m), or only of the outline.
    pub fn cut_length(&self, with_pockets: bool) -> f64 {
        let pockets = self
            .pockets
            .iter()
            .filter(|pocket| !pocket.is_notch && with_pockets);
        let pockets = pockets.map(|pocket| length(&pocket.corners));
        length(&self.outline) + pockets.sum::<f64>()
    }
}

impl Pocket {
    /// Its marks, the best first.
    fn texts(&self) -> [String; 3] {
        let pole = self.pole.letter();
        let number = self.name.rsplit(' ').next().unwrap_or_default();
        [
            format!("{} {pole}", self.name),
            format!("{number}{pole}"),
            pole.to_string(),
        ]
    }

    /// The cutter's line along the pocket's inner side, counter-clockwise around the tile, and the
    /// direction of the sides of a notch from there, which is outwards.
    fn bottom(&self, hole: &Magnet, normal: Vector2<f64>) -> (Vec<Corner>, Vector2<f64>) {
        let corner = |point, bulge| Corner { point, bulge };
        if let Some((middle, radius)) = self.circle() {
            let along = Vector2::new(-normal.y, normal.x) * radius;
            return (
                vec![corner(middle - along, -1.0), corner(middle + along, 0.0)],
                normal,
            );
        }
        let (sin, cos) = libm::sincos(hole.angle);
        let axes = [[cos, sin], [-sin, cos], [-cos, -sin], [sin, -cos]].map(Vector2::from);
        let nearer = |a: &Vector2<f64>, b: &Vector2<f64>| a.dot(&normal).total_cmp(&b.dot(&normal));
        let out = axes.into_iter().max_by(nearer).unwrap_or(normal);
        let along = Vector2::new(-out.y, out.x);
        let inner = self.corners.iter().map(|corner| corner.point);
        let mut inner: Vec<Vector2<f64>> = inner
            .filter(|p| (p - self.middle).dot(&out) < 0.0)
            .collect();
        inner.sort_by(|a, b| a.dot(&along).total_cmp(&b.dot(&along)));
        (
            inner.into_iter().map(|point| corner(point, 0.0)).collect(),
            out,
        )
    }
}

/// The number of pockets of a tile that leave no stable wall to the rim, with the given clearance (m)
/// around magnets, and how much `inset` must be raised (m) for all to have one, if that helps.
pub fn open_pockets(tile: &Tile, clearance: f64) -> (usize, Option<f64>) {
    let holes: Vec<Magnet> = tile.magnets.iter().map(|it| it.grown(clearance)).collect();
    let walls = holes.iter().map(|hole| hole.wall(&tile.outline));
    let open = walls.filter(|wall| *wall < THINNEST - TIE).count();
    (open, deeper(tile, &holes))
}

/// See [`CutPart::deeper`]: tried, since on slopes a wall grows by less than the inset.
fn deeper(tile: &Tile, holes: &[Magnet]) -> Option<f64> {
    let moved = |hole: &Magnet, by: f64| Magnet {
        position: hole.position - tile.faces[hole.face].normal() * by,
        ..hole.clone()
    };
    let wall = |by: f64| {
        let walls = holes.iter().map(|hole| moved(hole, by).wall(&tile.outline));
        walls.fold(f64::INFINITY, f64::min)
    };
    let tried = (0..=STEPS).map(|k| STEP * f64::from(k));
    tried.into_iter().find(|&by| wall(by) >= THINNEST - TIE)
}

/// Width (m) of the thinner of the pieces of material on both sides of a notch that are longer than
/// wide. The cutter takes half the kerf from either side of them.
fn sliver(outline: &[Corner], bottom: &[Corner], out: Vector2<f64>, kerf: f64) -> Option<f64> {
    let along = Vector2::new(-out.y, out.x);
    let ends = [(bottom.first()?, -along), (bottom.last()?, along)];
    let pieces = ends
        .iter()
        .filter_map(|(corner, aside)| notch::beside(outline, corner.point, out, *aside));
    pieces
        .map(|[wide, long]| [wide - kerf, long])
        .filter(|[wide, long]| wide < long)
        .map(|[wide, _]| wide)
        .min_by(f64::total_cmp)
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

fn pocket(
    tile: &Tile,
    (magnet, hole): (&Magnet, &Magnet),
    number: usize,
    making: &Request,
) -> Result<Pocket, PartError> {
    let face = &tile.faces[magnet.face];
    let cut = magnet.grown(making.clearance - making.kerf / 2.0);
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
        wall: hole.wall(&tile.outline),
        is_notch: false,
        sliver: None,
        beside: [None; 2],
    })
}

/// The thinnest walls (m) between each hole and the others of its face, and those of other faces.
fn walls(holes: &[Magnet]) -> Vec<[Option<f64>; 2]> {
    let radius = |hole: &Magnet| libm::hypot(hole.size[0], hole.size[1]) / 2.0;
    let mut walls = vec![[None; 2]; holes.len()];
    for (i, one) in holes.iter().enumerate() {
        for (j, other) in holes[..i].iter().enumerate() {
            let kind = usize::from(one.face != other.face);
            let apart = (one.position - other.position).norm() - radius(one) - radius(other);
            let is_known = |wall: &Option<f64>| wall.is_some_and(|wall| wall <= apart);
            if is_known(&walls[i][kind]) && is_known(&walls[j][kind]) {
                continue;
            }
            let Some(wall) = between([&one.outline(), &other.outline()]) else {
                continue;
            };
            for k in [i, j] {
                let known = &mut walls[k][kind];
                *known = Some(known.map_or(wall, |known: f64| known.min(wall)));
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
        assert!((disc.wall(&rim) - 0.5).abs() < 1e-12);
    }
}
