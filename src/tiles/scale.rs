//! Lengths that are stated for tiles of one size, scaled to tiles of another.
//!
//! If all lengths of a problem are multiplied by s at the same remanence, energies are multiplied
//! by s^3 and nothing else changes. So no step of a search and no tolerance may be an absolute
//! length. If it cannot be derived from a magnet, an energy or an outline, it is relative to the
//! tiles: the constants of this crate in m apply to the paper's tile, a square of 43 cm, and are
//! converted by [`Scale::length`] (mostly as [`Contact::scaled`](crate::contact::Contact::scaled)
//! and [`Problem::scaled`](crate::Problem::scaled)) before they are used.

/// The circumradius (m) of the paper's tile, `0.43 / sqrt 2`.
const TOLD_FOR: f64 = 0.304_055_915_910_215_24;

/// How many times larger tiles are than the paper's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(f64);

impl Scale {
    /// For landscapes without tiles: lengths are not scaled.
    pub const NONE: Self = Self(1.0);

    /// The scale of tiles with these circumradii (m): of the smaller one, because its shape must be
    /// resolved.
    #[inline]
    pub fn of(circumradii: [f64; 2]) -> Self {
        let ratio = circumradii[0].min(circumradii[1]) / TOLD_FOR;
        // To seven digits, so that the rounding of corners has no effect.
        Self(f64::from(ratio as f32))
    }

    /// A length (m) given for the paper's tiles, scaled to these.
    #[inline]
    pub fn length(self, told: f64) -> f64 {
        told * self.0
    }

    /// A time (s) given for the paper's tiles, scaled to these: with the same remanence and
    /// density, tiles of any size reach the same speeds.
    #[inline]
    pub fn time(self, told: f64) -> f64 {
        told * self.0
    }

    /// The factor itself.
    #[inline]
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
