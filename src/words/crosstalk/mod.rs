//! Crosstalk: how strongly every two faces of a set attract, over all poses: tilted, slid,
//! separated.
//!
//! One tile carries the first word on its target face, the other the second on its own; their other
//! faces are empty. The energy is bilinear in the two words, so the energies of all pairs of
//! magnets in a pose, or their bounds in a cell of poses, give those of all pairs of words:
//! `grid` evaluates all pairs on one grid of poses, `minima` keeps the local minima there, `sampled`
//! finds the strongest attraction from them, and `certified` bounds it from one subdivision.
//!
//! Around the bond of a word and its own mate everything lies on the bond's slope; the wrong
//! contacts of these two are their `traps`, other stable contacts. A word that is its own mate (NS,
//! NNSS, UD) binds its own kind: there a word on itself is the bond, too.
//!
//! Exchanging the two tiles exchanges the words; a mirror exchanges every word for its mate. So two
//! pairs of two words and their mates are computed, and the others follow.

mod certified;
mod grid;
mod minima;
mod sampled;
mod traps;

pub use certified::Proof;

use std::sync::OnceLock;

use super::{Bar, Word};
use grid::{THINNED, slide_step, tilts};
use tiles::configuration::{Configuration, wrap_angle};
use tiles::contact::Contact;
use tiles::potential::interaction::{PairWork, pair_work};
use tiles::potential::{Energy, Interaction, Unbounded};
use tiles::problem::Problem;
use tiles::tile::{Pair, Tile};

/// Units of work of an energy besides its pairs of magnets: contact, sines, coefficients.
const AN_ENERGY: f64 = 250.0;
/// Of the poses of the grid, the share in which faces lie along each other.
const FACING: f64 = 0.3;
/// Energies for the refinement of a pose.
const REFINED: f64 = 120.0;
/// Minima of the grid that are refined, of two faces, and of a word and its mate for their traps.
const STARTS: [usize; 2] = [3, 8];

/// The default width of bounds, as a fraction of two magnets' energy.
pub const TOLERANCE: f64 = 0.25;

/// Two tiles whose target faces carry a magnet in every place, north poles out, in the order of the
/// places. The target faces must be each other's mirror images, as a square's east and west are.
pub struct Stage {
    pair: Pair,
    interaction: Interaction,
    contact: Contact,
    places: usize,
    /// The energy of magnet k of the fixed tile and magnet j of the moving one, at k places + j;
    /// built on first use.
    magnets: OnceLock<Vec<Energy>>,
}

/// The results for all pairs of faces: rows and columns are words, then their mates.
#[derive(Clone, Debug)]
pub struct Crosstalk {
    /// The words, without their mates.
    pub words: Vec<Word>,
    /// Lowest energy (J) found.
    pub strongest: Vec<Vec<f64>>,
    /// Its pose: the tile with the second word, in the frame of the tile with the first.
    pub poses: Vec<Vec<Configuration>>,
    /// For each word and its own mate, the deepest stable contact found besides the bond: energy
    /// (J) and pose; `None` if none was found.
    pub traps: Vec<Option<(f64, Configuration)>>,
    /// Proved lower bounds of the energy (J).
    pub lower: Option<Vec<Vec<f64>>>,
    /// Whether all lower bounds are within the tolerance.
    pub settled: bool,
    /// Number of cells evaluated for them.
    pub cells: usize,
}

/// The kind of contact of two faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactKind {
    /// A word on its own mate, which may be the word itself.
    Bond,
    /// Faces other than a word and its own mate.
    Wrong,
    /// A word and its own mate, away from the bond.
    Trap,
}

/// The strongest contact of this kind of two faces.
#[derive(Clone, Copy, Debug)]
pub struct StrongestContact {
    /// Row and column.
    pub faces: [usize; 2],
    /// Its kind.
    pub kind: ContactKind,
    /// The lowest energy (J) found.
    pub energy: f64,
    /// Its proved lower bound (J).
    pub lower: Option<f64>,
    /// The pose of the tile with the second face, in the frame of the tile with the first.
    pub pose: Configuration,
}

