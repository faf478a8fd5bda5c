//! Compares designs: an analysis of each, summarised in a dozen figures.
//!
//! [`assess`] analyses a design and keeps an [`Assessment`]; a [`Quantity`] reads one figure of it,
//! with its bounds; [`ranking`] sorts designs by a figure and states which order is proved.
//!
//! - The *depth* of a state is minus its energy.
//! - *Unbinding* leads from the bond to `free`, *binding* the other way, over the same saddle. The
//!   barrier of binding is the saddle's energy above that of tiles far apart, which is 0; it is 0
//!   if the saddle lies below that. Bounds are those of the saddle, shifted in the same way.
//! - *Selectivity* is the depth of the bond over that of the deepest trap.
//! - *Unlisted* is the largest possible depth of a state that is not listed: it is proved that
//!   below this depth no other state has an escape barrier above half a hundredth of the bond.
//! - *Robust* is the share of pairs made with the stated errors that work ([`crate::tolerance`]).
//! - The *capture range* is defined in [`capture_range`].

pub mod capture_range;
pub mod quantity;
pub mod ranking;
mod request;

use serde::{Deserialize, Serialize};

use crate::design::{Design, Drawing};
use crate::pipeline::{self, Analysis};
use crate::tolerance;
use physics::dynamics::check::BarrierCheck;
use physics::landscape::minimum::Known;
use physics::landscape::{Barrier, Completeness, Proportion, SaddleBounds, State, StateKind};
use physics::observer::Observer;
use physics::potential::MagnetModel;
use physics::units::share_with;

pub use capture_range::CaptureRange;
pub use quantity::{Estimate, Quantity};
pub use request::{Request, Thoroughness};

/// The compared figures of a design. Poses are x, y (m) and theta (rad), energies in J.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Assessment {
    /// The design's name.
    pub name: String,
    /// SHA-256 of the design file's bytes.
    pub sha256: String,
    /// The drawings that the design refers to.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drawings: Vec<Drawing>,
    /// The magnet model, as in design files.
    pub model: String,
    /// What the magnets are modelled as: dipoles, blocks, discs.
    #[serde(default)]
    pub magnets: String,
    /// The seed of all random numbers.
    pub seed: u64,
    /// Energy with the target faces coinciding (J).
    #[serde(rename = "target_energy_J")]
    pub target_energy: f64,
    /// `None` if the bond does not hold.
    pub bond: Option<Bond>,
    /// Number of kinds of trap, without symmetric copies.
    pub trap_kinds: usize,
    /// The trap of lowest energy; `None` if there are no traps.
    pub deepest_trap: Option<Trap>,
    /// It is proved that below this energy (J) no other state has an escape barrier above a share
    /// of the bond's depth; `None` if nothing is proved.
    #[serde(
        default,
        rename = "unlisted_above_J",
        skip_serializing_if = "Option::is_none"
    )]
    pub unlisted_above: Option<f64>,
    /// Number of far starts.
    pub far_starts: usize,
    /// Number of far starts that end in the bond.
    pub captured: usize,
    /// Number of far starts that end in no state.
    pub uncaptured: usize,
    /// How many of the pairs made with the stated errors work; `None` if no errors are stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robust: Option<Proportion>,
    /// Number of barriers checked by moving tiles; `None` without the check.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub barriers_checked: Option<usize>,
    /// The contradicted barriers, one text for each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contradictions: Vec<String>,
    /// Barriers without certified bounds that the check shows to be estimated too high.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub overestimates: Vec<String>,
}

/// The bound state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bond {
    /// x, y (m) and theta (rad).
    pub pose: [f64; 3],
    /// U (J), below 0.
    #[serde(rename = "energy_J")]
    pub energy: f64,
    /// To `free`.
    pub way_out: WayOut,
    /// `None` if aligned tiles do not bind.
    pub capture_range: Option<CaptureRange>,
}

/// A trap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trap {
    /// x, y (m) and theta (rad).
    pub pose: [f64; 3],
    /// U (J).
    #[serde(rename = "energy_J")]
    pub energy: f64,
    /// To the nearest lower state or to `free`.
    pub escape: WayOut,
}

/// The best way out of a state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WayOut {
    /// Highest energy on the path (J); `None` if no path was found.
    #[serde(rename = "saddle_energy_J")]
    pub saddle: Option<f64>,
    /// Proved bounds of the lowest possible maximum energy.
    #[serde(flatten)]
    pub bounds: SaddleBounds,
}

impl WayOut {
    fn new(barrier: Option<&Barrier>) -> Self {
        barrier.map_or_else(Self::default, |barrier| Self {
            saddle: Some(barrier.saddle_energy).filter(|saddle| saddle.is_finite()),
            bounds: barrier.bounds,
        })
    }

    /// The climb (J) above `energy`, never negative.
    pub fn climb(&self, energy: f64) -> Option<Estimate> {
        if self.bounds.caged {
            return Some(Estimate {
                value: f64::INFINITY,
                low: Some(f64::INFINITY),
                high: None,
            });
        }
        let SaddleBounds { lower, upper, .. } = self.bounds.above(energy);
        self.saddle.map(|saddle| Estimate {
            value: (saddle - energy).max(0.0),
            low: lower,
            high: upper,
        })
    }
}

