//! The landscape of a pair of tiles as data of the page.

use nalgebra::Vector2;
use serde::Serialize;

use super::numbers::{fixed, rounded};
use super::packed::Packed;
use super::pathways::Played;
use crate::names::kind;
use crate::plots::scale::{EnergyScale, VIK};
use crate::plots::{Scene, disconnectivity};
use jobs::design::Design;
use physics::configuration::Configuration;
use physics::landscape::volume::{in_front, whole};
use physics::landscape::{Place, State};
use physics::tile::Tile;
use physics::tile::magnet::{Form, Shape, Standing};

/// The data for drawing a landscape and moving tiles in it. Lengths in m, angles in rad, energies
/// in J.
#[derive(Clone, Debug, Serialize)]
pub struct Landscape {
    /// Largest energy of the scale; see [`EnergyScale`].
    most: f64,
    decades: i32,
    /// Colours of evenly spaced positions from -1 to 1.
    palette: &'static [[u8; 3]],
    fixed: Drawn,
    moving: Drawn,
    /// Whether U is the sum over point dipoles, so that the page can compute it.
    dipoles: bool,
    target: TargetFaces,
    around: Packed,
    in_front: Packed,
    /// For each tilt and slide, the distance along the normal at which the tiles first touch.
    landing: Vec<Option<f64>>,
    states: Vec<DrawnState>,
    pathways: Vec<Played>,
    /// The disconnectivity graph on that scale and on a linear one, SVG documents; empty without
    /// barriers.
    tree: Vec<String>,
}

/// A tile to draw.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Drawn {
    pub(super) outline: Vec<[f64; 2]>,
    magnets: Vec<DrawnMagnet>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct DrawnMagnet {
    position: [f64; 2],
    /// Direction of the moment.
    angle: f64,
    /// Along the magnetic axis and across it.
    size: [f64; 2],
    /// A m^2.
    moment: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    stands: Option<Stands>,
}

/// An upright magnet: which pole is up, and whether it is a disc.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Stands {
    up: char,
    round: bool,
}

impl Stands {
    /// `None` for magnets that lie flat.
    pub(super) fn of(form: Form) -> Option<Self> {
        form.stands.map(|stands| Self {
            up: match stands {
                Standing::Up => 'N',
                Standing::Down => 'S',
            },
            round: form.shape == Shape::Disc,
        })
    }
}

/// The frame of the map in front of the target face.
#[derive(Clone, Debug, Serialize)]
struct TargetFaces {
    names: [String; 2],
    bound: [f64; 3],
    /// Middle of the moving tile's target face, in its frame.
    pivot: [f64; 2],
    tangent: [f64; 2],
    normal: [f64; 2],
}

#[derive(Clone, Debug, Serialize)]
struct DrawnState {
    id: usize,
    name: String,
    kind: &'static str,
    pose: [f64; 3],
    energy: f64,
    class: usize,
}

impl Landscape {
    /// The landscape of a scene and the animated paths through it.
    pub fn new(design: &Design, scene: &Scene, pathways: Vec<Played>) -> Self {
        let around = whole(scene.problem, scene.pair);
        let in_front = in_front(scene.problem, scene.pair);
        let volumes = [&around, &in_front.volume];
        let energies = volumes.iter().flat_map(|volume| &volume.energies);
        let states = scene.states().iter().map(|state| state.energy);
        let scale = EnergyScale::holding(states.chain(energies.copied().flatten()));
        let (around, in_front_packed) = rayon::join(
            || Packed::new(&around, &scale),
            || Packed::new(&in_front.volume, &scale),
        );
        Self {
            most: scale.most(),
            decades: EnergyScale::DECADES,
            palette: &VIK,
            fixed: Drawn::new(&design.pair.fixed),
            moving: Drawn::new(&design.pair.moving),
            dipoles: design.interaction.is_sum_of_dipoles(&design.pair),
            target: TargetFaces::new(design, scene),
            around,
            in_front: in_front_packed,
            landing: in_front
                .landing
                .iter()
                .map(|distance| distance.map(fixed))
                .collect(),
            states: scene
                .states()
                .iter()
                .map(|state| DrawnState::new(scene, state))
                .collect(),
            pathways,
            tree: match scene.barriers().next() {
                None => Vec::new(),
                Some(_) => [scale, scale.linear_throughout()]
                    .into_iter()
                    .filter_map(|scale| disconnectivity::on_page(scene, scale))
                    .collect(),
            },
        }
    }
}

fn pair([a, b]: [f64; 2]) -> [f64; 2] {
    [fixed(a), fixed(b)]
}

fn point(p: Vector2<f64>) -> [f64; 2] {
    pair([p.x, p.y])
}

pub(super) fn pose(q: &Configuration) -> [f64; 3] {
    q.to_array().map(fixed)
}

impl Drawn {
    pub(super) fn new(tile: &Tile) -> Self {
        Self {
            outline: tile.outline.vertices().iter().map(|v| point(*v)).collect(),
            magnets: tile
                .magnets
                .iter()
                .map(|magnet| DrawnMagnet {
                    position: point(magnet.position),
                    angle: rounded(magnet.angle, 9),
                    size: pair([magnet.size[0], magnet.size[1]]),
                    moment: rounded(magnet.moment, 9),
                    stands: Stands::of(magnet.form),
                })
                .collect(),
        }
    }
}

impl TargetFaces {
    fn new(design: &Design, scene: &Scene) -> Self {
        let (fixed, moving) = design.pair.target;
        let face = &design.pair.fixed.faces[fixed];
        Self {
            names: [
                face.name.clone(),
                design.pair.moving.faces[moving].name.clone(),
            ],
            bound: pose(&scene.pair.bound),
            pivot: point(design.pair.moving.faces[moving].middle()),
            tangent: point(face.tangent()),
            normal: point(face.normal()),
        }
    }
}

impl DrawnState {
    fn new(scene: &Scene, state: &State) -> Self {
        Self {
            id: state.id,
            name: scene.name_of(Place::State(state.id)),
            kind: kind(state.kind),
            pose: pose(&state.configuration),
            energy: rounded(state.energy, 7),
            class: state.class,
        }
    }
}
