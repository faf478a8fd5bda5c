//! A tile set built from magnets, at one kT and one coverage of the table.
//!
//! In kTAM a tile attaches to a free place with the rate `k_f exp(-Gmc)` and leaves it with `k_f
//! exp(-b Gse)`, where b is the strength that binds it there. Their ratio is the equilibrium
//! constant of one bond. With U its energy and Z0 its partition function around the bond,
//!
//! ```text
//! b Gse = -U / kT,    Gmc = -ln(rho Z0 / 2 pi) + ln(sum of shares),
//! ```
//!
//! where rho is the coverage over a tile's area, of all tiles together; each kind has its share of
//! it, and fits into its place in one of its four orientations. Gse and Z0 are those of the weakest
//! bond of strength 1. A tile bound by two bonds has less freedom than this; the engines ignore
//! that, so a real corner binds a little less strongly.

use std::collections::BTreeMap;

use super::assignment::assign;
use super::axis::{MeetingAxis, Met};
use super::depths::Depths;
use super::growth::{Grown, Holds, grow, neighbours};
use super::matrix::Matrix;
use super::rests::{Faces, Rests};
use super::wiring::{TilePair, Wiring};
use super::{Glue, TileSet};
use crate::design::WordSet;
use physics::bisection::bisected;
use physics::kinetics::bond::Shaking;
use physics::kinetics::bond::corner;
use physics::words::{Bar, Lags, Word};

/// A tile set with its words and energies.
pub struct Built {
    /// The set.
    pub set: TileSet,
    /// Its bonds; each has the word at the same index of the matrix.
    pub wiring: Wiring,
    /// The energies of all pairs of faces.
    pub matrix: Matrix,
    /// Depth (J) of the weakest bond, over its strength.
    pub unit: f64,
    /// The index of that bond.
    pub weakest: usize,
    /// What grows without errors.
    pub grown: Grown,
    /// The tiles that meet, with how often: in the grown assembly, or every two that bind.
    pub meetings: BTreeMap<Met, usize>,
    /// The contribution of the other faces of two tiles to their bond.
    pub rests: Rests,
}

/// The energies of a built set on a shaken table.
#[derive(Clone, Copy, Debug)]
pub struct Shaken {
    /// The shaking.
    pub shaking: Shaking,
    /// Gse (kT): the weakest bond of strength 1.
    pub gse: f64,
    /// Gmc (kT) of a tile with share 1 among its kinds.
    pub gmc: f64,
    /// The docking cost of a tile if all tiles were of its kind (kT).
    pub docking_cost: f64,
    /// The integral Z0 (m^2 rad) around the weakest bond.
    pub volume: f64,
}

/// How a set is to be put together, and whether its words were given.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plan {
    /// By hand, rather than by growth from a seed.
    pub laid: bool,
    /// Given words keep their orientation.
    pub given: bool,
}

/// Whether a tile set grows as it should.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrowthVerdict {
    /// No tile attaches to the seed, whatever kT: no bond has strength tau.
    Stuck,
    /// kT is too high: bonds of strength tau do not hold a tile.
    TooHard,
    /// kT is as high, but growths end right all the same, as tiles that more bonds hold stay.
    MoreHold,
    /// kT is too low: bonds weaker than tau also hold a tile.
    FewerHold,
    /// kT is as low, but growths end right all the same, as nothing else fits.
    FewerSuffice,
    /// kT is too low: a single aligned mismatch holds a tile.
    MismatchHolds,
    /// Bonds of strength tau hold a tile, weaker ones do not.
    TauHolds,
    /// One bond holds a tile, as intended.
    OneHolds,
    /// Bonds hold as intended, but wrong tiles are locked in by others: growths end with errors.
    ErrorsStay,
    /// Bonds hold as intended, but so weakly that growths do not end.
    Slow,
}

/// Number of tiles at which an unlimited growth without errors is stopped.
pub const MOST_GROWN: usize = 2500;
/// Largest number of pairs of tiles of a set that is laid by hand for which there are designs.
pub const MOST_MEETINGS: usize = 1000;
/// Free rows and columns around the assembly.
const MARGIN: i32 = 4;

