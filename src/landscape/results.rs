//! The results of a landscape as plain values: states, barriers and pathways.

use ordered_float::OrderedFloat;
use serde::{Deserialize, Serialize};

use crate::roadmap::knot;
use tiles::budget::Ended;
use tiles::configuration::Configuration;
use tiles::potential::Unbounded;

/// States whose energies differ by less than this fraction count as equally deep.
pub const SAME_ENERGY: f64 = 1e-6;

/// Whether a state is the intended bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum StateKind {
    /// The two target faces coincide.
    Bond,
    /// Any other minimum: a trap.
    Trap,
}

/// A proportion found by sampling, with its 95 % Wilson interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Proportion {
    /// Number of successes.
    pub count: usize,
    /// Number of trials.
    pub of: usize,
    /// Lower end of the interval, 0 to 1.
    pub low: f64,
    /// Upper end of the interval, 0 to 1.
    pub high: f64,
}

impl Proportion {
    /// The proportion `count / of` with its 95 % Wilson score interval (Wilson 1927,
    /// doi:10.1080/01621459.1927.10502953). With `of` = 0 the interval is [0, 1].
    pub fn new(count: usize, of: usize) -> Self {
        if of == 0 {
            return Self {
                count,
                of,
                low: 0.0,
                high: 1.0,
            };
        }
        const Z: f64 = 1.959_963_984_540_054;
        let n = of as f64;
        let p = count as f64 / n;
        let centre = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        Self {
            count,
            of,
            // Sets the ends of [0, 1] exactly, which rounding would miss.
            low: if count == 0 { 0.0 } else { centre - half },
            high: if count == of { 1.0 } else { centre + half },
        }
    }

    /// The same if `unknown` more of them may count or not: its interval holds either way.
    pub fn at_least(count: usize, unknown: usize, of: usize) -> Self {
        Self {
            high: Self::new(count + unknown, of).high,
            ..Self::new(count, of)
        }
    }

    /// `count / of`; 0 if `of` is 0.
    pub fn share(&self) -> f64 {
        if self.of == 0 {
            0.0
        } else {
            self.count as f64 / self.of as f64
        }
    }
}

/// Shares of the far starts that end in no reported state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uncaptured {
    /// Those that come to rest in a minimum too shallow to be reported.
    pub at_rest: Proportion,
    /// Those that leave the table.
    pub gone: Proportion,
}

impl Uncaptured {
    /// All of them.
    pub fn all(&self) -> Proportion {
        Proportion::new(self.at_rest.count + self.gone.count, self.gone.of)
    }
}

/// A local minimum of the energy over the free configurations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Its place in the list of states.
    pub id: usize,
    /// The intended bond, or a trap.
    pub kind: StateKind,
    /// Where the minimum is.
    pub configuration: Configuration,
    /// U (J).
    pub energy: f64,
    /// States that a symmetry of the two tiles maps onto each other share this number; the
    /// lowest id among them.
    pub class: usize,
    /// Pairs (face of the fixed tile, face of the moving tile) that touch.
    pub faces: Vec<(usize, usize)>,
    /// Magnet pairs within 1.5 pitches (or magnet lengths) of each other that attract, and repel.
    pub attracting: usize,
    /// The pairs among them that repel.
    pub repelling: usize,
    /// Energy (J) of uniformly magnetised blocks in this configuration, if `energy` is for point
    /// dipoles.
    pub block_energy: Option<f64>,
    /// Share of far starts that overdamped motion takes into this state.
    pub capture: Option<Proportion>,
    /// For the first state of a kind: the lowest pass (J) to an equally deep state, a mirror twin
    /// or a copy, if it is lower than the pass to `free` or to a clearly lower state.
    pub sideways: Option<f64>,
}

impl State {
    /// A minimum of which nothing else is known, in a class of its own.
    pub fn new(id: usize, kind: StateKind, configuration: Configuration, energy: f64) -> Self {
        Self {
            id,
            kind,
            configuration,
            energy,
            class: id,
            faces: Vec::new(),
            attracting: 0,
            repelling: 0,
            block_energy: None,
            capture: None,
            sideways: None,
        }
    }

