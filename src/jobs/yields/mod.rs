//! The yield of a shaken table: how many pairs are bound after a given time.
//!
//! Attachment rates are counted in docking runs of shaken tiles ([`attachment`]); detachment rates
//! follow from them by detailed balance, `k_off = k_on / K`, with the constants K of
//! [`physics::kinetics::bond`]. Both are valid only if the table has a temperature: contact that
//! dissipates energy, which shaking does not return, violates detailed balance, and drag determines
//! how fast tiles meet. The table's rim and the other tiles take room: see
//! [`Crowd`]. Pairs go from trap to bond only through free.
//!
//! Each tile binds one partner at most, except for equal tiles with two binding faces: beside the pairs,
//! their chains and rings are simulated ([`physics::kinetics::population::rows`]).

pub mod attachment;
mod outcome;
mod rows;
mod schedule;

use crate::design::Design;
use crate::docking;
use crate::memory;
use crate::pipeline;
use crate::request::{self, Unanswered, options};
use attachment::AttachmentOptions;
pub use attachment::RateSource;
pub use outcome::{KindRates, Yield};
use outcome::{outcome, state};
use physics::dynamics::docking::{DockingError, MOST_REPEATS};
use physics::kinetics::bond::volume::NO_PLAY;
use physics::kinetics::bond::{BondError, Hold, LEAST_DEPTH, Shaking, traps};
use physics::kinetics::population::Crowd;
use physics::kinetics::population::mixture::Mixture;
use physics::kinetics::population::rows::Joints;
use physics::kinetics::rates::RatesError;
use physics::observer::Observer;
use physics::units::{plain, si};
pub use rows::{Chains, Count, Mean};

/// Largest number of settings.
const MOST_SETTINGS: usize = 20;
/// Largest number of tiles.
const MOST_TILES: usize = 10_000;

options! {
    /// The options.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Request {
        /// Number of tiles on the table, half of each kind unless both are one
        pub tiles: usize = value("N", tiles),

        /// How long the table is shaken (s)
        pub time: f64 = value("S", request::time),

        /// Effective energy kT of shaking (J); several: find the best and a schedule
        pub kts: Vec<f64> = value("E_J[,E_J...]", request::shaking).named("kt").list().required(),

        /// Fraction of the table covered by tiles
        pub coverage: f64 = value("F", request::fraction).or(0.3),

        /// Docking runs for each kT, or another source of attachment rates
        pub method: AttachmentOptions = group(),

        /// Runs of the exact simulation that checks the result; 0: none
        pub simulations: usize = value("N", request::runs_or_none).or(1000),

        /// Random seed; the same seed gives the same results
        pub seed: u64 = value("N", request::seed).or(1),
    }
}

impl Request {
    /// Checks that the meshes, if there are any, fit into memory beside a number of threads.
    ///
    /// # Errors
    /// See [`memory::check_meshes`].
    pub fn check_memory(&self, threads: usize) -> Result<(), String> {
        match self.method.source {
            // The bond, a few traps and free tiles.
            RateSource::Overdamped => memory::check_meshes(5, threads),
            RateSource::Docking => Ok(()),
        }
    }
}

/// About how long (s on one core) the docking runs at all kT take at most; `None` if that are seconds.
///
/// # Errors
/// As [`yields`].
pub fn expected(design: &Design, request: &Request) -> Result<Option<f64>, YieldError> {
    let (effort, kts) = (&request.method, &request.kts);
    let Some(hottest) = kts.iter().copied().reduce(f64::max) else {
        return Ok(None);
    };
    if effort.source != RateSource::Docking {
        return Ok(None);
    }
    let runs = effort.runs_at(hottest, request.seed);
    let one = docking::expected(&design.problem(), &runs)?;
    let repeats = match effort.attachments {
        0 => 1,
        _ => MOST_REPEATS,
    };
    Ok(one.map(|one| one * (repeats * kts.len()) as f64))
}

/// A number of tiles, half of each kind.
fn tiles(text: &str) -> Result<usize, String> {
    match request::count(text)? {
        count @ 2..=MOST_TILES if count % 2 == 0 => Ok(count),
        _ => Err(format!(
            "an even number of tiles from 2 to {MOST_TILES} is needed"
        )),
    }
}

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum YieldError {
    /// There are too many settings.
    #[error("kt: {0} energies; at most {MOST_SETTINGS} are compared")]
    Many(usize),
    /// There is no bond.
    #[error(transparent)]
    Bond(#[from] BondError),
    /// Docking could not be simulated.
    #[error(transparent)]
    Docking(#[from] DockingError),
    /// The rates of overdamped motion could not be solved.
    #[error(transparent)]
    Rates(#[from] RatesError),
    /// At this kT (J) the bond of this energy (J) holds no tile.
    #[error(
        "at kT = {} the bond of {} is less than {LEAST_DEPTH} kT deep and does not hold: choose a \
         --kt below {}", si(*.0, "J", 4), si(*.1, "J", 4), si(-.1 / LEAST_DEPTH, "J", 3)
    )]
    Hot(f64, f64),
    /// At this kT (J) the bond's well is narrower than the contact tolerance.
    #[error(
        "at kT = {} tiles move by less than {} in the bond, which is below the contact tolerance: \
         choose a larger --kt", si(*.0, "J", 4), si(NO_PLAY, "m", 2)
    )]
    Cold(f64),
    /// The table of this area (m^2) is too small.
    #[error(
        "a bound pair has no room on a square table of {} m2: use more tiles, or a smaller --coverage",
        plain(*.0, 3)
    )]
    NoRoom(f64),
    /// The bond's basin has no volume.
    #[error("the bond has no clearance at all: shaken tiles never find it, and the yield is 0")]
    NoPlay,
    /// The mesh has no path into the bond, and contact does not prove that there is none.
    #[error(
        "no path into the bond was found, so attachment rates are unknown: count them in docking \
         runs (--rates docking)"
    )]
    Lost,
}

