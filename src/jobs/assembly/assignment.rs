//! Which word for which bond.
//!
//! Engines let a word of one bond meet the mate of another one on the same axis only, aligned. So
//! among words of equal depth it matters which goes where, and whether a bond's east faces carry a
//! word or its mate: exchanges are made as long as they lessen the sum of the weights of wrong
//! meetings. Then bonds are kept from being deeper in whole tiles than their faces alone have them
//! ([`super::rests`]), by exchanges that cost little of that.

use super::depths::Depths;
use super::matrix::Matrix;
use super::wiring::Bond;
use physics::order::Order;
use physics::words::Word;

/// Depth of a bond in kT at which wrong meetings are weighed.
const DEPTH: f64 = 8.0;
/// Bonds whose depths differ by less than this share may take each other's words.
const ALIKE: f64 = 0.05;
/// Rounds of exchanges at most.
const ROUNDS: usize = 12;

/// A face of [`Matrix`] for every bond, that of its east or north faces: the deepest words of
/// `all` for the strongest bonds, then exchanged.
pub fn assign(all: &Matrix, bonds: &[Bond], depths: Option<&Depths>) -> Vec<Word> {
    let (there, needed) = (all.words.len(), bonds.len());
    let mut by_depth: Vec<usize> = (0..there).collect();
    // Depths that differ in their last digits only are the same.
    let rank = |word: usize| -(all.bond(word) / all.bond(0).abs() * 1e9).round();
    by_depth.order_by(|a, b| rank(*a).total_cmp(&rank(*b)));
    let mut by_strength: Vec<usize> = (0..needed).collect();
    by_strength.order_by(|a, b| bonds[*b].strength.total_cmp(&bonds[*a].strength));
    // Faces of bonds, then words that are left.
    let mut faces = vec![0; needed];
    for (bond, word) in by_strength.iter().zip(&by_depth) {
        faces[*bond] = *word;
    }
    faces.extend(by_depth.iter().skip(needed));
    let weights = |faces: &[usize], changed: &[usize]| weights(all, bonds, faces, changed);
    exchange(&mut faces, all, needed, 1, |faces, others, changed| {
        weights(others, changed) < weights(faces, changed) * (1.0 - 1e-9)
    });
    if let Some(depths) = depths {
        let every: Vec<usize> = (0..needed).collect();
        let most = weights(&faces, &every) * depths.price;
        exchange(&mut faces, all, needed, 4, |faces, others, _| {
            let deeper = depths.excess(faces);
            deeper > 0.0
                && depths.excess(others) < deeper * (1.0 - 1e-9)
                && weights(others, &every) <= most
        });
    }
    faces[..needed].iter().map(|face| all.code(*face)).collect()
}

/// Exchanges the faces of bonds, with each other and with what is left, and words with mates, as long
/// as that is `better`, which is told the faces before and after and the bonds that changed. What is
/// exchanged goes in 1 or 4 `ways`: as it is, or with one or both for their mates as well.
fn exchange(
    faces: &mut Vec<usize>,
    all: &Matrix,
    needed: usize,
    ways: usize,
    better: impl Fn(&[usize], &[usize], &[usize]) -> bool,
) {
    let there = all.words.len();
    let take = |faces: &mut Vec<usize>, others: Vec<usize>, changed: &[usize]| {
        let taken = better(faces, &others, changed);
        if taken {
            *faces = others;
        }
        taken
    };
    for _ in 0..ROUNDS {
        let mut any = false;
        for i in 0..needed {
            let mut turned = faces.clone();
            turned[i] = all.mate(faces[i]);
            any |= take(faces, turned, &[i]);
            for k in i + 1..there {
                let [one, other] = [faces[i], faces[k]].map(|face| all.bond(face));
                if (one / other - 1.0).abs() > ALIKE {
                    continue;
                }
                let changed = if k < needed { &[i, k][..] } else { &[i] };
                for way in 0..ways {
                    let mut swapped = faces.clone();
                    swapped.swap(i, k);
                    for (bit, at) in [i, k].into_iter().enumerate() {
                        if way >> bit & 1 == 1 {
                            swapped[at] = all.mate(swapped[at]);
                        }
                    }
                    any |= take(faces, swapped, changed);
                }
            }
        }
        if !any {
            break;
        }
    }
}

/// The weights of the wrong meetings of some bonds.
fn weights(all: &Matrix, bonds: &[Bond], faces: &[usize], changed: &[usize]) -> f64 {
    let meeting = |i: usize, j: usize| {
        let energy = all.energies[faces[i]][all.mate(faces[j])];
        let unit = all.bond(faces[i]) / bonds[i].strength;
        libm::exp(-DEPTH * energy / unit)
    };
    let with = |i: &usize| -> f64 {
        let others = (0..bonds.len()).filter(|j| j != i && bonds[*j].axis == bonds[*i].axis);
        others.map(|j| meeting(*i, j) + meeting(j, *i)).sum()
    };
    changed.iter().map(with).sum()
}
