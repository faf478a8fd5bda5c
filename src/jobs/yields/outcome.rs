//! The result of one setting: rates of the states, and the number of bound pairs over time.

use super::Request;
use super::attachment::Attachments;
use super::rows::{Chains, rows};
use physics::dynamics::docking::stream;
use physics::dynamics::exits::mean_and_error;
use physics::kinetics::bond::{Hold, Shaking, TOLERANCE};
use physics::kinetics::population::rows::Joints;
use physics::kinetics::population::{Crowd, MOST_STATES, PairRates, Shares};
use physics::order::Order;
use physics::parallel;
use physics::tile::Pair;

/// Numbers of tiles and coverages in the table of yields, besides the requested ones.
const TILES: [usize; 6] = [2, 4, 8, 16, 32, 50];
const COVERAGES: [f64; 5] = [0.05, 0.1, 0.2, 0.3, 0.5];
/// Points in time.
const TIMES: usize = 40;
/// ... over this many powers of ten before the end.
const DECADES: f64 = 3.0;
/// Largest number of states of a crowd in the table of yields for which all probabilities are
/// computed; the requested crowd can have more, [`MOST_STATES`].
const MOST_IN_TABLE: usize = 600;

/// One kind of state at one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct KindRates {
    /// `A` for the bond, `B` for the deepest trap.
    pub name: String,
    /// Its index among all kinds of states: 0 for the bond.
    pub kind: usize,
    /// Number of counted attachments.
    pub attachments: usize,
    /// kappa (m^2/s): attachments per second for one partner per square metre.
    pub on: f64,
    /// Its 95 % interval.
    pub on_interval: [f64; 2],
    /// Detachments per second: by detailed balance, or solved.
    pub off: f64,
    /// Its 95 % interval, in proportion to that of kappa.
    pub off_interval: [f64; 2],
    /// The constant of association (m^2).
    pub constant: f64,
    /// Depth over kT.
    pub depth: f64,
    /// ln K at the requested coverage.
    pub ln_k: f64,
}

/// The outcome of one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Yield {
    /// kT (J).
    pub kt: f64,
    /// The bond first, then the traps that caught anything.
    pub states: Vec<KindRates>,
    /// Rates of the pair.
    pub rates: PairRates,
    /// The attachments from which the rates follow.
    pub attached: Attachments,
    /// Share of all possible pairs in the bond at the end.
    pub bound: f64,
    /// The same for the ends of the interval of the bond's attachment rate, widened by the error of
    /// mean numbers.
    pub interval: [f64; 2],
    /// Whether all probabilities were computed; otherwise only mean numbers.
    pub exact: bool,
    /// The difference between the bound share by mean numbers and by simulation, including twice
    /// the standard error of the latter; `None` if all probabilities were computed, or without
    /// simulation.
    pub off: Option<f64>,
    /// Share in traps at the end.
    pub trapped: f64,
    /// Share in the bond by the equations of mean numbers; `None` if they cannot be solved.
    pub smooth: Option<f64>,
    /// Share in the bond in equilibrium; `None` if the bond is never found.
    pub equilibrium: Option<f64>,
    /// Share in the bond in the exact simulation, over all runs and pairs, with the standard error.
    pub simulated: Option<[f64; 2]>,
    /// Mean times (s) of a pair on this table: from free to the bond, and out of the bond.
    pub mean_times: [f64; 2],
    /// What they are at least (95 %), if no attachment to the bond was counted.
    pub least_times: Option<[f64; 2]>,
    /// Time (s), share in the bond, share in traps.
    pub course: Vec<[f64; 3]>,
    /// Tiles, coverage, share in the bond at the end, and whether all probabilities were computed.
    pub table: Vec<(usize, f64, f64, bool)>,
    /// Chains and rings, of equal tiles that bind with two faces.
    pub rows: Option<Chains>,
}

/// The rates of one kind of state; `None` for a trap without attachments, and for a state without
/// volume.
pub(super) fn state(
    hold: &Hold,
    kind: usize,
    attached: &Attachments,
    shaking: &Shaking,
) -> Option<KindRates> {
    let count = attached.counts[kind];
    let on = attached.rate(kind);
    if kind > 0 && (on == 0.0 || !hold.holds_at(shaking.kt)) {
        return None;
    }
    let docking = hold.docking(shaking, TOLERANCE);
    if docking.cost.is_infinite() {
        return None;
    }
    // K for one partner per square metre: all copies count, and the coverage does not.
    let constant = hold.association(&docking);
    let on_interval = attached.interval(kind);
    let off = attached.off(kind).unwrap_or(on / constant);
    Some(KindRates {
        name: hold.name.clone(),
        kind,
        attachments: count,
        on,
        on_interval,
        off,
        off_interval: on_interval.map(|end| match on > 0.0 {
            true => off * end / on,
            false => end / constant,
        }),
        constant,
        depth: docking.depth,
        ln_k: docking.ln_k(1.0),
    })
}

