//! The yield of a shaken table: from a design and a shaking to what is bound after a time.
//!
//! Attachment rates are counted in docking runs of shaken tiles ([`attachment`]); detachment rates
//! follow from them by detailed balance, `k_off = k_on / K`, with the constants K of
//! [`crate::kinetics::bond`]. Both are honest as far as kT is: contact that takes energy out of a
//! collision, which shaking does not give back, keeps no detailed balance, and drag decides how fast
//! tiles meet. Pairs go from trap to bond through free only.

pub mod attachment;

use crate::design::Design;
use crate::dynamics::docking::{DockingError, stream};
use crate::dynamics::exits::mean_and_error;
use crate::kinetics::bond::{Bond, BondError, Hold, LEAST_DEPTH, Shaking, TOLERANCE, traps};
use crate::kinetics::mixture::{self, Mixture};
use crate::kinetics::population::{Crowd, MOST_PAIRS, PairRates};
use crate::kinetics::rates::RatesError;
use crate::kinetics::well::NO_PLAY;
use crate::observer::Observer;
use crate::pipeline::{self, Settings};
use crate::units::si;
use attachment::{Attachments, Effort};
use rayon::prelude::*;

/// Numbers of tiles and coverages of the table of yields, besides those asked for.
const TILES: [usize; 6] = [2, 4, 8, 16, 32, 50];
const COVERAGES: [f64; 5] = [0.05, 0.1, 0.2, 0.3, 0.5];
/// Points in time.
const TIMES: usize = 40;
/// ... over so many powers of ten before the end.
const DECADES: f64 = 3.0;
/// Slots of a schedule of settings.
const SLOTS: usize = 8;
/// Pairs for which schedules are sought: ten states.
const MIXED_PAIRS: usize = 3;

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Effective energies kT (J) of the settings.
    pub kts: Vec<f64>,
    /// Share of the table that tiles cover.
    pub coverage: f64,
    /// Tiles, half of either kind.
    pub tiles: usize,
    /// How long the table is shaken (s).
    pub time: f64,
    /// Docking runs for each setting.
    pub effort: Effort,
    /// Runs of the exact simulation for each setting; 0 for none.
    pub simulations: usize,
    /// Of all random numbers.
    pub seed: u64,
}

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum YieldError {
    /// There is no bond.
    #[error(transparent)]
    Bond(#[from] BondError),
    /// Docking could not be simulated.
    #[error(transparent)]
    Docking(#[from] DockingError),
    /// The rates of overdamped motion could not be solved.
    #[error(transparent)]
    Rates(#[from] RatesError),
    /// At this kT (J) the bond of this energy (J) holds nothing.
    #[error(
        "at kT = {} the bond of {} is less than {LEAST_DEPTH} kT deep and holds nothing: choose a \
         --kt below {}", si(*.0, "J", 4), si(*.1, "J", 4), si(-.1 / LEAST_DEPTH, "J", 3)
    )]
    Hot(f64, f64),
    /// At this kT (J) the bond's well is narrower than contact is known.
    #[error(
        "at kT = {} tiles move by less than {} in the bond, which is closer than contact is known: \
         choose a larger --kt", si(*.0, "J", 4), si(NO_PLAY, "m", 2)
    )]
    Cold(f64),
    /// The bond's basin has no volume.
    #[error("the bond has no play at all: shaken tiles never find it, and nothing is yielded")]
    NoPlay,
    /// The mesh has no way into the bond, and contact does not prove that there is none.
    #[error(
        "no way into the bond was found, so that nothing is known of how fast tiles attach: count \
         them in docking runs (--rates docking)"
    )]
    Lost,
}

impl YieldError {
    /// Whether another kT may have an answer.
    fn is_of_one_kt(&self) -> bool {
        match self {
            Self::Hot(..) | Self::Cold(_) => true,
            Self::Rates(error) => matches!(error, RatesError::Joined(_) | RatesError::Cold(..)),
            _ => false,
        }
    }
}

/// One kind of state at one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct StateRates {
    /// `A` for the bond, `B` for the deepest trap.
    pub name: String,
    /// Attachments that were counted.
    pub attachments: usize,
    /// kappa (m^2/s): attachments a second for one partner a square metre.
    pub on: f64,
    /// Its 95 % interval.
    pub on_interval: [f64; 2],
    /// Detachments a second, by detailed balance.
    pub off: f64,
    /// The constant of association (m^2).
    pub constant: f64,
    /// Depth over kT.
    pub depth: f64,
    /// ln K at the coverage asked for.
    pub ln_k: f64,
}

