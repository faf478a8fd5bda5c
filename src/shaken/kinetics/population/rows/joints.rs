//! How tiles with two binding faces lie in a row.

use std::array::from_fn;

use nalgebra::Vector2;

use tiles::configuration::Configuration;
use tiles::problem::{Equal, Problem};
use tiles::tile::congruence::congruence;

/// Faces whose middles are closer than this share of the tile's radius are the same.
const SAME_FACE: f64 = 1e-3;
/// Tiles of a row may overlap by this share of their radius: bonds have play.
const OVERLAP: f64 = 0.01;

/// The tiles of a row in their order: whether each is entered by the second of its binding faces.
pub type TileRow = Vec<bool>;

/// A bond between a tile of a row and the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    /// The next tile's pose in the frame of the one before, both drawn as the pair's fixed tile.
    pub pose: Configuration,
    /// The map of the intended bond onto this one.
    pub map: Equal,
}

/// The joints of equal tiles with two binding faces.
pub struct Joints<'a> {
    pub(super) problem: &'a Problem,
    /// The map that lays the fixed tile onto the moving one.
    pub(super) congruence: Configuration,
    /// By the face of the tile before and that of the next one.
    joints: [[Option<Joint>; 2]; 2],
    radius: f64,
}

impl<'a> Joints<'a> {
    /// Those of a pair; `None` if its tiles differ, or bind with another number of faces than two.
    pub fn of(problem: &'a Problem) -> Option<Self> {
        problem.exchange?;
        let pair = problem.pair.as_deref()?;
        let congruence = congruence(&pair.fixed, &pair.moving)?;
        let radius = pair.fixed.outline.circumradius();
        let target = [
            pair.fixed.faces[pair.target.0].middle(),
            pair.moving.faces[pair.target.1].middle(),
        ];
        let mut faces: Vec<Vector2<f64>> = Vec::new();
        let mut number = |middle: Vector2<f64>| {
            let is_same = |known: &Vector2<f64>| (known - middle).norm() <= SAME_FACE * radius;
            faces.iter().position(is_same).unwrap_or_else(|| {
                faces.push(middle);
                faces.len() - 1
            })
        };
        let mut found = Vec::new();
        for bond in problem.bonds() {
            let [before, next] = bond.map.of_points(target);
            let ends = [before, congruence.inverse_transform(next)].map(&mut number);
            let joint = Joint {
                pose: bond.pose.compose(&congruence),
                map: bond.map,
            };
            found.push((ends, joint));
        }
        let mut joints = [[None; 2]; 2];
        for ([before, next], joint) in &found {
            *joints.get_mut(*before)?.get_mut(*next)? = Some(*joint);
        }
        let count = joints.iter().flatten().flatten().count();
        (faces.len() == 2 && count == found.len()).then_some(Self {
            problem,
            congruence,
            joints,
            radius,
        })
    }

    /// The number of ways in which two single tiles bind.
    pub fn ways(&self) -> usize {
        self.joints.iter().flatten().flatten().count()
    }

    /// The bond of a tile of a row with the next one, if those faces bind.
    pub(super) fn joint(&self, before: bool, next: bool) -> Option<&Joint> {
        self.joints[usize::from(!before)][usize::from(next)].as_ref()
    }

    /// A row of tiles that all turn the same way, if they bind so.
    pub fn uniform(&self, count: usize) -> Option<TileRow> {
        self.joint(false, false).map(|_| vec![false; count])
    }

    /// The exact places of a row's tiles, in the frame of the first.
    fn places(&self, row: &[bool]) -> Vec<Configuration> {
        let mut places = vec![Configuration::new(0.0, 0.0, 0.0)];
        for pair in row.windows(2) {
            let here = places[places.len() - 1];
            let joint = self.joint(pair[0], pair[1]);
            places.push(joint.map_or(here, |joint| here.compose(&joint.pose)));
        }
        places
    }

    /// Whether two rows, of which the first has `first` tiles, have room as one.
    pub fn fit(&self, row: &[bool], first: usize) -> bool {
        let places = self.places(row);
        let back = self.congruence.inverse();
        (0..first).all(|a| {
            (first..row.len()).all(|b| {
                let to = places[a].inverse().compose(&places[b]);
                let is_joint = (a + 1, b) == (first, first);
                is_joint
                    || to.position().norm() >= 2.0 * self.radius
                    || self.problem.clearance(&to.compose(&back)) >= -OVERLAP * self.radius
            })
        })
    }

    /// The number of tiles of the longest uniform row, if one of `most` has no room.
    pub fn longest(&self, most: usize) -> Option<usize> {
        (2..=most).find_map(|count| {
            let row = self.uniform(count)?;
            (!self.fit(&row, count - 1)).then_some(count - 1)
        })
    }

    /// A value for each joint.
    pub(super) fn each<T>(&self, of: impl Fn(&Joint) -> T) -> [[Option<T>; 2]; 2] {
        from_fn(|before| from_fn(|next| self.joints[before][next].as_ref().map(&of)))
    }
}