/// Two words on two tiles.
#[derive(Clone, Copy, Debug)]
struct Couple {
    first: Word,
    second: Word,
}

impl Couple {
    /// Whether it is a word and its own mate.
    fn is_bond(&self) -> bool {
        self.second == self.first.mate()
    }

    /// The number of its pairs of magnets.
    fn pairs(&self) -> usize {
        (self.first.magnets() * self.second.magnets()) as usize
    }

    /// The sign of the energy of magnets k and j relative to both with their north poles out.
    fn sign(&self, k: usize, j: usize) -> f64 {
        f64::from(self.first.at(k) * self.second.at(j))
    }
}

impl Stage {
    /// The stage for tiles with as many magnets on their target faces as words have places, and
    /// none elsewhere.
    pub fn new(pair: Pair, interaction: Interaction) -> Self {
        Self {
            contact: Contact::new(&pair.fixed.outline, &pair.moving.outline),
            places: pair.fixed.magnets.len(),
            magnets: OnceLock::new(),
            interaction,
            pair,
        }
    }

    /// The energy of magnet k of the fixed tile and magnet j of the moving one.
    fn alone(&self, k: usize, j: usize) -> Energy {
        let alone = |tile: &Tile, at: usize| Tile {
            magnets: vec![tile.magnets[at].clone()],
            ..tile.clone()
        };
        let (fixed, moving) = (&self.pair.fixed, &self.pair.moving);
        self.interaction
            .between(&alone(fixed, k), &alone(moving, j))
    }

    /// The energies of all pairs of magnets, at k places + j.
    fn magnets(&self) -> &[Energy] {
        let pair = |number| self.alone(number / self.places, number % self.places);
        let all = || (0..self.places * self.places).map(pair).collect();
        self.magnets.get_or_init(all)
    }

    /// Whether bounds can be proved.
    ///
    /// # Errors
    /// Why the energy of these magnets has no bounds over cells.
    pub fn certifiable(&self) -> Result<(), Unbounded> {
        self.alone(0, 0).bounds.map(|_| ())
    }

    /// The depth (J) of the contact of two facing magnets.
    pub fn contact_energy(&self) -> f64 {
        let facing = self.alone(0, self.places - 1);
        facing.potential.energy(&self.pair.bound).abs()
    }

    /// The energies (J) of all pairs of magnets for flush, aligned faces: place k of the first face
    /// and j of the second one, north poles out, at the index k times places + j.
    pub fn flush(&self) -> Vec<f64> {
        energies(self.magnets(), &self.pair.bound)
    }

    /// The crosstalk of words; with bounds closer than the given `tolerance` (J), if any, from at
    /// most this many `cells`, whose proof is followed by `proving`. Without [bounds over
    /// cells](Self::certifiable) nothing is proved, after all these cells.
    pub fn crosstalk(
        &self,
        words: &[Word],
        certify: Option<(f64, usize)>,
        proving: &dyn Fn(Proof),
    ) -> Crosstalk {
        let m = words.len();
        let couples: Vec<Couple> = couples_of(m)
            .map(|(i, j, mate)| Couple {
                first: words[i],
                second: if mate { words[j].mate() } else { words[j] },
            })
            .collect();
        let own: Vec<usize> = couples_of(m)
            .enumerate()
            .filter(|(_, (i, j, mate))| i == j && *mate)
            .map(|(number, _)| number)
            .collect();
        let grid = self.grid(&couples);
        let found = self.sampled(&couples, &grid);
        let bounds = certify.map(|limits| self.certified(&couples, &found, limits, proving));
        let mut crosstalk = Crosstalk {
            words: words.to_vec(),
            strongest: vec![vec![0.0; 2 * m]; 2 * m],
            traps: self.traps(&couples, &own, &grid),
            poses: vec![vec![Configuration::new(0.0, 0.0, 0.0); 2 * m]; 2 * m],
            lower: bounds.as_ref().map(|_| vec![vec![0.0; 2 * m]; 2 * m]),
            settled: bounds.as_ref().is_none_or(|bounds| bounds.settled),
            cells: bounds.as_ref().map_or(0, |bounds| bounds.cells),
        };
        for (number, (i, j, mate)) in couples_of(m).enumerate() {
            let (energy, pose) = found[number];
            let second = if mate { m + j } else { j };
            let other = |face: usize| if face < m { face + m } else { face - m };
            let places = [
                (i, second, pose),
                (second, i, exchanged(&pose)),
                (other(i), other(second), mirrored(&pose)),
                (other(second), other(i), exchanged(&mirrored(&pose))),
            ];
            for (row, column, pose) in places {
                crosstalk.strongest[row][column] = energy;
                crosstalk.poses[row][column] = pose;
                if let (Some(lower), Some(bounds)) = (&mut crosstalk.lower, &bounds) {
                    lower[row][column] = bounds.lower[number];
                }
            }
        }
        crosstalk
    }

