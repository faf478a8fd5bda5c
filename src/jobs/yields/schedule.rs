//! Schedules: which shaking at which time.

use super::Request;
use super::outcome::Yield;
use physics::kinetics::bond::{Hold, Shaking, TOLERANCE};
use physics::kinetics::population::mixture::{self, Mixture};
use physics::kinetics::population::numbers::{self, Numbers};
use physics::kinetics::population::{Crowd, PairRates};
use physics::parallel;

/// Slots of a schedule.
const SLOTS: usize = 8;
/// Largest number of pairs for which schedules are computed, and of their states.
const PAIRS: usize = 3;
const STATES: usize = 300;
/// States that hold nothing are left this many times as fast as the most fleeting state.
const FLEETING: f64 = 10.0;

/// The best schedule of the settings, and the number of tiles it is for: the requested number, but
/// at most six, and fewer if there are too many kinds of traps.
pub(super) fn best(
    outcomes: &[Yield],
    holds: &[&Hold],
    request: &Request,
    crowd: &Crowd,
) -> (usize, Mixture) {
    // All settings have the same states: a trap without attachments at one kT still holds tiles
    // caught at another.
    let caught = |hold: &&&Hold| {
        outcomes
            .iter()
            .any(|outcome| rates_of(outcome, hold).is_some())
    };
    let kinds: Vec<&Hold> = holds.iter().filter(caught).copied().collect();
    let fits =
        |pairs: &usize| numbers::count(kinds.len(), *pairs).is_some_and(|states| states <= STATES);
    let most = PAIRS.min(request.tiles / 2);
    let pairs = (1..=most).rev().find(fits).unwrap_or(1);
    // Fewer tiles on as much smaller a part of the table.
    let share = pairs as f64 / crowd.pairs() as f64;
    let crowd = Crowd {
        tiles: [pairs; 2],
        area: share * crowd.area,
        table: share * crowd.table,
        ..*crowd
    };
    let settings = parallel::map(0..outcomes.len(), |k| {
        let all = rates(outcomes, &outcomes[k], &kinds, request.coverage);
        Numbers::new(&all, &crowd)
    });
    let first = &settings[0];
    let share = |state: usize| f64::from(first.of(state)[0]) / pairs as f64;
    let values: Vec<f64> = (0..first.len()).map(share).collect();
    let chains: Vec<_> = settings.iter().map(Numbers::chain).collect();
    let found = mixture::schedule(&chains, &values, request.time, SLOTS);
    (2 * pairs, found)
}

/// Attachment and detachment rates of a state at a setting, if it has attachments there.
fn rates_of(outcome: &Yield, hold: &Hold) -> Option<[f64; 2]> {
    let states = outcome.states.iter();
    let mut own = states.filter(|state| state.name == hold.name);
    own.next().map(|state| [state.on, state.off])
}

/// The rates of all kinds of states at a setting. A state without attachments there, but with some
/// at other settings, detaches by detailed balance with their mean attachment rate.
fn rates(outcomes: &[Yield], outcome: &Yield, kinds: &[&Hold], coverage: f64) -> PairRates {
    let known = |hold: &&Hold| rates_of(outcome, hold);
    let fastest = kinds.iter().filter_map(known).map(|rates| rates[1]);
    let fastest = fastest.fold(0.0, f64::max);
    let shaking = Shaking {
        kt: outcome.kt,
        coverage,
    };
    let of = |hold: &&Hold| {
        known(hold).unwrap_or_else(|| {
            let others = outcomes.iter().filter_map(|other| rates_of(other, hold));
            let others: Vec<f64> = others.map(|rates| rates[0]).collect();
            let on = others.iter().sum::<f64>() / others.len() as f64;
            let off = hold
                .holds_at(outcome.kt)
                .then(|| on / hold.association(&hold.docking(&shaking, TOLERANCE)));
            let off = off.filter(|off| off.is_finite());
            [0.0, off.unwrap_or(FLEETING * fastest)]
        })
    };
    let all = kinds.iter().map(of);
    let (on, off) = all.map(|[on, off]| (on, off)).unzip();
    let mut rates = PairRates::through_free(on, off);
    let place = |hold: &&Hold| outcome.states.iter().position(|it| it.name == hold.name);
    let places: Vec<Option<usize>> = kinds.iter().map(place).collect();
    for (i, from) in places.iter().enumerate() {
        for (j, to) in places.iter().enumerate() {
            if let (Some(from), Some(to)) = (from, to) {
                rates.turns[(i, j)] = outcome.rates.turns[(*from, *to)];
            }
        }
    }
    rates
}
