//! The contacts of all faces of a set of words as data of the page.

use nalgebra::Vector2;
use serde::Serialize;

use super::landscape::Stands;
use super::numbers::{finite, fixed};
use crate::document::rows;
use crate::plots::Drawing;
use crate::plots::matrix::Matrix;
use physics::configuration::Configuration;
use physics::tile::Magnet;
use physics::tile::magnet::Form;
use physics::words::Word;

/// A map of all pairs of faces, words and then their mates: the strongest wrong contact of each
/// pair, which a click shows.
#[derive(Clone, Debug, Serialize)]
pub struct Meetings {
    /// The heading.
    pub title: String,
    /// The meaning of a cell.
    pub note: String,
    /// The names of the faces.
    pub names: Vec<String>,
    /// Their codes.
    pub codes: Vec<String>,
    /// Energies (J), null for faces that do not meet.
    #[serde(rename = "energies_J")]
    energies: Vec<Vec<Option<f64>>>,
    /// Proved lower bounds (J); empty if nothing is proved.
    #[serde(rename = "lower_J")]
    lower: Vec<Vec<Option<f64>>>,
    /// Poses of the tile with the second face in the frame of the tile with the first.
    poses: Vec<Vec<Option<[f64; 3]>>>,
    /// Whether the second tile is turned over; empty if none ever is.
    over: Vec<Vec<bool>>,
    /// Whether words bind their own kind, so that there are no mates.
    own: bool,
    /// Depth of the weakest bond (J).
    #[serde(rename = "bond_J")]
    bond: f64,
    /// The initially shown contact.
    worst: [usize; 2],
    /// The outline of both tiles.
    outline: Vec<[f64; 2]>,
    /// The magnets of each face when its tile is the first.
    first: Vec<Vec<Block>>,
    /// The magnets of each face when its tile is the second.
    second: Vec<Vec<Block>>,
}

/// A magnet.
#[derive(Clone, Debug, Serialize)]
struct Block {
    position: [f64; 2],
    angle: f64,
    size: [f64; 2],
    #[serde(skip_serializing_if = "Option::is_none")]
    stands: Option<Stands>,
}

/// One contact of two faces.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    /// Energy (J).
    pub energy: f64,
    /// Proved lower bound (J).
    pub lower: Option<f64>,
    /// Pose of the second tile.
    pub pose: Configuration,
    /// Whether the second tile is turned over.
    pub over: bool,
}

/// The square tiles that carry the words.
#[derive(Clone, Debug)]
pub struct Carrier {
    /// Side of the tiles (m).
    pub side: f64,
    /// Positions of the places along a face (m).
    pub places: Vec<f64>,
    /// Size of a magnet along its axis and along the face (m).
    pub size: [f64; 2],
    /// Distance from the face to a magnet's outer end (m).
    pub inset: f64,
    /// The form of the magnets, with north up for upright ones.
    pub form: Form,
}

impl Carrier {
    /// The magnets of a word on the east face of the first tile or the west face of the second.
    fn blocks(&self, word: Word, east: bool) -> Vec<Block> {
        let depth = self.side / 2.0 - self.inset - self.size[0] / 2.0;
        let sign = if east { 1.0 } else { -1.0 };
        let magnets = self.places.iter().enumerate();
        magnets
            .filter(|(k, _)| word.at(*k) != 0)
            .map(|(k, at)| Block {
                position: [fixed(sign * depth), fixed(sign * at)],
                // The north pole points outwards.
                angle: match (word.at(k) > 0) == east {
                    true => 0.0,
                    false => std::f64::consts::PI,
                },
                size: self.size,
                stands: Stands::of(match word.at(k) > 0 {
                    true => self.form,
                    false => self.form.reversed(),
                }),
            })
            .collect()
    }

    /// The pose of two flush tiles: the second is shifted by `slide` (m) along the first one's
    /// face.
    pub fn flush(&self, slide: f64) -> Configuration {
        Configuration::new(self.side, slide, 0.0)
    }