/// What one setting yields.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// kT (J).
    pub kt: f64,
    /// The bond first, then the traps that caught anything.
    pub states: Vec<StateRates>,
    /// Rates of the pair.
    pub rates: PairRates,
    /// What the rates were counted in.
    pub attached: Attachments,
    /// Share of all possible pairs that are in the bond at the end.
    pub bound: f64,
    /// The same for the ends of the interval of the bond's attachment rate.
    pub interval: [f64; 2],
    /// Share that are in traps at the end.
    pub trapped: f64,
    /// Share in the bond by the difference equations; `None` where they take too many steps.
    pub smooth: Option<f64>,
    /// Share in the bond in equilibrium, where the forward equation tells.
    pub equilibrium: Option<f64>,
    /// Share in the bond in the exact simulation, over all runs and pairs, with the standard error.
    pub simulated: Option<[f64; 2]>,
    /// Mean times (s): from free to the bond, and out of the bond, of a pair on this table.
    pub mean_times: [f64; 2],
    /// Time (s), share in the bond, share in traps.
    pub course: Vec<[f64; 3]>,
    /// Tiles, coverage, share in the bond at the end.
    pub table: Vec<(usize, f64, f64)>,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Yields {
    /// Area (m^2) of the moving tile.
    pub tile_area: f64,
    /// The tiles and their table.
    pub crowd: Crowd,
    /// By kT, in the order asked for.
    pub outcomes: Vec<Outcome>,
    /// The kT (J) that have none, and why; in the order asked for.
    pub without: Vec<(f64, YieldError)>,
    /// Schedules of the settings, for this many tiles at most six; `None` for one setting.
    pub mixture: Option<(usize, Mixture)>,
}

impl Yields {
    /// What was found at one of the kT (J) asked for, or why there is no answer.
    pub fn at(&self, kt: f64) -> Result<&Outcome, Option<&YieldError>> {
        let found = self.outcomes.iter().find(|outcome| outcome.kt == kt);
        found.ok_or_else(|| {
            let mut without = self.without.iter();
            without.find(|(other, _)| *other == kt).map(|(_, why)| why)
        })
    }

    /// The setting that yields most.
    pub fn best(&self) -> &Outcome {
        let all = self.outcomes.iter();
        all.reduce(|best, next| if next.bound > best.bound { next } else { best })
            .expect("one setting at least is asked for")
    }
}

/// Answers a question about a design, at those kT that have an answer.
///
/// # Errors
/// See [`YieldError`]; what is of one kT only where no other is left.
pub fn yields(
    design: &Design,
    question: &Question,
    observer: &dyn Observer,
) -> Result<Yields, YieldError> {
    let analysis = pipeline::analyse(design, &Settings::without_proofs(question.seed), observer);
    let (problem, inventory) = (&analysis.problem, &analysis.inventory);
    let bond = Bond::new(problem, inventory)?;
    let hold = bond.hold();
    let refused = |kt: f64| match () {
        // Tiles that fast meet things a million times in a run, and nothing comes of it.
        () if !hold.holds_at(kt) => Some(YieldError::Hot(kt, hold.energy)),
        () if hold.is_too_cold(kt) => Some(YieldError::Cold(kt)),
        () => None,
    };
    let usable = question.kts.iter().copied();
    let usable = usable.filter(|kt| refused(*kt).is_none());
    let coldest = usable.fold(f64::INFINITY, f64::min);
    let traps = traps(problem, inventory, coldest);
    let holds: Vec<&Hold> = std::iter::once(bond.hold()).chain(&traps).collect();
    let tile_area = design.pair.moving.outline.area();
    let crowd = Crowd::new(question.tiles, question.coverage, tile_area);
    let at = |kt: f64| {
        if let Some(why) = refused(kt) {
            return Err(why);
        }
        let attached = attachment::attached(&analysis, &holds, kt, question)?;
        let shaking = Shaking {
            kt,
            coverage: question.coverage,
        };
        let states: Vec<StateRates> = holds
            .iter()
            .enumerate()
            .filter_map(|(kind, hold)| state(hold, kind, &attached, &shaking))
            .collect();
        if states
            .first()
            .is_none_or(|first| first.name != bond.hold().name)
        {
            return Err(YieldError::NoPlay);
        }
        Ok(outcome(kt, states, attached, &crowd, tile_area, question))
    };
    let (mut outcomes, mut without) = (Vec::new(), Vec::new());
    for (k, &kt) in question.kts.iter().enumerate() {
        observer.stage(
            question.effort.stage(),
            k as f64 / question.kts.len() as f64,
        );
        match at(kt) {
            Ok(outcome) => outcomes.push(outcome),
            Err(error) if error.is_of_one_kt() => without.push((kt, error)),
            Err(error) => return Err(error),
        }
    }
    if let (true, Some((_, error))) = (outcomes.is_empty(), without.first()) {
        return Err(error.clone());
    }
    let mixture = (outcomes.len() > 1).then(|| mixed(&outcomes, question, tile_area));
    Ok(Yields {
        tile_area,
        crowd,
        outcomes,
        without,
        mixture,
    })
}

/// The rates of one kind of state; `None` for a trap that caught nothing, and for a state without
/// volume.
fn state(
    hold: &Hold,
    kind: usize,
    attached: &Attachments,
    shaking: &Shaking,
) -> Option<StateRates> {
    let count = attached.counts[kind];
    let on = attached.rate(kind);
    if kind > 0 && (on == 0.0 || !hold.holds_at(shaking.kt)) {
        return None;
    }
    let docking = hold.docking(shaking, TOLERANCE);
    if docking.cost.is_infinite() {
        return None;
    }
    // K for one partner a square metre: all copies count, and no coverage does.
    let constant = hold.association(&docking);
    Some(StateRates {
        name: hold.name.clone(),
        attachments: count,
        on,
        on_interval: attached.interval(kind),
        off: on / constant,
        constant,
        depth: docking.depth,
        ln_k: docking.ln_k(1.0),
    })
}