    /// The problem of two tiles with these words.
    pub fn problem_of(&self, first: Word, second: Word) -> Problem {
        let mut pair = self.pair.clone();
        for (tile, word) in [(&mut pair.fixed, first), (&mut pair.moving, second)] {
            let magnets = tile.magnets.iter().enumerate();
            tile.magnets = magnets
                .filter(|(k, _)| word.at(*k) != 0)
                .map(|(k, magnet)| match word.at(k) {
                    1 => magnet.clone(),
                    _ => magnet.reversed(),
                })
                .collect();
        }
        let space = tiles::ConfigurationSpace {
            half_size: [2.0 * pair.free_distance(); 2],
            rho: pair.moving.radius_of_gyration(),
            free_distance: pair.free_distance(),
        };
        Problem::new(space, pair.into(), &self.interaction)
    }
}

/// Units of work to sample words with so many magnets each anywhere along a face (m), mostly for the
/// energies of all couples at all poses of the grid, and for the refinement of their lowest poses.
pub fn sampling_work(bar: &Bar, face: f64, words: usize, magnets: usize) -> u64 {
    let step = slide_step(bar.model, bar.size[1], bar.size[0] + 2.0 * bar.inset);
    let even = 2.0 * face / step + 1.0;
    let places = (2 * words * magnets) as f64;
    let facing = (places * places).min(even / THINNED);
    let poses = (tilts().len() as f64 + 1.0) * even + facing;
    let PairWork { far, near, reach } = pair_work(bar.model, bar.form, bar.size);
    // Of a magnet's others, those within reach.
    let beside = (1.0 + 2.0 * reach * magnets as f64 / face).min(magnets as f64);
    let (all, close) = ((magnets * magnets) as f64, magnets as f64 * beside);
    let couples = (words * (words + 1)) as f64;
    let on_grid = AN_ENERGY + all * far + FACING * close * near;
    let refined = AN_ENERGY + all * far + close * near;
    let [of_two, of_one] = STARTS;
    let starts = couples * of_two as f64 + (words * of_one) as f64;
    (couples * poses * on_grid + starts * REFINED * refined) as u64
}

