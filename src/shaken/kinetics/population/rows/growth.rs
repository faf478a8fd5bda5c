//! Rows that grow and break: exact stochastic simulation.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::closing::Spreads;
use super::joints::{Joints, TileRow};
use crate::kinetics::population::choice::chosen;
use crate::kinetics::population::crowd::PairRates;
use tiles::interruption;

/// Most events of a simulation.
const MOST_EVENTS: usize = 20_000_000;
/// Fewest tiles of a ring.
const LEAST_RING: usize = 3;
/// A chain that would close less often than this in the whole time never does.
const NEVER: f64 = 1e-9;

/// Rates of rows on a table.
pub struct Growth<'a> {
    /// How tiles join.
    pub joints: &'a Joints<'a>,
    /// The play of bonds.
    pub spreads: &'a Spreads,
    /// Rates of two single tiles.
    pub rates: &'a PairRates,
    /// The area (m^2) in which tiles meet.
    pub area: f64,
    /// The power a of `f = ((1/i + 1/j) / 2)^a`, by which chains of i and j tiles are slower.
    pub slowing: f64,
}

/// The numbers of rows at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Census {
    /// Chains by the number of their tiles, single tiles included.
    pub chains: BTreeMap<usize, usize>,
    /// Rings by the number of their tiles.
    pub rings: BTreeMap<usize, usize>,
    /// Pairs of chains that a trap holds.
    pub held: usize,
}

impl Census {
    /// The number of bonds.
    pub fn bonds(&self) -> usize {
        let open = self.chains.iter().map(|(size, count)| (size - 1) * count);
        let closed = self.rings.iter().map(|(size, count)| size * count);
        open.chain(closed).sum()
    }
}

/// The rows of one simulation.
struct Table {
    /// Chains, with the rates (1/s) at which they close.
    open: Vec<(TileRow, f64)>,
    rings: Vec<TileRow>,
    /// Two chains and the state that holds them.
    held: Vec<(TileRow, TileRow, usize)>,
}

impl Table {
    fn census(&self) -> Census {
        let mut census = Census {
            held: self.held.len(),
            ..Census::default()
        };
        let held = self.held.iter().flat_map(|(a, b, _)| [a, b]);
        for row in self.open.iter().map(|(row, _)| row).chain(held) {
            *census.chains.entry(row.len()).or_default() += 1;
        }
        for ring in &self.rings {
            *census.rings.entry(ring.len()).or_default() += 1;
        }
        census
    }
}

/// What is known of chains: whether they have room, by the two rows that they consist of, and at which
/// rate (1/s) they close.
#[derive(Default)]
struct Known {
    fit: BTreeMap<(TileRow, usize), bool>,
    closing: BTreeMap<TileRow, f64>,
}

/// The row read from its other end.
fn reversed(row: &[bool]) -> TileRow {
    row.iter().rev().map(|turned| !turned).collect()
}