fn outcome(
    kt: f64,
    states: Vec<StateRates>,
    attached: Attachments,
    crowd: &Crowd,
    tile_area: f64,
    question: &Question,
) -> Outcome {
    let on = states.iter().map(|state| state.on).collect();
    let rates = PairRates::through_free(on, states.iter().map(|state| state.off).collect());
    let time = question.time;
    let pairs = crowd.pairs() as f64;
    let share = |time: f64| shares(&rates, crowd, time);
    let [bound, trapped] = share(time);
    let bond = &states[0];
    // Where none attached, the rate may still be above 0.
    let at_end = |on: f64| {
        let mut other = rates.clone();
        (other.on[0], other.off[0]) = (on, on / bond.constant);
        shares(&other, crowd, time)[0]
    };
    let chain = rates.pair_chain(crowd.area / crowd.tiles[0].max(1) as f64);
    let course = (0..TIMES).map(|k| {
        let power = DECADES * (k as f64 / (TIMES - 1) as f64 - 1.0);
        let now = time * 10f64.powf(power);
        let [bound, trapped] = share(now);
        [now, bound, trapped]
    });
    let rows = with(&TILES, question.tiles).into_iter();
    let coverages = with(&COVERAGES, question.coverage);
    let rows = rows.flat_map(|tiles| coverages.iter().map(move |&coverage| (tiles, coverage)));
    let table = rows.map(|(tiles, coverage)| {
        let crowd = Crowd::new(tiles, coverage, tile_area);
        (tiles, coverage, shares(&rates, &crowd, time)[0])
    });
    let smooth = rates.difference_equations(crowd, time);
    Outcome {
        kt,
        bound,
        trapped,
        interval: bond.on_interval.map(at_end),
        smooth: smooth.map(|numbers| numbers[0] / pairs),
        equilibrium: rates.equilibrium(crowd),
        simulated: simulated(&rates, crowd, question),
        mean_times: [chain.mean_times(&[1])[0], chain.mean_times(&[0])[1]],
        course: course.collect(),
        table: table.collect(),
        rates,
        attached,
        states,
    }
}

/// A list with one more entry, ascending, without repeats.
fn with<T: Copy + PartialOrd>(list: &[T], more: T) -> Vec<T> {
    let mut all: Vec<T> = list
        .iter()
        .copied()
        .filter(|x| *x != more)
        .chain([more])
        .collect();
    all.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    all
}

/// Shares of all possible pairs in the bond and in traps: by the forward equation, or for more tiles
/// by the difference equations.
fn shares(rates: &PairRates, crowd: &Crowd, time: f64) -> [f64; 2] {
    let pairs = crowd.pairs() as f64;
    if crowd.pairs() <= MOST_PAIRS
        && let Some((bound, trapped)) = rates.forward_equation(crowd, time)
    {
        let mean: f64 = bound.iter().enumerate().map(|(k, p)| k as f64 * p).sum();
        return [mean / pairs, trapped / pairs];
    }
    match rates.difference_equations(crowd, time) {
        Some(numbers) => [numbers[0] / pairs, numbers[1..].iter().sum::<f64>() / pairs],
        None => [f64::NAN; 2],
    }
}

/// Mean share in the bond over runs of the exact simulation, and its standard error.
fn simulated(rates: &PairRates, crowd: &Crowd, question: &Question) -> Option<[f64; 2]> {
    let runs = question.simulations;
    let pairs = crowd.pairs() as f64;
    let shares: Option<Vec<f64>> = (0..runs)
        .into_par_iter()
        .map(|run| {
            let numbers = rates.simulate(crowd, question.time, &mut stream(question.seed, run))?;
            Some(numbers[0] as f64 / pairs)
        })
        .collect();
    let shares = shares.filter(|shares| shares.len() > 1)?;
    Some(mean_and_error(&shares))
}

/// The best schedule of the settings, for as many tiles as asked for but at most six.
fn mixed(outcomes: &[Outcome], question: &Question, tile_area: f64) -> (usize, Mixture) {
    let tiles = question.tiles.min(2 * MIXED_PAIRS);
    let crowd = Crowd::new(tiles, question.coverage, tile_area);
    // The same states for all: every setting has a kind of trapped pairs, if a fleeting one.
    let chains: Vec<_> = outcomes
        .iter()
        .map(|outcome| outcome.rates.with_traps())
        .collect();
    let chains: Vec<_> = chains
        .iter()
        .map(|rates| rates.crowd_chain(&crowd))
        .collect();
    let pairs = crowd.pairs() as f64;
    let values: Vec<f64> = chains[0]
        .0
        .iter()
        .map(|state| state[0] as f64 / pairs)
        .collect();
    let chains: Vec<_> = chains.into_iter().map(|(_, chain)| chain).collect();
    (
        tiles,
        mixture::schedule(&chains, &values, question.time, SLOTS),
    )
}