impl Crosstalk {
    /// The word with the weakest bond, and its energy (J).
    pub fn weakest_bond(&self) -> Option<(usize, f64)> {
        let m = self.words.len();
        let bonds = (0..m).map(|i| (i, self.strongest[i][m + i]));
        bonds.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Whether the faces of a row and a column are meant to bind: a word and its own mate, or, if a word
    /// is its own mate, any two of them.
    pub fn binds(&self, row: usize, column: usize) -> bool {
        let m = self.words.len();
        row.abs_diff(column) == m || row % m == column % m && self.binds_itself(row % m)
    }

    /// Whether a word is its own mate.
    pub fn binds_itself(&self, word: usize) -> bool {
        self.words[word] == self.words[word].mate()
    }

    /// The rows and columns of different faces: mates that are their own words are left out.
    pub fn distinct(&self) -> impl Iterator<Item = usize> {
        let m = self.words.len();
        (0..2 * m).filter(move |face| *face < m || !self.binds_itself(face - m))
    }

    /// All faces, in the order of rows and columns.
    pub fn faces(&self) -> impl Iterator<Item = Word> {
        let mates = self.words.iter().map(|word| word.mate());
        self.words.iter().copied().chain(mates)
    }

    /// The strongest contacts of all pairs of faces, followed by the traps.
    pub fn meetings(&self) -> impl Iterator<Item = StrongestContact> {
        let m = self.words.len();
        let pairs = self.distinct().flat_map(move |i| {
            let from_here = self.distinct().filter(move |j| *j >= i);
            from_here.map(move |j| [i, j])
        });
        let pairs = pairs.map(move |[i, j]| StrongestContact {
            kind: match self.binds(i, j) {
                true => ContactKind::Bond,
                false => ContactKind::Wrong,
            },
            ..self.wrong_of([i, j])
        });
        pairs.chain((0..m).filter_map(move |i| self.worst(i, m + i)))
    }

    /// All contacts other than bonds: of two faces other than a word and its own mate, and traps.
    pub fn wrong(&self) -> impl Iterator<Item = StrongestContact> {
        self.meetings().filter(|it| it.kind != ContactKind::Bond)
    }

    /// The wrong contact that attracts most.
    pub fn strongest_wrong(&self) -> Option<StrongestContact> {
        self.wrong().min_by(|a, b| a.energy.total_cmp(&b.energy))
    }

    /// The worst wrong contact of the faces of a row and a column; for a word and its own mate a
    /// trap, if one was found.
    pub fn worst(&self, row: usize, column: usize) -> Option<StrongestContact> {
        let m = self.words.len();
        let faces = [row, column];
        if self.binds(row, column) {
            let (energy, pose) = self.traps[row.min(column) % m]?;
            return Some(StrongestContact {
                faces,
                kind: ContactKind::Trap,
                energy,
                lower: None,
                pose: if row < m { pose } else { exchanged(&pose) },
            });
        }
        Some(self.wrong_of(faces))
    }

    /// The strongest contact of two faces other than a word and its own mate.
    fn wrong_of(&self, faces: [usize; 2]) -> StrongestContact {
        let [i, j] = faces;
        StrongestContact {
            faces,
            kind: ContactKind::Wrong,
            energy: self.strongest[i][j],
            lower: self.lower.as_ref().map(|lower| lower[i][j]),
            pose: self.poses[i][j],
        }
    }

    /// 1 - strongest wrong attraction found / weakest bond.
    pub fn gap(&self) -> Option<f64> {
        let bond = self.weakest_bond()?.1;
        let wrong = self.strongest_wrong().map_or(0.0, |wrong| wrong.energy);
        (bond < 0.0).then(|| 1.0 - wrong.min(0.0) / bond)
    }

    /// The same with the proved lower bounds for all faces other than words and their own mates.
    pub fn proved_gap(&self) -> Option<f64> {
        let lower = self.wrong().filter_map(|it| it.lower);
        let deepest = lower.fold(0.0, f64::min);
        self.lower.as_ref()?;
        Some(1.0 - deepest / self.weakest_bond()?.1)
    }

    /// 1 - attraction / weakest bond for every wrong contact.
    pub fn gaps(&self) -> impl Iterator<Item = f64> {
        let bond = self.weakest_bond().map_or(-1.0, |bond| bond.1);
        self.wrong().map(move |it| 1.0 - it.energy.min(0.0) / bond)
    }
}

/// Words i <= j: i with j, and i with j's mate.
fn couples_of(m: usize) -> impl Iterator<Item = (usize, usize, bool)> {
    (0..m).flat_map(move |i| (i..m).flat_map(move |j| [(i, j, false), (i, j, true)]))
}

/// The same contact in the other tile's frame, with its target face to the east again: the inverse
/// pose, turned by half a turn.
fn exchanged(q: &Configuration) -> Configuration {
    let p = q.rotation().inverse() * q.position();
    Configuration::new(p.x, p.y, wrap_angle(-q.theta))
}

/// The same contact mirrored along the target face's normal.
fn mirrored(q: &Configuration) -> Configuration {
    Configuration::new(q.x, -q.y, wrap_angle(-q.theta))
}

/// Energies of all pairs of magnets in a pose (J).
fn energies(magnets: &[Energy], q: &Configuration) -> Vec<f64> {
    magnets
        .iter()
        .map(|energy| energy.potential.energy(q))
        .collect()
}
