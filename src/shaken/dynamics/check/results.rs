//! The settings and the results of checks.

use crate::dynamics::Motion;
use landscape::Place;
use tiles::units::si;

/// The settings of the check.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckSettings {
    /// The seed of all random numbers.
    pub seed: u64,
    /// Trajectories below each barrier.
    pub runs: usize,
    /// Trajectories above each barrier.
    pub controls: usize,
    /// Share of a barrier by which its saddle energy may be too high if it is not certified.
    pub settled: f64,
}

impl Default for CheckSettings {
    fn default() -> Self {
        Self {
            seed: 1,
            runs: 1000,
            controls: 100,
            settled: 0.005,
        }
    }
}

/// Trajectories with less total energy than a barrier.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Below {
    /// Number of trajectories.
    pub runs: usize,
    /// Number of crossings.
    pub crossed: usize,
    /// Number of further trajectories that the integration error raised above the barrier.
    pub spoilt: usize,
    /// The start of one that crossed.
    pub example: Option<Motion>,
}

/// The end of a trajectory from one side of a saddle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Side {
    /// `None` for no reported state, and if the integration error raised the tile above the
    /// ceiling.
    pub ended: Option<Place>,
    /// The relation of the end to the pathway.
    pub verdict: SideVerdict,
}

/// The relation of a trajectory's end to the pathway.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SideVerdict {
    /// At the pathway's end on this side, or in a state on the way there.
    OnThePathway,
    /// In another place. The saddle is not lower from there, so nothing is refuted.
    Elsewhere,
    /// At the pathway's other end, behind the barrier. (States on the way there do not count: there
    /// may be a lower path to them.)
    Opposite,
}

/// The check of one barrier by moving tiles.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct BarrierCheck {
    /// The state that the pathway leaves.
    pub from: Place,
    /// The state that it leads to, or free tiles.
    pub to: Place,
    /// The energy (J) that trajectories stayed below: the barrier's certified lower bound, or the
    /// saddle energy less its possible error. Infinite if the state is proved to be caged.
    pub ceiling: f64,
    /// Whether the ceiling is a certified bound, not an estimate.
    pub certified: bool,
    /// Trajectories with less energy than the ceiling.
    pub below: Below,
    /// Number of trajectories that crossed with 0.1 to 2 barriers more energy than the pathway
    /// needs, and number of trajectories.
    pub above: (usize, usize),
    /// The ends from both sides of the saddle. `None` if not tested: behind a saddle to `free`,
    /// which may be where the tiles separate, with no slope behind it.
    pub sides: [Option<Side>; 2],
    /// Smallest tried kick energy (J) that expelled the tile along the pathway; `None` if none did,
    /// up to eight times the barrier.
    pub kick: Option<f64>,
    /// Lower bound (J) of the kick energy: the ceiling, relative to the start.
    pub climb: f64,
    /// Number of steps of all its trajectories.
    pub steps: usize,
}

impl BarrierCheck {
    /// Whether trajectories below the barrier crossed it.
    pub fn is_crossed(&self) -> bool {
        self.below.crossed > 0
    }

    /// Whether a kick with less energy than the barrier expelled the tile.
    pub fn is_kicked_over(&self) -> bool {
        self.kick.is_some_and(|kick| kick < self.climb)
    }

    /// Whether a trajectory from one side of the saddle ended on the other.
    pub fn is_swapped(&self) -> bool {
        let opposite = |side: &Side| side.verdict == SideVerdict::Opposite;
        self.sides.iter().flatten().any(opposite)
    }

    /// Whether any of these is so.
    pub fn is_refuted(&self) -> bool {
        self.is_crossed() || self.is_kicked_over() || self.is_swapped()
    }

    /// Whether a proved bound is refuted: either the proof or the simulation is wrong.
    pub fn is_contradicted(&self) -> bool {
        self.certified && self.is_refuted()
    }

    /// Whether an unproved estimate is refuted: a lower path was found.
    pub fn is_overestimated(&self) -> bool {
        !self.certified && self.is_refuted()
    }

    /// Describes what refutes the barrier, with emphasis if a proof is contradicted.
    pub fn describe(&self) -> String {
        let name = |place| match place {
            Place::State(id) => format!("state {id}"),
            Place::Free => "free".to_owned(),
        };
        let ceiling = si(self.ceiling, "J", 4);
        let claim = match self.certified {
            _ if self.ceiling.is_infinite() => "proved to have no path over it".to_owned(),
            true => format!("certified to be above {ceiling}"),
            false => format!("estimated to be above {ceiling}"),
        };
        let mut found = Vec::new();
        if self.is_crossed() {
            let Below { crossed, runs, .. } = self.below;
            found.push(format!("{crossed} of {runs} trajectories below it crossed"));
        }
        if let Some(kick) = self.kick.filter(|_| self.is_kicked_over()) {
            let [kick, climb] = [kick, self.climb].map(|energy| si(energy, "J", 4));
            found.push(format!(
                "a kick of {kick} threw the tile over it, less than {climb}"
            ));
        }
        if self.is_swapped() {
            found.push("from beside the saddle a tile ended on the other side".to_owned());
        }
        let verdict = if self.certified {
            "CONTRADICTION"
        } else {
            "estimate too high"
        };
        format!(
            "{verdict}: the barrier from {} to {}, {claim}: {}",
            name(self.from),
            name(self.to),
            found.join("; ")
        )
    }
}