    /// Energy of the point dipoles minus the energy of the blocks they represent (J).
    pub fn dipole_error(&self) -> Option<f64> {
        self.block_energy.map(|blocks| self.energy - blocks)
    }
}

/// One end of a barrier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Place {
    /// A state by its id.
    State(usize),
    /// Any configuration with the tiles far apart.
    Free,
}

/// A point of a pathway.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathwayPoint {
    /// Length along the pathway in the metric of the configuration space (m).
    pub s: f64,
    /// Where the moving tile is.
    pub configuration: Configuration,
    /// U (J).
    pub energy: f64,
    /// Signed clearance of the tiles (m).
    pub clearance: f64,
}

/// A continuous free motion: from point to point it is straight in x, y and theta (the shorter way
/// round), proved free to half a micrometre of the paper's tile, and nowhere exceeds its highest point. The
/// points are close enough for U to be nearly linear between them.
pub type Pathway = Vec<PathwayPoint>;

/// Mechanical work against the energy along a pathway, forwards and backwards (J): the sums of its
/// climbs and of its falls.
pub fn work(pathway: &Pathway) -> [f64; 2] {
    knot::work(pathway.iter().map(|point| point.energy))
}

/// Proved bounds of the highest energy on the best path between two places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SaddleBounds {
    /// Every free path reaches this energy (J); `None` if nothing is proved.
    #[serde(rename = "lower_J")]
    pub lower: Option<f64>,
    /// A known free path nowhere exceeds this energy (J).
    #[serde(rename = "upper_J")]
    pub upper: Option<f64>,
    /// Whether it is proved that there is no free path.
    pub caged: bool,
}

impl SaddleBounds {
    /// Tightens the bounds by other bounds of the same energy.
    pub fn tighten(&mut self, other: Self) {
        let better = |a: Option<f64>, b: Option<f64>, better: fn(f64, f64) -> f64| {
            a.zip(b).map(|(a, b)| better(a, b)).or(a).or(b)
        };
        self.lower = better(self.lower, other.lower, f64::max);
        self.upper = better(self.upper, other.upper, f64::min);
        self.caged |= other.caged;
    }

    /// The proved lower bound (J): minus infinity if nothing is proved, infinity if there is no
    /// path.
    pub fn least(&self) -> f64 {
        if self.caged {
            return f64::INFINITY;
        }
        self.lower.unwrap_or(f64::NEG_INFINITY)
    }

    /// Width (J): zero if it is proved that there is no path, infinite if a bound is missing.
    pub fn width(&self) -> f64 {
        match self.both() {
            _ if self.caged => 0.0,
            Some((lower, upper)) => upper - lower,
            None => f64::INFINITY,
        }
    }

    /// Both bounds (J), if both are known.
    pub fn both(&self) -> Option<(f64, f64)> {
        self.lower.zip(self.upper)
    }

    /// The bounds of the climb from an energy (J), never negative.
    pub fn above(&self, energy: f64) -> Self {
        let above = |saddle: f64| (saddle - energy).max(0.0);
        Self {
            lower: self.lower.map(above),
            upper: self.upper.map(above),
            caged: self.caged,
        }
    }
}

/// Why barriers have no certified bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum Uncertified {
    /// No bounds were requested.
    #[error("no proof was requested")]
    Unasked,
    /// The effort was spent before.
    #[error("{} before the first bounds", .0.describe())]
    Ended(Ended),
    /// The energy has no bounds over cells.
    #[error(transparent)]
    Unbounded(#[from] Unbounded),
}

/// The barrier between two places: the lowest maximum energy over all free paths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Barrier {
    /// Where it starts.
    pub from: Place,
    /// Where it ends.
    pub to: Place,
    /// Highest energy on the best pathway found (J): an upper bound of the minimax energy. Infinite
    /// if no pathway is known.
    pub saddle_energy: f64,
    /// The configuration of the saddle; the start if no pathway is known.
    pub saddle: Configuration,
    /// Proved bounds of the saddle's energy.
    pub bounds: SaddleBounds,
    /// Energy (J) of the start; 0 for `Free`.
    pub from_energy: f64,
    /// Energy (J) of the end; 0 for `Free`.
    pub to_energy: f64,
    /// Lowest and highest saddle energy (J) over repeated runs with other seeds.
    pub spread: Option<(f64, f64)>,
    /// The pathway from end to end; empty if none is known.
    pub pathway: Pathway,
}

