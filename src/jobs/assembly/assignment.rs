//! The assignment of words to bonds.
//!
//! In the engines, a word of one bond meets the mate of another only on the same axis and aligned.
//! So among words of equal depth the assignment matters, and also whether a bond's east faces carry
//! a word or its mate. Words are exchanged as long as this reduces the sum of the weights of wrong
//! contacts. Further exchanges, which increase that sum only a little, keep bonds between whole
//! tiles from being deeper than those of their faces alone ([`super::rests`]).

use super::depths::Depths;
use super::matrix::Matrix;
use super::wiring::{LinkedBonds, Wiring};
use physics::order::Order;
use physics::words::Word;

/// Depth of a bond in kT for the weights of wrong contacts.
const DEPTH: f64 = 8.0;
/// Bonds whose depths differ by less than this share may exchange words.
const ALIKE: f64 = 0.05;
/// Largest number of rounds of exchanges.
const ROUNDS: usize = 12;
/// Largest number of steps in the search for words that bind each other's mates.
const MOST_STEPS: usize = 1_000_000;

/// Assigns a face of [`Matrix`] to every bond, that of its east or north faces: first the deepest
/// words of `all` to the strongest bonds, then by exchanges. Words that are `given` keep their
/// orientation: east and north faces carry words, not mates.
///
/// # Errors
/// If no words bind each other's mates as some bonds require.
pub fn assign(
    all: &Matrix,
    wiring: &Wiring,
    depths: Option<&Depths>,
    given: bool,
) -> Result<Vec<Word>, String> {
    let ways = |ways: usize| if given { 0 } else { ways };
    let bonds = &wiring.bonds;
    let fixed = fixed(all, wiring)?;
    let (there, needed) = (all.words.len(), bonds.len());
    let is_fixed = |word: &usize| fixed.iter().flatten().any(|face| face % there == *word);
    let mut by_depth: Vec<usize> = (0..there).filter(|word| !is_fixed(word)).collect();
    // Depths that differ only in their last digits are equal.
    let rank = |word: usize| -(all.bond(word) / all.bond(0).abs() * 1e9).round();
    by_depth.order_by(|a, b| rank(*a).total_cmp(&rank(*b)));
    let is_free = |bond: &usize| fixed[*bond].is_none();
    let mut by_strength: Vec<usize> = (0..needed).filter(is_free).collect();
    by_strength.order_by(|a, b| bonds[*b].strength.total_cmp(&bonds[*a].strength));
    // Faces of bonds, then unused words.
    let mut faces: Vec<usize> = fixed.iter().map(|face| face.unwrap_or(0)).collect();
    for (bond, word) in by_strength.iter().zip(&by_depth) {
        faces[*bond] = *word;
    }
    faces.extend(by_depth.iter().skip(by_strength.len()));
    let weights = |faces: &[usize], changed: &[usize]| weights(all, wiring, faces, changed);
    exchange(
        &mut faces,
        all,
        &fixed,
        ways(1),
        |faces, others, changed| weights(others, changed) < weights(faces, changed) * (1.0 - 1e-9),
    );
    if let Some(depths) = depths {
        let every: Vec<usize> = (0..needed).collect();
        let most = weights(&faces, &every) * depths.price;
        exchange(&mut faces, all, &fixed, ways(4), |faces, others, _| {
            let deeper = depths.excess(faces);
            deeper > 0.0
                && depths.excess(others) < deeper * (1.0 - 1e-9)
                && weights(others, &every) <= most
        });
    }
    Ok(faces[..needed].iter().map(|face| all.code(*face)).collect())
}

