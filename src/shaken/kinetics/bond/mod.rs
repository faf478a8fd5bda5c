//! How strongly states hold shaken tiles: the Gse and Gmc of tile assembly models.

pub mod corner;
mod frame;
mod line;
mod root;
pub mod volume;
pub mod well;

use std::cell::RefCell;

use self::root::{root, straight_root};
use self::volume::Estimate;
use self::well::Well;
use landscape::roadmap::Point;
use landscape::{Catalogue, Kind, Place};
use tiles::configuration::Configuration;
use tiles::interruption;
use tiles::problem::Problem;

/// Relative tolerance of partition functions.
pub const TOLERANCE: f64 = 2e-3;
/// ... and that for searching the window of kT.
const ROUGH: f64 = 1e-2;
/// A state shallower than this (in kT) holds nothing: bound and free tiles are practically the
/// same.
pub const LEAST_DEPTH: f64 = 2.0;
/// Range of the bond's depth in kT in which the window is searched.
const DEPTHS: [f64; 2] = [2.0, 120.0];

/// Why there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BondError {
    /// There is no state where the target faces meet.
    #[error(
        "the tiles do not hold where the target faces meet, so there is no bond (see `tilebind \
         show`)"
    )]
    NoBond,
    /// The energy is not that of two tiles.
    #[error("without tiles there is no coverage of a table")]
    NoTiles,
}

/// A shaken table with tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaking {
    /// Effective energy kT (J).
    pub kt: f64,
    /// Share of the table covered by tiles.
    pub coverage: f64,
}

/// A kind of state that holds tiles.
pub struct Hold<'a> {
    /// Its letter: `A` for the bond, `B` for the deepest trap.
    pub name: String,
    /// The configuration of its first state.
    pub configuration: Configuration,
    /// U there (J).
    pub energy: f64,
    /// The number of its symmetric copies, including those by rotations of the fixed tile and by the
    /// exchange of equal tiles; for the bond, all contacts that count as it.
    pub copies: usize,
    /// The number of copies by rotations of the moving tile alone.
    pub moving_copies: usize,
    /// Its basin, for integrals.
    pub well: Well<'a>,
    area: f64,
}

/// The depth and the docking cost of a state at one kT, in kT.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Binding {
    /// Depth of the state over kT (Gse).
    pub depth: f64,
    /// The integral Z0 (m^2 rad) of `exp(-(U - Umin) / kT)` over the state's basin.
    pub volume: Estimate,
    /// `-ln(rho Z0 s / 2 pi)` with rho tiles per square metre and s copies (Gmc); infinite if the
    /// basin has no volume, as between square teeth without play.
    pub cost: f64,
}

impl Binding {
    /// ln K of `bonds` equal bonds closed by one docking: their total depth less the docking cost.
    pub fn ln_k(&self, bonds: f64) -> f64 {
        bonds * self.depth - self.cost
    }
}

impl<'a> Hold<'a> {
    /// The bond of a catalogue.
    ///
    /// # Errors
    /// If there is none.
    pub fn bond(problem: &'a Problem, catalogue: &Catalogue) -> Result<Self, BondError> {
        problem.pair.as_ref().ok_or(BondError::NoTiles)?;
        let kind = catalogue.kinds().find(Kind::is_bond);
        let kind = kind.ok_or(BondError::NoBond)?;
        let name = catalogue.names()[kind.first().id].clone();
        let all = catalogue.kinds().filter(Kind::is_bond);
        Ok(Self {
            copies: all.map(|kind| kind.copies()).sum(),
            ..Self::new(problem, catalogue, &kind, name)
        })
    }

    /// A kind of states of a catalogue; computes its basin.
    fn new(problem: &'a Problem, catalogue: &Catalogue, kind: &Kind, name: String) -> Self {
        interruption::check();
        let state = kind.first();
        let minimum = Point::new(problem, state.configuration);
        let others = catalogue.states.iter().filter(|other| other.id != state.id);
        let others: Vec<_> = others.map(|other| other.configuration).collect();
        Self {
            name,
            configuration: state.configuration,
            energy: minimum.energy,
            copies: kind.copies(),
            moving_copies: problem.symmetries.iter().filter(|s| s.fixed == 0.0).count(),
            well: Well::new(problem, &minimum, pass(catalogue, kind), &others),
            area: problem
                .pair
                .as_ref()
                .map_or(0.0, |pair| pair.moving.outline.area()),
        }
    }

    /// Whether it is deep enough at kT (J) to hold anything.
    pub fn holds_at(&self, kt: f64) -> bool {
        -self.energy >= LEAST_DEPTH * kt
    }

    /// Whether it has play, but at kT (J) less than the contact tolerance: tiles move by less than
    /// [`self::volume::NO_PLAY`] in it. A state without play at a tenth of its depth has none at
    /// all.
    pub fn is_too_cold(&self, kt: f64) -> bool {
        let has_play = |kt: f64| self.well.has_play(kt);
        !has_play(kt) && has_play(-self.energy / 10.0)
    }

