//! Words: barcodes as two sets of bits, fast enough for millions of them.

use std::cmp::Ordering;
use std::fmt::{self, Write};

use tiles::tile::barcode::{Barcode, BarcodeError, Pole};

/// Most places of a word.
pub const MOST_PLACES: usize = 64;

/// A barcode of at most [`MOST_PLACES`] places, read counter-clockwise: place k is bit k of the set
/// of north poles or of the set of south poles, or of neither if there is no magnet. For upright
/// magnets north is up, and the letters are `U` and `D`. Words are ordered like texts of N and S.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Word {
    north: u64,
    south: u64,
    places: u8,
    stands: bool,
}

/// Why a text is not a word.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WordError {
    /// A character is not a pole.
    #[error(transparent)]
    Character(#[from] BarcodeError),
    /// There are no places, or too many.
    #[error("a word has 1 to {MOST_PLACES} positions, not {0}")]
    Places(usize),
    /// N or S together with U or D.
    #[error("magnets of a word are all in the plane (N, S) or all upright (U, D)")]
    Mixed,
}

impl Word {
    /// The word with these disjoint sets of north and south poles, all below `places`.
    pub(super) fn new(north: u64, south: u64, places: usize) -> Self {
        let mask = u64::MAX >> (MOST_PLACES - places);
        Self {
            north: north & mask,
            south: south & mask & !north,
            places: places as u8,
            stands: false,
        }
    }

    /// The same word of upright or lying magnets.
    pub fn standing(self, stands: bool) -> Self {
        Self { stands, ..self }
    }

    /// Reads a word such as `NN.S`, or `UU.D` for upright magnets.
    ///
    /// # Errors
    /// If a character is none of `N`, `S`, `U`, `D` and `.`, if there are none or too many, or if
    /// letters of lying and upright magnets are mixed.
    pub fn parse(text: &str) -> Result<Self, WordError> {
        let code = Barcode::parse(text)?;
        let places = text.len();
        if !(1..=MOST_PLACES).contains(&places) {
            return Err(WordError::Places(places));
        }
        let mut stand = code.places(0.0).map(|(_, _, pole)| pole.stands());
        let stands = stand.next().unwrap_or(false);
        if stand.any(|other| other != stands) {
            return Err(WordError::Mixed);
        }
        let set = |pole: u8| {
            let here = text.bytes().enumerate().filter(|(_, c)| *c == pole);
            here.fold(0, |set, (k, _)| set | 1 << k)
        };
        let [north, south] =
            [[b'N', b'U'], [b'S', b'D']].map(|poles| set(poles[0]) | set(poles[1]));
        Ok(Self::new(north, south, places).standing(stands))
    }

    /// Number of places, including empty ones.
    pub fn places(self) -> usize {
        self.places.into()
    }

    /// Number of magnets.
    pub fn magnets(self) -> u32 {
        (self.north | self.south).count_ones()
    }

    /// The pole in a place, if it holds a magnet.
    pub fn pole(self, k: usize) -> Option<Pole> {
        Pole::of(self.at(k), self.stands)
    }

    /// 1 for a north pole, -1 for a south pole, 0 for no magnet.
    pub fn at(self, k: usize) -> i32 {
        (self.north >> k & 1) as i32 - (self.south >> k & 1) as i32
    }

    /// The places that hold magnets, ascending, each with its pole.
    pub(super) fn poles(self) -> impl Iterator<Item = (usize, i32)> {
        let mut left = self.north | self.south;
        std::iter::from_fn(move || {
            let k = (left != 0).then(|| left.trailing_zeros() as usize)?;
            left &= left - 1;
            Some((k, self.at(k)))
        })
    }

    /// The word that binds this one: reversed, its poles exchanged.
    pub fn mate(self) -> Self {
        self.negated().reversed()
    }

    /// The word with exchanged poles.
    pub fn negated(self) -> Self {
        Self {
            north: self.south,
            south: self.north,
            ..self
        }
    }

    /// The reversed word, which a face that is turned over has.
    pub fn reversed(self) -> Self {
        let reverse = |set: u64| set.reverse_bits() >> (MOST_PLACES - self.places());
        Self {
            north: reverse(self.north),
            south: reverse(self.south),
            ..self
        }
    }

    /// Equal minus unequal poles with `other`, moved by `lag` places: the sum over k of `self[k]
    /// other[k + lag]`.
    #[inline]
    pub fn correlation(self, other: Self, lag: i32) -> i32 {
        let [equal, unequal] = self.facing(other, lag);
        equal.count_ones() as i32 - unequal.count_ones() as i32
    }