/// A cell of blocks costs as much as about this many cells of dipoles.
const CELLS_OF_BLOCKS: usize = 30;

/// Analyses a design and keeps the compared figures.
pub fn assess(
    design: &Design,
    thoroughness: &Thoroughness,
    seed: u64,
    observer: &dyn Observer,
) -> Assessment {
    let mut asked = thoroughness.analysis(seed);
    if design.interaction.model == MagnetModel::Cuboid {
        asked.complete_cells /= CELLS_OF_BLOCKS;
    }
    let analysis = pipeline::analyse(design, &asked, observer);
    let states = (&*analysis.problem, &analysis.catalogue);
    Assessment {
        robust: tolerance::robust(design, states, &thoroughness.making, seed),
        ..Assessment::new(design, &analysis)
    }
}

/// Assesses designs one after another.
pub fn assess_all<'a>(
    designs: impl IntoIterator<Item = &'a Design>,
    request: &Request,
    observer: &dyn Observer,
) -> Vec<Assessment> {
    let designs: Vec<&Design> = designs.into_iter().collect();
    let count = designs.len();
    let assessed = designs.into_iter().enumerate().map(|(done, design)| {
        let part = Part {
            observer,
            done,
            count,
        };
        assess(design, &request.thoroughness, request.seed, &part)
    });
    assessed.collect()
}

/// The progress of one design among several.
struct Part<'a> {
    observer: &'a dyn Observer,
    done: usize,
    count: usize,
}

impl Observer for Part<'_> {
    fn stage(&self, name: &'static str, share: f64) {
        let share = (self.done as f64 + share) / self.count as f64;
        self.observer.stage(name, share);
    }
}

impl Assessment {
    /// Whether there is a bond and no trap.
    pub fn has_no_trap(&self) -> bool {
        self.bond.is_some() && self.deepest_trap.is_none()
    }

    /// The numbers of barriers that moving tiles checked, contradicted, and showed to be estimated
    /// too high; `None` without the check.
    pub fn checks(&self) -> Option<[usize; 3]> {
        let checked = self.barriers_checked?;
        Some([checked, self.contradictions.len(), self.overestimates.len()])
    }

    /// Whether it is proved that no way leads out of the bond.
    pub fn is_caged(&self) -> bool {
        let bond = self.bond.as_ref();
        bond.is_some_and(|bond| bond.way_out.bounds.caged)
    }

    /// Why tiles of this design do not reach the bond, if they do not: there is no bond, no way
    /// leads in, or no far start ended there. The number, from 3 for the worst to 1, is the
    /// severity.
    pub fn obstacle(&self) -> Option<(u8, String)> {
        if self.bond.is_none() {
            return Some((3, "the bond does not hold".to_owned()));
        }
        if self.is_caged() {
            let proved = "proved: no path leads from far apart into the bond";
            return Some((2, proved.to_owned()));
        }
        let none_came_in = self.far_starts > 0 && self.captured == 0;
        none_came_in.then(|| {
            let most = share_with(Proportion::new(0, self.far_starts).high, 1);
            let starts = self.far_starts;
            (
                1,
                format!("none of {starts} far starts reached the bond (at most {most} do)"),
            )
        })
    }

    /// The compared figures of an analysed design; also computes the capture range.
    pub fn new(design: &Design, analysis: &Analysis) -> Self {
        let catalogue = &analysis.catalogue;
        let captured = |state: &State| state.capture.map_or(0, |capture| capture.count);
        let bound = catalogue.first(StateKind::Bond);
        Self {
            name: design.name.clone(),
            sha256: design.sha256.clone(),
            drawings: design.drawings.clone(),
            model: design.interaction.model.name().to_owned(),
            magnets: design.interaction.model.plural(&design.pair).to_owned(),
            seed: analysis.request.seed,
            target_energy: analysis.bound.1,
            bond: bound.map(|state| bond(analysis, state)),
            trap_kinds: catalogue.kinds().filter(|kind| !kind.is_bond()).count(),
            deepest_trap: catalogue.first(StateKind::Trap).map(|state| Trap {
                pose: state.configuration.to_array(),
                energy: state.energy,
                escape: WayOut::new(analysis.escape(state.id).as_ref()),
            }),
            unlisted_above: analysis
                .completeness
                .as_ref()
                .ok()
                .map(Completeness::lowest),
            far_starts: analysis.uncaptured.gone.of,
            captured: catalogue
                .states
                .iter()
                .filter(|state| state.kind == StateKind::Bond)
                .map(captured)
                .sum(),
            uncaptured: analysis.uncaptured.all().count,
            robust: None,
            barriers_checked: analysis.dynamics.as_ref().map(Vec::len),
            contradictions: analysis
                .contradicted()
                .map(BarrierCheck::describe)
                .collect(),
            overestimates: analysis
                .overestimated()
                .map(BarrierCheck::describe)
                .collect(),
        }
    }
}

fn bond(analysis: &Analysis, state: &State) -> Bond {
    let q = &state.configuration;
    let states = analysis.catalogue.states.iter();
    let known = Known::minima(states.map(|state| state.configuration));
    Bond {
        pose: q.to_array(),
        energy: state.energy,
        way_out: WayOut::new(analysis.catalogue.way_out_of_the_bond()),
        capture_range: capture_range::find(&analysis.problem, known, q, state.energy),
    }
}