    /// Its strength at one kT, with the integral to the relative `tolerance`.
    pub fn docking(&self, shaking: &Shaking, tolerance: f64) -> Binding {
        let volume = self.well.volume(shaking.kt, tolerance);
        self.with(shaking, volume)
    }

    /// The same with only the part of its basin below `level` (J).
    pub fn docking_below(&self, shaking: &Shaking, level: f64, tolerance: f64) -> Binding {
        let volume = self.well.volume_below(shaking.kt, level, tolerance);
        self.with(shaking, volume)
    }

    /// The same with the partition function in closed form, see [`corner`]; `None` if there is
    /// none.
    pub fn closed_form(&self, problem: &Problem, shaking: &Shaking) -> Option<Binding> {
        let value = corner::volume(problem, &self.configuration, shaking.kt)?;
        let error = f64::NAN;
        Some(self.with(shaking, Estimate { value, error }))
    }

    /// The association constant K (m^2) of one pair: alone on an area S, the pair is in one of the
    /// state's copies K / S times as often as free. `K = n Z0 exp(depth) / 2 pi` with all n copies.
    pub fn association(&self, docking: &Binding) -> f64 {
        self.copies as f64 * docking.volume.value * libm::exp(docking.depth) / std::f64::consts::TAU
    }

    fn with(&self, shaking: &Shaking, volume: Estimate) -> Binding {
        let density = shaking.coverage / self.area;
        let share = density * volume.value * self.moving_copies as f64 / std::f64::consts::TAU;
        Binding {
            depth: -self.energy / shaking.kt,
            volume,
            cost: -libm::log(share),
        }
    }

    /// The two kT (J) at a coverage between which two bonds closed by one docking hold a tile and
    /// one alone does not: at the first, ln K of one bond is 0; at the second, ln K of two bonds
    /// with a single docking cost. `None` if there is no such kT for a bond of 2 to 120 kT.
    pub fn window(&self, coverage: f64) -> [Option<f64>; 2] {
        let cost = |docking: &Binding, _: f64| docking.cost;
        let known = RefCell::default();
        [1.0, 2.0].map(|bonds| self.threshold(coverage, bonds, &cost, &known))
    }

    /// The kT (J) at which a pair with an area (m^2) for itself is bound `exp(log_odds)` times as
    /// long as it is free; `None` if there is no such kT for a bond of 2 to 120 kT.
    pub fn kt_of_odds(&self, log_odds: f64, area: f64) -> Option<f64> {
        let cost = |docking: &Binding, depth: f64| {
            depth + log_odds - libm::log(self.association(docking) / area)
        };
        self.threshold(1.0, 1.0, &cost, &RefCell::default())
    }

    /// The kT (J) above which `bonds` depths are less than a cost that decreases with kT; known
    /// costs, by the logarithm of the depth in kT, are reused.
    fn threshold(
        &self,
        coverage: f64,
        bonds: f64,
        cost: &dyn Fn(&Binding, f64) -> f64,
        known: &RefCell<Vec<[f64; 2]>>,
    ) -> Option<f64> {
        let of = |log_depth: f64| {
            let found = known.borrow().iter().find(|it| it[0] == log_depth).copied();
            if let Some([_, cost]) = found {
                return cost;
            }
            let depth = libm::exp(log_depth);
            let kt = -self.energy / depth;
            let cost = cost(&self.docking(&Shaking { kt, coverage }, ROUGH), depth);
            known.borrow_mut().push([log_depth, cost]);
            cost
        };
        let ends = DEPTHS.map(libm::log);
        let found = straight_root(bonds, &of, ends);
        let found = found.or_else(|| root(|log| bonds * libm::exp(log) - of(log), ends));
        found.map(|log_depth| -self.energy / libm::exp(log_depth))
    }
}

/// The kinds of traps of a catalogue that are deep enough to hold anything at kT (J), in the
/// catalogue's order.
pub fn traps<'a>(problem: &'a Problem, catalogue: &Catalogue, kt: f64) -> Vec<Hold<'a>> {
    let names = catalogue.names();
    let is_deep = |kind: &Kind| -kind.first().energy >= LEAST_DEPTH * kt;
    let kinds = catalogue
        .kinds()
        .filter(|kind| !kind.is_bond() && is_deep(kind));
    let trap = |kind: Kind| Hold::new(problem, catalogue, &kind, names[kind.first().id].clone());
    kinds.map(trap).collect()
}

/// The lowest energy (J) of a known path out of a kind of states.
fn pass(catalogue: &Catalogue, kind: &Kind) -> f64 {
    let is_own = |place: Place| kind.states.iter().any(|it| place == Place::State(it.id));
    let ways = catalogue.barriers.iter();
    let ways = ways.filter(|way| is_own(way.from) != is_own(way.to));
    ways.fold(f64::INFINITY, |least, way| least.min(way.saddle_energy))
}