impl Unanswered for YieldError {
    fn is_of_the_question(&self) -> bool {
        match self {
            Self::Many(_)
            | Self::Docking(_)
            | Self::Hot(..)
            | Self::Cold(_)
            | Self::Lost
            | Self::NoRoom(_) => true,
            Self::Rates(error) => error.is_of_the_question(),
            Self::Bond(_) | Self::NoPlay => false,
        }
    }
}

impl YieldError {
    /// Whether another kT may have a result.
    fn is_of_one_kt(&self) -> bool {
        match self {
            Self::Hot(..) | Self::Cold(_) => true,
            Self::Rates(error) => matches!(error, RatesError::Joined(_) | RatesError::Cold(..)),
            Self::Docking(error) => matches!(error, DockingError::NeverApart(_)),
            _ => false,
        }
    }
}

/// The result.
#[derive(Clone, Debug, PartialEq)]
pub struct Yields {
    /// Area (m^2) of the moving tile.
    pub tile_area: f64,
    /// The tiles and their table.
    pub crowd: Crowd,
    /// The outcomes by kT, in the requested order.
    pub outcomes: Vec<Yield>,
    /// The kT (J) without an outcome, and why; in the requested order.
    pub without: Vec<(f64, YieldError)>,
    /// The best schedule of the settings, and the number of tiles it is for (at most six); `None`
    /// for one setting.
    pub mixture: Option<(usize, Mixture)>,
}

impl Yields {
    /// The outcome at one of the requested kT (J), or why there is none.
    pub fn at(&self, kt: f64) -> Result<&Yield, Option<&YieldError>> {
        let found = self.outcomes.iter().find(|outcome| outcome.kt == kt);
        found.ok_or_else(|| {
            let mut without = self.without.iter();
            without.find(|(other, _)| *other == kt).map(|(_, why)| why)
        })
    }

    /// The setting that yields most.
    pub fn best(&self) -> &Yield {
        let all = self.outcomes.iter();
        all.reduce(|best, next| if next.bound > best.bound { next } else { best })
            .expect("there is at least one setting")
    }
}

/// Computes the yield of a design at all kT that have a result.
///
/// # Errors
/// See [`YieldError`]; errors of a single kT only if no other kT has a result.
pub fn yields(
    design: &Design,
    request: &Request,
    observer: &dyn Observer,
) -> Result<Yields, YieldError> {
    let count = request.kts.len();
    if count > MOST_SETTINGS {
        return Err(YieldError::Many(count));
    }
    let design = &design.centred();
    let analysis = pipeline::analyse(
        design,
        &pipeline::Request::without_proofs(request.seed),
        observer,
    );
    let (problem, catalogue) = (&analysis.problem, &analysis.catalogue);
    let bond = Hold::bond(problem, catalogue)?;
    let refused = |kt: f64| match () {
        // Such fast tiles collide a million times in a run without any effect.
        () if !bond.holds_at(kt) => Some(YieldError::Hot(kt, bond.energy)),
        () if bond.is_too_cold(kt) => Some(YieldError::Cold(kt)),
        () => None,
    };
    let usable = request.kts.iter().copied();
    let usable = usable.filter(|kt| refused(*kt).is_none());
    let coldest = usable.fold(f64::INFINITY, f64::min);
    let traps = traps(problem, catalogue, coldest);
    let holds: Vec<&Hold> = std::iter::once(&bond).chain(&traps).collect();
    let pair = &*design.pair;
    let tile_area = pair.moving.outline.area();
    let crowd = Crowd::new(
        request.tiles,
        request.coverage,
        pair,
        problem.exchange.is_some(),
    );
    if crowd.area.is_infinite() {
        return Err(YieldError::NoRoom(crowd.table));
    }
    let joints = Joints::of(problem);
    let at = |kt: f64| {
        if let Some(why) = refused(kt) {
            return Err(why);
        }
        let attached = attachment::attached(&analysis, &holds, kt, request)?;
        let shaking = Shaking {
            kt,
            coverage: request.coverage,
        };
        let states: Vec<KindRates> = holds
            .iter()
            .enumerate()
            .filter_map(|(kind, hold)| state(hold, kind, &attached, &shaking))
            .collect();
        if states.first().is_none_or(|first| first.name != bond.name) {
            return Err(YieldError::NoPlay);
        }
        let joints = joints.as_ref().map(|joints| (joints, &bond));
        Ok(outcome(
            kt,
            states,
            attached,
            (&crowd, pair),
            joints,
            request,
        ))
    };
    let (mut outcomes, mut without) = (Vec::new(), Vec::new());
    for (k, &kt) in request.kts.iter().enumerate() {
        observer.stage(request.method.stage(), k as f64 / request.kts.len() as f64);
        match at(kt) {
            Ok(outcome) => outcomes.push(outcome),
            Err(error) if error.is_of_one_kt() => without.push((kt, error)),
            Err(error) => return Err(error),
        }
    }
    if let (true, Some((_, error))) = (outcomes.is_empty(), without.first()) {
        return Err(error.clone());
    }
    let mixture = (outcomes.len() > 1).then(|| schedule::best(&outcomes, &holds, request, &crowd));
    Ok(Yields {
        tile_area,
        crowd,
        outcomes,
        without,
        mixture,
    })
}
