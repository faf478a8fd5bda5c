//! What is found out about a landscape: states, barriers and pathways, as plain values.

use crate::configuration::Configuration;

/// Whether a state is the wanted bond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateKind {
    /// The two target faces coincide.
    Bound,
    /// Any other minimum: a trap.
    Misbound,
}

/// A proportion found by sampling, with its 95 % Wilson interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proportion {
    pub count: usize,
    pub of: usize,
    pub low: f64,
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
            // Exactly the ends of [0, 1] there, which rounding would miss.
            low: if count == 0 { 0.0 } else { centre - half },
            high: if count == of { 1.0 } else { centre + half },
        }
    }

    pub fn share(&self) -> f64 {
        if self.of == 0 {
            0.0
        } else {
            self.count as f64 / self.of as f64
        }
    }
}

/// A local minimum of the energy over the free configurations.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub id: usize,
    pub kind: StateKind,
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
    pub repelling: usize,
    /// Energy (J) of uniformly magnetised blocks in this configuration, where `energy` is that of
    /// point dipoles.
    pub block_energy: Option<f64>,
    /// Share of far starts that overdamped motion takes into this state.
    pub capture: Option<Proportion>,
}

impl State {
    /// How much higher (J) point dipoles' energy is than that of the blocks they stand for.
    pub fn dipole_error(&self) -> Option<f64> {
        self.block_energy.map(|blocks| self.energy - blocks)
    }
}

/// One end of a barrier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    State(usize),
    /// Any configuration with the tiles far apart.
    Free,
}

/// A point of a pathway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathwayPoint {
    /// Length along the pathway in the metric of the configuration space (m).
    pub s: f64,
    pub configuration: Configuration,
    /// U (J).
    pub energy: f64,
    /// Signed clearance of the tiles (m).
    pub clearance: f64,
}

/// A continuous free motion, as points so close that U and the clearance between two of them are
/// as good as linear.
pub type Pathway = Vec<PathwayPoint>;

/// The barrier between two places: the least possible highest energy of a free path.
#[derive(Clone, Debug, PartialEq)]
pub struct Barrier {
    pub from: Place,
    pub to: Place,
    /// Highest energy on the best pathway found (J): an upper bound of the minimax energy.
    pub saddle_energy: f64,
    pub saddle: Configuration,
    /// Certified bounds of the saddle energy (J), where certified.
    pub lower: Option<f64>,
    pub upper: Option<f64>,
    /// Proved that there is no way at all; the saddle energy is then infinite.
    pub caged: bool,
    /// Energies (J) of the two ends; 0 for `Free`.
    pub from_energy: f64,
    pub to_energy: f64,
    /// Lowest and highest saddle energy (J) over repeated runs with other seeds.
    pub spread: Option<(f64, f64)>,
    pub pathway: Pathway,
}

impl Barrier {
    /// Saddle minus the energy of the start (J).
    pub fn forward(&self) -> f64 {
        self.saddle_energy - self.from_energy
    }

    /// Saddle minus the energy of the end (J).
    pub fn reverse(&self) -> f64 {
        self.saddle_energy - self.to_energy
    }
}
