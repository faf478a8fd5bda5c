//! Which contacts of two words are wrong, and how strongly the words attract in them.
//!
//! A face carries a word u or its mate u*. Slid by s places, u meets v with the correlations of u
//! and the reverse of v, and v* with those of u and -v. A face that is turned over has its word
//! reversed. So all contacts of two words and their mates need at most four correlations.
//!
//! Words that bind their own kind ([`Faces::Own`]) have no mates: every face is a word of the set,
//! and the bond is that of u with u.

use super::fault::{Fault, Faulty};
use super::lag::{Correlations, Lags};
use super::word::Word;

/// Which faces can meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Faces {
    /// Every face can meet every face.
    #[default]
    All,
    /// Words meet only mates.
    Mates,
    /// Every face carries a word, which is to bind its own kind: there are no mates.
    Own,
}

impl Faces {
    /// The name of each.
    pub const NAMES: [(&'static str, Self); 2] = [("all", Self::All), ("mates", Self::Mates)];
}

/// The complementary shapes of the faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FaceShape {
    /// None: faces slide.
    #[default]
    None,
    /// One that any two faces share and that forbids slides.
    Shared,
    /// Knobs on words, slots on mates: words meet only mates, and do not slide.
    Polar,
}

impl FaceShape {
    /// The name of each.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("none", Self::None),
        ("shared", Self::Shared),
        ("polar", Self::Polar),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].0
    }
}

/// The wrong contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rules {
    /// Which faces can meet, without a shape.
    pub faces: Faces,
    /// Their shapes.
    pub shape: FaceShape,
    /// Tiles may lie upside down.
    pub flip: bool,
    /// The fault that one magnet of every face may have; bonds and wrong attractions are then those
    /// with the worst faults.
    pub fault: Option<Fault>,
}

/// Numbers of contacts that differ by less than this are equal.
const ROUNDED: f64 = 1e-9;

/// One way in which a face meets another word's faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Way {
    /// The second face is a mate.
    mate: bool,
    /// It is turned over.
    flipped: bool,
}

impl Way {
    /// The second face as read from the first one, up to the sign.
    fn facing(self, word: Word) -> Word {
        if self.mate == self.flipped {
            word.reversed()
        } else {
            word
        }
    }

    /// The place on the second face, when not turned over, of magnet j of [`Self::facing`].
    fn place(self, j: usize, places: usize) -> usize {
        if self.flipped { j } else { places - 1 - j }
    }

    /// The sign of the attraction relative to the energy of [`Self::facing`].
    fn sign(self) -> f64 {
        if self.mate { 1.0 } else { -1.0 }
    }
}

/// The strongest wrong contact of two faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrongContact {
    /// The word of the first face.
    pub first: Word,
    /// The word of the second face, when not turned over.
    pub second: Word,
    /// Whether the second face is turned over.
    pub flipped: bool,
    /// By how many places the second face lies farther along the first one (counter-clockwise).
    pub slide: i32,
    /// J.
    pub energy: f64,
    /// Places of the faulty magnets, if faults are allowed.
    pub faulty: Faulty,
}

impl WrongContact {
    /// The one that attracts more; the first of equals.
    pub(super) fn stronger(self, other: Self) -> Self {
        if other.energy < self.energy {
            other
        } else {
            self
        }
    }
}

impl Rules {
    /// Whether a word and its mate may be exchanged without changing which faces meet.
    pub fn exchangeable(&self) -> bool {
        self.words_meet() && !self.own()
    }

    /// Whether words bind their own kind and have no mates.
    pub fn own(&self) -> bool {
        self.faces == Faces::Own
    }

    /// Whether words meet words.
    pub fn words_meet(&self) -> bool {
        match self.shape {
            FaceShape::None => self.faces != Faces::Mates,
            FaceShape::Shared => true,
            FaceShape::Polar => false,
        }
    }

    /// Whether faces slide along each other.
    pub fn slides(&self) -> bool {
        self.shape == FaceShape::None
    }

    /// Number of contacts of two words with this many places.
    pub fn meetings(&self, places: usize) -> usize {
        self.ways().count() * self.slides_of(places).count()
    }

    /// Number of ways in which they meet at a slide.
    pub(super) fn ways_of_meeting(&self) -> usize {
        self.ways().count()
    }

    fn ways(&self) -> impl Iterator<Item = Way> {
        let (words_meet, mates, flip) = (self.words_meet(), !self.own(), self.flip);
        let all = [(true, false), (false, false), (true, true), (false, true)];
        all.into_iter()
            .filter(move |(mate, flipped)| {
                (if *mate { mates } else { words_meet }) && (!flipped || flip)
            })
            .map(|(mate, flipped)| Way { mate, flipped })
    }

    /// The slides at which two words with this many places overlap, from the middle.
    fn slides_of(&self, places: usize) -> impl Iterator<Item = i32> {
        let last = if self.slides() { places as i32 - 1 } else { 0 };
        (0..=last).flat_map(|s| [s, -s].into_iter().take(if s == 0 { 1 } else { 2 }))
    }

    /// How the faces of a bond meet: a word and its mate, or two of a kind.
    fn bond_way(&self) -> Way {
        Way {
            mate: !self.own(),
            flipped: false,
        }
    }

    /// Whether a contact is the bond, at slide 0.
    fn is_bond(&self, way: Way, s: i32, same: bool) -> bool {
        same && s == 0 && way == self.bond_way()
    }

