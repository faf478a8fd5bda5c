//! What one setting yields: rates of the states, and the course of what is bound.

use super::Question;
use super::attachment::Attachments;
use physics::dynamics::docking::stream;
use physics::dynamics::exits::mean_and_error;
use physics::kinetics::bond::{Hold, Shaking, TOLERANCE};
use physics::kinetics::population::{Crowd, MOST_PAIRS, PairRates};
use physics::order::Order;
use physics::parallel;

/// Numbers of tiles and coverages of the table of yields, besides those asked for.
const TILES: [usize; 6] = [2, 4, 8, 16, 32, 50];
const COVERAGES: [f64; 5] = [0.05, 0.1, 0.2, 0.3, 0.5];
/// Points in time.
const TIMES: usize = 40;
/// ... over so many powers of ten before the end.
const DECADES: f64 = 3.0;
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

/// The rates of one kind of state; `None` for a trap that caught nothing, and for a state without
/// volume.
pub(super) fn state(
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

/// What a setting of some states' rates yields.
pub(super) fn outcome(
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
        let now = time * libm::pow(10f64, power);
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
    all.order_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
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
    let shares = parallel::map(0..runs, |run| {
        let numbers = rates.simulate(crowd, question.time, &mut stream(question.seed, run))?;
        Some(numbers[0] as f64 / pairs)
    });
    let shares: Option<Vec<f64>> = shares.into_iter().collect();
    let shares = shares.filter(|shares| shares.len() > 1)?;
    Some(mean_and_error(&shares))
}