    /// The correlation of words with a magnet in every place, which is faster.
    #[inline]
    pub(super) fn full_correlation(self, other: Self, lag: i32) -> i32 {
        let overlap = i32::from(self.places) - lag.abs();
        let mask = u64::MAX >> (MOST_PLACES as i32 - overlap);
        let (own, others) = match lag {
            0.. => (self.north, other.north >> lag),
            _ => (self.north >> -lag, other.north),
        };
        overlap - 2 * ((own ^ others) & mask).count_ones() as i32
    }

    /// The places k at which `self[k]` and `other[k + lag]` are equal poles, and unequal ones.
    #[inline]
    pub fn facing(self, other: Self, lag: i32) -> [u64; 2] {
        let shift = |set: u64| match lag {
            0.. => set.unbounded_shr(lag as u32),
            _ => set.unbounded_shl(lag.unsigned_abs()),
        };
        let (north, south) = (shift(other.north), shift(other.south));
        [
            (self.north & north) | (self.south & south),
            (self.north & south) | (self.south & north),
        ]
    }

    /// North minus south poles.
    pub fn excess(self) -> i32 {
        self.north.count_ones() as i32 - self.south.count_ones() as i32
    }

    /// The longest run of equal poles, ignoring places without a magnet.
    pub fn longest_run(self) -> usize {
        let mut last = 0;
        let mut run = 0;
        let poles = (0..self.places()).map(|k| self.at(k)).filter(|p| *p != 0);
        poles.fold(0, |longest, pole| {
            run = if pole == last { run + 1 } else { 1 };
            last = pole;
            longest.max(run)
        })
    }

    /// The smallest distance of two of its magnets, in places.
    pub fn least_spacing(self) -> usize {
        let magnets = self.north | self.south;
        let mut apart = 1..self.places();
        apart
            .find(|d| magnets & (magnets >> d) != 0)
            .unwrap_or(usize::MAX)
    }
}

impl PartialOrd for Word {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Word {
    fn cmp(&self, other: &Self) -> Ordering {
        let differ = (self.north ^ other.north) | (self.south ^ other.south);
        if differ == 0 {
            return self.places.cmp(&other.places);
        }
        // '.' before 'N' before 'S'.
        let rank = |word: &Self, k: u32| (word.north >> k & 1) + 2 * (word.south >> k & 1);
        let k = differ.trailing_zeros();
        rank(self, k).cmp(&rank(other, k))
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = |k| self.pole(k).map_or('.', Pole::letter);
        (0..self.places()).try_for_each(|k| f.write_char(letter(k)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_their_texts() {
        for text in ["N", "NNSN", "N..S.SN", "UUDU", ".U.D", &"NS.".repeat(21)] {
            let word = Word::parse(text).unwrap();
            assert_eq!(word.to_string(), text);
            assert_eq!(
                word.mate().to_string(),
                Barcode::parse(text).unwrap().mate().to_string()
            );
            assert_eq!(word.reversed().reversed(), word);
        }
        assert_eq!(Word::parse(""), Err(WordError::Places(0)));
        assert_eq!(Word::parse(&"N".repeat(65)), Err(WordError::Places(65)));
        assert!(matches!(Word::parse("NXS"), Err(WordError::Character(_))));
        assert_eq!(Word::parse("N.U"), Err(WordError::Mixed));
        assert_eq!(
            Word::parse("NS.").unwrap().standing(true).to_string(),
            "UD."
        );
    }

    #[test]
    fn order_is_that_of_texts() {
        let texts = ["NNS", "S.N", ".SS", "SSS", "NSN", "N.N"];
        let mut words = texts.map(|text| Word::parse(text).unwrap());
        let mut sorted = texts;
        words.sort();
        sorted.sort();
        assert_eq!(words.map(|word| word.to_string()), sorted);
    }

    #[test]
    fn correlation_is_the_sum() {
        let (u, v) = (
            Word::parse("NNS.SN").unwrap(),
            Word::parse("SN.NNS").unwrap(),
        );
        for lag in -8..=8 {
            let plain: i32 = (0..6)
                .filter(|k| (0..6).contains(&(k + lag)))
                .map(|k| u.at(k as usize) * v.at((k + lag) as usize))
                .sum();
            assert_eq!(u.correlation(v, lag), plain);
        }
        let (u, v) = (
            Word::parse("NNSNSN").unwrap(),
            Word::parse("SNSNNS").unwrap(),
        );
        for lag in -5..=5 {
            assert_eq!(u.full_correlation(v, lag), u.correlation(v, lag));
        }
    }

    #[test]
    fn shape_of_words() {
        let word = Word::parse("..NN.NS.").unwrap();
        assert_eq!(word.longest_run(), 3);
        assert_eq!(word.least_spacing(), 1);
        assert_eq!(word.excess(), 2);
    }
}
