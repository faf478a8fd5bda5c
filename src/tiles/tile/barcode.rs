//! Barcodes: which pole of each magnet of a face points outwards.
//!
//! A code is read counter-clockwise along its face: `N` north pole out (the moment along the
//! outward normal), `S` south pole out, `U` and `D` an upright magnet with its north pole up and
//! down, `.` no magnet. Character k of n sits at `s = (k - (n - 1) / 2) * pitch` from the middle of
//! the face.
//!
//! Two faces that touch run against each other, so the mate of a code is its reverse with N and S
//! exchanged, and U and D: `NNNS` binds `NSSS`. The same rule holds for magnets at any place and
//! angle: the mate of a magnet at s, turned by `axis` from the normal, sits at -s, has the other
//! pole out and is turned by `-axis`. Head to tail across the gap, the two moments (along the
//! normal and along the face) are those of a magnet and its image in a soft-iron wall, so that each
//! pair attracts at every angle.

use std::fmt::{self, Write};

/// The pole of a magnet that points outwards or, for an upright magnet, the side of its north pole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pole {
    /// The moment along the outward normal.
    North,
    /// The moment against it.
    South,
    /// The moment out of the tiles' plane.
    Up,
    /// The moment into it.
    Down,
}

impl Pole {
    /// North or up for a positive sign, south or down for a negative one; `None` for 0.
    pub fn of(sign: i32, stands: bool) -> Option<Self> {
        match (sign.signum(), stands) {
            (0, _) => None,
            (1, false) => Some(Self::North),
            (1, true) => Some(Self::Up),
            (_, false) => Some(Self::South),
            (_, true) => Some(Self::Down),
        }
    }

    /// The pole that it attracts.
    pub fn opposite(self) -> Self {
        match self {
            Self::North => Self::South,
            Self::South => Self::North,
            Self::Up => Self::Down,
            Self::Down => Self::Up,
        }
    }

    /// Whether a magnet with this pole is upright.
    pub fn stands(self) -> bool {
        matches!(self, Self::Up | Self::Down)
    }

    /// Its character in a code.
    pub fn letter(self) -> char {
        match self {
            Self::North => 'N',
            Self::South => 'S',
            Self::Up => 'U',
            Self::Down => 'D',
        }
    }

    /// The pole of a code's character.
    pub fn from_char(c: char) -> Option<Self> {
        let all = [Self::North, Self::South, Self::Up, Self::Down];
        all.into_iter().find(|pole| pole.letter() == c)
    }
}

/// The poles along a face, counter-clockwise; `None` if there is no magnet.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Barcode(Vec<Option<Pole>>);

/// A character that is not a pole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "'{character}' is not a pole; a code consists of N and S, or of U and D, and . (no magnet)"
)]
pub struct BarcodeError {
    /// The position of the character, counted from 0.
    pub index: usize,
    /// The character.
    pub character: char,
}

impl Barcode {
    /// Reads a code such as `NN.S`.
    ///
    /// # Errors
    /// The first character other than `N`, `S`, `U`, `D` and `.`.
    pub fn parse(code: &str) -> Result<Self, BarcodeError> {
        code.chars()
            .enumerate()
            .map(|(index, character)| match Pole::from_char(character) {
                Some(pole) => Ok(Some(pole)),
                None if character == '.' => Ok(None),
                None => Err(BarcodeError { index, character }),
            })
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// Number of places, empty ones included.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether the code has no places at all.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The code that binds this one.
    pub fn mate(&self) -> Self {
        Self(
            self.0
                .iter()
                .rev()
                .map(|place| place.map(Pole::opposite))
                .collect(),
        )
    }

    /// Where the magnets sit along the face, for a spacing of `pitch` (m): the place in the code,
    /// s (m) and the pole, counter-clockwise.
    pub fn places(&self, pitch: f64) -> impl Iterator<Item = (usize, f64, Pole)> + '_ {
        let middle = (self.len() as f64 - 1.0) / 2.0;
        self.0
            .iter()
            .enumerate()
            .filter_map(move |(k, place)| place.map(|pole| (k, (k as f64 - middle) * pitch, pole)))
    }
}

impl fmt::Display for Barcode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0
            .iter()
            .try_for_each(|place| f.write_char(place.map_or('.', Pole::letter)))
    }
}