/// The outcome of a setting with given rates of the states.
pub(super) fn outcome(
    kt: f64,
    states: Vec<KindRates>,
    attached: Attachments,
    (crowd, pair): (&Crowd, &Pair),
    joints: Option<(&Joints, &Hold)>,
    request: &Request,
) -> Yield {
    let rates = PairRates {
        on: states.iter().map(|state| state.on).collect(),
        off: states.iter().map(|state| state.off).collect(),
        turns: attached.turns(&states.iter().map(|state| state.kind).collect::<Vec<_>>()),
    };
    let time = request.time;
    let pairs = crowd.pairs() as f64;
    let bond = &states[0];
    let power = |k: usize| DECADES * (k as f64 / (TIMES - 1) as f64 - 1.0);
    let times: Vec<f64> = (0..TIMES)
        .map(|k| time * libm::pow(10f64, power(k)))
        .collect();
    // Even without attachments the rate may be above 0. By detailed balance, a higher attachment rate
    // implies a higher detachment rate.
    let with_end = |end: usize| {
        let mut other = rates.clone();
        other.on[0] = bond.on_interval[end];
        other.off[0] = bond.off_interval[end];
        for other_kind in (1..other.on.len()).filter(|_| bond.on > 0.0) {
            let more = other.on[0] / bond.on;
            other.turns[(0, other_kind)] *= more;
            other.turns[(other_kind, 0)] *= more;
        }
        other
    };
    let [low, high] = [0, 1].map(with_end);
    let built = joints.and_then(|of| rows(of, kt, (&rates, [&low, &high]), &times, crowd, request));
    let asked = [
        (&rates, &times[..]),
        (&low, &[time][..]),
        (&high, &[time][..]),
    ];
    let found = parallel::map(0..asked.len(), |k| {
        let (rates, times) = asked[k];
        shares(rates, crowd, times, MOST_STATES)
    });
    let at_end = |k: usize| *found[k].bound.last().expect("the end is one of the times");
    let simulated = simulated(&rates, crowd, request);
    let bound = at_end(0);
    let exact = found[0].exact;
    let apart = |[mean, error]: [f64; 2]| (bound - mean).abs() + 2.0 * error;
    let off = simulated.map(apart).filter(|_| !exact);
    let wider = off.unwrap_or_default();
    let ends = [at_end(1), at_end(2)];
    let interval = [
        ends[0].min(bound - wider).max(0.0),
        ends[1].max(bound + wider).min(1.0),
    ];
    // A tile among its possible partners.
    let partners = match crowd.one_kind {
        true => crowd.tiles[0] + crowd.tiles[1] - 1,
        false => crowd.tiles[0],
    };
    let mean_times = |rates: &PairRates| {
        let chain = rates.pair_chain(crowd.area / partners.max(1) as f64);
        [chain.mean_times(&[1])[0], chain.mean_times(&[0])[1]]
    };
    let course = times.iter().zip(&found[0].bound).zip(&found[0].trapped);
    let course = course.map(|((time, bound), trapped)| [*time, *bound, *trapped]);
    let rows = with(&TILES, request.tiles).into_iter();
    let coverages = with(&COVERAGES, request.coverage);
    let rows = rows.flat_map(|tiles| coverages.iter().map(move |&coverage| (tiles, coverage)));
    let rows: Vec<(usize, f64)> = rows.collect();
    let table = parallel::map(0..rows.len(), |k| {
        let (tiles, coverage) = rows[k];
        // The requested row is the result above.
        if (tiles, coverage) == (request.tiles, request.coverage) {
            return (tiles, coverage, bound, exact);
        }
        let crowd = Crowd::new(tiles, coverage, pair, crowd.one_kind);
        let found = shares(&rates, &crowd, &[time], MOST_IN_TABLE);
        (tiles, coverage, found.bound[0], found.exact)
    });
    let smooth = rates.mean_numbers(crowd, &[time]);
    // Known without attachments too, since it does not depend on their rate.
    let equilibrium = rates.equilibrium(crowd).or_else(|| high.equilibrium(crowd));
    Yield {
        kt,
        bound,
        trapped: *found[0].trapped.last().expect("as above"),
        interval,
        exact,
        off,
        smooth: smooth.map(|course| course.values[0][0] / pairs),
        equilibrium,
        simulated,
        mean_times: mean_times(&rates),
        least_times: attached.counts_none(0).then(|| mean_times(&high)),
        course: course.collect(),
        table,
        rows: built,
        rates,
        attached,
        states,
    }
}

/// A list with one more entry, in ascending order, without duplicates.
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

/// Shares of all possible pairs; NaN if no solver has a result.
fn shares(rates: &PairRates, crowd: &Crowd, times: &[f64], most: usize) -> Shares {
    rates.shares(crowd, times, most).unwrap_or_else(|| Shares {
        bound: vec![f64::NAN; times.len()],
        trapped: vec![f64::NAN; times.len()],
        error: f64::NAN,
        exact: false,
    })
}

/// Mean share in the bond over runs of the exact simulation, and its standard error.
fn simulated(rates: &PairRates, crowd: &Crowd, request: &Request) -> Option<[f64; 2]> {
    let runs = request.simulations;
    let pairs = crowd.pairs() as f64;
    let one = |run: usize| {
        let numbers = rates.simulate(crowd, request.time, &mut stream(request.seed, run))?;
        Some(numbers[0] as f64 / pairs)
    };
    // One run has no error; and if one has too many events, no other is of use.
    let first = (runs > 1).then(|| one(0))??;
    let others = parallel::map(1..runs, one);
    let shares: Option<Vec<f64>> = std::iter::once(Some(first)).chain(others).collect();
    Some(mean_and_error(&shares?))
}
