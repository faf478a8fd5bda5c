//! Every option implemented by its definition, over poles and plain sums over dipoles,
//! independently of the tested code.

use std::sync::LazyLock;

use super::super::constraint::Constraints;
use super::super::{Fault, Rules, Word};
use super::plain_energy;

/// Poles of a word: 1, -1.
pub(super) type Poles = Vec<i32>;

pub(super) fn poles(word: Word) -> Poles {
    (0..word.places()).map(|k| word.at(k)).collect()
}

pub(super) fn mate(word: &[i32]) -> Poles {
    word.iter().rev().map(|pole| -pole).collect()
}

/// A face and all its variants with a fault of one magnet.
fn made(face: &[i32], fault: Option<Fault>) -> Vec<Poles> {
    let factor = match fault {
        None => return vec![face.to_vec()],
        Some(Fault::Missing) => 0,
        Some(Fault::Flipped) => -1,
    };
    let faulty = (0..face.len()).map(|k| {
        let mut face = face.to_vec();
        face[k] *= factor;
        face
    });
    faulty.chain([face.to_vec()]).collect()
}

/// The energy (J) of two faces at contact, the second slid by some places along the first.
pub(super) fn energy(first: &[i32], second: &[i32], slide: i32) -> f64 {
    static OF_NORTHS: LazyLock<Vec<f64>> = LazyLock::new(|| {
        let north = Word::parse("N").unwrap();
        (0..20).map(|d| plain_energy(north, north, d)).collect()
    });
    let last = first.len() as i32 - 1;
    let mut energy = 0.0;
    for (k, pole) in (0..).zip(first) {
        for (j, other) in (0..).zip(second) {
            let apart: i32 = last - j - k + slide;
            energy += f64::from(pole * other) * OF_NORTHS[apart.unsigned_abs() as usize];
        }
    }
    energy
}

/// The lowest (sign 1) or highest (sign -1) energy over all faults of both, times the sign.
fn with_faults(first: &[i32], second: &[i32], slide: i32, fault: Option<Fault>, sign: f64) -> f64 {
    let mut least = f64::INFINITY;
    for one in made(first, fault) {
        for other in made(second, fault) {
            least = least.min(sign * energy(&one, &other, slide));
        }
    }
    least
}

pub(super) fn bond(word: &[i32], rules: &Rules) -> f64 {
    let partner = if rules.own() {
        word.to_vec()
    } else {
        mate(word)
    };
    with_faults(word, &partner, 0, rules.fault, -1.0)
}

/// The strongest wrong attraction (J) of two words and their mates.
pub(super) fn wrong(u: &[i32], v: &[i32], rules: &Rules) -> f64 {
    let last = if rules.slides() {
        u.len() as i32 - 1
    } else {
        0
    };
    let mut strongest = 0.0f64;
    for (mates, second) in [(true, mate(v)), (false, v.to_vec())] {
        if (!mates && !rules.words_meet()) || (mates && rules.own()) {
            continue;
        }
        for over in [false, true] {
            if over && !rules.flip {
                continue;
            }
            let mut second = second.clone();
            if over {
                second.reverse();
            }
            for slide in -last..=last {
                if !(mates != rules.own() && !over && slide == 0 && u == v) {
                    strongest = strongest.max(-with_faults(u, &second, slide, rules.fault, 1.0));
                }
            }
        }
    }
    strongest
}

/// Mismatches of two words, one moved by some places, including overhanging places; and runs of
/// matches.
fn compared(u: &[i32], v: &[i32], lag: i32) -> (usize, usize) {
    let n = u.len() as i32;
    let (mut matches, mut run, mut longest) = (0, 0, 0);
    for k in 0..n {
        let there = k + lag;
        if (0..n).contains(&there) && u[k as usize] == v[there as usize] {
            matches += 1;
            run += 1;
            longest = longest.max(run);
        } else {
            run = 0;
        }
    }
    (u.len() - matches, longest)
}

/// Whether two words satisfy the paper's constraints, by its definitions.
pub(super) fn allowed(u: &[i32], v: &[i32], asked: &Constraints) -> bool {
    let n = u.len() as i32;
    let complement = mate(v);
    let mut longest = 0;
    let mut least = usize::MAX;
    for (other, same) in [(v, u == v), (&complement[..], u == complement)] {
        for lag in 1 - n..n {
            if lag != 0 || !same {
                let (mismatches, run) = compared(u, other, lag);
                least = least.min(mismatches);
                longest = longest.max(run);
            }
        }
    }
    (u == v || compared(u, v, 0).0 >= asked.mismatches)
        && compared(u, &complement, 0).0 >= asked.complement_mismatches
        && least >= asked.slide_mismatches
        && asked
            .consecutive
            .as_ref()
            .is_none_or(|range| range.contains(&longest))
}

/// Whether a single word satisfies the constraints.
pub(super) fn sound(word: &[i32], rules: &Rules, asked: &Constraints) -> bool {
    let excess: i32 = word.iter().sum();
    let runs = word.chunk_by(|a, b| a == b).map(<[i32]>::len);
    (!asked.balanced || excess.unsigned_abs() as usize <= word.len() % 2)
        && asked
            .longest_run
            .is_none_or(|most| runs.max().unwrap() <= most)
        && asked
            .least_bond
            .is_none_or(|least| bond(word, rules) >= least)
        && allowed(word, word, asked)
}