impl Barrier {
    /// A barrier without a known pathway. Each end is a place with its energy (J).
    pub fn without_a_way(from: (Place, f64), start: Configuration, to: (Place, f64)) -> Self {
        Self {
            from: from.0,
            to: to.0,
            saddle_energy: f64::INFINITY,
            saddle: start,
            bounds: SaddleBounds::default(),
            from_energy: from.1,
            to_energy: to.1,
            spread: None,
            pathway: Pathway::new(),
        }
    }

    /// Whether a pathway over it is known.
    pub fn has_way(&self) -> bool {
        !self.pathway.is_empty()
    }

    /// Saddle minus the energy of the start (J).
    pub fn forward(&self) -> f64 {
        self.saddle_energy - self.from_energy
    }

    /// Saddle minus the energy of the end (J); 0 if the path into `Free` never rises above the
    /// energy of tiles far apart.
    pub fn reverse(&self) -> f64 {
        (self.saddle_energy - self.to_energy).max(0.0)
    }

    /// Proved bounds of the climb from the start (J), never negative; `None` if one is missing. This
    /// is what people read as "certified".
    pub fn certified(&self) -> Option<(f64, f64)> {
        self.bounds.above(self.from_energy).both()
    }

    /// Work against the energy along the pathway (J), from start to end and back; `None` if no
    /// pathway is known.
    pub fn work(&self) -> Option<[f64; 2]> {
        self.has_way().then(|| work(&self.pathway))
    }

    /// Length (m) of the pathway in the metric of the space; `None` if no pathway is known.
    pub fn length(&self) -> Option<f64> {
        self.pathway.last().map(|last| last.s)
    }

    /// Replaces the pathway by another one between the same ends, and the saddle by its highest
    /// point.
    pub fn lead_along(&mut self, pathway: Pathway) {
        if let Some(highest) = highest_point(&pathway).copied() {
            self.saddle_energy = highest.energy;
            self.saddle = highest.configuration;
            self.pathway = pathway;
        }
    }

    /// The same, if it is lower than the known pathway.
    pub fn lead_lower(&mut self, pathway: Pathway) {
        let is_lower = |highest: &PathwayPoint| highest.energy < self.saddle_energy;
        if highest_point(&pathway).is_some_and(is_lower) {
            self.lead_along(pathway);
        }
    }
}

/// The point of a pathway with the highest energy.
pub fn highest_point(pathway: &Pathway) -> Option<&PathwayPoint> {
    pathway
        .iter()
        .max_by_key(|point| OrderedFloat(point.energy))
}

/// A pathway that minimises a cost other than the highest energy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Alternative {
    /// Where it starts.
    pub from: Place,
    /// Where it ends.
    pub to: Place,
    /// The cost that it minimises.
    pub by: PathwayCost,
    /// The cost: J of work, or -ln of the probability.
    pub cost: f64,
    /// From end to end.
    pub pathway: Pathway,
}

/// The cost that a pathway minimises.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PathwayCost {
    /// Work against the energy (J).
    Work,
    /// -ln of the product of the transition probabilities.
    Probability,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two of ten that may count or not: the interval is that of the fewest and of the most.
    #[test]
    fn what_is_unknown_counts_either_way() {
        let found = Proportion::at_least(3, 2, 10);
        assert_eq!(found.share(), 0.3);
        assert_eq!(found.low, Proportion::new(3, 10).low);
        assert_eq!(found.high, Proportion::new(5, 10).high);
        assert_eq!(Proportion::at_least(3, 0, 10), Proportion::new(3, 10));
        assert_eq!(Proportion::at_least(0, 10, 10).high, 1.0);
    }
}
