//! The numbers of pictures in tables of numbers.

use crate::csv::{number, rounded};
use physics::tile::Pair;

/// Decimals of lengths (m) in tables of numbers: a micrometre for tiles of 5 to 50 cm, and in
/// proportion for others.
#[derive(Clone, Copy)]
pub struct Decimals(i32);

impl Decimals {
    /// For two tiles.
    pub fn of(pair: &Pair) -> Self {
        Self(5 - libm::floor(libm::log10(pair.free_distance())) as i32)
    }

    /// A length (m).
    pub fn length(self, value: f64) -> String {
        let scale = 10f64.powi(self.0);
        number((scale * value).round() / scale)
    }

    /// The two lengths (m) and the angle (rad) of a pose.
    pub fn pose(self, [x, y, theta]: [f64; 3]) -> [String; 3] {
        [self.length(x), self.length(y), angle(theta)]
    }
}

/// An angle (rad) in a table of numbers.
pub fn angle(value: f64) -> String {
    number((1e6 * value).round() / 1e6)
}

/// An energy (J) in a table of numbers, to five significant digits: a picture shows no more.
pub fn energy(value: f64) -> String {
    rounded(value, 5)
}
