//! Known codes, from which searches for words start.
//!
//! If faces only meet aligned, two words attract each other less the more places they differ in:
//! sets of words are binary codes with a minimum distance. The best of these have structure that no
//! exchange of single words finds. Those that are quick to construct are here:
//!
//! - lexicodes (Conway and Sloane 1986, doi:10.1109/TIT.1986.1057187): all words in order that are
//!   far enough from all earlier ones. They are linear, and those of up to 16 places include
//!   Hamming's codes and the first Reed-Muller codes (rows of Sylvester's matrix and their
//!   negatives);
//! - rows of Hadamard matrices of Paley's two kinds, with their negatives: 2 n words of n places,
//!   of which any two differ in at least n / 2, and the codes with one or two columns less;
//! - Golay's extended code of 24 places, and codes of Bose, Ray-Chaudhuri and Hocquenghem of 31 and,
//!   with a bit of parity, 32, shortened to fewer.

/// Largest number of words of a code.
const MOST: usize = 4096;
/// Lexicodes are made up to this many places.
const LEXICODE: usize = 16;

/// Generators of cyclic codes: places, their polynomial, the least distance; a parity bit adds one
/// place and increases an odd distance by one.
const CYCLIC: [(usize, u64, usize); 5] = [
    (23, 0b1010_1110_0011, 7),
    (31, 0b100_101, 3),
    (31, multiply(0b100_101, 0b111_101), 5),
    (31, multiply(multiply(0b100_101, 0b111_101), 0b110_111), 7),
    // Of the classes of 1, 3, 5 and 7.
    (
        31,
        multiply(
            multiply(multiply(0b100_101, 0b111_101), 0b110_111),
            0b101_111,
        ),
        11,
    ),
];

/// The product of two polynomials over two numbers.
const fn multiply(a: u64, b: u64) -> u64 {
    let (mut sum, mut k) = (0, 0);
    while k < 64 {
        if b >> k & 1 == 1 {
            sum ^= a << k;
        }
        k += 1;
    }
    sum
}

/// Codes with this many places in which any two words differ in at least `distance` places, as bits
/// of words, largest first.
pub fn of(places: usize, distance: usize) -> Vec<Vec<u64>> {
    let mut codes = Vec::new();
    if !(2..=places).contains(&distance) || places > 63 {
        return codes;
    }
    if places <= LEXICODE {
        codes.push(lexicode(places, distance));
    }
    for more in 0..3 {
        codes
            .extend(hadamard(places + more).and_then(|rows| fitted(&rows, more, places, distance)));
    }
    for (length, generator, least) in CYCLIC {
        for parity in [false, true] {
            let (length, least) = (length + usize::from(parity), least + usize::from(parity));
            if length >= places && least >= distance {
                let code = shortened(length, generator, parity, places);
                codes.push(code);
            }
        }
    }
    codes.retain(|code| code.len() > 2);
    codes.sort_by_key(|code| std::cmp::Reverse(code.len()));
    codes
}

/// The lexicode, up to [`MOST`] words.
fn lexicode(places: usize, distance: usize) -> Vec<u64> {
    let mut code = vec![0u64];
    let far = |code: &[u64], word: u64| {
        code.iter()
            .all(|other| (word ^ other).count_ones() as usize >= distance)
    };
    // Linear: a new word also adds its sums with all earlier words.
    let mut word = 1u64;
    while word < 1 << places && 2 * code.len() <= MOST {
        if far(&code, word) {
            let more: Vec<u64> = code.iter().map(|other| other ^ word).collect();
            code.extend(more);
        }
        word += 1;
    }
    code
}