impl Built {
    /// Builds a set with words, assigned so that wrong contacts have the least weight.
    ///
    /// # Errors
    /// If that is impossible.
    pub fn new(set: &TileSet, words: &WordSet, plan: Plan) -> Result<Self, String> {
        let wiring = Wiring::new(set)?;
        let (bonds, there) = (&wiring.bonds, words.words.len());
        let needed = bonds.len();
        if there < needed {
            return Err(format!(
                "the tile set needs {needed} words but the set has {there}: find more with \
                 `tilebind words`, on a longer face or with a narrower gap"
            ));
        }
        let grown = grow(set, MOST_GROWN);
        let rests = Rests::new(words);
        let all = Matrix::new(words, &words.words);
        let meetings = match plan.laid {
            true => all_meetings(set, &wiring),
            false => grown.meetings(),
        };
        let depths = Depths::new(&all, &rests, (set, &wiring), &meetings);
        let chosen = assign(&all, &wiring, depths.as_ref(), plan.given)?;
        let matrix = Matrix::new(words, &chosen);
        if let Some(bond) = (0..needed).find(|bond| matrix.bond(*bond) <= 0.0) {
            return Err(loose(chosen[bond]));
        }
        let least = wiring.least_strength();
        let depth = |bond: &usize| matrix.bond(*bond) / bonds[*bond].strength;
        let weakest = (0..needed).filter(|bond| bonds[*bond].strength == least);
        let weakest = weakest
            .min_by(|a, b| depth(a).total_cmp(&depth(b)))
            .unwrap_or(0);
        Ok(Self {
            set: set.clone(),
            unit: depth(&weakest),
            weakest,
            grown,
            meetings,
            rests,
            wiring,
            matrix,
        })
    }

    /// The energies on a shaken table.
    ///
    /// # Errors
    /// If the weakest bond does not hold its mate in place.
    pub fn shaken(&self, words: &WordSet, shaking: Shaking) -> Result<Shaken, String> {
        let word = self.matrix.words[self.weakest];
        let volume = volume(words, word, shaking.kt).ok_or_else(|| loose(word))?;
        let docking_cost = docking_cost(words, &shaking, volume);
        Ok(Shaken {
            shaking,
            gse: self.unit / shaking.kt,
            gmc: docking_cost + of_shares(&self.set),
            docking_cost,
            volume,
        })
    }

    /// The largest relative deviation of a bond's strength from the requested one, in units of the
    /// weakest bond; with the bond, its requested and its actual strength.
    pub fn unlike(&self) -> Option<(usize, f64, f64)> {
        let bonds = self.wiring.bonds.iter().enumerate();
        let got = bonds.map(|(k, bond)| (k, bond.strength, self.matrix.bond(k) / self.unit));
        let off = |it: &(usize, f64, f64)| (it.2 / it.1 - 1.0).abs();
        got.reduce(|most, next| if off(&next) > off(&most) { next } else { most })
    }

    /// The strongest wrong attraction of aligned faces (J, negative), and the two faces.
    pub fn strongest_wrong(&self) -> Option<(usize, usize, f64)> {
        let n = self.matrix.words.len();
        let wanted = |i: usize, j: usize| {
            i < n && j >= n && (j - i == n || self.wiring.are_linked(i, j - n))
        };
        let wrong = |i: usize, j: usize| !wanted(i, j);
        self.matrix.strongest(&wrong)
    }

    /// The word that a face carries, as an index of the matrix (mates come after the words).
    pub fn face(&self, tile: usize, side: usize) -> Option<usize> {
        let bond = self.wiring.of(&self.set, tile, side)?;
        Some(self.matrix.on(side, bond))
    }

    /// For two tiles that meet by a bond: its word, and the energy that their other faces add (J).
    pub fn whole(&self, met: &Met) -> Option<(usize, f64)> {
        let TilePair { axis, bond, faces } = self.wiring.meeting(&self.set, met)?;
        let code =
            |side: usize, bond: Option<usize>| Some(self.matrix.code(self.matrix.on(side, bond?)));
        let [first, second] =
            faces.map(|bonds| -> Faces { std::array::from_fn(|side| code(side, bonds[side])) });
        Some((bond, self.rests.of(axis, &first, &second)))
    }