    /// Whether no wrong attraction of two words and their mates exceeds `limit` (J).
    pub fn within(&self, lags: &Lags, u: Word, v: Word, limit: f64) -> bool {
        self.within_but(lags, [u, v], u == v, limit)
    }

    /// The same if the aligned contact of one with the other's mate is also intended.
    pub fn within_but_aligned(&self, lags: &Lags, u: Word, v: Word, limit: f64) -> bool {
        self.within_but(lags, [u, v], true, limit)
    }

    /// The same, with or without the aligned contact of a word and the other one's mate.
    fn within_but(&self, lags: &Lags, [u, v]: [Word; 2], same: bool, limit: f64) -> bool {
        let (places, magnets) = (u.places() as i32, u.magnets().min(v.magnets()));
        let others = u.magnets().max(v.magnets());
        let full = magnets as i32 == places;
        // The facing magnets nearly always decide: up to one number is allowed whatever the others
        // add, and above another is too many.
        let (contact, rest) = (lags.contact(), lags.rest(magnets, others));
        let by_faults = self.fault.map_or(0, Fault::contacts);
        let fine = ((limit - rest) / contact - ROUNDED).floor() as i32 - by_faults;
        let most = ((limit + rest) / contact + ROUNDED).floor() as i32;
        let last = if self.slides() {
            places - fine.max(0) - 1
        } else {
            0
        };
        self.ways().all(|way| {
            let facing = way.facing(v);
            let sign = if way.mate { 1 } else { -1 };
            let mut all_lags = None;
            let mut is_within = |s: i32| {
                let facing_alone = sign
                    * match full {
                        true => u.full_correlation(facing, s),
                        false if last == 0 => u.correlation(facing, s),
                        false => all_lags
                            .get_or_insert_with(|| Correlations::new(u, facing))
                            .at(s),
                    };
                if facing_alone <= fine || self.is_bond(way, s, same) {
                    return true;
                }
                if facing_alone > most {
                    return false;
                }
                if let Some(fault) = self.fault {
                    return -fault.least(lags, -way.sign(), [u, facing], s).0 <= limit;
                }
                let all = all_lags.get_or_insert_with(|| Correlations::new(u, facing));
                way.sign() * lags.energy(all, s) <= limit
            };
            // At larger slides, fewer magnets face each other than are allowed.
            (last < 0 || is_within(0)) && (1..=last).all(|s| is_within(s) && is_within(-s))
        })
    }

    /// The strongest wrong contact of two words and their mates, however weak; `None` if they never
    /// meet.
    pub fn strongest(&self, lags: &Lags, u: Word, v: Word) -> Option<WrongContact> {
        let found = self
            .ways()
            .filter_map(|way| self.strongest_way(lags, [u, v], way));
        found.reduce(WrongContact::stronger)
    }

    /// The same for two faces alone, without the bond.
    pub fn strongest_of(&self, lags: &Lags, first: Word, second: Word) -> Option<WrongContact> {
        let ways = self.ways().filter(|way| way.mate != self.own());
        let second = if self.own() { second } else { second.mate() };
        let found = ways.filter_map(|way| self.strongest_way(lags, [first, second], way));
        found.reduce(WrongContact::stronger)
    }

    fn strongest_way(&self, lags: &Lags, [u, v]: [Word; 2], way: Way) -> Option<WrongContact> {
        let facing = way.facing(v);
        let all = lags.energies(&Correlations::new(u, facing));
        let slides = self.slides_of(u.places());
        let wrong = slides.filter(|s| !self.is_bond(way, *s, u == v));
        let energies = wrong.map(|s| match self.fault {
            Some(fault) => (fault.least(lags, -way.sign(), [u, facing], s), s),
            None => ((-way.sign() * all.at(s), [None; 2]), s),
        });
        let ((energy, faulty), s) = energies.reduce(|a, b| if b.0.0 < a.0.0 { b } else { a })?;
        Some(WrongContact {
            first: u,
            second: if way.mate { v.mate() } else { v },
            flipped: way.flipped,
            // u[k] faces place k + s of the second, counted from its end.
            slide: -s,
            energy,
            faulty: [faulty[0], faulty[1].map(|j| way.place(j, v.places()))],
        })
    }

    /// The depth (J) of the bond of a word, flush; with the worst faults if faults are allowed.
    pub fn bond(&self, lags: &Lags, word: Word) -> f64 {
        let way = self.bond_way();
        let facing = way.facing(word);
        match self.fault {
            Some(fault) => fault.least(lags, way.sign(), [word, facing], 0).0,
            None => way.sign() * lags.energy(&Correlations::new(word, facing), 0),
        }
    }

    /// The energy (J) of two faces without faults, neither turned over, the second one `slide`
    /// places farther along the first (counter-clockwise); includes the bond of a word and its
    /// mate.
    pub fn energy_at(&self, lags: &Lags, first: Word, second: Word, slide: i32) -> f64 {
        let all = Correlations::new(first, second.mate());
        -lags.energy(&all, -slide)
    }

    /// All energies (J) of wrong contacts of two faces without faults, the second a mate or not,
    /// neither turned over.
    pub fn energies(&self, lags: &Lags, [u, v]: [Word; 2], mate: bool) -> Vec<f64> {
        let way = Way {
            mate,
            flipped: false,
        };
        let all = lags.energies(&Correlations::new(u, way.facing(v)));
        self.slides_of(u.places())
            .filter(|s| !self.is_bond(way, *s, u == v))
            .map(|s| -way.sign() * all.at(s))
            .collect()
    }
}
