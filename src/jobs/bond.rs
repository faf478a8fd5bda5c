//! How strongly the bond and the traps hold shaken tiles.

use crate::design::Design;
use crate::pipeline;
use crate::request::{self, options};
use physics::configuration::Configuration;
use physics::kinetics::bond::{Binding, BondError, Hold, Shaking, TOLERANCE, traps};
use physics::landscape::Catalogue;
use physics::observer::Observer;
use physics::parallel;
use physics::problem::Problem;

/// Ratios to the requested kT at which the strength of states is plotted.
const SHAKINGS: [f64; 9] = [0.4, 0.5, 0.63, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5];
/// Relative tolerance of plotted integrals.
const ROUGH: f64 = 1e-2;

options! {
    /// The options.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Request {
        /// Effective energy kT of shaking (J)
        pub kt: f64 = value("E_J", request::shaking),

        /// Fraction of the table covered by tiles
        pub coverage: f64 = value("F", request::fraction),

        /// Random seed; the same seed gives the same results
        pub seed: u64 = value("N", request::seed).or(pipeline::Request::default().seed),
    }
}

impl Request {
    /// Surveys the states of a design and integrates over the bond and the traps; also at other
    /// kT, if they are to be plotted.
    ///
    /// # Errors
    /// If there is no bond.
    pub fn run(
        &self,
        design: &Design,
        is_pictured: bool,
        observer: &dyn Observer,
    ) -> Result<Held, BondError> {
        let settings = pipeline::Request::without_proofs(self.seed);
        let found = pipeline::analyse(design, &settings, observer);
        let Self { kt, coverage, .. } = *self;
        let shaking = Shaking { kt, coverage };
        held(
            design,
            (&found.problem, &found.catalogue),
            shaking,
            is_pictured,
        )
    }
}

/// The bond and the traps at one kT.
#[derive(Clone, Debug)]
pub struct Held {
    /// The request.
    pub shaking: Shaking,
    /// Area (m^2) of the moving tile.
    pub tile_area: f64,
    /// The bond first, then the traps, deepest first.
    pub states: Vec<HeldState>,
    /// Number of kinds of traps too shallow to hold a tile.
    pub shallow: usize,
    /// The range of kT (J) in which two bonds closed by one docking hold a tile and one alone does
    /// not.
    pub window: [Option<f64>; 2],
    /// Whether the bond has play, but less than the contact tolerance.
    pub is_too_cold: bool,
    /// The strength of the states at other kT (J); empty if not requested.
    pub over_kt: Vec<(f64, Vec<Binding>)>,
}

/// A kind of states at one kT.
#[derive(Clone, Debug)]
pub struct HeldState {
    /// Its letter: `A` for the bond, `B` for the deepest trap.
    pub name: String,
    /// The configuration of its first state.
    pub configuration: Configuration,
    /// U there (J).
    pub energy: f64,
    /// The number of its symmetric copies.
    pub copies: usize,
    /// The number of copies that arise from rotations of the moving tile alone.
    pub moving_copies: usize,
    /// Its basin contains all configurations that can be reached from it below this energy (J), ...
    pub level: f64,
    /// ... or the part of it that was examined.
    pub is_cut: bool,
    /// Its binding strength.
    pub docking: Binding,
    /// The same with only the part of the basin below half its depth.
    pub inner: Binding,
    /// The same by the closed form of corner wells, if there is one.
    pub closed: Option<Binding>,
}

impl HeldState {
    fn new(problem: &Problem, hold: &Hold, shaking: &Shaking) -> Self {
        let basin = &hold.well;
        Self {
            name: hold.name.clone(),
            configuration: hold.configuration,
            energy: hold.energy,
            copies: hold.copies,
            moving_copies: hold.moving_copies,
            level: basin.level,
            is_cut: basin.is_cut,
            docking: hold.docking(shaking, TOLERANCE),
            inner: hold.docking_below(shaking, hold.energy / 2.0, TOLERANCE),
            closed: hold.closed_form(problem, shaking),
        }
    }

    /// The error of the closed form, if both are known.
    pub fn closed_error(&self) -> Option<f64> {
        let volume = self.docking.volume.value;
        let closed = self.closed.filter(|_| volume > 0.0)?;
        Some(closed.volume.value / volume - 1.0)
    }
}

/// Integrates over the bond and the traps of a catalogue; also at other kT, if they are to be
/// plotted.
///
/// # Errors
/// If there is no bond.
fn held(
    design: &Design,
    (problem, catalogue): (&Problem, &Catalogue),
    shaking: Shaking,
    is_pictured: bool,
) -> Result<Held, BondError> {
    let bond = Hold::bond(problem, catalogue)?;
    let traps = traps(problem, catalogue, shaking.kt);
    let holds: Vec<&Hold> = std::iter::once(&bond).chain(&traps).collect();
    let at = |share: &f64| {
        let kt = share * shaking.kt;
        let shaking = Shaking { kt, ..shaking };
        let dockings = holds.iter().map(|hold| hold.docking(&shaking, ROUGH));
        (kt, dockings.collect())
    };
    Ok(Held {
        shaking,
        tile_area: design.pair.moving.outline.area(),
        shallow: catalogue.kinds().count() - holds.len(),
        states: holds
            .iter()
            .map(|hold| HeldState::new(problem, hold, &shaking))
            .collect(),
        window: bond.window(shaking.coverage),
        is_too_cold: bond.is_too_cold(shaking.kt),
        over_kt: match is_pictured {
            true => parallel::map(&SHAKINGS[..], at),
            false => Vec::new(),
        },
    })
}
