//! The sides of cells, and the faces they consist of.

use super::octree::Octree;
use super::profile::{Resistance, Spread};

/// The neighbourhood of a cell's side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    /// Nothing.
    Closed,
    /// A face.
    Whole([(u32, f64); 1]),
    /// The faces of four smaller cells, with the shares of the flux that go through them.
    Split([(u32, f64); 4]),
}

impl Side {
    /// Its faces, with the shares of the flux that go through them.
    pub fn faces(&self) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        let faces: &[_] = match self {
            Self::Closed => &[],
            Self::Whole(face) => face,
            Self::Split(faces) => faces,
        };
        faces.iter().map(|&(face, share)| (face as usize, share))
    }
}

/// For each cell its sides, and for each face whether it is an end, as those at the rim are.
pub(super) fn sides(
    mesh: &Octree,
    rim: usize,
    costs: &[Option<(Spread, Box<Resistance>)>],
) -> (Vec<[Side; 6]>, Vec<Option<usize>>) {
    let mut sides = vec![[Side::Closed; 6]; mesh.leaves.len()];
    let mut ends = Vec::new();
    let mut parts: Vec<(usize, usize, u32, usize)> = Vec::new();
    for (id, leaf, _) in mesh.live() {
        for side in 0..6 {
            let is_upper = side % 2 == 1;
            let face = ends.len() as u32;
            let Some(other) = mesh.find(leaf.beyond(side)) else {
                // Contact, or the rim.
                if is_upper {
                    ends.push(Some(rim));
                    sides[id][side] = Side::Whole([(face, 1.0)]);
                }
                continue;
            };
            let beyond = &mesh.leaves[other];
            if beyond.element.is_none() || beyond.level > leaf.level {
                continue;
            }
            if beyond.level < leaf.level {
                parts.push((other, side ^ 1, face, id));
            } else if is_upper {
                sides[other][side ^ 1] = Side::Whole([(face, 1.0)]);
            } else {
                continue;
            }
            ends.push(None);
            sides[id][side] = Side::Whole([(face, 1.0)]);
        }
    }
    parts.sort_unstable();
    for four in parts.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (cell, side, ..) = four[0];
        let share = |part: usize| {
            let [whole, [from, to]] = [cell, part].map(|id| mesh.leaves[id].along(&mesh.chart));
            match &costs[cell] {
                Some((spread, _)) if side >= 2 => {
                    let profile = spread.of(side);
                    0.5 * (profile.share(to, whole) - profile.share(from, whole))
                }
                _ => 0.25,
            }
        };
        let faces: Vec<_> = four.iter().map(|part| (part.2, share(part.3))).collect();
        if let Ok(faces) = faces.try_into() {
            sides[cell][side] = Side::Split(faces);
        }
    }
    (sides, ends)
}

/// The distribution of fluxes over the sides of each cell; for a shared side that of the larger
/// cell, or else the lower one. `own` gives the distribution of a cell itself, for its sides 2 to 5
/// and its centre.
pub(in crate::kinetics) fn spreads(mesh: &Octree, own: &[Option<Spread>]) -> Vec<Spread> {
    let mut spreads = vec![Spread::default(); mesh.leaves.len()];
    for (id, leaf, _) in mesh.live() {
        let mut spread = own[id].unwrap_or_default();
        for side in 2..6 {
            let beyond = mesh.find(leaf.beyond(side)).filter(|&other| {
                let level = mesh.leaves[other].level;
                level < leaf.level || level == leaf.level && side % 2 == 0
            });
            if let Some(other) = beyond.and_then(|other| own[other]) {
                spread.profiles[side - 2] = *other.of(side ^ 1);
            }
        }
        spreads[id] = spread;
    }
    spreads
}