    /// From the magnets at the places of an existing tile.
    pub fn of_magnets(
        side: f64,
        normal: Vector2<f64>,
        magnets: &[Magnet],
        places: Vec<f64>,
    ) -> Self {
        let first = magnets.first();
        let size = first.map_or([0.0; 2], |magnet| [magnet.size[0], magnet.size[1]]);
        let out = first.map_or(0.0, |magnet| magnet.position.dot(&normal));
        Self {
            side,
            places,
            inset: side / 2.0 - out - size[0] / 2.0,
            size,
            form: first.map_or(Form::default(), |magnet| magnet.form),
        }
    }
}

impl Meetings {
    /// From faces with their names and words; `met` gives the contact of every two of them (rows,
    /// columns).
    pub fn new(
        carrier: &Carrier,
        faces: &[(String, Word)],
        bond: f64,
        met: impl Fn(usize, usize) -> Option<Met>,
    ) -> Self {
        let n = faces.len();
        let all: Vec<Vec<Option<Met>>> = (0..n)
            .map(|i| (0..n).map(|j| met(i, j)).collect())
            .collect();
        fn table<T>(all: &[Vec<Option<Met>>], pick: impl Fn(&Option<Met>) -> T) -> Vec<Vec<T>> {
            all.iter()
                .map(|row| row.iter().map(&pick).collect())
                .collect()
        }
        let energy = |&(i, j): &(usize, usize)| all[i][j].map_or(f64::INFINITY, |met| met.energy);
        let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let worst = pairs
            .min_by(|a, b| energy(a).total_cmp(&energy(b)))
            .unwrap_or((0, 0));
        let any = |has: fn(&Met) -> bool| all.iter().flatten().flatten().any(has);
        let or_none = |some: bool, table: Vec<Vec<bool>>| if some { table } else { Vec::new() };
        let half = carrier.side / 2.0;
        Self {
            title: String::new(),
            note: String::new(),
            names: faces.iter().map(|face| face.0.clone()).collect(),
            codes: faces.iter().map(|face| face.1.to_string()).collect(),
            energies: table(&all, |met| met.and_then(|met| finite(met.energy, 5))),
            lower: match any(|met| met.lower.is_some()) {
                true => table(&all, |met| met.and_then(|met| finite(met.lower?, 5))),
                false => Vec::new(),
            },
            poses: table(&all, |met| met.map(|met| met.pose.to_array().map(fixed))),
            over: or_none(
                any(|met| met.over),
                table(&all, |met| met.is_some_and(|met| met.over)),
            ),
            own: !faces.iter().any(|face| face.0.ends_with('*')),
            bond,
            worst: [worst.0, worst.1],
            outline: vec![[half, -half], [half, half], [-half, half], [-half, -half]],
            first: faces
                .iter()
                .map(|face| carrier.blocks(face.1, true))
                .collect(),
            second: faces
                .iter()
                .map(|face| carrier.blocks(face.1, false))
                .collect(),
        }
    }

    /// The same as a picture.
    pub(crate) fn picture(&self) -> Drawing<'static> {
        let share = |energy: &Option<f64>| energy.map(|energy| (-energy / self.bond).max(0.0));
        let row = |row: &Vec<Option<f64>>| row.iter().map(share).collect();
        let shares: Vec<Vec<Option<f64>>> = self.energies.iter().map(row).collect();
        let n = self.names.len();
        let pairs = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let met = pairs.filter_map(|(i, j)| Some((i, j, self.energies[i][j]?, shares[i][j]?)));
        let numbers = rows(met)
            .data("first", |it| self.names[it.0].clone())
            .data("second", |it| self.names[it.1].clone())
            .data("energy_J", |it| it.2)
            .data("share", |it| it.3);
        Matrix {
            name: "crosstalk",
            title: self.title.clone(),
            names: self.names.clone(),
            numbers: numbers.table("crosstalk").csv(),
            shares,
            is_framed: match self.own {
                true => |row, column, _| row == column,
                false => |row, column, count| 2 * row.abs_diff(column) == count,
            },
            legend: "attraction relative to the weakest bond",
            remark: match self.own {
                true => "framed: a word and its own kind",
                false => "framed: a word and its own mate",
            },
        }
        .into()
    }

    /// Sets the heading and the meaning of a cell.
    #[must_use]
    pub fn titled(self, title: &str, note: &str) -> Self {
        Self {
            title: title.to_owned(),
            note: note.to_owned(),
            ..self
        }
    }
}