/// Faces for the bonds whose words bind each other's mates: the first solution in order.
fn fixed(all: &Matrix, wiring: &Wiring) -> Result<Vec<Option<usize>>, String> {
    let mut fixed: Vec<Option<usize>> = vec![None; wiring.bonds.len()];
    for LinkedBonds { bonds, strengths } in wiring.groups() {
        let taken: Vec<usize> = fixed.iter().flatten().copied().collect();
        let mut chosen: Vec<usize> = Vec::new();
        let mut next = 0;
        let mut steps = 0;
        while chosen.len() < bonds.len() {
            let k = chosen.len();
            let goes = |face: &usize| {
                let unit = |face: usize, k: usize| all.bond(face) / strengths[k][k];
                let own = unit(*face, k) / chosen.first().map_or(unit(*face, k), |it| unit(*it, 0));
                let like = |(j, other): (usize, &usize)| {
                    let holds = -all.energies[*other][all.mate(*face)];
                    let asked = strengths[j][k] * unit(*other, j);
                    (holds - asked).abs() <= ALIKE * 2.0 * unit(*other, j)
                };
                let word = face % all.words.len();
                let mut others = taken.iter().chain(&chosen);
                (own - 1.0).abs() <= 2.0 * ALIKE
                    && others.all(|other| other % all.words.len() != word)
                    && chosen.iter().enumerate().all(like)
            };
            steps += 1;
            match (next..all.energies.len()).find(goes) {
                Some(face) => {
                    chosen.push(face);
                    next = 0;
                }
                None => match chosen.pop() {
                    Some(face) if steps < MOST_STEPS => next = face + 1,
                    _ => {
                        return Err(format!(
                            "glues that bind other glues but not themselves need {} words that bind \
                             each other's mates, which the given words do not include: leave out \
                             --words to search for such words",
                            bonds.len()
                        ));
                    }
                },
            }
        }
        for (bond, face) in bonds.into_iter().zip(chosen) {
            fixed[bond] = Some(face);
        }
    }
    Ok(fixed)
}

/// Exchanges the faces of bonds with each other and with unused words, and words with mates, as
/// long as the result is `better`, a function of the faces before and after and of the changed
/// bonds. There are 1 or 4 `ways` of each exchange: as it is, or also with one or both replaced by
/// their mates; with 0, exchanges are as they are and no word is replaced by its mate.
fn exchange(
    faces: &mut Vec<usize>,
    all: &Matrix,
    fixed: &[Option<usize>],
    ways: usize,
    better: impl Fn(&[usize], &[usize], &[usize]) -> bool,
) {
    let needed = fixed.len();
    let is_fixed = |k: usize| fixed.get(k).is_some_and(Option::is_some);
    let there = faces.len();
    let take = |faces: &mut Vec<usize>, others: Vec<usize>, changed: &[usize]| {
        let taken = better(faces, &others, changed);
        if taken {
            *faces = others;
        }
        taken
    };
    for _ in 0..ROUNDS {
        let mut any = false;
        for i in (0..needed).filter(|i| !is_fixed(*i)) {
            let mut turned = faces.clone();
            turned[i] = all.mate(faces[i]);
            any |= ways > 0 && take(faces, turned, &[i]);
            for k in (i + 1..there).filter(|k| !is_fixed(*k)) {
                let [one, other] = [faces[i], faces[k]].map(|face| all.bond(face));
                if (one / other - 1.0).abs() > ALIKE {
                    continue;
                }
                let changed = if k < needed { &[i, k][..] } else { &[i] };
                for way in 0..ways.max(1) {
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

/// The weights of the wrong contacts of some bonds.
fn weights(all: &Matrix, wiring: &Wiring, faces: &[usize], changed: &[usize]) -> f64 {
    let bonds = &wiring.bonds;
    let meeting = |i: usize, j: usize| {
        let energy = all.energies[faces[i]][all.mate(faces[j])];
        let unit = all.bond(faces[i]) / bonds[i].strength;
        libm::exp(-DEPTH * energy / unit)
    };
    let with = |i: &usize| -> f64 {
        let others = (0..bonds.len()).filter(|j| j != i && bonds[*j].axis == bonds[*i].axis);
        let others = others.filter(|j| !wiring.are_linked(*i, *j));
        others.map(|j| meeting(*i, j) + meeting(j, *i)).sum()
    };
    changed.iter().map(with).sum()
}
