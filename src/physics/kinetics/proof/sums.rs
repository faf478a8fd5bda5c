//! Bounds of sums over the cells of a mesh, subdivided where the bounds are wide.

use std::cmp::Reverse;

use ordered_float::OrderedFloat;

use super::piece::{Ground, Piece, Place, Range, UNKNOWN};
use crate::interruption;
use crate::kinetics::mesh::Octree;
use crate::order::Order;
use crate::parallel;

/// The requested part of a load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Load {
    /// All of it.
    All,
    /// An upper bound of the part below an energy (J).
    Below(f64),
}

/// The requested integrals of a piece of a cell.
#[derive(Clone, Debug, Default)]
pub(super) struct Role {
    /// The values of a function at its corners, for the energy.
    pub values: Option<[f64; 8]>,
    /// Upward fluxes through its sides, for the cost.
    pub fluxes: Option<[f64; 6]>,
    /// Whether its load is requested.
    pub load: Option<Load>,
    /// Whether its load counts as outside of other sets.
    pub around: bool,
}

/// The sums: energies, costs, loads and loads outside of other sets.
pub(super) const SUMS: usize = 4;

/// The requested accuracy of sums, and the largest number of pieces of cells.
#[derive(Clone, Copy, Debug)]
pub(in crate::kinetics) struct Closeness {
    /// Allowed total of the relative widths of the sums' bounds.
    pub apart: f64,
    /// Pieces at most.
    pub pieces: usize,
}

/// Share of the width of the bounds in the pieces that are bisected.
const HALVED: f64 = 0.8;
/// Times that pieces are halved at most.
const ROUNDS: usize = 100;
/// Sums with this multiple of the allowed width are far from the goal.
const FAR: f64 = 8.0;
/// Relative rounding of the sums.
const ROUNDING: f64 = 1e-11;

struct Part {
    piece: Piece,
    /// The number of its role.
    role: usize,
    sums: [Range; SUMS],
    axis: usize,
}

/// Bounds of the sums over pieces. `sizes` are approximate values of the sums.
pub(super) fn bounded(
    ground: &Ground,
    mesh: &Octree,
    roles: &[(Piece, Role)],
    sizes: [f64; SUMS],
    asked: Closeness,
) -> [Range; SUMS] {
    let part = |(number, piece): (usize, Piece)| {
        interruption::check();
        let leaf = &mesh.leaves[piece.cell];
        let role = &roles[number].1;
        let place = ground.place(&piece, leaf);
        let of = |find: &dyn Fn(&Place) -> Range| place.as_ref().map_or(UNKNOWN, find);
        let load = |asked: Load| {
            of(&|place| match asked {
                Load::All => ground.load(place),
                // This is the best accuracy possible.
                Load::Below(limit) if place.energies(ground.kt, ground.level)[0] < limit => {
                    [ground.load(place)[1]; 2]
                }
                Load::Below(_) => [0.0; 2],
            })
        };
        let energy = |values: &[f64; 8]| of(&|place| ground.energy(place, leaf, values));
        let cost = |fluxes: &[f64; 6]| of(&|place| ground.cost(place, leaf, fluxes));
        let around = role.around.then_some(Load::All);
        let sums = [
            role.values.as_ref().map(energy),
            role.fluxes.as_ref().map(cost),
            role.load.map(load),
            around.map(load),
        ];
        let longest = (0..3).max_by(|a, b| piece.size[*a].total_cmp(&piece.size[*b]));
        Part {
            role: number,
            // Integrals that are not requested are zero.
            sums: sums.map(Option::unwrap_or_default),
            axis: place.as_ref().map_or(longest.unwrap_or(0), Place::axis),
            piece,
        }
    };
    let whole = |number: usize| part((number, roles[number].0));
    let mut parts: Vec<Part> = parallel::map(0..roles.len(), whole);
    let mut rounds = 0;
    loop {
        let gap = |part: &Part| -> f64 {
            let each = part.sums.iter().zip(sizes);
            let apart = |[low, high]: &Range| if low == high { 0.0 } else { high - low };
            each.map(|(range, size)| apart(range) / size).sum()
        };
        let mut gaps: Vec<(usize, f64)> = parts.iter().map(gap).enumerate().collect();
        let all: f64 = gaps.iter().map(|(_, gap)| gap).sum();
        rounds += 1;
        let is_full = parts.len() >= asked.pieces && all.is_finite();
        if all <= asked.apart || is_full || rounds > ROUNDS {
            let counts = |part: &Part, end: usize| {
                end == 1 || !matches!(roles[part.role].1.load, Some(Load::Below(_)))
            };
            let sum = |k: usize, end: usize| -> f64 {
                let own = parts.iter().filter(|part| k != 2 || counts(part, end));
                own.map(|part| part.sums[k][end]).sum()
            };
            return std::array::from_fn(|k| {
                [sum(k, 0) * (1.0 - ROUNDING), sum(k, 1) * (1.0 + ROUNDING)]
            });
        }
        gaps.order_by_key(|&(at, gap)| (Reverse(OrderedFloat(gap)), at));
        // At first the pieces without any bound; far from the goal all pieces with more than their
        // share of it.
        let least = match all.is_finite() {
            true => asked.apart / parts.len() as f64,
            false => f64::MAX,
        };
        let is_far = all > FAR * asked.apart;
        let mut left = HALVED * all;
        let mut is_marked = |gap: f64| {
            let marked = if is_far { gap > least } else { left > 0.0 };
            left -= gap;
            marked
        };
        let marked: Vec<usize> = gaps
            .iter()
            .take_while(|(_, gap)| is_marked(*gap))
            .map(|(at, _)| *at)
            .take(asked.pieces)
            .collect();
        let halves: Vec<[Part; 2]> = parallel::map(&marked, |&at| {
            let whole = &parts[at];
            let halves = whole.piece.halves(whole.axis);
            halves.map(|half| {
                let mut half = part((whole.role, half));
                // Nothing is negative, so a half is at most the whole.
                for (range, [_, most]) in half.sums.iter_mut().zip(whole.sums) {
                    range[1] = range[1].min(most);
                }
                half
            })
        });
        for (at, [lower, upper]) in marked.into_iter().zip(halves) {
            parts[at] = lower;
            parts.push(upper);
        }
    }
}