impl Growth<'_> {
    /// The rate constant (m^2/s) of two free ends.
    fn of_ends(&self) -> f64 {
        self.rates.on[0] / self.joints.ways() as f64
    }

    /// The factor f of two chains.
    fn factor(&self, i: usize, j: usize) -> f64 {
        libm::pow(0.5 * (1.0 / i as f64 + 1.0 / j as f64), self.slowing)
    }

    /// The rate (1/s) at which a chain closes.
    pub fn closing(&self, row: &[bool]) -> f64 {
        match row.len() {
            LEAST_RING.. => TAU * self.of_ends() * self.spreads.density(self.joints, row),
            _ => 0.0,
        }
    }

    /// The rows at ascending `times` (s), from single tiles; `None` if it has too many events.
    pub fn simulate(
        &self,
        tiles: usize,
        times: &[f64],
        rng: &mut ChaCha8Rng,
    ) -> Option<Vec<Census>> {
        let end = times.last().copied().unwrap_or(0.0);
        let mut known = Known::default();
        let mut table = Table {
            open: vec![(vec![false], 0.0); tiles],
            rings: Vec::new(),
            held: Vec::new(),
        };
        let traps: f64 = self.rates.on[1..].iter().sum();
        let leaving: Vec<f64> = (0..self.rates.on.len())
            .map(|kind| self.rates.leaving(kind))
            .collect();
        let mut seen = Vec::with_capacity(times.len());
        let mut now = 0.0;
        for event in 0..MOST_EVENTS {
            if event % 1024 == 0 {
                interruption::check();
            }
            let rows = table.open.len() as f64;
            let open: usize = table.open.iter().map(|(row, _)| row.len() - 1).sum();
            let closed: usize = table.rings.iter().map(Vec::len).sum();
            let weights = [
                rows * (rows - 1.0) / 2.0 * (4.0 * self.of_ends() + traps) / self.area,
                (open + closed) as f64 * leaving[0],
                table.held.iter().map(|(_, _, kind)| leaving[*kind]).sum(),
                table.open.iter().map(|(_, closing)| closing).sum(),
            ];
            let all: f64 = weights.iter().sum();
            now += -libm::log(1.0 - rng.random::<f64>()) / all;
            // Never, if no event is possible.
            let until = if now.is_nan() { f64::INFINITY } else { now };
            while seen.len() < times.len() && times[seen.len()] <= until {
                seen.push(table.census());
            }
            if until >= end {
                return Some(seen);
            }
            match chosen(weights, rng.random::<f64>() * all) {
                0 => self.meet(&mut table, &mut known, traps, end, rng),
                1 => self.open(&mut table, &mut known, (open, closed), end, rng),
                2 => self.release(&mut table, &mut known, &leaving, end, rng),
                _ => {
                    let rest = rng.random::<f64>() * weights[3];
                    let row = chosen(table.open.iter().map(|(_, rate)| *rate), rest);
                    let (row, _) = table.open.swap_remove(row);
                    table.rings.push(row);
                }
            }
        }
        None
    }

    /// Two chains meet, and perhaps join.
    fn meet(
        &self,
        table: &mut Table,
        known: &mut Known,
        traps: f64,
        end: f64,
        rng: &mut ChaCha8Rng,
    ) {
        let count = table.open.len();
        let a = rng.random_range(0..count);
        let b = (a + rng.random_range(1..count)) % count;
        let lengths = [a, b].map(|k| table.open[k].0.len());
        if rng.random::<f64>() >= self.factor(lengths[0], lengths[1]) {
            return;
        }
        let by_ends = 4.0 * self.of_ends();
        let rest = rng.random::<f64>() * (by_ends + traps);
        if rest < by_ends {
            let ends = [rng.random::<bool>(), rng.random::<bool>()];
            let rows = [a, b].map(|k| table.open[k].0.clone());
            if let Some(joined) = self.joined(rows, ends, known) {
                take(table, a, b);
                self.add(table, known, joined, end);
            }
        } else {
            let kind = 1 + chosen(self.rates.on[1..].iter().copied(), rest - by_ends);
            let [one, other] = take(table, a, b);
            table.held.push((one, other, kind));
        }
    }

    /// Two chains as one, if the last face of the first and the first face of the second bind and there is
    /// room; each can be turned round before.
    fn joined(&self, rows: [TileRow; 2], turned: [bool; 2], known: &mut Known) -> Option<TileRow> {
        let [one, other] = rows;
        let mut row = if turned[0] { reversed(&one) } else { one };
        let next = if turned[1] { reversed(&other) } else { other };
        self.joints.joint(row[row.len() - 1], next[0])?;
        let first = row.len();
        row.extend(next);
        let fits = *known
            .fit
            .entry((row.clone(), first))
            .or_insert_with(|| self.joints.fit(&row, first));
        fits.then_some(row)
    }

    /// Adds a chain.
    fn add(&self, table: &mut Table, known: &mut Known, row: TileRow, end: f64) {
        let closing = match known.closing.get(&row) {
            Some(closing) => *closing,
            None => {
                let closing = self.closing(&row);
                known.closing.insert(row.clone(), closing);
                closing
            }
        };
        let is_never = closing * end < NEVER;
        table.open.push((row, if is_never { 0.0 } else { closing }));
    }

    /// A bond opens.
    fn open(
        &self,
        table: &mut Table,
        known: &mut Known,
        (open, closed): (usize, usize),
        end: f64,
        rng: &mut ChaCha8Rng,
    ) {
        let leaving = self.rates.leaving(0);
        let mut bond = rng.random_range(0..open + closed);
        if bond < open {
            let mut at = 0;
            while bond >= table.open[at].0.len() - 1 {
                bond -= table.open[at].0.len() - 1;
                at += 1;
            }
            let length = table.open[at].0.len();
            if rng.random::<f64>() >= self.factor(bond + 1, length - bond - 1) {
                return;
            }
            let (mut row, _) = table.open.swap_remove(at);
            let rest = row.split_off(bond + 1);
            let way = rng.random::<f64>() * leaving - self.rates.off[0];
            if way < 0.0 {
                [row, rest]
                    .into_iter()
                    .for_each(|row| self.add(table, known, row, end));
            } else {
                let turns = self.rates.turns.row(0);
                table
                    .held
                    .push((row, rest, chosen(turns.iter().copied(), way)));
            }
        } else {
            bond -= open;
            let mut at = 0;
            while bond >= table.rings[at].len() {
                bond -= table.rings[at].len();
                at += 1;
            }
            if rng.random::<f64>() * leaving < self.rates.off[0] {
                let mut row = table.rings.swap_remove(at);
                row.rotate_left(bond + 1);
                self.add(table, known, row, end);
            }
        }
    }

    /// A trap releases its chains, or turns to another state.
    fn release(
        &self,
        table: &mut Table,
        known: &mut Known,
        leaving: &[f64],
        end: f64,
        rng: &mut ChaCha8Rng,
    ) {
        let weights = || table.held.iter().map(|(_, _, kind)| leaving[*kind]);
        let at = chosen(weights(), rng.random::<f64>() * weights().sum::<f64>());
        let (one, other, kind) = table.held[at].clone();
        if rng.random::<f64>() >= self.factor(one.len(), other.len()) {
            return;
        }
        let way = rng.random::<f64>() * leaving[kind] - self.rates.off[kind];
        if way < 0.0 {
            table.held.swap_remove(at);
            self.add(table, known, one, end);
            self.add(table, known, other, end);
            return;
        }
        match chosen(self.rates.turns.row(kind).iter().copied(), way) {
            0 => {
                let binds = |[a, b]: &[bool; 2]| {
                    let last = if *a { !one[0] } else { one[one.len() - 1] };
                    let next = if *b {
                        !other[other.len() - 1]
                    } else {
                        other[0]
                    };
                    self.joints.joint(last, next).is_some()
                };
                let ends = [[false, false], [false, true], [true, false], [true, true]];
                let ends: Vec<[bool; 2]> = ends.into_iter().filter(binds).collect();
                if ends.is_empty() {
                    return;
                }
                let ends = ends[rng.random_range(0..ends.len())];
                if let Some(joined) = self.joined([one, other], ends, known) {
                    table.held.swap_remove(at);
                    self.add(table, known, joined, end);
                }
            }
            next => table.held[at].2 = next,
        }
    }
}

/// Takes two chains off the table.
fn take(table: &mut Table, a: usize, b: usize) -> [TileRow; 2] {
    let (first, second) = (a.max(b), a.min(b));
    [first, second].map(|k| table.open.swap_remove(k).0)
}
