//! Chains and rings of equal tiles that bind with two faces each.

use super::Request;
use super::attachment::RateSource;
use physics::dynamics::docking::stream;
use physics::dynamics::exits::mean_and_error;
use physics::kinetics::bond::Hold;
use physics::kinetics::population::rows::{Census, Growth, Joints, Spreads};
use physics::kinetics::population::{Crowd, PairRates};
use physics::parallel;
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Streams of random numbers of the play of bonds, and of the growth of rows.
const PLAY: usize = 1 << 20;
const GROWTH: usize = 1 << 21;
/// Largest number of tiles of a chain whose closure is described.
const MOST_IN_RING: usize = 64;
/// Tiles of all simulations together: more tiles need fewer runs.
const MOST_TILES: usize = 40_000;
const LEAST_RUNS: usize = 8;

/// A ring that chains can close to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Closing {
    /// Number of its tiles.
    pub size: usize,
    /// The area (m^2) in which one free end would be as near to another as the chain's ends are.
    #[serde(rename = "effective_area_m2")]
    pub area: f64,
    /// The rate (1/s) at which a chain of its tiles closes.
    #[serde(rename = "closures_per_s")]
    pub rate: f64,
}

/// A mean number and its interval: 95 % over the runs, and the ends of the attachment rate's interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// The mean.
    pub mean: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

/// The number of rows of one size at the end.
#[derive(Clone, Debug, PartialEq)]
pub struct Count {
    /// Whether it is a ring, or else a chain.
    pub is_ring: bool,
    /// Number of its tiles.
    pub size: usize,
    /// The mean number over the runs.
    pub number: Mean,
}

/// What equal tiles build at one kT.
#[derive(Clone, Debug, PartialEq)]
pub struct Chains {
    /// The longest chain that has room, if there is one.
    pub longest: Option<usize>,
    /// The rings.
    pub closings: Vec<Closing>,
    /// Bonds at the end.
    pub bonds: Mean,
    /// Shares of all tiles at the end: single, in chains of two or more, in rings.
    pub shares: [Mean; 3],
    /// Chains, single tiles included, and rings, by size.
    pub counts: Vec<Count>,
    /// Time (s), bonds, and the shares of tiles that are single, in chains and in rings.
    pub course: Vec<[f64; 5]>,
    /// Runs of the simulation.
    pub runs: usize,
}

/// The shares of tiles that are single, in chains and in rings.
fn shares(census: &Census, tiles: usize) -> [f64; 3] {
    let single = census.chains.get(&1).copied().unwrap_or(0);
    let in_rings: usize = census.rings.iter().map(|(size, count)| size * count).sum();
    [single, tiles - single - in_rings, in_rings].map(|part| part as f64 / tiles as f64)
}

/// The rows at the end of `times` (s), at kT (J), for the rates and for the ends of their interval;
/// `None` without simulations, or if they have too many events.
pub(super) fn rows(
    (joints, bond): (&Joints, &Hold),
    kt: f64,
    (rates, ends): (&PairRates, [&PairRates; 2]),
    times: &[f64],
    crowd: &Crowd,
    request: &Request,
) -> Option<Chains> {
    let tiles = request.tiles;
    let most = (MOST_TILES / tiles).max(LEAST_RUNS);
    let runs = request.simulations.min(most);
    if runs < 2 {
        return None;
    }
    let mut rng = stream(request.seed, PLAY);
    let spreads = Spreads::sampled(joints, kt, bond.well.level, &mut rng);
    let slowing = match request.method.source {
        RateSource::Docking => 0.5,
        RateSource::Overdamped => 1.0,
    };
    let growth = |rates| Growth {
        joints,
        spreads: &spreads,
        rates,
        area: crowd.area,
        slowing,
    };
    let all = |rates, times: &[f64]| -> Option<Vec<Vec<Census>>> {
        let growth = growth(rates);
        parallel::map(0..runs, |run| {
            growth.simulate(tiles, times, &mut stream(request.seed, GROWTH + run))
        })
        .into_iter()
        .collect()
    };
    let found = all(rates, times)?;
    let last = &times[times.len() - 1..];
    let [low, high] = ends.map(|rates| all(rates, last));
    let [low, high] = [low?, high?];
    // The mean of a number that is at most `most`.
    let mean = |most: f64, of: &dyn Fn(&Census) -> f64| {
        let over = |runs: &[Vec<Census>]| {
            let values = runs.iter().filter_map(|run| run.last());
            mean_and_error(&values.map(of).collect::<Vec<f64>>())
        };
        let [mean, error] = over(&found);
        let others = [over(&low), over(&high)];
        let least = others.iter().fold(mean, |least, it| least.min(it[0]));
        let greatest = others.iter().fold(mean, |greatest, it| greatest.max(it[0]));
        Mean {
            mean,
            low: (least - 2.0 * error).max(0.0),
            high: (greatest + 2.0 * error).min(most),
        }
    };
    let number = |of: fn(&Census) -> &BTreeMap<usize, usize>, size: usize| {
        mean((tiles / size) as f64, &move |census: &Census| {
            of(census).get(&size).copied().unwrap_or(0) as f64
        })
    };
    let ends = || found.iter().filter_map(|run| run.last());
    let sizes = |of: fn(&Census) -> &BTreeMap<usize, usize>| {
        let mut sizes: Vec<usize> = ends().flat_map(|it| of(it).keys().copied()).collect();
        sizes.sort_unstable();
        sizes.dedup();
        sizes
    };
    let counts = |is_ring: bool, of: fn(&Census) -> &BTreeMap<usize, usize>| {
        sizes(of).into_iter().map(move |size| (is_ring, size, of))
    };
    let counts = counts(false, |census| &census.chains).chain(counts(true, |it| &it.rings));
    let course = times.iter().enumerate().map(|(k, time)| {
        let each = |of: &dyn Fn(&Census) -> f64| {
            found.iter().map(|run| of(&run[k])).sum::<f64>() / runs as f64
        };
        let part = |which: usize| each(&move |census| shares(census, tiles)[which]);
        let bonds = each(&|census| census.bonds() as f64);
        [*time, bonds, part(0), part(1), part(2)]
    });
    let of_rates = growth(rates);
    let closings = (3..=tiles.min(MOST_IN_RING)).filter_map(|size| {
        let row = joints.uniform(size)?;
        let density = spreads.density(joints, &row);
        let area = 1.0 / (TAU * density);
        // Ends that are farther from each other than from other tiles do not make rings.
        (area < crowd.area).then(|| Closing {
            size,
            area,
            rate: of_rates.closing(&row),
        })
    });
    let longest = joints.longest(tiles.min(MOST_IN_RING) + 1);
    Some(Chains {
        longest,
        closings: closings
            .filter(|it| longest.is_none_or(|longest| it.size <= longest))
            .collect(),
        bonds: mean(tiles as f64, &|census| census.bonds() as f64),
        shares: [0, 1, 2].map(|which| mean(1.0, &|census| shares(census, tiles)[which])),
        counts: counts
            .map(|(is_ring, size, of)| Count {
                is_ring,
                size,
                number: number(of, size),
            })
            .collect(),
        course: course.collect(),
        runs,
    })
}
