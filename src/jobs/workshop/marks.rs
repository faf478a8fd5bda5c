//! Texts to engrave beside the pockets, where there is room for them.

use nalgebra::Vector2;
use physics::configuration::Configuration;
use physics::contact::Contact;
use physics::tile::{Magnet, Outline, Tile};

/// Heights of letters (m), the best first.
const HEIGHTS: [f64; 3] = [0.005, 0.003, 0.002];
/// Least distance (m) of a text from pockets, other texts and the rim.
const FREE: f64 = 5e-4;
/// Width of a letter over its height, with the gap to the next one: wide fonts have as much.
const WIDTH: f64 = 0.75;
/// Height of the tile's mark, its arrow included, over that of its letters.
const TALL: f64 = 2.4;
/// Number of places that are tried for the tile's mark in each direction.
const PLACES: i32 = 8;

/// A text to engrave.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// The text.
    pub text: String,
    /// Its middle (m).
    pub middle: Vector2<f64>,
    /// Height of its letters (m).
    pub height: f64,
    /// The direction in which it is read (rad).
    pub turn: f64,
    /// An arrow beside it that points towards face 0: from its tail to its tip (m).
    pub arrow: Option<[Vector2<f64>; 2]>,
}

/// The marks of a tile: of its pockets, `names` in the order of its magnets, then its own name.
///
/// All letters are as high as there is room for all marks, and texts are shortened only if there is
/// none for letters of the least height. Where not even the shortest text fits, the mark is `None`.
pub(super) fn marks(tile: &Tile, holes: &[Magnet], names: &[[String; 3]], name: &str) -> Marks {
    let taken = holes.iter().map(Magnet::outline);
    let board = Board {
        rim: &tile.outline,
        taken: taken.filter_map(|hole| Outline::new(hole).ok()).collect(),
    };
    let texts = [
        format!("{name}, this side up"),
        format!("{name} up"),
        name.chars().take(1).chain(" up".chars()).collect(),
    ];
    let tried = |shortened: usize, height: f64| {
        let mut board = board.clone();
        let pockets = holes.iter().zip(names).map(|(hole, names)| {
            let inwards = -tile.faces[hole.face].normal();
            board.beside(hole, inwards, &names[shortened..], height)
        });
        Marks {
            pockets: pockets.collect(),
            tile: board.anywhere(&texts[shortened..], &tile.faces[0].normal(), height),
        }
    };
    let mut best = Marks::default();
    for shortened in 0..texts.len() {
        for height in HEIGHTS {
            let marks = tried(shortened, height);
            if marks.count() > best.count() || best.pockets.len() < holes.len() {
                best = marks;
            }
            if best.count() == holes.len() + 1 {
                return best;
            }
        }
    }
    best
}

/// The marks of a tile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Of each pocket.
    pub pockets: Vec<Option<Mark>>,
    /// Its name, the side that is up, and an arrow.
    pub tile: Option<Mark>,
}

impl Marks {
    /// How many there are.
    fn count(&self) -> usize {
        self.pockets.iter().chain([&self.tile]).flatten().count()
    }
}

/// What is free of a tile.
#[derive(Clone)]
struct Board<'a> {
    rim: &'a Outline,
    taken: Vec<Outline>,
}

impl Board<'_> {
    /// Places one of some texts inwards of a hole.
    fn beside(
        &mut self,
        hole: &Magnet,
        inwards: Vector2<f64>,
        texts: &[String],
        height: f64,
    ) -> Option<Mark> {
        let corners = hole.outline();
        let reach = corners.iter().map(|p| (p - hole.position).dot(&inwards));
        let reach = reach.fold(0.0, f64::max) + 1.05 * FREE;
        let along = Vector2::new(-inwards.y, inwards.x);
        for text in texts {
            let width = WIDTH * height * text.chars().count() as f64;
            for farther in [0.0, 1.5 * height, 3.0 * height] {
                for (axis, deep) in [(along, height), (inwards, width)] {
                    let middle = hole.position + inwards * (reach + farther + deep / 2.0);
                    if self.take(middle, axis, [width, height]) {
                        return Some(Mark {
                            text: text.clone(),
                            middle,
                            height,
                            turn: readable(axis),
                            arrow: None,
                        });
                    }
                }
            }
        }
        None
    }

    /// Places one of some texts with an arrow as near to the middle of the tile as possible.
    fn anywhere(&mut self, texts: &[String], arrow: &Vector2<f64>, height: f64) -> Option<Mark> {
        let middle = self.rim.centroid();
        let step = self.rim.circumradius() / f64::from(PLACES);
        let range = -PLACES..=PLACES;
        let mut places: Vec<(i32, i32)> = range
            .clone()
            .flat_map(|i| range.clone().map(move |j| (i, j)))
            .collect();
        places.sort_by_key(|(i, j)| i * i + j * j);
        for text in texts {
            let width = WIDTH * height * text.chars().count() as f64;
            for &(i, j) in &places {
                let at = middle + Vector2::new(f64::from(i), f64::from(j)) * step;
                let size = [width.max(TALL * height), TALL * height];
                if !self.take(at, Vector2::x(), size) {
                    continue;
                }
                // Text below, arrow above.
                let low = at - Vector2::y() * ((TALL - 1.0) / 2.0 * height);
                let high = at + Vector2::y() * (0.5 * height);
                let half = arrow * (0.65 * height);
                return Some(Mark {
                    text: text.clone(),
                    middle: low,
                    height,
                    turn: 0.0,
                    arrow: Some([high - half, high + half]),
                });
            }
        }
        None
    }

    /// Takes a rectangle if it is free.
    fn take(&mut self, middle: Vector2<f64>, axis: Vector2<f64>, size: [f64; 2]) -> bool {
        let (a, b) = (
            axis * (size[0] / 2.0),
            Vector2::new(-axis.y, axis.x) * (size[1] / 2.0),
        );
        let corners = vec![
            middle - a - b,
            middle + a - b,
            middle + a + b,
            middle - a + b,
        ];
        let mut ring = corners.iter().zip(corners.iter().cycle().skip(1));
        let inside = ring.all(|(p, q)| {
            (0..4).all(|k| {
                let p = p + (q - p) * (f64::from(k) / 4.0);
                self.rim.signed_distance(p) < -FREE
            })
        });
        // The rim may reach into the rectangle between these points.
        let reaches_in = |corner: &Vector2<f64>| {
            let from = corner - middle;
            let along = from.dot(&axis).abs() - size[0] / 2.0;
            along.max(from.perp(&axis).abs() - size[1] / 2.0) < FREE
        };
        let inside = inside && !self.rim.vertices().iter().any(reaches_in);
        let Some(own) = inside.then(|| Outline::new(corners).ok()).flatten() else {
            return false;
        };
        let is_clear = |other: &Outline| {
            let here = Configuration::new(0.0, 0.0, 0.0);
            Contact::new(&own, other).clearance(&here) > FREE
        };
        let free = self.taken.iter().all(is_clear);
        if free {
            self.taken.push(own);
        }
        free
    }
}

/// The direction (rad) of a line of text that is not upside down.
fn readable(axis: Vector2<f64>) -> f64 {
    let is_back = axis.x < -1e-9 || (axis.x <= 1e-9 && axis.y < 0.0);
    let axis = if is_back { -axis } else { axis };
    libm::atan2(axis.y, axis.x)
}