    /// Whether the assembly grows at this kT.
    pub fn verdict(&self, shaken: &Shaken) -> GrowthVerdict {
        let (gse, gmc, tau) = (shaken.gse, shaken.gmc, self.set.tau());
        let less = self.wiring.least_strength();
        let wrong = self.strongest_wrong();
        let mismatch = wrong.map_or(0.0, |(.., energy)| -energy / shaken.shaking.kt);
        match () {
            () if self.grown.is_stuck() => GrowthVerdict::Stuck,
            () if gmc > tau * gse => GrowthVerdict::TooHard,
            () if tau > less && gmc < (tau - less) * gse => GrowthVerdict::FewerHold,
            () if mismatch > gmc => GrowthVerdict::MismatchHolds,
            () if tau > less => GrowthVerdict::TauHolds,
            () => GrowthVerdict::OneHolds,
        }
    }

    /// The set as engines run it: glues are faces, strengths their energies over Gse, seed and
    /// canvas as the growth needs them.
    pub fn engine(&self, shaken: &Shaken) -> TileSet {
        let faces = self.matrix.energies.len();
        let scale = -1.0 / self.unit;
        let strength = |i: usize, j: usize| scale * self.matrix.energies[i][j] + 0.0;
        let glue = |face: usize| Glue {
            name: self.matrix.name(face),
            strength: strength(face, face),
        };
        let mut set = TileSet {
            glues: (0..faces).map(glue).collect(),
            links: (0..faces)
                .flat_map(|i| (i + 1..faces).map(move |j| (i, j)))
                .map(|(i, j)| (i, j, strength(i, j)))
                .filter(|link| link.2 != 0.0)
                .collect(),
            gse: Some(shaken.gse),
            gmc: Some(shaken.gmc),
            ..self.set.clone()
        };
        for (number, tile) in set.tiles.iter_mut().enumerate() {
            tile.glues = std::array::from_fn(|side| self.face(number, side));
        }
        self.place(&mut set);
        set
    }

    /// Seed and canvas: those of the set if there is room, otherwise as the growth needs.
    fn place(&self, set: &mut TileSet) {
        let [low, high] = self.grown.extent();
        let room = |reach: i32| match self.grown.complete {
            true => reach + MARGIN,
            false => reach + reach / 3 + MARGIN,
        };
        let [west, south] = [-low.0, -low.1].map(room);
        let [east, north] = [high.0, high.1].map(room);
        let (rows, columns) = ((north + south + 1) as usize, (west + east + 1) as usize);
        let first = set.seed.first().copied().unwrap_or((0, 0, 0));
        let fits = |at: usize, size: usize, before: i32, after: i32| {
            at as i32 >= before.min(MARGIN) && size as i32 - 1 - at as i32 >= after.min(MARGIN)
        };
        let keeps = !set.seed.is_empty()
            && set.size.is_some_and(|[height, width]| {
                height >= rows
                    && width >= columns
                    && fits(first.0, height, north, south)
                    && fits(first.1, width, west, east)
            });
        if keeps {
            return;
        }
        let shift = |row: usize, column: usize| {
            let (dy, dx) = (row as i32 - first.0 as i32, column as i32 - first.1 as i32);
            ((north + dy) as usize, (west + dx) as usize)
        };
        if set.seed.is_empty() {
            set.seed.push((0, 0, 0));
        }
        for seed in &mut set.seed {
            (seed.0, seed.1) = shift(seed.0, seed.1);
        }
        let side = rows.max(columns);
        set.size = Some([side, side]);
    }

    /// Errors per tile in the limit of slow growth, just above standstill, where every tile stays
    /// as briefly as possible: the mean, over the places of the assembly, of the weights of all
    /// wrong tiles relative to the right one, each bound by the neighbours that attached earlier.
    pub fn errors_at_standstill(&self, shaken: &Shaken) -> f64 {
        let engine = Holds::new(&self.engine(shaken));
        let gse = shaken.gse;
        let mut there = BTreeMap::new();
        let mut sum = 0.0;
        for place in &self.grown.order {
            let tile = self.grown.tiles[place];
            if neighbours(*place).any(|(_, near)| there.contains_key(&near)) {
                let held = |tile: usize| gse * engine.at(&there, *place, tile);
                let stoic = |tile: usize| self.set.tiles[tile].stoic;
                let right = held(tile) + libm::log(stoic(tile).max(f64::MIN_POSITIVE));
                let others = (0..self.set.tiles.len()).filter(|other| *other != tile);
                let wrong: f64 = others
                    .map(|it| stoic(it) * libm::exp(held(it) - right))
                    .sum();
                sum += wrong / (1.0 + wrong);
            }
            there.insert(*place, tile);
        }
        sum / self.grown.order.len().max(1) as f64
    }

