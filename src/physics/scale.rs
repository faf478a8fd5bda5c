//! Lengths that are stated for tiles of one size, scaled to tiles of another.
//!
//! Multiply all lengths of a problem by s and keep the remanence: energies are multiplied by s^3, and
//! nothing else changes. So no step of a search and no tolerance may be a length by itself. Where it
//! belongs to no magnet, energy or outline that is at hand, it belongs to the tiles: the constants of
//! this crate that are said to be in m are what they are for the paper's tile, a square of 43 cm, and
//! go through [`Scale::length`] (mostly as [`Contact::scaled`](crate::contact::Contact::scaled) and
//! [`Problem::scaled`](crate::Problem::scaled)) before they are used.

/// The circumradius (m) of the paper's tile, `0.43 / sqrt 2`.
const TOLD_FOR: f64 = 0.304_055_915_910_215_24;

/// How many times larger tiles are than the paper's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(f64);

impl Scale {
    /// Of landscapes without tiles: lengths are what they are told to be.
    pub const NONE: Self = Self(1.0);

    /// Of tiles with these circumradii (m): of the smaller one, as its shape is to be resolved.
    pub fn of(circumradii: [f64; 2]) -> Self {
        let ratio = circumradii[0].min(circumradii[1]) / TOLD_FOR;
        // To seven digits: how corners are rounded must not show.
        Self(f64::from(ratio as f32))
    }

    /// What a length (m) is for these tiles that is told for the paper's.
    pub fn length(self, told: f64) -> f64 {
        told * self.0
    }

    /// What a time (s) is for these tiles that is told for the paper's: magnets of the same remanence and
    /// tiles of the same density bring tiles of any size to the same speeds.
    pub fn time(self, told: f64) -> f64 {
        told * self.0
    }

    /// The factor itself.
    pub fn factor(self) -> f64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_tile_is_the_measure_and_the_smaller_tile_counts() {
        let radius = libm::hypot(0.215, 0.215);
        assert_eq!(Scale::of([radius, 2.0 * radius]).length(1e-3), 1e-3);
        assert_eq!(Scale::of([radius, radius / 8.0]).length(1e-3), 1e-3 / 8.0);
        assert_eq!(Scale::of([radius * (1.0 + 1e-12); 2]), Scale::NONE);
    }
}