/// The rows of a Hadamard matrix of Paley's kinds, bits for its minus signs; `None` if there is
/// none.
fn hadamard(n: usize) -> Option<Vec<u64>> {
    let prime = |q: usize| q > 2 && (2..q).all(|k| !q.is_multiple_of(k));
    if !(4..=64).contains(&n) {
        return None;
    }
    let character = |q: usize, k: usize| match k % q {
        0 => 0,
        k => match (1..q).any(|x| x * x % q == k) {
            true => 1,
            false => -1,
        },
    };
    // Conference matrix: ones about Jacobsthal's matrix, skew for q = 3 mod 4.
    let conference = |q: usize, i: usize, j: usize| match (i, j) {
        (0, 0) => 0,
        (0, _) => 1,
        (_, 0) if q % 4 == 3 => -1,
        (_, 0) => 1,
        _ => character(q, q + i - j),
    };
    let entry: Box<dyn Fn(usize, usize) -> i32> = if n.is_multiple_of(4) && prime(n - 1) {
        Box::new(move |i, j| conference(n - 1, i, j) + i32::from(i == j))
    } else if n.is_multiple_of(4) && prime((n / 2).saturating_sub(1)) && (n / 2 - 1) % 4 == 1 {
        let q = n / 2 - 1;
        Box::new(move |i, j| {
            let (block, a, b) = (conference(q, i / 2, j / 2), i % 2, j % 2);
            let sign = if a * b == 1 { -1 } else { 1 };
            match block {
                // A separate 2 x 2 block on the diagonal.
                0 => [[1, -1], [-1, -1]][a][b],
                block => block * sign,
            }
        })
    } else {
        return None;
    };
    let row = |i: usize| (0..n).fold(0u64, |bits, j| bits | u64::from(entry(i, j) < 0) << j);
    Some((0..n).map(row).collect())
}

/// Rows and their negatives with this many columns less, shortened or punctured, whichever has more
/// words at the distance.
fn fitted(rows: &[u64], less: usize, places: usize, distance: usize) -> Option<Vec<u64>> {
    let n = places + less;
    let mask = (1u64 << places) - 1;
    let all = rows
        .iter()
        .flat_map(|row| [*row, !row & (u64::MAX >> (64 - n))]);
    let all: Vec<u64> = all.collect();
    if n / 2 >= distance + less {
        return Some(all.iter().map(|row| row & mask).collect());
    }
    // Those that agree in the first omitted column, with another one punctured.
    (less > 0 && n / 2 >= distance + less - 1).then(|| {
        let agree = all.iter().filter(|row| *row >> places & 1 == 0);
        agree.map(|row| row & mask).collect()
    })
}

/// A cyclic code, with or without a parity bit, shortened to this many places: at most [`MOST`] of
/// its words.
fn shortened(length: usize, generator: u64, parity: bool, places: usize) -> Vec<u64> {
    let degree = 63 - generator.leading_zeros() as usize;
    let cyclic = length - usize::from(parity);
    let cut = length - places;
    // Words that are zero in the highest places; the parity bit is the lowest.
    let dimension = (cyclic - degree).saturating_sub(cut);
    let count = dimension.min(MOST.ilog2() as usize);
    let word = |message: u64| {
        let sum = multiply(generator, message);
        match parity {
            true => sum << 1 | u64::from(sum.count_ones() % 2),
            false => sum,
        }
    };
    (0..1u64 << count).map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn least_distance(code: &[u64]) -> u32 {
        let pairs = (0..code.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let distances = pairs.map(|(i, j)| (code[i] ^ code[j]).count_ones());
        distances.min().unwrap_or(u32::MAX)
    }

    #[test]
    fn codes_have_the_distance_and_the_places_asked_for() {
        for places in 3..=32 {
            for distance in 2..=places / 2 + 1 {
                for code in of(places, distance) {
                    let some = &code[..code.len().min(300)];
                    assert!(
                        least_distance(some) as usize >= distance,
                        "{places} {distance}"
                    );
                    assert!(code.iter().all(|word| word >> places == 0));
                }
            }
        }
    }

    /// Sizes known to be the largest (Brouwer's table of A(n, d)), or those of linear codes.
    #[test]
    fn codes_are_as_large_as_is_known() {
        let size = |places, distance| of(places, distance)[0].len();
        for (places, distance, least) in [
            (8, 4, 16),
            (12, 6, 24),
            (11, 5, 24),
            (11, 6, 12),
            (12, 3, 256),
            (16, 8, 32),
            (20, 10, 40),
            (24, 12, 48),
            (24, 8, 4096),
            (28, 14, 56),
            (32, 12, 2048),
        ] {
            assert!(size(places, distance) >= least, "{places} {distance}");
        }
    }
}