    /// The range of kT (J) in which bonds of strength tau hold a tile and weaker ones do not; Z0 is
    /// assumed to grow as kT^(5/2), as at a flush edge.
    pub fn window(&self, shaken: &Shaken) -> Option<[f64; 2]> {
        let tau = self.set.tau();
        let less = self.wiring.least_strength();
        // ln K of bonds of a given strength; it decreases with kT.
        let ln_k = |strength: f64, kt: f64| {
            let gmc = shaken.gmc - 2.5 * libm::log(kt / shaken.shaking.kt);
            strength * self.unit / kt - gmc
        };
        let end = |strength: f64| {
            let ends = [self.unit / 400.0, self.unit * tau.max(1.0)];
            let [low, high] = ends.map(libm::log);
            let ln_k = |log: f64| ln_k(strength, libm::exp(log));
            (ln_k(low) >= 0.0).then(|| libm::exp(bisected(low, high, 80, |log| ln_k(log) > 0.0)[0]))
        };
        let lower = if tau > less { end(tau - less)? } else { 0.0 };
        Some([lower, end(tau)?])
    }

    /// How much deeper a bond is between whole tiles than between two faces, as a share of its
    /// depth: the minimum and maximum over all pairs.
    pub fn deeper(&self) -> Option<[f64; 2]> {
        let met = self.meetings.keys();
        let shares = met.filter_map(|met| {
            let (bond, rest) = self.whole(met)?;
            Some(-rest / self.matrix.bond(bond))
        });
        shares.fold(None, |range, share| {
            let [low, high] = range.unwrap_or([share; 2]);
            Some([share.min(low), share.max(high)])
        })
    }

    /// Energies of two magnets by the number of places between them; `None` for words without a
    /// pitch.
    pub fn lags(words: &WordSet) -> Option<Lags> {
        let design = &words.stage;
        if words.places.is_some() {
            return None;
        }
        let (tile, face) = (&design.pair.fixed, design.pair.target.0);
        let bar = Bar::of_face(tile, face, &design.interaction, design.pitch?);
        Some(Lags::new(&bar.ok()?, words.words.first()?.places()))
    }
}

/// Every two tiles that a bond joins, at most [`MOST_MEETINGS`] of them.
fn all_meetings(set: &TileSet, wiring: &Wiring) -> BTreeMap<Met, usize> {
    let used = |tile: &usize| set.tiles[*tile].stoic > 0.0;
    let tiles = || (0..set.tiles.len()).filter(used);
    let pairs = tiles().flat_map(|a| tiles().map(move |b| (a, b)));
    let met = pairs.flat_map(|(a, b)| MeetingAxis::ALL.map(|axis| (a, axis, b)));
    let bound = met.filter(|met| wiring.meeting(set, met).is_some());
    bound.take(MOST_MEETINGS).map(|met| (met, 1)).collect()
}

fn loose(word: Word) -> String {
    format!("the word {word} does not hold its mate in place: use another word")
}

/// The integral Z0 (m^2 rad) around the bond of a word at kT (J).
fn volume(words: &WordSet, word: Word, kt: f64) -> Option<f64> {
    let problem = words.carriers().problem_of(word, word.mate());
    corner::volume(&problem, &words.stage.pair.bound, kt)
}

/// The docking cost of a tile if all tiles were of its kind (kT).
fn docking_cost(words: &WordSet, shaking: &Shaking, volume: f64) -> f64 {
    let area = words.stage.pair.moving.outline.area();
    -libm::log(shaking.coverage / area * volume / std::f64::consts::TAU)
}

/// The additional cost of a tile of share 1, being one kind of many (kT).
fn of_shares(set: &TileSet) -> f64 {
    let shares: f64 = set.tiles.iter().map(|tile| tile.stoic).sum();
    libm::log(shares.max(f64::MIN_POSITIVE))
}
