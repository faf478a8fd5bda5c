//! The share of a set in the cells that belong to it only in part.

use super::Cells;
use super::piece::{Ground, Piece};
use super::sums::{Load, Role};
use crate::kinetics::mesh::Octree;
use crate::parallel;

/// Parts of such a cell along each axis, ...
const PARTS: [usize; 4] = [8, 4, 2, 1];
/// ... with at most this many in total.
const MOST: usize = 1 << 20;

/// The parts of the cells that belong to a set only in part: parts proved to lie in the set and
/// connected to it count fully, the others only by what may be below the limit (J).
pub(super) fn pieces(
    mesh: &Octree,
    ground: &Ground,
    cells: &Cells,
    below: f64,
) -> Vec<(Piece, Role)> {
    let is_rim = |id: &usize| cells.outer[*id] && !cells.inner[*id];
    let rim: Vec<usize> = (0..mesh.leaves.len()).filter(is_rim).collect();
    let mut number = vec![None; mesh.leaves.len()];
    for (at, &id) in rim.iter().enumerate() {
        number[id] = Some(at);
    }
    let fits = |parts: &usize| rim.len() * parts.pow(3) <= MOST;
    let parts = PARTS.into_iter().find(fits).unwrap_or(1);
    let all = parts.pow(3);
    let part = |at: usize| {
        let (id, own) = (rim[at / all], at % all);
        let leaf = &mesh.leaves[id];
        let size = leaf.size() as f64 / parts as f64;
        let along = [own % parts, own / parts % parts, own / parts / parts];
        Piece {
            cell: id,
            low: std::array::from_fn(|i| leaf.low[i] as f64 + along[i] as f64 * size),
            size: [size; 3],
        }
    };
    let lies_below = |at: usize| {
        let piece = part(at);
        let place = ground.place(&piece, &mesh.leaves[piece.cell]);
        place.is_some_and(|place| place.energies(ground.kt, ground.level)[1] < below)
    };
    let count = rim.len() * all;
    let low: Vec<bool> = parallel::map(0..count, lies_below);
    // The middles of a part's sides, just beyond them, in whole units: parts of the smallest cells
    // have none.
    let beside = |at: usize| {
        let piece = part(at);
        let half = piece.size[0] / 2.0;
        (0..6).filter_map(move |side| {
            let mut place = piece.low.map(|low| (low + half).floor() as i64);
            let (axis, is_upper) = (side / 2, side % 2 == 1);
            place[axis] = match is_upper {
                true => (piece.low[axis] + piece.size[axis]) as i64,
                false => piece.low[axis] as i64 - 1,
            };
            (piece.size[0] >= 1.0).then_some(place)
        })
    };
    let mut inside = vec![false; count];
    let mut open = Vec::new();
    let is_in = |place| mesh.find(place).is_some_and(|id| cells.inner[id]);
    for at in (0..count).filter(|&at| low[at]) {
        if beside(at).any(is_in) {
            inside[at] = true;
            open.push(at);
        }
    }
    while let Some(at) = open.pop() {
        for place in beside(at) {
            let Some(other) = mesh.find(place).and_then(|id| Some((id, number[id]?))) else {
                continue;
            };
            let (id, first) = other;
            let leaf = &mesh.leaves[id];
            let Some(folded) = mesh.chart.fold(place, false) else {
                continue;
            };
            let along =
                |i: usize| (folded[i] - leaf.low[i]) as usize * parts / leaf.size() as usize;
            let other = first * all + along(0) + parts * (along(1) + parts * along(2));
            if low[other] && !std::mem::replace(&mut inside[other], true) {
                open.push(other);
            }
        }
    }
    let role = |at: usize| Role {
        load: Some(match inside[at] {
            true => Load::All,
            false => Load::Below(below),
        }),
        ..Role::default()
    };
    (0..count).map(|at| (part(at), role(at))).collect()
}
